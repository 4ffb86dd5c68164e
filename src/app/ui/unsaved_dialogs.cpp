// Questions about work that was not saved.
#include <fmt/format.h>
#include <imgui.h>

#include <utility>

#include "app/document/words.h"
#include "app/ui/panels.h"
#include "app/ui/widgets.h"

namespace splatcut {

namespace {

// What to do with work that would be lost.
enum class UnsavedAnswer { kNone, kStay, kGoOn, kSave };

// saves_work: there is work that can be saved first.
UnsavedAnswer unsaved_dialog(UiContext& ui, const char* id, bool wanted, const std::string& text,
                             const char* go_on, bool saves_work) {
  if (!begin_dialog(id, wanted, {430, 150}, Turn::kFirst)) return UnsavedAnswer::kNone;
  wrapped_muted(ui, text);
  ImGui::SetCursorPosY(ImGui::GetWindowHeight() - 42);
  const bool stays = plain_button(ui, "Stay", 100) || escape_pressed();
  ImGui::SameLine();
  const bool goes_on = plain_button(ui, go_on, 100);
  bool saves = false;
  if (saves_work) {
    ImGui::SameLine(ImGui::GetWindowWidth() - 112);
    saves = button(ui, "Save...", "Save the work first  (Enter)", {}, true, 100) ||
            (!goes_on && !stays && enter_pressed());
  }
  if (stays || goes_on || saves) ImGui::CloseCurrentPopup();
  ImGui::EndPopup();
  return stays     ? UnsavedAnswer::kStay
         : goes_on ? UnsavedAnswer::kGoOn
         : saves   ? UnsavedAnswer::kSave
                   : UnsavedAnswer::kNone;
}

// next: opened once the work is saved; none: the program ends then.
void save_first(UiContext& ui, const std::optional<OpenScene>& next) {
  if (next) ui.state.files.folder.clear();  // it is the other scene's
  open_file_dialog(ui, FilePurpose::kSaveWork);
  ui.state.after_save = {next, ui.studio.work().saves(), ui.studio.history().cursor()};
}

// What was exported is no saved work, but nothing of it goes.
std::string what_is_not_saved(const Studio& studio) {
  if (studio.exports().last().empty()) return "The objects and strokes were not saved since they changed. ";
  return studio.exports().have_all()
             ? "The objects are exported, and these files stay. The clicks that made them are not saved. "
             : "The objects and strokes were not saved since they changed; files that were exported stay. ";
}

}  // namespace

void open_anyway_dialog(UiContext& ui) {
  const std::string name = ui.state.open_asked ? scene_name(ui.state.open_asked->path) : "";
  const UnsavedAnswer answer = unsaved_dialog(
      ui, "Open without saving?###open_anyway", ui.state.open_asked.has_value(),
      what_is_not_saved(ui.studio) +
          (ui.studio.work().own_autosave().empty()
               ? fmt::format("That work ends once {} is open; if it cannot be read, the work stays.", name)
               : std::string("A copy is kept all the same and offered in the right panel.")),
      "Open", true);
  if (answer == UnsavedAnswer::kNone) return;
  const std::optional<OpenScene> next = std::exchange(ui.state.open_asked, {});
  if (answer == UnsavedAnswer::kGoOn) ui.state.open_now = next;
  if (answer == UnsavedAnswer::kSave) save_first(ui, next);
}

void quit_dialog(UiContext& ui) {
  const bool unsaved = ui.studio.unsaved();
  const std::string kept = ui.studio.work().own_autosave().empty()
                               ? "That work ends with the program. "
                               : "A copy is kept all the same and offered at the next start. ";
  const std::string work = unsaved ? what_is_not_saved(ui.studio) + kept : "";
  const std::string exported =
      ui.studio.exporting() ? "An export is still being written: it is stopped, and files of before stay."
      : unsaved             ? ""
                            : "The export is written.";
  const UnsavedAnswer answer = unsaved_dialog(ui, unsaved ? "Leave without saving?###quit" : "Leave?###quit",
                                              ui.state.quit_asked, work + exported, "Leave", unsaved);
  if (answer == UnsavedAnswer::kNone) return;
  ui.state.quit_asked = false;
  if (answer == UnsavedAnswer::kGoOn) ui.state.quit_wanted = true;
  if (answer == UnsavedAnswer::kSave) save_first(ui, {});
}

}  // namespace splatcut
