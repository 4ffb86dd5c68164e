// The neighbour graph of a still life of a million Gaussians and the capacities of its arcs.
#include <benchmark/benchmark.h>

#include "bench_scenes.h"
#include "segment/graphcut/energy.h"
#include "segment/graphcut/knn_graph.h"

namespace splatcut::bench {

namespace {

constexpr std::size_t kGaussians = 1'000'000;

const FlowGraph& graph() {
  static const FlowGraph made = knn_graph(still_life(kGaussians).cloud);
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

void slow_stage(benchmark::internal::Benchmark* bench) {
  bench->Unit(benchmark::kMillisecond)->UseRealTime()->MeasureProcessCPUTime();
}

BENCHMARK(build_knn_graph)->Apply(slow_stage);
BENCHMARK(weigh_arcs)->Apply(slow_stage);

}  // namespace

}  // namespace splatcut::bench
