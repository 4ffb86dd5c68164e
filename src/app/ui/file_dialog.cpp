// The file dialog, the desktop's own or the one inside the window: opening, saving work, pictures, and
// choosing where an export goes.
#include <fmt/format.h>
#include <imgui.h>

#include <imgui_internal.h>  // ClearActiveID
#include <imgui_stdlib.h>    // needs imgui.h first

#include <algorithm>
#include <cstdlib>

#include "app/document/words.h"
#include "app/ui/panels.h"
#include "app/ui/widgets.h"

namespace splatcut {

namespace {

std::string stem_of_scene(const Studio& studio) {
  std::string name = studio.scene() ? scene_name(studio.scene()->scene->path) : "scene";
  return name.substr(0, name.find('.'));
}

void use(UiContext& ui, const std::filesystem::path& path) {
  switch (ui.state.file_purpose) {
    case FilePurpose::kOpen:
      return ui.ask(OpenScene{path});
    case FilePurpose::kAdd:
      return ui.ask(AddScene{path, {}, ui.studio.viewport().looked_at_world()});
    case FilePurpose::kSaveWork:
      return ui.ask(SaveWork{path});
    case FilePurpose::kSnapshot:
      return ui.ask(SaveSnapshot{path, true});
    case FilePurpose::kFill:
      return ui.ask(KeepFill{path});
    case FilePurpose::kTurntable:
      ui.state.turntable.path = path.string();
      ui.state.turntable_open = true;
      return;
    case FilePurpose::kExport:
      ui.state.exporting.path = path.string();
      ui.state.exporting.path_typed = true;
      ui.state.export_open = true;
  }
}

// asked: replacing that very file is wanted.
void use_choice(UiContext& ui, std::filesystem::path path, bool asked) {
  const FilePurpose purpose = ui.state.file_purpose;
  const FileKind kind = kind_of(purpose);
  if (!std::string(kind.extension).empty() && !path.filename().string().ends_with(kind.extension)) {
    path += kind.extension;
    asked = false;
  }
  const bool writes =
      purpose == FilePurpose::kSaveWork || purpose == FilePurpose::kSnapshot || purpose == FilePurpose::kFill;
  std::error_code ignored;
  if (writes && !asked && path != ui.studio.work().work_path() && std::filesystem::exists(path, ignored))
    ui.state.replace_asked = path;
  else
    use(ui, path);
}

// What stands in the field that the button was pressed beside; empty: nothing, or there is none.
std::string field_of_caller(const UiState& state, FilePurpose purpose) {
  if (purpose == FilePurpose::kExport) return state.exporting.path;
  return purpose == FilePurpose::kTurntable ? state.turntable.path : std::string();
}

// The dialog that asked for a path comes back without one.
void back_to_caller(UiContext& ui) {
  if (ui.state.file_purpose == FilePurpose::kExport) ui.state.export_open = true;
  if (ui.state.file_purpose == FilePurpose::kTurntable) ui.state.turntable_open = true;
  ui.state.after_save.reset();
}

void entry_list(FileBrowser& files, float height, bool moved, bool double_clicked, bool* chosen) {
  ImGui::BeginChild("entries", {0, height}, true);
  std::optional<std::filesystem::path> enter;
  for (int i = 0; i < std::ssize(files.entries); ++i) {
    const BrowserEntry& entry = files.entries[static_cast<std::size_t>(i)];
    const bool reached = i == files.cursor;
    const std::string label = fmt::format("{}  {}", entry.folder ? icon::kFolder : icon::kFile, entry.name);
    if (ImGui::Selectable(label.c_str(), reached || entry.name == files.name)) {
      files.go(i);
      if (entry.folder)
        enter = files.folder / entry.name;
      else  // both clicks on it: the first may have been on a folder that it is in; or pressed by Enter
        *chosen |= (double_clicked && reached) || !ImGui::IsMouseReleased(0);
    }
    if (reached && moved) ImGui::SetScrollHereY();
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

// Arrows, Page Up and Down, Home, End and the first letters of a name. True where they moved.
bool keys_in_list(FileBrowser& files) {
  constexpr int kPage = 12;
  const int before = files.cursor;
  const bool typing = ImGui::GetIO().WantTextInput;
  const std::pair<int, int> steps[] = {
      {key::kDown, 1}, {key::kUp, -1}, {key::kPageDown, kPage}, {key::kPageUp, -kPage}};
  for (const auto& [code, step] : steps)
    if (ImGui::IsKeyPressed(code)) files.go(std::max(0, files.cursor + step));
  if (typing) return files.cursor != before;
  if (ImGui::IsKeyPressed(key::kHome)) files.go(0);
  if (ImGui::IsKeyPressed(key::kEnd)) files.go(static_cast<int>(files.entries.size()) - 1);
  if (ImGui::IsKeyPressed(key::kBackspace, false)) files.enter(files.folder.parent_path());
  if (files.saving) return files.cursor != before;  // letters are for the name
  for (const ImWchar letter : ImGui::GetIO().InputQueueCharacters)
    if (letter > ' ' && letter < 127) files.type(std::string(1, static_cast<char>(letter)), ImGui::GetTime());
  return files.cursor != before;
}

// The folder; what is typed into it is a path, or the beginning of a name in the list. Returns true where
// Enter took what was typed: a file, which is chosen then, or a folder.
bool path_field(FileBrowser& files, bool* chosen) {
  ImGui::SetNextItemWidth(-1);
  if (!ImGui::IsWindowAppearing() && std::exchange(files.path_first, false)) ImGui::SetKeyboardFocusHere();
  const bool enter =
      ImGui::InputText("##folder", &files.typed_folder,
                       ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_AutoSelectAll);
  if (ImGui::IsItemEdited()) files.follow_typed();
  if (!enter || !files.typed) return false;
  std::error_code ignored;
  const std::filesystem::path path = files.typed_path();
  if (std::filesystem::is_regular_file(path, ignored)) {  // a whole path, typed or pasted
    files.folder = path.parent_path();
    files.name = path.filename().string();
    *chosen = !files.saving;
    return true;
  }
  if (files.cursor >= 0 && !std::filesystem::is_directory(path, ignored))
    return false;  // the entry that was found by it
  files.enter(path);
  files.path_first = !files.saving;
  return true;
}

// Where people keep things, and where they were before.
void places(UiContext& ui, float height) {
  FileBrowser& files = ui.state.files;
  ImGui::BeginChild("places", {150, height}, true);
  std::vector<std::pair<std::string, std::filesystem::path>> all;
  const auto add = [&all](const char* name, const std::filesystem::path& folder) {
    std::error_code ignored;
    if (std::filesystem::is_directory(folder, ignored)) all.emplace_back(name, folder);
  };
  if (const char* home = std::getenv("HOME")) {
    add("Home", home);
    for (const char* name : {"Desktop", "Documents", "Downloads"})
      add(name, std::filesystem::path(home) / name);
  }
  if (ui.studio.scene())
    add("Scene", std::filesystem::absolute(ui.studio.scene()->scene->path).parent_path());
  const std::size_t fixed = all.size();
  for (const std::filesystem::path& file : ui.state.recent) {
    const std::filesystem::path folder = file.parent_path();
    if (std::ranges::none_of(all, [&](const auto& p) { return p.second == folder; })) add("", folder);
  }
  std::vector<std::filesystem::path> recent;
  for (std::size_t i = fixed; i < all.size(); ++i) recent.push_back(all[i].second);
  const std::vector<std::string> names = names_of_folders(recent);
  for (std::size_t i = fixed; i < all.size(); ++i) all[i].first = names[i - fixed];
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (i == fixed) ImGui::Separator();
    ImGui::PushID(static_cast<int>(i));
    if (ImGui::Selectable(fmt::format("{}  {}", icon::kFolder, all[i].first).c_str(),
                          files.folder == all[i].second))
      files.enter(all[i].second);
    tooltip(all[i].second.string());
    ImGui::PopID();
  }
  ImGui::EndChild();
}

}  // namespace

void open_file_dialog(UiContext& ui, FilePurpose purpose) {
  const FileKind kind = kind_of(purpose);
  FileBrowser& files = ui.state.files;
  ui.state.file_purpose = purpose;
  ui.state.replace_asked.reset();  // that question was about another purpose
  if (purpose != FilePurpose::kSaveWork) ui.state.after_save.reset();
  files.title = kind.title;
  files.extensions = kind.shown;
  files.saving = files.name_first = purpose != FilePurpose::kOpen && purpose != FilePurpose::kAdd;
  files.path_first = !files.saving;
  files.name.clear();
  const std::string stem = stem_of_scene(ui.studio);
  if (purpose == FilePurpose::kSaveWork) files.name = stem + ".splatcut.json";
  if (purpose == FilePurpose::kSnapshot) files.name = stem + ".png";
  if (purpose == FilePurpose::kTurntable) files.name = stem + "_turntable";
  if (purpose == FilePurpose::kFill) files.name = stem + "_fill.ply";
  std::filesystem::path start = files.folder;
  if (const std::filesystem::path field = field_of_caller(ui.state, purpose); !field.empty()) {
    files.name = field.filename().string();
    std::error_code ignored;
    const std::filesystem::path folder = std::filesystem::absolute(field).parent_path();
    if (std::filesystem::is_directory(folder, ignored)) start = folder;
  }
  if (const auto& saved = ui.studio.work().work_path(); purpose == FilePurpose::kSaveWork && !saved.empty()) {
    files.name = saved.filename().string();
    start = saved.parent_path();
  }
  if (start.empty()) {
    start = ui.studio.scene() ? std::filesystem::absolute(ui.studio.scene()->scene->path).parent_path()
                              : std::filesystem::current_path();
    if (files.saving) start = folder_to_write(start);
  }
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
      use_choice(ui, ui.state.native_files.path(), true);
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
  const ImVec2 screen = ImGui::GetIO().DisplaySize;
  if (!begin_dialog((files.title + "###files").c_str(), files.open,
                    {std::min(760.0f, screen.x - 20), std::min(480.0f, screen.y - 20)}))
    return;
  bool chosen = false;
  if (button(ui, icon::kUp, "The folder above")) files.enter(files.folder.parent_path());
  ImGui::SameLine();
  const bool goes = path_field(files, &chosen);
  const bool moved = keys_in_list(files);
  if (moved) {
    files.typed = false;
    if (!files.saving) ImGui::ClearActiveID();  // from now on the list has the keys
  }
  const float height = files.saving ? -80.0f : -44.0f;
  const ImVec2 at = ImGui::GetCursorPos();
  ImGui::SetCursorPosX(at.x + 158);
  entry_list(files, height, moved, ui.state.double_clicked, &chosen);  // Tab comes to it before the places
  ImGui::SetCursorPos(at);
  places(ui, height);
  if (files.saving) {
    if (moved) ImGui::ClearActiveID();  // the field would put its own text back
    ImGui::SetNextItemWidth(-1);
    if (!ImGui::IsWindowAppearing() && std::exchange(files.name_first, false)) ImGui::SetKeyboardFocusHere();
    ImGui::InputText("##name", &files.name, ImGuiInputTextFlags_AutoSelectAll);
    if (ImGui::IsItemEdited()) files.cursor = -1;
  }
  const bool at_folder = files.cursor >= 0 && files.entries[static_cast<std::size_t>(files.cursor)].folder;
  const bool enters = !goes && enter_pressed();
  if (enters && at_folder)
    files.enter(files.folder / files.entries[static_cast<std::size_t>(files.cursor)].name);
  chosen |= enters && !at_folder;
  const FileKind kind = kind_of(ui.state.file_purpose);
  ImGui::BeginChild("buttons", {0, 0}, false, ImGuiWindowFlags_NoScrollbar);  // Tab comes to it last
  const ImVec2 row = ImGui::GetCursorPos();
  ImGui::SetCursorPosX(ImGui::GetWindowWidth() - 110);  // Tab comes to it before Cancel
  const std::string reason = files.name.empty() ? (files.saving ? "Type a name" : "Choose a file") : "";
  chosen |= button(ui, kind.button, kind.title, reason, reason.empty(), 110);
  ImGui::SetCursorPos(row);
  const bool cancelled = plain_button(ui, "Cancel", 110) || escape_pressed();
  ImGui::EndChild();
  chosen &= reason.empty();
  if (chosen || cancelled) {
    files.open = false;
    ImGui::CloseCurrentPopup();
  }
  if (chosen) use_choice(ui, files.folder / files.name, false);
  if (cancelled) back_to_caller(ui);
  ImGui::EndPopup();
}

void replace_dialog(UiContext& ui) {
  if (!begin_dialog("Replace the file?###replace", ui.state.replace_asked.has_value(), {430, 150})) return;
  const std::filesystem::path path = ui.state.replace_asked.value_or("");
  wrapped_muted(ui, path.filename().string() + " is there already. What it holds would be gone.");
  ImGui::SetCursorPosY(ImGui::GetWindowHeight() - 42);
  const bool replaces = plain_button(ui, "Replace", 110);
  ImGui::SameLine(ImGui::GetWindowWidth() - 142);
  const bool keeps = button(ui, "Another name", "The file stays  (Enter)", {}, true, 130) ||
                     (!replaces && (enter_pressed() || escape_pressed()));
  if (replaces || keeps) {
    ui.state.replace_asked.reset();
    ImGui::CloseCurrentPopup();
  }
  ImGui::EndPopup();
  if (replaces) use(ui, path);
  if (keeps && ui.state.native_wanted) open_file_dialog(ui, ui.state.file_purpose);
  if (keeps && !ui.state.native_wanted) ui.state.files.open = ui.state.files.name_first = true;
}

}  // namespace splatcut
