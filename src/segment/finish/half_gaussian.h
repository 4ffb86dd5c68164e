// The part of a Gaussian that lies on one side of a plane, as a Gaussian again: mean and covariance are those
// of the truncated distribution, opacity keeps what shows in a view along the plane.
//
// In: a Gaussian (world frame, scene units), a normal that points to the side kept, the share 0 < w < 1 of it
// that lies there. Out: the child.
//   tau = probit(1 - w),  lambda = phi(tau) / w,  delta = lambda (lambda - tau),  s^2 = n' S n
//   mean += lambda S n / s,   S -= delta (S n)(S n)' / s^2,   opacity *= w / sqrt(1 - delta)
// The plane follows from the share: it need not pass through the middle.
// Source: moments of the truncated normal, Johnson, Kotz, Balakrishnan, Continuous Univariate Distributions,
// 1994, 10.1. Cost: one eigen-decomposition of a 3x3 matrix.
#pragma once

#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>

namespace splatcut {

struct SolidGaussian {
  glm::vec3 mean{0};
  glm::vec3 scale{0};              // standard deviations along the local axes
  glm::quat rotation{1, 0, 0, 0};  // world from local
  float opacity = 0;
};

// A plane that the Gaussian has no extent across, or a share so small that nothing stays, leave it as it is.
SolidGaussian half_gaussian(const SolidGaussian& whole, const glm::vec3& normal, double share);

// scale and rotation of a symmetric positive semidefinite matrix, by Jacobi's rotations. Rotation's
// determinant is +1.
void scale_and_rotation(const glm::dmat3& covariance, glm::vec3* scale, glm::quat* rotation);

// Where the standard normal distribution reaches p in (0, 1), absolute error below 1e-9.
double probit(double p);

}  // namespace splatcut
