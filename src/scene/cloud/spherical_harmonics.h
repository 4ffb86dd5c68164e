// Real spherical harmonics with the signs of 3DGS files, and how their coefficients turn with a scene.
#pragma once

#include <array>
#include <glm/glm.hpp>
#include <span>

namespace splatcut {

// The SH basis functions beyond the constant one in a unit direction: the first sh_rest_coefficients(degree)
// of `basis` are written. Returns that number.
int sh_rest_basis(int degree, const glm::vec3& direction, float basis[15]);

// Coefficients before a rotation of the scene to those after it: band by band the matrix that gives every
// direction the colour that it had before it was turned.
class ShTurn {
 public:
  explicit ShTurn(const glm::mat3& rotation);

  // rest: of one Gaussian, channel-major, of that degree.
  void apply(std::span<float> rest, int degree) const;

 private:
  static constexpr int kMostInBand = 7;
  using BandMatrix = std::array<std::array<double, kMostInBand>, kMostInBand>;
  static void solve(BandMatrix* matrix, BandMatrix* right, std::size_t n);
  static BandMatrix of_band(int band, const glm::mat3& rotation);

  std::array<BandMatrix, 3> bands_;
};

}  // namespace splatcut
