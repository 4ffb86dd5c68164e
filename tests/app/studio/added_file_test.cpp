// Where a file stands that is added to the scene in the window.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "hands.h"
#include "opened_sample.h"
#include "several_scenes.h"

using namespace splatcut;
using namespace splatcut::testing;

namespace {

// Height of the box's lowest corner along up, once it is moved.
float lowest_corner(const Box& box, const Similarity& to, const glm::vec3& up) {
  float lowest = std::numeric_limits<float>::max();
  for (int corner = 0; corner < 8; ++corner) {
    const glm::vec3 at((corner & 1) ? box.min.x : box.max.x, (corner & 2) ? box.min.y : box.max.y,
                       (corner & 4) ? box.min.z : box.max.z);
    lowest = std::min(lowest, glm::dot(moved(at, to), glm::normalize(up)));
  }
  return lowest;
}

}  // namespace

TEST_CASE("several scenes: an added file comes to stand upright on what one looks at") {
  const ScratchFolder folder("several_onto");
  Hands hands;
  Studio& studio = hands.studio();
  const auto a = small_scene(folder, "a.ply", 1), b = small_scene(folder, "b.ply", 2);
  const glm::vec3 seen = studio.viewport().looked_at_world(), beside = seen + glm::vec3(1, 0, 0.5f);
  const Camera camera = studio.viewport().pane_camera();
  const glm::vec2 middle = 0.5f * studio.viewport().size_px();
  CHECK(glm::distance(camera.pixel_from_camera(camera.camera_from_world(seen)), middle) < 0.5f);
  const auto stands_on = [&](const SceneSource& file, const glm::vec3& point) {
    const glm::vec3 up = studio.document().up_world;
    return file.place == stood_on(file, stood_upright(file, {}, up), point, up);
  };
  studio.apply(AddScene{a, {}, seen});
  studio.apply(AddScene{b, {}, beside});  // while the first is read
  REQUIRE(hands.app.settle());
  REQUIRE(studio.scene()->files.size() == 3);
  const SceneSource first = studio.scene()->files[1], second = studio.scene()->files[2];
  CHECK(stands_on(first, seen));
  CHECK(stands_on(second, beside));
  studio.apply(PlaceScene{first.id, {}});
  REQUIRE(hands.app.settle());
  CHECK(studio.scene()->files[1].place == ScenePlace{});
  CHECK(studio.scene()->files[2].place == second.place);
  studio.apply(Undo{});
  REQUIRE(hands.app.settle());
  CHECK(studio.scene()->files[1].place == first.place);
}

TEST_CASE("several scenes: a file is brought onto the surface in the middle of the picture, or not at all") {
  const ScratchFolder folder("several_here");
  Hands hands(false);
  Studio& studio = hands.studio();
  add(hands, small_scene(folder));
  const std::uint32_t id = last_file(hands).id;
  // The view turns and is shifted: its pivot hangs in the air or lies under the table.
  hands.app.drag({{300, 200}, {300, 260}});
  hands.app.drag({{300, 260}, {300, 190}}, PointerButton::kRight);
  REQUIRE(hands.app.settle());
  const auto below = [&] {  // what is under the middle, but for the file itself
    const Camera camera = studio.viewport().pane_camera();
    std::vector<std::uint8_t> others = gaussians_of(*studio.scene(), id);
    for (std::uint8_t& g : others) g = !g;
    const auto hit = studio.viewport().hit_in(camera, 0.5f * studio.viewport().size_px(), make_flags(others));
    REQUIRE(hit);
    return hit->position_world;
  };
  REQUIRE(glm::distance(below(), studio.camera().pivot_world()) > 0.01f * studio.camera().scene_size());
  const glm::vec3 up = studio.document().up_world;
  for (int again = 0; again < 2; ++again) {  // it does not climb upon itself
    const glm::vec3 place = below();
    studio.apply(BringHere{id});
    REQUIRE(hands.app.settle());
    CHECK(glm::distance(foot_world(last_file(hands), up), place) < 1e-3f * studio.camera().scene_size());
  }
  const ScenePlace stands = last_file(hands).place;
  const glm::vec3 outside = 100 * studio.camera().scene_size() * glm::vec3(1, 0, 0);
  studio.apply(GoToCamera{look_at(outside, 2.0f * outside, up, 0.9f, 640, 480)});  // into the sky
  REQUIRE(hands.app.settle());
  studio.apply(BringHere{id});
  REQUIRE(hands.app.settle());
  CHECK(hands.said().find("Nothing to stand on") != std::string::npos);
  CHECK(last_file(hands).place == stands);
}

TEST_CASE("several scenes: a ring marks where a file would be brought, and it comes to stand there") {
  const ScratchFolder folder("several_ring");
  Hands hands(false);
  Studio& studio = hands.studio();
  add(hands, small_scene(folder));
  hands.app.frames(3);
  const UiRect ring = hands.app.button("middle");
  REQUIRE(ring.size().x > 0);
  CHECK(hands.app->interface().viewport().contains(ring.min));
  studio.apply(BringHere{last_file(hands).id});
  REQUIRE(hands.app.settle());
  const glm::vec2 foot = hands.seen_at(foot_world(last_file(hands), studio.document().up_world));
  CHECK(glm::distance(foot, 0.5f * (ring.min + ring.max)) < 2);
  hands.app.interface_state().placing.file = 0;
  hands.app.frames(3);
  CHECK(hands.app.button("middle").size().x == 0);
}

TEST_CASE("several scenes: F frames what is placed, and the object that was clicked since") {
  const ScratchFolder folder("several_framed");
  Hands hands(false);
  Studio& studio = hands.studio();
  add(hands, small_scene(folder));
  hands.app.frames(3);  // its handles show
  const float size = studio.camera().scene_size();
  studio.apply(PlaceScene{last_file(hands).id, {{0.4f * size, 0, 0}, {}, 0.1f}});
  REQUIRE(hands.app.settle());
  const auto in_middle = [&](const glm::vec3& world) {
    const Camera camera = studio.viewport().pane_camera();
    const glm::vec2 middle(0.5f * static_cast<float>(camera.width_px),
                           0.5f * static_cast<float>(camera.height_px));
    return glm::distance(camera.pixel_from_camera(camera.camera_from_world(world)), middle) <
           0.2f * static_cast<float>(camera.height_px);
  };
  const SceneSource& file = last_file(hands);
  const auto middle_of_file = [&] { return moved(file.solid.centre(), similarity_of(file)); };
  REQUIRE_FALSE(in_middle(middle_of_file()));
  hands.app.key('F');
  REQUIRE(hands.app.settle());
  CHECK(in_middle(middle_of_file()));

  studio.apply(GoToCamera{studio.scene()->views().reference});
  REQUIRE(hands.app.settle());
  hands.app.click(hands.app.screen_of(kOnApple));
  REQUIRE(hands.app.settle());
  hands.app.key('F');
  REQUIRE(hands.app.settle());
  CHECK_FALSE(in_middle(middle_of_file()));
}

TEST_CASE("several scenes: a file stood upright stands on its point, whichever way up it was") {
  SceneSource file;
  file.bounds = {{-1, -2, -3}, {2, 1, 4}};
  const ScenePlace placed{{5, 6, 7}, {10, 20, 30}, 1.5f};
  for (const glm::vec3& own :
       {glm::vec3(0, 1, 0), glm::vec3(0, -1, 0), glm::vec3(1, 0, 0), glm::vec3(0.3f, -0.5f, 0.8f)})
    for (const glm::vec3& up : {glm::vec3(0, -1, 0), glm::vec3(0, 0, 2), glm::vec3(0.6f, 0.1f, -0.2f)}) {
      auto views = std::make_shared<FileViews>();
      views->up_world = own;
      file.views = views;
      const glm::vec3 point(0.5f, -4, 9);
      file.place = stood_on(file, stood_upright(file, placed, up), point, up);
      const Similarity to = similarity_of(file);
      CHECK(glm::dot(glm::normalize(to.rotation * own), glm::normalize(up)) > 0.9999f);
      CHECK(file.place.scale == placed.scale);
      const float lowest = lowest_corner(file.bounds, to, up) - glm::dot(point, glm::normalize(up));
      CHECK(std::abs(lowest) < 1e-4f);
    }
}

TEST_CASE("several scenes: where a file stands upright already, that is said, and why none is sure of it") {
  const glm::vec3 up(0, -2, 0);
  SceneSource file;
  file.bounds = {{-1, -2, -3}, {2, 1, 4}};
  const auto with_up = [&](const glm::vec3& own, bool guess) {
    FileViews views;
    views.up_world = own;
    views.up_is_guess = guess;
    file.views = std::make_shared<FileViews>(views);
  };
  with_up({0, 0, 3}, false);
  CHECK(why_upright(file, {}, up).empty());
  const ScenePlace upright = stood_upright(file, {}, up);
  CHECK(why_upright(file, upright, up) == "It stands upright already");
  with_up({0, -1, 0}, false);
  CHECK(why_upright(file, {}, up) == "It stands upright already");
  CHECK(why_upright(file, {{1, 2, 3}, {0, 40, 0}, 2}, up) == "It stands upright already");  // turned about up
  CHECK(why_upright(file, {{}, {1, 0, 0}}, up).empty());
  with_up({0, -1, 0}, true);
  CHECK(why_upright(file, {}, up).starts_with("It stands upright already, as far as can be guessed"));
}

TEST_CASE("several scenes: the button that stands a file upright is greyed where it does") {
  const ScratchFolder folder("several_upright");
  HeadlessApp app(kSmallWidth, 1000);
  opened(app);
  Studio& studio = app.studio();
  const auto file = small_scene(folder);
  studio.apply(AddScene{file});
  REQUIRE(app.settle());
  const std::uint32_t id = studio.scene()->files.back().id;
  studio.apply(PlaceScene{id, {{}, {30, 0, 10}}});
  REQUIRE(app.settle());
  app.interface_state().placing.file = id;
  app.frames(3);
  const auto press = [&] {
    const UiRect at = app.button("Stand it upright");
    REQUIRE(at.size().x > 0);
    app.click(0.5f * (at.min + at.max));
    REQUIRE(app.settle());
  };
  const std::size_t steps = studio.history().entries().size();
  press();
  const SceneSource placed = studio.scene()->files.back();
  CHECK_FALSE(why_upright(placed, placed.place, studio.document().up_world).empty());
  CHECK(studio.history().entries().size() == steps + 1);
  press();
  CHECK(studio.history().entries().size() == steps + 1);
  // A scale is not cut off. Its field is what the pointer is on beside "Scale", as far as it reaches.
  app->interface().make_current();
  const UiRect upright = app.button("Stand it upright");
  const float begin = app.window("side/scroll").min.x + 64,
              above = upright.min.x > begin ? 0 : upright.size().y + ImGui::GetStyle().ItemSpacing.y;
  const auto pointed_at = [&](float x) {
    app.move({begin + x, 0.5f * (upright.min.y + upright.max.y) - above});
    app.frames(2);
    app->interface().make_current();
    return GImGui->HoveredId;
  };
  const ImGuiID field = pointed_at(1);
  REQUIRE(field != 0);
  float width = 1;
  while (width < 400 && pointed_at(width) == field) ++width;
  const float needed = ImGui::CalcTextSize("0.2759 times").x + 2 * ImGui::GetStyle().FramePadding.x;
  CHECK(width >= needed);
  CHECK(width < needed + 60);  // it was the field, not a row
  // No number moves where the file becomes far too large.
  const glm::vec2 before = app.button("Fit").min;
  REQUIRE(before.x > 0);
  studio.apply(PlaceScene{id, {{}, {}, 300}});
  REQUIRE(app.settle());
  app.frames(3);
  REQUIRE_FALSE(
      misfit(studio.scene()->files.back(), studio.viewport().pane_camera(), studio.document().up_world)
          .empty());
  CHECK(app.button("Fit").min == before);
}

TEST_CASE("several scenes: the numbers of a file say where it goes before it is there") {
  const ScratchFolder folder("several_going");
  HeadlessApp app(kSmallWidth, 1000);
  opened(app);
  Studio& studio = app.studio();
  studio.apply(AddScene{small_scene(folder)});
  REQUIRE(app.settle());
  const std::uint32_t id = studio.scene()->files.back().id;
  app.interface_state().placing.file = id;
  app.frames(3);
  const ScenePlace there{{1, 2, 3}, {}, 0.5f};
  studio.apply(PlaceScene{id, there});
  app.frames(1);
  REQUIRE(studio.loading());
  CHECK(studio.scene()->files.back().place != there);
  CHECK(app.interface_state().placing.place == there);  // what is typed now begins there
  REQUIRE(app.settle());
  CHECK(studio.scene()->files.back().place == there);
}

TEST_CASE("several scenes: scaled, a file stays on its foot") {
  SceneSource file;
  file.bounds = {{-1, -1, -1}, {1, 1, 1}};
  file.solid = {{-1, -2, -3}, {2, 1, 4}};
  const ScenePlace placed{{5, 6, 7}, {10, 20, 30}, 1.5f};
  for (const glm::vec3& up : {glm::vec3(0, -1, 0), glm::vec3(0, 0, 2), glm::vec3(0.6f, 0.1f, -0.2f)})
    for (const float scale : {0.1f, 1.5f, 20.0f}) {
      file.place = placed;
      const glm::vec3 foot = foot_world(file, up);
      file.place = scaled_on_foot(file, placed, scale, up);
      CHECK(file.place.scale == scale);
      CHECK(file.place.turn_deg == placed.turn_deg);
      CHECK(glm::distance(foot_world(file, up), foot) < 1e-4f);
      const Similarity to = similarity_of(file);
      const float lowest = lowest_corner(file.solid, to, up) - glm::dot(foot, glm::normalize(up));
      CHECK(std::abs(lowest) < 1e-3f);
    }
}

TEST_CASE("several scenes: a file far larger or smaller than what is looked at is told, and Fit mends it") {
  const ScratchFolder folder("several_fit");
  Hands hands(false);
  Studio& studio = hands.studio();
  Scene scene = load_scene(kSmallSample);
  const GaussianCloud own = scene.cloud;
  const auto scaled = [&](float scale, const std::string& name) {
    for (std::size_t g = 0; g < own.size(); ++g) {
      scene.cloud.position[g] = scale * own.position[g];
      scene.cloud.scale[g] = scale * own.scale[g];
    }
    scene.rows_can_be_copied = false;
    save_scene(folder / name, scene, {}, SceneFormat::kPly);
    return folder / name;
  };
  const auto added = [&](const std::filesystem::path& path) {
    studio.apply(AddScene{path, {}, studio.viewport().looked_at_world()});
    REQUIRE(hands.app.settle());
    return hands.said();
  };
  for (const auto& [scale, says] : {std::pair(30.0f, "smaller"), {0.01f, "larger"}, {200.0f, "inside"}}) {
    CAPTURE(scale);
    const std::string said = added(scaled(scale, fmt::format("a{}.ply", scale)));
    CAPTURE(said);
    const bool told = said.find(says) != std::string::npos || said.find("inside") != std::string::npos;
    CHECK(told);
    CHECK(said.find("Fit") != std::string::npos);
    const Camera camera = studio.viewport().pane_camera();
    const glm::vec3 up = studio.document().up_world, foot = foot_world(last_file(hands), up);
    studio.apply(PlaceScene{last_file(hands).id, fitted(last_file(hands), camera, up)});
    REQUIRE(hands.app.settle());
    CHECK(share_of_picture(last_file(hands), camera, up) == doctest::Approx(0.5).epsilon(0.01));
    CHECK(glm::distance(foot_world(last_file(hands), up), foot) < 1e-2f * studio.camera().scene_size());
    CHECK(misfit(last_file(hands), camera, up).empty());
    for (const auto& [folds, told_again] :
         {std::pair(3.9f, false), {4.1f, true}, {0.26f, false}, {0.24f, true}}) {
      CAPTURE(folds);
      SceneSource other = last_file(hands);
      other.place = scaled_on_foot(other, other.place, folds * other.place.scale, up);
      CHECK(misfit(other, camera, up).empty() != told_again);
    }
    studio.apply(RemoveScene{last_file(hands).id});
    REQUIRE(hands.app.settle());
  }
  CHECK(added(scaled(1, "a1.ply")).find("Fit") == std::string::npos);
}

TEST_CASE("several scenes: the box of an added file holds all of it but strays") {
  const ScratchFolder folder("several_solid");
  Hands hands(false);
  Scene scene;
  scene.cloud = random_cloud(4000, 3, 0);
  scene.file_rows = scene.cloud.size();
  std::ranges::fill(scene.cloud.opacity, 0.9f);
  Box all{scene.cloud.position[0], scene.cloud.position[0]};
  for (const glm::vec3& p : scene.cloud.position) {
    all.min = glm::min(all.min, p);
    all.max = glm::max(all.max, p);
  }
  for (std::size_t g = 0; g < 12; ++g)  // strays
    scene.cloud.position[331 * g] = all.centre() + (3.0f + 0.7f * static_cast<float>(g)) * all.extent();
  save_scene(folder / "strays.ply", scene, {}, SceneFormat::kPly);
  add(hands, folder / "strays.ply");
  const Box solid = last_file(hands).solid;
  CHECK(glm::length(solid.extent() - all.extent()) < 0.05f * glm::length(all.extent()));
  CHECK(glm::length(last_file(hands).bounds.extent()) < 0.95f * glm::length(solid.extent()));
}

TEST_CASE(
    "several scenes: a step of placing says what was done, and bringing a file where it stands is none") {
  const ScratchFolder folder("several_named");
  Hands hands(false);
  Studio& studio = hands.studio();
  add(hands, small_scene(folder, "a.ply"));
  const std::uint32_t id = last_file(hands).id;
  const auto step_of = [&](const Command& command) {
    studio.apply(command);
    REQUIRE(hands.app.settle());
    return studio.history().entries()[studio.history().cursor()].title;
  };
  CHECK(step_of(PlaceScene{id, {{1, 0, 0}}}) == "a.ply moved");
  CHECK(step_of(PlaceScene{id, {{1, 0, 0}, {0, 30, 0}}}) == "a.ply turned");
  CHECK(step_of(PlaceScene{id, {{1, 1, 0}, {0, 30, 0}, 2}}) == "a.ply scaled");
  CHECK(step_of(PlaceScene{id, {}}) == "a.ply put back as in its file");
  CHECK(step_of(BringHere{id}) == "a.ply brought here");
  const std::size_t steps = hands.steps();
  CHECK(step_of(BringHere{id}) == "a.ply brought here");
  CHECK(hands.said() == "a.ply stands there already");
  CHECK(hands.steps() == steps);
}
