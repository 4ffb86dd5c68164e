// Keys, buttons and menu entries: whether they are allowed now, and what they do.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "app/studio/studio.h"

namespace splatcut {

namespace {

// Of the axes across `up`, one that a view can follow: z (or y) for the front, x (or y) for the right.
glm::vec3 level_direction(const glm::vec3& up, bool right) {
  const glm::vec3 ahead = std::abs(up.z) < 0.9f ? glm::vec3(0, 0, 1) : glm::vec3(0, 1, 0);
  const glm::vec3 front = glm::normalize(ahead - glm::dot(ahead, up) * up);
  return right ? -glm::cross(front, up) : front;
}

// Why an action is not allowed now; empty where it is.
using Refusal = std::string (*)(const Studio& studio);

std::string without_scene(const Studio& s) {
  return s.scene() ? "" : "Open a scene first";
}

std::string without_anything_to_stop(const Studio& s) {
  return s.loading() ? "" : without_scene(s);
}

std::string without_undo(const Studio& s) {
  if (!s.scene()) return without_scene(s);
  return s.history().can_undo() || s.files().changing() ? "" : "There is nothing to undo";
}

std::string without_redo(const Studio& s) {
  if (!s.scene()) return without_scene(s);
  return s.history().can_redo() || s.files().can_redo_files() ? "" : "There is nothing to redo";
}

std::string without_object(const Studio& s) {
  if (!s.scene()) return without_scene(s);
  return s.document().active_object() ? "" : "Click an object first";
}

std::string without_gaussians(const Studio& s) {
  if (std::string reason = without_object(s); !reason.empty()) return reason;
  return s.gaussians_of(s.document().active) > 0 ? "" : "The object is empty so far: click on it";
}

std::string without_anything_to_frame(const Studio& s) {
  return s.viewport().placing() ? "" : without_gaussians(s);
}

std::string without_selection(const Studio& s) {
  if (!s.scene()) return without_scene(s);
  const ObjectItem* active = s.document().active_object();
  if (!active || s.gaussians_of(active->id) == 0) return "Nothing is selected";
  return active->locked ? active->name + " is locked" : "";
}

std::string without_cutout(const Studio& s) {
  if (!s.scene()) return without_scene(s);
  const ObjectItem* active = s.document().active_object();
  return active && !active->cut_key.empty() ? "" : "There is no cutout yet: click an object";
}

std::string without_strokes(const Studio& s) {
  if (!s.scene()) return without_scene(s);
  const ObjectItem* active = s.document().active_object();
  if (!active || active->views.empty()) return "The object has no strokes";
  return active->locked ? active->name + " is locked" : "";
}

std::string without_cameras(const Studio& s) {
  if (!s.scene()) return without_scene(s);
  if (!s.scene()->views().cameras.empty()) return "";
  return s.scene()->files.front().cameras_are_others ? "The cameras beside the scene stand otherwise than it "
                                                       "says which way is up: they are not its own"
                                                     : "No camera file was found beside the scene";
}

std::string without_polygon(const Studio& s) {
  if (!s.scene()) return without_scene(s);
  const bool closes = tool_of(s.view().tool).confirm && s.tools().at_work();
  return closes || s.cursor_px() ? "" : "Enter clicks at the cursor of the arrow keys: press an arrow first";
}

template <int kSteps>
std::string without_size(const Studio& s) {
  return s.scene() ? s.clicks().why_not_step(kSteps) : without_scene(s);
}

constexpr float kBrushStep = 1.12f;

}  // namespace

struct Studio::ActionRow {
  // kForEdits: the action is an edit, or the edits before it decide whether it is allowed. kForCuts: it is
  // also about what the cuts on their way are to find.
  enum Waits { kForNothing, kForEdits, kForCuts };
  Action action;
  Refusal why_not;  // null: it is always allowed
  void (*does)(Studio& studio);
  Waits waits = kForNothing;
};

const Studio::ActionRow* Studio::row_of(Action action) {
  using S = Studio;
  constexpr auto kWaits = ActionRow::kForEdits, kForCuts = ActionRow::kForCuts;
  static const std::vector<ActionRow> rows = {
      {Action::kOpen, nullptr, [](S& s) { s.ask(UiRequest::kOpenDialog); }},
      {Action::kAddScene, without_scene, [](S& s) { s.ask(UiRequest::kAddDialog); }},
      {Action::kSave, without_scene, [](S& s) { s.ask(UiRequest::kSaveDialog); }},
      {Action::kExport, without_scene, [](S& s) { s.ask(UiRequest::kExportDialog); }, kWaits},
      {Action::kSnapshot, without_scene, [](S& s) { s.ask(UiRequest::kSnapshotDialog); }},
      {Action::kQuit, nullptr, [](S& s) { s.ask(UiRequest::kQuit); }},
      {Action::kHelp, nullptr, [](S& s) { s.ask(UiRequest::kHelp); }},
      {Action::kSettings, nullptr, [](S& s) { s.ask(UiRequest::kSettings); }},
      {Action::kTheme, nullptr, [](S& s) { s.ask(UiRequest::kTheme); }},
      {Action::kHistory, without_scene, [](S& s) { s.ask(UiRequest::kHistory); }},
      {Action::kUndo, without_undo, [](S& s) { s.apply(Undo{}); }, kWaits},
      {Action::kRedo, without_redo, [](S& s) { s.apply(Redo{}); }, kWaits},
      {Action::kCancel, without_anything_to_stop, [](S& s) { s.apply(Cancel{}); }},
      {Action::kCursor, without_scene,
       [](S& s) {
         s.move_cursor({0, 0});
       }},
      {Action::kConfirm, without_polygon, [](S& s) { s.cursor_px() ? s.press_cursor() : s.close_shape(); }},
      {Action::kRecompute, without_strokes, [](S& s) { s.apply(Recompute{}); }},
      {Action::kSelectAll, without_scene, [](S& s) { s.apply(EditSelection{SelectionEdit::kAll}); }},
      {Action::kSelectNone, without_selection, [](S& s) { s.apply(EditSelection{SelectionEdit::kNone}); },
       kForCuts},
      {Action::kInvert, without_object, [](S& s) { s.apply(EditSelection{SelectionEdit::kInvert}); },
       kForCuts},
      {Action::kGrow, without_selection, [](S& s) { s.apply(EditSelection{SelectionEdit::kGrow}); },
       kForCuts},
      {Action::kShrink, without_selection, [](S& s) { s.apply(EditSelection{SelectionEdit::kShrink}); },
       kForCuts},
      {Action::kLargestPart, without_selection,
       [](S& s) { s.apply(EditSelection{SelectionEdit::kLargestPart}); }, kForCuts},
      {Action::kFloaters, without_selection,
       [](S& s) { s.apply(ShowFloaters{!s.viewport_.floaters_shown()}); }, kWaits},
      {Action::kSeeThrough, without_scene, [](S& s) { s.turn_over(&ViewState::see_through); }},
      {Action::kByCentre, without_scene, [](S& s) { s.turn_over(&ViewState::by_centre); }},
      {Action::kDelete, without_selection, [](S& s) { s.apply(DeleteSelected{}); }, kForCuts},
      {Action::kNewObject, without_scene, [](S& s) { s.apply(NewObject{}); }},
      {Action::kBrushSmaller, without_scene, [](S& s) { s.scale_brush(1 / kBrushStep); }},
      {Action::kBrushLarger, without_scene, [](S& s) { s.scale_brush(kBrushStep); }},
      {Action::kPartLarger, without_size<1>, [](S& s) { s.apply(StepScale{1}); }},
      {Action::kPartSmaller, without_size<-1>, [](S& s) { s.apply(StepScale{-1}); }},
      {Action::kIsolate, without_gaussians,
       [](S& s) { s.apply(SetView{turned_over(s.view(), DisplayMode::kIsolate)}); }, kWaits},
      {Action::kHide, without_gaussians,
       [](S& s) { s.apply(SetView{turned_hide(s.view(), s.document().active)}); }, kWaits},
      {Action::kSideBySide, without_gaussians, [](S& s) { s.apply(SetView{turned_side_by_side(s.view())}); },
       kWaits},
      {Action::kCleanEdges, without_scene, [](S& s) { s.turn_over(&ViewState::clean_edges); }},
      {Action::kShowAll, without_scene,
       [](S& s) {
         ViewState view = turned_over(s.view(), s.view().display);
         view.hidden.clear();
         s.apply(SetView{view});
       }},
      {Action::kTint, without_scene, [](S& s) { s.turn_over(&ViewState::tint); }},
      {Action::kOutline, without_scene, [](S& s) { s.turn_over(&ViewState::outline); }},
      {Action::kHeat, without_cutout, [](S& s) { s.turn_over(&ViewState::heat); }},
      {Action::kSeenHeat, without_gaussians, [](S& s) { s.apply(SetView{turned_seen_heat(s.view())}); },
       kWaits},
      {Action::kFillHole, without_gaussians, [](S& s) { s.apply(SetView{turned_fill_hole(s.view())}); },
       kWaits},
      {Action::kCentres, without_scene, [](S& s) { s.turn_over(&ViewState::centres); }},
      {Action::kRings, without_scene, [](S& s) { s.turn_over(&ViewState::rings); }},
      {Action::kGrid, without_scene, [](S& s) { s.turn_over(&ViewState::grid); }},
      {Action::kBackdrop, without_scene, [](S& s) { s.apply(NextBackdrop{}); }},
      {Action::kFrameObject, without_anything_to_frame, [](S& s) { s.frame_object(); }, kWaits},
      {Action::kFrameScene, without_scene, [](S& s) { s.camera().frame_scene(); }},
      {Action::kOpeningView, without_scene, [](S& s) { s.camera().go_to_opening(); }},
      {Action::kNextCamera, without_cameras, [](S& s) { s.step_camera(1); }},
      {Action::kPreviousCamera, without_cameras, [](S& s) { s.step_camera(-1); }},
      {Action::kViewFront, without_scene,
       [](S& s) { s.apply(LookAlong{level_direction(s.document().up_world, false)}); }},
      {Action::kViewRight, without_scene,
       [](S& s) { s.apply(LookAlong{level_direction(s.document().up_world, true)}); }},
      {Action::kViewTop, without_scene, [](S& s) { s.apply(LookAlong{-s.document().up_world}); }},
  };
  const auto row = std::ranges::find(rows, action, &ActionRow::action);
  return row == rows.end() ? nullptr : &*row;
}

std::string Studio::why_not(Action action) const {
  if (action == Action::kNone) return {};
  const ActionRow* row = row_of(action);
  if (!row) return without_scene(*this);  // tools; flight keys act while they are held
  if (goes_to_view(action) && ws_.tools.at_work()) return std::string(kViewStays);
  return row->why_not ? row->why_not(*this) : "";
}

Studio::Held& Studio::held_for(const ObjectItem& object) {
  const std::string& cut = ws_.history.keys(object).cut;
  if (held_actions_.cut != cut) held_actions_ = {.cut = cut};
  return held_actions_;
}

// What needs the object's Gaussians waits for them where they are on their way: of I, H and B the last one.
bool Studio::hold_for_cut(Action action) {
  const bool frames = action == Action::kFrameObject;
  const bool displays =
      action == Action::kIsolate || action == Action::kHide || action == Action::kSideBySide;
  const ObjectItem* object = document().active_object();
  if ((!frames && !displays) || !object || !cuts_.comes(*object)) return false;
  Held& held = held_for(*object);
  (frames ? held.frame : held.display) = action;
  if (frames) held.seen_from = camera().goal();
  ws_.say(Message::Kind::kInfo,
          fmt::format("{}: as soon as {} is computed", short_name_of(action), object->name));
  return true;
}

// Of several the last one counts. The likeliest is what comes anyway.
void Studio::choose_meaning(int choice) {
  if (!clicks_.offer_comes()) {
    const std::string reason = clicks_.why_not_choose(choice);
    return reason.empty() ? apply(ChooseMeaning{choice}) : ws_.say(Message::Kind::kInfo, reason);
  }
  const ObjectItem& object = *document().active_object();
  Held& held = held_for(object);
  held.meaning = choice > 0 ? std::optional(choice) : std::nullopt;
  ws_.say(Message::Kind::kInfo,
          choice > 0 ? fmt::format("Meaning {}: as soon as {} is computed", choice + 1, object.name)
                     : object.name + " gets the likeliest meaning");
}

// Another stroke, object or step of the history, and Esc, drop what was held.
void Studio::run_held() {
  if (held_actions_.cut.empty()) return;
  const ObjectItem* object = document().active_object();
  const bool same = object && ws_.history.keys(*object).cut == held_actions_.cut;
  if (same && (cuts_.comes(*object) || (held_actions_.meaning && clicks_.offer_comes()))) return;
  Held held = std::exchange(held_actions_, {});
  if (!same || gaussians_of(object->id) == 0) return;
  if (held.meaning) {
    choose_meaning(*std::exchange(held.meaning, {}));
    held.cut = ws_.history.keys(*document().active_object()).cut;
    // What else waits is about what the meaning takes.
    if (cuts_.comes(*document().active_object())) return void(held_actions_ = std::move(held));
  }
  if (!(held.seen_from == camera().goal())) held.frame.reset();
  if (held.frame) free_sides_.forget();  // what it offered was for what the object was before
  for (const auto& action : {held.display, held.frame})
    if (action) run(*action);
}

// While another cut of it runs, the object is framed as it is, and again as it is then.
void Studio::frame_object() {
  free_sides_.frame();
  const ObjectItem* object = document().active_object();
  if (viewport_.placing() || !object || !cuts_.comes(*object)) return;
  Held& held = held_for(*object);
  held.frame = Action::kFrameObject;
  held.seen_from = camera().goal();
}

void Studio::run(Action action) {
  if (action == Action::kNone) return;
  const ActionRow* row = row_of(action);
  if (row && row->waits != ActionRow::kForNothing && edits_.waiting())
    return edits_.in_turn([this, action] { run(action); });
  if (row && row->waits == ActionRow::kForCuts && cuts_.next() != 0)
    return edits_.after_cuts(short_name_of(action), [this, action] { run(action); });
  if (const std::string reason = why_not(action); !reason.empty()) {
    if (reason != kViewStays && hold_for_cut(action)) return;
    const bool hint = action == Action::kConfirm;  // pressed by the way; nothing is wrong
    const bool of_sizes = action == Action::kPartLarger || action == Action::kPartSmaller;
    ws_.say(hint ? Message::Kind::kInfo : Message::Kind::kRefused,
            hint || of_sizes ? reason : fmt::format("{}: {}", short_name_of(action), reason));
    return;
  }
  if (const Tool* tool = tool_of(action)) {
    if (const std::string hidden = clicks_.why_no_meanings(); !hidden.empty())
      ws_.say(Message::Kind::kInfo,
              *tool == ws_.view.tool
                  ? hidden
                  : fmt::format("The tool is {} now: what else the click can mean is no longer "
                                "offered",
                                name_of(action)));
    ViewState view = ws_.view;
    view.tool = *tool;
    return apply(SetView{view});
  }
  if (row) row->does(*this);
}

void Studio::close_shape() {
  run_all(ws_.tools.confirm(viewport_.tool_context(viewport_.pressed_pane())));
}

void Studio::turn_over(bool ViewState::*part) {
  ViewState view = ws_.view;
  view.*part = !(view.*part);
  apply(SetView{view});
}

// The nearest given camera says where in the row we are.
void Studio::step_camera(int direction) {
  const glm::vec3 eye = camera().pose().position_world;
  const auto& cameras = ws_.scene->views().cameras;
  const auto distance = [&](const Camera& c) { return glm::length(c.centre_world() - eye); };
  const auto nearest = std::ranges::min_element(cameras, {}, distance);
  const auto count = static_cast<std::ptrdiff_t>(cameras.size());
  constexpr float kThereShare = 1e-4f;
  const bool there = distance(*nearest) < kThereShare * camera().scene_size();
  const std::ptrdiff_t step = !there ? 0 : direction > 0 ? 1 : count - 1;
  apply(GoToCamera{cameras[static_cast<std::size_t>((nearest - cameras.begin() + step) % count)]});
}

}  // namespace splatcut
