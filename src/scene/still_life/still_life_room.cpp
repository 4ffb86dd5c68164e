// Shared helpers of the model, and the background: table, wall, floor.
#include <cmath>

#include "core/counter_rng.h"
#include "scene/still_life/still_life_model.h"

namespace splatcut::still_life {
namespace {

constexpr float kTableHalfX = 1.35f, kTableHalfZ = 0.98f, kTableThickness = 0.055f;
constexpr float kFloorHeight = -1.0f, kRoomRadius = 3.7f, kWallTop = 2.1f;
constexpr int kPlanks = 7;

float lattice(int x, int y, int z) {
  const auto bits = [](int i) { return static_cast<std::uint64_t>(static_cast<std::uint32_t>(i)); };
  const std::uint64_t key =
      bits(x) * 0x9e3779b1ull ^ bits(y) * 0x85ebca77c2b2ae63ull ^ bits(z) * 0xc2b2ae3d27d4eb4full;
  return static_cast<float>(mixed_bits(key) >> 40) * 0x1p-24f;
}

// Oak planks along x: each plank has its own tone, wavy grain lines and a dark joint.
Material oak(const glm::vec3& p, float grain_contrast) {
  const float across = (p.z / kTableHalfZ * 0.5f + 0.5f) * kPlanks;
  const float plank = std::floor(across), inside = across - plank;
  const float tone = lattice(static_cast<int>(plank), 3, 7);
  const glm::vec3 q{p.x * 1.3f + 9.0f * plank, 5.0f * plank, p.z * 9.0f};
  const float wave = fractal_noise(q);
  const float rings = 0.5f + 0.5f * std::sin(38.0f * wave + p.z * 30.0f);
  const float fibre = value_noise({p.x * 9.0f, plank, p.z * 160.0f});
  const float shade =
      1 + grain_contrast * (0.20f * (tone - 0.5f) - 0.17f * rings * rings + 0.13f * (fibre - 0.5f));
  const float edge = std::min(inside, 1 - inside);
  const float joint = edge < 0.014f ? 0.72f : 1.0f;
  return {glm::vec3(0.74f, 0.535f, 0.35f) * (shade * joint), 0.10f, 0.97f, 0};
}

}  // namespace

float value_noise(const glm::vec3& p) {
  const glm::vec3 cell = glm::floor(p);
  glm::vec3 t = p - cell;
  t = t * t * (3.0f - 2.0f * t);
  const int x = static_cast<int>(cell.x), y = static_cast<int>(cell.y), z = static_cast<int>(cell.z);
  const auto row = [&](int j, int k) { return glm::mix(lattice(x, j, k), lattice(x + 1, j, k), t.x); };
  return glm::mix(glm::mix(row(y, z), row(y + 1, z), t.y), glm::mix(row(y, z + 1), row(y + 1, z + 1), t.y),
                  t.z);
}

float fractal_noise(const glm::vec3& p) {
  return 0.57f * value_noise(p) + 0.28f * value_noise(2.03f * p + 17.0f) +
         0.15f * value_noise(4.1f * p + 31.0f);
}

MaterialFn plain(const glm::vec3& colour, float gloss, float variation) {
  return [=](const SurfaceSample& s) {
    return Material{colour * (1 + variation * (2 * fractal_noise(14.0f * s.position) - 1)), gloss, 0.96f, 0};
  };
}

void add_box(Model& model, std::uint8_t label, float detail, const glm::vec3& base, const glm::vec3& size,
             float yaw_rad, const BoxFaces& faces) {
  const glm::vec3 x = size.x * glm::vec3(std::cos(yaw_rad), 0, std::sin(yaw_rad));
  const glm::vec3 z = size.z * glm::vec3(-std::sin(yaw_rad), 0, std::cos(yaw_rad));
  const glm::vec3 up{0, -size.y, 0};
  const glm::vec3 low = base - 0.5f * (x + z);
  const auto face = [&](const glm::vec3& origin, const glm::vec3& u, const glm::vec3& v,
                        const MaterialFn& m) {
    PatchShape shape{.surface = parallelogram(origin, u, v), .stretch = 1.5f, .turn_randomly = false};
    shape.cells_u = shape.cells_v = 1;
    if (m) model.patches.push_back({std::move(shape), m, label, detail});
  };
  face(low + up, x, z, faces.top);  // cross(x, z) points to -y: up
  face(low + z, x, -z, faces.bottom);
  face(low, x, up, faces.front);  // towards -z
  face(low + x + z, -x, up, faces.back);
  face(low + z, -z, up, faces.left);
  face(low + x, z, up, faces.right);
}

void add_room(Model& model, const StillLifeOptions& options) {
  const float grain = options.low_contrast ? 0.35f : 1.0f;
  const MaterialFn wood = [grain](const SurfaceSample& s) { return oak(s.position, grain); };
  const MaterialFn side = [grain](const SurfaceSample& s) {
    Material m = oak(s.position, grain);
    m.colour *= 0.86f;
    return m;
  };
  add_box(model, 0, 1.0f, at(0, -kTableThickness, 0), {2 * kTableHalfX, kTableThickness, 2 * kTableHalfZ}, 0,
          {wood, {}, side, side, side, side});
  model.patches.front().shape.stretch = 2.2f;  // splats along the grain
  for (std::size_t i = 1; i < model.patches.size(); ++i) model.patches[i].detail = 3;  // the narrow edges

  for (const float x : {-1.0f, 1.0f})
    for (const float z : {-1.0f, 1.0f}) {
      const glm::vec3 foot = at(x * (kTableHalfX - 0.16f), kFloorHeight, z * (kTableHalfZ - 0.16f));
      PatchShape leg{.surface = revolution(foot, {{0.028f, 0.0f}, {0.05f, -kFloorHeight - kTableThickness}})};
      leg.limit_u = 0.06f;
      model.patches.push_back({std::move(leg), plain({0.56f, 0.39f, 0.25f}, 0.05f), 0, 0.5f});
    }

  const MaterialFn plaster = [](const SurfaceSample& s) {
    const float h = -s.position.y, mottle = fractal_noise(2.2f * s.position) - 0.5f;
    const float rise = glm::smoothstep(-1.0f, 2.0f, h);
    const glm::vec3 sage = glm::mix(glm::vec3(0.56f, 0.64f, 0.60f), glm::vec3(0.80f, 0.84f, 0.79f), rise);
    return Material{sage * (1 + 0.07f * mottle), 0.0f, 0.97f, 0.45f};
  };
  PatchShape wall{.surface = revolution(at(0, 0, 0), {{kRoomRadius, kWallTop}, {kRoomRadius, kFloorHeight}}),
                  .overlap = 0.95f};
  model.patches.push_back({std::move(wall), plaster, 0, 0.030f});

  const MaterialFn boards = [](const SurfaceSample& s) {
    const glm::vec3 p = s.position;
    const float radius = glm::length(glm::vec2(p.x, p.z)), weave = value_noise(28.0f * p) - 0.5f;
    if (radius < 2.35f) {  // a round rug under the table, with a border
      const bool border = radius > 2.12f && radius < 2.24f;
      const glm::vec3 wool = border ? glm::vec3(0.87f, 0.82f, 0.73f) : glm::vec3(0.66f, 0.43f, 0.37f);
      return Material{wool * (1 + 0.10f * weave), 0.0f, 0.97f, 0};
    }
    const float board = std::floor(p.x * 4.0f);
    return Material{glm::vec3(0.50f, 0.40f, 0.31f) * (0.9f + 0.2f * lattice(static_cast<int>(board), 1, 1)),
                    0.05f, 0.97f, 0};
  };
  PatchShape floor{.surface = revolution(at(0, kFloorHeight, 0), {{kRoomRadius, 0}, {0.0f, 0.0f}}),
                   .overlap = 0.85f};
  floor.face_up = true;
  model.patches.push_back({std::move(floor), boards, 0, 0.06f});
}

void add_occluder(Model& model, const StillLifeOptions& options) {
  if (!options.occluder) return;
  const std::uint8_t label = model.add_label("board");
  const MaterialFn paint = [](const SurfaceSample& s) {  // a little landscape
    const float hill = 0.42f + 0.10f * std::sin(6.0f * s.uv.x) + 0.05f * value_noise(8.0f * s.position);
    const glm::vec3 colour = s.uv.y > hill ? glm::vec3(0.93f, 0.80f, 0.66f) : glm::vec3(0.32f, 0.47f, 0.52f);
    return Material{colour, 0.03f, 0.96f, 0};
  };
  const MaterialFn card = plain({0.88f, 0.85f, 0.79f}, 0.03f);
  add_box(model, label, 3.0f, at(-0.04f, 0, -0.78f), {0.50f, 0.42f, 0.025f}, 0.12f,
          {card, {}, paint, card, card, card});
  for (int i = 0; i < 4; ++i)
    model.proxies.push_back({at(-0.22f + 0.12f * static_cast<float>(i), 0.08f, -0.78f), 0.07f, label});
}

}  // namespace splatcut::still_life
