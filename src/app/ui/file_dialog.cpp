// The file dialog, the desktop's own or the one inside the window: opening, saving work, pictures, and
// choosing where an export goes.
#include <fmt/format.h>
#include <imgui.h>

#include <imgui_stdlib.h>  // needs imgui.h first

#include "app/ui/panels.h"
#include "app/ui/widgets.h"

namespace splatcut {

namespace {

std::vector<std::string> with(std::vector<std::string> extensions, const char* one_more) {
  extensions.emplace_back(one_more);
  return extensions;
}

struct Kind {
  const char *title, *button, *extension;  // extension: added where none is given
  std::vector<std::string> shown;
};

Kind kind_of(FilePurpose purpose) {
  switch (purpose) {
    case FilePurpose::kOpen:
      return {"Open a scene or saved work", "Open", "",
              with(extensions_of(scene_formats()), ".splatcut.json")};
    case FilePurpose::kSaveWork:
      return {"Save the work", "Save", ".splatcut.json", {".splatcut.json"}};
    case FilePurpose::kSnapshot:
      return {"Save a picture of the view, with transparency", "Save", ".png", {".png"}};
    case FilePurpose::kTurntable:
      return {"A folder of this name for the turntable pictures", "Choose", "", {"/"}};
    case FilePurpose::kExport:
      return {"Where should it go?", "Choose", "", extensions_of(written_formats())};
  }
  return {};
}

std::string stem_of_scene(const Studio& studio) {
  std::string name = studio.scene() ? studio.scene()->scene->path.filename().string() : "scene";
  return name.substr(0, name.find('.'));
}

void use_choice(UiContext& ui, std::filesystem::path path) {
  const Kind kind = kind_of(ui.state.file_purpose);
  if (!std::string(kind.extension).empty() && !path.filename().string().ends_with(kind.extension))
    path += kind.extension;
  switch (ui.state.file_purpose) {
    case FilePurpose::kOpen:
      return ui.ask(OpenScene{path});
    case FilePurpose::kSaveWork:
      return ui.ask(SaveWork{path});
    case FilePurpose::kSnapshot:
      return ui.ask(SaveSnapshot{path, true});
    case FilePurpose::kTurntable:
      ui.state.turntable.folder = path.string();
      ui.state.turntable_open = true;
      return;
    case FilePurpose::kExport:
      ui.state.exporting.path = path.string();
      ui.state.export_open = true;
  }
}

// The dialog that asked for a path comes back without one.
void back_to_caller(UiContext& ui) {
  if (ui.state.file_purpose == FilePurpose::kExport) ui.state.export_open = true;
  if (ui.state.file_purpose == FilePurpose::kTurntable) ui.state.turntable_open = true;
}

void entry_list(FileBrowser& files, float height, bool* chosen) {
  ImGui::BeginChild("entries", {0, height}, true);
  std::optional<std::filesystem::path> enter;
  for (const BrowserEntry& entry : files.entries) {
    const std::string label = fmt::format("{}  {}", entry.folder ? icon::kFolder : icon::kFile, entry.name);
    if (ImGui::Selectable(label.c_str(), entry.name == files.name, ImGuiSelectableFlags_AllowDoubleClick)) {
      if (entry.folder) {
        enter = files.folder / entry.name;
      } else {
        files.name = entry.name;
        *chosen |= ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left);
      }
    }
    if (entry.folder) continue;
    const std::string size = human_bytes(entry.bytes);
    ImGui::SameLine(ImGui::GetWindowContentRegionMax().x - ImGui::CalcTextSize(size.c_str()).x);
    ImGui::TextDisabled("%s", size.c_str());
  }
  if (files.entries.empty())
    ImGui::TextDisabled("%s", files.trouble.empty() ? "Nothing of this kind here" : files.trouble.c_str());
  ImGui::EndChild();
  if (enter) files.enter(*enter);
}

}  // namespace

void open_file_dialog(UiContext& ui, FilePurpose purpose) {
  const Kind kind = kind_of(purpose);
  FileBrowser& files = ui.state.files;
  ui.state.file_purpose = purpose;
  files.title = kind.title;
  files.extensions = kind.shown;
  files.saving = purpose != FilePurpose::kOpen;
  files.name.clear();
  const std::string stem = stem_of_scene(ui.studio);
  if (purpose == FilePurpose::kSaveWork) files.name = stem + ".splatcut.json";
  if (purpose == FilePurpose::kSnapshot) files.name = stem + ".png";
  if (purpose == FilePurpose::kTurntable) files.name = stem + "_turntable";
  if (purpose == FilePurpose::kExport)
    files.name = std::filesystem::path(ui.state.exporting.path).filename().string();
  std::filesystem::path start = files.folder;
  if (purpose == FilePurpose::kTurntable && !ui.state.turntable.folder.empty()) {
    files.name = std::filesystem::path(ui.state.turntable.folder).filename().string();
    start = std::filesystem::path(ui.state.turntable.folder).parent_path();
  }
  if (start.empty())
    start = ui.studio.scene() ? std::filesystem::absolute(ui.studio.scene()->scene->path).parent_path()
                              : std::filesystem::current_path();
  files.enter(start);
  files.open = !ui.state.native_wanted ||
               !ui.state.native_files.ask(
                   {files.title, files.saving, files.saving ? start / files.name : start, files.extensions});
}

void file_dialog(UiContext& ui) {
  FileBrowser& files = ui.state.files;
  switch (ui.state.native_files.poll()) {
    case NativeDialog::State::kChosen:
      files.folder = ui.state.native_files.path().parent_path();  // where the next one starts
      use_choice(ui, ui.state.native_files.path());
      break;
    case NativeDialog::State::kCancelled:
      back_to_caller(ui);
      break;
    case NativeDialog::State::kFailed:  // no display for it, say: the one inside of the window takes over
      files.open = true;
      break;
    default:
      break;
  }
  const char* id = "###files";
  if (files.open && !ImGui::IsPopupOpen(id)) ImGui::OpenPopup(id);
  const ImVec2 middle = {ImGui::GetIO().DisplaySize.x / 2, ImGui::GetIO().DisplaySize.y / 2};
  ImGui::SetNextWindowPos(middle, ImGuiCond_Always, {0.5f, 0.5f});
  ImGui::SetNextWindowSize({640, 480});
  if (!ImGui::BeginPopupModal((files.title + id).c_str(), nullptr,
                              ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove))
    return;
  bool chosen = false;
  if (button(ui, icon::kUp, "The folder above")) files.enter(files.folder.parent_path());
  ImGui::SameLine();
  ImGui::SetNextItemWidth(-1);
  if (ImGui::InputText("##folder", &files.typed_folder, ImGuiInputTextFlags_EnterReturnsTrue))
    files.enter(files.typed_folder);
  entry_list(files, files.saving ? -80.0f : -44.0f, &chosen);
  if (files.saving) {
    ImGui::SetNextItemWidth(-1);
    chosen |= ImGui::InputText("##name", &files.name, ImGuiInputTextFlags_EnterReturnsTrue);
  }
  const Kind kind = kind_of(ui.state.file_purpose);
  const bool cancelled = ImGui::Button("Cancel", {110, 0}) || ImGui::IsKeyPressed(key::kEscape, false);
  ImGui::SameLine(ImGui::GetWindowWidth() - 122);
  const std::string reason = files.name.empty() ? (files.saving ? "Type a name" : "Choose a file") : "";
  chosen |= button(ui, kind.button, kind.title, reason, reason.empty(), 110);
  chosen &= reason.empty();
  if (chosen || cancelled) {
    files.open = false;
    ImGui::CloseCurrentPopup();
  }
  if (chosen) use_choice(ui, files.folder / files.name);
  if (cancelled) back_to_caller(ui);
  ImGui::EndPopup();
}

}  // namespace splatcut
