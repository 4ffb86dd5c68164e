// Small clouds with known content for tests.
#pragma once

#include <cmath>
#include <random>

#include "scene/camera/camera.h"
#include "scene/cloud/gaussian_cloud.h"

namespace splatcut::testing {

// n Gaussians of mixed size, orientation and opacity in a unit ball around the origin.
inline GaussianCloud random_cloud(std::size_t n, unsigned seed, int sh_degree = 0, float size = 0.05f) {
  std::mt19937 random(seed);
  const auto uniform = [&](float low, float high) {
    return low + (high - low) * static_cast<float>(random() >> 8) / 16777216.0f;
  };
  GaussianCloud cloud;
  cloud.resize(n, sh_degree);
  for (std::size_t g = 0; g < n; ++g) {
    cloud.position[g] = {uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)};
    for (int axis = 0; axis < 3; ++axis) cloud.scale[g][axis] = size * std::exp(uniform(-2, 0));
    cloud.rotation[g] =
        glm::normalize(glm::quat(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1), uniform(0.1f, 1)));
    cloud.opacity[g] = uniform(0, 1);
    for (int channel = 0; channel < 3; ++channel) cloud.f_dc[g][channel] = uniform(-1.5f, 1.5f);
    cloud.file_row[g] = static_cast<std::uint32_t>(g);
  }
  for (float& value : cloud.sh_rest) value = uniform(-0.2f, 0.2f);
  return cloud;
}

inline Camera front_camera(int width = 131, int height = 77) {
  return look_at({0, 0, -3}, {0, 0, 0}, {0, -1, 0}, 0.9f, width, height);
}

// One Gaussian on the optical axis of axis_camera(), seen as an isotropic splat.
inline GaussianCloud single_splat(float depth, float sigma, float opacity, const glm::vec3& colour) {
  GaussianCloud cloud;
  cloud.resize(1, 0);
  cloud.position[0] = {0, 0, depth};
  cloud.scale[0] = glm::vec3(sigma);
  cloud.opacity[0] = opacity;
  cloud.f_dc[0] = (colour - 0.5f) / 0.28209479177387814f;
  return cloud;
}

// At the world origin, looking along +z, principal point on the centre of pixel (16, 16).
inline Camera axis_camera() {
  Camera camera;
  camera.width_px = camera.height_px = 33;
  camera.fx_px = camera.fy_px = 100;
  camera.cx_px = camera.cy_px = 16.5f;
  return camera;
}

}  // namespace splatcut::testing
