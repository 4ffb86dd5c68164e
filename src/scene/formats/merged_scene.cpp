#include "scene/formats/merged_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <limits>

#include "core/error.h"
#include "scene/cloud/joined_clouds.h"
#include "scene/cloud/morton.h"

namespace splatcut {

namespace {

// Nor what finds no room beside its parts.
void refuse_too_many(const std::vector<Scene>& scenes) {
  std::uint64_t rows = 0;
  int degree = 0;
  for (const Scene& scene : scenes) {
    rows += scene.file_rows;
    degree = std::max(degree, scene.cloud.sh_degree);
  }
  if (rows > std::numeric_limits<std::uint32_t>::max())
    throw Error(scenes.front().path.string(),
                fmt::format("with the others {} Gaussians, more than can be handled", rows));
  if (scenes.size() > 1) check_memory(scenes.front().path, rows, degree);
}

// A file of several scenes has one mark: it says so of all, or of none.
std::string mark_of_some(const std::vector<Scene>& scenes) {
  const auto is_marked = [](const Scene& scene) { return scene.cloud.antialiased; };
  const auto marked = std::ranges::find_if(scenes, is_marked);
  if (marked == scenes.end() || std::ranges::all_of(scenes, is_marked)) return {};
  return fmt::format("the mark that {} was trained with antialiasing is left out, as not all have it",
                     marked->path.string());
}

// A file of several scenes says one up, that of the first.
std::string up_of_others(const std::vector<Scene>& scenes) {
  constexpr float kSame = 0.9998f;  // within a degree
  const std::optional<glm::vec3>& first = scenes.front().up;
  const auto other = std::ranges::find_if(
      scenes, [&](const Scene& s) { return s.up && !(first && glm::dot(*s.up, *first) > kSame); });
  if (other == scenes.end()) return {};
  return fmt::format("which way is up by {} is left out, it is not what {} says", other->path.string(),
                     scenes.front().path.string());
}

void add_names(const std::vector<std::string>& names, std::vector<std::string>* all) {
  for (const std::string& name : names)
    if (std::ranges::find(*all, name) == all->end()) all->push_back(name);
}

// What the file of the merged scene would say of itself.
Scene described(const std::vector<Scene>& scenes) {
  Scene whole;
  whole.path = scenes.front().path;
  whole.format = scenes.front().format;
  whole.origin = scenes.front().origin;
  whole.up = scenes.front().up;
  for (const Scene& scene : scenes) {
    whole.file_rows += scene.file_rows;
    whole.dropped += scene.dropped;
    whole.file_bytes += scene.file_bytes;
    add_names(scene.other_properties, &whole.other_properties);
    whole.files.insert(whole.files.end(), scene.files.begin(), scene.files.end());
  }
  return whole;
}

// One after the other: each with its rows after those of the ones before.
GaussianCloud in_sequence(std::vector<Scene>* scenes) {
  std::vector<GaussianCloud> clouds;
  std::size_t rows_before = 0;
  for (Scene& scene : *scenes) {
    for (std::uint32_t& row : scene.cloud.file_row) row += static_cast<std::uint32_t>(rows_before);
    rows_before += scene.file_rows;
    clouds.push_back(std::move(scene.cloud));
  }
  return joined(std::move(clouds));
}

}  // namespace

MergedScene merged(std::vector<Scene> scenes, const Job& job) {
  assert(!scenes.empty());
  refuse_too_many(scenes);
  MergedScene result{described(scenes), {}};
  for (const std::string& loss : {mark_of_some(scenes), up_of_others(scenes)})
    if (!loss.empty()) result.loss += (result.loss.empty() ? "" : "; ") + loss;
  job.progress("merging", 0.0);
  const GaussianCloud cloud = in_sequence(&scenes);
  // Compact formats rely on the order: neighbours share a chunk.
  const std::vector<std::uint32_t> order = morton_order(cloud.position, job);
  if (job.cancelled()) return result;
  job.progress("merging", 0.5);
  result.scene.cloud = permuted(cloud, order);
  result.scene.cloud.near_plane = near_plane_of(result.scene.cloud);
  job.progress("merging", 1.0);
  return result;
}

}  // namespace splatcut
