// How the cutout is made: method, smoothness, stages with their times; what runs, and what is in doubt.
#include <fmt/format.h>

#include <algorithm>

#include "app/picture/cut_sentences.h"
#include "app/ui/panels.h"
#include "app/ui/stage_words.h"
#include "app/ui/widgets.h"

namespace splatcut {

namespace {

// The energy that the cut minimises.
void method_choice(UiContext& ui) {
  ImGui::AlignTextToFramePadding();
  ImGui::TextUnformatted("Method");
  ImGui::SameLine(62);
  const std::string& now = ui.studio.document().preset;
  const auto taken = std::ranges::find_if(presets(), [&](const Preset& p) { return now == p.name; });
  const std::string label = fmt::format("{} {}", taken->title, icon::kDown);
  if (button(ui, label.c_str(), "The others are there for comparison with the paper"))
    ImGui::OpenPopup("method");
  if (!ImGui::BeginPopup("method")) return;
  for (const Preset& preset : presets()) {
    if (ImGui::MenuItem(preset.title, nullptr, now == preset.name)) ui.ask(SetPreset{preset.name});
    tooltip(preset.sentence);
  }
  ImGui::EndPopup();
}

// The number stands beside the slider, not under its handle: in a narrow panel above it.
void slider_label(const std::string& text) {
  constexpr float kBeside = 124, kRoomForBoth = 240;
  ImGui::AlignTextToFramePadding();
  ImGui::TextUnformatted(text.c_str());
  if (ImGui::GetContentRegionAvail().x >= kRoomForBoth) ImGui::SameLine(kBeside);
  ImGui::SetNextItemWidth(-34);
}

// How far from what the click likely means: each meaning has its own number of sizes, which says nothing.
std::string size_beside(int steps) {
  return steps == 0 ? "as clicked" : fmt::format("{} {}", std::abs(steps), steps > 0 ? "larger" : "smaller");
}

// A step for each size that the last click can have, the smallest at the left. The picture outlines the step
// that the pointer is at; it is taken when the button is let go. While the sizes are not known its place is
// kept, so that what is below does not move.
void size_slider(UiContext& ui, const ObjectItem& object) {
  if (object.views.empty()) return;
  const StrokeSizes* known = ui.studio.clicks().known_sizes();
  if (!known || known->count() < 2) {
    const std::string why = ui.studio.clicks().why_not_step(1);
    slider_label("Part");
    ImGui::BeginDisabled();
    int none = 0;
    ImGui::SliderInt("##size", &none, 0, 1, "", ImGuiSliderFlags_NoInput);
    ImGui::EndDisabled();
    return tooltip(why.empty()
                       ? "Sizes of the last click, or of the box that began the object, once they are known"
                       : why);
  }
  const auto sizes = static_cast<int>(known->count()),
             taken = static_cast<int>(ui.studio.clicks().size_wanted());
  const bool away = last_takes_away(object.views);
  slider_label((away ? "Away  " : "Part  ") + size_beside(taken - static_cast<int>(known->likeliest)));
  ImGui::BeginDisabled(object.locked);
  const float from = ImGui::GetCursorScreenPos().x, width = ImGui::CalcItemWidth();
  int step = taken + 1;
  // It stands at the size that is taken, so the step is read off the pointer.
  ImGui::SliderInt("##size", &step, 1, sizes, "", ImGuiSliderFlags_NoInput);
  const float share = (ImGui::GetIO().MousePos.x - from) / width;
  const int pointed = std::clamp(static_cast<int>(share * static_cast<float>(sizes)), 0, sizes - 1);
  if (ImGui::IsItemHovered() || ImGui::IsItemActive())
    ui.state.size_pointed = static_cast<std::size_t>(pointed);
  if (ImGui::IsItemDeactivated() && pointed != taken) ui.ask(StepScale{pointed - taken});
  ImGui::EndDisabled();
  const char* direction = away ? " away" : "";
  tooltip(pointed == taken
              ? fmt::format("The part that the last click takes{}", direction)
              : fmt::format("Take the part {}{}  (wheel after the click, Page Up, Page Down)",
                            size_beside(pointed - static_cast<int>(known->likeliest)), direction));
}

void smoothness_slider(UiContext& ui, const ObjectItem& object) {
  const float usual = preset(ui.studio.document().preset).last_lambda();
  float value = object.smoothness.value_or(usual);
  slider_label(fmt::format("Smoothness  {:.2f}", value));
  ImGui::BeginDisabled(object.locked);
  if (slider_without_text("##smoothness", &value, 0.02f, 50, "%.2f", ImGuiSliderFlags_Logarithmic))
    ui.ask(SetSmoothness{object.id, value});
  tooltip(
      "How much neighbours stay together. Low follows the masks closely, high closes holes and drops stray "
      "bits.");
  ImGui::SameLine(0, 4);
  if (button(ui, icon::kRefresh, fmt::format("Back to the preset's own, {:.2f}", usual),
             object.smoothness ? "" : "It is the preset's own") &&
      object.smoothness)
    ui.ask(SetSmoothness{object.id, {}});
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
    ImGui::TextUnformatted(words_of_stage(stage.name).c_str());
    const std::string ms = ui.state.steady ? "-" : ms_text(stage.ms);
    ImGui::SameLine(width - ImGui::CalcTextSize(ms.c_str()).x);
    muted_text(ui, ms);
    ImGui::Unindent(6);
  }
}

// How long each stage took: for those who wonder. The row stays where nothing is known, for those below it.
void times(UiContext& ui, const CutRun* known) {
  if (!ImGui::TreeNodeEx("Times", ImGuiTreeNodeFlags_NoTreePushOnOpen)) return;
  if (!known || known->stages.empty()) return muted_text(ui, "Nothing was computed for this.");
  const CutRun& run = *known;
  stage_list(ui, run);
  if (!run.running && run.total_ms > 0 && !ui.state.steady)
    muted_text(ui, fmt::format("first shown after {}, done after {}", ms_text(run.first_mask_ms),
                               ms_text(run.total_ms)));
}

bool is_shown(const std::string& doubt, bool thumbnails) {
  return thumbnails || doubt != kDoubtOfSides;
}

// The doubts, and a button to come nearer if the object is too small to see.
void warnings(UiContext& ui, const CutRun& run, bool thumbnails) {
  bool too_far = run.result->outcome == Outcome::kNothingFound;
  if (too_far) wrapped_warning(ui, run.result->reason);
  for (const std::string& doubt : run.doubts) {
    if (!is_shown(doubt, thumbnails)) continue;
    wrapped_warning(ui, as_sentence(doubt));
    too_far |= doubt.ends_with("come nearer");
  }
  if (too_far) come_nearer_button(ui, -1);
}

// The text for an object that was not cut yet.
std::string why_no_cutout(const Studio& studio, const ObjectItem& object) {
  if (!object.views.empty()) return "";
  return studio.gaussians_of(object.id) == 0 ? "Empty: click it in the picture."
                                             : "Made by hand: no strokes to compute from.";
}

}  // namespace

void cutout_panel(UiContext& ui) {
  ui.state.size_pointed.reset();
  if (!section(ui, "Cutout")) return;
  method_choice(ui);
  const ObjectItem* object = ui.studio.document().active_object();
  if (!object) return wrapped_muted(ui, "Click an object in the picture.");
  size_slider(ui, *object);
  smoothness_slider(ui, *object);
  if (const std::string reason = why_no_cutout(ui.studio, *object); !reason.empty())
    return wrapped_muted(ui, reason);
  if (ui.studio.cuts().given_up(*object))
    wrapped_muted(ui, "The last strokes were not computed: R computes them.");
  times(ui, ui.studio.cuts().run(object->id));
}

bool has_cut_notes(const Studio& studio, bool thumbnails) {
  const CutRun* run = studio.cuts().run(studio.document().active);
  if (!run) return false;
  const auto shown = [&](const std::string& doubt) { return is_shown(doubt, thumbnails); };
  return run->running || (run->result && (run->result->outcome == Outcome::kNothingFound ||
                                          std::ranges::any_of(run->doubts, shown)));
}

void cut_notes(UiContext& ui, bool thumbnails) {
  const CutRun* run = ui.studio.cuts().run(ui.studio.document().active);
  if (!run) return;
  if (!run->running) {
    if (run->result) warnings(ui, *run, thumbnails);
    return;
  }
  const auto progress = ui.studio.progress();
  const ImVec2 at = ImGui::GetCursorScreenPos();
  ImGui::ProgressBar(static_cast<float>(progress.fraction), {-72, 0}, "");
  ImGui::GetWindowDrawList()->AddText({at.x + 8, at.y + 5}, packed(ui.theme.colour.text),
                                      words_of_stage(progress.stage).c_str());
  ImGui::SameLine();
  action_button(ui, Action::kCancel, "Cancel", false, -1);
}

}  // namespace splatcut
