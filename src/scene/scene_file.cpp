#include "scene/scene_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>

#include "scene/error.h"
#include "scene/scene_formats.h"

namespace splatcut {

namespace {

bool begins_with(const MappedFile& file, std::string_view magic) {
  const std::string_view text(reinterpret_cast<const char*>(file.bytes().data()), file.bytes().size());
  return text.starts_with(magic);
}

// The content decides among files that carry a mark; the name is needed for .splat, which has none.
SceneFormat format_of(const MappedFile& file) {
  if (begins_with(file, "ply\n") || begins_with(file, "ply\r\n"))
    return is_compressed_ply(file) ? SceneFormat::kCompressedPly : SceneFormat::kPly;
  constexpr std::string_view kGzip = "\x1f\x8b";
  if (begins_with(file, "NGSP") || begins_with(file, kGzip)) return SceneFormat::kSpz;
  return format_from_name(file.path());
}

std::vector<std::uint32_t> kept_in_file_order(const GaussianCloud& cloud,
                                              std::span<const std::uint8_t> keep) {
  assert(keep.empty() || keep.size() == cloud.size());
  std::vector<std::uint32_t> kept;
  for (std::size_t g = 0; g < cloud.size(); ++g)
    if (keep.empty() || keep[g]) kept.push_back(static_cast<std::uint32_t>(g));
  std::ranges::sort(kept, {}, [&](std::uint32_t g) { return cloud.file_row[g]; });
  return kept;
}

std::string write_scene(AtomicFile& out, const Scene& scene, std::span<const std::uint32_t> kept,
                        SceneFormat format) {
  switch (format) {
    case SceneFormat::kPly:
      if (scene.format != SceneFormat::kPly || scene.path.empty()) return write_ply(out, scene.cloud, kept);
      write_ply_subset(out, scene, kept);
      return {};
    case SceneFormat::kCompressedPly:
      return write_compressed_ply(out, scene.cloud, kept);
    case SceneFormat::kSplat:
      return write_splat(out, scene.cloud, kept);
    case SceneFormat::kSpz:
      return write_spz(out, scene.cloud, kept);
  }
  return {};
}

// Beyond, squares of lengths leave the range of numbers.
void check_size(const Scene& scene) {
  constexpr float kSmallest = 1e-12f, kLargest = 1e12f;
  const Box box = robust_bounds(scene.cloud.position);
  const glm::vec3 far = glm::max(glm::abs(box.min), glm::abs(box.max));
  const float size = glm::length(box.extent());
  const bool small = size > 0 && size < kSmallest;
  if (small || !(std::max({far.x, far.y, far.z}) < kLargest))
    throw Error(scene.path.string(),
                small ? fmt::format("the scene is only {:g} units wide", size)
                      : fmt::format("coordinates go up to {:g}", std::max({far.x, far.y, far.z})),
                fmt::format("Scale it: lengths from {:g} to {:g} units can be handled", kSmallest, kLargest));
}

}  // namespace

const char* name_of(SceneFormat format) {
  switch (format) {
    case SceneFormat::kPly:
      return "ply";
    case SceneFormat::kCompressedPly:
      return "compressed.ply";
    case SceneFormat::kSplat:
      return "splat";
    case SceneFormat::kSpz:
      return "spz";
  }
  return "unknown";
}

SceneFormat format_from_name(const std::filesystem::path& path) {
  std::string name = path.filename().string();
  std::ranges::transform(name, name.begin(), [](unsigned char c) { return std::tolower(c); });
  if (name.ends_with(".compressed.ply")) return SceneFormat::kCompressedPly;
  if (name.ends_with(".ply")) return SceneFormat::kPly;
  if (name.ends_with(".splat")) return SceneFormat::kSplat;
  if (name.ends_with(".spz")) return SceneFormat::kSpz;
  throw Error(path.string(), "the file extension is none of .ply, .compressed.ply, .splat and .spz");
}

Scene load_scene(const std::filesystem::path& path, const Job& job) {
  const MappedFile file(path);
  Scene scene;
  scene.path = path;
  scene.format = format_of(file);
  scene.file_bytes = file.bytes().size();
  scene.modified_ns = file.modified_ns();
  switch (scene.format) {
    case SceneFormat::kPly:
      read_ply(file, scene, job);
      break;
    case SceneFormat::kCompressedPly:
      read_compressed_ply(file, scene, job);
      break;
    case SceneFormat::kSplat:
      read_splat(file, scene, job);
      break;
    case SceneFormat::kSpz:
      read_spz(file, scene, job);
      break;
  }
  if (!job.cancelled() && scene.cloud.empty())
    throw Error(
        path.string(),
        fmt::format("none of the {} Gaussians is usable: each has NaN, a zero rotation, or lies beyond 1e15",
                    scene.file_rows));
  scene.cloud.near_plane = natural_near_plane(scene.cloud.position);
  if (!job.cancelled()) check_size(scene);
  return scene;
}

SaveReport save_scene(const std::filesystem::path& path, const Scene& scene,
                      std::span<const std::uint8_t> keep, SceneFormat format) {
  const std::vector<std::uint32_t> kept = kept_in_file_order(scene.cloud, keep);
  if (kept.empty())
    throw Error(path.string(), "nothing is selected: a scene without Gaussians is not written");
  AtomicFile out(path);
  SaveReport report;
  report.gaussians = kept.size();
  report.loss = write_scene(out, scene, kept, format);
  report.bytes = out.bytes_written();
  out.commit();
  return report;
}

}  // namespace splatcut
