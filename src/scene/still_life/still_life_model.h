// What the still life is made of, before it becomes splats: patches with materials, spheres that stand in
// for the objects where light is concerned, and the places where objects touch. Used by still_life*.cpp only.
#pragma once

#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "scene/still_life/still_life.h"
#include "scene/still_life/surface_sampler.h"

namespace splatcut::still_life {

// Display-referred colour: the same space the rasteriser writes.
struct Material {
  glm::vec3 colour{0.5f};
  float gloss = 0.05f;  // strength of the view-dependent lobe
  float opacity = 0.96f;
  float glow = 0;  // 0: lit by the room; 1: shows its own colour unshaded
};
using MaterialFn = std::function<Material(const SurfaceSample&)>;

struct Patch {
  PatchShape shape;
  MaterialFn material;
  std::uint8_t label = 0;
  float detail = 1;  // splats per area, relative
};

struct Proxy {  // sphere
  glm::vec3 centre{0};
  float radius = 0;
  std::uint8_t label = 0;
};

// A circle along which the object `label` touches `other`.
struct Contact {
  glm::vec3 centre{0};
  float radius = 0;
  std::uint8_t label = 0, other = 0;
  glm::vec3 colour{0.5f};
};

struct Model {
  std::vector<Patch> patches;
  std::vector<Proxy> proxies;    // cast shade; may stick out a little
  std::vector<Proxy> interiors;  // lie well inside their objects
  std::vector<Contact> contacts;
  std::vector<std::string> label_name;

  std::uint8_t add_label(const std::string& name) {
    label_name.push_back(name);
    return static_cast<std::uint8_t>(label_name.size() - 1);
  }
};

// Metre-like frame with height h upwards: the world's up is -y.
inline glm::vec3 at(float x, float h, float z) {
  return {x, -h, z};
}

// Smooth noise in [0, 1]; features of size 1.
float value_noise(const glm::vec3& p);
// Three octaves of it.
float fractal_noise(const glm::vec3& p);

MaterialFn plain(const glm::vec3& colour, float gloss, float variation = 0.04f);

struct BoxFaces {  // materials of the six faces of a box
  MaterialFn top, bottom, front, back, left, right;
};
// Box with its bottom centre at base, size = (width x, height, depth z), turned about the vertical by
// yaw_rad.
void add_box(Model& model, std::uint8_t label, float detail, const glm::vec3& base, const glm::vec3& size,
             float yaw_rad, const BoxFaces& faces);

void add_room(Model& model, const StillLifeOptions& options);
void add_mug(Model& model, const StillLifeOptions& options);
void add_fruit(Model& model, const StillLifeOptions& options);
void add_twin(Model& model, const StillLifeOptions& options);
void add_plant(Model& model, const StillLifeOptions& options);
void add_books(Model& model, const StillLifeOptions& options);
void add_lamp(Model& model, const StillLifeOptions& options);
void add_occluder(Model& model, const StillLifeOptions& options);

// Where the light of the lamp comes from.
inline const glm::vec3 kLampBulb = at(-0.86f, 0.74f, 0.30f);

struct Lit {
  glm::vec3 colour{0};  // what a camera along the normal sees
  glm::vec3 mirror{0};  // unit direction in which the highlight leaves
};
Lit lit(const Model& model, const SurfaceSample& sample, const Material& material, std::uint8_t label);

std::vector<LabelledScene::SeedClick> seed_clicks(const LabelledScene& scene);

}  // namespace splatcut::still_life
