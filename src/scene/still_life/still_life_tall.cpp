// The tall ones: the potted plant with its thin leaves and the lamp with its cable.
#include <cmath>

#include "core/counter_rng.h"
#include "scene/still_life/still_life_model.h"

namespace splatcut::still_life {
namespace {

constexpr float kPotX = 0.52f, kPotZ = 0.36f, kPotRadius = 0.20f, kPotHeight = 0.31f;
constexpr int kLeaves = 58;
constexpr float kLeafWidth = 0.034f;
constexpr float kLampX = -0.86f, kLampZ = 0.30f, kShadeLow = 0.68f, kShadeHigh = 0.98f;
constexpr float kCableRadius = 0.009f;

// One blade: rises from the soil, arches outwards and droops; folded a little along its midrib.
void add_leaf(Model& model, std::uint8_t label, int index, float width_scale) {
  CounterRng rng(0x1eaf, static_cast<std::uint64_t>(index));  // the plant itself is the same for every seed
  const float turn = (static_cast<float>(index) * 0.61803399f + rng.between(-0.03f, 0.03f)) * kTau;
  const float inner = static_cast<float>(index) / kLeaves;  // 0 outer, old and low; 1 inner and upright
  const float length = rng.between(0.46f, 0.64f) + 0.10f * inner;
  const float lean = glm::mix(1.00f, 0.16f, inner) + rng.between(-0.08f, 0.08f);
  const float droop = glm::mix(1.25f, 0.75f, inner) * rng.between(0.7f, 1.25f);
  const float width = kLeafWidth * width_scale * rng.between(0.8f, 1.2f);
  const float sway = rng.between(-0.35f, 0.35f), tone = rng.unit();
  const glm::vec3 out{std::cos(turn), 0, std::sin(turn)}, side{-std::sin(turn), 0, std::cos(turn)};
  const glm::vec3 root = at(kPotX, kPotHeight - 0.03f, kPotZ) + 0.07f * (1 - 0.6f * inner) * out;
  const auto rib = [=](float v) {
    // The angle from the vertical grows along the blade: the integral of its direction, in closed form.
    const float bend = droop, a0 = lean * 0.55f, a1 = a0 + bend * v;
    const float across = (std::cos(a0) - std::cos(a1)) / bend, rise = (std::sin(a1) - std::sin(a0)) / bend;
    return root + length * (across * out + glm::vec3(0, -rise, 0) + sway * 0.3f * v * v * side);
  };
  const auto blade = [=](float u, float v) {
    const float w = 2 * u - 1;
    const float half =
        0.5f * width * std::pow(std::sin(3.14159265f * (0.10f + 0.90f * v)), 0.7f) * (1.02f - 0.6f * v);
    return rib(v) + half * (w * side + glm::vec3(0, -0.35f * std::abs(w), 0));
  };
  const MaterialFn green = [=](const SurfaceSample& s) {
    const float w = std::abs(2 * s.uv.x - 1), v = s.uv.y;
    glm::vec3 colour =
        glm::mix(glm::vec3(0.23f, 0.42f, 0.19f), glm::vec3(0.50f, 0.66f, 0.28f), 0.55f * tone + 0.4f * v);
    if (w < 0.22f) colour = glm::mix(colour, glm::vec3(0.72f, 0.80f, 0.50f), 0.55f);  // midrib
    if (w > 0.80f) colour *= 0.9f;
    if (tone > 0.86f && v > 0.86f) colour = {0.66f, 0.52f, 0.28f};        // a few dry tips
    const float depth = 0.60f + 0.40f * glm::smoothstep(0.0f, 0.45f, v);  // dark where leaves crowd
    return Material{colour * depth, 0.10f, 0.97f, 0};
  };
  PatchShape shape{
      .surface = blade, .stretch = 0.4f, .turn_randomly = false, .limit_u = 0.20f, .limit_v = 0.05f};
  shape.face_up = true;
  shape.cells_u = 4;
  shape.cells_v = 48;
  model.patches.push_back({std::move(shape), green, label, 9});
}

// Cubic Catmull-Rom through points; v in [0, 1], clamped.
glm::vec3 spline(const std::vector<glm::vec3>& points, float v) {
  const auto last = static_cast<int>(points.size()) - 1;
  const float s = std::min(1.0f, std::max(0.0f, v)) * static_cast<float>(last);
  const int i = std::min(last - 1, static_cast<int>(s));
  const float t = s - static_cast<float>(i);
  const auto p = [&](int k) { return points[static_cast<std::size_t>(std::min(last, std::max(0, k)))]; };
  const glm::vec3 a = p(i - 1), b = p(i), c = p(i + 1), d = p(i + 2);
  return 0.5f * (2.0f * b + t * (c - a) + t * t * (2.0f * a - 5.0f * b + 4.0f * c - d) +
                 t * t * t * (3.0f * b - 3.0f * c + d - a));
}

void add_cable(Model& model, std::uint8_t label, float width_scale) {
  const float r = kCableRadius * width_scale;
  const std::vector<glm::vec3> points = {
      at(-0.90f, r, 0.22f),  at(-1.02f, r, 0.02f),           at(-0.90f, r, -0.16f),     at(-0.70f, r, -0.20f),
      at(-0.64f, r, -0.38f), at(-0.82f, r, -0.52f),          at(-1.05f, r, -0.50f),     at(-1.20f, r, -0.66f),
      at(-1.12f, r, -0.90f), at(-1.10f, r - 0.01f, -0.995f), at(-1.10f, -0.25f, -1.02f)};
  // Sideways reference never parallel to the cable: it runs in the table plane, then straight down.
  const auto path = [points](float v) { return spline(points, v); };
  PatchShape cable{.surface = tube(
                       path, [r](float) { return r; }, glm::vec3(0.18f, -0.9f, 0.39f)),
                   .stretch = 0.6f,
                   .turn_randomly = false,
                   .limit_u = 0.09f};
  cable.cells_u = 6;
  cable.cells_v = 128;
  const MaterialFn braid = [](const SurfaceSample& s) {
    const bool thread = std::fmod(s.uv.y * 90.0f + s.uv.x * 2.0f, 1.0f) < 0.5f;
    return Material{thread ? glm::vec3(0.80f, 0.30f, 0.22f) : glm::vec3(0.70f, 0.23f, 0.18f), 0.04f, 0.97f,
                    0};
  };
  model.patches.push_back({std::move(cable), braid, label, 9});
  constexpr int kBalls = 40;
  for (int i = 0; i < kBalls; ++i)
    model.proxies.push_back({path(0.86f * static_cast<float>(i) / kBalls), 1.2f * r, label});
}

}  // namespace

void add_plant(Model& model, const StillLifeOptions& options) {
  const std::uint8_t plant = model.add_label("plant"), pot = model.add_label("pot");
  const glm::vec3 base = at(kPotX, 0, kPotZ);
  const float r = kPotRadius, h = kPotHeight;
  PatchShape clay{.surface = revolution(base, {{0.0f, 0.0f},
                                               {0.70f * r, 0.0f},
                                               {0.93f * r, h - 0.085f},
                                               {1.03f * r, h - 0.083f},
                                               {1.06f * r, h - 0.006f},
                                               {1.04f * r, h},
                                               {0.97f * r, h},
                                               {0.95f * r, h - 0.006f},
                                               {0.90f * r, h - 0.05f}})};
  clay.limit_u = 0.05f;
  clay.limit_v = 0.03f;
  clay.cells_v = 96;
  const glm::vec3 terracotta =
      options.low_contrast ? glm::vec3(0.70f, 0.50f, 0.33f) : glm::vec3(0.77f, 0.43f, 0.29f);
  const MaterialFn fired = [=](const SurfaceSample& s) {
    const float lime =
        glm::smoothstep(0.55f, 0.8f, fractal_noise(9.0f * s.position)) * (options.low_contrast ? 0 : 1);
    const float ring = value_noise({1.0f, s.position.y * 120.0f, 1.0f});
    return Material{
        glm::mix(terracotta, glm::vec3(0.86f, 0.66f, 0.55f), 0.45f * lime) * (0.96f + 0.06f * ring), 0.05f,
        0.97f, 0};
  };
  model.patches.push_back({std::move(clay), fired, pot, 2.4f});
  PatchShape soil{.surface = revolution(base, {{0.92f * r, h - 0.045f}, {0.0f, h - 0.03f}})};
  soil.face_up = true;
  const MaterialFn earth = [](const SurfaceSample& s) {
    return Material{glm::vec3(0.25f, 0.18f, 0.13f) * (0.7f + 0.7f * value_noise(45.0f * s.position)), 0.0f,
                    0.97f, 0};
  };
  model.patches.push_back({std::move(soil), earth, pot, 2.0f});
  for (const float height : {0.11f, 0.19f, 0.25f})
    model.proxies.push_back({base + at(0, height, 0), 0.16f, pot});
  for (const float height : {0.12f, 0.16f}) model.interiors.push_back({base + at(0, height, 0), 0.11f, pot});
  for (int i = 0; i < kLeaves; ++i) add_leaf(model, plant, i, options.thin_width_scale);
  for (int i = 0; i < 9; ++i) {  // the crown as a loose cluster: dappled shade
    const float a = kTau * static_cast<float>(i) / 9;
    model.proxies.push_back(
        {base + at(0.24f * std::cos(a), 0.66f + 0.05f * std::sin(3 * a), 0.24f * std::sin(a)), 0.06f, plant});
  }
  model.contacts.push_back({base, 0.70f * r, pot, 0, {0.6f, 0.4f, 0.27f}});
  model.contacts.push_back({base + at(0, h - 0.03f, 0), 0.05f, plant, pot, {0.3f, 0.3f, 0.16f}});
}

void add_lamp(Model& model, const StillLifeOptions& options) {
  const std::uint8_t label = model.add_label("lamp");
  const glm::vec3 base = at(kLampX, 0, kLampZ);
  PatchShape foot{.surface = revolution(base, {{0.0f, 0.0f},
                                               {0.155f, 0.0f},
                                               {0.16f, 0.008f},
                                               {0.158f, 0.022f},
                                               {0.148f, 0.03f},
                                               {0.04f, 0.042f},
                                               {0.022f, 0.06f},
                                               {0.016f, 0.10f},
                                               {0.016f, 0.62f},
                                               {0.03f, 0.63f},
                                               {0.03f, 0.70f},
                                               {0.0f, 0.70f}})};
  foot.limit_u = 0.06f;
  foot.limit_v = 0.03f;
  foot.cells_v = 96;
  model.patches.push_back({std::move(foot), plain({0.74f, 0.58f, 0.32f}, 0.24f), label, 4});
  const auto linen = [](float glow) {
    return [glow](const SurfaceSample& s) {
      const float h = -s.position.y, weave = value_noise({s.uv.x * 260.0f, h * 30.0f, 1.0f});
      const float warm = glm::smoothstep(kShadeHigh, kShadeLow + 0.02f, h);
      const glm::vec3 colour = glm::mix(glm::vec3(0.93f, 0.84f, 0.68f), glm::vec3(1.0f, 0.90f, 0.70f), warm);
      const bool hem = h < kShadeLow + 0.014f || h > kShadeHigh - 0.014f;
      return Material{colour * (0.96f + 0.06f * weave) * (hem ? 0.86f : 1.0f), 0.02f, 0.97f, glow};
    };
  };
  PatchShape outside{.surface = revolution(base, {{0.25f, kShadeLow}, {0.155f, kShadeHigh}})};
  PatchShape inside{.surface = revolution(base, {{0.151f, kShadeHigh}, {0.246f, kShadeLow}})};
  outside.limit_u = inside.limit_u = 0.05f;
  model.patches.push_back({std::move(outside), linen(0.86f), label, 3.5f});
  model.patches.push_back({std::move(inside), linen(0.95f), label, 1.6f});
  add_cable(model, label, options.thin_width_scale);
  model.proxies.push_back({base + at(0, 0.83f, 0), 0.17f, label});
  for (int i = 0; i < 6; ++i) {
    const float a = kTau * static_cast<float>(i) / 6;
    model.proxies.push_back({base + at(0.09f * std::cos(a), 0.012f, 0.09f * std::sin(a)), 0.05f, label});
  }
  model.contacts.push_back({base, 0.15f, label, 0, {0.68f, 0.53f, 0.32f}});
}

}  // namespace splatcut::still_life
