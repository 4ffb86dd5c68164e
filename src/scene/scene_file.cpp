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
        fmt::format("none of the {} Gaussians is usable: each has NaN or a zero rotation", scene.file_rows));
  scene.cloud.near_plane = natural_near_plane(scene.cloud.position);
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
  report.bytes = static_cast<std::uint64_t>(std::ftell(out.stream()));
  out.commit();
  return report;
}

}  // namespace splatcut
