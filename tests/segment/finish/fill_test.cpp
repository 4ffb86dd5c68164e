// The hole that an object leaves: a still life of which training saw nothing below its objects, and the same
// one without the object.
#include "segment/finish/fill.h"

#include <doctest/doctest.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <random>
#include <stop_token>
#include <thread>

#include "segment/finish/seen_from.h"
#include "segment/finish/support_plane.h"
#include "segment/masks/mask_tools.h"
#include "segment/superpoints/orbit.h"
#include "thing_of_still_life.h"

using namespace splatcut;
using namespace splatcut::testing;

namespace {

struct WithHole {
  Thing thing;
  LabelledScene without;
  SurfacePatch patch;

  explicit WithHole(const std::string& object, std::size_t gaussians = 60000)
      : thing(options(gaussians), object), without(make_still_life(bare(gaussians, object))) {
    patch = fill_surface(thing.scene.cloud, thing.test.truth_labels, {}, {0, -1, 0}, {}, {});
  }
  static StillLifeOptions options(std::size_t gaussians) {
    StillLifeOptions options;
    options.gaussians = gaussians;
    options.hidden_missing = true;
    return options;
  }
  static StillLifeOptions bare(std::size_t gaussians, const std::string& object) {
    StillLifeOptions options;
    options.gaussians = gaussians;
    options.without = object;
    return options;
  }

  GaussianCloud rest(bool filled) const {
    std::vector<std::uint8_t> stay;
    for (const std::uint8_t label : thing.test.truth_labels) stay.push_back(label == 0);
    return rest_of(thing.scene.cloud, stay, filled ? patch.changes : RestChanges{});
  }
  // Against the scene made without it, in and around the pixels that showed it.
  double psnr_db(const GaussianCloud& rest) const {
    double squares = 0, pixels = 0;
    for (std::size_t c = 0; c < thing.scene.cameras.size(); c += 3) {
      const Camera camera = limited_to_width(thing.scene.cameras[c], 504);
      const Mask around =
          dilated(thresholded(render_labels(thing.scene.cloud, camera, thing.test.truth_labels), 0.5f), 6);
      const Image<glm::vec3> is = rasterize(rest, camera).colour,
                             should = rasterize(without.cloud, camera).colour;
      for (std::size_t i = 0; i < around.size(); ++i) {
        if (!around.pixels()[i]) continue;
        const glm::vec3 d = is.pixels()[i] - should.pixels()[i];
        squares += static_cast<double>(glm::dot(d, d)) / 3;
        ++pixels;
      }
    }
    return 10 * std::log10(pixels / squares);
  }
};

}  // namespace

TEST_CASE("fill: the table under a fruit is as the scene made without it has it") {
  for (const char* name : {"apple", "orange"}) {
    CAPTURE(name);
    const WithHole fruit(name);
    REQUIRE(fruit.patch.why_not.empty());
    CHECK(fruit.psnr_db(fruit.rest(true)) > fruit.psnr_db(fruit.rest(false)) + 6);
  }
}

TEST_CASE("fill: what a plant leaves in its pot, where nothing is flat, stays as it is") {
  const WithHole plant("plant");
  CHECK_FALSE(plant.patch.why_not.empty());
  CHECK(plant.patch.changes.given_back.empty());
}

TEST_CASE("fill: copies are of the table, lie in its plane, and nothing of the object or of others leaves") {
  const WithHole apple("apple", 20000);
  const SurfacePatch& patch = apple.patch;
  REQUIRE(patch.why_not.empty());
  CHECK(patch.area > 0);
  for (const glm::vec3& p : patch.changes.given_back.position)
    CHECK(std::abs(p.y) < 0.05f);  // the table top is y = 0
  const GaussianCloud& cloud = apple.thing.scene.cloud;
  for (std::size_t i = 0; i < patch.changes.given_back.size(); ++i) {
    const auto from = static_cast<std::size_t>(
        std::ranges::find(cloud.file_row, patch.changes.given_back.file_row[i]) - cloud.file_row.begin());
    REQUIRE(from < cloud.size());
    CHECK(apple.thing.scene.label[from] == 0);
    CHECK(patch.changes.given_back.scale[i] == cloud.scale[from]);
  }
  CHECK(std::ranges::is_sorted(patch.changes.ghosts));
  CHECK(std::ranges::all_of(patch.changes.ghosts,
                            [&](std::uint32_t g) { return apple.thing.scene.label[g] == 0; }));
}

TEST_CASE("fill: the same bits on one thread and on two") {
  const Thing apple(WithHole::options(20000), "apple");
  const auto filled = [&](int threads) {
    SurfacePatch patch;
    tbb::task_arena(threads).execute([&] {
      patch = fill_surface(apple.scene.cloud, apple.test.truth_labels, {}, {0, -1, 0}, {}, {});
    });
    return patch;
  };
  const SurfacePatch one = filled(1), two = filled(2);
  CHECK(one.changes.ghosts == two.changes.ghosts);
  CHECK(one.changes.given_back.position == two.changes.given_back.position);
  CHECK(one.changes.given_back.f_dc == two.changes.given_back.f_dc);
}

TEST_CASE("fill: what does not touch anything flat is left in words") {
  const Thing apple(WithHole::options(20000), "apple");
  GaussianCloud cloud = apple.scene.cloud;
  for (std::size_t g = 0; g < cloud.size(); ++g)
    if (apple.test.truth_labels[g]) cloud.position[g].y -= 0.5f;  // up
  const SurfacePatch patch = fill_surface(cloud, apple.test.truth_labels, {}, {0, -1, 0}, {}, {});
  CHECK_FALSE(patch.why_not.empty());
  CHECK(patch.changes.given_back.empty());
  CHECK(patch.changes.ghosts.empty());
}

TEST_CASE("fill: where nothing beside the hole looks like its rim, nothing is made up") {
  const Thing apple(WithHole::options(20000), "apple");
  GaussianCloud cloud = apple.scene.cloud;
  const ObjectExtent extent = object_extent(cloud, apple.test.truth_labels);
  for (std::size_t g = 0; g < cloud.size(); ++g) {
    if (apple.test.truth_labels[g]) continue;
    const glm::vec3 away = cloud.position[g] - extent.centre_world;
    const float grey = (cloud.f_dc[g].r + cloud.f_dc[g].g + cloud.f_dc[g].b) / 3;
    cloud.f_dc[g] = glm::vec3(grey);  // as bright as before, on which the contact shadow depends
    if (glm::length(away) > 2 * extent.radius) continue;
    cloud.f_dc[g][away.x > 0 ? 0 : away.z > 0 ? 1 : 2] += 2.4f;
    cloud.f_dc[g] -= 0.8f;
  }
  const SurfacePatch patch = fill_surface(cloud, apple.test.truth_labels, {}, {0, -1, 0}, {}, {});
  CAPTURE(patch.rim_error);
  CHECK(patch.why_not == "nothing beside the hole looks like its rim");
  CHECK(patch.changes.given_back.empty());
  CHECK(patch.changes.ghosts.empty());
}

TEST_CASE("fill, seen from: cancelled at any moment they end in a moment") {
  const Thing apple(WithHole::options(20000), "apple");
  for (const int ms : {0, 3, 10, 20, 30, 40, 60, 80, 100, 130}) {
    std::stop_source stop;
    const std::jthread other([&] {
      std::this_thread::sleep_for(std::chrono::milliseconds(ms));
      stop.request_stop();
    });
    const Job job{.stop = stop.get_token(), .on_progress = {}};
    fill_surface(apple.scene.cloud, apple.test.truth_labels, {}, {0, -1, 0}, {}, job);
    const SeenFrom seen = seen_from(apple.scene.cloud, apple.test.truth_labels, {0, -1, 0}, {}, {}, job);
    seen_picture(seen, apple.scene.cloud, apple.test.truth_labels, job);
  }
}

TEST_CASE("support plane: a tilted one under a ball, among dust and a larger one farther off") {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> unit(-1, 1);
  const glm::vec3 normal = glm::normalize(glm::vec3(0.3f, 0.9f, -0.2f));
  const glm::vec3 u = glm::normalize(glm::cross(normal, glm::vec3(1, 0, 0))), v = glm::cross(normal, u);
  std::vector<glm::vec3> ball, rest;
  for (int i = 0; i < 2000; ++i) {
    const glm::vec3 direction = glm::normalize(glm::vec3(unit(random), unit(random), unit(random)));
    ball.push_back(glm::vec3(5, 6, 7) + direction);
    rest.push_back(glm::vec3(5, 6, 7) - normal + 2.0f * unit(random) * u + 2.0f * unit(random) * v +
                   0.01f * unit(random) * normal);
    rest.push_back(glm::vec3(5, 6, 7) +
                   2.0f * glm::vec3(1.0f, unit(random), unit(random)));  // does not touch
    if (i % 4 == 0)
      rest.push_back(glm::vec3(5, 6, 7) + 2.0f * glm::vec3(unit(random), unit(random), unit(random)));
  }
  const auto plane = support_plane(ball, rest, {glm::vec3(5, 6, 7), 1}, {0, 1, 0});
  REQUIRE(plane);
  CHECK(glm::dot(plane->normal_world, normal) > 0.9995f);
  CHECK(plane->height(glm::vec3(5, 6, 7)) == doctest::Approx(1).epsilon(0.02));
  CHECK_FALSE(support_plane(ball, {}, {glm::vec3(5, 6, 7), 1}, {0, 1, 0}));
}

TEST_CASE("support plane: under a ball that is seen from above alone, where a wall begins farther off") {
  std::mt19937 random(4);
  std::uniform_real_distribution<float> unit(-1, 1);
  const glm::vec3 centre(1, 2, 3), up(0, 0, 1);
  std::vector<glm::vec3> ball, rest;
  constexpr float kLowest = -0.7f;  // what views from 45 degrees above see of it
  while (ball.size() < 1000) {
    const glm::vec3 direction = glm::normalize(glm::vec3(unit(random), unit(random), unit(random)));
    if (direction.z > kLowest) ball.push_back(centre + direction);
  }
  while (rest.size() < 1500) {
    const glm::vec3 p(2.4f * unit(random), 2.4f * unit(random), -1);
    if (glm::length(glm::vec2(p)) > 1) rest.push_back(centre + p);  // the floor, but for what the ball hides
  }
  for (int i = 0; i < 1000; ++i)
    rest.push_back(centre + glm::vec3(1.5f, 2 * unit(random), -1 + unit(random) + 1));
  const auto plane = support_plane(ball, rest, {centre, 1}, up);
  REQUIRE(plane);
  CHECK(glm::dot(plane->normal_world, up) > 0.9995f);
  CHECK(plane->height(centre) == doctest::Approx(1).epsilon(0.02));
}

TEST_CASE("support plane: what a thing stands on, not the wall that it touches as well") {
  std::mt19937 random(5);
  std::uniform_real_distribution<float> unit(-1, 1);
  std::vector<glm::vec3> cube, rest;
  for (int i = 0; i < 600; ++i) {
    const glm::vec2 p(unit(random), unit(random));
    for (int axis = 0; axis < 3; ++axis)
      for (const float side : {-1.0f, 1.0f}) {
        glm::vec3 on_face(p, side);
        std::swap(on_face[2], on_face[axis]);
        cube.push_back(on_face);
      }
    rest.emplace_back(1, 2.5f * p.x, 2.5f * p.y);
    rest.emplace_back(2.5f * p.x, 2.5f * p.y, -1);
  }
  for (const glm::vec3& up : {glm::vec3(0, 0, 1), glm::vec3(-1, 0, 0)}) {
    const auto plane = support_plane(cube, rest, {glm::vec3(0), 1.7f}, up);
    REQUIRE(plane);
    CHECK(glm::dot(plane->normal_world, up) > 0.9995f);
  }
}
