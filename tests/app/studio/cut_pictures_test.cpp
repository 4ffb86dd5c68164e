// The strip of thumbnails: views keep their places from one cut to the next.
#include "app/studio/cut_pictures.h"

#include <doctest/doctest.h>

#include <cmath>

using namespace splatcut;

namespace {

constexpr float kTurn = 6.2831853f;

// Around the origin; twelve steps are a whole turn.
ViewCard around(float step, bool used = false) {
  const float angle = kTurn * step / 12;
  ViewCard card;
  card.camera = look_at({3 * std::sin(angle), -1, -3 * std::cos(angle)}, {0, 0, 0}, {0, -1, 0}, 0.9f, 64, 48);
  card.used = used;
  card.only_to_look = !used;
  return card;
}

std::vector<ViewCard> cards(std::initializer_list<float> steps) {
  std::vector<ViewCard> out;
  for (const float step : steps) out.push_back(around(step, out.empty()));
  return out;
}

bool same_order(const std::vector<ViewCard>& a, const std::vector<ViewCard>& b) {
  return std::ranges::equal(
      a, b, [](const ViewCard& left, const ViewCard& right) { return same_view(left.camera, right.camera); });
}

}  // namespace

TEST_CASE(
    "thumbnails: a view that was clicked stays where it was, others nearly as before, new ones come last") {
  const auto before = cards({0, 1, 11, 2, 10});
  // The view at 11 was corrected: it counts now, so that the cut lists it second; the others moved a little.
  const auto after = in_places_of(before, cards({0, 11, 1.1f, 1.9f, 10.1f, 5}));
  CHECK(same_order(after, cards({0, 1.1f, 11, 1.9f, 10.1f, 5})));
}

TEST_CASE("thumbnails: nothing is lost, whatever was shown before") {
  CHECK(same_order(in_places_of({}, cards({0, 1, 2})), cards({0, 1, 2})));
  CHECK(same_order(in_places_of(cards({6, 7, 8}), cards({0, 1, 2})), cards({0, 1, 2})));
  CHECK(same_order(in_places_of(cards({0, 1, 2, 3}), cards({0, 3})), cards({0, 3})));
  CHECK(in_places_of(cards({0, 1}), {}).empty());
}
