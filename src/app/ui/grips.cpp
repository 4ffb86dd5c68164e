#include "app/ui/grips.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/document/words.h"
#include "app/tools/actions.h"
#include "app/ui/theme.h"

namespace splatcut {

namespace {

constexpr float kReach = 9;  // points: as near is on it
constexpr ImU32 kShade = IM_COL32(0, 0, 0, 130), kWhite = IM_COL32(255, 255, 255, 240);

// An axis of the coordinates has its colour; another one, as the scene's up, has none.
ImU32 ink_of(const glm::vec3& axis, const Theme& theme) {
  for (int i = 0; i < 3; ++i)
    if (std::abs(axis[i]) > 0.999f) return kAxisInks[i];
  return packed(theme.colour.accent);
}

const char* name_of(const glm::vec3& axis) {
  constexpr const char* kNames[] = {"x", "y", "z"};
  for (int i = 0; i < 3; ++i)
    if (std::abs(axis[i]) > 0.999f) return kNames[i];
  return "up";
}

void arrow(ImDrawList& list, const ImVec2& from, const ImVec2& tip, ImU32 ink, float width) {
  constexpr float kHead = 11, kHalf = 5;
  const float length = std::hypot(tip.x - from.x, tip.y - from.y);
  if (length < 1) return;
  const ImVec2 along = {(tip.x - from.x) / length, (tip.y - from.y) / length};
  const ImVec2 neck = {tip.x - kHead * along.x, tip.y - kHead * along.y};
  list.AddLine(from, neck, kShade, width + 2);
  list.AddLine(from, neck, ink, width);
  list.AddTriangleFilled(tip, {neck.x - kHalf * along.y, neck.y + kHalf * along.x},
                         {neck.x + kHalf * along.y, neck.y - kHalf * along.x}, ink);
}

void draw(ImDrawList& list, const PlacingHandles& handles, const PlacingHandle& handle, bool lit,
          const Theme& theme) {
  const float width = lit ? 4.0f : 2.5f;
  const ImVec2 at = vec(handle.path_px.front());
  const ImU32 accent = packed(theme.colour.accent);
  switch (handle.grip) {
    case PlacingGrip::kTurn: {
      const ImU32 ink = lit ? kWhite : ink_of(handles.turn_axes[handle.axis], theme);
      std::vector<ImVec2> path;
      for (const glm::vec2& p : handle.path_px) path.push_back(vec(p));
      list.AddPolyline(path.data(), static_cast<int>(path.size()), kShade, 0, width + 2);
      list.AddPolyline(path.data(), static_cast<int>(path.size()), ink, 0, width);
      break;
    }
    case PlacingGrip::kMoveAlong:
      arrow(list, at, vec(handle.path_px.back()),
            lit ? kWhite : ink_of(handles.arrow_axes[handle.axis], theme), width);
      break;
    case PlacingGrip::kScale:
      list.AddRectFilled({at.x - 6, at.y - 6}, {at.x + 6, at.y + 6}, lit ? kWhite : accent, 2);
      list.AddRect({at.x - 6, at.y - 6}, {at.x + 6, at.y + 6}, lit ? accent : kWhite, 2, 0, 1.5f);
      break;
    case PlacingGrip::kMove:
      list.AddCircleFilled(at, 7, lit ? kWhite : accent);
      list.AddCircle(at, 7, lit ? accent : kWhite, 0, 1.5f);
      break;
  }
}

std::string words_of(const PlacingHandles& handles, const PlacingHandle& handle) {
  switch (handle.grip) {
    case PlacingGrip::kTurn:
      return fmt::format("Drag: turn about {} (Shift: by 15 degrees)",
                         name_of(handles.turn_axes[handle.axis]));
    case PlacingGrip::kMoveAlong:
      return fmt::format("Drag: move along {}", name_of(handles.arrow_axes[handle.axis]));
    case PlacingGrip::kScale:
      return "Drag: scale (Shift: by tenths)";
    case PlacingGrip::kMove:
      break;
  }
  return "Drag: move";
}

std::string amount_of(const PlacingHandle& handle, const PlacingChange& change) {
  switch (handle.grip) {
    case PlacingGrip::kTurn:
      return fmt::format("{:.1f} degrees", glm::degrees(change.angle_rad));
    case PlacingGrip::kScale:
      return fmt::format("{:.3g} times", change.scale);
    case PlacingGrip::kMoveAlong:
    case PlacingGrip::kMove:
      break;
  }
  return length_text(glm::length(change.move_world)) + " units";
}

void say(const std::string& text, const glm::vec2& pointer, const Theme& theme) {
  ImDrawList& list = *ImGui::GetForegroundDrawList();
  const ImVec2 size = ImGui::CalcTextSize(text.c_str());
  const ImVec2 at = {std::min(pointer.x + 18, ImGui::GetIO().DisplaySize.x - size.x - 12), pointer.y + 16};
  list.AddRectFilled({at.x - 6, at.y - 3}, {at.x + size.x + 6, at.y + size.y + 3},
                     packed(theme.colour.panel, 0.92f), 5);
  list.AddText(at, packed(theme.colour.text), text.c_str());
}

}  // namespace

bool Grips::at(const glm::vec2& point) const {
  return handle_at(shown, point, kReach).has_value();
}

Camera in_window_points(const Camera& camera, const glm::vec2& origin, float pixels_per_point) {
  Camera out = camera;
  out.fx_px /= pixels_per_point;
  out.fy_px /= pixels_per_point;
  out.cx_px = out.cx_px / pixels_per_point + origin.x;
  out.cy_px = out.cy_px / pixels_per_point + origin.y;
  return out;
}

GripsMoved grips(Grips* grips, const PlacingHandles& handles, const Camera& camera, bool free,
                 const Theme& theme) {
  GripsMoved moved;
  const ImGuiIO& io = ImGui::GetIO();
  const glm::vec2 pointer(io.MousePos.x, io.MousePos.y);
  grips->shown = handles_px(handles, camera);
  const PlacingHandle* over = nullptr;
  if (free)
    if (const auto i = handle_at(grips->shown, pointer, kReach)) over = &grips->shown[*i];
  if (!grips->drag && over && ImGui::IsMouseClicked(0)) {
    grips->drag = Grips::Drag{handles, *over, camera, pointer};
    moved.began = true;
  }
  const auto lit = [&](const PlacingHandle& handle) {
    if (grips->drag)
      return handle.grip == grips->drag->handle.grip && handle.axis == grips->drag->handle.axis;
    return &handle == over;
  };
  for (const PlacingHandle& handle : grips->shown)
    draw(*ImGui::GetWindowDrawList(), handles, handle, lit(handle), theme);
  if (!grips->drag) {
    if (over) say(words_of(handles, *over), pointer, theme);
    return moved;
  }
  const Grips::Drag& drag = *grips->drag;
  if (ImGui::IsKeyPressed(key::kEscape, false)) {
    moved.change = PlacingChange{};
    grips->drag.reset();
    return moved;
  }
  moved.change = dragged(drag.handles, drag.handle, drag.from, pointer, drag.camera, io.KeyShift);
  say(amount_of(drag.handle, *moved.change), pointer, theme);
  moved.done = !io.MouseDown[0];
  if (moved.done) grips->drag.reset();
  return moved;
}

}  // namespace splatcut
