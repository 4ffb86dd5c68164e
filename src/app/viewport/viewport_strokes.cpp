// Drawn over the picture: strokes, other meanings of a click, the shape that a tool is drawing.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "app/picture/badge_place.h"
#include "app/ui/widgets.h"
#include "app/viewport/on_screen.h"
#include "app/viewport/viewport_pane.h"

namespace splatcut {

namespace {

const ImU32 kObjectInk = IM_COL32(90, 220, 120, 255), kRestInk = IM_COL32(245, 95, 90, 255);

// Corners cut twice (Chaikin 1974): the hand's path has no corners. The ends stay.
std::vector<ImVec2> rounded(std::vector<ImVec2> path) {
  for (int pass = 0; pass < 2 && path.size() > 2; ++pass) {
    std::vector<ImVec2> cut{path.front()};
    for (std::size_t i = 0; i + 1 < path.size(); ++i) {
      const ImVec2 &a = path[i], &b = path[i + 1];
      if (i > 0) cut.push_back({0.75f * a.x + 0.25f * b.x, 0.75f * a.y + 0.25f * b.y});
      if (i + 2 < path.size()) cut.push_back({0.25f * a.x + 0.75f * b.x, 0.25f * a.y + 0.75f * b.y});
    }
    cut.push_back(path.back());
    path = std::move(cut);
  }
  return path;
}

// Half a disc beyond the end of a path that comes from `before`: a whole one would show twice where the path
// is see-through.
void end_cap(ImDrawList& list, const ImVec2& before, const ImVec2& end, float radius, ImU32 colour) {
  constexpr float kQuarter = 1.5707963f;
  const float angle = std::atan2(end.y - before.y, end.x - before.x);
  list.PathArcTo(end, radius, angle - kQuarter, angle + kQuarter);
  list.PathFillConvex(colour);
}

void smooth_path(ImDrawList& list, const std::vector<ImVec2>& points, ImU32 colour, float width) {
  std::vector<ImVec2> path = rounded(points);
  const auto same = [](const ImVec2& a, const ImVec2& b) { return a.x == b.x && a.y == b.y; };
  path.erase(std::unique(path.begin(), path.end(), same), path.end());
  if (path.size() == 1) return list.AddCircleFilled(path[0], 0.5f * width, colour);
  for (const ImVec2& p : path) list.PathLineTo(p);
  list.PathStroke(colour, 0, width);
  end_cap(list, path[1], path.front(), 0.5f * width, colour);
  end_cap(list, path[path.size() - 2], path.back(), 0.5f * width, colour);
}

std::vector<ImVec2> placed(const std::vector<glm::vec2>& points_px, const OnScreen& place) {
  std::vector<ImVec2> out;
  for (const glm::vec2& p : points_px) out.push_back(place(p));
  return out;
}

// Places pixels of a stroke's camera on the screen; both cameras stand alike.
OnScreen placement_of(const Camera& camera, const Camera& now, const OnScreen& place) {
  const float factor = now.fy_px / camera.fy_px;
  const glm::vec2 shift = glm::vec2(now.cx_px, now.cy_px) - factor * glm::vec2(camera.cx_px, camera.cy_px);
  return {place.origin + shift * place.points_per_pixel, factor * place.points_per_pixel};
}

ImU32 faded(ImU32 ink, float opacity) {
  const auto alpha = static_cast<ImU32>(opacity * static_cast<float>(ink >> IM_COL32_A_SHIFT));
  return (ink & ~IM_COL32_A_MASK) | alpha << IM_COL32_A_SHIFT;
}

void draw_click(ImDrawList& list, const ImVec2& at, bool object, float opacity) {
  const ImU32 sign = faded(IM_COL32(10, 20, 10, 255), opacity);
  list.AddCircleFilled(at, 6.5f, faded(IM_COL32(0, 0, 0, 150), opacity));
  list.AddCircleFilled(at, 5, faded(object ? kObjectInk : kRestInk, opacity));
  list.AddLine({at.x - 2.5f, at.y}, {at.x + 2.5f, at.y}, sign, 1.5f);
  if (object) list.AddLine({at.x, at.y - 2.5f}, {at.x, at.y + 2.5f}, sign, 1.5f);
}

// The click under the pointer, which can be taken away.
void draw_pointed_click(ImDrawList& list, const ImVec2& at, bool object) {
  constexpr float kArm = 3.2f;
  const ImU32 sign = IM_COL32(10, 20, 10, 255);
  list.AddCircleFilled(at, 10, IM_COL32(255, 255, 255, 235));
  list.AddCircleFilled(at, 8, object ? kObjectInk : kRestInk);
  list.AddLine({at.x - kArm, at.y - kArm}, {at.x + kArm, at.y + kArm}, sign, 2);
  list.AddLine({at.x - kArm, at.y + kArm}, {at.x + kArm, at.y - kArm}, sign, 2);
}

// An isolated object is not painted over, unless it is being repaired.
bool strokes_wanted(const ViewState& view) {
  return tool_of(view.tool).strokes || (view.display == DisplayMode::kWhole && !view.heat);
}

// Beside the bar of meanings, and the message that is shown.
std::optional<ImVec2> label_place(const UiContext& ui, const std::vector<ImVec2>& border,
                                  const std::vector<ImVec2>& apart, const UiRect& area, const UiRect& bar) {
  const auto points = [](const std::vector<ImVec2>& from) {
    std::vector<glm::vec2> out;
    for (const ImVec2& p : from) out.emplace_back(p.x, p.y);
    return out;
  };
  const auto place =
      badge_place(points(border), points(apart),
                  {area.min, area.max, {{{bar.min, bar.max}, {ui.state.message.min, ui.state.message.max}}}});
  return place ? std::optional(ImVec2(place->x, place->y)) : std::nullopt;
}

void draw_badge(const UiContext& ui, ImDrawList& list, const ImVec2& at, const std::string& text,
                float opacity = 1) {
  const ImVec2 size = ImGui::CalcTextSize(text.c_str());
  ui.state.badges.emplace_back(at.x, at.y);
  list.AddCircleFilled(at, 11, packed(ui.theme.colour.panel, 0.92f * opacity));
  list.AddCircle(at, 11, IM_COL32(255, 255, 255, static_cast<int>(230 * opacity)), 0, 1.5f);
  list.AddText({at.x - 0.5f * size.x, at.y - 0.5f * size.y}, packed(ui.theme.colour.text, opacity),
               text.c_str());
}

// Dashes along a closed path, of equal length whatever its corners.
void dashed(ImDrawList& list, const std::vector<ImVec2>& path, ImU32 ink, float width) {
  constexpr float kDash = 6, kGap = 5;
  float along = 0;  // points since the last dash began
  for (std::size_t i = 0; i < path.size(); ++i) {
    const ImVec2 &a = path[i], &b = path[(i + 1) % path.size()];
    const float length = std::hypot(b.x - a.x, b.y - a.y);
    const auto at = [&](float s) {
      return ImVec2{a.x + (b.x - a.x) * s / length, a.y + (b.y - a.y) * s / length};
    };
    for (float s = 0; s < length;) {
      const bool draws = along < kDash;
      const float until = std::min(length, s + (draws ? kDash : kDash + kGap) - along);
      if (draws) list.AddLine(at(s), at(until), ink, width);
      along += until - s;
      if (along >= kDash + kGap - 1e-3f) along = 0;
      s = std::max(until, s + 1e-3f);
    }
  }
}

}  // namespace

// Scribbles and boxes are kept per view: they show where the camera stands as it did when they were drawn;
// clicks wherever they are in sight. They fade where the object is looked at alone, which needs no frame.
void draw_strokes(const UiContext& ui, const UiRect& area) {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const OnScreen place = on_screen(ui, area);
  const ObjectItem* object = ui.studio.document().active_object();
  if (!object || !strokes_wanted(ui.studio.view())) return;
  const Camera now = ui.studio.viewport().pane_camera();
  const float opacity = ui.studio.view().display == DisplayMode::kIsolate ? 0.35f : 1;
  for (const StrokedView& view : object->views) {
    if (!same_pose(view.camera, now)) continue;
    const OnScreen there = placement_of(view.camera, now, place);
    for (const Stroke& stroke : view.strokes) {
      if (stroke.is_click() || (stroke.is_box() && ui.studio.view().display != DisplayMode::kWhole)) continue;
      const bool is_object = stroke.label == SeedLabel::kObject;
      const ImU32 ink = faded(is_object ? kObjectInk : kRestInk, opacity);
      if (stroke.is_box()) {
        list.AddRect(there(stroke.points_px[0]), there(stroke.points_px[1]), ink, 0, 0, 2);
        continue;
      }
      smooth_path(list, placed(stroke.points_px, there), faded(ink, 0.56f),
                  std::max(2.0f, 2 * stroke.radius_px * there.points_per_pixel));
    }
  }
  constexpr float kFromElsewhere = 0.6f;
  for (const StrokeMark& mark : ui.studio.viewport().marks())
    draw_click(list, place(mark.at_px), mark.object, mark.from_here ? opacity : kFromElsewhere * opacity);
  if (const StrokeMark* mark = ui.studio.clicks().pointed_mark(); mark && pointed_at(ui, area)) {
    draw_pointed_click(list, place(mark->at_px), mark->object);
    tooltip_within(area, std::string(mark->object ? "Right" : "Left") + " click: takes this click away" +
                             (ui.studio.clicks().wheel_takes_sizes() ? ". Wheel: takes more or less" : ""));
  }
}

// What else the click can mean, as thin outlines with their keys, where the camera stands as it was clicked.
void draw_offer(const UiContext& ui, const UiRect& area, const UiRect& bar) {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const OnScreen place = on_screen(ui, area);
  const ClickMeanings* offer = ui.studio.clicks().offer();
  const Camera now = ui.studio.viewport().pane_camera();
  if (!offer || !same_pose(offer->camera, now) || ui.studio.clicks().sizes()) return;
  const OnScreen there = placement_of(offer->camera, now, place);
  const int taken = ui.studio.document().active_object()->choice;
  std::vector<ImVec2> apart;
  const std::vector<StrokedView>& views = ui.studio.document().active_object()->views;
  for (const StrokedView& view : views)
    for (const Stroke& stroke : view.strokes) apart.push_back(there(stroke.points_px.front()));
  for (int i = 0; i < std::ssize(offer->outlines); ++i) {
    if (i == taken) continue;
    std::optional<ImVec2> label;
    for (const std::vector<glm::vec2>& border : offer->outlines[static_cast<std::size_t>(i)]) {
      const std::vector<ImVec2> path = rounded(placed(border, there));
      list.AddPolyline(path.data(), static_cast<int>(path.size()), IM_COL32(0, 0, 0, 110), ImDrawFlags_Closed,
                       3);
      list.AddPolyline(path.data(), static_cast<int>(path.size()), IM_COL32(255, 255, 255, 200),
                       ImDrawFlags_Closed, 1.3f);
      if (!label) label = label_place(ui, path, apart, area, bar);
    }
    if (!label) continue;
    apart.push_back(*label);
    draw_badge(ui, list, *label, fmt::format("{}", i + 1));
  }
}

// The size that the pointer is at in the panel. Else the one that is computed, and the next larger and
// smaller one, dashed, with what the wheel says to them: + upwards.
void draw_sizes(const UiContext& ui, const UiRect& area, const UiRect& bar) {
  const Clicks& clicks = ui.studio.clicks();
  const std::optional<std::size_t> pointed = ui.state.size_pointed;
  const StrokeSizes* sizes = pointed ? clicks.known_sizes() : clicks.sizes();
  const Camera now = ui.studio.viewport().pane_camera();
  if (!sizes || !same_pose(sizes->camera, now)) return;
  if (pointed && *pointed >= sizes->count()) return;  // the panel was drawn for another object
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const OnScreen there = placement_of(sizes->camera, now, on_screen(ui, area));
  const float opacity = pointed ? 1 : clicks.sizes_opacity();
  std::vector<ImVec2> apart;
  for (const StrokedView& view : ui.studio.document().active_object()->views)
    for (const Stroke& stroke : view.strokes) apart.push_back(there(stroke.points_px.front()));
  const ImU32 dark = IM_COL32(0, 0, 0, static_cast<int>(140 * opacity)),
              light = IM_COL32(255, 255, 255, static_cast<int>(215 * opacity));
  const auto draw = [&](std::size_t size, const char* sign) {
    std::optional<ImVec2> label;
    for (const std::vector<glm::vec2>& border : sizes->outlines[size]) {
      const std::vector<ImVec2> path = rounded(placed(border, there));
      if (sign) {
        dashed(list, path, dark, 3);
        dashed(list, path, light, 1.3f);
        if (!label) label = label_place(ui, path, apart, area, bar);
        continue;
      }
      list.AddPolyline(path.data(), static_cast<int>(path.size()), dark, ImDrawFlags_Closed, 4);
      list.AddPolyline(path.data(), static_cast<int>(path.size()), light, ImDrawFlags_Closed, 2);
    }
    if (!label) return;
    apart.push_back(*label);
    draw_badge(ui, list, *label, sign, opacity);
  };
  const std::size_t size = pointed.value_or(clicks.size_wanted());
  if (pointed || size != sizes->size) draw(size, nullptr);
  if (pointed) return;
  if (size + 1 < sizes->count()) draw(size + 1, "+");
  if (size > 0) draw(size - 1, "-");
}

void draw_tool_shape(const UiContext& ui, const UiRect& area) {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const OnScreen place = on_screen(ui, area);
  const ToolOverlay overlay = ui.studio.overlay();
  const ImU32 ink = overlay.cuts                                 ? (overlay.rest ? kRestInk : kObjectInk)
                    : overlay.operation == SetOperation::kRemove ? kRestInk
                                                                 : packed(ui.theme.colour.accent);
  const ImU32 wash = (ink & 0x00ffffffu) | 0x30000000u;
  const std::vector<ImVec2> points = placed(overlay.points_px, place);
  const float radius = overlay.radius_px * place.points_per_pixel;
  switch (overlay.shape) {
    case ToolOverlay::Shape::kPath:
      smooth_path(list, points, (ink & 0x00ffffffu) | 0x90000000u, 2 * radius);
      break;
    case ToolOverlay::Shape::kRectangle:
      if (points.size() < 2) break;
      list.AddRectFilled(points[0], points[1], wash);
      list.AddRect(points[0], points[1], ink, 0, 0, 1.5f);
      break;
    case ToolOverlay::Shape::kPolygon:
      for (const ImVec2& p : points) list.PathLineTo(p);
      list.PathStroke(ink, ImDrawFlags_Closed, 1.8f);
      for (const ImVec2& p : points)
        if (overlay.dots) list.AddCircleFilled(p, 3.5f, ink);
      break;
    case ToolOverlay::Shape::kCircle:
      if (radius > 0) list.AddCircleFilled(points[0], radius, wash);
      if (radius > 0) list.AddCircle(points[0], radius, ink, 0, 1.8f);
      for (const auto& [from, to] : overlay.edges_px) list.AddLine(place(from), place(to), ink, 1.8f);
      for (const glm::vec2& handle : overlay.handles_px) {
        list.AddCircleFilled(place(handle), 5, IM_COL32(255, 255, 255, 235));
        list.AddCircle(place(handle), 5, ink, 0, 2);
      }
      break;
    case ToolOverlay::Shape::kPoints:
    case ToolOverlay::Shape::kNone:
      break;
  }
}

// The brush as a ring under the pointer.
void draw_brush_ring(const UiContext& ui, const UiRect& area) {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const std::optional<ImVec2> at = pointed_at(ui, area);
  if (!at || tool_of(ui.studio.view().tool).brush == 0) return;
  const float radius = std::max(2.0f, ui.studio.overlay().radius_px / ui.theme.pixels_per_point);
  list.AddCircle(*at, radius + 1, IM_COL32(0, 0, 0, 120), 0, 1);
  list.AddCircle(*at, radius, IM_COL32(255, 255, 255, 220), 0, 1.3f);
}

}  // namespace splatcut
