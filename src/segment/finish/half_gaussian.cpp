#include "segment/finish/half_gaussian.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/symmetric_eigen.h"
#include "scene/raster/splat_math.h"

namespace splatcut {

namespace {

double density(double x) {
  return std::exp(-0.5 * x * x) / std::sqrt(2 * std::numbers::pi);
}

double distribution(double x) {
  return 0.5 * std::erfc(-x / std::numbers::sqrt2);
}

glm::dmat3 covariance_of(const SolidGaussian& g) {
  glm::dmat3 axes = glm::mat3_cast(glm::dquat(g.rotation));
  for (int axis = 0; axis < 3; ++axis) axes[axis] *= static_cast<double>(g.scale[axis]);
  return axes * glm::transpose(axes);
}

}  // namespace

// Bisection: a few hundred thousand calls an export cost less than a table's error would.
double probit(double p) {
  double low = -9, high = 9;
  constexpr int kHalvings = 34;  // 18 / 2^34 = 1e-9
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = 0.5 * (low + high);
    (distribution(middle) < p ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

void scale_and_rotation(const glm::dmat3& covariance, glm::vec3* scale, glm::quat* rotation) {
  const auto [values, axes] = symmetric_eigen(covariance);
  *rotation = glm::normalize(glm::quat(glm::normalize(glm::quat_cast(axes))));
  for (int axis = 0; axis < 3; ++axis)
    (*scale)[axis] = static_cast<float>(std::sqrt(std::max(0.0, values[axis])));
}

SolidGaussian half_gaussian(const SolidGaussian& whole, const glm::vec3& normal, double share) {
  const glm::dmat3 sigma = covariance_of(whole);
  const glm::dvec3 across = sigma * glm::dvec3(normal);
  const double variance = glm::dot(glm::dvec3(normal), across);
  if (!(variance > 0) || !(share > 0) || !(share < 1)) return whole;
  const double tau = probit(1 - share), lambda = density(tau) / share;
  constexpr double kMostNarrowing = 0.98;  // a sliver keeps a seventh of its width: it stays an ellipse
  const double delta = std::min(kMostNarrowing, lambda * (lambda - tau));
  SolidGaussian half = whole;
  half.mean = glm::vec3(glm::dvec3(whole.mean) + lambda / std::sqrt(variance) * across);
  scale_and_rotation(sigma - delta / variance * glm::outerProduct(across, across), &half.scale,
                     &half.rotation);
  half.opacity = std::min(kAlphaMax, whole.opacity * static_cast<float>(share / std::sqrt(1 - delta)));
  return half;
}

}  // namespace splatcut
