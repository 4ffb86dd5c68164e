// The picture of the scene with everything over it: messages, offers, the first-run hint.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <utility>

#include "app/ui/panels.h"
#include "app/ui/widgets.h"
#include "app/viewport/on_screen.h"
#include "app/viewport/viewport_pane.h"
#include "segment/finish/shown_part.h"

namespace splatcut {

namespace {

constexpr std::uint64_t kPaneKey = 1;  // of the panes' textures

// The background of what floats over the picture.
void floating_box(const UiContext& ui, const ImVec2& from, const ImVec2& to) {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddRectFilled(from, to, packed(ui.theme.colour.panel, 0.94f), 7);
  list.AddRect(from, to, packed(ui.theme.colour.line), 7);
}

glm::vec2 banner_size(const std::string& text, float wrap) {
  const ImVec2 size = ImGui::CalcTextSize(text.c_str(), nullptr, false, wrap);
  return {size.x + 46, size.y + 16};
}

void banner(const UiContext& ui, const ImVec2& at, const char* symbol, const ImVec4& colour,
            const std::string& text, float wrap) {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const glm::vec2 size = banner_size(text, wrap);
  floating_box(ui, at, {at.x + size.x, at.y + size.y});
  list.AddText({at.x + 12, at.y + 8}, packed(colour), symbol);
  list.AddText(nullptr, 0, {at.x + 34, at.y + 8}, packed(ui.theme.colour.text), text.c_str(), nullptr, wrap);
}

// Where a message should not lie, on the screen: a sample of the active object's Gaussians, and the badges
// and dots of clicks, each of which counts as much as the whole sample.
struct Covered {
  std::vector<glm::vec2> object, marks;
};
constexpr std::size_t kMostCovered = 4000;  // size of the sample

Covered covered_by_message(const UiContext& ui, const UiRect& picture) {
  const Studio& studio = ui.studio;
  Covered out;
  if (!studio.scene()) return out;
  const OnScreen place = on_screen(ui, picture);
  const auto screen_of = [&](const glm::vec2& pixel) {
    const ImVec2 at = place(pixel);
    return glm::vec2(at.x, at.y);
  };
  out.marks = ui.state.badges;
  for (const StrokeMark& mark : studio.viewport().marks()) out.marks.push_back(screen_of(mark.at_px));
  // As they are by now: the picture may still show those before the message.
  const std::vector<std::uint32_t> rows = labelled_rows(studio.labels(studio.document().active));
  const GaussianCloud& cloud = *studio.scene()->cloud;
  const Camera camera = studio.viewport().pane_camera();
  const std::size_t step = 1 + rows.size() / kMostCovered;
  for (std::size_t i = 0; i < rows.size() && out.object.size() < kMostCovered; i += step) {
    const glm::vec3 seen = camera.camera_from_world(cloud.position[rows[i]]);
    if (!(seen.z > studio.viewport().draw_limits().near_plane)) continue;
    out.object.push_back(screen_of(camera.pixel_from_camera(seen)));
  }
  return out;
}

std::size_t count_in(const UiRect& rect, const Covered& covered) {
  constexpr float kBadge = 11;  // points, of its radius
  const UiRect near{rect.min - kBadge, rect.max + kBadge};
  const auto in_rect = [&](const glm::vec2& at) { return rect.contains(at); };
  const auto in_near = [&](const glm::vec2& at) { return near.contains(at); };
  return static_cast<std::size_t>(std::ranges::count_if(covered.object, in_rect)) +
         kMostCovered * static_cast<std::size_t>(std::ranges::count_if(covered.marks, in_near));
}

// In the corner that covers least as the message comes, a lower one if it covers nothing; there it stays.
// top: where the upper ones begin, under what lies over the picture.
void draw_message(const UiContext& ui, const UiRect& area, float top) {
  const ImVec2 pointer = ImGui::GetIO().MousePos;
  const bool whole = std::exchange(ui.state.message, {}).contains({pointer.x, pointer.y});
  const Message* shown = shown_message(ui.studio.messages(), ui.studio.clock_s());
  if (!shown) return;
  const Message& message = *shown;
  const Palette& p = ui.theme.colour;
  const bool warns = message.kind == Message::Kind::kRefused, fails = message.kind == Message::Kind::kError;
  constexpr float kMargin = 14, kMostShare = 1.0f / 8;  // of the picture; all of it under the pointer
  const float wrap = std::min(760.0f, area.size().x - 90);
  const float share = std::max(kMostShare * area.size().y, banner_size("\n", wrap).y);  // two lines at least
  const float most_height = whole || warns || fails ? area.size().y : share;
  const std::string text = shortened(
      message.text, [&](const std::string& said) { return banner_size(said, wrap).y <= most_height; });
  const glm::vec2 size = banner_size(text, wrap);
  const float left = area.min.x + kMargin, right = std::max(left, area.max.x - size.x - kMargin),
              low = area.max.y - size.y - kMargin, high = std::min(low, top + kMargin);
  const std::array<glm::vec2, 4> corners = {{{left, low}, {right, low}, {left, high}, {right, high}}};
  if (std::exchange(ui.state.message_s, message.time_s) != message.time_s) {
    const Covered below = covered_by_message(ui, area);
    std::array<std::size_t, 4> covered;
    std::ranges::transform(corners, covered.begin(), [&](const glm::vec2& at) {
      return count_in({at, at + size}, below);
    });
    ui.state.message_place = static_cast<std::size_t>(std::ranges::min_element(covered) - covered.begin());
  }
  const glm::vec2 at = corners[ui.state.message_place];
  ui.state.message = {at, at + size};
  ui.state.message_text = text;
  banner(ui, vec(at),
         warns || fails                         ? icon::kWarning
         : message.kind == Message::Kind::kDone ? icon::kCheck
                                                : icon::kInfo,
         fails                                  ? p.bad
         : warns                                ? p.warn
         : message.kind == Message::Kind::kDone ? p.good
                                                : p.accent,
         text, wrap);
}

// Small labels of two panes.
void pane_label(const UiContext& ui, const ImVec2& at, const std::string& text) {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const ImVec2 size = ImGui::CalcTextSize(text.c_str());
  list.AddRectFilled(at, {at.x + size.x + 16, at.y + size.y + 8}, packed(ui.theme.colour.panel, 0.85f), 5);
  list.AddText({at.x + 8, at.y + 4}, packed(ui.theme.colour.text), text.c_str());
}

// In the middle of a pane without a picture.
void coming_label(const UiContext& ui, const UiRect& pane, const std::string& text) {
  const ImVec2 size = ImGui::CalcTextSize(text.c_str());
  const glm::vec2 at = 0.5f * (pane.min + pane.max - glm::vec2(size.x + 16, size.y + 8));
  pane_label(ui, vec(at), text);
}

using OutlineWorld = std::vector<std::pair<glm::vec3, glm::vec3>>;

bool shows_hole_filled(const Studio& studio) {
  const auto& without = studio.viewport().styles().without;
  return without && without->patch.why_not.empty() && studio.viewport().clean(0);
}

// Without the object, around the hole that is filled, as long as outlines show, or around ground that no view
// ever showed; null: there is none, or it is not known.
const OutlineWorld* ground_outline(const Studio& studio) {
  if (studio.view().display != DisplayMode::kHide) return nullptr;
  if (shows_hole_filled(studio))
    return studio.view().outline ? &studio.viewport().styles().without->patch.outline_world : nullptr;
  const UnseenGround* ground = studio.view().fill_hole ? nullptr : studio.seen_views().ground();
  return ground && !ground->outline_world.empty() ? &ground->outline_world : nullptr;
}

// Whole letters of a name that is longer than what leaves room for the rest of a label.
std::string beginning_of(const std::string& name, std::size_t most) {
  if (name.size() <= most) return name;
  while (most > 0 && (static_cast<unsigned char>(name[most]) & 0xC0) == 0x80) --most;
  return name.substr(0, most) + "...";
}

std::string mode_label(const Studio& studio) {
  constexpr std::size_t kMostOfName = 24;
  const CleanObject* clean = studio.viewport().clean(0).get();
  const ObjectItem* object = studio.document().active_object();
  const std::string name = object ? object->name : "the object";
  return label_of(studio.view(), {.name = beginning_of(name, kMostOfName),
                                  .clean = clean && clean->report.cleaned,
                                  .heat = studio.viewport().style(0).heat != nullptr,
                                  .looking = studio.seen_views().looking(),
                                  .filled = shows_hole_filled(studio),
                                  .outlined = ground_outline(studio) != nullptr});
}

// The bar with the meanings as buttons.
constexpr float kOfferPad = 8, kOfferButton = 26;

struct OfferBar {
  UiRect rect;
  const char* words;  // behind the buttons
};

// As many words as fit left of `right`, in two lines if need be: that Esc keeps what was taken comes last to
// go.
std::optional<OfferBar> offer_bar(const UiContext& ui, const ImVec2& at, float right) {
  constexpr const char* kWords[] = {"what else this can mean  (Esc: keep this one)",
                                    "what else this can mean\n(Esc: keep this one)", "Esc: keep this one",
                                    "Esc: keep"};
  const ClickMeanings* offer = ui.studio.clicks().offer();
  if (!offer) return {};
  const auto count = static_cast<float>(offer->outlines.size());
  const float buttons = 2 * kOfferPad + count * (kOfferButton + 4) + 6,
              bottom = at.y + kOfferButton + 2 * kOfferPad;
  for (const char* words : kWords)
    if (const float end = at.x + buttons + ImGui::CalcTextSize(words).x; end <= right)
      return OfferBar{{{at.x, at.y}, {end, bottom}}, words};
  return OfferBar{{{at.x, at.y}, {at.x + buttons, bottom}}, ""};
}

// The meanings as buttons with their keys.
std::optional<UiRect> offer_line(UiContext& ui, const ImVec2& at, float right) {
  const std::optional<OfferBar> bar = offer_bar(ui, at, right);
  if (!bar) return {};
  constexpr float kPad = kOfferPad, kButton = kOfferButton;
  const ClickMeanings* offer = ui.studio.clicks().offer();
  const ObjectItem& object = *ui.studio.document().active_object();
  const Stroke* first = first_stroke(object.views);
  const int taken = first && first->size_step == 0 ? object.choice : -1;  // another size is none of them
  const ImVec2 words = ImGui::CalcTextSize(bar->words), size = vec(bar->rect.size());
  ImDrawList& list = *ImGui::GetWindowDrawList();
  ui.state.offer_words = bar->words;
  floating_box(ui, at, vec(bar->rect.max));
  ImGui::SetCursorScreenPos({at.x + kPad, at.y + kPad});
  for (int i = 0; i < std::ssize(offer->outlines); ++i) {
    if (i > 0) ImGui::SameLine(0, 4);
    if (button(ui, fmt::format("{}##meaning", i + 1).c_str(), fmt::format("Key {}", i + 1), {}, i == taken,
               kButton) &&
        i != taken)
      ui.ask(ChooseMeaning{i});
  }
  list.AddText({at.x + size.x - kPad - words.x, at.y + 0.5f * (size.y - words.y)},
               packed(ui.theme.colour.text), bar->words);
  return bar->rect;
}

// A sentence, with room for a button of that label behind it, where the cursor then is; below it where both
// are not left of `right`.
UiRect line_before_button(const UiContext& ui, const ImVec2& at, float right, const char* text,
                          const char* label) {
  constexpr float kPad = 8, kButton = 26;
  const float for_button = ImGui::CalcTextSize(label).x + 5 * kPad + 16;
  const bool beside = at.x + ImGui::CalcTextSize(text).x + for_button <= right;
  const float wrap = beside ? 0 : right - at.x - 2 * kPad;
  const ImVec2 words = ImGui::CalcTextSize(text, nullptr, false, wrap > 0 ? wrap : -1);
  const ImVec2 end = {at.x + words.x + (beside ? for_button : 2 * kPad),
                      at.y + kButton + 2 * kPad + (beside ? 0 : words.y + kPad)};
  floating_box(ui, at, end);
  ImGui::GetWindowDrawList()->AddText(nullptr, 0,
                                      {at.x + kPad, at.y + (beside ? 0.5f * (end.y - at.y - words.y) : kPad)},
                                      packed(ui.theme.colour.text), text, nullptr, wrap);
  ImGui::SetCursorScreenPos({at.x + (beside ? words.x + 2 * kPad : kPad), end.y - kPad - kButton});
  return UiRect{{at.x, at.y}, {end.x, end.y}};
}

// Without the object: its hole can be filled, or is.
UiRect hole_line(UiContext& ui, const ImVec2& at, float right) {
  const bool fills = ui.studio.view().fill_hole;
  const bool kept = ui.studio.files().fills_hole_of(ui.studio.document().active);
  const std::string text = fills  ? ui.studio.finish().hole_text()
                           : kept ? "Its hole is filled."
                                  : "It may leave a hole.";
  const char* label = fills ? "Leave the hole" : "Fill the hole";
  const auto without = fills ? ui.studio.finish().without() : nullptr;
  const bool keeps = without && !without->patch.changes.given_back.empty();
  constexpr const char* kKeep = "Keep the fill";
  const UiRect line = line_before_button(ui, at, right, text.c_str(),
                                         keeps ? fmt::format("{}   {}", label, kKeep).c_str() : label);
  action_button(ui, Action::kFillHole, label);
  if (!keeps) return line;
  ImGui::SameLine(0, 8);
  if (button(ui, kKeep, "As a file of the scene and an object of its own, to be repaired, moved or exported"))
    open_file_dialog(ui, FilePurpose::kFill);
  return line;
}

// Where a click from afar found nothing, an object shown alone is not as clean as it is wanted, or the object
// is not shown.
std::optional<UiRect> advice_line(UiContext& ui, const ImVec2& at, float right) {
  if (ui.studio.clicks().found_nothing()) {
    const UiRect line =
        line_before_button(ui, at, right, "Nothing stands out where you clicked.", "Come nearer");
    come_nearer_button(ui);
    return line;
  }
  if (ui.studio.clicks().offer()) return {};
  if (ui.studio.view().display == DisplayMode::kHide) return hole_line(ui, at, right);
  return {};
}

// Of the picture, by the tool's options.
float covered_top(const UiContext& ui) {
  return ui.state.row_below() ? ui.state.options_height : 0;
}

// At the picture's lower edge, where a scene has its floor and no object; a small window has more room at the
// upper one.
std::optional<UiRect> first_run_hint(UiContext& ui, const UiRect& area) {
  if (!ui.state.hint_wanted || !ui.studio.document().objects.empty()) return {};
  constexpr std::array<std::pair<const char*, const char*>, 4> kLines = {
      {{"Click", "an object: it is cut out"},
       {"Right-click", "what does not belong to it"},
       {"Wheel", "zooms; right after a click: more or less"},
       {"Drag", "turns, right drag shifts. F1: every key"}}};
  constexpr float kMargin = 14, kPad = 16, kRow = 28, kSecondColumn = 272;
  const bool wide = area.size().x >= 630;  // two columns, or one
  const std::size_t rows = wide ? 2 : 4;
  const ImVec2 size = {wide ? 600.0f : std::min(376.0f, area.size().x - 2 * kMargin),
                       kRow * static_cast<float>(rows) + 20};
  const ImVec2 at = {area.min.x + kMargin,
                     wide ? area.max.y - size.y - kMargin : area.min.y + kMargin + covered_top(ui)};
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
  if (plain_button(ui, icon::kClose)) ui.state.hint_wanted = false;
  ImGui::PopStyleColor();
  tooltip("Do not show this again");
  return UiRect{{at.x, at.y}, {at.x + size.x, at.y + size.y}};
}

// Rings and centres that no pane shows go: they hold the whole scene of which they were made.
void forget_unshown(const UiContext& ui) {
  const Studio& studio = ui.studio;
  const int panes = studio.scene() ? studio.viewport().panes() : 0;
  for (int i = 0; i < 2; ++i) {
    if (i >= panes || !studio.view().rings) ui.state.rings[i] = {};
    if (i >= panes || !studio.view().centres) ui.state.centres[i] = {};
  }
}

}  // namespace

std::vector<UiRect> viewport_pane(UiContext& ui, const UiRect& area, ImTextureID gpu_picture[2]) {
  std::vector<UiRect> covered;
  ui.state.badges.clear();
  forget_unshown(ui);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const Studio& studio = ui.studio;
  list.AddRectFilled(vec(area.min), vec(area.max), packed(ui.theme.colour.panel_low));
  if (!studio.scene()) {
    start_page(ui, area);
    draw_message(ui, area, area.max.y);  // in a lower corner
    return covered;
  }
  const int panes = studio.viewport().panes();
  const float pane_width = area.size().x / static_cast<float>(panes);
  const FrameResult* picture = studio.viewport().picture();
  const auto rect_of = [&](int pane) -> UiRect {
    const float left = area.min.x + pane_width * static_cast<float>(pane);
    return {{left, area.min.y}, {left + pane_width, area.max.y}};
  };
  for (int i = 0; i < panes; ++i) {
    const UiRect of_pane = rect_of(i);
    const ImVec2 from = vec(of_pane.min), to = vec(of_pane.max);
    const auto pane = static_cast<std::size_t>(i);
    if (gpu_picture[i])
      list.AddImage(gpu_picture[i], from, to);
    else if (picture && pane < picture->pictures.size())
      list.AddImage(
          ui.renderer.texture(kPaneKey + pane, studio.viewport().picture_serial(), picture->pictures[pane]),
          from, to);
    if (!gpu_picture[i] && !picture) coming_label(ui, of_pane, studio.coming());
    ImGui::PushClipRect(from, to, true);
    draw_ground_grid(ui, of_pane, i);
    if (const OutlineWorld* outline = ground_outline(studio)) draw_ground_outline(ui, of_pane, *outline);
    draw_rings(ui, of_pane, i);
    if (i == 0) draw_placed_file(ui, of_pane);
    draw_centres(ui, of_pane, i);
    ImGui::PopClipRect();
  }
  ImGui::PushClipRect(vec(area.min), {area.min.x + pane_width, area.max.y}, true);
  const float top = area.min.y + covered_top(ui) + 12;
  const float below_label = panes == 2 || !mode_label(studio).empty() ? 40.0f : 0.0f;
  const ImVec2 offers_at = {area.min.x + 12, top + below_label};
  const float offers_end = area.min.x + pane_width - 12;
  const auto offer = offer_bar(ui, offers_at, offers_end);
  const UiRect bar = offer ? offer->rect : UiRect{};
  draw_offer(ui, area, bar);
  draw_sizes(ui, area, bar);
  draw_strokes(ui, area);
  ImGui::PopClipRect();
  // A volume stands in the scene, whichever pane shows that; what is drawn on a picture stays there.
  const bool volume = studio.overlay().shape == ToolOverlay::Shape::kCircle;
  for (int i = 0; i < panes; ++i) {
    if (!volume && i != studio.viewport().pressed_pane()) continue;
    const UiRect of_pane = rect_of(i);
    ImGui::PushClipRect(vec(of_pane.min), vec(of_pane.max), true);
    draw_tool_shape(ui, of_pane);
    draw_points(ui, of_pane);
    ImGui::PopClipRect();
  }
  ImGui::PushClipRect(vec(area.min), vec(area.max), true);
  draw_brush_ring(ui, area);
  draw_looking(ui, area);
  if (!studio.cursor_px()) draw_cursor_sign(ui, area);
  ImGui::PopClipRect();
  if (panes == 2) {
    list.AddLine({area.min.x + pane_width, area.min.y}, {area.min.x + pane_width, area.max.y},
                 packed(ui.theme.colour.line), 2);
    const bool compares = studio.view().display == DisplayMode::kBeforeAfter;
    const auto& clean = studio.viewport().clean(1);
    pane_label(ui, {area.min.x + pane_width + 12, top},
               clean && clean->report.cleaned ? "Object, edges cleaned" : "Object");
    pane_label(ui, {area.min.x + 12, top}, compares ? "Object as it is  (B: back)" : "Scene");
  } else if (const std::string label = mode_label(studio); !label.empty()) {
    pane_label(ui, {area.min.x + 12, top}, label);
  }
  float above_axes = area.min.y + covered_top(ui);
  for (const auto& line :
       {offer_line(ui, offers_at, offers_end), advice_line(ui, offers_at, area.max.x - 12)}) {
    if (line) covered.push_back(*line);
    if (line && line->max.x > area.max.x - kAxesWidth) above_axes = line->max.y;
  }
  const UiRect axes = axes_gizmo(ui, {{area.min.x, above_axes}, area.max});
  UiRect for_message = area;
  if (const auto rect = first_run_hint(ui, area)) {
    covered.push_back(*rect);
    if (rect->max.y > 0.5f * (area.min.y + area.max.y)) for_message.max.y = rect->min.y;
  }
  float under = std::max(top + below_label, axes.max.y);
  for (const UiRect& rect : covered)
    if (rect.min.y < 0.5f * (area.min.y + area.max.y)) under = std::max(under, rect.max.y);
  if (!studio.tools().at_work()) covered.push_back(axes);  // else it is drawn over
  draw_message(ui, for_message, under);
  if (studio.cursor_px()) {  // no message hides what keys move
    draw_cursor_sign(ui, area);
    draw_key_cursor(ui, area);
  }
  return covered;
}

}  // namespace splatcut
