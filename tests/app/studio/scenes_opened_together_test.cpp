// Several files opened at once: where they stand, and what is said of those that cannot be read.
#include <doctest/doctest.h>

#include <algorithm>
#include <fstream>
#include <glm/gtc/matrix_access.hpp>

#include "app/work/work_file.h"
#include "hands.h"
#include "opened_sample.h"
#include "several_scenes.h"

using namespace splatcut;
using namespace splatcut::testing;

TEST_CASE(
    "several scenes: those opened together stand upright on what the first view shows, as one added later") {
  const ScratchFolder folder("several_at_once");
  Scene lying;
  lying.cloud = random_cloud(kAdded, 4, 0);
  lying.file_rows = lying.cloud.size();
  lying.up = glm::vec3(1, 0, 0);
  save_scene(folder / "lying.ply", lying, {}, SceneFormat::kPly);
  Hands hands(false);
  Studio& studio = hands.studio();
  const auto a = small_scene(folder, "a.ply");
  studio.apply(OpenScene{kSmallSample, {}, {folder / "lying.ply", a}});
  REQUIRE(hands.app.settle());
  REQUIRE(studio.scene()->files.size() == 3);
  const glm::vec3 up = studio.document().up_world;
  const SceneSource &first = studio.scene()->files[1], &second = studio.scene()->files[2];
  CHECK(first.path == folder / "lying.ply");
  CHECK_FALSE(why_upright(first, first.place, up).empty());
  CHECK(first.place != ScenePlace{});
  const glm::vec3 apart = foot_world(first, up) - foot_world(second, up);
  CHECK(std::abs(glm::dot(apart, glm::normalize(up))) < 1e-3f * studio.camera().scene_size());
  studio.apply(OpenScene{kSmallSample, {}, {folder / "no.ply"}});
  REQUIRE(hands.app.settle());
  CHECK(studio.scene()->files.size() == 1);
  CHECK(hands.said().find("no.ply") != std::string::npos);

  // A wrong camera is no fault of the scenes.
  const std::filesystem::path own = kSampleFolder / "cameras.json";
  std::ofstream(folder / "none.json") << "[]";
  for (const auto& [cameras, camera, words] : {std::tuple(own, "no_such", "no_such"),
                                               {folder / "none.json", "", "none.json: holds no camera"},
                                               {std::filesystem::path(), "no_such", "no_such"}}) {
    CAPTURE(words);
    studio.apply(OpenScene{.path = kSmallSample, .added = {a}, .cameras = cameras, .camera = camera});
    REQUIRE(hands.app.settle());
    CHECK(hands.said().find(words) != std::string::npos);
    CHECK(hands.said().find("None of the files") == std::string::npos);
  }
}

TEST_CASE(
    "several scenes: those opened together stand side by side, and one that is none is said while they "
    "open") {
  const ScratchFolder folder("several_beside");
  const auto bad = folder / "bad.ply";
  std::ofstream(bad) << "no scene";
  Hands hands(false);
  Studio& studio = hands.studio();
  const glm::vec3 seen = studio.viewport().looked_at_world();
  const auto a = small_scene(folder, "a.ply", 1), b = small_scene(folder, "b.ply", 2),
             c = small_scene(folder, "c.ply", 3);
  const auto said = [&](const std::string& words) {
    return std::ranges::any_of(studio.messages(),
                               [&](const Message& m) { return m.text.find(words) != std::string::npos; });
  };
  studio.apply(OpenScene{kSmallSample, {}, {a, bad, b, folder / "gone.ply", c}});
  REQUIRE(hands.app.settle());
  REQUIRE(studio.scene()->files.size() == 4);
  CHECK(hands.said().find("bad.ply") != std::string::npos);
  CHECK(hands.said().find("gone.ply") != std::string::npos);
  CHECK(said("a.ply, b.ply, c.ply added"));
  const glm::vec3 up = studio.document().up_world;
  const glm::vec3 row = glm::row(studio.viewport().pane_camera().camera_from_world_rotation, 0);
  const auto along = [&](const SceneSource& file) { return glm::dot(foot_world(file, up) - seen, row); };
  const std::vector<SceneSource> files = studio.scene()->files;
  float first = 0, last = 0;
  for (std::size_t i = 1; i < files.size(); ++i) {
    CHECK(std::abs(glm::dot(foot_world(files[i], up) - seen, up)) < 1e-3f);  // on one height
    const float half = half_extent(files[i], row);
    if (i == 1) first = along(files[i]) - half;
    if (i > 1) CHECK(along(files[i]) - half > last);  // beside the one before
    last = along(files[i]) + half;
  }
  CHECK(std::abs(first + last) < 1e-3f * (last - first));  // what one looks at is in the middle

  // One that is added later and is none leaves nothing behind: the next one comes in.
  studio.apply(AddScene{bad});
  REQUIRE(hands.app.settle());
  CHECK(hands.said().find("bad.ply") != std::string::npos);
  CHECK(studio.scene()->files.size() == 4);
  studio.apply(AddScene{bad});
  studio.apply(AddScene{small_scene(folder, "d.ply", 4)});  // while that is read
  REQUIRE(hands.app.settle());
  CHECK(studio.scene()->files.size() == 5);
  add(hands, small_scene(folder, "e.ply", 5));
  CHECK(studio.scene()->files.size() == 6);
  CHECK(hands.said().find("bad.ply") == std::string::npos);

  // The first of all is none.
  studio.apply(OpenScene{bad, {}, {a, b}});
  REQUIRE(hands.app.settle());
  REQUIRE(studio.scene()->files.size() == 2);
  CHECK(studio.scene()->files[0].path == a);
  CHECK(hands.said().find("bad.ply") != std::string::npos);
  studio.apply(OpenScene{bad, {}, {folder / "gone.ply"}});
  REQUIRE(hands.app.settle());
  CHECK(studio.scene()->files[0].path == a);
  CHECK(hands.said().find("bad.ply") != std::string::npos);
  CHECK(hands.said().find("gone.ply") != std::string::npos);
}

TEST_CASE(
    "several scenes: saved work among those opened together is refused in words, also where none opens") {
  const ScratchFolder folder("several_work");
  const auto work = folder / "my.splatcut.json";
  const auto scene = open_scene(kSmallSample);
  write_work_file(work, *scene, Document{});
  Hands hands(false);
  hands.studio().apply(OpenScene{folder / "gone.ply", {}, {work}});
  REQUIRE(hands.app.settle());
  CHECK(hands.said().find("my.splatcut.json: is saved work, not a scene") != std::string::npos);
  CHECK(hands.said().find("gone.ply") != std::string::npos);
  const auto a = small_scene(folder, "a.ply");
  hands.studio().apply(OpenScene{folder / "gone.ply", {}, {work, a}});
  REQUIRE(hands.app.settle());
  CHECK(hands.studio().scene()->files.front().path == a);
  CHECK(hands.said().find("my.splatcut.json: is saved work, not a scene") != std::string::npos);
}
