// Runs the benchmarks; docs/benchmarks.md has the commands. SPLATCUT_BENCH_SCENE=FILE adds the rasteriser on
// that file.
#include <benchmark/benchmark.h>

#include "cut_bench.h"
#include "rasterizer_bench.h"

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  splatcut::bench::register_file_benchmark();
  splatcut::bench::register_cut_benchmarks();
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}
