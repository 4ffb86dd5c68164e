// How the scene is looked at, and the history.
#include <fmt/format.h>

#include <algorithm>
#include <glm/gtc/constants.hpp>

#include "app/document/document_edits.h"
#include "app/document/words.h"
#include "app/ui/panels.h"
#include "app/ui/widgets.h"
#include "scene/cloud/scene_memory.h"

namespace splatcut {

namespace {

void up_buttons(UiContext& ui) {
  struct Axis {
    const char* name;
    glm::vec3 direction;
  };
  const Axis axes[] = {{"+X", {1, 0, 0}},  {"-X", {-1, 0, 0}}, {"+Y", {0, 1, 0}},
                       {"-Y", {0, -1, 0}}, {"+Z", {0, 0, 1}},  {"-Z", {0, 0, -1}}};
  const AxisSigns of_file = axes_of_file(ui.studio);
  ImGui::AlignTextToFramePadding();
  ImGui::TextUnformatted("Up");
  for (const Axis& axis : axes) {
    ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, {5, 4});
    axis.name == axes[0].name ? ImGui::SameLine(0, 74) : same_line_if_fits(axis.name, 2);
    const glm::vec3 direction_world = of_file.position(axis.direction);
    const bool on = glm::dot(ui.studio.document().up_world, direction_world) > 0.9999f;
    if (button(ui, axis.name, "Turns the scene so that this axis points up", {}, on))
      ui.ask(SetUp{direction_world});
    ImGui::PopStyleVar();
  }
}

// Of a .spz that does not say its axes: what was taken, and the other way.
void axes_row(UiContext& ui) {
  const Scene* scene = ui.studio.scene() ? ui.studio.scene()->scene.get() : nullptr;
  if (!scene || !scene->taken_axes) return;
  const SceneSource& file = ui.studio.scene()->files.front();
  wrapped_muted(ui, scene->axes_note);
  const SpzAxes other = *scene->taken_axes == SpzAxes::kRub ? SpzAxes::kPly : SpzAxes::kRub;
  if (button(ui, "Take the other axes",
             "Loads the file again, with y and z the other way round; work begins anew", {}, false, -1))
    ui.ask(OpenScene{scene->path, other, {}, {}, file.cameras, file.camera});
}

void slider_row(const char* label, const char* tip, const std::function<void()>& slider) {
  ImGui::AlignTextToFramePadding();
  ImGui::TextUnformatted(label);
  ImGui::SameLine(92);
  ImGui::SetNextItemWidth(-1);
  slider();
  tooltip(tip);
}

// Of a scene that has levels of detail: the one that is open, and the others.
void level_row(UiContext& ui) {
  const SceneSource* file = ui.studio.scene() ? &ui.studio.scene()->files.front() : nullptr;
  if (!file || file->levels.gaussians.size() < 2) return;
  const auto said = [&](unsigned level) {
    constexpr double kGb = 1e9;
    const std::uint64_t count = file->levels.gaussians[level];
    return fmt::format("{}: {} Gaussians, {:.1f} GB", level, grouped(count),
                       static_cast<double>(memory_of_scene(count, file->levels.sh_degree)) / kGb);
  };
  const unsigned open =
      std::min<unsigned>(file->lod.value_or(0), static_cast<unsigned>(file->levels.gaussians.size()) - 1);
  slider_row("Detail",
             "Level of detail, 0 the finest; another one loads the file again, and work begins anew", [&] {
               if (!ImGui::BeginCombo("##detail", said(open).c_str())) return;
               for (unsigned level = 0; level < file->levels.gaussians.size(); ++level)
                 if (ImGui::Selectable(said(level).c_str(), level == open) && level != open)
                   ui.ask(OpenScene{file->path, file->spz_axes, {}, level, file->cameras, file->camera});
               ImGui::EndCombo();
             });
}

void backdrop_buttons(UiContext& ui) {
  ImGui::SetCursorPosX(14);
  for (std::size_t i = 0; i < backdrops().size(); ++i) {
    const Backdrop& backdrop = backdrops()[i];
    ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, {6, 4});
    if (i > 0) same_line_if_fits(backdrop.name, 2);
    if (button(ui, backdrop.name, tip_of(Action::kBackdrop), {},
               shows(backdrop, ui.studio.document(), ui.studio.view())))
      ui.ask(SetBackdrop{i});
    ImGui::PopStyleVar();
  }
}

// The present step comes into sight where the list is opened, and where it moves on from a row in sight: who
// has scrolled away, or points into the panel, stays there.
void follow_row(UiContext& ui, std::size_t row, bool was_open) {
  const bool moved = std::exchange(ui.state.history_row, row) != row;
  const bool follows = moved && ui.state.history_row_seen && !ImGui::IsWindowHovered();
  if (follows || !was_open) ImGui::SetScrollHereY();
  ui.state.history_row_seen = follows || !was_open || ImGui::IsItemVisible();
}

}  // namespace

void scene_panel(UiContext& ui) {
  if (!section(ui, "View", false)) return;
  const Studio& s = ui.studio;
  ViewState view = s.view();
  slider_row("Background", "Behind the scene; pictures with transparency leave it out", [&] {
    glm::vec3 background = s.document().background;
    if (!ImGui::ColorEdit3("##background", &background.x)) return;
    view.checker = false;
    ui.ask(SetView{view});
    ui.ask(SetBackground{background});
  });
  backdrop_buttons(ui);
  slider_row("View angle", "Vertical field of view: type it, 5 to 140 degrees", [&] {
    float degrees = glm::degrees(s.camera().pose().fov_y_rad);
    if (ImGui::InputFloat("##fov", &degrees, 1, 10, "%.1f deg", ImGuiInputTextFlags_EnterReturnsTrue))
      ui.ask(SetFieldOfView{glm::radians(degrees)});
  });
  constexpr const char* kWidest = "0.00123";
  slider_row("Near limit", "What is nearer than this is not drawn, in scene units", [&] {
    const float unit = s.viewport().draw_limits().near_plane / view.near_share;
    float units = s.viewport().draw_limits().near_plane;
    const std::string format = s.scene() ? length_format(units) : "-";
    if (!numbered_slider(ui, "##near", &units, 0.0005f * unit, 0.2f * unit, format.c_str(),
                         ImGuiSliderFlags_Logarithmic | kTypedLength, kWidest))
      return;
    view.near_share = units / unit;
    ui.ask(SetView{view});
  });
  slider_row("Far limit",
             "What is farther than this is not drawn, in scene units; at the left end there is no limit",
             [&] {
               const float size = s.camera().scene_size();
               float units = view.far_share * size;
               const std::string format = units > 0 ? length_format(units) : "none";
               if (!numbered_slider(ui, "##far", &units, 0, 3 * size, format.c_str(), kTypedLength, kWidest))
                 return;
               view.far_share = units / size;
               ui.ask(SetView{view});
             });
  if (ImGui::Checkbox("Centres of the Gaussians", &view.centres)) ui.ask(SetView{view});
  tooltip(tip_of(Action::kCentres));
  if (ImGui::Checkbox("Rings of the Gaussians", &view.rings)) ui.ask(SetView{view});
  tooltip(tip_of(Action::kRings) + "\nTheir outlines at two standard deviations; of many some, evenly");
  if (ImGui::Checkbox("Grid on the ground", &view.grid)) ui.ask(SetView{view});
  tooltip(tip_of(Action::kGrid));
  bool seen = shows_seen_heat(view);
  if (ImGui::Checkbox("Seen by how many views", &seen)) ui.ask(Action::kSeenHeat);
  tooltip(tip_of(Action::kSeenHeat) +
          "\nOf at most twelve views, cameras of the capture or around it. Red: none saw it; blue: many did");
  level_row(ui);
  axes_row(ui);
  up_buttons(ui);
  ButtonRow frame({"Frame scene", "Frame object"}), step({"Previous camera", "Next camera"});
  action_button(ui, Action::kFrameScene, "Frame scene", false, frame.next());
  action_button(ui, Action::kFrameObject, "Frame object", false, frame.next());
  action_button(ui, Action::kOpeningView, "Opening view", false, -1);
  action_button(ui, Action::kPreviousCamera, "Previous camera", false, step.next());
  action_button(ui, Action::kNextCamera, "Next camera", false, step.next());
  turntable_button(ui, fmt::format("{} Turntable", icon::kFilm).c_str(), -1);
}

void history_panel(UiContext& ui) {
  if (ui.state.history_wanted) ImGui::SetNextItemOpen(*std::exchange(ui.state.history_wanted, std::nullopt));
  const bool was_open = std::exchange(ui.state.history_open, section(ui, "History", false));
  if (!ui.state.history_open) return;
  const History& history = ui.studio.history();
  const SceneFiles& files = ui.studio.files();
  std::size_t row = 0;
  const auto step = [&](const std::string& title) {
    ImGui::PushID(static_cast<int>(row));
    const bool undone = row > history.cursor(), now = row == history.cursor();
    if (undone) ImGui::PushStyleColor(ImGuiCol_Text, ui.theme.colour.muted);
    if (ImGui::Selectable(title.c_str(), now) && !now) ui.ask(JumpHistory{row});
    if (undone) ImGui::PopStyleColor();
    if (now) follow_row(ui, row, was_open);
    ImGui::PopID();
    ++row;
  };
  for (const History::Entry& entry : history.entries()) {
    const bool stays = files.stays(entry);
    const std::string title = row_title(history, row);
    step(stays ? title + "  (stays)" : title);
    if (stays) tooltip("Undo leaves the files as they are: the scene before this step is no longer kept");
  }
  for (const std::string& title : files.redo_titles()) step(title);
}

}  // namespace splatcut
