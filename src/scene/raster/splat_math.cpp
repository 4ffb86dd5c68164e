#include "scene/raster/splat_math.h"

#include <algorithm>
#include <cmath>

namespace splatcut {

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

float antialiased_share(const Symmetric2& sharp, const Symmetric2& blurred) {
  const float det_sharp = sharp.a * sharp.c - sharp.b * sharp.b;
  const float det_blurred = blurred.a * blurred.c - blurred.b * blurred.b;
  return std::sqrt(std::max(det_sharp, 0.0f) / det_blurred);
}

bool project(const GaussianCloud& cloud, std::size_t g, const Camera& camera, float near_plane, Splat* splat,
             float low_pass_px2) {
  const float opacity = cloud.opacity[g];
  if (opacity < kAlphaMin) return false;
  const glm::vec3 point_camera = camera.camera_from_world(cloud.position[g]);
  if (!(point_camera.z >= near_plane)) return false;
  const glm::mat3 sigma = covariance_world(cloud.scale[g], cloud.rotation[g]);
  const Symmetric2 sharp = covariance_px2(camera, point_camera, sigma, 0);
  const Symmetric2 s{sharp.a + low_pass_px2, sharp.b, sharp.c + low_pass_px2};
  const float det = s.a * s.c - s.b * s.b;
  if (!(det > 0) || !std::isfinite(det)) return false;
  splat->opacity = cloud.antialiased ? opacity * antialiased_share(sharp, s) : opacity;
  if (splat->opacity < kAlphaMin) return false;
  splat->mean_px = camera.pixel_from_camera(point_camera);
  splat->covariance_px2 = s;
  splat->conic = {s.c / det, -s.b / det, s.a / det};
  splat->depth = point_camera.z;
  const float mahalanobis2 = 2.0f * std::log(splat->opacity / kAlphaMin);
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
