// Mug, apple, orange and books.
#include <cmath>

#include "scene/still_life/still_life_model.h"

namespace splatcut::still_life {
namespace {

constexpr float kPi = 3.14159265f;
constexpr glm::vec3 kTableTone{0.70f, 0.50f, 0.33f};  // what low contrast is low against
constexpr float kMugX = 0.0f, kMugZ = -0.34f, kMugRadius = 0.165f, kMugHeight = 0.36f;
constexpr float kAppleRadius = 0.15f, kOrangeRadius = 0.142f;
constexpr float kCoffeeHeight = 0.30f;

// Points of a profile between two ends along a quarter of an ellipse or a line are written by hand; a
// fruit's is made here. dimple: depth at the poles, in radii.
std::vector<glm::vec2> fruit_profile(float radius, float squash, float dimple, float shoulder) {
  constexpr int kSteps = 48;
  std::vector<glm::vec2> profile;
  for (int i = 0; i <= kSteps; ++i) {
    const float a = -0.5f * kPi + kPi * static_cast<float>(i) / kSteps;  // south to north
    const float pole = std::abs(std::sin(a));
    const float pit = dimple * std::pow(pole, 24.0f);
    const float r = std::cos(a) * (1 + shoulder * std::sin(a));
    profile.push_back({std::max(0.0f, radius * r), radius * squash * (1 + std::sin(a) * (1 - pit))});
  }
  return profile;
}

struct Place {
  float x, z;
};

struct FruitPlaces {
  Place apple, orange;
};

FruitPlaces fruit_places(bool contact) {
  if (!contact) return {{0.40f, -0.48f}, {0.74f, -0.26f}};
  const float reach = kMugRadius + kAppleRadius * 0.985f, angle = 0.35f;
  const Place apple{kMugX + reach * std::cos(angle), kMugZ - reach * std::sin(angle)};
  const float next = kAppleRadius + kOrangeRadius;
  return {apple, {apple.x + next * std::cos(-0.4f), apple.z - next * std::sin(-0.4f)}};
}

void add_stem(Model& model, std::uint8_t label, const glm::vec3& root, float length, float radius) {
  const auto path = [=](float v) { return root + at(0.25f * length * v * v, length * v, 0.1f * length * v); };
  PatchShape stem{.surface = tube(path, [=](float v) { return radius * (1 + 0.5f * v); }, {0, 0, 1})};
  stem.limit_u = 0.08f;
  stem.turn_randomly = false;
  model.patches.push_back({std::move(stem), plain({0.33f, 0.24f, 0.15f}, 0.02f), label, 22});
}

void add_apple(Model& model, const StillLifeOptions& options, const Place& place, const std::string& name) {
  const std::uint8_t label = model.add_label(name);
  const bool quiet = options.low_contrast;
  const glm::vec3 base = at(place.x, 0, place.z);
  const MaterialFn skin = [=](const SurfaceSample& s) {
    const float angle = 2 * kPi * s.uv.x, h = -s.position.y / (2 * kAppleRadius);
    const glm::vec3 local = s.position - base;
    const float streak = value_noise({13 * std::cos(angle), 2.5f * h, 13 * std::sin(angle)});
    const float blush = glm::smoothstep(
        0.25f, 0.80f,
        fractal_noise(5.0f * local + 3.0f) + 0.30f * (streak - 0.4f) + 0.12f * std::cos(angle - 0.6f));
    const float pole = glm::smoothstep(0.055f, 0.01f, glm::length(glm::vec2(local.x, local.z)));
    glm::vec3 colour =
        glm::mix(glm::vec3(0.78f, 0.13f, 0.12f), glm::vec3(0.93f, 0.66f, 0.28f), 0.75f * blush);
    colour = glm::mix(colour, glm::vec3(0.72f, 0.66f, 0.28f), pole);
    if (quiet) colour = kTableTone * (0.94f + 0.10f * streak);
    return Material{colour, 0.20f, 0.97f, 0};
  };
  PatchShape body{.surface = revolution(base, fruit_profile(kAppleRadius, 0.92f, 0.20f, 0.12f))};
  body.limit_u = 0.05f;
  body.cells_v = 64;
  model.patches.push_back({std::move(body), skin, label, 4.5f});
  add_stem(model, label, base + at(0, 0.225f, 0), 0.075f, 0.006f * options.thin_width_scale);
  model.proxies.push_back({base + at(0, 0.14f, 0), kAppleRadius * 0.97f, label});
  model.interiors.push_back({base + at(0, 0.13f, 0), 0.115f, label});
  model.contacts.push_back({base, 0.06f, label, 0, {0.6f, 0.3f, 0.2f}});
}

void add_orange(Model& model, const StillLifeOptions& options, const Place& place) {
  const std::uint8_t label = model.add_label("orange");
  const glm::vec3 base = at(place.x, 0, place.z);
  const MaterialFn peel = [=](const SurfaceSample& s) {
    const glm::vec3 local = s.position - base;
    const float pore = value_noise(85.0f * local), tone = fractal_noise(6.0f * local);
    const glm::vec3 colour = glm::mix(glm::vec3(0.93f, 0.47f, 0.09f), glm::vec3(0.98f, 0.62f, 0.16f), tone);
    return Material{colour * (0.93f + 0.12f * pore), 0.12f, 0.97f, 0};
  };
  PatchShape body{.surface = revolution(base, fruit_profile(kOrangeRadius, 0.95f, 0.06f, 0.0f))};
  body.limit_u = 0.05f;
  body.cells_v = 64;
  model.patches.push_back({std::move(body), peel, label, 4.5f});
  const glm::vec3 top = base + at(0, 0.262f, 0);
  PatchShape calyx{.surface = [top](float u, float v) {
    const float star = 0.020f * (1 + 0.35f * std::cos(10 * kPi * u));
    return top + at(v * star * std::cos(2 * kPi * u), 0.004f * (1 - v), v * star * std::sin(2 * kPi * u));
  }};
  calyx.face_up = true;
  model.patches.push_back({std::move(calyx), plain({0.38f, 0.47f, 0.20f}, 0.02f), label, 14});
  add_stem(model, label, top, 0.022f, 0.006f * options.thin_width_scale);
  model.proxies.push_back({base + at(0, 0.135f, 0), kOrangeRadius * 0.97f, label});
  model.interiors.push_back({base + at(0, 0.135f, 0), 0.115f, label});
  model.contacts.push_back({base, 0.06f, label, 0, {0.8f, 0.5f, 0.25f}});
}

MaterialFn glaze(const StillLifeOptions& options) {
  const bool quiet = options.low_contrast;
  return [quiet](const SurfaceSample& s) {
    const float h = -s.position.y;
    const float wobble = 0.004f * std::sin(9.0f * s.uv.x * 2 * kPi);
    const bool stripe = h > 0.115f + wobble && h < 0.205f + wobble;
    const bool line = h > 0.222f + wobble && h < 0.234f + wobble;
    const float speck = value_noise(60.0f * s.position) > 0.88f ? 0.88f : 1.0f;
    glm::vec3 colour = glm::vec3(0.92f, 0.885f, 0.815f) * speck;
    if (stripe || line)
      colour = glm::vec3(0.17f, 0.33f, 0.48f) * (0.93f + 0.14f * value_noise(25.0f * s.position));
    if (h < 0.022f) colour = {0.66f, 0.50f, 0.38f};  // the unglazed foot
    if (quiet) colour = kTableTone * (stripe || line ? 0.93f : 1.02f);
    return Material{colour, 0.17f, 0.97f, 0};
  };
}

}  // namespace

void add_mug(Model& model, const StillLifeOptions& options) {
  const std::uint8_t label = model.add_label("mug");
  const glm::vec3 base = at(kMugX, 0, kMugZ);
  const float r = kMugRadius, h = kMugHeight, inner = r - 0.018f;
  PatchShape body{.surface = revolution(base, {{0.0f, 0.004f},
                                               {r - 0.03f, 0.004f},
                                               {r - 0.022f, 0.0f},
                                               {r - 0.012f, 0.008f},
                                               {r - 0.003f, 0.03f},
                                               {r, 0.06f},
                                               {r, h - 0.01f},
                                               {r - 0.003f, h - 0.003f},
                                               {r - 0.009f, h},
                                               {r - 0.015f, h - 0.003f},
                                               {inner, h - 0.01f},
                                               {inner, kCoffeeHeight - 0.01f}})};
  body.limit_u = 0.05f;
  body.limit_v = 0.008f;
  body.cells_v = 96;
  model.patches.push_back({std::move(body), glaze(options), label, 6.5f});

  PatchShape coffee{.surface = revolution(base, {{inner, kCoffeeHeight}, {0.0f, kCoffeeHeight}})};
  coffee.face_up = true;
  const MaterialFn brew = [base](const SurfaceSample& s) {
    const float froth = glm::length(glm::vec2(s.position.x - base.x, s.position.z - base.z));
    const float rim = glm::smoothstep(0.10f, 0.15f, froth + 0.03f * value_noise(40.0f * s.position));
    return Material{glm::mix(glm::vec3(0.26f, 0.15f, 0.09f), glm::vec3(0.58f, 0.40f, 0.25f), rim), 0.06f,
                    0.97f, 0};
  };
  model.patches.push_back({std::move(coffee), brew, label, 3.0f});

  // An ear to the left and to the front: leaves the wall at the top, comes back lower down.
  const glm::vec3 out = glm::normalize(at(-0.86f, 0, -0.5f));
  const auto ear = [=](float v) {
    const float a = kPi * (0.5f - v);
    return base + out * (r - 0.012f + 0.125f * std::pow(std::max(0.0f, std::cos(a)), 0.8f)) +
           at(0, 0.19f + 0.108f * std::sin(a), 0);
  };
  const float thick = 0.017f * options.thin_width_scale;
  PatchShape handle{.surface = tube([=](float v) { return ear(std::min(1.0f, std::max(0.0f, v))); },
                                    [=](float) { return thick; }, glm::cross(out, glm::vec3(0, 1, 0)))};
  handle.limit_u = 0.07f;
  handle.cells_v = 64;
  handle.turn_randomly = false;
  const glm::vec3 tone = options.low_contrast ? kTableTone : glm::vec3(0.92f, 0.885f, 0.815f);
  model.patches.push_back({std::move(handle), plain(tone, 0.17f), label, 9});
  for (const float height : {0.10f, 0.19f, 0.27f})
    model.proxies.push_back({base + at(0, height, 0), 0.145f, label});
  for (const float height : {0.11f, 0.17f})
    model.interiors.push_back({base + at(0, height, 0), 0.10f, label});
  model.contacts.push_back({base, r - 0.02f, label, 0, {0.7f, 0.55f, 0.42f}});
}

void add_fruit(Model& model, const StillLifeOptions& options) {
  const FruitPlaces places = fruit_places(options.contact);
  add_apple(model, options, places.apple, "apple");
  add_orange(model, options, places.orange);
  if (!options.contact) return;
  const std::uint8_t mug = 1, apple = 2;
  const glm::vec3 touch = at(0.5f * (kMugX + places.apple.x), 0.15f, 0.5f * (kMugZ + places.apple.z));
  model.contacts.push_back({touch, 0.02f, apple, mug, {0.75f, 0.5f, 0.45f}});
}

void add_twin(Model& model, const StillLifeOptions& options) {
  if (options.twins) add_apple(model, options, {-0.50f, -0.62f}, "apple twin");
}

void add_books(Model& model, const StillLifeOptions&) {
  const std::uint8_t label = model.add_label("books");
  struct Book {
    glm::vec3 size, cover;
    float x, z, yaw;
  };
  const Book books[] = {{{0.62f, 0.090f, 0.44f}, {0.20f, 0.36f, 0.39f}, -0.30f, 0.24f, 0.12f},
                        {{0.55f, 0.066f, 0.40f}, {0.74f, 0.35f, 0.25f}, -0.28f, 0.25f, -0.14f},
                        {{0.50f, 0.078f, 0.36f}, {0.90f, 0.75f, 0.42f}, -0.31f, 0.24f, 0.28f},
                        {{0.40f, 0.046f, 0.29f}, {0.42f, 0.31f, 0.42f}, -0.29f, 0.25f, 0.02f}};
  float height = 0;
  for (const Book& book : books) {
    constexpr float kBoard = 0.008f, kOverhang = 0.012f;
    const glm::vec3 cover = book.cover;
    const MaterialFn cloth = [cover](const SurfaceSample& s) {
      return Material{cover * (0.95f + 0.10f * value_noise(70.0f * s.position)), 0.06f, 0.97f, 0};
    };
    const MaterialFn spine = [cover](const SurfaceSample& s) {
      const float u = s.uv.x;  // bands and a title in a lighter ink
      const bool band = (u > 0.06f && u < 0.075f) || (u > 0.925f && u < 0.94f);
      const bool title = u > 0.24f && u < 0.70f && s.uv.y > 0.40f && s.uv.y < 0.62f &&
                         value_noise({u * 44.0f, 1.0f, cover.x * 90.0f}) > 0.36f;
      const glm::vec3 ink{0.95f, 0.89f, 0.74f};
      return Material{band || title ? ink : cover * 0.98f, 0.06f, 0.97f, 0};
    };
    const MaterialFn pages = [](const SurfaceSample& s) {
      const float leaf = value_noise({s.position.x * 3.0f, s.position.y * 420.0f, s.position.z * 3.0f});
      return Material{glm::vec3(0.93f, 0.89f, 0.79f) * (0.80f + 0.22f * leaf), 0.02f, 0.97f, 0};
    };
    const glm::vec3 base = at(book.x, height, book.z);
    const glm::vec3 board{book.size.x, kBoard, book.size.z};
    add_box(model, label, 2.2f, base, board, book.yaw, {cloth, cloth, cloth, cloth, cloth, cloth});
    const glm::vec3 block{book.size.x - 2 * kOverhang, book.size.y - 2 * kBoard, book.size.z - 2 * kOverhang};
    add_box(model, label, 5.0f, base + at(0, kBoard, 0), block, book.yaw, {{}, {}, {}, pages, pages, pages});
    const glm::vec3 back{-std::sin(-book.yaw), 0, -std::cos(book.yaw)};
    const glm::vec3 spine_base = base + at(0, kBoard, 0) + back * (0.5f * book.size.z - 0.008f);
    add_box(model, label, 5.0f, spine_base, {book.size.x, book.size.y - 2 * kBoard, 0.016f}, book.yaw,
            {{}, {}, spine, {}, cloth, cloth});
    add_box(model, label, 2.2f, base + at(0, book.size.y - kBoard, 0), board, book.yaw,
            {cloth, cloth, cloth, cloth, cloth, cloth});
    for (int i = 0; i < 5; ++i)
      for (int j = 0; j < 3; ++j) {
        const float x = (static_cast<float>(i) - 2) * 0.105f, z = (static_cast<float>(j) - 1) * 0.13f;
        const float c = std::cos(book.yaw), s = std::sin(book.yaw);
        model.proxies.push_back({base + at(c * x - s * z, 0.05f, s * x + c * z), 0.065f, label});
      }
    height += book.size.y + 0.001f;
  }
  for (const float x : {-0.42f, -0.30f, -0.18f})
    model.interiors.push_back({at(x, 0.115f, 0.24f), 0.085f, label});
  model.contacts.push_back({at(-0.30f, 0, 0.24f), 0.24f, label, 0, {0.35f, 0.38f, 0.34f}});
}

}  // namespace splatcut::still_life
