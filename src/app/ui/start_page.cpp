// What the window shows before there is a scene.
#include <fmt/format.h>

#include <algorithm>

#include "app/document/words.h"
#include "app/ui/panels.h"
#include "app/ui/widgets.h"

namespace splatcut {

// A row for each: the whole row restores it, the button at its end throws it away.
void left_work_list(UiContext& ui) {
  constexpr float kThrow = 34;
  constexpr std::size_t kMostShown = 5;
  const std::vector<LeftWork>& offers = ui.studio.work().offers();
  wrapped_muted(ui, "Not saved when the program ended. Click to restore:");
  for (std::size_t i = 0; i < std::min(offers.size(), kMostShown); ++i) {
    const LeftWork& left = offers[i];
    ImGui::PushID(left.file.c_str());
    const float width = ImGui::GetContentRegionAvail().x - kThrow - 4;
    if (button(ui, fmt::format("{}  {}", icon::kRefresh, left.says).c_str(),
               left.scene.string() + "\nStrokes, objects and history, saved by themselves", {}, i == 0,
               width))
      ui.ask(OpenScene{left.file});  // asks where other work would be lost
    ImGui::SameLine(0, 4);
    if (button(ui, icon::kTrash, "Throw that work away", {}, false, kThrow)) ui.ask(DropAutosave{left.file});
    ImGui::PopID();
  }
  if (offers.size() > kMostShown)
    muted_text(ui, fmt::format("and {} older, offered once these are done with", offers.size() - kMostShown));
}

void recent_list(UiContext& ui) {
  for (const auto& path : ui.state.recent) {
    const std::string name = (path.parent_path().filename() / scene_name(path)).string();
    if (ImGui::Selectable((name + "##" + path.string()).c_str())) ui.ask(OpenScene{path});
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
  wrapped_muted(ui, "A 3D Gaussian Splatting scene: " + spoken_extensions(read_formats(), "or") +
                        ". Or a .splatcut.json with saved work. Drop it on this window, or:");
  ImGui::Dummy({0, 4});
  action_button(ui, Action::kOpen, fmt::format("{} Open a file", icon::kOpen).c_str());
  if (!ui.state.sample.empty()) {
    ImGui::SameLine();
    if (button(ui, "Open the sample scene", "A still life on a table, to try things on"))
      ui.ask(OpenScene{ui.state.sample});
  }
  if (!ui.studio.work().offers().empty()) {
    ImGui::Dummy({0, 4});
    left_work_list(ui);
  }
  if (!ui.state.recent.empty()) {
    ImGui::Dummy({0, 6});
    muted_text(ui, "Recent");
    recent_list(ui);
  }
  ImGui::EndChild();
}

}  // namespace splatcut
