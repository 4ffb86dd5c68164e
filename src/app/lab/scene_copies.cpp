#include "app/lab/scene_copies.h"

#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <bit>
#include <filesystem>
#include <numeric>
#include <span>
#include <utility>

#include "core/counter_rng.h"
#include "core/error.h"

namespace splatcut {

namespace {

constexpr float kShareOfSize = 0.01f;

// Removes its file.
class TemporaryFile {
 public:
  explicit TemporaryFile(const std::string& ending) {
    std::string name = (std::filesystem::temp_directory_path() / "splatcut_copy_XXXXXX").string() + ending;
    const int file = ::mkstemps(name.data(), static_cast<int>(ending.size()));
    if (file < 0) throw Error(name, "cannot be created");
    ::close(file);
    path_ = name;
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  ~TemporaryFile() {
    std::error_code ignored;
    std::filesystem::remove(path_, ignored);
  }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

// To 12 significant bits, half of the last one added first.
float rounded(float value) {
  constexpr std::uint32_t kDropped = 12;
  const auto bits = std::bit_cast<std::uint32_t>(value);
  return std::bit_cast<float>((bits + (1u << (kDropped - 1))) & ~((1u << kDropped) - 1));
}

void round_numbers(GaussianCloud* cloud) {
  const auto round_all = [](float* values, std::size_t n) {
    for (float& v : std::span(values, n)) v = rounded(v);
  };
  round_all(&cloud->position.front().x, 3 * cloud->size());
  round_all(&cloud->scale.front().x, 3 * cloud->size());
  round_all(cloud->opacity.data(), cloud->size());
  round_all(&cloud->f_dc.front().x, 3 * cloud->size());
  if (!cloud->sh_rest.empty()) round_all(cloud->sh_rest.data(), cloud->sh_rest.size());
}

void move_splats(std::uint64_t draw, GaussianCloud* cloud) {
  for (std::size_t g = 0; g < cloud->size(); ++g)
    cloud->position[g] +=
        kShareOfSize * (cloud->rotation[g] * (cloud->scale[g] * CounterRng(draw, g).in_ball()));
}

std::vector<std::uint32_t> shuffled_rows(std::size_t n, std::uint64_t draw) {
  std::vector<std::uint32_t> rows(n);
  std::iota(rows.begin(), rows.end(), 0u);
  CounterRng random(draw, 0x5467);
  for (std::size_t i = n; i > 1; --i) std::swap(rows[i - 1], rows[random.below(i)]);
  return rows;
}

// A scene with no file behind it: every row is written from the cloud.
Scene of_cloud(GaussianCloud cloud) {
  Scene scene;
  scene.format = SceneFormat::kSplat;
  scene.cloud = std::move(cloud);
  scene.file_rows = scene.cloud.size();
  scene.cloud.file_row.resize(scene.cloud.size());
  std::iota(scene.cloud.file_row.begin(), scene.cloud.file_row.end(), 0u);
  return scene;
}

Scene through_file(const Scene& scene, const std::string& ending, const Job& job) {
  const TemporaryFile file(ending);
  save_scene(file.path(), scene, {}, output_format_from_name(file.path()));
  return load_scene(file.path(), job);
}

}  // namespace

SceneCopy scene_copy(const Scene& original, int number, const Job& job) {
  constexpr std::array kFormats = {".ply", ".compressed.ply", ".splat", ".spz"};
  constexpr int kCount = static_cast<int>(kFormats.size());
  const auto draw = static_cast<std::uint64_t>(number + 1);
  SceneCopy copy;
  GaussianCloud cloud = original.cloud;
  std::vector<std::uint32_t> rows;  // of the copy's file: the original's Gaussians; empty: in their order
  std::string ending = ".ply";
  if (number < kCount) {
    ending = kFormats[static_cast<std::size_t>(number)];
    copy.name = number == 0 ? "rounded .ply" : ending;
    if (number == 0) round_numbers(&cloud);
  } else if ((number - kCount) % 2 == 0) {
    copy.name = fmt::format("shuffled rows, draw {}", draw);
    rows = shuffled_rows(cloud.size(), draw);
    cloud = permuted(cloud, rows);
  } else {
    copy.name = fmt::format("splats moved, draw {}", draw);
    move_splats(draw, &cloud);
  }
  copy.scene = through_file(of_cloud(std::move(cloud)), ending, job);
  copy.origin = copy.scene.cloud.file_row;
  if (!rows.empty())
    for (std::uint32_t& row : copy.origin) row = rows[row];
  return copy;
}

}  // namespace splatcut
