// The files that the scene is made of: added, placed by numbers, selected, taken out.
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>

#include "app/document/words.h"
#include "app/ui/panels.h"
#include "app/ui/widgets.h"

namespace splatcut {

namespace {

// Three numbers in a row, dragged or typed. True where the change is done.
bool three_numbers(const char* label, const char* tip, glm::vec3* values, float step, const char* format) {
  constexpr const char* kAxes[] = {"x", "y", "z"};
  bool done = false;
  ImGui::AlignTextToFramePadding();
  ImGui::TextUnformatted(label);
  ImGui::SameLine(64);
  const float third = (ImGui::GetContentRegionAvail().x - 8) / 3;
  ImGui::PushID(label);
  for (int i = 0; i < 3; ++i) {
    if (i > 0) ImGui::SameLine(0, 4);
    ImGui::SetNextItemWidth(third);
    ImGui::DragFloat(fmt::format("##{}", kAxes[i]).c_str(), &(*values)[i], step, 0, 0,
                     fmt::format("{} {}", kAxes[i], format).c_str(), ImGuiSliderFlags_NoRoundToFormat);
    done |= ImGui::IsItemDeactivatedAfterEdit();
    tooltip(fmt::format("{}. Drag, or click and type.", tip));
  }
  ImGui::PopID();
  return done;
}

// About the file's foot.
bool scale_number(ScenePlace* place, const SceneSource& file, const glm::vec3& up_world) {
  ImGui::AlignTextToFramePadding();
  ImGui::TextUnformatted("Scale");
  ImGui::SameLine(64);
  // As wide as a number above, or as the longest scale.
  const float longest = ImGui::CalcTextSize("0.001234 times").x + 2 * ImGui::GetStyle().FramePadding.x;
  ImGui::SetNextItemWidth(std::max((ImGui::GetContentRegionAvail().x - 8) / 3, longest));
  float scale = place->scale;
  if (ImGui::DragFloat("##scale", &scale, 0.01f, 1e-3f, 1e3f, "%.4g times",
                       ImGuiSliderFlags_Logarithmic | ImGuiSliderFlags_NoRoundToFormat))
    *place = scaled_on_foot(file, *place, scale, up_world);
  const bool done = ImGui::IsItemDeactivatedAfterEdit();
  tooltip("It stays on its foot. Drag, or click and type.");
  return done;
}

void placing(UiContext& ui, const SceneSource& file) {
  ScenePlace& place = ui.state.placing.place;
  const Camera camera = ui.studio.viewport().pane_camera();
  const glm::vec3& up_world = ui.studio.document().up_world;
  const std::string trouble = misfit(file, camera, up_world);
  // A thousandth of the scene's size a step.
  bool done = three_numbers("Move", "By how much it stands elsewhere, in scene units", &place.move,
                            0.001f * ui.studio.camera().scene_size(), "%.4g");
  done |= three_numbers("Turn", "About this axis of the scene, around the middle of the file, in degrees",
                        &place.turn_deg, 0.5f, "%.1f");
  done |= scale_number(&place, file, up_world);
  same_line_if_fits("Stand it upright", 4);
  if (button(ui, "Stand it upright",
             "Its own way up, as its file says, of its cameras or guessed, becomes the scene's",
             why_upright(file, place, up_world), false, -1))
    ui.ask(PlaceScene{file.id, stood_upright(file, place, up_world), "stood upright"});
  if (done) ui.ask(PlaceScene{file.id, place});
  ButtonRow row({"Fit", "Bring here", "As in file", "Take out"});
  if (button(ui, "Fit", "Scales it on its foot to half of the picture's height", {}, !trouble.empty(),
             row.next()))
    ui.ask(PlaceScene{file.id, fitted(file, camera, up_world), "fitted"});
  if (button(ui, "Bring here", "Stands it on what lies in the middle of the picture, where the ring is", {},
             false, row.next()))
    ui.ask(BringHere{file.id});
  if (button(ui, "As in file", "Back to its own coordinates",
             file.place == ScenePlace{} ? "It stands there" : "", false, row.next()))
    ui.ask(PlaceScene{file.id, {}});
  if (button(ui, "Take out", "The window's scene goes on without it; the file stays as it is", {}, false,
             row.next()))
    ui.ask(RemoveScene{file.id});
  // Last: it comes and goes while numbers are typed, which shall stay where they are.
  if (!trouble.empty()) wrapped_warning(ui, trouble);
}

void file_row(UiContext& ui, const SceneSource& file, bool first) {
  PlacingChoice& choice = ui.state.placing;
  const bool chosen = choice.file == file.id;
  ImGui::PushID(static_cast<int>(file.id));
  const std::string count = grouped(file.gaussians);
  const float select_width = 54, count_width = ImGui::CalcTextSize(count.c_str()).x;
  ImGui::AlignTextToFramePadding();
  const std::string name = scene_name(file.path) + "##file";
  if (ImGui::Selectable(name.c_str(), chosen && !first, 0,
                        {ImGui::GetContentRegionAvail().x - select_width - count_width - 16, 0}))
    choice.file = chosen || first ? 0 : file.id;
  tooltip(first ? fmt::format("{}\nOpened first: the others stand in its scene", file.path.string())
                : fmt::format("{}\nClick to place it, by handles or numbers", file.path.string()));
  ImGui::SameLine(ImGui::GetWindowContentRegionMax().x - select_width - count_width - 8);
  muted_text(ui, count);
  ImGui::SameLine(ImGui::GetWindowContentRegionMax().x - select_width);
  if (button(ui, "Select", "Adds its Gaussians to the object", {}, false, select_width))
    ui.ask(SelectScene{file.id, ui.studio.view().operation});
  if (chosen && !first) placing(ui, file);
  ImGui::PopID();
}

}  // namespace

void files_panel(UiContext& ui) {
  const OpenedScene* scene = ui.studio.scene();
  if (!scene) return;
  PlacingChoice& choice = ui.state.placing;
  if (scene->files.size() > choice.files_before) {
    ImGui::SetNextItemOpen(true);
    choice.file = scene->files.back().id;
  }
  choice.files_before = scene->files.size();
  choice.open = section(ui, "Files", false);
  if (!choice.open) return;
  const std::vector<SceneSource>& files = scene->files;
  for (const SceneSource& file : files) file_row(ui, file, &file == &files.front());
  if (files.size() > 1 && !scene->file(choice.file))
    wrapped_muted(ui, "Click a file that was added: it gets handles.");
  action_button(ui, Action::kAddScene, fmt::format("{} Add a scene", icon::kPlus).c_str(), false, -1);
}

}  // namespace splatcut
