#include "scene/raster/rasterizer.h"

#include <doctest/doctest.h>
#include <hwy/targets.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "reference_rasterizer.h"
#include "scene/raster/splat_math.h"
#include "scene/raster/splat_projection.h"
#include "scene/raster/tile_grid.h"
#include "synthetic_cloud.h"

using namespace splatcut;
using namespace splatcut::testing;

namespace {

RasterOptions everything() {
  RasterOptions options;
  options.depth = true;
  options.background = {0.1f, 0.2f, 0.3f};
  return options;
}

Mask left_half(const Camera& camera) {
  Mask mask(camera.width_px, camera.height_px);
  for (int y = 0; y < mask.height(); ++y)
    for (int x = 0; x < mask.width() / 2; ++x) mask.at(x, y) = kMaskObject;
  return mask;
}

bool same_bits(const RasterOutput& a, const RasterOutput& b) {
  return a.colour == b.colour && a.alpha == b.alpha && a.expected_depth == b.expected_depth &&
         a.median_depth == b.median_depth && a.first_hit == b.first_hit;
}

}  // namespace

TEST_CASE("one splat: alpha and colour at its centre and two pixels off, by hand") {
  // sigma_px = 100 * 0.04 / 2 = 2, so Sigma2 = 4 + 0.3 px^2.
  const GaussianCloud cloud = single_splat(2, 0.04f, 0.8f, {1, 0.5f, 0.25f});
  const RasterOutput out = rasterize(cloud, axis_camera(), everything());
  const float side = 0.8f * std::exp(-0.5f * 4 / 4.3f);
  CHECK(out.alpha.at(16, 16) == doctest::Approx(0.8).epsilon(1e-5));
  CHECK(out.alpha.at(18, 16) == doctest::Approx(side).epsilon(1e-5));
  CHECK(out.colour.at(16, 16).r == doctest::Approx(0.8 + 0.2 * 0.1).epsilon(1e-5));
  CHECK(out.colour.at(18, 16).g == doctest::Approx(side * 0.5 + (1 - side) * 0.2).epsilon(1e-5));
  CHECK(out.expected_depth.at(16, 16) == doctest::Approx(2));
  CHECK(out.median_depth.at(16, 16) == 2.0f);
  CHECK(out.first_hit.at(16, 16) == 0);
  CHECK(out.first_hit.at(0, 0) == -1);
}

TEST_CASE("the low-pass is what the options say, by hand: a point's variance is nothing else") {
  const GaussianCloud point = single_splat(2, 1e-6f, 0.8f, glm::vec3(1));
  for (const float low_pass_px2 : {kWebLowPassPx2, kLowPassPx2, 4.0f}) {
    CAPTURE(low_pass_px2);
    RasterOptions options = everything();
    options.low_pass_px2 = low_pass_px2;
    const RasterOutput out = rasterize(point, axis_camera(), options);
    const RasterOutput slow = rasterize_reference(point, axis_camera(), options);
    for (const int off : {0, 1, 2, 5, 6}) {
      const double seen = 0.8 * std::exp(-0.5 * off * off / low_pass_px2);
      CAPTURE(off);
      CHECK(out.alpha.at(16 + off, 16) == doctest::Approx(seen < 1 / 255.0 ? 0 : seen).epsilon(1e-4));
      CHECK(slow.alpha.at(16 + off, 16) == doctest::Approx(out.alpha.at(16 + off, 16)).epsilon(1e-4));
    }
  }
}

TEST_CASE("antialiased: what the low-pass adds to the area is taken off the opacity, by hand") {
  GaussianCloud cloud =
      single_splat(2, 0.01f, 0.8f, glm::vec3(1));  // 0.5 px: Sigma2 0.25, with the low-pass 0.55
  cloud.antialiased = true;
  const RasterOutput out = rasterize(cloud, axis_camera(), everything());
  const RasterOutput slow = rasterize_reference(cloud, axis_camera(), everything());
  for (const int off : {0, 1}) {
    const double seen = 0.8 * 0.25 / 0.55 * std::exp(-0.5 * off * off / 0.55);
    CHECK(out.alpha.at(16 + off, 16) == doctest::Approx(seen).epsilon(1e-4));
    CHECK(slow.alpha.at(16 + off, 16) == doctest::Approx(seen).epsilon(1e-4));
  }
  cloud.scale[0] = glm::vec3(1e-6f);  // a point would take an opacity below 1/255
  CHECK(rasterize(cloud, axis_camera(), everything()).alpha.at(16, 16) == 0);
  CHECK(rasterize_reference(cloud, axis_camera(), everything()).alpha.at(16, 16) == 0);
}

TEST_CASE("a wide low-pass reaches into the picture from beside it") {
  RasterOptions options = everything();
  options.low_pass_px2 = 16;
  options.roi = PixelRect{26, 16, 27, 17};  // ten pixels off: 3.1 of 4 px sigmas are drawn
  const double seen = 0.8 * std::exp(-0.5 * 100 / 16);
  const RasterOutput out = rasterize(single_splat(2, 1e-6f, 0.8f, glm::vec3(1)), axis_camera(), options);
  CHECK(out.alpha.at(0, 0) == doctest::Approx(seen).epsilon(1e-4));
}

TEST_CASE("a splat ends where alpha falls to 1/255, not at 3 sigma") {
  const GaussianCloud cloud = single_splat(2, 0.04f, 0.99f, glm::vec3(1));
  const RasterOutput out = rasterize(cloud, axis_camera(), everything());
  const double reach = std::sqrt(2 * std::log(0.99 * 255) * 4.3);  // 6.9 px; 3 sigma would be 6.2
  CHECK(out.alpha.at(16 + static_cast<int>(reach), 16) > 0);
  CHECK(out.alpha.at(16 + static_cast<int>(reach) + 1, 16) == 0);
}

TEST_CASE("two splats: the nearer one hides the other, alpha clamps at 0.99") {
  GaussianCloud cloud = single_splat(4, 0.08f, 1.0f, {0, 1, 0});
  const GaussianCloud near = single_splat(2, 0.04f, 1.0f, {1, 0, 0});
  cloud.resize(2, 0);
  cloud.position[1] = near.position[0];
  cloud.scale[1] = near.scale[0];
  cloud.opacity[1] = near.opacity[0];
  cloud.f_dc[1] = near.f_dc[0];
  const RasterOutput out = rasterize(cloud, axis_camera(), {});
  CHECK(out.colour.at(16, 16).r == doctest::Approx(0.99).epsilon(1e-5));
  CHECK(out.colour.at(16, 16).g == doctest::Approx(0.01 * 0.99).epsilon(1e-4));
  CHECK(out.alpha.at(16, 16) == doctest::Approx(0.9999).epsilon(1e-6));
}

TEST_CASE("tile rasteriser agrees with the scalar reference") {
  for (const int degree : {0, 1, 2, 3, 4}) {  // 4: of degree 0, antialiased
    CAPTURE(degree);
    GaussianCloud cloud = random_cloud(3000, 7, degree % 4, 0.15f);
    cloud.antialiased = degree == 4;
    const Camera camera = front_camera();
    const Mask mask = left_half(camera);
    MaskedSums fast(cloud.size()), slow(cloud.size());
    RasterOptions options = everything();
    options.sum_mask = &mask;
    options.sums = &fast;
    const RasterOutput a = rasterize(cloud, camera, options);
    options.sums = &slow;
    const RasterOutput b = rasterize_reference(cloud, camera, options);
    int off = 0;
    for (std::size_t i = 0; i < a.alpha.size(); ++i) {
      // A pixel exactly on the 1/255 or stop threshold may fall on either side by rounding.
      if (std::abs(a.alpha.pixels()[i] - b.alpha.pixels()[i]) > 2e-4f) ++off;
      if (glm::length(a.colour.pixels()[i] - b.colour.pixels()[i]) > 6e-3f) ++off;
      if (std::abs(a.expected_depth.pixels()[i] - b.expected_depth.pixels()[i]) > 2e-2f) ++off;
    }
    CHECK(off == 0);
    for (std::size_t g = 0; g < cloud.size(); ++g) {
      CAPTURE(g);
      CHECK(std::abs(fast.total[g] - slow.total[g]) <
            0.02 * 65536 + 0.001 * static_cast<double>(slow.total[g]));
      CHECK(std::abs(fast.inside[g] - slow.inside[g]) <
            0.02 * 65536 + 0.001 * static_cast<double>(slow.inside[g]));
      CHECK(fast.inside[g] <= fast.total[g]);
    }
  }
}

TEST_CASE("a batch of projected Gaussians agrees with project() and sh_colour() one by one") {
  for (const int degree : {0, 1, 2, 3}) {
    CAPTURE(degree);
    GaussianCloud cloud = random_cloud(253, 17, degree, 0.1f);  // no whole number of vectors
    cloud.position[7] = {0, 0, -4};                             // behind the camera
    cloud.opacity[9] = 0.5f / 255;                              // never seen
    const Camera camera = front_camera();
    const PixelRect everywhere{-100000, -100000, 100000, 100000};
    SplatBatch batch;
    project_batch(cloud, 0, static_cast<std::uint32_t>(cloud.size()), camera, {}, everywhere, &batch);
    int next = 0;
    for (std::uint32_t g = 0; g < cloud.size(); ++g) {
      CAPTURE(g);
      Splat s;
      if (!project(cloud, g, camera, cloud.near_plane, &s)) continue;
      REQUIRE(next < batch.size);
      const int i = next++;
      REQUIRE(batch.gaussian[i] == g);
      const double log2_e = 1.4426950408889634;
      CHECK(batch.x_px[i] == doctest::Approx(s.mean_px.x).epsilon(1e-5));
      CHECK(batch.y_px[i] == doctest::Approx(s.mean_px.y).epsilon(1e-5));
      CHECK(batch.depth[i] == doctest::Approx(s.depth).epsilon(1e-6));
      CHECK(batch.qa[i] == doctest::Approx(-0.5 * log2_e * s.conic.a).epsilon(1e-3));
      CHECK(batch.qb[i] == doctest::Approx(-log2_e * s.conic.b).epsilon(1e-3));
      CHECK(batch.qc[i] == doctest::Approx(-0.5 * log2_e * s.conic.c).epsilon(1e-3));
      CHECK(batch.log2_opacity[i] == doctest::Approx(std::log2(cloud.opacity[g])).epsilon(1e-6));
      CHECK(batch.half_width_px[i] == doctest::Approx(s.extent_px.x).epsilon(1e-4));
      CHECK(batch.half_height_px[i] == doctest::Approx(s.extent_px.y).epsilon(1e-4));
      const glm::vec3 ray = glm::normalize(cloud.position[g] - camera.centre_world());
      const glm::vec3 colour = sh_colour(cloud.f_dc[g], cloud.sh_rest_of(g), degree, ray);
      CHECK(batch.red[i] == doctest::Approx(colour.r).epsilon(1e-5));
      CHECK(batch.green[i] == doctest::Approx(colour.g).epsilon(1e-5));
      CHECK(batch.blue[i] == doctest::Approx(colour.b).epsilon(1e-5));
    }
    CHECK(next == batch.size);
    CHECK(next < 253);
  }
}

TEST_CASE("needles that cross many tiles agree with the scalar reference, alone and behind an opaque wall") {
  GaussianCloud cloud = random_cloud(200, 23, 0, 0.02f);
  for (std::size_t g = 0; g < cloud.size(); ++g) cloud.scale[g] = {g % 2 ? 3.0f : 0.4f, 1e-3f, 1e-4f};
  const Camera camera = front_camera();
  const auto worst = [&] {
    const RasterOutput fast = rasterize(cloud, camera), slow = rasterize_reference(cloud, camera);
    float difference = 0;
    for (std::size_t i = 0; i < fast.alpha.size(); ++i)
      difference = std::max(difference, std::abs(fast.alpha.pixels()[i] - slow.alpha.pixels()[i]));
    return difference;
  };
  CHECK(worst() < 1e-3f);
  // More opaque splats in front than are blended at a time: tiles end early, and must end alike.
  const GaussianCloud needles = cloud;
  cloud = random_cloud(2000, 29, 0, 0.4f);
  for (std::size_t g = 0; g < cloud.size(); ++g) cloud.position[g].z = -1.5f, cloud.opacity[g] = 0.6f;
  std::copy(needles.position.begin(), needles.position.end(), cloud.position.begin());
  CHECK(worst() < 1e-3f);
}

TEST_CASE("weights plus remaining transmittance sum to 1") {
  const GaussianCloud cloud = random_cloud(5000, 3, 0, 0.1f);
  const Camera camera = front_camera();
  const Mask everywhere(camera.width_px, camera.height_px, kMaskObject);
  MaskedSums sums(cloud.size());
  RasterOptions options;
  options.sum_mask = &everywhere;
  options.sums = &sums;
  const RasterOutput out = rasterize(cloud, camera, options);
  double weights = 0, opaque = 0;
  for (const std::int64_t units : sums.total)
    weights += static_cast<double>(units) / MaskedSums::kUnitsPerPixel;
  for (const float alpha : out.alpha.pixels()) opaque += alpha;
  CHECK(weights == doctest::Approx(opaque).epsilon(1e-5));
  CHECK(sums.inside == sums.total);
}

TEST_CASE("whole pixels: sums count where a Gaussian shows, however little") {
  // Alpha 0.5 falls below 1/255 at d^2 = 2 ln 127.5 variances; sigma 0.05 at depth 1 is 5 px, its
  // variance 25.3 px^2 with the low-pass.
  const GaussianCloud cloud = single_splat(1, 0.05f, 0.5f, glm::vec3(1));
  const Camera camera = axis_camera();
  std::int64_t expected = 0, expected_left = 0;
  for (int y = 0; y < camera.height_px; ++y)
    for (int x = 0; x < camera.width_px; ++x)
      if ((x - 16) * (x - 16) + (y - 16) * (y - 16) < 2 * std::log(127.5) * 25.3) {
        ++expected;
        expected_left += x < camera.width_px / 2;
      }
  const Mask mask = left_half(camera);
  for (auto* draw :
       {+[](const GaussianCloud&c, const Camera&v, const RasterOptions&o) { rasterize(c, v, o); },
        +[](const GaussianCloud&c, const Camera&v, const RasterOptions&o) {
          rasterize_reference(c, v, o);
        }}) {
    MaskedSums sums(1);
    RasterOptions options;
    options.sum_mask = &mask;
    options.sums = &sums;
    options.sum_whole_pixels = true;
    draw(cloud, camera, options);
    CHECK(sums.total[0] == expected * 65536);
    CHECK(sums.inside[0] == expected_left * 65536);
  }
}

TEST_CASE("same bits on 1, 2, 3 threads and on every SIMD target of this machine") {
  const GaussianCloud cloud = random_cloud(20000, 11, 2, 0.06f);
  const Camera camera = front_camera(317, 203);
  const Mask mask = left_half(camera);
  const auto run = [&](MaskedSums* sums) {
    RasterOptions options = everything();
    options.sum_mask = &mask;
    options.sums = sums;
    return rasterize(cloud, camera, options);
  };
  MaskedSums first_sums(cloud.size());
  const RasterOutput first = run(&first_sums);
  const auto check_same = [&] {
    MaskedSums sums(cloud.size());
    CHECK(same_bits(run(&sums), first));
    CHECK(sums.total == first_sums.total);
    CHECK(sums.inside == first_sums.inside);
  };
  for (const int threads : {1, 2, 3}) {
    CAPTURE(threads);
    tbb::task_arena(threads).execute(check_same);
  }
  for (const auto target : hwy::SupportedAndGeneratedTargets()) {
    CAPTURE(hwy::TargetName(target));
    hwy::SetSupportedTargetsForTest(target);
    check_same();
  }
  hwy::SetSupportedTargetsForTest(0);
}

TEST_CASE("a region of interest holds the same bits as the whole picture, and counts its own pixels only") {
  const GaussianCloud cloud = random_cloud(4000, 5, 1, 0.1f);
  const Camera camera = front_camera();
  RasterOptions options = everything();
  const RasterOutput whole = rasterize(cloud, camera, options);
  options.roi = PixelRect{21, 13, 94, 60};
  const Mask everywhere(camera.width_px, camera.height_px, kMaskObject);
  MaskedSums sums(cloud.size());
  options.sum_mask = &everywhere;
  options.sums = &sums;
  const RasterOutput part = rasterize(cloud, camera, options);
  bool same = true;
  double opaque = 0;
  for (int y = 13; y < 60; ++y)
    for (int x = 21; x < 94; ++x) {
      same = same && part.colour.at(x - 21, y - 13) == whole.colour.at(x, y) &&
             part.first_hit.at(x - 21, y - 13) == whole.first_hit.at(x, y);
      opaque += whole.alpha.at(x, y);
    }
  CHECK(same);
  const double weights =
      static_cast<double>(std::accumulate(sums.total.begin(), sums.total.end(), std::int64_t{0}));
  CHECK(weights / MaskedSums::kUnitsPerPixel == doctest::Approx(opaque).epsilon(1e-5));
}

TEST_CASE("more pairs than fit are drawn region by region, down to single tiles, to the same bits and sums") {
  const GaussianCloud cloud = random_cloud(3000, 5, 1, 0.2f);
  const Camera camera = front_camera();
  const Mask mask = left_half(camera);
  for (const std::optional<PixelRect>& roi :
       {std::optional<PixelRect>(), std::optional(PixelRect{21, 13, 94, 60})}) {
    RasterOptions options = everything();
    options.roi = roi;
    options.sum_mask = &mask;
    MaskedSums whole_sums(cloud.size());
    options.sums = &whole_sums;
    const RasterOutput whole = rasterize(cloud, camera, options);
    const std::size_t pairs = bin_splats(cloud, camera, options, {}).entries.size();
    for (const std::size_t most : {std::size_t{1}, std::size_t{500}, std::size_t{5000}}) {
      CAPTURE(most);
      REQUIRE(most < pairs);
      MaskedSums sums(cloud.size());
      options.sums = &sums;
      options.most_pairs = most;
      CHECK(same_bits(rasterize(cloud, camera, options), whole));
      CHECK(sums.total == whole_sums.total);
      CHECK(sums.inside == whole_sums.inside);
    }
  }
}

TEST_CASE("hidden Gaussians and colour overrides") {
  const GaussianCloud cloud = random_cloud(500, 9, 0, 0.2f);
  const std::vector<std::uint8_t> nothing(cloud.size(), 0);
  RasterOptions options;
  options.shown = nothing;
  const Image<float> empty = rasterize(cloud, front_camera(), options).alpha;
  CHECK(std::ranges::all_of(empty.pixels(), [](float alpha) { return alpha == 0; }));
  const std::vector<glm::vec3> white(cloud.size(), glm::vec3(1));
  options = {};
  options.colour_override = white;
  const RasterOutput out = rasterize(cloud, front_camera(), options);
  for (std::size_t i = 0; i < out.alpha.size(); ++i)
    REQUIRE(out.colour.pixels()[i].g == doctest::Approx(out.alpha.pixels()[i]).epsilon(1e-4));
}

TEST_CASE("an empty cloud, and Gaussians behind the camera, draw the background") {
  RasterOptions options = everything();
  CHECK(rasterize(GaussianCloud{}, front_camera(), options).colour.at(3, 3) == options.background);
  GaussianCloud behind = single_splat(-2, 0.1f, 1, glm::vec3(1));
  CHECK(rasterize(behind, axis_camera(), options).colour.at(16, 16) == options.background);
}

TEST_CASE("sums over planes: those of the slow rasteriser, and of a mask where a plane is one") {
  const GaussianCloud cloud = random_cloud(3000, 8);
  const Camera camera = front_camera();
  RasterOptions options;
  options.colour = false;
  options.roi = PixelRect{20, 10, 110, 70};  // planes are of the region's size, the mask of the picture's
  const Mask mask = left_half(camera);
  std::vector<Image<float>> planes(3, Image<float>(options.roi->width(), options.roi->height(), 1.0f));
  for (int y = 0; y < planes[0].height(); ++y)
    for (int x = 0; x < planes[0].width(); ++x) {
      planes[1].at(x, y) = mask.at(x + options.roi->x0, y + options.roi->y0) ? 1.0f : 0.0f;
      planes[2].at(x, y) = std::sin(0.1f * static_cast<float>(x * y));
    }
  PlaneSums sums(cloud.size(), 3), slow(cloud.size(), 3);
  RasterOptions by_planes = options;
  by_planes.sum_planes = planes;
  by_planes.plane_sums = &sums;
  rasterize(cloud, camera, by_planes);
  by_planes.plane_sums = &slow;
  rasterize_reference(cloud, camera, by_planes);
  MaskedSums masked(cloud.size());
  options.sum_mask = &mask;
  options.sums = &masked;
  rasterize(cloud, camera, options);
  double seen = 0;
  for (std::size_t g = 0; g < cloud.size(); ++g) {
    CHECK(sums.sum[g * 3] == masked.total[g]);
    CHECK(sums.sum[g * 3 + 1] == masked.inside[g]);
    for (std::size_t k = 0; k < 3; ++k) CHECK(std::abs(sums.at(g, k) - slow.at(g, k)) < 0.02);
    seen += std::abs(sums.at(g, 2));
  }
  CHECK(seen > 10);
}

TEST_CASE("rasterizer: what a pixel gets from each group and each Gaussian is what it gets from each alone") {
  constexpr std::uint32_t kGroups = 7;
  constexpr float kListed = 0.01f;
  const GaussianCloud cloud = random_cloud(120, 5, 1, 0.2f);
  const Camera camera = front_camera();
  std::vector<std::uint32_t> group_of(cloud.size());
  for (std::size_t g = 0; g < group_of.size(); ++g)
    group_of[g] = g % 10 == 0 ? kNoGroup : static_cast<std::uint32_t>(g % kGroups);
  RasterOptions options;
  options.colour = false;
  options.least_listed_weight = kListed;
  const auto share_of = [&](const auto& is_meant) {
    std::vector<std::uint8_t> labels(cloud.size());
    for (std::size_t g = 0; g < labels.size(); ++g) labels[g] = is_meant(g);
    RasterOptions alone;
    alone.colour = false;
    alone.labels = labels;
    return rasterize(cloud, camera, alone).label_share;
  };
  options.groups = group_of;
  const Image<std::uint32_t> group = rasterize(cloud, camera, options).group;
  options.colour = true;  // in one pass: the same bits
  const RasterOutput both = rasterize(cloud, camera, options);
  CHECK(both.group == group);
  CHECK(both.colour == rasterize(cloud, camera).colour);
  options.colour = false;
  options.groups = {};
  options.list_gaussians = true;
  const ListedWeights lists = rasterize(cloud, camera, options).gaussians;
  std::vector<Image<float>> of_group, of_gaussian;
  for (std::uint32_t k = 0; k < kGroups; ++k)
    of_group.push_back(share_of([&](std::size_t g) { return group_of[g] == k; }));
  for (std::size_t i = 0; i < cloud.size(); ++i)
    of_gaussian.push_back(share_of([&](std::size_t g) { return g == i; }));
  std::size_t shown = 0, listed = 0;
  for (std::size_t pixel = 0; pixel < group.size(); ++pixel) {
    std::vector<GroupWeight> weights;
    for (std::uint32_t k = 0; k < kGroups; ++k)
      if (const float w = of_group[k].pixels()[pixel]; w >= kListed) weights.push_back({k, w});
    std::ranges::stable_sort(weights, std::ranges::greater(), &GroupWeight::weight);
    CHECK(group.pixels()[pixel] == group_of_pixel(weights));
    shown += group.pixels()[pixel] != kNoGroup;
    std::vector<float> expected(cloud.size()), got(cloud.size());
    for (std::size_t g = 0; g < cloud.size(); ++g)
      if (const float w = of_gaussian[g].pixels()[pixel]; w >= kListed) expected[g] = w;
    for (const GroupWeight& w : lists.of.pixels()[pixel]) got[w.group] = w.weight;
    CHECK(got == expected);
    listed += lists.of.pixels()[pixel].size();
  }
  CHECK(shown > 100);
  CHECK(listed > 500);
}
