#include "scene/cloud/coarse_cloud.h"

#include <doctest/doctest.h>
#include <tbb/global_control.h>

#include <set>

#include "core/picture_difference.h"
#include "core/png_file.h"
#include "scene/cloud/morton.h"
#include "scene/raster/rasterizer.h"
#include "scene/still_life/still_life.h"
#include "synthetic_cloud.h"

using namespace splatcut;
using namespace splatcut::testing;

namespace {

// A row of `n` small discs a sigma apart, in the plane z = 0, and one far Gaussian that makes them small.
GaussianCloud row_of_discs(std::size_t n, float sigma) {
  GaussianCloud cloud;
  cloud.resize(n + 1, 0);
  for (std::size_t g = 0; g < n; ++g) {
    cloud.position[g] = {sigma * static_cast<float>(g), 0, 0};
    cloud.scale[g] = {sigma, sigma, 0.1f * sigma};
    cloud.rotation[g] = {1, 0, 0, 0};
    cloud.opacity[g] = 0.5f;
  }
  cloud.position[n] = {1000, 0, 0};
  cloud.scale[n] = glm::vec3(50);
  cloud.rotation[n] = {1, 0, 0, 0};
  cloud.opacity[n] = 0.5f;
  return cloud;
}

}  // namespace

TEST_CASE("coarse: eight equal discs become one of eight times the area in their middle") {
  // The bounds must be the far Gaussian's: without it nothing counts as small.
  GaussianCloud fine = row_of_discs(8, 0.01f);
  for (int i = 0; i < 8; ++i)
    fine.f_dc[static_cast<std::size_t>(i)] = glm::vec3(0.05f * static_cast<float>(i));
  const CoarseCloud coarse = coarse_cloud(fine);
  REQUIRE(coarse.cloud.size() == 2);
  CHECK(coarse.cloud.position[0].x == doctest::Approx(0.035));
  CHECK(coarse.cloud.f_dc[0].x == doctest::Approx(0.175));
  CHECK(coarse.cloud.scale[0].x * coarse.cloud.scale[0].y == doctest::Approx(8 * 0.01 * 0.01));
  CHECK(coarse.cloud.scale[0].z == doctest::Approx(0.001));
  CHECK(coarse.cloud.opacity[0] == 0.5f);
  CHECK(coarse.stands_for[0] < 8);
  CHECK(coarse.stands_for[1] == 8);
}

TEST_CASE("coarse: another colour, a far one, and a much smaller one are kept as they are") {
  GaussianCloud fine = row_of_discs(8, 0.01f);
  fine.f_dc[1] = {2, 0, 0};
  fine.position[3] = {0, 5, 0};
  fine.scale[5] = {0.001f, 0.001f, 0.0001f};
  const CoarseCloud coarse = coarse_cloud(fine);
  const std::set<std::uint32_t> kept(coarse.stands_for.begin(), coarse.stands_for.end());
  for (const std::uint32_t g : {1u, 3u, 5u, 8u}) CHECK(kept.contains(g));
  CHECK(coarse.cloud.size() == 5);
}

TEST_CASE("coarse: nothing is made once it is cancelled") {
  std::stop_source stop;
  stop.request_stop();
  CHECK(coarse_cloud(random_cloud(5000, 1), {stop.get_token(), {}}).cloud.size() == 0);
}

TEST_CASE("coarse: a still life keeps its look, and the same bits on any number of threads") {
  StillLifeOptions options;
  options.gaussians = 300000;
  const LabelledScene scene = make_still_life(options);
  const GaussianCloud cloud = permuted(scene.cloud, morton_order(scene.cloud.position));
  const CoarseCloud coarse = coarse_cloud(cloud);
  CHECK(coarse.cloud.size() < cloud.size() * 7 / 10);
  const Camera camera = resized(scene.cameras.front(), 320, 240);
  const PictureDifference d = picture_difference(rgb8_from_linear(rasterize(cloud, camera).colour),
                                                 rgb8_from_linear(rasterize(coarse.cloud, camera).colour));
  MESSAGE("300 k: " << coarse.cloud.size() << " left, PSNR " << d.psnr_db << " dB");
  CHECK(d.psnr_db > 30);
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const CoarseCloud again = coarse_cloud(cloud);
  CHECK(again.stands_for == coarse.stands_for);
  CHECK(again.cloud.position == coarse.cloud.position);
  CHECK(again.cloud.scale == coarse.cloud.scale);
  CHECK(again.cloud.f_dc == coarse.cloud.f_dc);
}
