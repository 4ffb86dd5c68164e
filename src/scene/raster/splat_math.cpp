#include "scene/raster/splat_math.h"

#include <algorithm>
#include <cmath>

namespace splatcut {

namespace {

// Real spherical harmonics constants in the sign convention of 3DGS files.
constexpr float kShC1 = 0.4886025119029199f;
constexpr float kShC2[] = {1.0925484305920792f, -1.0925484305920792f, 0.31539156525252005f,
                           -1.0925484305920792f, 0.5462742152960396f};
constexpr float kShC3[] = {-0.5900435899266435f, 2.890611442640554f,   -0.4570457994644658f,
                           0.3731763325901154f,  -0.4570457994644658f, 1.445305721320277f,
                           -0.5900435899266435f};

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

glm::mat3 covariance_world(const glm::vec3& scale, const glm::quat& rotation) {
  glm::mat3 m = glm::mat3_cast(rotation);
  for (int axis = 0; axis < 3; ++axis) m[axis] *= scale[axis];
  return m * glm::transpose(m);
}

glm::vec3 shortest_axis(const glm::vec3& scale, const glm::quat& rotation) {
  const glm::mat3 world_from_local = glm::mat3_cast(rotation);
  const int axis = scale.x <= scale.y && scale.x <= scale.z ? 0 : scale.y <= scale.z ? 1 : 2;
  return world_from_local[axis];
}

PixelJacobian pixel_jacobian(const Camera& camera, const glm::vec3& point_camera) {
  const float z = point_camera.z;
  const float limit_x = kFrustumSlack * 0.5f * static_cast<float>(camera.width_px) / camera.fx_px;
  const float limit_y = kFrustumSlack * 0.5f * static_cast<float>(camera.height_px) / camera.fy_px;
  const float x = std::clamp(point_camera.x / z, -limit_x, limit_x) * z;
  const float y = std::clamp(point_camera.y / z, -limit_y, limit_y) * z;
  const glm::mat3 world_from_camera = glm::transpose(camera.camera_from_world_rotation);
  return {world_from_camera * glm::vec3(camera.fx_px / z, 0, -camera.fx_px * x / (z * z)),
          world_from_camera * glm::vec3(0, camera.fy_px / z, -camera.fy_px * y / (z * z))};
}

Symmetric2 covariance_px2(const Camera& camera, const glm::vec3& point_camera, const glm::mat3& sigma_world,
                          float low_pass_px2) {
  const auto [u, v] = pixel_jacobian(camera, point_camera);
  const glm::vec3 sigma_u = sigma_world * u, sigma_v = sigma_world * v;
  return {glm::dot(u, sigma_u) + low_pass_px2, glm::dot(u, sigma_v), glm::dot(v, sigma_v) + low_pass_px2};
}

bool project(const GaussianCloud& cloud, std::size_t g, const Camera& camera, float near_plane, Splat* splat,
             float low_pass_px2) {
  const float opacity = cloud.opacity[g];
  if (opacity < kAlphaMin) return false;
  const glm::vec3 point_camera = camera.camera_from_world(cloud.position[g]);
  if (!(point_camera.z >= near_plane)) return false;
  const glm::mat3 sigma = covariance_world(cloud.scale[g], cloud.rotation[g]);
  const Symmetric2 s = covariance_px2(camera, point_camera, sigma, low_pass_px2);
  const float det = s.a * s.c - s.b * s.b;
  if (!(det > 0) || !std::isfinite(det)) return false;
  splat->mean_px = camera.pixel_from_camera(point_camera);
  splat->covariance_px2 = s;
  splat->conic = {s.c / det, -s.b / det, s.a / det};
  splat->depth = point_camera.z;
  const float mahalanobis2 = 2.0f * std::log(opacity / kAlphaMin);
  splat->extent_px = {std::sqrt(mahalanobis2 * s.a), std::sqrt(mahalanobis2 * s.c)};
  return true;
}

glm::vec3 sh_colour(const glm::vec3& f_dc, std::span<const float> rest, int degree,
                    const glm::vec3& direction_world) {
  float basis[15];
  const int used = sh_rest_basis(degree, direction_world, basis);
  const std::size_t stride = rest.size() / 3;
  glm::vec3 colour = 0.5f + kShC0 * f_dc;
  for (int channel = 0; channel < 3; ++channel)
    for (int k = 0; k < used; ++k)
      colour[channel] += basis[k] * rest[static_cast<std::size_t>(channel) * stride + k];
  return glm::max(colour, 0.0f);
}

}  // namespace splatcut
