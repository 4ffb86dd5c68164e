// What the window shows before there is a scene.
#include <fmt/format.h>

#include <algorithm>

#include "app/document/words.h"
#include "app/ui/panels.h"
#include "app/ui/widgets.h"

namespace splatcut {

namespace {

const ImVec2 kLeftPicture = {64, 42};  // of left work, points

// The middle of it, in a box that is plain where there is no picture. True when clicked.
bool left_picture(UiContext& ui, const LeftWork& left) {
  constexpr std::uint64_t kLeftKey = 2000;  // of the list's textures
  const ImVec2 at = ImGui::GetCursorScreenPos(), end = {at.x + kLeftPicture.x, at.y + kLeftPicture.y};
  ImGui::Dummy(kLeftPicture);
  const bool clicked = ImGui::IsItemClicked();
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddRectFilled(at, end, packed(ui.theme.colour.line, 0.5f), 4);
  if (!left.picture.empty()) {
    const glm::vec2 size(left.picture.width(), left.picture.height());
    const glm::vec2 box(kLeftPicture.x, kLeftPicture.y);
    const glm::vec2 half = 0.5f * box / size / std::max(box.x / size.x, box.y / size.y);
    list.AddImageRounded(ui.renderer.texture(kLeftKey + left.serial, left.serial, left.picture), at, end,
                         {0.5f - half.x, 0.5f - half.y}, {0.5f + half.x, 0.5f + half.y}, 0xffffffffu, 4);
  }
  return clicked;
}

// Time and scene in a line each. Where there is no room for folder and name: what tells it from the others.
std::string left_label(const std::vector<LeftWork>& all, const LeftWork& left, float width) {
  const std::size_t gap = std::min(left.says.find("  "), left.says.size());
  const std::string when = left.says.substr(0, gap);
  const std::string label = when + "\n" + left.says.substr(std::min(gap + 2, left.says.size()));
  if (left.scene.empty() || ImGui::CalcTextSize(label.c_str()).x <= width) return label;
  const bool shared = has_common_name(left.scene) || std::ranges::any_of(all, [&](const LeftWork& other) {
                        return other.scene != left.scene && scene_name(other.scene) == scene_name(left.scene);
                      });
  return when + "\n" + (shared ? telling_folder(left.scene) : scene_name(left.scene));
}

// In place of what can be opened.
void opening(UiContext& ui, float width) {
  ImGui::PushFont(ui.theme.title);
  ImGui::TextWrapped("%s", ui.studio.coming().c_str());
  ImGui::PopFont();
  const TaskThread::Progress progress = ui.studio.progress();
  muted_text(ui, progress.stage);
  progress_bar(ui, progress.fraction, width);
}

// The whole row restores it, the button at its end throws it away.
void left_row(UiContext& ui, const LeftWork& left, bool first) {
  constexpr float kThrow = 34;
  ImGui::PushID(left.file.c_str());
  bool restore = left_picture(ui, left);
  ImGui::SameLine(0, 4);
  const float width = ImGui::GetContentRegionAvail().x - kThrow - 4;
  const ImVec2 padding = ImGui::GetStyle().FramePadding;
  const std::string label = left_label(ui.studio.work().offers(), left, width - 2 * padding.x);
  ImGui::PushStyleVar(ImGuiStyleVar_ButtonTextAlign, {0, 0.5f});
  ImGui::PushStyleVar(ImGuiStyleVar_FramePadding,
                      {padding.x, 0.5f * (kLeftPicture.y - 2 * ImGui::GetFontSize())});
  restore |=
      button(ui, label.c_str(), left.scene.string() + "\nStrokes, objects and history, saved by themselves",
             {}, first, width);
  ImGui::PopStyleVar(2);
  if (restore) ui.ask(OpenScene{left.file});  // asks where other work would be lost
  ImGui::SameLine(0, 4);
  ImGui::PushStyleVar(ImGuiStyleVar_FramePadding,
                      {padding.x, 0.5f * (kLeftPicture.y - ImGui::GetFontSize())});
  if (button(ui, icon::kTrash, "Throw that work away", {}, false, kThrow)) ui.ask(DropAutosave{left.file});
  ImGui::PopStyleVar();
  ImGui::PopID();
}

}  // namespace

// The newest; the rest behind one row. Beside a scene the panel is for its objects: work of others stands
// behind one row, too.
void left_work_list(UiContext& ui) {
  const std::vector<LeftWork>& offers = ui.studio.work().offers();
  const bool in_panel = ui.studio.scene() != nullptr;
  const std::size_t own = in_panel ? ui.studio.work().own_offers() : offers.size();
  const std::size_t newest = std::min(own, in_panel ? std::size_t{2} : std::size_t{3});
  const auto list = [&](std::size_t from, std::size_t to) {
    for (std::size_t i = from; i < to; ++i) left_row(ui, offers[i], i == 0 && own > 0);
  };
  const auto behind = [&](const std::string& row, std::size_t from, std::size_t to) {
    if (from == to) return;
    const bool open =
        ImGui::TreeNodeEx(row.c_str(), ImGuiTreeNodeFlags_NoTreePushOnOpen | ImGuiTreeNodeFlags_FramePadding);
    const ImVec2 min = ImGui::GetItemRectMin(), max = ImGui::GetItemRectMax();
    ui.state.items.push_back({row.substr(0, row.find('#')), {min.x, min.y}, {max.x, max.y}});
    if (open) list(from, to);
  };
  if (own > 0) wrapped_muted(ui, "Unsaved work. Click to restore:");
  list(0, newest);
  behind(fmt::format("{} more###older", own - newest), newest, own);
  const std::size_t others = offers.size() - own;
  std::string row = fmt::format("Unsaved work of other scenes: {}", others);
  const float room = ImGui::GetContentRegionAvail().x - ImGui::GetTreeNodeToLabelSpacing();
  if (ImGui::CalcTextSize(row.c_str()).x > room) row = fmt::format("{} unsaved of other scenes", others);
  behind(row + "###others", own, offers.size());
}

void recent_list(UiContext& ui) {
  for (const auto& path : ui.state.recent) {
    if (ImGui::Selectable((name_in_folder(path) + "##" + path.string()).c_str())) ui.ask(OpenScene{path});
    tooltip(path.string());
  }
}

void start_page(UiContext& ui, const UiRect& area) {
  constexpr float kWidth = 420, kHeight = 330, kMargin = 20;
  const glm::vec2 middle = 0.5f * (area.min + area.max);
  const glm::vec2 size = glm::min(glm::vec2(kWidth, kHeight), area.size() - 2 * kMargin);
  const float top = std::min(std::max(area.min.y + kMargin, middle.y - 150), area.max.y - kMargin - size.y);
  ImGui::SetCursorScreenPos({middle.x - size.x / 2, top});
  ImGui::BeginChild("start", vec(size));
  tooltips_beside_window();  // below an entry it would cover the next
  const auto left_work = [&] {
    if (ui.studio.work().offers().empty()) return;
    ImGui::Dummy({0, 4});
    left_work_list(ui);
  };
  if (!ui.studio.coming().empty()) {
    opening(ui, size.x);
    left_work();
    return ImGui::EndChild();
  }
  ImGui::PushFont(ui.theme.title);
  ImGui::TextUnformatted("Open a scene");
  ImGui::PopFont();
  wrapped_muted(ui, "A 3D Gaussian Splatting scene: " + spoken_endings(read_formats(), "or") +
                        ". Or a .splatcut.json with saved work. Drop it on this window, or:");
  ImGui::Dummy({0, 4});
  action_button(ui, Action::kOpen, fmt::format("{} Open a file", icon::kOpen).c_str());
  if (!ui.state.sample.empty()) {
    ImGui::SameLine();
    if (button(ui, "Open the sample scene", "A still life on a table, to try things on"))
      ui.ask(OpenScene{ui.state.sample});
  }
  left_work();
  if (!ui.state.recent.empty()) {
    ImGui::Dummy({0, 6});
    muted_text(ui, "Recent");
    recent_list(ui);
  }
  ImGui::EndChild();
}

}  // namespace splatcut
