// psi of the overlap energy (energy.h) for many pairs of Gaussians at a time. Internal to src/segment.
//
// Logarithm and exponential are polynomials without fused multiplication: the same bits on every machine and
// vector width. Error of D below 1e-5 of it beside the rounding of the determinants.
#pragma once

#include <glm/glm.hpp>

namespace splatcut {

// A symmetric matrix: the upper triangle, row by row.
struct Symmetric3 {
  float xx, xy, xz, yy, yz, zz;
};

// Pairs in structure-of-arrays form; unused lanes may hold anything.
struct OverlapBlock {
  static constexpr int kPairs = 16;
  alignas(64) float a[6][kPairs], b[6][kPairs];  // the two covariances, scene units squared
  alignas(64) float d[3][kPairs];                // difference of the positions, scene units
  alignas(64) float unlike[kPairs];    // what else speaks against the pair: gamma_colour |dbeta|^2 and more
  alignas(64) float distance[kPairs];  // out: D, infinite where an input was not finite
  alignas(64) float psi[kPairs];       // out: exp(-gamma_position D - unlike)

  void set(int pair, const Symmetric3& sigma_g, const Symmetric3& sigma_h, const glm::vec3& difference,
           float unlikeness);
};

void overlap_weights(OverlapBlock& block, float gamma_position);

}  // namespace splatcut
