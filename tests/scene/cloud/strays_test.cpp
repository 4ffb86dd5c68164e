// Strays: few points apart from the rest, wherever they are, and nothing else.
#include "scene/cloud/strays.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <random>

using namespace splatcut;

namespace {

// A ball's surface.
std::vector<glm::vec3> ball(std::size_t count, const glm::vec3& centre, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<float> normal;
  std::vector<glm::vec3> points;
  for (std::size_t i = 0; i < count; ++i)
    points.push_back(centre + glm::normalize(glm::vec3(normal(random), normal(random), normal(random))));
  return points;
}

std::size_t count(const std::vector<std::uint8_t>& flags) {
  return static_cast<std::size_t>(std::ranges::count(flags, 1));
}

}  // namespace

TEST_CASE("strays: none in a thing of few or many points, nor in two things, nor where all is one point") {
  for (const std::size_t points : {1u, 5u, 30u, 300u, 3000u, 100000u}) {
    CAPTURE(points);
    std::vector<glm::vec3> one = ball(points, {5, -3, 2}, 1);
    CHECK(count(strays_of(one)) <= points / 50);
    const std::vector<glm::vec3> other = ball(points, {12, -3, 2}, 2);
    one.insert(one.end(), other.begin(), other.end());
    CHECK(count(strays_of(one)) <= one.size() / 50);
  }
  CHECK(count(strays_of(std::vector<glm::vec3>(100, glm::vec3(1)))) == 0);
  CHECK(strays_of({}).empty());
}

TEST_CASE("strays: points far from a thing, a twentieth of all behind it, too") {
  for (const std::size_t points : {500u, 5000u, 60000u}) {
    CAPTURE(points);
    std::vector<glm::vec3> all = ball(points, {0, 0, 0}, 3);
    std::mt19937 random(4);
    std::uniform_real_distribution<float> far(5, 60);
    const std::size_t strays = points / 20;
    for (std::size_t i = 0; i < strays; ++i) all.emplace_back(far(random), far(random), far(random));
    const std::vector<std::uint8_t> found = strays_of(all);
    CHECK(count(found) >= strays * 95 / 100);
    CHECK(std::count(found.begin(), found.begin() + static_cast<std::ptrdiff_t>(points), 1) <=
          static_cast<std::ptrdiff_t>(points / 100));
    for (const glm::vec3& p : without_strays(all, 400)) CHECK(glm::length(p) < 40);
  }
}
