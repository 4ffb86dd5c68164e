#include "scene/raster/first_view.h"

#include <doctest/doctest.h>

#include <glm/gtc/constants.hpp>

#include "core/mapped_file.h"
#include "places.h"
#include "scene/formats/scene_file.h"
#include "scene/raster/guessed_up.h"
#include "scene/raster/rasterizer.h"
#include "scene/still_life/still_life.h"
#include "synthetic_cloud.h"

using namespace splatcut;
using namespace splatcut::testing;

namespace {

// The cloud turned so that what points along `from` points along `to`.
GaussianCloud turned(GaussianCloud cloud, const glm::vec3& from, const glm::vec3& to) {
  const glm::vec3 across = std::abs(from.x) > 0.5f ? glm::vec3(0, 0, 1) : glm::vec3(1, 0, 0);
  const glm::quat turn = glm::dot(from, to) < -0.9f ? glm::angleAxis(glm::pi<float>(), across)
                         : glm::dot(from, to) > 0.9f
                             ? glm::quat(1, 0, 0, 0)
                             : glm::angleAxis(glm::half_pi<float>(), glm::cross(from, to));
  for (glm::vec3& p : cloud.position) p = turn * p;
  for (glm::quat& q : cloud.rotation) q = turn * q;
  return cloud;
}

// A disc facing `normal`.
void add_disc(GaussianCloud* cloud, const glm::vec3& centre, const glm::vec3& normal, float sigma) {
  cloud->position.push_back(centre);
  cloud->scale.push_back({sigma, sigma, 0.02f * sigma});
  cloud->rotation.push_back(std::abs(normal.z) > 0.5f ? glm::quat(1, 0, 0, 0)
                            : std::abs(normal.y) > 0.5f
                                ? glm::angleAxis(glm::half_pi<float>(), glm::vec3(1, 0, 0))
                                : glm::angleAxis(glm::half_pi<float>(), glm::vec3(0, 1, 0)));
  cloud->opacity.push_back(0.98f);
  cloud->f_dc.push_back(glm::vec3(0));
}

// The faces of the box [-1, 1]^3 times `half`, each with steps x steps discs.
void add_box(GaussianCloud* cloud, float half, int steps) {
  const float pitch = 2 * half / static_cast<float>(steps);
  for (int axis = 0; axis < 3; ++axis)
    for (const float side : {-half, half})
      for (int i = 0; i < steps; ++i)
        for (int j = 0; j < steps; ++j) {
          glm::vec3 p, normal(0);
          normal[axis] = 1;
          p[axis] = side;
          p[(axis + 1) % 3] = -half + pitch * (static_cast<float>(i) + 0.5f);
          p[(axis + 2) % 3] = -half + pitch * (static_cast<float>(j) + 0.5f);
          add_disc(cloud, p, normal, 0.6f * pitch);
        }
}

Camera outside_of(const Box& bounds) {
  return look_at(bounds.centre() + glm::vec3(0, -1, -3) * glm::length(bounds.extent()) * 0.5f,
                 bounds.centre(), {0, -1, 0}, 0.87f, 320, 240);
}

}  // namespace

TEST_CASE("up is guessed whichever way the still life is turned") {
  StillLifeOptions options;
  options.gaussians = 30000;
  const GaussianCloud cloud = make_still_life(options).cloud;
  for (int axis = 0; axis < 3; ++axis)
    for (const float sign : {-1.0f, 1.0f}) {
      glm::vec3 up(0);
      up[axis] = sign;
      CAPTURE(axis);
      CAPTURE(sign);
      const UpGuess guess = up_guess(turned(cloud, {0, -1, 0}, up));
      CHECK(glm::dot(guess.up_world, up) == 1);
      if (axis == 1 && sign < 0) CHECK(guess.sure);  // as captures stand, and a table lies there
    }
}

TEST_CASE("up: nothing known is the usual up of a capture") {
  CHECK(guessed_up(GaussianCloud{}) == glm::vec3(0, -1, 0));
  CHECK_FALSE(up_guess(GaussianCloud{}).sure);
  CHECK(guessed_up(single_splat(2, 0.1f, 0.9f, {1, 0, 0})) == glm::vec3(0, -1, 0));
}

TEST_CASE(
    "first view: a room whose walls are blurs from behind is seen from within, an object from outside") {
  GaussianCloud room;
  add_box(&room, 3, 120);   // what was photographed
  add_box(&room, 3.4f, 5);  // haze behind the walls
  const Box bounds{glm::vec3(-3), glm::vec3(3)};
  const auto within = better_first_view(room, bounds, {0, -1, 0}, outside_of(bounds));
  REQUIRE(within);
  const glm::vec3 eye = within->centre_world();
  for (int axis = 0; axis < 3; ++axis) CHECK(std::abs(eye[axis]) < 3);
  CHECK(glm::dot(within->down_world(), glm::vec3(0, 1, 0)) > 0.9f);

  GaussianCloud object;
  add_box(&object, 1, 120);
  for (const float half : {0.8f, 0.6f, 0.4f, 0.2f}) add_box(&object, half, 8);  // filled by what nobody saw
  const Box around{glm::vec3(-1), glm::vec3(1)};
  const Camera outside = outside_of(around);
  const Camera view = better_first_view(object, around, {0, -1, 0}, outside).value_or(outside);
  std::size_t outside_px = 0;
  for (const glm::vec3& p : object.position) {
    const glm::vec3 seen = view.camera_from_world(p);
    REQUIRE(seen.z > 0.5f);
    const glm::vec2 at = view.pixel_from_camera(seen);
    outside_px += at.x < 0 || at.y < 0 || at.x > 320 || at.y > 240;
  }
  CHECK(100 * outside_px < object.size());
}

TEST_CASE("first view: what was captured finely is in the middle, not too small, whatever lies around it") {
  GaussianCloud scene;
  add_box(&scene, 0.5f, 60);
  for (glm::vec3& p : scene.position) p += glm::vec3(2, 0, 1);
  add_box(&scene, 6, 12);  // walls far away, of which one is before the usual view
  const Box bounds{glm::vec3(-6), glm::vec3(6)};
  const auto view = better_first_view(scene, bounds, {0, -1, 0}, outside_of(bounds));
  REQUIRE(view);
  const glm::vec3 middle = view->camera_from_world({2, 0, 1});
  REQUIRE(middle.z > 0);
  const glm::vec2 at = view->pixel_from_camera(middle);
  CHECK(glm::distance(at, glm::vec2(160, 120)) < 30);
  const float side_px = view->fx_px / middle.z;  // of the fine box
  CHECK(side_px > 40);
  CHECK(side_px < 200);
}

TEST_CASE("first view: a statue on a blurred plinth is not looked at from within") {
  GaussianCloud scene;
  add_box(&scene, 0.5f, 70);
  for (glm::vec3& p : scene.position) p = (p + glm::vec3(0, -0.5f, 0)) * glm::vec3(0.8f, 1.4f, 0.8f);
  const std::size_t statue = scene.size();
  for (const float below : {0.6f, 1.8f}) {
    const std::size_t from = scene.size();
    add_box(&scene, 0.6f, 12);
    for (std::size_t g = from; g < scene.size(); ++g) scene.position[g].y += below;
  }
  const Box bounds = framed_bounds(scene);
  const Camera outside = outside_of(bounds);
  const Camera view = better_first_view(scene, bounds, {0, -1, 0}, outside).value_or(outside);
  for (std::size_t g = 0; g < statue; ++g) {
    const glm::vec3 seen = view.camera_from_world(scene.position[g]);
    REQUIRE(seen.z > 0);
    const glm::vec2 at = view.pixel_from_camera(seen);
    const bool inside = at.x > 0 && at.y > 0 && at.x < 320 && at.y < 240;
    REQUIRE(inside);
  }
}

TEST_CASE("first view: the sample without its cameras shows what stands on the table, nothing is before it") {
  const std::filesystem::path folder = project_folder() + "/assets/sample";
  const Scene scene = load_scene(folder / "sample.compressed.ply");
  const std::string labels = text_of_file(folder / "sample.labels.u8");
  const Box bounds = framed_bounds(scene.cloud);
  const glm::vec3 up = scene.up.value_or(guessed_up(scene.cloud));
  const Camera outside = view_of_all(bounds, up, 0.87f, 640, 480);
  const Camera view = better_first_view(scene.cloud, bounds, up, outside).value_or(outside);
  RasterOptions options;
  options.colour = false;
  options.depth = true;
  const RasterOutput picture = rasterize(scene.cloud, view, options);
  for (const int object : {1, 2, 3}) {  // mug, apple, orange
    CAPTURE(object);
    std::size_t all = 0, framed = 0, seen = 0;
    for (std::size_t g = 0; g < scene.cloud.size(); ++g) {
      if (labels.at(scene.cloud.file_row[g]) != object) continue;
      ++all;
      const glm::vec3 at = view.camera_from_world(scene.cloud.position[g]);
      const glm::vec2 px = view.pixel_from_camera(at);
      if (!(at.z > 0 && px.x >= 0 && px.y >= 0 && px.x < 640 && px.y < 480)) continue;
      ++framed;
      const float depth = picture.median_depth.at(static_cast<int>(px.x), static_cast<int>(px.y));
      seen += at.z < 1.05f * depth;
    }
    CHECK(framed == all);
    CHECK(seen > all / 3);  // the rest is its own other side
  }
  std::size_t black = 0, near = 0;
  const float distance = glm::distance(view.centre_world(), bounds.centre());
  for (const float depth : picture.median_depth.pixels()) {
    black += depth == 0;
    near += depth > 0 && depth < 0.35f * distance;
  }
  CHECK(black < picture.median_depth.size() / 4);
  CHECK(near == 0);
}

TEST_CASE("first view: a tall thing that stands alone is seen from head to foot") {
  GaussianCloud tower;  // captured best in its middle
  float y = -2;
  for (const int steps : {24, 30, 34, 30, 24}) {
    const std::size_t from = tower.size();
    add_box(&tower, 0.5f, steps);
    for (std::size_t g = from; g < tower.size(); ++g) tower.position[g].y += y;
    ++y;
  }
  const Box bounds{{-0.5f, -2.5f, -0.5f}, {0.5f, 2.5f, 0.5f}};
  const Camera outside = outside_of(bounds);
  const Camera view = better_first_view(tower, bounds, {0, -1, 0}, outside).value_or(outside);
  float highest = 240, lowest = 0;
  for (const glm::vec3& p : tower.position) {
    const glm::vec2 at = view.pixel_from_camera(view.camera_from_world(p));
    highest = std::min(highest, at.y);
    lowest = std::max(lowest, at.y);
  }
  CHECK(highest > 0);
  CHECK(lowest < 240);
  CHECK(lowest - highest > 100);
}

TEST_CASE(
    "view of all: the box lies in the picture with air around it, upright, seen from above, whatever is up") {
  const Box bounds{{-2, -1, -3}, {4, 1, 2}};
  for (const glm::vec3 up :
       {glm::vec3(0, -1, 0), glm::vec3(0, 1, 0), glm::vec3(0, 0, 2), glm::vec3(1, 0, 0)}) {
    CAPTURE(up.x);
    CAPTURE(up.y);
    const Camera view = view_of_all(bounds, up, 0.87f, 640, 480);
    const glm::vec3 unit_up = glm::normalize(up);
    CHECK(glm::dot(view.centre_world() - bounds.centre(), unit_up) > 0);
    CHECK(glm::dot(view.down_world(), unit_up) < -0.9f);
    float lowest = 480, highest = 0;
    for (int corner = 0; corner < 8; ++corner) {
      const glm::vec3 p(corner & 1 ? bounds.max.x : bounds.min.x, corner & 2 ? bounds.max.y : bounds.min.y,
                        corner & 4 ? bounds.max.z : bounds.min.z);
      const glm::vec2 at = view.pixel_from_camera(view.camera_from_world(p));
      CHECK(at.x > 0);
      CHECK(at.x < 640);
      lowest = std::min(lowest, at.y);
      highest = std::max(highest, at.y);
    }
    CHECK(lowest > 0);
    CHECK(highest < 480);
    CHECK(highest - lowest > 120);  // and is no dot in it
  }
}
