// The picture of the scene with strokes, tool shapes, messages and the first-run hint over it.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "app/ui/panels.h"
#include "app/ui/widgets.h"

namespace splatcut {

namespace {

constexpr std::uint64_t kPaneKey = 1;  // of the panes' textures
constexpr double kMessageSeconds = 7;
const ImU32 kObjectInk = IM_COL32(90, 220, 120, 255), kRestInk = IM_COL32(245, 95, 90, 255);

ImVec2 vec(const glm::vec2& v) {
  return {v.x, v.y};
}

// Viewport pixels to points on the screen.
struct Placement {
  glm::vec2 origin;
  float points_per_pixel;
  ImVec2 operator()(const glm::vec2& pixel) const { return vec(origin + pixel * points_per_pixel); }
};

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

std::vector<ImVec2> placed(const std::vector<glm::vec2>& points_px, const Placement& place) {
  std::vector<ImVec2> out;
  for (const glm::vec2& p : points_px) out.push_back(place(p));
  return out;
}

// Of another camera's pixels, where it stands as the one on the screen does.
Placement placement_of(const Camera& camera, const Camera& now, const Placement& place) {
  const float factor = now.fy_px / camera.fy_px;
  const glm::vec2 shift = glm::vec2(now.cx_px, now.cy_px) - factor * glm::vec2(camera.cx_px, camera.cy_px);
  return {place.origin + shift * place.points_per_pixel, factor * place.points_per_pixel};
}

void draw_click(ImDrawList& list, const ImVec2& at, bool object) {
  list.AddCircleFilled(at, 6.5f, IM_COL32(0, 0, 0, 150));
  list.AddCircleFilled(at, 5, object ? kObjectInk : kRestInk);
  list.AddLine({at.x - 2.5f, at.y}, {at.x + 2.5f, at.y}, IM_COL32(10, 20, 10, 255), 1.5f);
  if (object) list.AddLine({at.x, at.y - 2.5f}, {at.x, at.y + 2.5f}, IM_COL32(10, 20, 10, 255), 1.5f);
}

// What is looked at alone should not be painted over, unless it is being repaired.
bool strokes_wanted(const ViewState& view) {
  return is_stroke_tool(view.tool) || (view.display == DisplayMode::kWhole && !view.heat);
}

constexpr float kThinPx = 2;

// As box_strokes() makes them: rest, closed, four corners.
bool is_frame(const Stroke& stroke) {
  const std::vector<glm::vec2>& p = stroke.points_px;
  return stroke.label == SeedLabel::kRest && p.size() == 5 && p[0] == p[4] && p[0].y == p[1].y &&
         p[1].x == p[2].x && p[2].y == p[3].y && p[3].x == p[0].x;
}

// Strokes are kept per view: they show where the camera stands as it did when they were drawn.
void draw_strokes(const UiContext& ui, ImDrawList& list, const Placement& place) {
  const ObjectItem* object = ui.studio.document().active_object();
  if (!object || !strokes_wanted(ui.studio.view())) return;
  const Camera now = ui.studio.viewport_camera();
  for (const StrokedView& view : object->views) {
    if (!same_pose(view.camera, now)) continue;
    const Placement there = placement_of(view.camera, now, place);
    for (const Stroke& stroke : view.strokes) {
      const bool is_object = stroke.label == SeedLabel::kObject;
      if (stroke.points_px.size() == 1) {
        draw_click(list, there(stroke.points_px.front()), is_object);
        continue;
      }
      const ImU32 ink = is_object ? kObjectInk : kRestInk;
      if (is_frame(stroke)) {  // of a box: its border says it all
        if (stroke.radius_px <= kThinPx)
          list.AddRect(there(stroke.points_px[0]), there(stroke.points_px[2]), ink, 0, 0, 2);
        continue;
      }
      smooth_path(list, placed(stroke.points_px, there), (ink & 0x00ffffffu) | 0x90000000u,
                  std::max(2.0f, 2 * stroke.radius_px * there.points_per_pixel));
    }
  }
}

// A point of the border that is far from everything in `apart`; nothing of it may be in `area`.
std::optional<ImVec2> label_place(const std::vector<ImVec2>& border, const std::vector<ImVec2>& apart,
                                  const UiRect& area) {
  constexpr float kMargin = 16, kFarEnough = 60;
  std::optional<ImVec2> best;
  float farthest = -1;
  for (const ImVec2& p : border) {
    if (!area.contains({p.x - kMargin, p.y - kMargin}) || !area.contains({p.x + kMargin, p.y + kMargin}))
      continue;
    float distance = kFarEnough;
    for (const ImVec2& q : apart) distance = std::min(distance, std::hypot(p.x - q.x, p.y - q.y));
    if (distance <= farthest) continue;
    farthest = distance;
    best = p;
  }
  return best;
}

void draw_badge(const UiContext& ui, ImDrawList& list, const ImVec2& at, int number) {
  const std::string text = fmt::format("{}", number);
  const ImVec2 size = ImGui::CalcTextSize(text.c_str());
  list.AddCircleFilled(at, 11, packed(ui.theme.colour.panel, 0.92f));
  list.AddCircle(at, 11, IM_COL32(255, 255, 255, 230), 0, 1.5f);
  list.AddText({at.x - 0.5f * size.x, at.y - 0.5f * size.y}, packed(ui.theme.colour.text), text.c_str());
}

// What else the click can mean, as thin outlines with their keys, where the camera stands as it was clicked.
void draw_offer(const UiContext& ui, ImDrawList& list, const Placement& place, const UiRect& area) {
  const ClickMeanings* offer = ui.studio.offer();
  const Camera now = ui.studio.viewport_camera();
  if (!offer || !same_pose(offer->camera, now)) return;
  const Placement there = placement_of(offer->camera, now, place);
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
      if (!label) label = label_place(path, apart, area);
    }
    if (!label) continue;
    apart.push_back(*label);
    draw_badge(ui, list, *label, i + 1);
  }
}

void draw_tool_shape(const UiContext& ui, ImDrawList& list, const Placement& place) {
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
        if (ui.studio.view().tool == Tool::kPolygon) list.AddCircleFilled(p, 3.5f, ink);
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
void draw_brush_ring(const UiContext& ui, ImDrawList& list, const Placement& place, const UiRect& area) {
  const Tool tool = ui.studio.view().tool;
  if (tool != Tool::kScribble && tool != Tool::kBrush) return;
  const ImVec2 mouse = ImGui::GetIO().MousePos;
  if (!area.contains({mouse.x, mouse.y}) || ImGui::IsAnyItemHovered() ||
      ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopupId | ImGuiPopupFlags_AnyPopupLevel))
    return;
  const float radius = std::max(2.0f, ui.studio.overlay().radius_px * place.points_per_pixel);
  list.AddCircle(mouse, radius + 1, IM_COL32(0, 0, 0, 120), 0, 1);
  list.AddCircle(mouse, radius, IM_COL32(255, 255, 255, 220), 0, 1.3f);
}

UiRect banner(const UiContext& ui, const ImVec2& at, const char* symbol, const ImVec4& colour,
              const std::string& text, float wrap) {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const ImVec2 size = ImGui::CalcTextSize(text.c_str(), nullptr, false, wrap);
  const ImVec2 end = {at.x + size.x + 46, at.y + size.y + 16};
  list.AddRectFilled(at, end, packed(ui.theme.colour.panel, 0.94f), 7);
  list.AddRect(at, end, packed(ui.theme.colour.line), 7);
  list.AddText({at.x + 12, at.y + 8}, packed(colour), symbol);
  list.AddText(nullptr, 0, {at.x + 34, at.y + 8}, packed(ui.theme.colour.text), text.c_str(), nullptr, wrap);
  return {{at.x, at.y}, {end.x, end.y}};
}

void draw_message(const UiContext& ui, const UiRect& area, float bottom) {
  if (ui.studio.messages().empty()) return;
  const Message& message = ui.studio.messages().back();
  if (ui.studio.clock_s() - message.time_s > kMessageSeconds) return;
  const Palette& p = ui.theme.colour;
  const bool warns = message.kind == Message::Kind::kRefused, fails = message.kind == Message::Kind::kError;
  const float wrap = std::min(760.0f, area.size().x - 90);
  const float height = ImGui::CalcTextSize(message.text.c_str(), nullptr, false, wrap).y + 16;
  banner(ui, {area.min.x + 14, area.max.y - bottom - height - 14},
         warns || fails                         ? icon::kWarning
         : message.kind == Message::Kind::kDone ? icon::kCheck
                                                : icon::kInfo,
         fails                                  ? p.bad
         : warns                                ? p.warn
         : message.kind == Message::Kind::kDone ? p.good
                                                : p.accent,
         message.text, wrap);
}

// Small labels of two panes.
void pane_label(const UiContext& ui, const ImVec2& at, const char* text) {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const ImVec2 size = ImGui::CalcTextSize(text);
  list.AddRectFilled(at, {at.x + size.x + 16, at.y + size.y + 8}, packed(ui.theme.colour.panel, 0.85f), 5);
  list.AddText({at.x + 8, at.y + 4}, packed(ui.theme.colour.text), text);
}

const char* mode_label(const Studio& studio) {
  switch (studio.view().display) {
    case DisplayMode::kIsolate:
      return "Only the object  (I: back)";
    case DisplayMode::kHide:
      return "Without the object  (H: back)";
    default:
      return studio.view().heat ? "Likelihood: blue rest, red object  (M: back)" : nullptr;
  }
}

// Which keys choose, as buttons, so that the mouse can.
std::optional<UiRect> offer_line(UiContext& ui, const ImVec2& at) {
  const ClickMeanings* offer = ui.studio.offer();
  if (!offer) return {};
  constexpr float kPad = 8, kButton = 26;
  const std::string text = "other meanings of this click  (Esc: keep this one)";
  const int taken = ui.studio.document().active_object()->choice;
  const auto count = static_cast<float>(offer->outlines.size());
  const ImVec2 words = ImGui::CalcTextSize(text.c_str());
  const ImVec2 size = {2 * kPad + count * (kButton + 4) + 6 + words.x, kButton + 2 * kPad};
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddRectFilled(at, {at.x + size.x, at.y + size.y}, packed(ui.theme.colour.panel, 0.94f), 7);
  list.AddRect(at, {at.x + size.x, at.y + size.y}, packed(ui.theme.colour.line), 7);
  ImGui::SetCursorScreenPos({at.x + kPad, at.y + kPad});
  for (int i = 0; i < std::ssize(offer->outlines); ++i) {
    if (i > 0) ImGui::SameLine(0, 4);
    if (button(ui, fmt::format("{}##meaning", i + 1).c_str(), fmt::format("Key {}", i + 1), {}, i == taken,
               kButton) &&
        i != taken)
      ui.ask(ChooseMeaning{i});
  }
  list.AddText({at.x + size.x - kPad - words.x, at.y + 0.5f * (size.y - words.y)},
               packed(ui.theme.colour.text), text.c_str());
  return UiRect{{at.x, at.y}, {at.x + size.x, at.y + size.y}};
}

// Where a click from afar found nothing.
std::optional<UiRect> nearer_line(UiContext& ui, const ImVec2& at) {
  if (!ui.studio.found_nothing()) return {};
  constexpr float kPad = 8, kButton = 26;
  const char* text = "Nothing stands out where you clicked.";
  const ImVec2 words = ImGui::CalcTextSize(text), label = ImGui::CalcTextSize("Come nearer");
  const ImVec2 end = {at.x + words.x + label.x + 5 * kPad + 16, at.y + kButton + 2 * kPad};
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddRectFilled(at, end, packed(ui.theme.colour.panel, 0.94f), 7);
  list.AddRect(at, end, packed(ui.theme.colour.line), 7);
  list.AddText({at.x + kPad, at.y + 0.5f * (end.y - at.y - words.y)}, packed(ui.theme.colour.text), text);
  ImGui::SetCursorScreenPos({at.x + words.x + 2 * kPad, at.y + kPad});
  if (button(ui, "Come nearer", "Goes to where you clicked: click again from there", {}, true))
    ui.ask(ComeNearer{});
  return UiRect{{at.x, at.y}, {end.x, end.y}};
}

// At the picture's lower edge, where a scene has its floor and no object; a small window has more room at the
// upper one.
std::optional<UiRect> hint(UiContext& ui, const UiRect& area, float bottom) {
  if (!ui.state.hint_wanted || !ui.studio.document().objects.empty()) return {};
  constexpr std::array<std::pair<const char*, const char*>, 4> kLines = {
      {{"Click", "an object: it is cut out"},
       {"Right-click", "what does not belong to it"},
       {"Drag", "turns, right drag shifts, the wheel zooms"},
       {"F1", "shows every key"}}};
  constexpr float kMargin = 14, kPad = 16, kRow = 28, kSecondColumn = 272;
  const bool wide = area.size().x >= 630;  // two columns, or one
  const std::size_t rows = wide ? 2 : 4;
  const ImVec2 size = {wide ? 600.0f : 376.0f, kRow * static_cast<float>(rows) + 20};
  const ImVec2 at = {area.min.x + kMargin,
                     wide ? area.max.y - bottom - size.y - kMargin : area.min.y + kMargin};
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddRectFilled(at, {at.x + size.x, at.y + size.y}, packed(ui.theme.colour.panel, 0.94f), 9);
  list.AddRect(at, {at.x + size.x, at.y + size.y}, packed(ui.theme.colour.accent, 0.7f), 9, 0, 1.5f);
  for (std::size_t i = 0; i < kLines.size(); ++i) {
    const bool second = i >= rows;
    const ImVec2 from = {at.x + (second ? kSecondColumn : kPad),
                         at.y + 14 + kRow * static_cast<float>(i % rows)};
    list.AddText(ui.theme.strong, ImGui::GetFontSize(), from, packed(ui.theme.colour.accent),
                 kLines[i].first);
    list.AddText({from.x + (second ? 44.0f : 82.0f), from.y}, packed(ui.theme.colour.text), kLines[i].second);
  }
  ImGui::SetCursorScreenPos({at.x + size.x - 32, at.y + 6});
  ImGui::PushStyleColor(ImGuiCol_Button, {0, 0, 0, 0});
  if (ImGui::Button(icon::kClose)) ui.state.hint_wanted = false;
  ImGui::PopStyleColor();
  tooltip("Do not show this again");
  return UiRect{{at.x, at.y}, {at.x + size.x, at.y + size.y}};
}

}  // namespace

std::vector<UiRect> viewport_pane(UiContext& ui, const UiRect& area, float bottom,
                                  ImTextureID gpu_picture[2]) {
  std::vector<UiRect> covered;
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const Studio& studio = ui.studio;
  list.AddRectFilled(vec(area.min), vec(area.max), packed(ui.theme.colour.panel_low));
  if (!studio.scene()) {
    start_page(ui, area);
    draw_message(ui, area, bottom);
    return covered;
  }
  const int panes = studio.panes();
  const float pane_width = area.size().x / static_cast<float>(panes);
  const Placement place{area.min, 1 / ui.theme.pixels_per_point};
  const FrameResult* picture = studio.picture();
  for (int i = 0; i < panes; ++i) {
    const ImVec2 from = {area.min.x + pane_width * static_cast<float>(i), area.min.y};
    const ImVec2 to = {from.x + pane_width, area.max.y};
    const auto pane = static_cast<std::size_t>(i);
    if (gpu_picture[i])
      list.AddImage(gpu_picture[i], from, to);
    else if (picture && pane < picture->pictures.size())
      list.AddImage(ui.renderer.texture(kPaneKey + pane, studio.picture_serial(), picture->pictures[pane]),
                    from, to);
  }
  ImGui::PushClipRect(vec(area.min), {area.min.x + pane_width, area.max.y}, true);
  draw_offer(ui, list, place, {{area.min.x, area.min.y}, {area.max.x, area.max.y - bottom}});
  draw_strokes(ui, list, place);
  ImGui::PopClipRect();
  ImGui::PushClipRect(vec(area.min), vec(area.max), true);
  if (panes == 1) draw_centres(ui, area);
  draw_tool_shape(ui, list, place);
  draw_points(ui, area);
  draw_brush_ring(ui, list, place, area);
  draw_cursor_sign(ui, area);
  ImGui::PopClipRect();
  if (panes == 2) {
    list.AddLine({area.min.x + pane_width, area.min.y}, {area.min.x + pane_width, area.max.y},
                 packed(ui.theme.colour.line), 2);
    pane_label(ui, {area.min.x + pane_width + 12, area.min.y + 12}, "Object");
    pane_label(ui, {area.min.x + 12, area.min.y + 12}, "Scene");
  } else if (const char* label = mode_label(studio)) {
    pane_label(ui, {area.min.x + 12, area.min.y + 12}, label);
  }
  const float below_label = panes == 2 || mode_label(studio) ? 40.0f : 0.0f;
  if (const auto rect = offer_line(ui, {area.min.x + 12, area.min.y + 12 + below_label}))
    covered.push_back(*rect);
  if (const auto rect = nearer_line(ui, {area.min.x + 12, area.min.y + 12 + below_label}))
    covered.push_back(*rect);
  covered.push_back(axes_gizmo(ui, area));
  if (const auto rect = hint(ui, area, bottom)) {
    covered.push_back(*rect);
    if (rect->max.y > 0.5f * (area.min.y + area.max.y))
      bottom = area.max.y - rect->min.y;  // messages come above it
  }
  draw_message(ui, area, bottom);
  return covered;
}

void restore_buttons(UiContext& ui) {
  wrapped_muted(ui, "Not saved last time: " + ui.studio.autosave_says());
  if (button(ui, fmt::format("{} Restore the work of last time", icon::kRefresh).c_str(),
             "It was saved by itself before the program ended"))
    ui.ask(RestoreAutosave{});
  ImGui::SameLine(0, 4);
  if (button(ui, icon::kTrash, "Throw that work away")) ui.ask(DropAutosave{});
}

void recent_list(UiContext& ui) {
  for (const auto& path : ui.state.recent) {
    if (ImGui::Selectable(path.filename().string().c_str())) ui.ask(OpenScene{path});
    tooltip(path.string());
  }
}

void start_page(UiContext& ui, const UiRect& area) {
  constexpr float kWidth = 420;
  const glm::vec2 middle = 0.5f * (area.min + area.max);
  ImGui::SetCursorScreenPos({middle.x - kWidth / 2, std::max(area.min.y + 20, middle.y - 150)});
  ImGui::BeginChild("start", {kWidth, 330});
  ImGui::PushFont(ui.theme.title);
  ImGui::TextUnformatted(ui.studio.loading() ? "Opening..." : "Open a scene");
  ImGui::PopFont();
  wrapped_muted(ui, "A 3D Gaussian Splatting scene: " + spoken_extensions(scene_formats(), "or") +
                        ". Or a .splatcut.json with saved work. Drop it on this window, or:");
  ImGui::Dummy({0, 4});
  action_button(ui, Action::kOpen, fmt::format("{} Open a file", icon::kOpen).c_str());
  if (!ui.state.sample.empty()) {
    ImGui::SameLine();
    if (button(ui, "Open the sample scene", "A still life on a table, to try things on"))
      ui.ask(OpenScene{ui.state.sample});
  }
  if (ui.studio.autosave_found()) {
    ImGui::Dummy({0, 4});
    restore_buttons(ui);
  }
  if (!ui.state.recent.empty()) {
    ImGui::Dummy({0, 6});
    muted_text(ui, "Recent");
    recent_list(ui);
  }
  ImGui::EndChild();
}

}  // namespace splatcut
