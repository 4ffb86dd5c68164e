// The list of objects: choose, name, colour, show, lock, and what can be done with each.
#include <fmt/format.h>
#include <imgui.h>

#include <imgui_stdlib.h>  // needs imgui.h first

#include "app/ui/panels.h"
#include "app/ui/widgets.h"

namespace splatcut {

namespace {

void name_field(UiContext& ui, const ObjectItem& object, float width) {
  ImGui::SetNextItemWidth(width);
  ImGui::SetKeyboardFocusHere();
  const bool entered = ImGui::InputText(
      "##name", &ui.state.new_name, ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_AutoSelectAll);
  const bool left = ImGui::IsItemDeactivated();
  if (!entered && !left) return;
  if (!ui.state.new_name.empty() && ui.state.new_name != object.name)
    ui.ask(RenameObject{object.id, ui.state.new_name});
  ui.state.renaming = 0;
}

std::string first_of(std::initializer_list<std::string> reasons) {
  for (const std::string& reason : reasons)
    if (!reason.empty()) return reason;
  return {};
}

// Greyed, with the reason in its tooltip, unless that is empty.
bool entry(const char* label, const std::string& reason = {}, bool ticked = false) {
  const bool chosen = ImGui::MenuItem(label, nullptr, ticked, reason.empty());
  tooltip(reason);
  return chosen;
}

void merge_menu(UiContext& ui, const ObjectItem& object, const std::string& locked) {
  const auto& objects = ui.studio.document().objects;
  const std::string reason = objects.size() < 2 ? "There is no other object" : locked;
  const bool open = ImGui::BeginMenu("Merge into", reason.empty());
  tooltip(reason);
  if (!open) return;
  for (const ObjectItem& other : objects)
    if (other.id != object.id && entry(other.name.c_str(), other.locked ? other.name + " is locked" : ""))
      ui.ask(MergeObjects{other.id, object.id});
  ImGui::EndMenu();
}

void object_menu(UiContext& ui, const ObjectItem& object) {
  const std::string empty = ui.studio.gaussians_of(object.id) == 0 ? "The object is empty so far" : "";
  const std::string locked = object.locked ? object.name + " is locked" : "";
  if (entry("Rename")) {
    ui.state.renaming = object.id;
    ui.state.new_name = object.name;
  }
  if (entry("New part of this object")) ui.ask(NewObject{object.id});
  if (entry("Duplicate")) ui.ask(DuplicateObject{object.id});
  if (entry("Tint", "", object.tinted)) ui.ask(TintObject{object.id, !object.tinted});
  merge_menu(ui, object, locked);
  if (entry("Split into connected parts", first_of({locked, empty}))) ui.ask(SplitObject{object.id});
  if (entry("Separate in place", empty)) ui.ask(SeparateObject{object.id});
  const bool without = ui.studio.is_without_others(object.id);
  if (entry("Without the other objects", locked, without)) ui.ask(LeaveToOthers{object.id, !without});
  ImGui::Separator();
  const bool active = object.id == ui.studio.document().active;
  if (entry("Clear strokes", first_of({locked, object.views.empty() ? "It has no strokes" : "",
                                       active ? "" : "Choose the object first"})))
    ui.ask(ClearStrokes{});
  if (entry("Remove from the list", locked)) ui.ask(RemoveObject{object.id});
}

// An icon without a frame.
bool flat_icon(UiContext& ui, const char* symbol, bool lit, const std::string& tip) {
  ImGui::PushStyleColor(ImGuiCol_Button, {0, 0, 0, 0});
  ImGui::PushStyleColor(ImGuiCol_Text, lit ? ui.theme.colour.text : ui.theme.colour.muted);
  ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, {3, 5});
  const bool pressed = ImGui::Button(symbol);
  ImGui::PopStyleVar();
  ImGui::PopStyleColor(2);
  tooltip(tip);
  return pressed;
}

void object_row(UiContext& ui, const ObjectItem& object) {
  constexpr float kIconsWidth = 84;
  const bool active = object.id == ui.studio.document().active;
  ImGui::PushID(static_cast<int>(object.id));
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  const float width = ImGui::GetContentRegionAvail().x, height = ImGui::GetFrameHeight() + 4;
  if (active)
    ImGui::GetWindowDrawList()->AddRectFilled({corner.x - 4, corner.y - 2},
                                              {corner.x + width + 4, corner.y + height - 2},
                                              packed(ui.theme.colour.accent, 0.22f), 5);
  if (object.within != 0) ImGui::Indent(14);
  ImVec4 colour = colour_of(object.colour);
  ImGui::SetNextItemWidth(22);
  if (ImGui::ColorEdit3(
          "##colour", &colour.x,
          ImGuiColorEditFlags_NoInputs | ImGuiColorEditFlags_NoLabel | ImGuiColorEditFlags_NoTooltip))
    ui.ask(RecolourObject{object.id, Rgb8{static_cast<std::uint8_t>(colour.x * 255 + 0.5f),
                                          static_cast<std::uint8_t>(colour.y * 255 + 0.5f),
                                          static_cast<std::uint8_t>(colour.z * 255 + 0.5f)}});
  tooltip("Colour of the object");
  ImGui::SameLine();
  const float name_width = width - kIconsWidth - 34 - (object.within ? 14.0f : 0.0f);
  if (ui.state.renaming == object.id) {
    name_field(ui, object, name_width);
  } else {
    const std::string label = fmt::format("{}##row", object.name);
    ImGui::AlignTextToFramePadding();
    if (ImGui::Selectable(label.c_str(), false, ImGuiSelectableFlags_AllowDoubleClick, {name_width, 0})) {
      if (!active) ui.ask(ActivateObject{object.id});
      if (ui.state.double_clicked) {
        ui.state.renaming = object.id;
        ui.state.new_name = object.name;
      }
    }
    if (ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled))  // else nobody counts them
      tooltip(fmt::format("{} Gaussians. Double-click renames, right-click shows more.",
                          grouped(ui.studio.gaussians_of(object.id))));
    if (ImGui::BeginPopupContextItem("menu")) {
      object_menu(ui, object);
      ImGui::EndPopup();
    }
  }
  ImGui::SameLine(width - kIconsWidth + 12);
  const ObjectId chosen = ui.studio.document().active;
  const bool hidden = hides(ui.studio.view(), object.id, chosen);
  if (flat_icon(
          ui, fmt::format("{}###eye", hidden ? icon::kEyeOff : icon::kEye).c_str(), !hidden,
          hidden ? "Hidden in the scene. Press to show it" : "Hide it in the scene. Exports still have it"))
    ui.ask(SetView{turned_eye(ui.studio.view(), object.id, chosen)});
  ImGui::SameLine(0, 0);
  if (flat_icon(ui, object.locked ? icon::kLock : icon::kUnlock, object.locked,
                tip_of_lock(ui.studio.document(), object)))
    ui.ask(LockObject{object.id, !object.locked});
  ImGui::SameLine(0, 0);
  if (flat_icon(ui, icon::kMore, true, "More")) ImGui::OpenPopup("more");
  if (ImGui::BeginPopup("more")) {
    object_menu(ui, object);
    ImGui::EndPopup();
  }
  if (object.within != 0) ImGui::Unindent(14);
  ImGui::PopID();
}

// What was exported last, to be taken to another program.
void exported_file(UiContext& ui) {
  const std::filesystem::path& file = ui.studio.exports().last();
  if (file.empty()) return;
  const std::string name = fmt::format("{}  {}##exported", icon::kFile, file.filename().string());
  ImGui::PushStyleVar(ImGuiStyleVar_ButtonTextAlign, {0, 0.5f});
  if (plain_button(ui, name.c_str(), -1)) ImGui::SetClipboardText(std::filesystem::absolute(file).c_str());
  ImGui::PopStyleVar();
  constexpr float kStart = 6;  // points: less is a click
  if (ImGui::IsItemActive() && ImGui::IsMouseDragging(0, kStart) && !ui.state.drags_out) {
    ui.state.dragged_out = file;
    ui.state.drags_out = true;
  }
  if (!ImGui::IsItemActive()) ui.state.drags_out = false;
  if (ui.state.drags_out)
    ImGui::SetTooltip("%s", file.filename().c_str());
  else
    tooltip(fmt::format("{}\nExported last. Drag it into another program, or click: its path is copied",
                        file.string()));
}

}  // namespace

// A part stays within its whole, locked or not.
std::string tip_of_lock(const Document& document, const ObjectItem& object) {
  const ObjectItem* whole = document.find(object.within);
  const std::string but =
      whole && !whole->locked ? fmt::format(" but a change of {}, of which it is a part", whole->name) : "";
  return fmt::format(
      fmt::runtime(object.locked ? "Locked: nothing changes it{}, and no other object takes what it "
                                   "has. Press to unlock"
                                 : "Lock it: then nothing changes it{}, and no other object takes "
                                   "what it has"),
      but);
}

void objects_panel(UiContext& ui) {
  if (!section(ui, "Objects")) return;
  const auto& objects = ui.studio.document().objects;
  if (objects.empty()) wrapped_muted(ui, "Click an object in the picture: it appears here.");
  if (objects.empty() && ui.studio.scene() && !ui.studio.work().offers().empty()) left_work_list(ui);
  for (const ObjectItem& object : objects) object_row(ui, object);
  action_button(ui, Action::kNewObject, fmt::format("{} New object", icon::kPlus).c_str(), false, -1);
  if (const ObjectItem* active = ui.studio.document().active_object())
    wrapped_muted(ui, ui.studio.gaussians_of(active->id) == 0 && active->views.empty()
                          ? fmt::format("{} is empty: click it in the picture.", active->name)
                      : hides_chosen(ui.studio.view(), active->id)
                          ? fmt::format("Clicks and strokes go to {}, which is hidden.", active->name)
                          : fmt::format("Clicks and strokes go to {}.", active->name));
  exported_file(ui);
}

}  // namespace splatcut
