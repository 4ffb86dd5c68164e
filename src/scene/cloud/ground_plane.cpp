#include "scene/cloud/ground_plane.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "core/counter_rng.h"
#include "core/symmetric_eigen.h"

namespace splatcut {

namespace {

constexpr float kMostTilt = 0.7071f;                       // cosine of 45 degrees
constexpr double kLeastOnPlane = 0.15, kMostBelow = 0.12;  // shares
constexpr double kLeastOfTwo = 0.1;                        // where two planes are alike
constexpr float kAlike = 0.9962f;                          // cosine of 5 degrees

struct Plane {
  glm::vec3 normal{0};
  float height = 0;  // of the plane along the normal
  double share = 0, above = 0, below = 0;
  double worth() const { return share * std::max(0.0, above - 3 * below); }
};

class Search {
 public:
  Search(std::vector<glm::vec3> points, float tolerance, const glm::vec3& up)
      : points_(std::move(points)), tolerance_(tolerance), up_(up) {}

  Plane best() const {
    constexpr int kTries = 3000, kRounds = 4;
    constexpr std::size_t kFewest = 200;
    Plane best;
    if (points_.size() < kFewest) return best;
    CounterRng rng(1, 0);
    for (int i = 0; i < kTries; ++i) {
      const glm::vec3 &a = points_[rng.below(points_.size())], b = points_[rng.below(points_.size())],
                      c = points_[rng.below(points_.size())];
      glm::vec3 normal = glm::cross(b - a, c - a);
      if (!(glm::length(normal) > 0)) continue;
      normal = glm::normalize(normal);
      if (std::abs(glm::dot(normal, up_)) < kMostTilt) continue;
      const Plane plane = counted(normal, a);
      if (plane.worth() > best.worth()) best = plane;
    }
    for (int round = 0; round < kRounds && best.worth() > 0; ++round) best = fitted(best);
    return best;
  }

 private:
  bool lies_in(const glm::vec3& p, const Plane& plane) const {
    return std::abs(glm::dot(plane.normal, p) - plane.height) < tolerance_;
  }

  Plane counted(glm::vec3 normal, const glm::vec3& through) const {
    if (glm::dot(normal, up_) < 0) normal = -normal;
    Plane plane{normal, glm::dot(normal, through)};
    std::size_t within = 0, above = 0;
    for (const glm::vec3& p : points_) {
      const float height = glm::dot(normal, p) - plane.height;
      within += std::abs(height) < tolerance_;
      above += height >= tolerance_;
    }
    const auto all = static_cast<double>(points_.size());
    plane.share = static_cast<double>(within) / all;
    plane.above = static_cast<double>(above) / all;
    plane.below = 1 - plane.share - plane.above;
    return plane;
  }

  Plane fitted(const Plane& plane) const {
    glm::dvec3 sum(0);
    double count = 0;
    for (const glm::vec3& p : points_)
      if (lies_in(p, plane)) {
        sum += p;
        ++count;
      }
    const glm::dvec3 mean = sum / count;
    glm::dmat3 spread(0);
    for (const glm::vec3& p : points_)
      if (lies_in(p, plane)) spread += glm::outerProduct(glm::dvec3(p) - mean, glm::dvec3(p) - mean);
    const SymmetricEigen eigen = symmetric_eigen(spread);
    int least = 0;
    for (int i = 1; i < 3; ++i)
      if (eigen.values[i] < eigen.values[least]) least = i;
    return counted(glm::vec3(eigen.axes[least]), glm::vec3(mean));
  }

  std::vector<glm::vec3> points_;
  float tolerance_;
  glm::vec3 up_;
};

std::vector<glm::vec3> sampled_centres(const GaussianCloud& cloud) {
  constexpr float kSolid = 0.5f;
  constexpr std::size_t kSample = 1 << 14;
  std::vector<glm::vec3> centres;
  const std::size_t step = 1 + cloud.size() / kSample;
  for (std::size_t g = 0; g < cloud.size(); g += step)
    if (cloud.opacity[g] >= kSolid) centres.push_back(cloud.position[g]);
  return centres;
}

std::vector<glm::vec3> within(std::span<const glm::vec3> centres, const Box& box) {
  constexpr std::size_t kMost = 3000;
  std::vector<glm::vec3> inside, some;
  for (const glm::vec3& p : centres)
    if (glm::all(glm::lessThanEqual(box.min, p)) && glm::all(glm::lessThanEqual(p, box.max)))
      inside.push_back(p);
  const std::size_t step = 1 + inside.size() / kMost;
  for (std::size_t i = 0; i < inside.size(); i += step) some.push_back(inside[i]);
  return some;
}

}  // namespace

std::optional<glm::vec3> ground_normal(const GaussianCloud& cloud, const glm::vec3& up_world) {
  constexpr float kTolerance = 0.005f;  // of the largest extent
  const std::vector<glm::vec3> centres = sampled_centres(cloud);
  std::vector<Plane> planes;
  for (const double inside : {0.96, 0.8, 0.6}) {
    const Box box = robust_bounds(centres, inside);
    const glm::vec3 extent = box.extent();
    const float size = std::max({extent.x, extent.y, extent.z});
    const Plane plane = Search(within(centres, box), kTolerance * size, up_world).best();
    if (plane.below < kMostBelow && glm::dot(plane.normal, up_world) > kMostTilt) planes.push_back(plane);
  }
  const auto confirmed = [&](const Plane& plane) {
    return std::ranges::count_if(planes, [&](const Plane& other) {
             return other.share >= kLeastOfTwo && glm::dot(other.normal, plane.normal) > kAlike;
           }) > 1;
  };
  std::erase_if(planes, [&](const Plane& p) {
    return p.share < kLeastOnPlane && (p.share < kLeastOfTwo || !confirmed(p));
  });
  const auto best = std::ranges::max_element(planes, {}, &Plane::share);
  if (best == planes.end()) return {};
  return best->normal;
}

}  // namespace splatcut
