#pragma once

namespace splatcut::bench {

// Frames of the scene named by the environment variable SPLATCUT_BENCH_SCENE, if it is set.
void register_file_benchmark();

}  // namespace splatcut::bench
