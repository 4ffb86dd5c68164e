// Nothing depends on the unit of lengths: in a scene times a power of two, every bit is the same.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "cut_in_view.h"
#include "scene/raster/first_view.h"
#include "scene/raster/guessed_up.h"
#include "scene/raster/rasterizer.h"
#include "scene/still_life/still_life.h"
#include "segment/session/settings_table.h"

using namespace splatcut;
using namespace splatcut::testing;

namespace {

GaussianCloud times(GaussianCloud cloud, float unit) {
  for (glm::vec3& p : cloud.position) p *= unit;
  for (glm::vec3& s : cloud.scale) s *= unit;
  cloud.near_plane = natural_near_plane(cloud.position);
  return cloud;
}

Camera times(Camera camera, float unit) {
  camera.camera_from_world_translation *= unit;
  return camera;
}

const LabelledScene& scene() {
  static const LabelledScene made = [] {
    StillLifeOptions options;
    options.gaussians = 8000;
    return make_still_life(options);
  }();
  return made;
}

}  // namespace

TEST_CASE("scale: pictures, guessed views and cuts are the same from 2^-40 to 2^36 units") {
  const LabelledScene::SeedClick* apple = nullptr;
  for (const auto& seed : scene().seeds)
    if (seed.object == "apple") apple = &seed;
  REQUIRE(apple);
  const Strokes strokes = {click(glm::vec2(apple->pixel), SeedLabel::kObject)};
  const glm::vec3 up(0, 1, 0);
  struct Seen {
    glm::vec3 up;
    glm::mat3 turned;
    Image<glm::vec3> colour;
    std::vector<std::uint8_t> by_default, by_pixels;
  };
  const auto seen = [&](float unit) {
    const GaussianCloud cloud = times(scene().cloud, unit);
    const Camera camera = times(scene().cameras[static_cast<std::size_t>(apple->camera)], unit);
    const Box bounds = robust_bounds(cloud.position, 0.9);
    const Camera all = view_of_all(bounds, up, 0.87f, 320, 240);
    CutSettings by_pixels;
    for (const char* one : {"first.from=pixels", "views.most=0"}) set_setting(one, &by_pixels);
    return Seen{
        guessed_up(cloud), better_first_view(cloud, bounds, up, all).value_or(all).camera_from_world_rotation,
        rasterize(cloud, all, {}).colour, cut_in_view(cloud, camera, up, strokes, preset("default")).labels,
        cut_in_view(cloud, camera, up, strokes, by_pixels).labels};
  };
  const Seen as_made = seen(1);
  CHECK(std::ranges::count(as_made.by_default, 1) > 0);
  for (const int power : {-40, -23, 23, 36}) {
    CAPTURE(power);
    const Seen scaled = seen(std::ldexp(1.0f, power));
    CHECK(scaled.up == as_made.up);
    CHECK(scaled.turned == as_made.turned);
    CHECK(std::ranges::equal(scaled.colour.pixels(), as_made.colour.pixels()));
    CHECK(scaled.by_default == as_made.by_default);
    CHECK(scaled.by_pixels == as_made.by_pixels);
  }
}
