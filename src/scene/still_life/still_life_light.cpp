// Baked light: a soft key light from a window, sky light, the lamp, and the shade the objects cast on each
// other. Occlusion and soft shadow of a sphere follow the closed forms of I. Quilez, "sphere ambient
// occlusion" and "sphere soft shadow" (iquilezles.org, 2007); spheres of the same object are skipped.
#include <algorithm>
#include <cmath>

#include "scene/still_life/still_life_model.h"

namespace splatcut::still_life {
namespace {

const glm::vec3 kToWindow = glm::normalize(at(-0.62f, 1.0f, -0.62f));
constexpr glm::vec3 kWindowColour{0.62f, 0.595f, 0.55f}, kSkyColour{0.50f, 0.515f, 0.55f};
constexpr glm::vec3 kLampColour{0.34f, 0.235f, 0.12f};
constexpr float kShadowSharpness = 5.0f;  // larger: smaller window
constexpr float kLampReach = 0.55f;       // distance at which the lamp has its nominal strength

float occlusion(const Proxy& ball, const glm::vec3& p, const glm::vec3& n) {
  const glm::vec3 d = ball.centre - p;
  const float l = glm::length(d);
  if (l <= ball.radius) return 0.75f;
  const float h = l / ball.radius;
  return std::max(0.0f, glm::dot(n, d / l)) / (h * h);
}

float shadow(const Proxy& ball, const glm::vec3& p, const glm::vec3& to_light) {
  const glm::vec3 oc = p - ball.centre;
  const float b = glm::dot(oc, to_light);
  if (b > 0) return 1;  // the ball is behind the point
  const float h = b * b - glm::dot(oc, oc) + ball.radius * ball.radius;
  if (h > 0) return 0;  // the ray to the light meets the ball
  const float gap = std::sqrt(ball.radius * ball.radius - h) - ball.radius;
  return glm::smoothstep(0.0f, 1.0f, gap / std::max(1e-4f, -b) * kShadowSharpness);
}

struct Exposure {
  float sky = 1, key = 1;
};

Exposure exposure_at(const Model& model, const glm::vec3& p, const glm::vec3& n, std::uint8_t label) {
  Exposure e;
  for (const Proxy& ball : model.proxies) {
    if (ball.label == label) continue;
    e.sky *= 1 - 0.80f * std::min(1.0f, occlusion(ball, p, n));
    e.key = std::min(e.key, shadow(ball, p, kToWindow));
  }
  return e;
}

}  // namespace

Lit lit(const Model& model, const SurfaceSample& sample, const Material& material, std::uint8_t label) {
  const glm::vec3& n = sample.normal;
  const Exposure e = exposure_at(model, sample.position, n, label);
  const float up = 0.5f - 0.5f * n.y;
  // Wrapped Lambert: the window is large, so the terminator is soft.
  const float key = std::max(0.0f, (glm::dot(n, kToWindow) + 0.25f) / 1.25f) * (0.12f + 0.88f * e.key);
  const glm::vec3 to_lamp = kLampBulb - sample.position;
  const float distance = std::max(0.15f, glm::length(to_lamp));
  const float reach = kLampReach / distance;
  const float lamp = std::max(0.0f, glm::dot(n, to_lamp) / distance) * std::min(2.0f, reach * reach);
  const glm::vec3 sky = kSkyColour * (0.55f + 0.45f * up) * e.sky;
  const glm::vec3 bounce = glm::vec3(0.10f, 0.075f, 0.05f) * (1 - up);  // from the wood
  const glm::vec3 light = sky + bounce + kWindowColour * key + kLampColour * lamp;
  Lit out;
  out.colour = glm::mix(material.colour * light, material.colour, material.glow);
  out.mirror = glm::normalize(2.0f * glm::dot(n, kToWindow) * n - kToWindow);
  return out;
}

}  // namespace splatcut::still_life
