// What the readers of all scene formats share, above all the loading loop: rows of a file, in any encoding,
// become a GaussianCloud in Morton order. Internal to src/scene/formats.
#pragma once

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <cmath>
#include <limits>
#include <vector>

#include "core/mapped_file.h"
#include "scene/cloud/morton.h"
#include "scene/cloud/scene_memory.h"
#include "scene/formats/scene_file.h"
#include "scene/packing/unpack.h"

namespace splatcut {

inline float sigmoid(float logit) {
  return 1.0f / (1.0f + std::exp(-logit));
}

inline bool is_finite(const glm::vec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

// Squares of distances beyond leave the range of numbers; no scene's own Gaussian is there, see check_size().
inline bool is_within_reach(const glm::vec3& position) {
  constexpr float kFarthest = 1e15f;
  return glm::all(glm::lessThan(glm::abs(position), glm::vec3(kFarthest)));
}

// Nor is a size beyond that one of a scene: moved or scaled, it would be no number.
inline constexpr float kLargestLogSize = 34.5f;  // of 9.6e14
inline bool is_size(const glm::vec3& scale) {
  return is_within_reach(scale) && glm::all(glm::greaterThanEqual(scale, glm::vec3(0)));
}

// Takes the memory of the cloud in large pages where the system has them: the first touch of 4 kB pages
// costs more than decoding into them.
void resize_for_decode(GaussianCloud& cloud, std::size_t n, int degree);

// check_expansion() for what stands in a file once and is a Gaussian many times, or of a higher degree of
// spherical harmonics than its own: throws Error if the cloud would take more than six times what may be
// unpacked.
void check_cloud_size(const std::filesystem::path& path, std::uint64_t packed_bytes, std::uint64_t gaussians,
                      int degree);

// Source: `glm::vec3 position(row) const`, NaN for a row to drop, and `void decode(row, cloud, g) const`,
// which fills all attributes of Gaussian g but position and file_row. Both are called from many threads.
template <class Source>
void decode_rows(const Source& source, std::size_t rows, int degree, Scene& scene, const Job& job) {
  constexpr std::size_t kGrain = 4096;
  using Range = tbb::blocked_range<std::size_t>;
  if (scene.cloud.empty()) check_memory(scene.path, rows, degree);  // else it is decoded again in its place
  job.progress("reading positions", 0.0);
  std::vector<glm::vec3> positions(rows);
  tbb::parallel_for(Range(0, rows, kGrain), [&](const Range& range) {
    if (job.cancelled()) return;
    for (std::size_t row = range.begin(); row < range.end(); ++row) positions[row] = source.position(row);
  });
  if (job.cancelled()) return;
  std::vector<std::uint32_t> row_of;
  row_of.reserve(rows);
  for (std::size_t row = 0; row < rows; ++row) {
    if (!is_within_reach(positions[row])) continue;
    positions[row_of.size()] = positions[row];
    row_of.push_back(static_cast<std::uint32_t>(row));
  }
  positions.resize(row_of.size());
  scene.file_rows = rows;
  scene.dropped = rows - row_of.size();

  job.progress("sorting along the Morton curve", 0.3);
  const std::vector<std::uint32_t> order = morton_order(positions, job);
  if (job.cancelled()) return;
  job.progress("decoding Gaussians", 0.5);
  GaussianCloud& cloud = scene.cloud;
  resize_for_decode(cloud, order.size(), degree);
  // Rows are read in file order and written to their places, not the other way round: the cloud lies in large
  // pages, the mapped file in small ones, whose address look-ups cost more than the decoding.
  std::vector<std::uint32_t> place(order.size());
  for (std::size_t g = 0; g < order.size(); ++g) place[order[g]] = static_cast<std::uint32_t>(g);
  tbb::parallel_for(Range(0, order.size(), kGrain), [&](const Range& range) {
    if (job.cancelled()) return;
    for (std::size_t i = range.begin(); i < range.end(); ++i) {
      const std::size_t g = place[i];
      cloud.position[g] = positions[i];
      cloud.file_row[g] = row_of[i];
      source.decode(row_of[i], cloud, g);
    }
  });
  job.progress("decoding Gaussians", 1.0);
}

inline constexpr glm::vec3 kDroppedRow{std::numeric_limits<float>::quiet_NaN()};

}  // namespace splatcut
