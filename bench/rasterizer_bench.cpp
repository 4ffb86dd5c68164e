// Frames of a synthetic cloud at 1280x720: Gaussians x threads x masked sums.
#include <benchmark/benchmark.h>
#include <tbb/global_control.h>

#include "scene/morton.h"
#include "scene/rasterizer.h"
#include "synthetic_cloud.h"

using namespace splatcut;

namespace {

const GaussianCloud& cloud_of(std::size_t n) {
  static std::map<std::size_t, GaussianCloud> clouds;
  auto [it, fresh] = clouds.try_emplace(n);
  if (fresh) {
    // Splat size falls with the count, as in a trained scene: the same surface, described more finely.
    const GaussianCloud cloud = testing::random_cloud(n, 1, 1, 0.05f * std::pow(1e5f / static_cast<float>(n), 0.45f));
    it->second = permuted(cloud, morton_order(cloud.position));
  }
  return it->second;
}

void rasterize_frame(benchmark::State& state) {
  const GaussianCloud& cloud = cloud_of(static_cast<std::size_t>(state.range(0)) * 1000);
  const tbb::global_control threads(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(state.range(1)));
  const Camera camera = testing::front_camera(1280, 720);
  Mask mask(camera.width_px, camera.height_px);
  for (int y = 200; y < 500; ++y)
    for (int x = 400; x < 800; ++x) mask.at(x, y) = kMaskObject;
  MaskedSums sums(cloud.size());
  RasterOptions options;
  if (state.range(2)) {
    options.sum_mask = &mask;
    options.sums = &sums;
  }
  for (auto _ : state) benchmark::DoNotOptimize(rasterize(cloud, camera, options).alpha.data());
}

}  // namespace

BENCHMARK(rasterize_frame)
    ->ArgNames({"thousand", "threads", "sums"})
    ->ArgsProduct({{100, 500, 1000}, {1, 2}, {0, 1}})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime()
    ->MeasureProcessCPUTime();

BENCHMARK_MAIN();
