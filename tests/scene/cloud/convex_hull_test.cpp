#include "scene/cloud/convex_hull.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <map>
#include <sstream>

#include "core/error.h"
#include "synthetic_cloud.h"

using namespace splatcut;
using namespace splatcut::testing;

namespace {

GaussianCloud points_at(const std::vector<glm::vec3>& positions, float size = 0) {
  GaussianCloud cloud;
  cloud.resize(positions.size(), 0);
  cloud.position = positions;
  for (std::size_t g = 0; g < positions.size(); ++g) {
    cloud.scale[g] = glm::vec3(size);
    cloud.rotation[g] = glm::quat(1, 0, 0, 0);
    cloud.opacity[g] = 1;
  }
  return cloud;
}

std::vector<glm::vec3> corners_of_box(const glm::vec3& half) {
  std::vector<glm::vec3> corners;
  for (int i = 0; i < 8; ++i)
    corners.push_back(half * glm::vec3(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1));
  return corners;
}

// By the divergence theorem: positive where triangles are counterclockwise from outside.
double volume(const ConvexHull& hull) {
  double six = 0;
  for (const auto& [a, b, c] : hull.triangles)
    six += glm::dot(glm::dvec3(hull.corners[a]),
                    glm::cross(glm::dvec3(hull.corners[b]), glm::dvec3(hull.corners[c])));
  return six / 6;
}

// Each edge lies in two triangles, once in each direction.
bool closed(const ConvexHull& hull) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  for (const auto& t : hull.triangles)
    for (std::size_t k = 0; k < 3; ++k) ++edges[{t.at(k), t.at((k + 1) % 3)}];
  for (const auto& [edge, count] : edges)
    if (count != 1 || !edges.contains({edge.second, edge.first})) return false;
  return hull.corners.size() + hull.triangles.size() == edges.size() / 2 + 2;  // Euler
}

}  // namespace

TEST_CASE("convex hull: a box of points is the box, whatever lies within") {
  std::vector<glm::vec3> points = corners_of_box({3, 1, 0.1f});
  points.emplace_back(0.5f, 0.2f, 0.05f);
  const ConvexHull hull = convex_hull(points_at(points), {});
  CHECK(hull.corners.size() == 8);
  CHECK(hull.triangles.size() == 12);
  CHECK(closed(hull));
  CHECK(volume(hull) == doctest::Approx(6 * 2 * 0.2));
}

TEST_CASE("convex hull: a Gaussian is its ellipsoid of one standard deviation") {
  GaussianCloud cloud = points_at({{5, 6, 7}});
  cloud.scale[0] = {2, 1, 0.5f};
  cloud.rotation[0] = glm::angleAxis(0.7f, glm::normalize(glm::vec3(1, 2, 3)));
  const ConvexHull hull = convex_hull(cloud, {});
  CHECK(hull.corners.size() == static_cast<std::size_t>(kHullDirections));
  CHECK(closed(hull));
  const double ellipsoid = 4.0 / 3 * 3.14159265 * 2 * 1 * 0.5;
  CHECK(volume(hull) < ellipsoid);
  CHECK(volume(hull) > 0.92 * ellipsoid);
  for (const glm::vec3& corner : hull.corners) {
    const glm::vec3 local =
        (glm::conjugate(cloud.rotation[0]) * (corner - cloud.position[0])) / cloud.scale[0];
    CHECK(glm::length(local) == doctest::Approx(1).epsilon(1e-4));
  }
}

TEST_CASE("convex hull: what is not kept, and what is hardly seen, has no say") {
  std::vector<glm::vec3> points = corners_of_box(glm::vec3(1));
  points.emplace_back(9, 0, 0);
  points.emplace_back(0, 9, 0);
  GaussianCloud cloud = points_at(points);
  cloud.opacity[9] = 0.05f;
  std::vector<std::uint8_t> keep(10, 1);
  keep[8] = 0;
  CHECK(volume(convex_hull(cloud, keep)) == doctest::Approx(8));
}

TEST_CASE("convex hull: no corner lies outside of any triangle, and a second run has the same bits") {
  const GaussianCloud cloud = random_cloud(2000, 3, 0);
  const ConvexHull hull = convex_hull(cloud, {});
  CHECK(closed(hull));
  float farthest_outside = 0;
  for (const auto& [a, b, c] : hull.triangles) {
    const glm::vec3& from = hull.corners[a];
    const glm::vec3 normal = glm::normalize(glm::cross(hull.corners[b] - from, hull.corners[c] - from));
    for (const glm::vec3& corner : hull.corners)
      farthest_outside = std::max(farthest_outside, glm::dot(normal, corner - from));
  }
  CHECK(farthest_outside < 1e-4f);
  CHECK(convex_hull(cloud, {}).corners == hull.corners);
}

TEST_CASE("convex hull: an object without volume is refused in words") {
  CHECK_THROWS_AS(convex_hull(points_at({}), {}), Error);
  CHECK_THROWS_AS(convex_hull(points_at({{1, 2, 3}}), {}), Error);
  CHECK_THROWS_AS(convex_hull(points_at({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {0.3f, 0.2f, 0}}), {}),
                  Error);
  CHECK_THROWS_AS(convex_hull(points_at(corners_of_box(glm::vec3(1))), std::vector<std::uint8_t>(8, 0)),
                  Error);
}

TEST_CASE("convex hull: an .obj is read back line by line") {
  const ConvexHull hull = convex_hull(points_at(corners_of_box(glm::vec3(1))), {});
  std::istringstream text(obj_text(hull, {100, 0, -0.5}));
  std::string word;
  for (const glm::vec3& corner : hull.corners) {
    glm::dvec3 at;
    text >> word >> at.x >> at.y >> at.z;
    CHECK(word == "v");
    CHECK(at == glm::dvec3(corner) + glm::dvec3(100, 0, -0.5));
  }
  for (const auto& triangle : hull.triangles) {
    std::uint32_t a = 0, b = 0, c = 0;
    text >> word >> a >> b >> c;
    CHECK(word == "f");
    CHECK(std::array<std::uint32_t, 3>{a - 1, b - 1, c - 1} == triangle);
  }
  CHECK_FALSE(static_cast<bool>(text >> word));
}
