// The dialog of an export.
#include <fmt/format.h>
#include <imgui.h>

#include <imgui_internal.h>  // GetActiveID
#include <imgui_stdlib.h>    // needs imgui.h first

#include <span>
#include <utility>

#include "app/document/words.h"
#include "app/ui/panels.h"
#include "app/ui/widgets.h"
#include "segment/finish/shown_part.h"

namespace splatcut {

namespace {

constexpr const char* kWhatNames[] = {"The object", "Everything else", "The whole scene",
                                      "All objects, a file each", "All objects, one file"};

std::size_t gaussians_to_export(const Studio& studio, ExportWhat what) {
  const Document& document = studio.document();
  const std::size_t object = studio.gaussians_of(document.active);
  if (what == ExportWhat::kObject) return object;
  if (what == ExportWhat::kRest || what == ExportWhat::kScene) {
    const std::size_t deleted = document.deleted ? count_flags(*document.deleted) : 0;
    return studio.scene()->cloud->size() - (what == ExportWhat::kRest ? object : 0) - deleted;
  }
  std::size_t sum = 0;
  for (const ObjectItem& item : document.objects) sum += studio.gaussians_of(item.id);
  return sum;
}

// What several objects have counts once: looked for once for each state of the document.
std::size_t gaussians_in_one(UiContext& ui) {
  const std::uint64_t serial = ui.studio.history().serial();
  ExportChoice& choice = ui.state.exporting;
  if (std::exchange(choice.counted_at, serial) != serial)
    choice.in_one = count_flags(exported(ui.studio.document(), 0, ExportWhat::kOneFile,
                                         ui.studio.scene()->cloud->size(), ui.studio.label_cache()));
  return choice.in_one;
}

EdgesKnown edges_known(const Studio& studio, ExportWhat what) {
  EdgesKnown known;
  known.clean = studio.view().clean_edges && what != ExportWhat::kScene && what != ExportWhat::kOneFile;
  if (!known.clean) return known;
  const Document& document = studio.document();
  for (const ObjectItem& item : document.objects)
    if ((what == ExportWhat::kAllObjects || item.id == document.active) && studio.gaussians_of(item.id) > 0)
      known.count(studio.clean_edges(item.id), item.name);
  return known;
}

HoleKnown hole_known(const Studio& studio, ExportWhat what) {
  if (what != ExportWhat::kRest || !studio.view().fill_hole) return {};
  return {true, studio.finish().without()};
}

void propose_path(UiContext& ui) {
  ExportChoice& choice = ui.state.exporting;
  choice.path = proposed_path(choice, ui.studio.scene()->scene->path, ui.studio.document().active_object(),
                              ui.studio.exports().folder());
  choice.folder = std::filesystem::path(choice.path).parent_path();
  choice.path_typed = false;
}

// A path that was typed or chosen stays, but for an ending that a folder does not have.
void choose_what(UiContext& ui, ExportWhat what) {
  ExportChoice& choice = ui.state.exporting;
  choice.what = what;
  choice.overwrite = false;  // with other content it is asked anew
  if (!choice.path_typed) return propose_path(ui);
  if (what == ExportWhat::kAllObjects && choice.path.ends_with(choice.format.extension))
    choice.path.resize(choice.path.size() - std::string_view(choice.format.extension).size());
}

// What pressing Export asks for.
ExportRequest request_of(const UiContext& ui) {
  const ExportChoice& choice = ui.state.exporting;
  return {choice.what,
          choice.format,
          target_of(choice),
          choice.overwrite,
          choice.placement,
          ui.studio.view().clean_edges,
          ui.studio.view().fill_hole};
}

// Why the last try failed is told of what was tried alone.
void forget_trouble_of_another_try(ExportChoice& choice, const ExportRequest& now) {
  if (choice.trouble.empty()) return;
  if (!choice.tried) choice.tried = now;
  if (*choice.tried == now) return;
  choice.trouble.clear();
  choice.tried.reset();
}

void fact(const char* symbol, const ImVec4& colour, const std::string& text) {
  ImGui::PushStyleColor(ImGuiCol_Text, colour);
  ImGui::TextUnformatted(symbol);
  ImGui::PopStyleColor();
  ImGui::SameLine(34);
  ImGui::PushTextWrapPos(0);
  ImGui::TextUnformatted(text.c_str());
  ImGui::PopTextWrapPos();
}

// Of the column: ImGui's own separator spans all of them.
void line_across(const Palette& palette) {
  const ImVec2 at = ImGui::GetCursorScreenPos();
  ImGui::GetWindowDrawList()->AddLine(at, {at.x + ImGui::GetContentRegionAvail().x, at.y},
                                      packed(palette.line));
  ImGui::Dummy({0, 2});
}

// The name without folder and extension is what is typed over; a whole path typed there replaces these, too,
// and an extension the old one.
int mark_name(ImGuiInputTextCallbackData* data) {
  ExportChoice& choice = *static_cast<ExportChoice*>(data->UserData);
  const std::string_view path(data->Buf, static_cast<std::size_t>(data->BufTextLen));
  const std::string_view ending = choice.what == ExportWhat::kAllObjects ? "" : choice.format.extension;
  const auto cursor = static_cast<std::size_t>(data->CursorPos);
  if (!data->HasSelection()) {
    const std::string folder = std::exchange(choice.marked_folder, {});
    const bool whole = !folder.empty() && path.starts_with(folder + "/");
    const bool before_ending = !ending.empty() && path.substr(cursor) == ending;
    if (before_ending && (whole || names_written_format(path.substr(0, cursor))))
      data->DeleteChars(data->CursorPos, static_cast<int>(ending.size()));
    if (whole) data->DeleteChars(0, static_cast<int>(folder.size()));
  }
  if (!std::exchange(choice.name_first, false)) return 0;
  data->SelectionStart = static_cast<int>(path.rfind('/') + 1);
  data->SelectionEnd = data->BufTextLen - static_cast<int>(path.ends_with(ending) ? ending.size() : 0);
  data->CursorPos = data->SelectionEnd;
  choice.marked_folder = path.substr(0, path.rfind('/') + 1);
  return 0;
}

void export_choices(UiContext& ui) {
  ExportChoice& choice = ui.state.exporting;
  ImGui::AlignTextToFramePadding();
  ImGui::TextUnformatted("What");
  const ObjectItem* active = ui.studio.document().active_object();
  const std::string no_object = active ? "" : "There is no object yet";
  constexpr int kFirstOfAll = 3;  // of a second row
  for (int i = 0; i < 5; ++i) {
    if (i == kFirstOfAll)
      ImGui::SetCursorPosX(90);
    else
      ImGui::SameLine(i == 0 ? 90.0f : 0.0f, i == 0 ? -1.0f : 2.0f);
    const auto what = static_cast<ExportWhat>(i);
    if (button(ui, kWhatNames[i], "", what == ExportWhat::kScene ? "" : no_object, choice.what == what))
      choose_what(ui, what);
  }
  ImGui::AlignTextToFramePadding();
  ImGui::TextUnformatted("Format");
  for (const SceneFormat& format : written_formats()) {
    const bool first = format == written_formats().front();
    ImGui::SameLine(first ? 90.0f : 0.0f, first ? -1.0f : 2.0f);
    if (button(ui, format.extension, format.name, {}, choice.format == format)) {
      choice.format = format;
      if (choice.what != ExportWhat::kAllObjects) choice.path = with_extension(choice.path, format).string();
    }
  }
  ImGui::AlignTextToFramePadding();
  ImGui::TextUnformatted(choice.what == ExportWhat::kAllObjects ? "Folder" : "File");
  ImGui::SameLine(90);
  ImGui::SetNextItemWidth(-44);
  if (choice.name_first && !ImGui::IsWindowAppearing() && ImGui::GetActiveID() != ImGui::GetID("##path"))
    ImGui::SetKeyboardFocusHere();
  if (ImGui::InputText("##path", &choice.path, ImGuiInputTextFlags_CallbackAlways, mark_name, &choice)) {
    choice.path_typed = true;
    follow_typed_name(choice);
  }
  ImGui::SameLine(0, 4);
  if (button(ui, icon::kFolder, "Choose a folder and name")) {
    ui.state.export_open = false;
    ImGui::CloseCurrentPopup();
    open_file_dialog(ui, FilePurpose::kExport);
  }
}

void placement_row(const char* text) {
  ImGui::AlignTextToFramePadding();
  ImGui::TextUnformatted(text);
  ImGui::SameLine(90);
}

// A number that can be typed or dragged.
bool placement_number(const char* id, float* value, float step, const char* format, float width) {
  ImGui::SetNextItemWidth(width);
  return ImGui::DragFloat(id, value, step, 0, 0, format);
}

template <class Choice>
void placement_choice(UiContext& ui, Choice* now, std::span<const std::pair<Choice, const char*>> choices,
                      const char* tip) {
  for (const auto& [choice, name] : choices) {
    if (&choice != &choices.front().first) ImGui::SameLine(0, 2);
    if (button(ui, name, tip, {}, *now == choice)) *now = choice;
  }
}

// A placement moves in the axes of a .ply; shown and typed are those of the file, which the preview shows,
// too.
void move_numbers(UiContext& ui) {
  constexpr const char *kIds[] = {"##x", "##y", "##z"}, *kFormats[] = {"x %.4g", "y %.4g", "z %.4g"};
  ExportChoice& choice = ui.state.exporting;
  const AxisSigns& axes = choice.format.axes;
  glm::vec3 in_file = axes.position(choice.placement.move) + 0.0f;  // no -0
  for (int i = 0; i < 3; ++i) {
    ImGui::SameLine(0, i == 0 ? 14.0f : 2.0f);
    if (placement_number(kIds[i], &in_file[i], 0.01f, kFormats[i], 84))
      choice.placement.move = axes.position(in_file) + 0.0f;
    tooltip("Added to every position of the file, after all else. Drag, or click and type.");
  }
}

// Where the Gaussians stand in the file.
void placement_choices(UiContext& ui) {
  constexpr std::pair<ExportOrigin, const char*> kOrigins[] = {{ExportOrigin::kScene, "As in the scene"},
                                                               {ExportOrigin::kCentre, "Its middle"},
                                                               {ExportOrigin::kFoot, "Its foot"}};
  constexpr std::pair<ExportUp, const char*> kUps[] = {{ExportUp::kScene, "As in the scene##up"},
                                                       {ExportUp::kPlusY, "+Y"},
                                                       {ExportUp::kMinusY, "-Y"},
                                                       {ExportUp::kPlusZ, "+Z"}};
  ExportPlacement& p = ui.state.exporting.placement;
  placement_row("Origin");
  placement_choice<ExportOrigin>(ui, &p.origin, kOrigins, "What lies at 0, 0, 0 of the file");
  placement_row("Up");
  placement_choice<ExportUp>(ui, &p.up, kUps, "Where the scene's up (see View) points in the file");
  ImGui::SameLine(0, 14);
  placement_number("##turn", &p.turn_deg, 1, "turn %.1f deg", 110);
  tooltip("About that axis. Drag, or click and type.");
  placement_row("Scale, move");
  placement_number("##scale", &p.scale, 0.01f, "%.4g times", 90);
  tooltip("Every length of the file times this. Drag, or click and type.");
  move_numbers(ui);
  if (p == ExportPlacement{}) return;
  ImGui::SameLine(0, 6);
  if (button(ui, icon::kUndo, "Back to where it stands in the scene")) p = {};
}

// Rows of objects are then written anew; the rest keeps its own.
bool cleans_objects(const UiContext& ui) {
  const ExportWhat what = ui.state.exporting.what;
  return ui.studio.view().clean_edges && (what == ExportWhat::kObject || what == ExportWhat::kAllObjects);
}

// Made once for each choice: it looks at all Gaussians. Of an object with clean edges it takes any that make
// as many as stay, as what it says of them are shares.
const FormatPlan& export_plan(UiContext& ui, std::size_t gaussians) {
  ExportChoice& choice = ui.state.exporting;
  const bool moved = choice.placement != ExportPlacement{} || cleans_objects(ui);
  const Document& document = ui.studio.document();
  const OpenedScene& scene = *ui.studio.scene();
  std::string key =
      fmt::format("{} {} {} {} {} {} {}", scene.serial, ui.studio.history().serial(), document.active,
                  static_cast<int>(choice.what), gaussians, choice.format.name, moved);
  if (choice.plan_key != key) {
    std::vector<std::uint32_t> rows;
    const auto add = [&](const std::vector<std::uint8_t>& labels) {
      const std::vector<std::uint32_t> some = labelled_rows(labels);
      rows.insert(rows.end(), some.begin(), some.end());
    };
    if (choice.what == ExportWhat::kAllObjects)
      visit_objects(
          document, scene.cloud->size(), [&](const ObjectToSave& o) { add(o.labels); },
          ui.studio.label_cache());
    else
      add(exported(document, document.active, choice.what, scene.cloud->size(), ui.studio.label_cache()));
    const std::size_t own = rows.size();
    rows.resize(std::min(own, gaussians));
    choice.plan = choice.format.plan(*scene.scene, rows, moved);
    if (gaussians > own && own > 0)  // what fills a hole comes beside
      choice.plan.bytes = choice.plan.bytes * gaussians / own;
    choice.plan.bytes += bytes_of_numbers(choice, gaussians);
    choice.plan_key = std::move(key);
  }
  return choice.plan;
}
}  // namespace

void export_dialog(UiContext& ui) {
  const char* id = "Export###export";
  if (ui.state.export_open && !ImGui::IsPopupOpen(id)) {
    if (!ui.studio.scene()) return;
    ExportChoice& choice = ui.state.exporting;
    const bool object = ui.studio.document().active_object() != nullptr;
    if (object && std::exchange(choice.for_want_of_object, false)) choice.what = ExportWhat::kObject;
    if (!object && choice.what != ExportWhat::kScene) {
      choice.what = ExportWhat::kScene;
      choice.for_want_of_object = true;
    }
    if (ui.state.exporting.path.empty()) propose_path(ui);
    remember_finish(ui);
  }
  constexpr float kWidth = 640, kHeight = 510, kPreview = 330;
  const bool previews = ImGui::GetIO().DisplaySize.x >= kWidth + kPreview;
  if (!begin_dialog(id, ui.state.export_open, {previews ? kWidth + kPreview : kWidth, kHeight})) return;
  const bool dragging = ui.state.export_preview.grips.drag.has_value();  // Esc is for that
  const bool typing = typing_beside("##path");
  if (previews) {
    ImGui::Columns(2, "sides", false);
    ImGui::SetColumnWidth(0, kWidth);
  }
  export_choices(ui);
  const float below_names = ImGui::GetCursorPosY();
  placement_choices(ui);
  ExportChoice& choice = ui.state.exporting;
  if (choice.what == ExportWhat::kRest) {
    fill_hole_choice(ui);
    ImGui::SameLine();
  }
  clean_edges_choice(ui, choice.what == ExportWhat::kScene ? "The whole scene is written as it is"
                         : choice.what == ExportWhat::kOneFile
                             ? "All objects in one file are written as they are"
                             : "");
  if (!previews) {  // a small one, right of the numbers
    constexpr float kSmall = 118;
    const ImVec2 after = ImGui::GetCursorPos();
    ImGui::SetCursorPos({ImGui::GetWindowWidth() - kSmall - 12, below_names});
    export_preview(ui, {kSmall, after.y - below_names - ImGui::GetStyle().ItemSpacing.y});
    ImGui::SetCursorPos(after);
  }
  const std::size_t gaussians = choice.what == ExportWhat::kOneFile
                                    ? gaussians_in_one(ui)
                                    : gaussians_to_export(ui.studio, choice.what);
  const EdgesKnown edges = edges_known(ui.studio, choice.what);
  const HoleKnown hole = hole_known(ui.studio, choice.what);
  const FormatPlan& plan = export_plan(ui, left_to_write(choice, gaussians, edges, hole));
  const Palette& p = ui.theme.colour;
  line_across(p);
  fact(icon::kInfo, p.accent, amount_text(choice, gaussians, edges, hole, plan));
  if (const std::string whose = whose_text(ui.studio.document(), choice.what); !whose.empty())
    fact(icon::kInfo, p.accent, whose);
  const std::string changes = changes_text(choice, edges, hole);
  fact(icon::kCheck, p.good, kept_text(choice, plan, changes));
  for (const std::string& text :
       {numbers_text(choice), moved_text(choice.placement), edges_stay_text(edges), changes})
    if (!text.empty()) fact(icon::kInfo, p.accent, text);
  if (const std::string doubt = sides_in_doubt(ui.studio, choice.what); !doubt.empty())
    fact(icon::kWarning, p.warn, doubt);
  if (const std::string why = hole.why_not(); !why.empty())
    fact(icon::kWarning, p.warn, "The hole stays: " + why + ".");
  if (const std::string lost = loss_text(choice, edges, hole, plan); !lost.empty())
    fact(plan.lost.empty() ? icon::kCheck : icon::kWarning, plan.lost.empty() ? p.good : p.warn, lost);
  const ExportRequest request = request_of(ui);
  forget_trouble_of_another_try(choice, request);
  if (!choice.trouble.empty()) fact(icon::kWarning, p.bad, choice.trouble);
  const std::filesystem::path& target = request.path;
  if (target != choice.path) {
    const bool typed = std::filesystem::path(choice.path).is_absolute();
    fact(icon::kInfo, p.accent, "It will be " + (typed ? target.filename() : target).string());
  }
  std::error_code ignored;
  const bool exists = std::filesystem::exists(target, ignored);
  if (exists) ImGui::Checkbox("Replace the file that is there", &choice.overwrite);
  if (previews) {
    ImGui::NextColumn();
    export_preview(ui, {kPreview - 20, kHeight - 96});
    ImGui::Columns(1);
  }
  const std::string reason = choice.path.empty()             ? "Type where it should go"
                             : !(choice.placement.scale > 0) ? "The scale must be larger than 0"
                             : gaussians == 0                ? "It would hold no Gaussians"
                             : exists && !choice.overwrite
                                 ? "The file exists: allow replacing it, or change the name"
                                 : "";
  const ImVec2 lowest_row = {ImGui::GetCursorPosX(), ImGui::GetWindowHeight() - 42};
  ImGui::SetCursorPos({ImGui::GetWindowWidth() - 122, lowest_row.y});  // Tab comes to it before Cancel
  const bool pressed = button(ui, "Export", "Write the file  (Enter)", reason, reason.empty(), 110);
  ImGui::SetCursorPos(lowest_row);
  const bool cancelled = plain_button(ui, "Cancel", 110) || (!typing && !dragging && escape_pressed());
  const bool done = pressed || (reason.empty() && !typing && enter_pressed());
  if (done) ui.ask(Export{request});
  if (done || cancelled) {
    leave_finish(ui, done);
    ui.state.export_open = false;
    choice.trouble.clear();
    ImGui::CloseCurrentPopup();
  }
  ImGui::EndPopup();
}
}  // namespace splatcut
