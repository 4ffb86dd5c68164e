// Several files as a row of a scene: beside what stands alone, given together or added one by one.
#include <doctest/doctest.h>

#include <glm/gtc/matrix_access.hpp>

#include "hands.h"
#include "several_scenes.h"

using namespace splatcut;
using namespace splatcut::testing;

namespace {

// Around the origin, with these half axes, in a file without cameras that says its up.
std::filesystem::path ellipsoid(const ScratchFolder& folder, const char* name, const glm::vec3& half_axes) {
  Scene scene;
  scene.cloud = random_cloud(kAdded, 7, 1);
  for (glm::vec3& p : scene.cloud.position) p = half_axes * glm::normalize(p);
  scene.file_rows = scene.cloud.size();
  scene.up = glm::vec3(0, -1, 0);
  save_scene(folder / name, scene, {}, SceneFormat::kPly);
  return folder / name;
}

}  // namespace

TEST_CASE("several scenes: beside a thing that stands alone others stand on its ground, and all are seen") {
  const ScratchFolder folder("several_alone");
  Hands hands(false);
  Studio& studio = hands.studio();
  studio.apply(OpenScene{ellipsoid(folder, "a.ply", {1, 2, 1}),
                         {},
                         {ellipsoid(folder, "b.ply", {2, 1, 1}), ellipsoid(folder, "c.ply", {1, 1, 3})}});
  REQUIRE(hands.app.settle());
  const std::vector<SceneSource> files = studio.scene()->files;
  REQUIRE(files.size() == 3);
  const glm::vec3 up = studio.document().up_world;
  const Camera camera = studio.viewport().pane_camera();
  const glm::vec3 row = glm::row(camera.camera_from_world_rotation, 0);
  float last = glm::dot(foot_world(files[0], up), row) + half_extent(files[0], row);
  for (std::size_t i = 1; i < files.size(); ++i) {
    CHECK(std::abs(glm::dot(foot_world(files[i], up) - foot_world(files[0], up), up)) < 0.02f);
    CHECK(glm::dot(foot_world(files[i], up), row) - half_extent(files[i], row) > last);
    last = glm::dot(foot_world(files[i], up), row) + half_extent(files[i], row);
  }
  for (const SceneSource& file : files) {
    const glm::vec2 at = camera.pixel_from_camera(camera.camera_from_world(foot_world(file, up)));
    CHECK(at.x > 0);
    CHECK(at.x < static_cast<float>(camera.width_px));
    CHECK(at.y < static_cast<float>(camera.height_px));
  }

  // A view that was moved while the others were read stays.
  Hands moved_hands(false);
  Studio& moved_studio = moved_hands.studio();
  const std::size_t before = moved_studio.scene()->files.size();
  REQUIRE(before == 1);
  moved_studio.apply(OpenScene{files[0].path, {}, {files[1].path, files[2].path}});
  for (int frame = 0; frame < 10000 && moved_studio.scene()->files[0].path != files[0].path; ++frame)
    moved_hands.app.frames(1);
  REQUIRE(moved_studio.scene()->files.size() == 1);
  moved_studio.camera().orbit({80, 10});
  const CameraPose pose = moved_studio.camera().goal();
  REQUIRE(moved_hands.app.settle());
  CHECK(moved_studio.scene()->files.size() == 3);
  CHECK(moved_studio.camera().goal() == pose);
}

TEST_CASE(
    "several scenes: one that is added to a thing that stands alone stands beside it, a small one on it") {
  const ScratchFolder folder("several_later");
  Hands hands(false);
  Studio& studio = hands.studio();
  studio.apply(OpenScene{ellipsoid(folder, "a.ply", glm::vec3(1))});
  REQUIRE(hands.app.settle());
  const glm::vec3 up = studio.document().up_world;
  const Camera camera = studio.viewport().pane_camera();
  const glm::vec3 row = glm::row(camera.camera_from_world_rotation, 0);
  const auto end_along_row = [&](const SceneSource& file, float side) {
    return glm::dot(foot_world(file, up), row) + side * half_extent(file, row);
  };
  const auto added = [&](const std::filesystem::path& path) {
    studio.apply(AddScene{path, {}, studio.viewport().looked_at_world()});
    REQUIRE(hands.app.settle());
    return last_file(hands);
  };
  float last = end_along_row(studio.scene()->files.front(), 1);
  for (const char* name : {"b.ply", "c.ply"}) {
    const SceneSource file = added(ellipsoid(folder, name, glm::vec3(0.8f)));
    CHECK(end_along_row(file, -1) > last);
    last = end_along_row(file, 1);
    const Camera shown = studio.viewport().pane_camera();
    const glm::vec2 at = shown.pixel_from_camera(shown.camera_from_world(foot_world(file, up)));
    CHECK(at.x > 0);
    CHECK(at.x < static_cast<float>(shown.width_px));
  }
  const CameraPose pose = studio.camera().goal();
  const glm::vec3 seen = studio.viewport().looked_at_world();
  const SceneSource hat = added(ellipsoid(folder, "hat.ply", glm::vec3(0.3f)));
  CHECK(glm::distance(foot_world(hat, up), seen) < 1e-3f);
  CHECK(studio.camera().goal() == pose);
}

TEST_CASE("several scenes: axes that are asked for with several files are those of every .spz of them") {
  const ScratchFolder folder("several_axes");
  Scene scene;
  scene.cloud = random_cloud(kAdded, 7, 1);
  scene.file_rows = scene.cloud.size();
  save_scene(folder / "a.ply", scene, {}, SceneFormat::kPly);
  save_scene(folder / "b.spz", scene, {}, SceneFormat::kSpz);
  Hands hands(false);
  for (const SpzAxes axes : {SpzAxes::kPly, SpzAxes::kRub}) {
    hands.studio().apply(OpenScene{folder / "a.ply", axes, {folder / "b.spz"}});
    REQUIRE(hands.app.settle());
    REQUIRE(hands.studio().scene()->files.size() == 2);
    CHECK(last_file(hands).spz_axes == axes);
  }
}
