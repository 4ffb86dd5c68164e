#include "scene/cloud/spherical_harmonics.h"

#include <cmath>
#include <utility>

namespace splatcut {

namespace {

constexpr float kShC1 = 0.4886025119029199f;
constexpr float kShC2[] = {1.0925484305920792f, -1.0925484305920792f, 0.31539156525252005f,
                           -1.0925484305920792f, 0.5462742152960396f};
constexpr float kShC3[] = {-0.5900435899266435f, 2.890611442640554f,   -0.4570457994644658f,
                           0.3731763325901154f,  -0.4570457994644658f, 1.445305721320277f,
                           -0.5900435899266435f};

// Spread over the sphere without symmetry, so that no band is blind to them.
glm::vec3 spread_direction(int i) {
  const float z = 0.93f - 0.27f * static_cast<float>(i), angle = 2.3999632f * static_cast<float>(i) + 0.4f;
  const float ring = std::sqrt(1 - z * z);
  return {ring * std::cos(angle), ring * std::sin(angle), z};
}

}  // namespace

int sh_rest_basis(int degree, const glm::vec3& d, float basis[15]) {
  if (degree < 1) return 0;
  const float x = d.x, y = d.y, z = d.z;
  basis[0] = -kShC1 * y;
  basis[1] = kShC1 * z;
  basis[2] = -kShC1 * x;
  if (degree < 2) return 3;
  const float xx = x * x, yy = y * y, zz = z * z;
  basis[3] = kShC2[0] * x * y;
  basis[4] = kShC2[1] * y * z;
  basis[5] = kShC2[2] * (2 * zz - xx - yy);
  basis[6] = kShC2[3] * x * z;
  basis[7] = kShC2[4] * (xx - yy);
  if (degree < 3) return 8;
  basis[8] = kShC3[0] * y * (3 * xx - yy);
  basis[9] = kShC3[1] * x * y * z;
  basis[10] = kShC3[2] * y * (4 * zz - xx - yy);
  basis[11] = kShC3[3] * z * (2 * zz - 3 * xx - 3 * yy);
  basis[12] = kShC3[4] * x * (4 * zz - xx - yy);
  basis[13] = kShC3[5] * z * (xx - yy);
  basis[14] = kShC3[6] * x * (xx - 3 * yy);
  return 15;
}

ShTurn::ShTurn(const glm::mat3& rotation) {
  for (int band = 1; band <= 3; ++band) bands_[static_cast<std::size_t>(band - 1)] = of_band(band, rotation);
}

// Gauss with pivots: the columns of `right` become matrix^-1 right.
void ShTurn::solve(BandMatrix* matrix, BandMatrix* right, std::size_t n) {
  for (std::size_t c = 0; c < n; ++c) {
    std::size_t pivot = c;
    for (std::size_t r = c; r < n; ++r)
      if (std::abs((*matrix)[r][c]) > std::abs((*matrix)[pivot][c])) pivot = r;
    std::swap((*matrix)[c], (*matrix)[pivot]);
    std::swap((*right)[c], (*right)[pivot]);
    for (std::size_t r = 0; r < n; ++r) {
      if (r == c) continue;
      const double factor = (*matrix)[r][c] / (*matrix)[c][c];
      for (std::size_t k = 0; k < n; ++k) {
        (*matrix)[r][k] -= factor * (*matrix)[c][k];
        (*right)[r][k] -= factor * (*right)[c][k];
      }
    }
  }
  for (std::size_t r = 0; r < n; ++r)
    for (std::size_t k = 0; k < n; ++k) (*right)[r][k] /= (*matrix)[r][r];
}

ShTurn::BandMatrix ShTurn::of_band(int band, const glm::mat3& rotation) {
  const std::size_t first = static_cast<std::size_t>(band * band - 1),
                    n = static_cast<std::size_t>(2 * band + 1);
  BandMatrix after{}, before{};
  for (std::size_t row = 0; row < n; ++row) {
    const glm::vec3 d = spread_direction(static_cast<int>(row));
    float now[15], then[15];
    sh_rest_basis(band, d, now);
    sh_rest_basis(band, glm::transpose(rotation) * d, then);
    for (std::size_t k = 0; k < n; ++k) {
      after[row][k] = static_cast<double>(now[first + k]);
      before[row][k] = static_cast<double>(then[first + k]);
    }
  }
  solve(&after, &before, n);
  return before;
}

void ShTurn::apply(std::span<float> rest, int degree) const {
  const std::size_t per_channel = rest.size() / 3;
  for (std::size_t channel = 0; channel < 3; ++channel)
    for (int band = 1; band <= degree; ++band) {
      const std::size_t n = static_cast<std::size_t>(2 * band + 1);
      const std::span<float> own =
          rest.subspan(channel * per_channel + static_cast<std::size_t>(band * band - 1), n);
      std::array<double, kMostInBand> turned{};
      const BandMatrix& turn = bands_[static_cast<std::size_t>(band - 1)];
      for (std::size_t r = 0; r < n; ++r)
        for (std::size_t k = 0; k < n; ++k) turned[r] += turn[r][k] * static_cast<double>(own[k]);
      for (std::size_t r = 0; r < n; ++r) own[r] = static_cast<float>(turned[r]);
    }
}

}  // namespace splatcut
