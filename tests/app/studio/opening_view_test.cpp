// The way back to the view in which a scene opened.
#include <doctest/doctest.h>

#include <cmath>
#include <filesystem>
#include <glm/gtc/matrix_access.hpp>

#include "hands.h"

using namespace splatcut;
using namespace splatcut::testing;

namespace {

void leave(Hands& hands) {
  hands.studio().camera().orbit({200, 30});
  hands.studio().camera().zoom(-8);
  hands.studio().apply(SetFieldOfView{0.4f});
}

void go_back(Hands& hands) {
  hands.app.key(key::kHome, {true, false, false});
  REQUIRE(hands.app.settle());
}

}  // namespace

TEST_CASE("opening view: one key goes back to it, in a move that is no step of undo") {
  Hands hands;
  const CameraController& camera = hands.studio().camera();
  const CameraPose start = camera.pose();
  const std::size_t steps = hands.steps();
  leave(hands);
  REQUIRE_FALSE(camera.pose() == start);
  const CameraPose away = camera.pose();
  hands.app.key(key::kHome, {true, false, false});
  hands.app.frames(2);
  CHECK(camera.goal() == start);
  CHECK_FALSE(camera.pose() == start);  // on the way
  CHECK_FALSE(camera.pose() == away);
  REQUIRE(hands.app.settle());
  CHECK(camera.pose() == start);
  CHECK(hands.steps() == steps);
}

TEST_CASE("opening view: it stays that of the scene where saved work opens elsewhere, and a file is added") {
  const ScratchFolder folder("opening_view");
  Hands hands;
  const CameraPose start = hands.studio().camera().pose();
  leave(hands);
  hands.studio().apply(SaveWork{folder / "away.splatcut.json"});
  REQUIRE(hands.app.settle());
  hands.studio().apply(OpenScene{folder / "away.splatcut.json"});
  REQUIRE(hands.app.settle());
  REQUIRE_FALSE(hands.studio().camera().pose() == start);
  std::filesystem::copy_file(kSmallSample, folder / "other.compressed.ply");
  hands.studio().apply(AddScene{folder / "other.compressed.ply"});
  REQUIRE(hands.app.settle());
  go_back(hands);
  CHECK(hands.studio().camera().pose() == start);
}

TEST_CASE("opening view: once another way is up it stands upright to that") {
  Hands hands(false);
  hands.studio().apply(SetUp{{0, 0.3f, 1}});
  leave(hands);
  go_back(hands);
  const glm::vec3 right = glm::row(glm::mat3_cast(hands.studio().camera().pose().camera_from_world), 0);
  CHECK(std::abs(glm::dot(right, hands.studio().document().up_world)) < 1e-3f);
}

TEST_CASE("opening view: work restored with another way up than the scene's goes back to it upright") {
  const ScratchFolder folder("opening_up");
  Hands hands(false);
  hands.studio().apply(SetUp{{0, 0.3f, 1}});
  hands.studio().apply(SaveWork{folder / "up.splatcut.json"});
  REQUIRE(hands.app.settle());
  hands.studio().apply(OpenScene{folder / "up.splatcut.json"});
  REQUIRE(hands.app.settle());
  leave(hands);
  go_back(hands);
  const glm::vec3 right = glm::row(glm::mat3_cast(hands.studio().camera().pose().camera_from_world), 0);
  CHECK(std::abs(glm::dot(right, hands.studio().document().up_world)) < 1e-3f);
}

TEST_CASE("opening view: of scenes opened together it shows all of them") {
  const ScratchFolder folder("opened_together");
  std::filesystem::copy_file(kSmallSample, folder / "one.compressed.ply");
  std::filesystem::copy_file(kSmallSample, folder / "two.compressed.ply");
  Hands hands(false);
  hands.studio().apply(OpenScene{folder / "one.compressed.ply", {}, {folder / "two.compressed.ply"}});
  REQUIRE(hands.app.settle());
  const CameraPose start = hands.studio().camera().pose();
  leave(hands);
  go_back(hands);
  CHECK(hands.studio().camera().pose() == start);
}

TEST_CASE(
    "opening view: cameras that were asked for come before those beside the scene, also in saved work") {
  const ScratchFolder folder("asked_cameras");
  const std::filesystem::path scene = folder / "s.compressed.ply", asked = folder / "of/capture.json",
                              work = folder / "w.splatcut.json";
  std::filesystem::copy_file(kSmallSample, scene);
  std::filesystem::create_directory(folder / "of");
  std::filesystem::copy_file(kSampleFolder / "cameras.json", asked);
  Hands hands(false, with_kept_scenes(), scene);
  REQUIRE(hands.studio().scene()->views().cameras.empty());
  hands.studio().apply(OpenScene{scene, {}, {}, {}, asked, "2"});
  REQUIRE(hands.app.settle());
  const auto cameras = [&] { return hands.studio().scene()->views().cameras; };
  const std::size_t given = cameras().size();
  REQUIRE(given > 2);
  CHECK(glm::distance(hands.studio().camera().pose().position_world, cameras()[2].centre_world()) < 1e-3f);
  hands.studio().apply(SaveWork{work});
  REQUIRE(hands.app.settle());
  hands.studio().apply(OpenScene{work});
  REQUIRE(hands.app.settle());
  CHECK(cameras().size() == given);
  for (const auto& [file, camera, said] :
       {std::tuple(asked, "none_such", "has no camera \"none_such\""),
        std::tuple(scene, "0", "s.compressed.ply"),
        std::tuple(std::filesystem::path(), "0", "Give them with --cameras")}) {
    CAPTURE(said);
    const std::uint64_t before = hands.studio().scene()->serial;
    hands.studio().apply(OpenScene{scene, {}, {}, {}, file, camera});
    REQUIRE(hands.app.settle());
    CHECK(hands.studio().scene()->serial == before);
    CHECK_MESSAGE(hands.said().find(said) != std::string::npos, hands.said());
  }
}
