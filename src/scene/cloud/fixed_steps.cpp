#include "scene/cloud/fixed_steps.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/error.h"
#include "scene/cloud/moved_far.h"

namespace splatcut {

namespace {

constexpr float kFixedLimit = 8388607.0f;  // 2^23 - 1

float farthest_of(const glm::vec3& p) {
  return std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)});
}

// As many bits, up to the usual 12, as let the farthest coordinate fit into 24; more, where they fit, for a
// scene or Gaussians of that size that the usual steps would be too coarse for.
int fractional_bits_for(float farthest, float size) {
  constexpr int kUsual = 12, kMost = 24;
  int bits = kUsual;
  while (bits > 0 && std::ldexp(farthest, bits) > kFixedLimit) --bits;
  constexpr float kCoarse = 1 << kUsual, kStepsOfSize = 20;
  const auto too_coarse = [&] {
    return std::ldexp(farthest, bits) < kCoarse || std::ldexp(size, bits) < kStepsOfSize;
  };
  while (farthest > 0 && bits < kMost && too_coarse() && std::ldexp(farthest, bits + 1) <= kFixedLimit)
    ++bits;
  return bits;
}

}  // namespace

FixedSteps::FixedSteps(const GaussianCloud& cloud, std::span<const std::uint32_t> gaussians) {
  if (gaussians.empty()) return;
  std::vector<float> reach;
  reach.reserve(gaussians.size());
  for (const std::uint32_t g : gaussians) reach.push_back(farthest_of(cloud.position[g]));
  farthest = std::ranges::max(reach);
  size = middle_size(cloud, gaussians);
  bits = fractional_bits_for(farthest, size);
  constexpr std::size_t kFew = 1000;  // strays are at most one in so many, or one alone
  const std::size_t strays_at_most = (reach.size() + kFew - 1) / kFew;
  if (reach.size() <= strays_at_most) return;
  const auto last = reach.end() - 1 - static_cast<std::ptrdiff_t>(strays_at_most);
  std::ranges::nth_element(reach, last);
  const int finer = fractional_bits_for(*last, size);
  if (finer <= bits) return;
  for (const float r : reach) {
    const bool fits = std::ldexp(r, finer) <= kFixedLimit;
    strays += !fits;
    if (fits) others = std::max(others, r);
  }
}

float FixedSteps::step() const {
  return std::ldexp(1.0f, -bits);
}

float FixedSteps::rounded(float coordinate) const {
  return std::clamp(std::round(std::ldexp(coordinate, bits)), -kFixedLimit, kFixedLimit);
}

std::string FixedSteps::whose_fault() const {
  return fmt::format("{} Gaussian{} farther than {:.3g} units from 0, 0, 0 (up to {:.3g})", strays,
                     strays == 1 ? " lies" : "s lie", others, farthest);
}

void FixedSteps::check(const char* format, const GaussianCloud& cloud,
                       std::span<const std::uint32_t> gaussians) const {
  constexpr float kFewestSteps = 256;
  if (farthest == 0) return;
  if (std::ldexp(farthest, bits) > kFixedLimit || std::ldexp(farthest, bits) < kFewestSteps)
    throw Error(format, fmt::format("coordinates up to {:g} cannot be written in 24 bits", farthest),
                "Choose another format, or scale the scene");
  if (step() <= size) return;
  const std::string what = fmt::format(
      "24 bits for coordinates up to {:g} are steps of {:g}, larger than half of the Gaussians ({:g})",
      farthest, step(), size);
  if (strays > 0)
    throw Error(format, what + ", because " + whose_fault(),
                "Delete what lies there, or choose another format");
  glm::vec3 least(std::numeric_limits<float>::infinity()), most(-least);
  for (const std::uint32_t g : gaussians) {
    least = glm::min(least, cloud.position[g]);
    most = glm::max(most, cloud.position[g]);
  }
  const float nearer = farthest_of(0.5f * (most - least));
  const bool helps = std::ldexp(size, fractional_bits_for(nearer, size)) >= 1;
  throw Error(format, what,
              helps ? "Choose another format, or move the scene near the origin" : "Choose another format");
}

std::string FixedSteps::moved(const GaussianCloud& cloud, std::span<const std::uint32_t> gaussians) const {
  constexpr float kMostSteps = 0.9f;  // more than half a step along each axis, where all fit into 24 bits
  const bool all_fit = std::ldexp(farthest, bits) <= kFixedLimit;
  const float most = all_fit ? kMostSteps * step() : std::numeric_limits<float>::infinity();
  std::string said = moved_far(cloud, gaussians, kVisibly, [&](std::size_t i) {
    const glm::vec3 &p = cloud.position[gaussians[i]], &s = cloud.scale[gaussians[i]];
    if (most < kVisibly * std::max({s.x, s.y, s.z})) return p;  // the export dialog waits for it
    return glm::vec3(rounded(p.x), rounded(p.y), rounded(p.z)) * step();
  });
  if (!said.empty() && strays > 0)
    said += fmt::format(", because {}: without {} positions would be finer", whose_fault(),
                        strays == 1 ? "it" : "them");
  return said;
}

}  // namespace splatcut
