// Objects as hands expect them: locked ones stay.
#include <doctest/doctest.h>

#include "hands.h"

using namespace splatcut;
using namespace splatcut::testing;

TEST_CASE("hands: another method does not change what is locked") {
  Hands hands = hands_on_sample();
  Studio& studio = hands.studio();
  const ObjectId object = studio.document().active;
  const auto before = studio.labels(object);
  studio.apply(LockObject{object, true});
  studio.apply(SetPreset{"paper-code"});
  REQUIRE(hands.app.settle());
  CHECK(studio.labels(object) == before);
  studio.apply(LockObject{object, false});
  REQUIRE(hands.app.settle());
  CHECK(studio.labels(object) != before);
}
