// The strip of thumbnails: views keep their places from one cut to the next.
#include "app/studio/cut_pictures.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "hands.h"
#include "segment/masks/mask_tools.h"

using namespace splatcut;
using namespace splatcut::testing;

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

TEST_CASE("thumbnails: a border through a surface is told from that of a whole thing on a table") {
  Hands hands = hands_on_sample();
  const Scene& scene = *hands.studio().scene()->scene;
  const Drawer drawer(scene.cloud, nullptr, nullptr);
  RasterOptions options;
  options.depth = true;
  // Of all views around what was clicked.
  const auto most = [&](const std::vector<std::uint8_t>& labels) {
    double share = 0;
    for (const ViewCard& card : hands.studio().cuts().run(hands.studio().document().active)->views) {
      const Mask mask = thresholded(render_labels(drawer, card.camera, labels), 0.5f);
      const RasterOutput drawn = rasterize(scene.cloud, limited_to_width(card.camera, 160), options);
      share = std::max(share, share_through_surface(drawn, mask));
    }
    return share;
  };
  for (const std::uint8_t thing : {kApple, kOrange, kMug}) CHECK(most(sample_truth(scene, thing)) < 0.15);
  for (const auto& [thing, axis, from] :
       {std::tuple{kMug, 0, 0.0f}, {kMug, 2, -0.34f}, {kApple, 0, 0.4f}, {kApple, 2, -0.48f}}) {
    CAPTURE(static_cast<int>(thing));
    CAPTURE(axis);
    std::vector<std::uint8_t> half = sample_truth(scene, thing);
    for (std::size_t g = 0; g < half.size(); ++g) half[g] = half[g] && scene.cloud.position[g][axis] > from;
    REQUIRE(count_flags(half) > 500);
    CHECK(most(half) > 0.2);
  }
}

TEST_CASE("thumbnails: sides in doubt are marked, and the message says how many") {
  Hands hands = hands_on_sample();
  const auto doubtful = [&] {
    const CutRun* run = hands.studio().cuts().run(hands.studio().document().active);
    return std::ranges::count_if(run->views, [](const ViewCard& c) { return c.only_to_look && c.in_doubt; });
  };
  CHECK(doubtful() == 0);
  CHECK(hands.said().find("in doubt") == std::string::npos);
  while (doubtful() == 0) {  // smaller parts of the apple end on the apple
    hands.app.key(key::kPageDown);
    REQUIRE(hands.app.settle());
    REQUIRE(hands.said().find("smallest") == std::string::npos);
  }
  const CutRun* run = hands.studio().cuts().run(hands.studio().document().active);
  CHECK((hands.said().find("right from here") != std::string::npos) == !run->views.front().in_doubt);
  CHECK(hands.said().find(doubtful() == 1 ? "one side is in doubt" : "sides are in doubt") !=
        std::string::npos);
}
