#include "scene/cloud/joined_clouds.h"

#include <algorithm>

namespace splatcut {

namespace {

// Coefficients stand channel after channel, so that those of a lower degree lie apart in a higher one.
void copy_sh(const GaussianCloud& cloud, std::size_t begin, GaussianCloud* whole) {
  const auto had = static_cast<std::size_t>(sh_rest_coefficients(cloud.sh_degree));
  const auto has = static_cast<std::size_t>(sh_rest_coefficients(whole->sh_degree));
  for (std::size_t row = 0; row < 3 * cloud.size(); ++row)  // a channel of a Gaussian
    std::copy_n(cloud.sh_rest.data() + row * had, had, whole->sh_rest.data() + (3 * begin + row) * has);
}

void copy(const GaussianCloud& cloud, std::size_t begin, GaussianCloud* whole) {
  const auto at = static_cast<std::ptrdiff_t>(begin);
  std::ranges::copy(cloud.position, whole->position.begin() + at);
  std::ranges::copy(cloud.scale, whole->scale.begin() + at);
  std::ranges::copy(cloud.rotation, whole->rotation.begin() + at);
  std::ranges::copy(cloud.opacity, whole->opacity.begin() + at);
  std::ranges::copy(cloud.f_dc, whole->f_dc.begin() + at);
  std::ranges::copy(cloud.file_row, whole->file_row.begin() + at);
  copy_sh(cloud, begin, whole);
}

}  // namespace

GaussianCloud joined(std::vector<GaussianCloud> clouds) {
  GaussianCloud whole;
  if (clouds.empty()) return whole;
  std::size_t size = 0;
  int degree = 0;
  for (const GaussianCloud& cloud : clouds) {
    size += cloud.size();
    degree = std::max(degree, cloud.sh_degree);
  }
  whole.resize(size, degree);
  whole.near_plane = clouds.front().near_plane;
  whole.antialiased = std::ranges::all_of(clouds, &GaussianCloud::antialiased);
  std::size_t begin = 0;
  for (GaussianCloud& cloud : clouds) {
    copy(cloud, begin, &whole);
    begin += cloud.size();
    cloud = {};
  }
  return whole;
}

}  // namespace splatcut
