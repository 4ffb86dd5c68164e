// A small still life of a table, sessions on it, and what is clicked there.
#pragma once

#include <doctest/doctest.h>

#include <algorithm>
#include <memory>
#include <string>

#include "scene/still_life/still_life.h"
#include "segment/session/session.h"
#include "segment/superpoints/orbit.h"

namespace splatcut::testing {

struct SmallTable {
  LabelledScene scene;
  std::shared_ptr<const GaussianCloud> cloud;
};

inline const SmallTable& small_table() {
  static const SmallTable made = [] {
    SmallTable t;
    StillLifeOptions options;
    options.gaussians = 25000;
    t.scene = make_still_life(options);
    t.cloud = std::make_shared<const GaussianCloud>(t.scene.cloud);
    return t;
  }();
  return made;
}

inline Session fresh_session() {
  return Session({.cloud = small_table().cloud, .photographs = small_table().scene.cameras});
}

inline CutSettings with_views_around() {
  CutSettings settings = preset("default");
  settings.orbit.views = kViewsAround;
  return settings;
}

// An object's request and settings.
struct Asked {
  CutRequest request;
  CutSettings settings = with_views_around();
};

inline Asked click_on(const std::string& object) {
  const LabelledScene& scene = small_table().scene;
  const auto seed = std::ranges::find(scene.seeds, object, &LabelledScene::SeedClick::object);
  REQUIRE(seed != scene.seeds.end());
  Asked asked;
  asked.request.strokes = {
      {scene.cameras[static_cast<std::size_t>(seed->camera)], {click(seed->pixel, SeedLabel::kObject)}}};
  return asked;
}

// A stroke on the object from the other side of the table.
inline StrokedView stroke_from_behind(const std::string& object, SeedLabel label) {
  const LabelledScene& scene = small_table().scene;
  const auto number = std::ranges::find(scene.label_name, object) - scene.label_name.begin();
  glm::vec3 middle(0);
  float count = 0;
  for (std::size_t g = 0; g < scene.label.size(); ++g)
    if (scene.label[g] == number) middle += scene.cloud.position[g], ++count;
  const Camera& camera = scene.cameras[5];
  const glm::vec2 at = camera.pixel_from_camera(camera.camera_from_world(middle / count));
  return {camera, {Stroke{label, 6, {at - glm::vec2(12, 0), at + glm::vec2(12, 0)}}}};
}

}  // namespace splatcut::testing
