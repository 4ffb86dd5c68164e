#include "scene/formats/scene_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <charconv>

#include "core/atomic_file.h"
#include "core/error.h"
#include "core/lower_case.h"
#include "core/mapped_file.h"
#include "core/spoken_list.h"
#include "scene/cloud/scene_memory.h"
#include "scene/formats/far_origin.h"
#include "scene/formats/foreign_files.h"

namespace splatcut {

namespace {

// The content decides among files that carry a mark; the name is needed for those without.
SceneFormat format_of(const MappedFile& file) {
  if (begins_with(file, "PK\x03\x04")) refuse_foreign(file);  // packages of others, by their names
  for (const SceneFormat& format : scene_formats())
    if (format.recognises && format.recognises(file)) return format;
  refuse_foreign(file);
  return input_format_from_name(file.path());
}

// What is said of a folder that is no scene: files in it that may be one, the first few by their names.
[[noreturn]] void refuse_folder(const std::filesystem::path& folder, std::vector<std::string> scenes) {
  constexpr std::size_t kMostNamed = 3;
  std::ranges::sort(scenes);
  const std::size_t named = std::min(scenes.size(), kMostNamed);
  std::string names;
  for (std::size_t i = 0; i < named; ++i) names += (i > 0 ? ", " : "") + scenes[i];
  if (scenes.size() > named) names += fmt::format(" and {} more", scenes.size() - named);
  if (!scenes.empty())
    throw Error(folder.string(), "this folder is no scene by itself", "Give a file. It holds " + names);
  throw Error(folder.string(), "this folder holds no scene",
              "Give a scene file, or a folder with meta.json, lod-meta.json, .lcc or .lcc2");
}

// The last iteration of a trainer's folder, point_cloud/iteration_N/point_cloud.ply, or an empty path.
std::filesystem::path last_iteration(const std::filesystem::path& folder) {
  constexpr std::string_view kIteration = "iteration_";
  std::filesystem::path last;
  unsigned long last_number = 0;
  std::error_code trouble;
  for (std::filesystem::directory_iterator at(folder / "point_cloud", trouble), end; !trouble && at != end;
       at.increment(trouble)) {
    const std::string name = at->path().filename().string();
    const std::filesystem::path scene = at->path() / "point_cloud.ply";
    std::error_code ignored;
    if (!name.starts_with(kIteration) || !std::filesystem::is_regular_file(scene, ignored)) continue;
    unsigned long number = 0;
    std::from_chars(name.data() + kIteration.size(), name.data() + name.size(), number);
    if (last.empty() || number > last_number) last = scene;
    last_number = std::max(last_number, number);
  }
  return last;
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

// Each of them is in every tile of every picture, so that a scene of many takes its time; a sky is a few.
std::string oddity_of(const GaussianCloud& cloud) {
  constexpr float kManySizes = 1, kManyShare = 0.05f, kFaint = 1.0f / 255;
  const auto share = [&](const auto& is) {
    std::size_t count = 0;
    for (std::size_t g = 0; g < cloud.size(); ++g) count += is(g);
    return static_cast<float>(count) / static_cast<float>(cloud.size());
  };
  const float size = glm::length(robust_bounds(cloud.position).extent());
  const float huge = size > 0 ? share([&](std::size_t g) {
    const glm::vec3& s = cloud.scale[g];
    return s.x + s.y + s.z - std::max({s.x, s.y, s.z}) > kManySizes * size;  // in two directions: no needle
  })
                              : 0;
  if (huge > kManyShare)
    return fmt::format(
        "{:.0f} % of its Gaussians are larger than the whole scene: pictures take long, and the file may say "
        "sizes where "
        "their logarithms are meant",
        100 * huge);
  if (share([&](std::size_t g) { return cloud.opacity[g] >= kFaint; }) == 0)
    return "all of its Gaussians are too faint to be seen";
  return {};
}

}  // namespace

std::filesystem::path scene_file_in(const std::filesystem::path& path) {
  std::error_code ignored;
  if (!std::filesystem::is_directory(path, ignored)) return path;
  // Where there are both, meta.json needs no other folders.
  for (const char* name : {"meta.json", "lod-meta.json", "meta.lcc", "meta.lcc2"})
    if (std::filesystem::exists(path / name, ignored)) return path / name;
  if (const std::filesystem::path last = last_iteration(path); !last.empty()) return last;
  std::filesystem::path first;  // by name: the order in a folder is the system's
  std::vector<std::string> scenes;
  std::error_code trouble;
  for (std::filesystem::directory_iterator at(path, trouble), end; !trouble && at != end;
       at.increment(trouble)) {
    if (lower_case(at->path().extension().string()).starts_with(".lcc") &&
        (first.empty() || at->path() < first))
      first = at->path();
    const std::string name = at->path().filename().string();
    if (has_scene_extension(at->path()) && !name.starts_with('.') && at->is_regular_file(ignored))
      scenes.push_back(name);
  }
  if (!first.empty() || trouble) return first.empty() ? path : first;
  if (scenes.size() != 1) refuse_folder(path, std::move(scenes));
  return path / scenes.front();
}

std::string remark_on_folder(const std::filesystem::path& given, const Scene& scene) {
  std::error_code ignored;
  const std::string name = scene.path.lexically_relative(given).generic_string();
  const bool several = name.ends_with(".json") || lower_case(name).find(".lcc") != std::string::npos;
  if (several || !std::filesystem::is_directory(given, ignored)) return {};
  return name.find('/') == std::string::npos ? name + " is read, the only scene in the folder"
                                             : name + " is read, the last iteration in the folder";
}

const char* name_of(SpzAxes axes) {
  return axes == SpzAxes::kPly ? "ply" : "rub";
}

std::optional<SpzAxes> spz_axes_from_name(std::string_view name) {
  for (const SpzAxes axes : {SpzAxes::kRub, SpzAxes::kPly})
    if (name == name_of(axes)) return axes;
  return {};
}

Scene with_cloud(const Scene& scene, GaussianCloud cloud) {
  Scene other;
  other.path = scene.path;
  other.format = scene.format;
  other.file_rows = scene.file_rows;
  other.other_properties = scene.other_properties;
  other.origin = scene.origin;
  other.up = scene.up;
  other.cloud = std::move(cloud);
  return other;
}

Scene load_scene(const std::filesystem::path& path, const LoadOptions& options, const Job& job) {
  const MappedFile file(scene_file_in(path));
  Scene scene;
  scene.path = file.path();
  scene.files = {file.path()};
  scene.format = format_of(file);
  scene.file_bytes = file.bytes().size();
  scene.modified_ns = file.modified_ns();
  if (options.lod > 0 && !scene.format.levels)
    throw Error(path.string(), "has no levels of detail",
                "--lod is for streamed scenes (lod-meta.json, .lcc, .lcc2, .rad)");
  scene.format.read(file, options, scene, job);
  if (!job.cancelled() && scene.file_rows == 0) throw Error(path.string(), "holds no Gaussians");
  if (!job.cancelled() && scene.cloud.empty())
    throw Error(path.string(), fmt::format("none of the {} Gaussians is usable: each has NaN, a zero "
                                           "rotation, or a place or size beyond 1e15",
                                           scene.file_rows));
  if (job.cancelled()) return scene;
  if (options.origin && scene.origin != *options.origin) take_off(*options.origin, &scene);
  scene.cloud.near_plane = near_plane_of(scene.cloud);
  check_size(scene);
  add_sentence(oddity_of(scene.cloud), &scene.oddity);
  return scene;
}

void check_beginning(const std::filesystem::path& path) {
  format_of(MappedFile(scene_file_in(path)));
}

SceneLevels levels_of(const std::filesystem::path& path) {
  const MappedFile file(scene_file_in(path));
  const SceneFormat format = format_of(file);
  return format.levels ? format.levels(file) : SceneLevels{};
}

unsigned finest_level(const SceneLevels& levels, std::uint64_t memory_bytes) {
  unsigned level = 0;
  while (level + 1 < levels.gaussians.size() &&
         memory_of_scene(levels.gaussians[level], levels.sh_degree) > memory_bytes)
    ++level;
  return level;
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
  assert(!options.changed_rows || (scene.rows_can_be_changed && format.name == SceneFormat::kPly.name));
  if (kept.empty() && !options.may_be_empty)
    throw Error(path.string(), "nothing is selected: a scene without Gaussians is not written");
  AtomicFile out(path);
  SaveReport report;
  report.gaussians = kept.size() + (options.changed_rows ? options.changed_rows->size() : 0);
  SaveOptions resolved = options;
  if (!resolved.up) resolved.up = scene.up;
  report.loss = format.write(out, scene, kept, resolved);
  report.bytes = out.bytes_written();
  out.commit();
  return report;
}

}  // namespace splatcut
