// What goes with a click on the rest, of what lies apart from it in the picture.
#include <doctest/doctest.h>

#include "four_leaves.h"
#include "segment/selection/reached_leaves.h"

using namespace splatcut;
using namespace splatcut::testing;

namespace {

constexpr int kReachWidth = 60, kReachHeight = 20;
constexpr Rgb8 kStoneGrey{120, 120, 120}, kGrassGreen{70, 130, 50};
using Leaves = std::vector<std::uint8_t>;

// Side by side from the left: leaf 0, which is green and clicked, a gap, leaf 1, and leaf 2, which is grey
// and stays. Nothing shows of leaf 3.
struct Picture {
  PartHierarchy parts = four_leaves();
  LeafView view;
  Mask displayed{kReachWidth, kReachHeight};

  Picture(int gap_px, const Rgb8& colour_of_1) {
    Image<std::int32_t> hit(kReachWidth, kReachHeight, -1);
    Image<Rgb8> colour(kReachWidth, kReachHeight, Rgb8{});
    const auto put = [&](std::int32_t leaf, int from, int to, const Rgb8& c) {
      for (int y = 4; y < 16; ++y)
        for (int x = from; x < to; ++x) {
          hit.at(x, y) = leaf;
          colour.at(x, y) = c;
          displayed.at(x, y) = kMaskObject;
        }
    };
    put(0, 2, 14, kGrassGreen);
    put(1, 14 + gap_px, 26 + gap_px, colour_of_1);
    put(2, 26 + gap_px, 50, kStoneGrey);
    Camera camera = look_at({0, 0, -10}, {0, 0, 0}, {0, -1, 0}, 1, kReachWidth, kReachHeight);
    view = leaf_view_of_hits(parts, camera, hit);
    view.colour = colour;
  }

  Leaves left_of(Leaves meant, bool object = false) const {
    const Leaves labels(4, object ? 0 : 1);
    return within_reach({view, {8, 10}, object, false, 0, 6, displayed}, labels, std::move(meant));
  }
};

}  // namespace

TEST_CASE("within reach: what lies apart stays where it looks like the object, not like what goes") {
  CHECK(Picture(8, kStoneGrey).left_of({1, 1, 0, 0}) == Leaves{1, 0, 0, 0});
  CHECK(Picture(8, kGrassGreen).left_of({1, 1, 0, 0}) == Leaves{1, 1, 0, 0});
}

TEST_CASE(
    "within reach: a narrow gap is none, what is hidden follows, nothing goes that the click is not on") {
  CHECK(Picture(4, kStoneGrey).left_of({1, 1, 0, 0}) == Leaves{1, 1, 0, 0});
  CHECK(Picture(5, kStoneGrey).left_of({1, 1, 0, 0}) == Leaves{1, 0, 0, 0});
  CHECK(Picture(8, kStoneGrey).left_of({1, 1, 0, 1}) == Leaves{1, 0, 0, 1});
  CHECK(Picture(8, kGrassGreen).left_of({0, 1, 0, 0}) == Leaves{0, 0, 0, 0});
}

TEST_CASE("within reach: clicks on the object, and views without colour, take all that is meant") {
  CHECK(Picture(8, kStoneGrey).left_of({1, 1, 0, 0}, true) == Leaves{1, 1, 0, 0});
  Picture colourless(8, kStoneGrey);
  colourless.view.colour = {};
  CHECK(colourless.left_of({1, 1, 0, 0}) == Leaves{1, 1, 0, 0});
}
