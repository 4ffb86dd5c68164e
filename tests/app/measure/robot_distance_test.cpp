// The any-view robot from other distances: its first click zoomed, its corrections from near.
#include <doctest/doctest.h>

#include <memory>
#include <nlohmann/json.hpp>

#include "app/lab/eval_suite.h"
#include "app/measure/any_view.h"
#include "program_runner.h"
#include "scene/raster/rasterizer.h"

using namespace splatcut;
using namespace splatcut::testing;
using nlohmann::json;

TEST_CASE("zoom: the camera stands on the ray of the clicked pixel, at so many times the distance") {
  const Workplace place;
  REQUIRE(place.run("make-scene small -o made --gaussians 3000").code == 0);
  for (const json& entry : read_suite(place / "made/suite.json")) {
    if (entry["name"] != "apple") continue;
    const auto loaded = load_case(entry, place / "made", {}, {});
    const AnyViewStart start = any_view_starts(loaded->test, truth_views(loaded->test)).front();
    const glm::vec2 pixel = start.first.points_px.front();
    RasterOptions options;
    options.depth = true;
    const float z = rasterize(loaded->scene.cloud, start.camera, options)
                        .median_depth.at(static_cast<int>(pixel.x), static_cast<int>(pixel.y));
    const glm::vec3 hit = start.camera.world_from_pixel(pixel, z);
    for (const float factor : {0.4f, 0.6f, 1.0f, 2.0f, 4.0f}) {
      const auto moved = zoomed_click(loaded->scene.cloud, start, factor);
      CHECK(moved.has_value() == (factor <= 1));  // from farther the mug stands before it
      if (!moved) continue;
      CHECK(glm::distance(moved->camera.centre_world(), hit) ==
            doctest::Approx(factor * glm::distance(start.camera.centre_world(), hit)).epsilon(1e-4));
      const glm::vec2 at = moved->camera.pixel_from_camera(moved->camera.camera_from_world(hit));
      CHECK(glm::distance(at, pixel) < 0.1f);
      CHECK(moved->stroke.points_px.front() == pixel);
    }
  }
}

TEST_CASE("near: later clicks are made on the ray of the same pixel, from that share of the distance") {
  const Workplace place;
  REQUIRE(place.run("make-scene small -o made --gaussians 3000").code == 0);
  int nearer = 0;
  for (const json& entry : read_suite(place / "made/suite.json")) {
    const auto loaded = load_case(entry, place / "made", {}, {});
    const auto views = truth_views(loaded->test);
    const AnyViewStart start = any_view_starts(loaded->test, views).front();
    const AnyViewWorld world =
        window_world(loaded->test, views, std::make_shared<WindowCut>(loaded->test, "default"));
    const AnyViewSession usual = any_view_session(world, start, 2);
    const AnyViewSession near = any_view_session(world, start, 2, {.near = 0.5f});
    CHECK(same_camera(near.clicks.front().camera, start.camera));
    REQUIRE(usual.clicks.size() == near.clicks.size());
    if (usual.clicks.size() < 2) continue;
    const ViewClick &from = usual.clicks[1], &to = near.clicks[1];
    CHECK(to.stroke.points_px == from.stroke.points_px);
    CHECK(to.stroke.label == from.stroke.label);
    if (same_camera(to.camera, from.camera)) continue;  // something else shows from near
    ++nearer;
    const glm::vec2 pixel = from.stroke.points_px.front();
    const glm::vec3 step = to.camera.centre_world() - from.camera.centre_world();
    const glm::vec2 at =
        from.camera.pixel_from_camera(from.camera.camera_from_world(to.camera.centre_world()));
    CHECK(glm::length(step) > 0);
    CHECK(glm::distance(at, pixel) < 1);
  }
  CHECK(nearer > 0);
}
