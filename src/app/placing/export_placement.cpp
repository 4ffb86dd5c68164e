#include "app/placing/export_placement.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "core/error.h"
#include "scene/cloud/spherical_harmonics.h"

namespace splatcut {

namespace {

glm::vec3 file_up(ExportUp up, const glm::vec3& up_world, const AxisSigns& axes) {
  switch (up) {
    case ExportUp::kPlusY:
      return axes.position({0, 1, 0});
    case ExportUp::kMinusY:
      return axes.position({0, -1, 0});
    case ExportUp::kPlusZ:
      return axes.position({0, 0, 1});
    case ExportUp::kScene:
      break;
  }
  return glm::normalize(up_world);
}

template <std::size_t N>
std::size_t index_of(std::string_view word, const std::array<const char*, N>& words, const char* where,
                     const char* takes) {
  const auto at = std::ranges::find(words, word);
  if (at == words.end()) throw Error(where, "is \"" + std::string(word) + "\"", takes);
  return static_cast<std::size_t>(at - words.begin());
}

}  // namespace

ExportPlacement placement_by_name(std::string_view origin, std::string_view up) {
  ExportPlacement placement;
  placement.origin =
      static_cast<ExportOrigin>(index_of(origin, kOriginNames, "origin", "It takes scene, centre or foot"));
  placement.up = static_cast<ExportUp>(index_of(up, kUpNames, "up", "It takes scene, +y, -y or +z"));
  return placement;
}

glm::quat turn_between(const glm::vec3& from, const glm::vec3& to) {
  const glm::vec3 a = glm::normalize(from), b = glm::normalize(to);
  const float cosine = glm::dot(a, b);
  constexpr float kOpposite = -0.999999f;
  if (cosine < kOpposite) {  // any axis across
    const glm::vec3 across = std::abs(a.x) < 0.9f ? glm::vec3(1, 0, 0) : glm::vec3(0, 1, 0);
    return glm::angleAxis(3.14159265f, glm::normalize(glm::cross(a, across)));
  }
  const glm::vec3 axis = glm::cross(a, b);
  return glm::normalize(glm::quat(1 + cosine, axis.x, axis.y, axis.z));
}

ExportFrame export_frame(const ExportPlacement& placement, const GaussianCloud& cloud,
                         std::span<const std::uint8_t> keep, const glm::vec3& up_world,
                         const AxisSigns& axes) {
  ExportFrame frame;
  frame.up_file = file_up(placement.up, up_world, axes);
  frame.upright = turn_between(up_world, frame.up_file);
  std::vector<glm::vec3> positions;
  for (std::size_t g = 0; g < cloud.size(); ++g)
    if (keep.empty() || keep[g]) positions.push_back(frame.upright * cloud.position[g]);
  const Box box = robust_bounds(positions);
  glm::vec3 origin = box.centre();
  if (placement.origin == ExportOrigin::kFoot)
    origin -= glm::dot(glm::abs(frame.up_file), 0.5f * box.extent()) * frame.up_file;
  frame.middle_world = glm::conjugate(frame.upright) * box.centre();
  if (placement.origin != ExportOrigin::kScene) frame.origin_world = glm::conjugate(frame.upright) * origin;
  return frame;
}

Similarity similarity_of(const ExportPlacement& placement, const ExportFrame& frame) {
  const glm::quat turn = glm::angleAxis(glm::radians(placement.turn_deg), frame.up_file);
  return {glm::normalize(turn * frame.upright), placement.scale, frame.origin_world, placement.move};
}

Similarity similarity_of(const ExportPlacement& placement, const GaussianCloud& cloud,
                         std::span<const std::uint8_t> keep, const glm::vec3& up_world,
                         const AxisSigns& axes) {
  return similarity_of(placement, export_frame(placement, cloud, keep, up_world, axes));
}

glm::vec3 moved(const glm::vec3& point, const Similarity& to) {
  return to.scale * (to.rotation * (point - to.origin)) + to.move;
}

glm::vec3 pivot_of(const ExportPlacement& placement, const ExportFrame& frame) {
  if (placement.origin != ExportOrigin::kScene) return placement.move;
  return moved(frame.middle_world, similarity_of(placement, frame));
}

ExportPlacement changed(ExportPlacement placement, const glm::vec3& pivot_file, const PlacingChange& change) {
  constexpr float kLeastScale = 1e-3f, kMostScale = 1e3f;
  const float scale = glm::clamp(placement.scale * change.scale, kLeastScale, kMostScale);
  const float factor = scale / placement.scale;
  placement.turn_deg = std::remainder(placement.turn_deg + glm::degrees(change.angle_rad), 360.0f);
  placement.move = factor * (change.turn * (placement.move - pivot_file)) + pivot_file + change.move_world;
  placement.scale = scale;
  return placement;
}

GaussianCloud placed(const GaussianCloud& cloud, std::span<const std::uint8_t> keep, const Similarity& to) {
  std::vector<std::uint32_t> order;
  for (std::uint32_t g = 0; g < cloud.size(); ++g)
    if (keep.empty() || keep[g]) order.push_back(g);
  GaussianCloud out = permuted(cloud, order);
  const glm::mat3 rotation = glm::mat3_cast(to.rotation);
  const ShTurn harmonics(rotation);
  tbb::parallel_for(std::size_t{0}, out.size(), [&](std::size_t g) {
    out.position[g] = to.scale * (rotation * (out.position[g] - to.origin)) + to.move;
    out.scale[g] *= to.scale;
    out.rotation[g] = glm::normalize(to.rotation * out.rotation[g]);
    harmonics.apply(std::span(out.sh_rest).subspan(g * out.sh_stride(), out.sh_stride()), out.sh_degree);
  });
  out.near_plane *= to.scale;
  return out;
}

}  // namespace splatcut
