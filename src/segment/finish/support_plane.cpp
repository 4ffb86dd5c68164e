#include "segment/finish/support_plane.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/counter_rng.h"
#include "core/symmetric_eigen.h"

namespace splatcut {

namespace {

constexpr float kNearSizes = 1.6f, kAroundSizes = 2.5f;  // of the radius, from the object's centre
constexpr float kTolerance = 0.02f;                      // of the radius
// Of the radius, where the lowest part that is seen may lie. Views from above do not see where a ball
// touches.
constexpr float kMostBelow = 0.08f, kMostAbove = 0.4f;
constexpr float kHalfWorthAbove = 0.24f;  // of the radius: a plane so far below is worth half
constexpr std::size_t kMostPoints = 4000, kLeastPoints = 30;

// Every so many-th, no more than wanted.
std::vector<glm::vec3> thinned(const std::vector<glm::vec3>& points, std::size_t most) {
  const std::size_t step = (points.size() + most - 1) / std::max<std::size_t>(most, 1);
  std::vector<glm::vec3> some;
  for (std::size_t i = 0; i < points.size(); i += std::max<std::size_t>(step, 1)) some.push_back(points[i]);
  return some;
}

class Search {
 public:
  Search(std::vector<glm::vec3> on_object, std::vector<glm::vec3> rest, const ObjectExtent& object,
         const glm::vec3& up_world)
      : on_object_(std::move(on_object)), rest_(std::move(rest)), object_(object), up_world_(up_world) {
    for (const glm::vec3& p : rest_) {
      around_ += nearness(p);
      if (away(p) < kNearSizes) near_.push_back(p);
    }
  }

  std::optional<SupportPlane> best() const {
    constexpr int kTries = 600;
    std::optional<Below> best;
    float most = 0;
    if (near_.size() < kLeastPoints) return {};
    CounterRng rng(1, 0);
    for (int i = 0; i < kTries; ++i) {
      const glm::vec3 &a = near_[rng.below(near_.size())], b = near_[rng.below(near_.size())],
                      c = near_[rng.below(near_.size())];
      const std::optional<Below> plane = touching(a, glm::cross(b - a, c - a));
      const float worth = plane ? worth_of(*plane) : 0;
      if (worth <= most) continue;
      most = worth;
      best = plane;
    }
    if (!best) return {};
    SupportPlane plane = best->plane;
    for (int round = 0; round < 3; ++round) plane = fitted(plane);
    plane.share = lying_in(plane) / around_;
    return plane;
  }

 private:
  struct Below {
    SupportPlane plane;
    float above = 0;  // of the radius: the object's lowest part above it
  };

  float away(const glm::vec3& p) const { return glm::distance(p, object_.centre_world) / object_.radius; }

  float nearness(const glm::vec3& p) const { return 1 / (1 + away(p) * away(p)); }

  // The plane, if the object lies on one side of it and its lowest part is near it.
  std::optional<Below> touching(const glm::vec3& through, glm::vec3 normal) const {
    const float length = glm::length(normal);
    if (!(length > 0)) return {};
    normal /= length;
    if (glm::dot(object_.centre_world - through, normal) < 0) normal = -normal;
    const SupportPlane plane{object_.centre_world - glm::dot(object_.centre_world - through, normal) * normal,
                             normal};
    std::vector<float> heights;
    for (const glm::vec3& p : on_object_) heights.push_back(plane.height(p));
    const auto lowest = heights.begin() + static_cast<std::ptrdiff_t>(heights.size() / 30);
    std::ranges::nth_element(heights, lowest);
    const float above = *lowest / object_.radius;
    if (above < -kMostBelow || above > kMostAbove) return {};
    return Below{plane, above};
  }

  bool lies_in(const glm::vec3& p, const SupportPlane& plane) const {
    return std::abs(plane.height(p)) < kTolerance * object_.radius;
  }

  float lying_in(const SupportPlane& plane) const {
    float sum = 0;
    for (const glm::vec3& p : rest_)
      if (lies_in(p, plane)) sum += nearness(p);
    return sum;
  }

  float worth_of(const Below& below) const {
    const float worth = lying_in(below.plane);
    if (worth <= static_cast<float>(kLeastPoints)) return 0;
    const float above = below.above / kHalfWorthAbove;
    const float level = glm::dot(below.plane.normal_world, up_world_);
    return worth / (1 + above * above * above * above) * (2 + level) / 3;
  }

  // The plane of least squares through the Gaussians that lie in it.
  SupportPlane fitted(const SupportPlane& plane) const {
    glm::dvec3 sum{0};
    double count = 0;
    for (const glm::vec3& p : rest_)
      if (lies_in(p, plane)) {
        sum += p;
        ++count;
      }
    if (count < 3) return plane;
    const glm::dvec3 mean = sum / count;
    glm::dmat3 spread{0};
    for (const glm::vec3& p : rest_)
      if (lies_in(p, plane)) spread += glm::outerProduct(glm::dvec3(p) - mean, glm::dvec3(p) - mean);
    const SymmetricEigen axes = symmetric_eigen(spread);
    const int least =
        static_cast<int>(std::ranges::min_element(&axes.values[0], &axes.values[0] + 3) - &axes.values[0]);
    const std::optional<Below> better = touching(glm::vec3(mean), glm::vec3(axes.axes[least]));
    return better ? better->plane : plane;
  }

  std::vector<glm::vec3> on_object_, rest_, near_;
  ObjectExtent object_;
  glm::vec3 up_world_;
  float around_ = 0;  // sum of nearness of what surrounds the object
};

}  // namespace

std::optional<SupportPlane> support_plane(const std::vector<glm::vec3>& on_object,
                                          const std::vector<glm::vec3>& on_rest, const ObjectExtent& object,
                                          const glm::vec3& up_world) {
  if (on_object.empty() || !(object.radius > 0)) return {};
  std::vector<glm::vec3> around;
  for (const glm::vec3& p : on_rest)
    if (glm::distance(p, object.centre_world) < kAroundSizes * object.radius) around.push_back(p);
  return Search(thinned(on_object, kMostPoints / 4), thinned(around, kMostPoints), object, up_world).best();
}

}  // namespace splatcut
