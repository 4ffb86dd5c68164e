// What the window shows before there is a scene.
#include <fmt/format.h>

#include <algorithm>

#include "app/document/words.h"
#include "app/ui/panels.h"
#include "app/ui/widgets.h"

namespace splatcut {

void restore_buttons(UiContext& ui) {
  wrapped_muted(ui, "Not saved last time: " + ui.studio.work().autosave_says());
  if (button(ui, fmt::format("{} Restore the work of last time", icon::kRefresh).c_str(),
             "It was saved by itself before the program ended"))
    ui.ask(OpenScene{ui.studio.work().offered()});  // asks where other work would be lost
  ImGui::SameLine(0, 4);
  if (button(ui, icon::kTrash, "Throw that work away")) ui.ask(DropAutosave{});
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
  if (ui.studio.work().autosave_found()) {
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
