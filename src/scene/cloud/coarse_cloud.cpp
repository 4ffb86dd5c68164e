#include "scene/cloud/coarse_cloud.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace splatcut {

namespace {

constexpr std::size_t kGroup = 8;
constexpr float kMuchSmaller = 1.0f / 12;  // of the coverage
constexpr float kNearSigmas = 6;           // of both together
constexpr float kMostGrowth = 4;
constexpr float kOtherColour = 1;  // in f_dc: 0.28 in the colour
constexpr float kLargestShare =
    1.0f / 700;  // sigma, of the scene's size: about a pixel where the whole scene is seen

int thinnest(const glm::vec3& s) {
  return s.x <= s.y && s.x <= s.z ? 0 : s.y <= s.z ? 1 : 2;
}

float long_axes(const glm::vec3& s) {
  const int thin = thinnest(s);
  return s[(thin + 1) % 3] * s[(thin + 2) % 3];
}

// What one group leaves: Gaussians kept as they are, the first of them grown to stand for the absorbed.
struct Reduced {
  std::array<std::uint32_t, kGroup> kept;
  std::size_t count = 0;
  glm::vec3 position, f_dc;
  float growth = 1;
};

Reduced reduced(const GaussianCloud& fine, std::size_t begin, std::size_t end, float largest) {
  std::array<float, kGroup> cover{};
  std::size_t lead = begin;
  for (std::size_t g = begin; g < end; ++g) {
    cover[g - begin] = fine.opacity[g] * long_axes(fine.scale[g]);
    if (cover[g - begin] > cover[lead - begin]) lead = g;
  }
  Reduced out;
  out.kept[out.count++] = static_cast<std::uint32_t>(lead);
  const float own = cover[lead - begin], reach = std::sqrt(long_axes(fine.scale[lead]));
  double sum = own;
  glm::dvec3 position = glm::dvec3(fine.position[lead]) * sum, colour = glm::dvec3(fine.f_dc[lead]) * sum;
  for (std::size_t g = begin; g < end; ++g) {
    if (g == lead) continue;
    const double c = cover[g - begin];
    const bool large = long_axes(fine.scale[g]) > largest * largest;
    const float apart = glm::length(fine.position[g] - fine.position[lead]);
    if (large || c < kMuchSmaller * own || glm::length(fine.f_dc[g] - fine.f_dc[lead]) > kOtherColour ||
        apart > kNearSigmas * (reach + std::sqrt(long_axes(fine.scale[g])))) {
      out.kept[out.count++] = static_cast<std::uint32_t>(g);
      continue;
    }
    sum += c;
    position += c * glm::dvec3(fine.position[g]);
    colour += c * glm::dvec3(fine.f_dc[g]);
  }
  if (!(sum > 0)) {
    out.position = fine.position[lead], out.f_dc = fine.f_dc[lead];
    return out;
  }
  out.position = position / sum;
  out.f_dc = colour / sum;
  out.growth = std::min(kMostGrowth, static_cast<float>(std::sqrt(sum / own)));
  return out;
}

void store(const GaussianCloud& fine, const Reduced& group, std::size_t at, CoarseCloud* out) {
  GaussianCloud& cloud = out->cloud;
  const std::size_t stride = fine.sh_stride();
  for (std::size_t i = 0; i < group.count; ++i, ++at) {
    const std::uint32_t g = group.kept[i];
    out->stands_for[at] = g;
    cloud.position[at] = i == 0 ? group.position : fine.position[g];
    cloud.f_dc[at] = i == 0 ? group.f_dc : fine.f_dc[g];
    cloud.scale[at] = fine.scale[g];
    if (i == 0) {
      const int thin = thinnest(fine.scale[g]);
      cloud.scale[at][(thin + 1) % 3] *= group.growth;
      cloud.scale[at][(thin + 2) % 3] *= group.growth;
    }
    cloud.rotation[at] = fine.rotation[g];
    cloud.opacity[at] = fine.opacity[g];
    cloud.file_row[at] = fine.file_row[g];
    std::copy_n(fine.sh_rest.data() + g * stride, stride, cloud.sh_rest.data() + at * stride);
  }
}

}  // namespace

CoarseCloud coarse_cloud(const GaussianCloud& fine, const Job& job) {
  const std::size_t groups = (fine.size() + kGroup - 1) / kGroup;
  const float largest = kLargestShare * glm::length(robust_bounds(fine.position, 0.9).extent());
  std::vector<Reduced> left(groups);
  tbb::parallel_for(std::size_t{0}, groups, [&](std::size_t i) {
    if (!job.cancelled())
      left[i] = reduced(fine, i * kGroup, std::min(fine.size(), (i + 1) * kGroup), largest);
  });
  if (job.cancelled()) return {};
  std::vector<std::size_t> first(groups + 1, 0);
  for (std::size_t i = 0; i < groups; ++i) first[i + 1] = first[i] + left[i].count;
  CoarseCloud out;
  out.cloud.resize(first.back(), fine.sh_degree);
  out.cloud.antialiased = fine.antialiased;
  out.stands_for.resize(first.back());
  tbb::parallel_for(std::size_t{0}, groups, [&](std::size_t i) {
    if (!job.cancelled()) store(fine, left[i], first[i], &out);
  });
  return out;
}

}  // namespace splatcut
