// Loading of a .ply of a million Gaussians of SH degree 3, beside reading the same file through a pipe.
#include <benchmark/benchmark.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <stdexcept>
#include <string>

#include "scene/formats/scene_file.h"
#include "scene/still_life/still_life.h"

namespace splatcut::bench {

namespace {

// A file in the folder for temporary files that goes when the program ends.
class LargePly {
 public:
  LargePly()
      : path_(std::filesystem::temp_directory_path() /
              ("splatcut_bench_" + std::to_string(::getpid()) + ".ply")) {
    StillLifeOptions options;
    options.gaussians = 1'000'000;
    options.sh_degree = 3;
    Scene scene;
    scene.cloud = make_still_life(options).cloud;
    for (std::size_t g = 0; g < scene.cloud.size(); ++g)
      scene.cloud.file_row[g] = static_cast<std::uint32_t>(g);
    save_scene(path_, scene, {}, SceneFormat::kPly);
  }
  LargePly(const LargePly&) = delete;
  LargePly& operator=(const LargePly&) = delete;
  ~LargePly() {
    std::error_code ignored;
    std::filesystem::remove(path_, ignored);
  }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

const std::filesystem::path& large_ply() {
  static const LargePly file;
  return file.path();
}

void count_bytes(benchmark::State& state) {
  state.SetBytesProcessed(state.iterations() *
                          static_cast<std::int64_t>(std::filesystem::file_size(large_ply())));
}

void load_ply(benchmark::State& state) {
  load_scene(large_ply());  // the first time, the system still gathers large pages
  for (auto _ : state) benchmark::DoNotOptimize(load_scene(large_ply()).cloud.size());
  count_bytes(state);
}

// The yardstick: what the disk cache gives.
void read_through_pipe(benchmark::State& state) {
  const std::string command = "cat '" + large_ply().string() + "' | cat >/dev/null";
  for (auto _ : state)
    if (std::system(command.c_str()) != 0) throw std::runtime_error(command + " failed");
  count_bytes(state);
}

BENCHMARK(load_ply)->Unit(benchmark::kMillisecond)->UseRealTime()->MeasureProcessCPUTime();
BENCHMARK(read_through_pipe)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace

}  // namespace splatcut::bench
