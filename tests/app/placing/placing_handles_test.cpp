// Handles that move, turn and scale: what a drag means, and the same in the window and in the export dialog.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <random>

#include "app/placing/placing_handles.h"
#include "hands.h"
#include "synthetic_cloud.h"

using namespace splatcut;
using namespace splatcut::testing;

namespace {

const std::vector<glm::vec3> kAxes = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};

Camera camera_at_five() {
  Camera camera;
  camera.width_px = camera.height_px = 200;
  camera.fx_px = camera.fy_px = 100;
  camera.cx_px = camera.cy_px = 100;
  camera.camera_from_world_translation = {0, 0, 5};
  return camera;
}

const PlacingHandle* find(const std::vector<PlacingHandle>& shown, PlacingGrip grip, std::size_t axis = 0) {
  for (const PlacingHandle& handle : shown)
    if (handle.grip == grip && handle.axis == axis) return &handle;
  return nullptr;
}

glm::vec2 pixel_of(const Camera& camera, const glm::vec3& world) {
  return camera.pixel_from_camera(camera.camera_from_world(world));
}

// In the middle of an arrow, a quarter along a ring, or the point itself.
glm::vec2 grip_of(const PlacingHandle& handle) {
  if (handle.grip == PlacingGrip::kMoveAlong) return 0.5f * (handle.path_px[0] + handle.path_px[1]);
  return handle.path_px[handle.path_px.size() / 4];
}

glm::vec3 after(const glm::vec3& p, const PlacingChange& change, const glm::vec3& centre) {
  return change.scale * (change.turn * (p - centre)) + centre + change.move_world;
}

// The files panel opens with the added file chosen.
void add_small(Hands& hands, const ScratchFolder& folder) {
  Scene small;
  small.cloud = random_cloud(300, 1, 1);
  small.file_rows = small.cloud.size();
  save_scene(folder / "small.ply", small, {}, SceneFormat::kPly);
  hands.studio().apply(AddScene{folder / "small.ply"});
  REQUIRE(hands.app.settle());
  hands.app.frames(3);
}

}  // namespace

TEST_CASE("placing: drags by hand, seen along z from five units away") {
  const PlacingHandles handles{{0, 0, 0}, kAxes, kAxes, 80};
  const Camera camera = camera_at_five();
  const auto shown = handles_px(handles, camera);
  CHECK_FALSE(find(shown, PlacingGrip::kMoveAlong, 2));  // it points at the camera
  const PlacingHandle* x = find(shown, PlacingGrip::kMoveAlong, 0);
  REQUIRE(x);
  CHECK(glm::distance(x->path_px.back(), {100 + 0.74f * 80, 100}) < 1e-3f);
  const PlacingChange along = dragged(handles, *x, {120, 100}, {140, 100}, camera, false);
  CHECK(glm::distance(along.move_world, {1, 0, 0}) < 1e-4f);  // 20 pixels at depth 5 over 100
  CHECK(along.scale == 1);
  const PlacingHandle* z = find(shown, PlacingGrip::kTurn, 2);
  REQUIRE(z);
  const PlacingChange turn = dragged(handles, *z, {150, 100}, {100, 160}, camera, false);
  CHECK(std::abs(turn.angle_rad - glm::half_pi<float>()) < 1e-4f);
  CHECK(glm::distance(turn.turn * glm::vec3(1, 0, 0), {0, 1, 0}) < 1e-4f);
  CHECK(std::abs(dragged(handles, *z, {150, 100}, {150, 112}, camera, true).angle_rad - glm::radians(15.0f)) <
        1e-5f);
  CHECK(dragged(handles, *z, {150, 100}, {150, 104}, camera, true).angle_rad == 0);
  PlacingHandles turned = handles;  // steps are of all that it is turned and scaled
  turned.turned_deg = {0, 0, 37.9f};
  turned.scaled = 1.23f;
  CHECK(std::abs(dragged(turned, *z, {150, 100}, {150, 108}, camera, true).angle_rad -
                 glm::radians(45 - 37.9f)) < 1e-5f);
  const PlacingHandle* scale = find(shown, PlacingGrip::kScale);
  REQUIRE(scale);
  CHECK(std::abs(dragged(handles, *scale, {130, 100}, {100, 160}, camera, false).scale - 2) < 1e-5f);
  CHECK(std::abs(dragged(handles, *scale, {130, 100}, {100, 161}, camera, true).scale - 2) < 1e-5f);
  CHECK(dragged(handles, *scale, {130, 100}, {100, 100}, camera, true).scale > 0);
  CHECK(std::abs(1.23f * dragged(turned, *scale, {130, 100}, {132, 100}, camera, true).scale - 1.3f) < 1e-5f);
  const PlacingHandle* move = find(shown, PlacingGrip::kMove);
  REQUIRE(move);
  CHECK(glm::distance(dragged(handles, *move, {100, 100}, {80, 140}, camera, false).move_world, {-1, 2, 0}) <
        1e-4f);
  Camera behind = camera;
  behind.camera_from_world_translation.z = -5;
  CHECK(handles_px(handles, behind).empty());
}

TEST_CASE("placing: what is grabbed follows the pointer, from any side") {
  std::mt19937 random(7);
  std::normal_distribution<float> normal;
  const auto vector = [&] { return glm::vec3(normal(random), normal(random), normal(random)); };
  int turns = 0, moves = 0;
  for (int round = 0; round < 60; ++round) {
    const PlacingHandles handles{vector(), kAxes, {glm::normalize(vector())}, 80};
    const Camera camera = look_at(handles.centre_world + 6.0f * glm::normalize(vector()),
                                  handles.centre_world + 0.3f * vector(), {0.1f, 1, 0.2f}, 0.8f, 400, 300);
    for (const PlacingHandle& handle : handles_px(handles, camera)) {
      const glm::vec2 from = grip_of(handle);
      if (handle.grip == PlacingGrip::kMoveAlong) {
        // A point of the axis under the pointer is under it afterwards.
        const glm::vec3 axis = handles.arrow_axes[handle.axis];
        const glm::vec3 a = handles.centre_world + 0.4f * axis, b = handles.centre_world + 1.1f * axis;
        const PlacingChange change =
            dragged(handles, handle, pixel_of(camera, a), pixel_of(camera, b), camera, false);
        CHECK(glm::distance(change.move_world, b - a) < 0.02f);
        ++moves;
      }
      if (handle.grip == PlacingGrip::kTurn) {
        const glm::vec3 axis = handles.turn_axes[0];
        if (std::abs(glm::dot(axis, camera.forward_world())) < 0.5f)
          continue;  // its edge has a rule of its own
        const glm::vec3 a = glm::cross(axis, glm::normalize(vector()));
        const glm::vec3 b = glm::angleAxis(0.9f, axis) * a;
        const PlacingChange change = dragged(handles, handle, pixel_of(camera, handles.centre_world + a),
                                             pixel_of(camera, handles.centre_world + b), camera, false);
        CHECK(std::abs(change.angle_rad - 0.9f) < 1e-3f);
        ++turns;
      }
      const auto found = handle_at(handles_px(handles, camera), from, 0.6f);
      CHECK(found.has_value());
      CHECK_FALSE(handle_at(handles_px(handles, camera), {-900, 4000}, 9).has_value());
    }
  }
  CHECK(turns > 15);
  CHECK(moves > 100);
}

TEST_CASE("placing: the face of a box follows the pointer, and the face across stays") {
  const Camera camera = look_at({3, -2, -4}, {0.2f, 0, 0}, {0, -1, 0}, 0.9f, 400, 300);
  const Volume box{false, {0.1f, 0.2f, -0.1f}, {0.5f, 0.4f, 0.7f}, glm::angleAxis(0.4f, glm::vec3(0, 1, 0))};
  for (std::size_t handle = 1; handle <= 6; ++handle) {
    CAPTURE(handle);
    const int axis = static_cast<int>(handle - 1) / 2;
    glm::vec3 outward(0);
    outward[axis] = handle % 2 == 1 ? 1.0f : -1.0f;
    outward = box.world_from_box * outward;
    const glm::vec3 face = box.centre_world + box.half[axis] * outward,
                    across = box.centre_world - box.half[axis] * outward;
    for (const float farther : {0.6f, -0.3f}) {
      const glm::vec3 wanted = face + farther * outward;
      const Volume moved = dragged(box, handle, pixel_of(camera, face), pixel_of(camera, wanted), camera);
      CHECK(glm::distance(moved.centre_world + moved.half[axis] * outward, wanted) < 1e-4f);
      CHECK(glm::distance(moved.centre_world - moved.half[axis] * outward, across) < 1e-4f);
    }
  }
}

TEST_CASE("placing: a ring seen from its edge turns with the pointer that runs along it") {
  const PlacingHandles handles{{0, 0, 0}, {}, {{0, 1, 0}}, 80};
  const Camera camera = camera_at_five();
  const auto shown = handles_px(handles, camera);
  REQUIRE(shown.size() == 3);
  const float radius = 80.0f / 100 * 5;
  // The nearest of its points lies before the middle; to the right is about +y's negative sense.
  const PlacingChange change = dragged(handles, shown[0], {100, 100}, {110, 100}, camera, false);
  const glm::vec3 near_point(0, 0, -radius);
  const float moved_px = pixel_of(camera, change.turn * near_point).x - pixel_of(camera, near_point).x;
  CHECK(std::abs(moved_px - 10) < 0.5f);
  CHECK(change.angle_rad < 0);
}

TEST_CASE("placing: a file and an export go where their handles went, whatever stood before") {
  std::mt19937 random(11);
  std::normal_distribution<float> normal;
  const auto vector = [&] { return glm::vec3(normal(random), normal(random), normal(random)); };
  const GaussianCloud cloud = random_cloud(200, 3, 1);
  for (int round = 0; round < 40; ++round) {
    const glm::vec3 axis = glm::normalize(vector());
    const float angle = round % 5 == 0 ? glm::half_pi<float>() : normal(random);
    const PlacingChange change{vector(), glm::angleAxis(angle, axis), angle, std::exp(0.3f * normal(random))};

    SceneSource file;
    file.bounds = {{-1, -2, -3}, {2, 1, 4}};
    file.place = {vector(), 60.0f * vector(), std::exp(normal(random))};
    const Similarity before = similarity_of(file);
    const glm::vec3 up(0.2f, -1, 0.1f);
    PlacingChange as_large = change;
    as_large.scale = 1;
    file.place = changed(file, file.place, as_large, up);
    const Similarity now = similarity_of(file);
    for (int i = 0; i < 5; ++i) {
      const glm::vec3 p = 3.0f * vector();
      CHECK(glm::distance(moved(p, now), after(moved(p, before), as_large, before.move)) < 2e-4f);
    }
    const glm::vec3 foot = foot_world(file, up);
    const float scale = file.place.scale;
    file.place = changed(file, file.place, {.scale = change.scale}, up);  // it stays on its foot
    CHECK(file.place.scale == doctest::Approx(scale * change.scale));
    CHECK(glm::distance(foot_world(file, up), foot) < 2e-4f);

    ExportPlacement placement{static_cast<ExportOrigin>(round % 3), static_cast<ExportUp>(round % 4),
                              50 * normal(random), std::exp(normal(random)), vector()};
    const ExportFrame frame = export_frame(placement, cloud, {}, {0.2f, -1, 0.1f});
    PlacingChange about_up = change;
    about_up.turn = glm::angleAxis(angle, frame.up_file);
    const glm::vec3 pivot = pivot_of(placement, frame);
    const Similarity from = similarity_of(placement, frame);
    const Similarity to = similarity_of(changed(placement, pivot, about_up), frame);
    CHECK(std::abs(changed(placement, pivot, about_up).turn_deg) <= 180);
    for (std::size_t g = 0; g < 5; ++g) {
      const glm::vec3& p = cloud.position[g];
      CHECK(glm::distance(moved(p, to), after(moved(p, from), about_up, pivot)) < 2e-4f * (1 + to.scale));
    }
  }
}

TEST_CASE("placing: in the window a file is moved, turned and scaled by its handles, and undone") {
  const ScratchFolder folder("handles");
  Hands hands;
  Studio& studio = hands.studio();
  add_small(hands, folder);
  PlacingChoice& choice = hands.app.interface_state().placing;
  const std::uint32_t id = studio.scene()->files.back().id;
  REQUIRE(choice.file == id);
  REQUIRE_FALSE(choice.grips.shown.empty());
  const std::size_t objects = studio.document().objects.size();
  const std::size_t gaussians = studio.gaussians_of(studio.document().active);
  const auto drag_by = [&](PlacingGrip grip, std::size_t axis, const glm::vec2& way) {
    const PlacingHandle* handle = find(choice.grips.shown, grip, axis);
    REQUIRE(handle);
    const glm::vec2 at = grip_of(*handle);
    hands.app.drag({at, at + 0.5f * way, at + way});
    REQUIRE(hands.app.settle());
    hands.app.frames(2);
    return studio.scene()->file(id)->place;
  };
  const ScenePlace moved_place = drag_by(PlacingGrip::kMove, 0, {25, 10});
  CHECK(moved_place.move != glm::vec3(0));
  CHECK(moved_place.turn_deg == glm::vec3(0));
  CHECK(choice.place == moved_place);
  const ScenePlace turned_place = drag_by(PlacingGrip::kTurn, 1, {30, 0});
  CHECK(turned_place.turn_deg != glm::vec3(0));
  CHECK(turned_place.move == moved_place.move);
  const ScenePlace scaled_place = drag_by(PlacingGrip::kScale, 0, {20, -20});
  CHECK(scaled_place.scale > 1.1f);
  CHECK(studio.document().objects.size() == objects);  // no press went to the click tool
  CHECK(studio.gaussians_of(studio.document().active) == gaussians);
  studio.apply(Undo{});
  REQUIRE(hands.app.settle());
  CHECK(studio.scene()->file(studio.scene()->files.back().id)->place == turned_place);
}

TEST_CASE("placing: Esc ends a drag with everything where it was") {
  const ScratchFolder folder("handles_esc");
  Hands hands;
  Studio& studio = hands.studio();
  add_small(hands, folder);
  PlacingChoice& choice = hands.app.interface_state().placing;
  const std::size_t step = studio.history().cursor();
  REQUIRE_FALSE(choice.grips.shown.empty());
  const glm::vec2 at = find(choice.grips.shown, PlacingGrip::kMove)->path_px[0];
  hands.app.move(at);
  hands.app.press(PointerButton::kLeft);
  hands.app.frames(1);
  hands.app.move(at + glm::vec2(40, 0));
  hands.app.frames(1);
  CHECK(choice.place.move != glm::vec3(0));
  const ToolId tool = studio.view().tool;
  hands.app.key(key::kEscape);
  CHECK(studio.view().tool == tool);  // Esc was for the drag
  hands.app.release(PointerButton::kLeft);
  REQUIRE(hands.app.settle());
  hands.app.frames(2);
  CHECK(choice.place == ScenePlace{});
  CHECK(studio.scene()->files.back().place == ScenePlace{});
  CHECK(studio.history().cursor() == step);
}

TEST_CASE("placing: the export dialog's picture has handles that change its numbers") {
  const ScratchFolder folder("handles_export");
  HeadlessApp app(1100, 620);
  app.interface_state().hint_wanted = false;
  app.open(kSample);
  REQUIRE(app.settle());
  app.click(app.screen_of(kOnApple));
  REQUIRE(app.settle());
  app.key('E', {.ctrl = true});
  app.frames(3);
  UiState& state = app.interface_state();
  app->interface().make_current();
  ImGui::ClearActiveID();  // the name is being typed
  state.exporting.path = (folder / "object.ply").string();
  state.exporting.placement.origin = ExportOrigin::kFoot;
  state.exporting.placement.up = ExportUp::kPlusZ;
  app.frames(2);
  REQUIRE_FALSE(state.export_preview.grips.shown.empty());
  const auto drag_by = [&](PlacingGrip grip, std::size_t axis, const glm::vec2& way) {
    const PlacingHandle* handle = find(state.export_preview.grips.shown, grip, axis);
    REQUIRE(handle);
    const glm::vec2 at = grip_of(*handle);
    app.drag({at, at + 0.5f * way, at + way});
    app.frames(2);
  };
  drag_by(PlacingGrip::kTurn, 0, {20, 0});
  CHECK(std::abs(state.exporting.placement.turn_deg) > 1);
  CHECK(state.exporting.placement.move == glm::vec3(0));  // it turns on its foot
  drag_by(PlacingGrip::kMoveAlong, 2, {0, -20});
  CHECK(state.exporting.placement.move.z > 0);
  CHECK(std::abs(state.exporting.placement.move.x) < 1e-5f);
  drag_by(PlacingGrip::kScale, 0, {15, -15});
  CHECK(state.exporting.placement.scale > 1.1f);
  const ExportPlacement placement = state.exporting.placement;

  const glm::vec2 at = find(state.export_preview.grips.shown, PlacingGrip::kMove)->path_px[0];
  app.move(at);
  app.press(PointerButton::kLeft);
  app.frames(1);
  app.move(at + glm::vec2(30, 0));
  app.frames(1);
  CHECK(state.exporting.placement != placement);
  app.key(key::kEscape);
  app.release(PointerButton::kLeft);
  app.frames(2);
  CHECK(state.exporting.placement == placement);
  CHECK(app->interface().dialog_open());  // Esc was for the drag

  const Camera before = state.export_preview.camera;
  const glm::vec2 corner = app.window("###export").max - glm::vec2(60, 120);
  app.drag({corner, corner - glm::vec2(40, 0), corner - glm::vec2(80, 20)});
  app.frames(2);
  CHECK_FALSE(same_view(before, state.export_preview.camera));  // beside the handles it turns
  CHECK(state.exporting.placement == placement);

  app.key(key::kEnter);
  REQUIRE(app.settle());
  const Scene written = load_scene(folder / "object.ply");
  const auto keep = app.studio().labels(app.studio().document().active);
  const Similarity to =
      similarity_of(placement, *app.studio().scene()->cloud, keep, app.studio().document().up_world);
  const GaussianCloud expected = placed(*app.studio().scene()->cloud, keep, to);
  REQUIRE(written.cloud.size() == expected.size());
  app.key('E', {.ctrl = true});
  app.frames(3);
  CHECK(state.exporting.placement == placement);  // for the next object
  app.key(key::kEscape);
  app.open(kSample);
  app.frames(3);
  app.press_item("###open_anyway", {"Open"});
  REQUIRE(app.settle());
  app.key('E', {.ctrl = true});
  app.frames(3);
  CHECK(state.exporting.placement == ExportPlacement{});  // another scene
  const Box a = robust_bounds(written.cloud.position), b = robust_bounds(expected.position);
  CHECK(glm::distance(a.min, b.min) + glm::distance(a.max, b.max) < 1e-4f);
}
