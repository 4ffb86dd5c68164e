#include "scene/cloud/convex_hull.h"

#include <fmt/format.h>
#include <libqhull_r/libqhull_r.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <glm/gtc/constants.hpp>
#include <iterator>
#include <limits>
#include <map>

#include "core/error.h"

namespace splatcut {

namespace {

constexpr float kLeastOpacity = 0.1f;

std::vector<std::uint32_t> seen_of(const GaussianCloud& cloud, std::span<const std::uint8_t> keep) {
  std::vector<std::uint32_t> seen;
  for (std::size_t g = 0; g < cloud.size(); ++g)
    if ((keep.empty() || keep[g]) && cloud.opacity[g] >= kLeastOpacity)
      seen.push_back(static_cast<std::uint32_t>(g));
  return seen;
}

// The i-th of n directions along a spiral from pole to pole, each with the same share of the sphere.
glm::vec3 direction(int i, int n) {
  const float z = 1 - (2 * static_cast<float>(i) + 1) / static_cast<float>(n);
  const float turn = static_cast<float>(i) * glm::two_pi<float>() / glm::golden_ratio<float>();
  const float r = std::sqrt(1 - z * z);
  return {r * std::cos(turn), r * std::sin(turn), z};
}

glm::vec3 support_point(const GaussianCloud& cloud, const std::vector<std::uint32_t>& seen,
                        const glm::vec3& towards) {
  glm::vec3 farthest{0};
  float most = -std::numeric_limits<float>::infinity();
  for (const std::uint32_t g : seen) {
    const glm::vec3 local = cloud.scale[g] * (glm::conjugate(cloud.rotation[g]) * towards);
    const float length = glm::length(local);
    const float reach = glm::dot(cloud.position[g], towards) + length;
    if (reach <= most) continue;
    most = reach;
    farthest = cloud.position[g];
    if (length > 0) farthest += cloud.rotation[g] * (cloud.scale[g] * local) / length;
  }
  return farthest;
}

// A thin thing has few corners for each of its long sides where directions are spread evenly: they are spread
// in the frame in which its box is a cube.
std::vector<glm::vec3> support_points(const GaussianCloud& cloud, const std::vector<std::uint32_t>& seen,
                                      int directions) {
  std::vector<glm::vec3> positions;
  for (const std::uint32_t g : seen) positions.push_back(cloud.position[g]);
  const glm::vec3 extent = robust_bounds(positions).extent();
  const float largest = std::max({extent.x, extent.y, extent.z});
  const glm::vec3 box = largest > 0 ? glm::max(extent / largest, glm::vec3(1e-3f)) : glm::vec3(1);
  std::vector<glm::vec3> points(static_cast<std::size_t>(directions));
  tbb::parallel_for(std::size_t{0}, points.size(), [&](std::size_t i) {
    points[i] = support_point(cloud, seen, direction(static_cast<int>(i), directions) / box);
  });
  return points;
}

// A run of Qhull. Its C++ interface does not compile as C++20.
class Hull {
 public:
  explicit Hull(std::vector<glm::dvec3>* points) {
    char triangles[] = "qhull Qt Pp";  // without hints
    qh_zero(&qhull_, said_);
    const bool keeps_points = false;
    found_ = qh_new_qhull(&qhull_, 3, static_cast<int>(points->size()), &points->front().x, keeps_points,
                          triangles, nullptr, said_) == qh_ERRnone;
  }
  Hull(const Hull&) = delete;
  Hull& operator=(const Hull&) = delete;
  ~Hull() {
    int blocks = 0, bytes = 0;
    qh_freeqhull(&qhull_, !qh_ALL);
    qh_memfreeshort(&qhull_, &blocks, &bytes);
    if (said_) std::fclose(said_);
  }

  const facetT* first() const { return found_ ? qhull_.facet_list : nullptr; }  // the last has no next one
  std::array<int, 3> points_of(const facetT& facet) {
    std::array<int, 3> points{};
    for (std::size_t k = 0; k < 3; ++k)
      points.at(k) = qh_pointid(&qhull_, static_cast<vertexT*>(facet.vertices->e[k].p)->point);
    if (facet.toporient != qh_ORIENTclock) std::swap(points[1], points[2]);
    return points;
  }

 private:
  qhT qhull_{};
  std::FILE* said_ = std::fopen("/dev/null", "w");  // what is wrong with the points; else it is printed
  bool found_ = false;
};

// Without triangles where the points have no volume.
ConvexHull hull_of(const std::vector<glm::vec3>& points) {
  std::vector<glm::dvec3> coordinates(points.begin(), points.end());
  Hull qhull(&coordinates);
  ConvexHull hull;
  std::map<int, std::uint32_t> corner_of;  // point: corner
  for (const facetT* facet = qhull.first(); facet && facet->next; facet = facet->next) {
    std::array<std::uint32_t, 3> triangle{};
    const std::array<int, 3> of_points = qhull.points_of(*facet);
    for (std::size_t k = 0; k < 3; ++k) {
      const int point = of_points.at(k);
      const auto [at, is_new] = corner_of.try_emplace(point, static_cast<std::uint32_t>(hull.corners.size()));
      if (is_new) hull.corners.push_back(points[static_cast<std::size_t>(point)]);
      triangle.at(k) = at->second;
    }
    hull.triangles.push_back(triangle);
  }
  return hull;
}

}  // namespace

ConvexHull convex_hull(const GaussianCloud& cloud, std::span<const std::uint8_t> keep, int directions) {
  const Error flat("convex hull", "the object has no volume", "Select more of it");
  const std::vector<std::uint32_t> seen = seen_of(cloud, keep);
  if (seen.empty()) throw flat;
  const std::vector<glm::vec3> points = support_points(cloud, seen, directions);
  ConvexHull hull = hull_of(points);
  if (hull.triangles.empty()) throw flat;
  return hull;
}

std::string obj_text(const ConvexHull& hull, const glm::dvec3& origin) {
  std::string text;
  for (const glm::vec3& corner : hull.corners) {
    const glm::dvec3 at = origin + glm::dvec3(corner);
    fmt::format_to(std::back_inserter(text), "v {} {} {}\n", at.x, at.y, at.z);
  }
  for (const auto& [a, b, c] : hull.triangles)
    fmt::format_to(std::back_inserter(text), "f {} {} {}\n", a + 1, b + 1, c + 1);
  return text;
}

}  // namespace splatcut
