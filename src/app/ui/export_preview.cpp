// What is exported as it will stand in the file: its axes and ground, some of its Gaussians, handles.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/picture/capture.h"
#include "app/ui/splat_dots.h"
#include "app/ui/widgets.h"

namespace splatcut {

namespace {

// Between dark objects and light ones, in both themes.
constexpr ImU32 kBackdrop = IM_COL32(104, 107, 112, 255), kFaint = IM_COL32(255, 255, 255, 60),
                kWords = IM_COL32(255, 255, 255, 210);

// Passes over all Gaussians: made once for each choice but the numbers. Of many some are drawn, and some say
// where the middle and the foot are, so that the window does not stand still; what is written goes by all.
void refresh(UiContext& ui) {
  constexpr std::size_t kMost = 60000, kMostForFrame = 200000;
  const ExportChoice& choice = ui.state.exporting;
  ExportPreview& preview = ui.state.export_preview;
  const Studio& studio = ui.studio;
  std::string key = fmt::format("{} {} {} {} {} {}", studio.scene()->serial, studio.history().serial(),
                                static_cast<int>(choice.what), static_cast<int>(choice.placement.origin),
                                static_cast<int>(choice.placement.up), choice.format.name);
  if (preview.key == key) return;
  const GaussianCloud& cloud = *studio.scene()->cloud;
  const Document& document = studio.document();
  const std::vector<std::uint8_t> keep = exported(document, document.active, choice.what, cloud.size());
  preview.sample = permuted(cloud, some_of(keep, kMost));
  preview.picture = {};
  std::vector<std::uint8_t> some(cloud.size(), 0);
  for (const std::uint32_t g : some_of(keep, kMostForFrame)) some[g] = 1;
  if (preview.sample.size() > 0)
    preview.frame = export_frame(choice.placement, cloud, some, document.up_world, choice.format.axes);
  preview.grips.drag.reset();
  preview.key = std::move(key);
}

struct Shown {
  Box box;             // of the sample and, where it is near, of 0, 0, 0
  bool origin = true;  // is in it
};

Shown what_to_show(const ExportPreview& preview, const Similarity& to) {
  constexpr float kFar = 5;  // times the size of what is exported: it would be a dot
  std::vector<glm::vec3> positions;
  for (const glm::vec3& p : preview.sample.position) positions.push_back(moved(p, to));
  Shown shown{robust_bounds(positions), true};
  const float size = std::max(1e-9f, glm::length(shown.box.extent()));
  shown.origin = glm::length(shown.box.centre()) < kFar * size;
  if (!shown.origin) return shown;
  shown.box.min = glm::min(shown.box.min, glm::vec3(0));
  shown.box.max = glm::max(shown.box.max, glm::vec3(0));
  return shown;
}

Camera camera_around(const ExportPreview& preview, const Box& box, const UiRect& area) {
  constexpr float kFov = 0.6f, kMargin = 1.25f;  // rad; room for the handles
  const glm::vec3 up = preview.frame.up_file;
  const glm::vec3 other = std::abs(up.z) < 0.7f ? glm::vec3(0, 0, 1) : glm::vec3(1, 0, 0);
  const glm::vec3 side = glm::normalize(glm::cross(up, other)), ahead = glm::cross(side, up);
  const glm::vec3 from = std::cos(preview.elevation_rad) *
                             (std::cos(preview.azimuth_rad) * ahead + std::sin(preview.azimuth_rad) * side) +
                         std::sin(preview.elevation_rad) * up;
  const float radius = std::max(1e-6f, 0.5f * glm::length(box.extent()));
  const glm::vec2 size = area.size();
  const float narrow = std::min(1.0f, size.x / size.y);
  const float distance = kMargin * radius / (std::sin(0.5f * kFov) * narrow);
  const Camera camera = look_at(box.centre() + distance * from, box.centre(), up, kFov,
                                static_cast<int>(size.x), static_cast<int>(size.y));
  return in_window_points(camera, area.min, 1);
}

// The same camera in the scene, whose Gaussians keep their places and colours: what shows does not depend on
// where the file has them. camera: in points of the window; corner: of the preview.
Camera camera_in_scene(Camera camera, const glm::vec2& corner, const Similarity& to) {
  camera.camera_from_world_translation = camera.camera_from_world(moved(glm::vec3(0), to)) / to.scale;
  camera.camera_from_world_rotation = camera.camera_from_world_rotation * glm::mat3_cast(to.rotation);
  camera.cx_px -= corner.x;
  camera.cy_px -= corner.y;
  return camera;
}

// As splats: as dots, what lies inside of the object and is never seen showed between those of its surface.
void draw_sample(UiContext& ui, const UiRect& area, const Similarity& to) {
  constexpr std::uint64_t kPreviewKey = 900;  // of its texture
  ExportPreview& preview = ui.state.export_preview;
  const Camera camera = camera_in_scene(preview.camera, area.min, to);
  if (preview.picture.size() == 0 || !same_camera(preview.picture_camera, camera)) {
    const DrawLimits limits{.near_plane = preview.sample.near_plane};
    preview.picture = capture(preview.sample, camera, nullptr, limits, {}, true, {});
    preview.picture_camera = camera;
    ++preview.picture_serial;
  }
  ImGui::GetWindowDrawList()->AddImage(
      ui.renderer.texture(kPreviewKey, preview.picture_serial, preview.picture), vec(area.min),
      vec(area.max));
}

void segment(const Camera& camera, const glm::vec3& a, const glm::vec3& b, ImU32 ink, float width) {
  const glm::vec3 from = camera.camera_from_world(a), to = camera.camera_from_world(b);
  if (!(from.z > 0) || !(to.z > 0)) return;
  ImGui::GetWindowDrawList()->AddLine(vec(camera.pixel_from_camera(from)), vec(camera.pixel_from_camera(to)),
                                      ink, width);
}

// Ten lines each way through 0, 0, 0 at right angles to up, and the file's axes.
void draw_ground(const glm::vec3& up, const AxisSigns& axes, const Camera& camera, float reach) {
  constexpr int kLines = 5;
  const glm::vec3 other = std::abs(up.x) < 0.7f ? glm::vec3(1, 0, 0) : glm::vec3(0, 0, 1);
  const glm::vec3 v = glm::normalize(glm::cross(up, other)), u = glm::cross(v, up);
  for (int i = -kLines; i <= kLines; ++i) {
    const float at = reach * static_cast<float>(i) / kLines;
    segment(camera, at * u - reach * v, at * u + reach * v, kFaint, 1);
    segment(camera, at * v - reach * u, at * v + reach * u, kFaint, 1);
  }
  for (int i = 0; i < 3; ++i) {
    glm::vec3 axis(0);
    axis[i] = reach;
    segment(camera, {}, axes.position(axis), kAxisInks[i], 2);
  }
}

void turn_view(ExportPreview* preview, bool held) {
  constexpr float kRadPerPoint = 0.01f, kSteepest = 1.5f;
  if (!held || preview->grips.drag) return;
  const ImVec2 way = ImGui::GetIO().MouseDelta;
  preview->azimuth_rad -= kRadPerPoint * way.x;
  preview->elevation_rad = std::clamp(preview->elevation_rad + kRadPerPoint * way.y, -kSteepest, kSteepest);
}

void drag_handles(UiContext& ui, const glm::vec2& size_points, bool hovered) {
  ExportPreview& preview = ui.state.export_preview;
  ExportPlacement& placement = ui.state.exporting.placement;
  const float reach = std::min(70.0f, 0.3f * size_points.x);
  const AxisSigns& axes = ui.state.exporting.format.axes;  // arrows point where the file's numbers grow
  const PlacingHandles shown{
      .centre_world = pivot_of(placement, preview.frame),
      .arrow_axes = {axes.position({1, 0, 0}), axes.position({0, 1, 0}), axes.position({0, 0, 1})},
      .turn_axes = {preview.frame.up_file},
      .reach_px = reach,
      .turned_deg = {placement.turn_deg},
      .scaled = placement.scale};
  const GripsMoved hand = grips(&preview.grips, shown, preview.camera, hovered, ui.theme);
  if (hand.began) preview.before = placement;
  if (hand.change) placement = changed(preview.before, pivot_of(preview.before, preview.frame), *hand.change);
}

}  // namespace

void export_preview(UiContext& ui, const glm::vec2& size_points) {
  refresh(ui);
  ExportPreview& preview = ui.state.export_preview;
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const UiRect area = {{at.x, at.y}, glm::vec2(at.x, at.y) + size_points};
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddRectFilled(vec(area.min), vec(area.max), kBackdrop, 6);
  ImGui::PushAllowKeyboardFocus(false);  // a picture is for the pointer: Tab passes it over
  ImGui::InvisibleButton("##preview", {size_points.x, size_points.y});
  ImGui::PopAllowKeyboardFocus();
  const bool hovered = ImGui::IsItemHovered(), held = ImGui::IsItemActive();
  if (preview.sample.size() == 0 || !(ui.state.exporting.placement.scale > 0))
    return preview.grips.shown.clear();
  const Similarity to = similarity_of(ui.state.exporting.placement, preview.frame);
  const Shown shown = what_to_show(preview, to);
  turn_view(&preview, held);
  if (!preview.grips.drag) preview.camera = camera_around(preview, shown.box, area);
  ImGui::PushClipRect(at, vec(area.max), true);
  if (shown.origin)
    draw_ground(preview.frame.up_file, ui.state.exporting.format.axes, preview.camera,
                0.75f * glm::length(shown.box.extent()));
  draw_sample(ui, area, to);
  drag_handles(ui, size_points, hovered);
  const auto write = [&](float y, const char* words) {  // where there is room
    if (ImGui::CalcTextSize(words).x + 16 <= size_points.x) list.AddText({at.x + 8, y}, kWords, words);
  };
  write(area.max.y - 22,
        shown.origin ? "In the file: x red, y green, z blue" : "0, 0, 0 of the file is far away");
  if (ui.state.exporting.placement.up != ExportUp::kScene)
    write(at.y + 6, "Does it lean? Set what is up under View first");
  ImGui::PopClipRect();
}

}  // namespace splatcut
