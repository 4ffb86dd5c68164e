// One line at the bottom: what runs, what is selected, which renderer draws and why.
#include <fmt/format.h>

#include "app/ui/panels.h"
#include "app/ui/stage_words.h"
#include "app/ui/widgets.h"

namespace splatcut {

namespace {

std::string right_text(const UiContext& ui) {
  const Studio& studio = ui.studio;
  std::string text = ui.state.renderer_line;
  if (!studio.scene()) return text;
  return fmt::format("{} Gaussians    {}", grouped(studio.scene()->cloud->size()), text);
}

// For those who wonder why it is slow.
std::string picture_times(const Studio& studio) {
  std::string text;
  if (studio.viewport().still_ms() > 0)
    text = fmt::format("A still picture takes {}", ms_text(studio.viewport().still_ms()));
  if (studio.viewport().moving_ms() > 0)
    text += fmt::format("\nA moving one {} at {:.0f} % of the pixels' sides",
                        ms_text(studio.viewport().moving_ms()), 100 * studio.viewport().moving_scale());
  return text;
}

}  // namespace

std::string status_text(const Studio& studio) {
  if (studio.loading()) return fmt::format("Loading: {}", studio.progress().stage);
  if (!studio.scene()) return "No scene";
  const auto progress = studio.progress();
  if (progress.busy && progress.kind == TaskKind::kPrepare) return "Making a lighter copy to move by";
  if (!progress.stage.empty() && progress.kind == TaskKind::kHover)
    return "Looking at what is under the pointer";
  if (progress.kind == TaskKind::kAhead && !progress.stage.empty()) return "Getting other sizes ready";
  if (progress.kind == TaskKind::kReady && !progress.stage.empty()) return "Getting ready for a click";
  if (const std::string exporting = studio.exports().doing(); progress.busy && !exporting.empty()) {
    const bool before = progress.kind != TaskKind::kExport && progress.kind != TaskKind::kClean;
    return exporting +
           (before && !progress.stage.empty() ? " (first: " + words_of_stage(progress.stage) + ")" : "");
  }
  if (progress.busy) return progress.stage.empty() ? "Working" : "Working: " + words_of_stage(progress.stage);
  return studio.viewport().picture() ? "Ready" : "Drawing the first picture";
}

void status_bar(UiContext& ui) {
  const auto progress = ui.studio.progress();
  ImGui::AlignTextToFramePadding();
  muted_text(ui, status_text(ui.studio));
  if (progress.fraction > 0) {
    ImGui::SameLine();
    progress_bar(ui, progress.fraction, 120);
  }
  const ObjectItem* active = ui.studio.document().active_object();
  if (active) {
    const CutRun* run = ui.studio.cuts().run(active->id);
    const std::string what =
        run && run->running ? "computing" : grouped(ui.studio.gaussians_of(active->id)) + " Gaussians";
    ImGui::SameLine(0, 24);
    ImGui::TextUnformatted(fmt::format("{}: {}", active->name, what).c_str());
  }
  const std::string right = right_text(ui);
  const float x = ImGui::GetWindowWidth() - ImGui::CalcTextSize(right.c_str()).x - 12;
  if (x < ImGui::GetItemRectMax().x - ImGui::GetWindowPos().x + 24) return;  // what is done comes first
  ImGui::SameLine(x);
  muted_text(ui, right);
  tooltip(picture_times(ui.studio));
}

}  // namespace splatcut
