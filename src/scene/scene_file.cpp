#include "scene/scene_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>

#include "scene/atomic_file.h"
#include "scene/error.h"
#include "scene/foreign_files.h"
#include "scene/mapped_file.h"

namespace splatcut {

namespace {

// The content decides among files that carry a mark; the name is needed for those without.
SceneFormat format_of(const MappedFile& file) {
  for (const SceneFormat& format : scene_formats())
    if (format.recognises && format.recognises(file)) return format;
  refuse_foreign(file);
  return format_from_name(file.path());
}

// A folder stands for the scene of several files in it.
std::filesystem::path in_folder(const std::filesystem::path& path) {
  std::error_code ignored;
  const std::filesystem::path meta = path / "meta.json";
  return std::filesystem::is_directory(path, ignored) && std::filesystem::exists(meta, ignored) ? meta : path;
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

const char* name_of(SpzAxes axes) {
  return axes == SpzAxes::kPly ? "ply" : "rub";
}

std::optional<SpzAxes> spz_axes_from_name(std::string_view name) {
  for (const SpzAxes axes : {SpzAxes::kRub, SpzAxes::kPly})
    if (name == name_of(axes)) return axes;
  return {};
}

Scene load_scene(const std::filesystem::path& path, const LoadOptions& options, const Job& job) {
  const MappedFile file(in_folder(path));
  Scene scene;
  scene.path = file.path();
  scene.format = format_of(file);
  scene.file_bytes = file.bytes().size();
  scene.modified_ns = file.modified_ns();
  scene.format.read(file, options, scene, job);
  if (!job.cancelled() && scene.cloud.empty())
    throw Error(
        path.string(),
        fmt::format("none of the {} Gaussians is usable: each has NaN, a zero rotation, or lies beyond 1e15",
                    scene.file_rows));
  scene.cloud.near_plane = natural_near_plane(scene.cloud.position);
  if (!job.cancelled()) check_size(scene);
  return scene;
}

Scene load_scene(const std::filesystem::path& path, const Job& job) {
  return load_scene(path, LoadOptions{}, job);
}

SaveReport save_scene(const std::filesystem::path& path, const Scene& scene,
                      std::span<const std::uint8_t> keep, const SceneFormat& format,
                      const SaveOptions& options) {
  if (!format.write)
    throw Error(path.string(), fmt::format("{} is only read, not written", format.extension),
                "Choose " + spoken_extensions(written_formats(), "or"));
  const std::vector<std::uint32_t> kept = kept_in_file_order(scene.cloud, keep);
  if (kept.empty())
    throw Error(path.string(), "nothing is selected: a scene without Gaussians is not written");
  AtomicFile out(path);
  SaveReport report;
  report.gaussians = kept.size();
  report.loss = format.write(out, scene, kept, options);
  report.bytes = out.bytes_written();
  out.commit();
  return report;
}

}  // namespace splatcut
