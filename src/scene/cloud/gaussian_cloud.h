// The immutable scene: N anisotropic Gaussians as a structure of arrays, in Morton order.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>
#include <span>
#include <vector>

namespace splatcut {

// SH coefficients per channel beyond the constant one: 0, 3, 8, 15 for degree 0..3.
constexpr int sh_rest_coefficients(int degree) {
  return (degree + 1) * (degree + 1) - 1;
}

struct GaussianCloud {
  std::vector<glm::vec3> position;  // world, scene units, finite
  std::vector<glm::vec3> scale;     // standard deviations along the local axes, scene units, >= 0 (linear)
  std::vector<glm::quat> rotation;  // world from local, unit length
  std::vector<float> opacity;       // [0, 1]
  std::vector<glm::vec3> f_dc;      // constant SH coefficient; base colour = 0.5 + 0.28209479 f_dc
  std::vector<float> sh_rest;       // per Gaussian 3 * sh_rest_coefficients values, channel-major as in .ply:
                                    // all of red, then green, then blue
  int sh_degree = 0;                // 0..3
  std::vector<std::uint32_t> file_row;  // row of each Gaussian in the file it came from
  // Trained with the filter of Mip-Splatting: a picture takes off a Gaussian's opacity what the low-pass adds
  // to its area.
  bool antialiased = false;
  float near_plane = 0.2f;  // scene units: pictures leave out what is nearer; see natural_near_plane()

  std::size_t size() const { return position.size(); }
  bool empty() const { return position.empty(); }
  std::size_t sh_stride() const { return 3 * static_cast<std::size_t>(sh_rest_coefficients(sh_degree)); }
  std::span<const float> sh_rest_of(std::size_t g) const {
    return std::span(sh_rest).subspan(g * sh_stride(), sh_stride());
  }
  void resize(std::size_t n, int degree);
};

// The Gaussians order[0], order[1], ... of cloud, all attributes.
GaussianCloud permuted(const GaussianCloud& cloud, std::span<const std::uint32_t> order);

// Axis-aligned box that holds the fraction `inside` of the positions in each axis: outlier splats
// cannot blow it up.
struct Box {
  glm::vec3 min{0}, max{0};
  glm::vec3 centre() const { return 0.5f * (min + max); }
  glm::vec3 extent() const { return max - min; }
};
Box robust_bounds(std::span<const glm::vec3> positions, double inside = 0.98);

// The median of these Gaussians' largest standard deviations, scene units.
float middle_size(const GaussianCloud& cloud, std::span<const std::uint32_t> gaussians);

// What the first view shows: nine tenths of the positions in each axis; where all are one point, its
// Gaussians.
Box framed_bounds(const GaussianCloud& cloud);

// That share of the diagonal of robust_bounds(): about the 0.2 units that scenes are trained with where those
// have the usual units, and the same picture where they have others. A scene without extent has
// GaussianCloud's own.
constexpr float kNaturalNearShare = 0.01f;
float natural_near_plane(std::span<const glm::vec3> positions);
// The same, of framed_bounds() where all are one point, and never more than 7.5 times the size (largest axis)
// that a tenth of the Gaussians exceed: what is nearer than that is a blur, and a scene of many rooms must
// not hide what stands in one of them. load_scene() sets it.
float near_plane_of(const GaussianCloud& cloud);

}  // namespace splatcut
