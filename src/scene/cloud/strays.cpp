#include "scene/cloud/strays.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <numeric>
#include <unordered_map>

namespace splatcut {

namespace {

constexpr double kLeastShare = 0.01;

using Cell = glm::ivec3;

std::uint64_t key_of(const Cell& cell) {
  constexpr int kBits = 21, kHalf = 1 << (kBits - 1);
  const auto part = [](int v) { return static_cast<std::uint64_t>(std::clamp(v + kHalf, 0, 2 * kHalf - 1)); };
  return part(cell.x) << (2 * kBits) | part(cell.y) << kBits | part(cell.z);
}

struct Filled {
  Cell cell;
  std::size_t points = 0, piece = 0;
};

class Cells {
 public:
  Cells(std::span<const glm::vec3> positions, const Box& core, float side) : origin_(core.min), side_(side) {
    for (const glm::vec3& p : positions) {
      const auto [at, fresh] = index_.try_emplace(key_of(cell_of(p)), cells_.size());
      if (fresh) cells_.push_back({cell_of(p), 0, cells_.size()});
      ++cells_[at->second].points;
    }
  }

  // Cells of at least so many points that touch become pieces; returns per cell whether its piece has at
  // least so large a share of the points, or is the largest.
  std::vector<bool> of_large_pieces(std::size_t fewest, double share) {
    for (std::size_t i = 0; i < cells_.size(); ++i)
      if (cells_[i].points >= fewest)
        each_beside(cells_[i].cell, [&](std::size_t j) {
          if (cells_[j].points >= fewest) cells_[root(j)].piece = root(i);
          return false;
        });
    std::vector<std::size_t> points(cells_.size(), 0);
    std::size_t all = 0;
    for (std::size_t i = 0; i < cells_.size(); ++i) {
      all += cells_[i].points;
      if (cells_[i].points >= fewest) points[root(i)] += cells_[i].points;
    }
    const std::size_t largest = std::ranges::max(points);
    const auto least =
        std::min(largest, static_cast<std::size_t>(std::ceil(share * static_cast<double>(all))));
    std::vector<bool> large(cells_.size());
    for (std::size_t i = 0; i < cells_.size(); ++i)
      large[i] = cells_[i].points >= fewest && points[root(i)] >= least;
    return large;
  }

  bool in_or_beside(const glm::vec3& p, const std::vector<bool>& wanted) const {
    return each_beside(cell_of(p), [&](std::size_t j) { return wanted[j]; });
  }

 private:
  Cell cell_of(const glm::vec3& p) const {
    constexpr float kFarthest = 1e6f;
    return Cell(glm::floor(glm::clamp((p - origin_) / side_, -kFarthest, kFarthest)));
  }
  // The cell itself and the filled ones that touch it, until `use` says true; returns whether it did.
  template <class Use>
  bool each_beside(const Cell& cell, const Use& use) const {
    for (int x = -1; x <= 1; ++x)
      for (int y = -1; y <= 1; ++y)
        for (int z = -1; z <= 1; ++z) {
          const auto found = index_.find(key_of(cell + Cell(x, y, z)));
          if (found != index_.end() && use(found->second)) return true;
        }
    return false;
  }
  std::size_t root(std::size_t i) {
    while (cells_[i].piece != i) i = cells_[i].piece = cells_[cells_[i].piece].piece;
    return i;
  }

  glm::vec3 origin_;
  float side_;
  std::unordered_map<std::uint64_t, std::size_t> index_;
  std::vector<Filled> cells_;
};

}  // namespace

std::vector<std::uint8_t> strays_of(std::span<const glm::vec3> positions) {
  constexpr double kCore = 0.8;
  constexpr float kMostAcross = 16, kFewestAcross = 2;
  constexpr float kSpacings = 3;  // side of a cell, in distances between points of a box's surface
  std::vector<std::uint8_t> strays(positions.size(), 0);
  const Box core = robust_bounds(positions, kCore);
  const float across = std::max({core.extent().x, core.extent().y, core.extent().z});
  if (!(across > 0)) return strays;
  const auto count = static_cast<float>(positions.size());
  const float cells = std::clamp(std::sqrt(count / 6) / kSpacings, kFewestAcross, kMostAcross);
  Cells grid(positions, core, across / cells);
  const std::vector<bool> large = grid.of_large_pieces(1 + positions.size() / 20000, kLeastShare);
  for (std::size_t i = 0; i < positions.size(); ++i) strays[i] = !grid.in_or_beside(positions[i], large);
  return strays;
}

std::vector<glm::vec3> without_strays(std::span<const glm::vec3> positions, std::size_t most) {
  std::vector<glm::vec3> points;
  const std::size_t step = 1 + positions.size() / (most + 1);
  for (std::size_t i = 0; i < positions.size(); i += step) points.push_back(positions[i]);
  const std::vector<std::uint8_t> strays = strays_of(points);
  std::vector<glm::vec3> left;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (!strays[i]) left.push_back(points[i]);
  return left;
}

std::vector<glm::vec3> shown_points(const GaussianCloud& cloud, std::span<const std::uint8_t> labels,
                                    std::size_t most) {
  constexpr float kHalfDense = 1.1774f;  // standard deviations
  std::vector<std::uint32_t> rows;
  for (std::uint32_t g = 0; g < labels.size(); ++g)
    if (labels[g]) rows.push_back(g);
  std::vector<glm::vec3> centres;
  const std::size_t step = 1 + rows.size() / (most + 1);
  for (std::size_t i = 0; i < rows.size(); i += step) centres.push_back(cloud.position[rows[i]]);
  const std::vector<std::uint8_t> strays = strays_of(centres);
  std::vector<glm::vec3> points;
  for (std::size_t i = 0; i < centres.size(); ++i) {
    if (strays[i]) continue;
    const std::uint32_t g = rows[i * step];
    const glm::mat3 axes = glm::mat3_cast(cloud.rotation[g]);
    points.push_back(centres[i]);
    for (int axis = 0; axis < 3; ++axis)
      for (const float side : {-kHalfDense, kHalfDense})
        points.push_back(centres[i] + side * cloud.scale[g][axis] * axes[axis]);
  }
  return points;
}

Box solid_bounds(const GaussianCloud& cloud) {
  constexpr float kShows = 0.1f;
  constexpr std::size_t kMost = 1000000;
  std::vector<glm::vec3> shown;
  for (std::size_t g = 0; g < cloud.size(); ++g)
    if (cloud.opacity[g] >= kShows) shown.push_back(cloud.position[g]);
  const std::vector<glm::vec3> points = without_strays(shown.empty() ? cloud.position : shown, kMost);
  if (points.empty()) return {};
  Box box{points.front(), points.front()};
  for (const glm::vec3& p : points) {
    box.min = glm::min(box.min, p);
    box.max = glm::max(box.max, p);
  }
  return box;
}

}  // namespace splatcut
