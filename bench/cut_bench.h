#pragma once

namespace splatcut::bench {

// The cut on still lifes of 0.2 to 5 M Gaussians, and on the suite named by the environment variable
// SPLATCUT_BENCH_SUITE, if it is set.
void register_cut_benchmarks();

}  // namespace splatcut::bench
