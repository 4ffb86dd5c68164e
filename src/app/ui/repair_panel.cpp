// Repairing a selection by hand: neighbours, parts, floaters, and selection by property with its histogram.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "app/ui/panels.h"
#include "app/ui/widgets.h"

namespace splatcut {

namespace {

struct PropertyName {
  const char *name, *tip;
};
constexpr PropertyName kProperties[] = {
    {"Opacity", "Select by opacity"},
    {"Size", "Select by size: the largest standard deviation, in scene units"},
    {"Depth", "Select by distance from the camera, in scene units"},
    {"Needles", "Select by shape: how many times longer a Gaussian is than it is wide"},
    {"Colour", "Select by colour"}};
constexpr int kColourProperty = PropertyChoice::kColourProperty, kBins = 48;

void pair_of(UiContext& ui, Action left, const char* left_label, Action right, const char* right_label) {
  ButtonRow row({left_label, right_label});
  action_button(ui, left, left_label, false, row.next());
  action_button(ui, right, right_label, false, row.next());
}

void floater_buttons(UiContext& ui) {
  const Studio& s = ui.studio;
  ButtonRow row({"Show floaters", "Remove them"});
  action_button(ui, Action::kFloaters, "Show floaters", s.viewport().floaters_shown(), row.next());
  const std::string reason = !s.viewport().floaters_shown()      ? "Show them first"
                             : s.viewport().floater_count() == 0 ? "There are none"
                                                                 : "";
  if (button(ui,
             s.viewport().floaters_shown() && s.viewport().floater_count()
                 ? fmt::format("Remove {}", grouped(s.viewport().floater_count())).c_str()
                 : "Remove them",
             "Takes the small far clusters out of the selection", reason, false, row.next()))
    ui.ask(EditSelection{SelectionEdit::kRemoveFloaters});
}

void refresh_histogram(UiContext& ui) {
  PropertyChoice& choice = ui.state.property;
  const Viewport& view = ui.studio.viewport();
  const Camera camera = view.pane_camera();
  const bool of_view = choice.property == static_cast<int>(Property::kDepth);
  const std::string key = fmt::format("{} {}", ui.studio.scene()->serial, choice.property);
  const bool other = key != choice.histogram_key;
  const bool of_last_view =
      choice.histogram_of && (view.moving() || same_camera(*choice.histogram_of, camera));
  if (!other && (!of_view || of_last_view)) return;
  const auto values =
      property_values(*ui.studio.scene()->cloud, static_cast<Property>(choice.property), &camera);
  choice.histogram = histogram(values, kBins);
  choice.histogram_key = key;
  choice.histogram_of = camera;
  if (!other) return;
  choice.low = choice.histogram.low;
  choice.high = choice.histogram.high;
}

void draw_histogram(UiContext& ui) {
  const PropertyChoice& choice = ui.state.property;
  const Histogram& h = choice.histogram;
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float width = ImGui::GetContentRegionAvail().x, height = 46;
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddRectFilled(at, {at.x + width, at.y + height}, packed(ui.theme.colour.field), 4);
  const float bar = width / static_cast<float>(h.share.size());
  for (std::size_t i = 0; i < h.share.size(); ++i) {
    const float middle =
        h.low + (h.high - h.low) * (static_cast<float>(i) + 0.5f) / static_cast<float>(h.share.size());
    const bool inside = middle >= choice.low && middle <= choice.high;
    const float x = at.x + bar * static_cast<float>(i), top = at.y + (height - 2) * (1 - h.share[i]);
    list.AddRectFilled({x, top}, {x + bar - 1, at.y + height},
                       packed(inside ? ui.theme.colour.accent : ui.theme.colour.line));
  }
  ImGui::Dummy({width, height});
}

void property_range(UiContext& ui) {
  PropertyChoice& choice = ui.state.property;
  refresh_histogram(ui);
  draw_histogram(ui);
  // Shares are shown in percent, sizes as lengths, of which powers of ten are kept. The ends of the histogram
  // stand for everything beyond them.
  const bool is_share = choice.property == static_cast<int>(Property::kOpacity),
             is_size = choice.property == static_cast<int>(Property::kSize);
  constexpr float kLeastLength = 1e-20f;
  const auto shown = [&](float value) {
    return is_share ? 100 * value : is_size ? std::pow(10.0f, value) : value;
  };
  const auto kept = [&](float value) {
    return is_share ? value / 100 : is_size ? std::log10(std::max(kLeastLength, value)) : value;
  };
  float low = shown(choice.low), high = shown(choice.high);
  const float low_before = low, high_before = high, least = shown(choice.histogram.low),
              most = shown(choice.histogram.high);
  const float range =
      is_size ? most - least : high - low;  // sizes are dragged in proportion to the whole range
  const auto format = [&](float value, bool end, const char* beyond) {
    return (is_share ? "%.0f %%" : length_format(value)) + (end ? beyond : "");
  };
  const std::string low_format = format(low, choice.low <= choice.histogram.low, " and less"),
                    high_format = format(high, choice.high >= choice.histogram.high, " and more");
  ImGui::SetNextItemWidth(-1);
  ImGui::DragFloatRange2("##range", &low, &high, std::max(is_size ? 0.0f : shown(1e-4f), range / 200), least,
                         most, low_format.c_str(), high_format.c_str(),
                         ImGuiSliderFlags_NoRoundToFormat | (is_size ? ImGuiSliderFlags_Logarithmic : 0));
  if (low != low_before) choice.low = low == least ? choice.histogram.low : kept(low);
  if (high != high_before) choice.high = high == most ? choice.histogram.high : kept(high);
}

SelectRangeOrColour range_of(const PropertyChoice& choice, SetOperation operation) {
  constexpr float kAll = std::numeric_limits<float>::infinity();
  if (choice.property == kColourProperty) return SelectColour{choice.colour, choice.tolerance, operation};
  return SelectRange{static_cast<Property>(choice.property),
                     choice.low <= choice.histogram.low ? -kAll : choice.low,
                     choice.high >= choice.histogram.high ? kAll : choice.high, operation};
}

// Shows in the picture what is in the range while the pointer is at it.
void preview_range(UiContext& ui, bool at_range) {
  const auto& shown = ui.studio.viewport().range_shown();
  if (!at_range) {
    if (shown) ui.ask(ShowRange{});
    return;
  }
  const SelectRangeOrColour wanted = range_of(ui.state.property, SetOperation::kAdd);
  if (shown != wanted) ui.ask(ShowRange{wanted});
}

void property_selection(UiContext& ui) {
  PropertyChoice& choice = ui.state.property;
  ImGui::AlignTextToFramePadding();
  ImGui::TextUnformatted("Select by");
  for (int i = 0; i < std::ssize(kProperties); ++i) {
    ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, {6, 4});
    if (i > 0) same_line_if_fits(kProperties[i].name, 2);
    if (button(ui, kProperties[i].name, kProperties[i].tip, {}, choice.property == i)) choice.property = i;
    ImGui::PopStyleVar();
  }
  const ImVec2 range_from = ImGui::GetCursorScreenPos();
  if (choice.property == kColourProperty) {
    ImGui::SetNextItemWidth(-1);
    ImGui::ColorEdit3("##colour", &choice.colour.x, ImGuiColorEditFlags_DisplayRGB);
    ImGui::SetNextItemWidth(-1);
    tolerance_slider(ui, &choice.tolerance);
  } else {
    property_range(ui);
  }
  const bool ranges = ImGui::IsItemActive();  // dragged, wherever the pointer is
  const auto ask = [&](SetOperation operation) {
    std::visit([&](const auto& wanted) { ui.ask(wanted); }, range_of(choice, operation));
  };
  const ObjectItem* active = ui.studio.document().active_object();
  const std::string reason = active && active->locked ? active->name + " is locked" : "";
  ButtonRow row({"Add", "Remove", "Keep only"});
  if (button(ui, "Add", "Add what lies in the range to the selection", reason, false, row.next()))
    ask(SetOperation::kAdd);
  if (button(ui, "Remove", "Take what lies in the range out of the selection", reason, false, row.next()))
    ask(SetOperation::kRemove);
  if (button(ui, "Keep only", "Keep only what lies in the range", reason, false, row.next()))
    ask(SetOperation::kIntersect);
  const ImVec2 range_to(range_from.x + ImGui::GetContentRegionAvail().x, ImGui::GetItemRectMax().y);
  const bool in_window = ImGui::IsWindowHovered(ImGuiHoveredFlags_AllowWhenBlockedByActiveItem);
  preview_range(ui, ranges || (in_window && ImGui::IsMouseHoveringRect(range_from, range_to)));
}

}  // namespace

void repair_panel(UiContext& ui) {
  if (!section(ui, "Repair by hand", false)) return preview_range(ui, false);
  pair_of(ui, Action::kGrow, "Grow", Action::kShrink, "Shrink");
  pair_of(ui, Action::kInvert, "Invert", Action::kLargestPart, "Largest part");
  floater_buttons(ui);
  ButtonRow row({"Delete from scene", "Restore deleted"});
  action_button(ui, Action::kDelete, "Delete from scene", false, row.next());
  if (button(ui, "Restore deleted", "Brings everything back that was deleted from the scene",
             ui.studio.document().deleted ? "" : "Nothing is deleted", false, row.next()))
    ui.ask(RestoreDeleted{});
  if (ui.studio.scene()) property_selection(ui);
}

}  // namespace splatcut
