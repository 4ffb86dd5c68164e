// The splat maths shared, name by name, by the CPU rasterisers and the shaders.
// Source: Kerbl et al. 2023; Zwicker et al. 2001.
#pragma once

#include <glm/glm.hpp>
#include <span>

#include "scene/camera/camera.h"
#include "scene/cloud/gaussian_cloud.h"
#include "scene/cloud/spherical_harmonics.h"

namespace splatcut {

inline constexpr float kLowPassPx2 = 0.3f;       // added to Sigma2's diagonal: no splat thinner than a pixel
inline constexpr float kWebLowPassPx2 = 0.075f;  // of PlayCanvas and SuperSplat: 0.3, but in half pixels
inline constexpr float kAlphaMax = 0.99f;        // keeps T positive, as 3DGS is trained
inline constexpr float kAlphaMin = 1.0f / 255.0f;  // below an 8-bit step a contribution is skipped
inline constexpr float kTransmittanceStop = 1e-4f;
inline constexpr float kFrustumSlack = 1.3f;  // x/z, y/z are clamped to this many half fields of view in J
inline constexpr float kShC0 = 0.28209479177387814f;

// Symmetric 2x2 matrix [a b; b c].
struct Symmetric2 {
  float a = 0, b = 0, c = 0;
};

// One Gaussian as it lies in the picture.
struct Splat {
  glm::vec2 mean_px{0};
  Symmetric2 covariance_px2;  // Sigma2, low-pass included
  Symmetric2 conic;           // Sigma2^-1
  float opacity = 0;          // of the Gaussian; of an antialiased cloud times antialiased_share()
  float depth = 0;            // camera z, scene units
  glm::vec2 extent_px{0};     // half size of the box in which alpha >= kAlphaMin
};

// R diag(s^2) R^T, world frame, scene units squared.
glm::mat3 covariance_world(const glm::vec3& scale, const glm::quat& rotation);

// The unit axis along which the Gaussian is thinnest: its surface's normal, of either sign.
glm::vec3 shortest_axis(const glm::vec3& scale, const glm::quat& rotation);

// How pixels move with a point in the world, px per scene unit: rows of J W. Slopes are clamped as
// kFrustumSlack says.
struct PixelJacobian {
  glm::vec3 x, y;
};
PixelJacobian pixel_jacobian(const Camera& camera, const glm::vec3& point_camera);

// Sigma2 of a Gaussian whose mean is at point_camera.
Symmetric2 covariance_px2(const Camera& camera, const glm::vec3& point_camera, const glm::mat3& sigma_world,
                          float low_pass_px2 = kLowPassPx2);

// What stays of the opacity where the low-pass makes a splat larger, so that its sum over the picture is that
// of the Gaussian: sqrt(det sharp / det blurred). Source: Yu et al., Mip-Splatting, 2024, eq. 10.
float antialiased_share(const Symmetric2& sharp_px2, const Symmetric2& blurred_px2);

// False where the Gaussian is before the near plane, too faint (opacity < 1/255) or degenerate.
bool project(const GaussianCloud& cloud, std::size_t g, const Camera& camera, float near_plane, Splat* splat,
             float low_pass_px2 = kLowPassPx2);

// Colour in [0, inf) of SH coefficients seen along `direction_world` (unit, from camera to Gaussian).
glm::vec3 sh_colour(const glm::vec3& f_dc, std::span<const float> rest, int degree,
                    const glm::vec3& direction_world);

}  // namespace splatcut
