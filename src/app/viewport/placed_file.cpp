// An added file while it is placed: its box, some of its Gaussians where they would stand, handles.
#include "app/ui/splat_dots.h"
#include "app/viewport/on_screen.h"
#include "app/viewport/viewport_pane.h"

namespace splatcut {

namespace {

const std::vector<std::uint32_t>& sample_of(PlacingChoice* choice, const OpenedScene& scene,
                                            const SceneSource& file) {
  constexpr std::size_t kMost = 4000;
  if (choice->sample_scene == scene.serial && choice->sample_file == file.id) return choice->sample;
  choice->sample = some_of(gaussians_of(scene, file.id), kMost);
  choice->sample_scene = scene.serial;
  choice->sample_file = file.id;
  return choice->sample;
}

void draw_box(const SceneSource& file, const Similarity& to, const Camera& camera, const Theme& theme) {
  const Volume box{false, moved(file.solid.centre(), to), 0.5f * to.scale * file.solid.extent(), to.rotation};
  for (const auto& [from, end] : edges_px(box, camera))
    ImGui::GetWindowDrawList()->AddLine({from.x, from.y}, {end.x, end.y}, packed(theme.colour.accent, 0.8f),
                                        1.5f);
}

// Not while a number of it is dragged or typed. Before the scene has followed it is the place to come, so
// that what is typed meanwhile begins there.
void take_place(UiContext& ui, const SceneSource& file) {
  PlacingChoice& choice = ui.state.placing;
  if (!choice.grips.drag && !ImGui::IsAnyItemActive()) choice.place = ui.studio.files().place_to_be(file.id);
}

// Where "Bring here" stands the file: what the middle of the picture shows.
void draw_middle(UiContext& ui, const UiRect& area) {
  constexpr float kRadius = 7, kArmEnd = 13;
  const glm::vec2 middle = 0.5f * (area.min + area.max);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const ImVec2 at(middle.x, middle.y);
  for (const auto& [ink, wider] :
       {std::pair(IM_COL32(0, 0, 0, 150), 2.5f), {packed(ui.theme.colour.accent), 0.0f}}) {
    list.AddCircle(at, kRadius, ink, 0, 1.6f + wider);
    for (const glm::vec2& arm : {glm::vec2(1, 0), {-1, 0}, {0, 1}, {0, -1}})
      list.AddLine({at.x + kRadius * arm.x, at.y + kRadius * arm.y},
                   {at.x + kArmEnd * arm.x, at.y + kArmEnd * arm.y}, ink, 1.6f + wider);
  }
  ui.state.items.push_back({"middle", middle - kArmEnd, middle + kArmEnd});
}

}  // namespace

void draw_placed_file(UiContext& ui, const UiRect& area) {
  PlacingChoice& choice = ui.state.placing;
  const SceneSource* file = ui.studio.scene()->file(choice.file);
  choice.grips.shown.clear();
  if (const std::uint32_t now = file && choice.open ? file->id : 0; now != ui.studio.viewport().placed_file())
    ui.ask(ShowPlaced{now});
  if (!file || !choice.open) return choice.grips.drag.reset();
  take_place(ui, *file);
  SceneSource there = *file;
  there.place = choice.place;
  const Camera camera =
      in_window_points(ui.studio.viewport().pane_camera(), area.min, ui.theme.pixels_per_point);
  const Similarity to = similarity_of(there);
  if (there.place != file->place)
    draw_dots(*ui.studio.scene()->cloud, sample_of(&choice, *ui.studio.scene(), *file),
              similarity_between(*file, there), camera, area);
  draw_box(there, to, camera, ui.theme);
  if (ui.studio.loading()) return choice.grips.drag.reset();
  if (!choice.grips.drag) draw_middle(ui, area);
  const std::vector<glm::vec3> axes = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  PlacingHandles shown{.centre_world = to.move, .arrow_axes = axes, .turn_axes = axes};
  shown.turned_deg = {choice.place.turn_deg.x, choice.place.turn_deg.y, choice.place.turn_deg.z};
  shown.scaled = choice.place.scale;
  const bool free = ImGui::IsWindowHovered() && !ImGui::IsAnyItemHovered();
  const GripsMoved hand = grips(&choice.grips, shown, camera, free, ui.theme);
  if (hand.began) choice.before = choice.place;
  if (hand.change) choice.place = changed(*file, choice.before, *hand.change, ui.studio.document().up_world);
  if (hand.done && choice.place != file->place) ui.ask(PlaceScene{file->id, choice.place});
}

}  // namespace splatcut
