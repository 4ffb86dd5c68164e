// Frames at 1280x720: scene x thousand Gaussians x threads x masked sums.
#include "rasterizer_bench.h"

#include <benchmark/benchmark.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cstdlib>
#include <vector>

#include "bench_scenes.h"
#include "scene/raster/rasterizer.h"
#include "scene/raster/tile_grid.h"

namespace splatcut::bench {

namespace {

// The middle ninth of the picture.
Mask middle_of(const Camera& camera) {
  Mask mask(camera.width_px, camera.height_px);
  for (int y = mask.height() / 3; y < 2 * mask.height() / 3; ++y)
    for (int x = mask.width() / 3; x < 2 * mask.width() / 3; ++x) mask.at(x, y) = kMaskObject;
  return mask;
}

void draw(benchmark::State& state, const BenchScene& scene, int threads, bool with_sums) {
  const Mask mask = middle_of(scene.view);
  MaskedSums sums(scene.cloud.size());
  RasterOptions options;
  if (with_sums) {
    options.sum_mask = &mask;
    options.sums = &sums;
  }
  RasterOutput out;
  tbb::task_arena arena(threads);
  for (auto _ : state) arena.execute([&] { out = rasterize(scene.cloud, scene.view, options); });
  const TileGrid grid = bin_splats(scene.cloud, scene.view, options, {});
  state.counters["pairs"] = static_cast<double>(grid.entries.size());
}

void rasterize_still_life(benchmark::State& state) {
  draw(state, still_life(static_cast<std::size_t>(state.range(0)) * 1000), static_cast<int>(state.range(1)),
       state.range(2) != 0);
}

void rasterize_volume(benchmark::State& state) {
  draw(state, volume(static_cast<std::size_t>(state.range(0)) * 1000), static_cast<int>(state.range(1)),
       state.range(2) != 0);
}

void rasterize_file(benchmark::State& state) {
  draw(state, scene_from_file(std::getenv("SPLATCUT_BENCH_SCENE")), static_cast<int>(state.range(0)),
       state.range(1) != 0);
}

// On a machine with other work, the least of some repetitions says most.
double least(const std::vector<double>& times) {
  return *std::ranges::min_element(times);
}

benchmark::internal::Benchmark* measured(benchmark::internal::Benchmark* bench) {
  return bench->Unit(benchmark::kMillisecond)
      ->UseRealTime()
      ->MeasureProcessCPUTime()
      ->ComputeStatistics("min", least);
}

void sizes(benchmark::internal::Benchmark* bench) {
  measured(bench)->ArgNames({"thousand", "threads", "sums"})->ArgsProduct({{100, 500, 1000}, {1, 2}, {0, 1}});
}

BENCHMARK(rasterize_still_life)->Apply(sizes);
BENCHMARK(rasterize_volume)->Apply(sizes);

}  // namespace

void register_file_benchmark() {
  if (!std::getenv("SPLATCUT_BENCH_SCENE")) return;
  measured(benchmark::RegisterBenchmark("rasterize_file", rasterize_file))
      ->ArgNames({"threads", "sums"})
      ->ArgsProduct({{1, 2}, {0, 1}});
}

}  // namespace splatcut::bench
