// How many pictures of the object turning once, how large, and where they go.
#include <fmt/format.h>
#include <imgui.h>

#include <imgui_stdlib.h>  // needs imgui.h first

#include <algorithm>
#include <array>
#include <utility>

#include "app/console/run_program.h"
#include "app/ui/panels.h"
#include "app/ui/widgets.h"

namespace splatcut {

namespace {

constexpr float kLabels = 90;
constexpr std::array<const char*, 3> kEndings = {"", ".webp", ".mp4"};

void propose(UiContext& ui) {
  TurntableChoice& choice = ui.state.turntable;
  const Camera view = ui.studio.viewport().pane_camera();
  if (choice.width_px <= 0) choice.width_px = view.width_px;
  if (choice.height_px <= 0) choice.height_px = view.height_px;
  if (!choice.path.empty()) return;
  const std::filesystem::path& scene = ui.studio.scene()->scene->path;
  const std::string name = scene.filename().string();
  const std::string ending = kEndings[static_cast<std::size_t>(choice.as)];
  choice.path = free_path(folder_of_next(scene, ui.studio.exports().folder()) /
                              (name.substr(0, name.find('.')) + "_turntable" + ending),
                          ending)
                    .string();
  choice.proposed = choice.path;
}

void label(const char* text) {
  ImGui::AlignTextToFramePadding();
  ImGui::TextUnformatted(text);
  ImGui::SameLine(kLabels);
}

void number(const char* id, int* value, int least, int most) {
  ImGui::SetNextItemWidth(96);
  ImGui::InputInt(id, value, 0);
  *value = std::clamp(*value, least, most);
}

void frames_row(UiContext& ui, TurntableChoice& choice) {
  label("Pictures");
  number("##frames", &choice.frames, 2, 10000);
  for (const int frames : {24, 72, 120}) {
    ImGui::SameLine(0, 4);
    if (button(ui, std::to_string(frames).c_str(), "So many in one turn", {}, choice.frames == frames))
      choice.frames = frames;
  }
}

void picture_size_row(UiContext& ui, TurntableChoice& choice) {
  label("Size");
  number("##width", &choice.width_px, 16, 8192);
  ImGui::SameLine(0, 6);
  ImGui::TextUnformatted("x");
  ImGui::SameLine(0, 6);
  number("##height", &choice.height_px, 16, 8192);
  struct Size {
    const char *name, *tip;
    int width, height;
  };
  const Camera view = ui.studio.viewport().pane_camera();
  for (const Size& s :
       std::array{Size{"View", "As large as the view", view.width_px, view.height_px},
                  Size{"1080p", "1920 x 1080", 1920, 1080}, Size{"Square", "1024 x 1024", 1024, 1024}}) {
    ImGui::SameLine(0, 4);
    if (button(ui, s.name, s.tip, {}, choice.width_px == s.width && choice.height_px == s.height))
      choice.width_px = s.width, choice.height_px = s.height;
  }
}

void as_row(UiContext& ui, TurntableChoice& choice) {
  label("As");
  const bool ffmpeg = on_path("ffmpeg");
  struct As {
    TurntableAs as;
    const char *name, *tip, *reason;
  };
  for (const As& a : std::array{
           As{TurntableAs::kPictures, "Pictures", "A folder of transparent PNGs", ""},
           As{TurntableAs::kWebp, "Animated WebP", "One transparent file, for web pages and chats", ""},
           As{TurntableAs::kVideo, "Video", "A .mp4 over the background, made by ffmpeg",
              ffmpeg ? "" : "ffmpeg is not installed"}}) {
    if (a.as != TurntableAs::kPictures) ImGui::SameLine(0, 2);
    if (!button(ui, a.name, a.tip, a.reason, choice.as == a.as) || choice.as == a.as) continue;
    const TurntableAs before = std::exchange(choice.as, a.as);
    if (choice.path == choice.proposed) {  // what exists under one ending says nothing of the others
      choice.path.clear();
      propose(ui);
      continue;
    }
    const std::string ending = kEndings[static_cast<std::size_t>(before)];
    if (choice.path.ends_with(ending)) choice.path.resize(choice.path.size() - ending.size());
    choice.path += kEndings[static_cast<std::size_t>(a.as)];
  }
  if (choice.as == TurntableAs::kPictures) return;
  ImGui::SameLine(0, 14);
  ImGui::SetNextItemWidth(90);
  ImGui::InputFloat("##seconds", &choice.turn_s, 0, 0, "%.1f s");
  choice.turn_s = std::clamp(choice.turn_s, 0.1f, 600.0f);
  tooltip("How long one turn takes");
}

std::string what_is_written(const TurntableChoice& choice) {
  const std::string camera = " The camera goes round once at the height from which you look. ";
  if (choice.as == TurntableAs::kPictures)
    return fmt::format("frame_0000.png to frame_{:04}.png, the object alone, transparent around it.",
                       choice.frames - 1) +
           camera;
  return (choice.as == TurntableAs::kWebp ? "The object alone, transparent around it, again and again."
                                          : "The object alone over the background.") +
         camera;
}

// A name alone goes to the folder that was proposed.
std::filesystem::path target_of(const TurntableChoice& choice) {
  return typed_in(std::filesystem::path(choice.proposed).parent_path(), choice.path);
}

// What it would write over; pictures have names of their own in their folder.
std::filesystem::path first_written(const TurntableChoice& choice) {
  const std::filesystem::path path = target_of(choice);
  return choice.as == TurntableAs::kPictures ? path / "frame_0000.png" : path;
}

}  // namespace

void turntable_button(UiContext& ui, const char* label, float width) {
  const ObjectItem* active = ui.studio.document().active_object();
  const bool selected = active && ui.studio.gaussians_of(active->id) > 0;
  if (button(ui, label, "Turntable: the object turning once, as pictures, animated WebP, video",
             selected ? "" : "There is no object to turn", false, width)) {
    ui.state.turntable.path.clear();
    ui.state.turntable.overwrite = false;
    ui.state.turntable_open = true;
  }
}

void turntable_dialog(UiContext& ui) {
  const char* id = "Turntable pictures###turntable";
  TurntableChoice& choice = ui.state.turntable;
  if (ui.state.turntable_open && !ImGui::IsPopupOpen(id)) {
    if (!ui.studio.scene()) return;
    propose(ui);
    remember_finish(ui);
  }
  constexpr float kWidth = 560, kHeight = 346, kLine = 26;
  const std::string doubt = ui.studio.scene() ? sides_in_doubt(ui.studio, ExportWhat::kObject) : "";
  if (!begin_dialog(id, ui.state.turntable_open, {kWidth, doubt.empty() ? kHeight : kHeight + kLine})) return;
  const bool typing = typing_beside("##folder");
  as_row(ui, choice);
  frames_row(ui, choice);
  picture_size_row(ui, choice);
  label(choice.as == TurntableAs::kPictures ? "Folder" : "File");
  ImGui::SetNextItemWidth(-44);
  ImGui::InputText("##folder", &choice.path);
  ImGui::SameLine(0, 4);
  const bool browse = button(ui, icon::kFolder, "Choose a folder and name");
  clean_edges_choice(ui);
  const FileViews& views = ui.studio.scene()->views();
  const bool guessed = views.up_is_guess && views.up_world == ui.studio.document().up_world;
  wrapped_muted(ui,
                what_is_written(choice) + (guessed ? " Does it lean? Set what is up under View first." : ""));
  if (!doubt.empty()) wrapped_warning(ui, doubt);
  std::error_code ignored;
  const bool exists = std::filesystem::exists(first_written(choice), ignored);
  if (exists)
    ImGui::Checkbox(choice.as == TurntableAs::kPictures ? "Replace the pictures that are there"
                                                        : "Replace the file that is there",
                    &choice.overwrite);
  const std::string reason = choice.path.empty()           ? "Type where they should go"
                             : !exists || choice.overwrite ? ""
                             : choice.as == TurntableAs::kPictures
                                 ? "Pictures are there: allow replacing them, or change the folder"
                                 : "The file exists: allow replacing it, or change the name";
  const ImVec2 lowest_row = {ImGui::GetCursorPosX(), ImGui::GetWindowHeight() - 42};
  ImGui::SetCursorPos({ImGui::GetWindowWidth() - 122, lowest_row.y});  // Tab comes to it before Cancel
  const bool pressed =
      button(ui, "Save", "Draw and write the pictures  (Enter)", reason, reason.empty(), 110);
  ImGui::SetCursorPos(lowest_row);
  const bool cancelled = plain_button(ui, "Cancel", 110) || (!typing && escape_pressed());
  const bool done = pressed || (reason.empty() && !cancelled && !browse && !typing && enter_pressed());
  if (done)
    ui.ask(SaveTurntable{target_of(choice), choice.frames, choice.width_px, choice.height_px, choice.as,
                         choice.turn_s, ui.studio.view().clean_edges});
  if (done || cancelled) leave_finish(ui, done);
  if (done || cancelled || browse) {
    ui.state.turntable_open = false;
    ImGui::CloseCurrentPopup();
  }
  if (browse) open_file_dialog(ui, FilePurpose::kTurntable);
  ImGui::EndPopup();
}

}  // namespace splatcut
