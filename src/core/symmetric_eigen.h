// Eigenvalues and eigenvectors of a symmetric 3x3 matrix by Jacobi's rotations (Golub and Van Loan, Matrix
// Computations, 8.5). Same input, same bits.
#pragma once

#include <cmath>
#include <glm/glm.hpp>

namespace splatcut {

struct SymmetricEigen {
  glm::dvec3 values;  // in no order
  glm::dmat3 axes;    // column i is the unit eigenvector of values[i]; right-handed
};

inline SymmetricEigen symmetric_eigen(glm::dmat3 s) {
  glm::dmat3 axes(1);
  constexpr int kSweeps = 12;  // converges quadratically: four or five do
  for (int sweep = 0; sweep < kSweeps; ++sweep)
    for (int p = 0; p < 2; ++p)
      for (int q = p + 1; q < 3; ++q) {
        if (std::abs(s[p][q]) <= 1e-18 * std::sqrt(std::abs(s[p][p] * s[q][q]))) continue;
        const double theta = 0.5 * (s[q][q] - s[p][p]) / s[p][q];
        const double t = (theta < 0 ? -1 : 1) / (std::abs(theta) + std::sqrt(theta * theta + 1));
        const double c = 1 / std::sqrt(t * t + 1);
        glm::dmat3 turn(1);
        turn[p][p] = turn[q][q] = c;
        turn[q][p] = t * c;
        turn[p][q] = -t * c;
        s = glm::transpose(turn) * s * turn;
        axes = axes * turn;
      }
  if (glm::determinant(axes) < 0) axes[0] = -axes[0];
  return {{s[0][0], s[1][1], s[2][2]}, axes};
}

}  // namespace splatcut
