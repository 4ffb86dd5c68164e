// Views that are projected once and drawn many times, against drawing each picture afresh.
#include "scene/raster/projected_view.h"

#include <doctest/doctest.h>

#include <algorithm>

#include "reference_rasterizer.h"
#include "synthetic_cloud.h"

using namespace splatcut;
using namespace splatcut::testing;

namespace {

struct Drawn {
  RasterOutput out;
  MaskedSums sums;
};

bool same(const Drawn& a, const Drawn& b) {
  const auto equal = [](const auto& x, const auto& y) { return std::ranges::equal(x.pixels(), y.pixels()); };
  return equal(a.out.colour, b.out.colour) && equal(a.out.alpha, b.out.alpha) &&
         equal(a.out.label_share, b.out.label_share) && equal(a.out.expected_depth, b.out.expected_depth) &&
         equal(a.out.median_depth, b.out.median_depth) && equal(a.out.first_hit, b.out.first_hit) &&
         a.sums.total == b.sums.total && a.sums.inside == b.sums.inside;
}

std::vector<std::uint8_t> every(std::size_t n, std::size_t nth) {
  std::vector<std::uint8_t> flags(n);
  for (std::size_t g = 0; g < n; ++g) flags[g] = g % nth == 0;
  return flags;
}

}  // namespace

TEST_CASE("a projected view draws what a fresh picture shows, bit for bit, with any options") {
  const GaussianCloud cloud = random_cloud(3000, 5, 2, 0.1f);
  const Camera camera = front_camera(123, 77);
  // The first drawing of everything leaves lists for those after it: once the first of all, once the last but
  // few.
  const ProjectedView view(cloud, camera, true), backwards(cloud, camera, true);
  const ProjectedView nothing_kept(cloud, camera, true, {}, 100);
  CHECK(nothing_kept.bytes() == 0);
  const std::vector<std::uint8_t> labels = every(cloud.size(), 3), shown = every(cloud.size(), 2);
  Mask mask(camera.width_px, camera.height_px);
  for (int y = 0; y < mask.height(); ++y) std::fill_n(&mask.at(0, y), mask.width() / 2, kMaskObject);
  for (int i = 0; i < 128; ++i) {
    const int choice = i < 64 ? i : 127 - i;
    CAPTURE(i);
    const auto draw = [&](const auto& by) {
      Drawn drawn{{}, MaskedSums(cloud.size())};
      RasterOptions options;
      options.colour = choice & 1;
      options.depth = choice & 2;
      if (choice & 4 && !options.colour) options.labels = labels;
      if (choice & 8) options.shown = shown;
      if (choice & 16) options.roi = PixelRect{21, 13, 94, 60};
      if (choice & 32) options.sum_mask = &mask, options.sums = &drawn.sums;
      drawn.out = by(options);
      return drawn;
    };
    const Drawn fresh = draw([&](const RasterOptions& o) { return rasterize(cloud, camera, o); });
    REQUIRE(same(draw([&](const RasterOptions& o) { return (i < 64 ? view : backwards).draw(o); }), fresh));
    if (i < 64) REQUIRE(same(draw([&](const RasterOptions& o) { return nothing_kept.draw(o); }), fresh));
    REQUIRE(std::ranges::any_of(fresh.out.alpha.pixels(), [](float a) { return a > 0.5f; }));
  }
}

TEST_CASE("the share of a label: what white for the label and black for the rest would show") {
  const GaussianCloud cloud = random_cloud(800, 6, 0, 0.15f);
  const std::vector<std::uint8_t> labels = every(cloud.size(), 3);
  std::vector<glm::vec3> white(cloud.size());
  for (std::size_t g = 0; g < cloud.size(); ++g) white[g] = glm::vec3(labels[g]);
  RasterOptions options;
  options.colour_override = white;
  const RasterOutput expected = rasterize(cloud, front_camera(), options);
  options = {};
  options.colour = false;
  options.labels = labels;
  const RasterOutput fast = rasterize(cloud, front_camera(), options),
                     slow = rasterize_reference(cloud, front_camera(), options);
  for (std::size_t i = 0; i < fast.label_share.size(); ++i) {
    REQUIRE(fast.label_share.pixels()[i] == expected.colour.pixels()[i].r);
    REQUIRE(slow.label_share.pixels()[i] == doctest::Approx(fast.label_share.pixels()[i]).epsilon(2e-3));
  }
}

TEST_CASE(
    "kept views: the last ones that fit, colours when they are asked for, and nothing of what was "
    "cancelled") {
  const GaussianCloud cloud = random_cloud(2000, 8, 1, 0.1f);
  const auto camera = [](int i) { return front_camera(80 + i, 60); };
  const std::size_t bytes = ProjectedView(cloud, camera(0), false).bytes();
  CHECK(bytes >= 40 * cloud.size());
  KeptViews kept(cloud, 5 * bytes / 2);
  const ProjectedView* first = &kept.view(camera(0), false, {});
  kept.view(camera(1), false, {});
  CHECK(&kept.view(camera(0), false, {}) == first);
  kept.view(camera(2), false, {});  // no room: the second, unused for longest, goes
  CHECK(kept.size() == 2);
  CHECK(&kept.view(camera(0), false, {}) == first);
  CHECK(kept.view(camera(0), true, {}).coloured());
  CHECK(kept.view(camera(0), false, {}).coloured());  // more than is asked for does no harm

  Job cancelled;
  std::stop_source stop;
  stop.request_stop();
  cancelled.stop = stop.get_token();
  CHECK_FALSE(kept.view(camera(3), false, cancelled).complete());
  CHECK(kept.view(camera(3), false, {}).complete());
  const Drawer drawer(cloud, &kept);
  CHECK(std::ranges::equal(drawer.draw(camera(3), {}).colour.pixels(),
                           rasterize(cloud, camera(3)).colour.pixels()));
  RasterOptions nearer;
  nearer.near_plane = 2;  // not what views are kept with
  CHECK(std::ranges::equal(drawer.draw(camera(3), nearer).alpha.pixels(),
                           rasterize(cloud, camera(3), nearer).alpha.pixels()));
}
