// The neighbour graph and the exact cut of a still life of a million Gaussians.
#include <benchmark/benchmark.h>

#include <algorithm>

#include "bench_scenes.h"
#include "segment/cut.h"
#include "segment/knn_graph.h"

namespace splatcut::bench {

namespace {

constexpr std::size_t kGaussians = 1'000'000;
constexpr std::size_t kViews = 12;

const FlowGraph& graph() {
  static const FlowGraph made = knn_graph(still_life(kGaussians).cloud);
  return made;
}

Mask true_mask(const BenchScene& scene, const Camera& camera) {
  std::vector<glm::vec3> white;
  for (const std::uint8_t is_mug : scene.mug) white.emplace_back(is_mug);
  RasterOptions options;
  options.colour_override = white;
  const RasterOutput out = rasterize(scene.cloud, camera, options);
  Mask mask(camera.width_px, camera.height_px);
  for (std::size_t i = 0; i < mask.size(); ++i)
    mask.pixels()[i] = out.colour.pixels()[i].r > 0.5f ? kMaskObject : 0;
  return mask;
}

// What true masks of the mug in twelve views say of each Gaussian.
const Likelihood& mug_likelihood() {
  static const Likelihood made = [] {
    const BenchScene& scene = still_life(kGaussians);
    MaskedSums sums(scene.cloud.size());
    for (std::size_t v = 0; v < kViews; ++v) {
      const Mask mask = true_mask(scene, scene.cameras[v]);
      RasterOptions options;
      options.colour = false;
      options.sum_mask = &mask;
      options.sums = &sums;
      rasterize(scene.cloud, scene.cameras[v], options);
    }
    return likelihood(sums);
  }();
  return made;
}

void build_knn_graph(benchmark::State& state) {
  const GaussianCloud& cloud = still_life(kGaussians).cloud;
  for (auto _ : state) benchmark::DoNotOptimize(knn_graph(cloud).arcs());
}

void weigh_arcs(benchmark::State& state) {
  const GaussianCloud& cloud = still_life(kGaussians).cloud;
  const FlowGraph& edges = graph();
  for (auto _ : state) benchmark::DoNotOptimize(arc_capacities(cloud, edges, {}).data());
}

// The solve of the whole graph, its capacities given: what moving the smoothness slider costs.
void cut_whole_graph(benchmark::State& state) {
  const BenchScene& scene = still_life(kGaussians);
  const Camera& camera = scene.cameras.front();
  const double pixels = static_cast<double>(camera.width_px) * camera.height_px;
  const std::vector<std::int32_t> capacity = arc_capacities(scene.cloud, graph(), {});
  CutReport report;
  for (auto _ : state)
    report =
        cut_object(scene.cloud, graph(), capacity, mug_likelihood(), static_cast<int>(kViews), pixels, {});
  state.counters["arcs"] = static_cast<double>(report.arcs);
  state.counters["object"] = static_cast<double>(std::count(report.labels.begin(), report.labels.end(), 1));
}

void slow_stage(benchmark::internal::Benchmark* bench) {
  bench->Unit(benchmark::kMillisecond)->UseRealTime()->MeasureProcessCPUTime();
}

BENCHMARK(build_knn_graph)->Apply(slow_stage);
BENCHMARK(weigh_arcs)->Apply(slow_stage);
BENCHMARK(cut_whole_graph)->Apply(slow_stage);

}  // namespace

}  // namespace splatcut::bench
