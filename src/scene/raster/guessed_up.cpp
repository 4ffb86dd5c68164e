#include "scene/raster/guessed_up.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "scene/cloud/ground_plane.h"

namespace splatcut {

namespace {

// A Gaussian as a disc.
struct Disc {
  glm::vec3 centre, normal;
  float area;  // sigma^2
};

std::vector<Disc> sampled_discs(const GaussianCloud& cloud) {
  constexpr std::size_t kSample = 1 << 16;
  constexpr float kLeastOpacity = 0.1f;
  constexpr double kAreaQuantile = 0.985;  // sky and haze are huge, and no ground
  const Box box = robust_bounds(cloud.position, 0.96);
  std::vector<Disc> discs;
  const std::size_t step = std::max<std::size_t>(1, cloud.size() / kSample);
  for (std::size_t g = 0; g < cloud.size(); g += step) {
    const glm::vec3 p = cloud.position[g], s = cloud.scale[g];
    if (cloud.opacity[g] < kLeastOpacity || glm::any(glm::lessThan(p, box.min)) ||
        glm::any(glm::greaterThan(p, box.max)))
      continue;
    const int thin = s.x <= s.y && s.x <= s.z ? 0 : s.y <= s.z ? 1 : 2;
    discs.push_back({p, glm::mat3_cast(cloud.rotation[g])[thin], s[(thin + 1) % 3] * s[(thin + 2) % 3]});
  }
  if (discs.empty()) return discs;
  std::vector<float> areas;
  for (const Disc& d : discs) areas.push_back(d.area);
  const auto high =
      areas.begin() + static_cast<std::ptrdiff_t>(kAreaQuantile * static_cast<double>(areas.size() - 1));
  std::ranges::nth_element(areas, high);
  std::erase_if(discs, [&](const Disc& d) { return d.area > *high; });
  return discs;
}

// On the scale of grounds: a captured room or yard has .06 to .7, what is none up to .034.
double prior_of(const glm::vec3& up) {
  if (up.y < -0.5f) return 0.045;
  if (up.z > 0.5f) return 0.01;
  return up.y > 0.5f ? 0.005 : 0;
}

// Areas in slabs across `axis`, from its low end to its high one.
struct Slabs {
  static constexpr int kCount = 32;
  std::array<double, kCount> level{}, standing{};
  double flat = 0;  // the lesser extent across the axis over that along it
};

Slabs slabs_along(const std::vector<Disc>& discs, int axis) {
  constexpr float kLevel = 0.906f;  // cosine of 25 degrees
  glm::vec3 low = discs.front().centre, high = low;
  for (const Disc& d : discs) low = glm::min(low, d.centre), high = glm::max(high, d.centre);
  const float from = low[axis], extent = std::max(1e-30f, high[axis] - from);
  const glm::vec3 size = high - low;
  Slabs slabs;
  slabs.flat = std::min(size[(axis + 1) % 3], size[(axis + 2) % 3]) / extent;
  double all = 0;
  for (const Disc& d : discs) {
    const int slab =
        std::min(Slabs::kCount - 1, static_cast<int>((d.centre[axis] - from) / extent * Slabs::kCount));
    (std::abs(d.normal[axis]) > kLevel ? slabs.level : slabs.standing)[static_cast<std::size_t>(slab)] +=
        d.area;
    all += d.area;
  }
  for (auto* areas : {&slabs.level, &slabs.standing})
    for (double& a : *areas) a /= std::max(1e-30, all);
  return slabs;
}

double ground_score(Slabs slabs, bool upwards) {
  if (!upwards) {
    std::ranges::reverse(slabs.level);
    std::ranges::reverse(slabs.standing);
  }
  double best = 0;
  for (int s = 0; s < Slabs::kCount; ++s) {
    const auto sum = [](const std::array<double, Slabs::kCount>& areas, int begin, int end) {
      double area = 0;
      for (int i = std::max(0, begin); i < std::min(Slabs::kCount, end); ++i)
        area += areas[static_cast<std::size_t>(i)];
      return area;
    };
    const double ground =
        sum(slabs.level, s - 1, s + 2);  // a slab's neighbours: it need not lie on their border
    const double above = sum(slabs.standing, s + 1, s + 1 + Slabs::kCount / 2);
    const double below = sum(slabs.standing, 0, s - 1) + sum(slabs.level, 0, s - 1);
    best = std::max(best, ground * (above - below));
  }
  return best;
}

// Weighted moments of places across y.
struct Across {
  double weight = 0, x = 0, z = 0, squares = 0;
  void add(double w, double px, double pz) {
    weight += w;
    x += w * px;
    z += w * pz;
    squares += w * (px * px + pz * pz);
  }
  double variance() const { return weight > 0 ? (squares - (x * x + z * z) / weight) / weight : 0; }
};

// As stands() has it, y down; 0 for what has no height or nothing in a third.
double standing_evidence(const GaussianCloud& cloud) {
  constexpr std::size_t kSample = 1 << 16;
  constexpr double kLow = 0.1, kSpread = 0.5;
  const Box box = robust_bounds(cloud.position, 0.96);
  const glm::dvec3 least(box.min), height(box.extent().y);
  if (!(height.y > 0)) return 0;
  Across lower, upper;
  double sum = 0, all = 0;
  const std::size_t step = std::max<std::size_t>(1, cloud.size() / kSample);
  for (std::size_t g = 0; g < cloud.size(); g += step) {
    const glm::vec3 &p = cloud.position[g], &s = cloud.scale[g];
    if (glm::any(glm::lessThan(p, box.min)) || glm::any(glm::greaterThan(p, box.max))) continue;
    const glm::dvec3 at = (glm::dvec3(p) - least) / height;
    const glm::dvec3 size = glm::dvec3(s) / height;
    const double w = cloud.opacity[g] * std::pow(size.x * size.y * size.z, 2.0 / 3);
    sum += w * (at.y - 0.5);
    all += w;
    if (at.y > 2.0 / 3) lower.add(w, at.x, at.z);
    if (at.y < 1.0 / 3) upper.add(w, at.x, at.z);
  }
  const double below = lower.variance(), above = upper.variance();
  if (!(below > 0) || !(above > 0)) return 0;
  return sum / all / kLow + 0.5 * std::log(below / above) / kSpread;
}

}  // namespace

std::optional<bool> stands(const GaussianCloud& cloud) {
  constexpr std::size_t kFewest = 100;  // of fewer, chance decides
  if (cloud.size() < kFewest) return {};
  constexpr double kGround = 0.06;   // as prior_of() has it
  constexpr double kEvidence = 0.4;  // of 20 captures that stand with -y up, 16 have more, one less than -0.4
  if (const std::vector<Disc> discs = sampled_discs(cloud); !discs.empty()) {
    const Slabs slabs = slabs_along(discs, 2);
    const double up = slabs.flat * ground_score(slabs, true), down = slabs.flat * ground_score(slabs, false);
    if (std::max(up, down) > kGround && up != down) return up > down;
  }
  const double evidence = standing_evidence(cloud);
  if (!(std::abs(evidence) > kEvidence)) return {};
  return evidence > 0;
}

UpGuess up_guess(const GaussianCloud& cloud) {
  glm::vec3 best(0, -1, 0);
  const std::vector<Disc> discs = sampled_discs(cloud);
  if (discs.empty()) return {best, false};
  double best_score = prior_of(best), next_score = 0, best_ground = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const Slabs slabs = slabs_along(discs, axis);
    for (const float sign : {-1.0f, 1.0f}) {
      glm::vec3 up(0);
      up[axis] = sign;
      const double ground = slabs.flat * ground_score(slabs, sign > 0), score = prior_of(up) + ground;
      if (up == best) best_ground = ground;
      if (score > best_score) {
        if (up != best) next_score = std::max(next_score, best_score);
        best_score = score, best = up, best_ground = ground;
      } else if (up != best) {
        next_score = std::max(next_score, score);
      }
    }
  }
  // Aligned by a program, a scene is exactly level, which the plane is not.
  constexpr float kLevel = 0.9986f;  // cosine of 3 degrees
  const std::optional<glm::vec3> ground = ground_normal(cloud, best);
  constexpr double kGroundThere = 0.035;  // see prior_of()
  constexpr double kClear = 2;            // times the score of any other direction; a wrong one had 1.75
  const bool sure = ground && best_ground > kGroundThere && best_score > kClear * next_score;
  return {ground && glm::dot(*ground, best) < kLevel ? *ground : best, sure};
}

glm::vec3 guessed_up(const GaussianCloud& cloud) {
  return up_guess(cloud).up_world;
}

}  // namespace splatcut
