// Runs of Gaussians that a view does not show, left out: the picture stays as it is.
#include "scene/raster/block_view.h"

#include <doctest/doctest.h>

#include <algorithm>

#include "core/counter_rng.h"
#include "scene/cloud/morton.h"
#include "synthetic_cloud.h"

using namespace splatcut;
using namespace splatcut::testing;

namespace {

GaussianCloud sorted_cloud(std::size_t n, unsigned seed) {
  const GaussianCloud cloud = random_cloud(n, seed, 0, 0.02f);
  return permuted(cloud, morton_order(cloud.position));
}

Camera random_camera(CounterRng* rng) {
  const auto between = [&](float reach) {
    return glm::vec3(rng->between(-reach, reach), rng->between(-reach, reach), rng->between(-reach, reach));
  };
  return look_at(between(2), between(1), {0, -1, 0}, rng->between(0.2f, 1.5f), 90, 70);
}

}  // namespace

TEST_CASE("blocks: pictures and sums are the same bits with and without them, from within and from outside") {
  const GaussianCloud cloud = sorted_cloud(20000, 31);
  const CloudBlocks blocks(cloud);
  CounterRng rng(7, 1);
  std::size_t passed_over = 0, shown = 0;
  for (int i = 0; i < 60; ++i) {
    CAPTURE(i);
    const Camera camera = random_camera(&rng);
    const Mask mask(camera.width_px, camera.height_px, kMaskObject);
    const auto draw = [&](const CloudBlocks* by) {
      MaskedSums sums(cloud.size());
      RasterOptions options;
      options.depth = true;
      options.blocks = by;
      options.sum_mask = &mask;
      options.sums = &sums;
      options.near_plane = i % 2 ? 0.01f : 0.3f;
      if (i % 3 == 0) options.roi = PixelRect{20, 10, 40, 30};
      return std::pair(rasterize(cloud, camera, options), std::move(sums));
    };
    const auto [all, all_sums] = draw(nullptr);
    const auto [some, some_sums] = draw(&blocks);
    REQUIRE(std::ranges::equal(all.colour.pixels(), some.colour.pixels()));
    REQUIRE(std::ranges::equal(all.first_hit.pixels(), some.first_hit.pixels()));
    REQUIRE(all_sums.total == some_sums.total);
    shown += static_cast<std::size_t>(std::ranges::count_if(all_sums.total, [](auto t) { return t > 0; }));
    const BlockView view(camera, 0.01f, kLowPassPx2, {0, 0, camera.width_px, camera.height_px});
    passed_over += static_cast<std::size_t>(
        std::ranges::count_if(blocks.blocks(), [&](const CloudBlock& b) { return !view.may_show(b); }));
  }
  CHECK(shown > 10000);
  CHECK(passed_over > 60 * blocks.blocks().size() / 8);
}

TEST_CASE("blocks: the Gaussians of a box are those of a search through all") {
  const GaussianCloud cloud = sorted_cloud(5003, 32);
  const CloudBlocks blocks(cloud);
  CounterRng rng(8, 1);
  for (int i = 0; i < 50; ++i) {
    const glm::vec3 at(rng.between(-1, 1), rng.between(-1, 1), rng.between(-1, 1));
    const Box box{at - rng.between(0, 1), at + rng.between(0, 1)};
    std::vector<std::uint32_t> expected;
    for (std::uint32_t g = 0; g < cloud.size(); ++g)
      if (contains(box, cloud.position[g])) expected.push_back(g);
    CHECK(blocks.rows_in(cloud, box) == expected);
    CHECK(blocks.count_in(cloud, box) == expected.size());
  }
}
