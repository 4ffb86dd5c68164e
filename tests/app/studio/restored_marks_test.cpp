// Which sides are in doubt in work that is opened again: those that were when it was saved.
#include <doctest/doctest.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "reopened.h"

using namespace splatcut;
using namespace splatcut::testing;

namespace {

// What the thumbnails show and say, in their order.
std::vector<std::pair<std::string, std::vector<Rgba8>>> marked_sides(HeadlessApp& app) {
  std::vector<std::pair<std::string, std::vector<Rgba8>>> all;
  for (const ViewCard& card : app.studio().cuts().run(app.studio().document().active)->views)
    all.emplace_back(card.doubt + card.legend + (card.looked_at ? " (looked at)" : ""),
                     std::vector<Rgba8>(card.picture->pixels().begin(), card.picture->pixels().end()));
  return all;
}

std::vector<std::string> said_of(const std::vector<std::pair<std::string, std::vector<Rgba8>>>& sides) {
  std::vector<std::string> all;
  for (const auto& side : sides) all.push_back(side.first);
  return all;
}

}  // namespace

TEST_CASE("restored marks: sides are in doubt as they were when the work was saved") {
  Hands hands = hands_on_sample();
  const auto click_on = [&](const glm::vec2& thing, PointerButton button) {
    hands.app.click(hands.app.screen_of(thing), button);
    REQUIRE(hands.app.settle());
  };
  SUBCASE("one click") {}
  SUBCASE("a click more") {
    click_on(kOnOrange, PointerButton::kLeft);
  }
  SUBCASE("a correction that takes far sides") {
    click_on(kOnOrange, PointerButton::kLeft);
    click_on(kOnOrange, PointerButton::kRight);
  }
  SUBCASE("another size") {
    hands.app.key(key::kPageDown);
    REQUIRE(hands.app.settle());
  }
  SUBCASE("an older change that nobody looked at") {
    hands.app.key(key::kPageDown);
    REQUIRE(hands.app.settle());
    click_on(kOnMug, PointerButton::kLeft);
    click_on(kOnOrange, PointerButton::kLeft);
  }
  SUBCASE("steps that are no strokes") {
    click_on(kOnOrange, PointerButton::kLeft);
    click_on(kOnOrange, PointerButton::kRight);
    hands.studio().apply(RenameObject{hands.studio().document().active, "apple"});
    hands.studio().apply(SetSmoothness{hands.studio().document().active, 2});
    REQUIRE(hands.app.settle());
    hands.studio().apply(Undo{});
    REQUIRE(hands.app.settle());
  }
  const auto before = marked_sides(hands.app);
  const ScratchFolder folder("restored_marks");
  const auto after = marked_sides(*reopened(hands, folder));
  CHECK(said_of(after) == said_of(before));
  CHECK(after == before);
}
