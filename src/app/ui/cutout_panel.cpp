// How the cutout is made: quality, smoothness, stages with their times.
#include <fmt/format.h>

#include <algorithm>

#include "app/ui/panels.h"
#include "app/ui/widgets.h"

namespace splatcut {

namespace {

void quality_choice(UiContext& ui) {
  ImGui::AlignTextToFramePadding();
  ImGui::TextUnformatted("Quality");
  ImGui::SameLine(62);
  const std::string& now = ui.studio.document().preset;
  for (const Preset& preset : presets()) {
    if (&preset != presets().data()) ImGui::SameLine(0, 2);
    ImGui::PushID(preset.name);
    ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, {6, 5});
    if (button(ui, preset.title, preset.sentence, {}, now == preset.name)) ui.ask(SetPreset{preset.name});
    ImGui::PopStyleVar();
    ImGui::PopID();
  }
}

void smoothness_slider(UiContext& ui, const ObjectItem& object) {
  const float usual = preset(ui.studio.document().preset).last_lambda();
  float value = object.smoothness.value_or(usual);
  ImGui::AlignTextToFramePadding();
  ImGui::TextUnformatted("Smoothness");
  ImGui::SameLine(92);
  ImGui::BeginDisabled(object.locked);
  ImGui::SetNextItemWidth(-34);
  if (ImGui::SliderFloat("##smoothness", &value, 0.02f, 50, "%.2f", ImGuiSliderFlags_Logarithmic))
    ui.ask(SetSmoothness{object.id, value});
  tooltip(
      "How much neighbours stay together. Low follows the masks closely, high closes holes and drops stray "
      "bits.");
  ImGui::SameLine(0, 4);
  if (button(ui, icon::kRefresh, fmt::format("Back to the preset's own, {:.2f}", usual),
             object.smoothness ? "" : "It is the preset's own") &&
      object.smoothness)
    ui.ask(SetSmoothness{object.id, usual});
  ImGui::EndDisabled();
}

void stage_list(UiContext& ui, const CutRun& run) {
  double longest = 1;
  for (const StageTime& stage : run.stages) longest = std::max(longest, stage.ms);
  const float width = ImGui::GetContentRegionAvail().x;
  ImDrawList& list = *ImGui::GetWindowDrawList();
  for (const StageTime& stage : run.stages) {
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float bar = static_cast<float>(stage.ms / longest) * (width - 4);
    if (!ui.state.steady)
      list.AddRectFilled({at.x, at.y + 1}, {at.x + bar, at.y + ImGui::GetTextLineHeight() + 3},
                         packed(ui.theme.colour.accent, 0.16f), 3);
    ImGui::Indent(6);
    ImGui::TextUnformatted(stage.name.c_str());
    const std::string ms = ui.state.steady ? "-" : ms_text(stage.ms);
    ImGui::SameLine(width - ImGui::CalcTextSize(ms.c_str()).x);
    muted_text(ui, ms);
    ImGui::Unindent(6);
  }
}

}  // namespace

void cutout_panel(UiContext& ui) {
  if (!section(ui, "Cutout")) return;
  quality_choice(ui);
  const ObjectItem* object = ui.studio.document().active_object();
  if (!object) return wrapped_muted(ui, "Stages and their times appear here after the first click.");
  smoothness_slider(ui, *object);
  const CutRun* run = ui.studio.cut_run(object->id);
  if (!run || (run->stages.empty() && !run->running)) {
    if (object->views.empty()) wrapped_muted(ui, "Made by hand: no strokes to compute from.");
    return;
  }
  if (run->running) {
    const auto progress = ui.studio.progress();
    const ImVec2 at = ImGui::GetCursorScreenPos();
    ImGui::ProgressBar(static_cast<float>(progress.fraction), {-72, 0}, "");
    ImGui::GetWindowDrawList()->AddText({at.x + 8, at.y + 5}, packed(ui.theme.colour.text),
                                        progress.stage.c_str());
    ImGui::SameLine();
    action_button(ui, Action::kCancel, "Cancel", false, -1);
  }
  stage_list(ui, *run);
  if (!run->running && run->total_ms > 0 && !ui.state.steady)
    muted_text(ui,
               fmt::format("first mask {}, cutout {}", ms_text(run->first_mask_ms), ms_text(run->total_ms)));
  const CutResult* result = run->running ? nullptr : run->result.get();
  if (result && result->sizes > 1) {
    muted_text(ui, fmt::format("size {} of {}", result->size + 1, result->sizes));
    tooltip(
        "What the first click can mean, from small to large: the wheel right after the click, Page Up or "
        "Page Down");
  }
  if (!result) return;
  if (result->outcome == Outcome::kNothingFound) wrapped_warning(ui, result->reason);
  for (const std::string& doubt : run->doubts) wrapped_warning(ui, doubt);
}

}  // namespace splatcut
