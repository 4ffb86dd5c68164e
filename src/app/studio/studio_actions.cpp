// Keys, buttons and menu entries: whether they are allowed now, and what they do.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/studio/studio.h"

namespace splatcut {

namespace {

// Of the axes across `up`, one that a view can follow: z (or y) for the front, x (or y) for the right.
glm::vec3 level_direction(const glm::vec3& up, bool right) {
  const glm::vec3 ahead = std::abs(up.z) < 0.9f ? glm::vec3(0, 0, 1) : glm::vec3(0, 1, 0);
  const glm::vec3 front = glm::normalize(ahead - glm::dot(ahead, up) * up);
  return right ? -glm::cross(front, up) : front;
}

// Commands on the document, or what they make possible: they wait for the edits before them.
bool waits_for_edits(Action action) {
  switch (action) {
    case Action::kUndo:
    case Action::kRedo:
    case Action::kExport:
    case Action::kSelectNone:
    case Action::kInvert:
    case Action::kGrow:
    case Action::kShrink:
    case Action::kLargestPart:
    case Action::kFloaters:
    case Action::kDelete:
    case Action::kIsolate:
    case Action::kHide:
    case Action::kSideBySide:
    case Action::kFrameObject:
      return true;
    default:
      return false;
  }
}

}  // namespace

std::string Studio::why_not(Action action) const {
  const ObjectItem* active = document().active_object();
  const bool selected = active && gaussians_of(active->id) > 0;
  switch (action) {
    case Action::kOpen:
    case Action::kQuit:
    case Action::kHelp:
    case Action::kTheme:
    case Action::kNone:
      return {};
    default:
      break;
  }
  if (!ws_.scene) return "Open a scene first";
  switch (action) {
    case Action::kUndo:
      return ws_.history.can_undo() ? "" : "There is nothing to undo";
    case Action::kRedo:
      return ws_.history.can_redo() ? "" : "There is nothing to redo";
    case Action::kExport:
    case Action::kInvert:
    case Action::kIsolate:
    case Action::kHide:
    case Action::kSideBySide:
    case Action::kFrameObject:
      if (!active) return "Click an object first";
      return selected || action == Action::kInvert ? "" : "The object is empty so far: click on it";
    case Action::kSelectNone:
    case Action::kDelete:
    case Action::kGrow:
    case Action::kShrink:
    case Action::kLargestPart:
    case Action::kFloaters:
      if (!selected) return "Nothing is selected";
      if (active->locked) return active->name + " is locked";
      if (!ws_.prepared && action != Action::kDelete && action != Action::kSelectNone)
        return "Neighbours are still being prepared";
      return {};
    case Action::kHeat:
      return active && !active->cut_key.empty() ? "" : "There is no cutout yet: click an object";
    case Action::kRecompute:
      return active && !active->views.empty() ? "" : "The object has no strokes";
    case Action::kNextCamera:
    case Action::kPreviousCamera:
      return ws_.scene->views().cameras.empty() ? "No camera file was found beside the scene" : "";
    case Action::kConfirm:
      return ws_.view.tool.confirm && ws_.tools.at_work() ? "" : "There is no polygon to close";
    case Action::kPartLarger:
      return clicks_.why_not_step(1);
    case Action::kPartSmaller:
      return clicks_.why_not_step(-1);
    default:
      return {};
  }
}

void Studio::run(Action action) {
  if (action == Action::kNone) return;
  if (edits_.waiting() && waits_for_edits(action)) return edits_.in_turn([this, action] { run(action); });
  if (const std::string reason = why_not(action); !reason.empty()) {
    ws_.say(Message::Kind::kRefused, fmt::format("{}: {}", name_of(action), reason));
    return;
  }
  if (const Tool* tool = tool_of(action)) {
    ViewState view = ws_.view;
    view.tool = *tool;
    return apply(SetView{view});
  }
  const auto edit_selection = [&](SelectionEdit edit) { apply(EditSelection{edit}); };
  const auto change_view = [&](const auto& change) {
    ViewState view = ws_.view;
    change(view);
    apply(SetView{view});
  };
  const auto display = [&](DisplayMode mode) {
    change_view([&](ViewState& v) { v.display = v.display == mode ? DisplayMode::kWhole : mode; });
  };
  constexpr float kBrushStep = 1.12f;
  switch (action) {
    case Action::kOpen:
      ws_.ui_requests.push_back(UiRequest::kOpenDialog);
      break;
    case Action::kAddScene:
      ws_.ui_requests.push_back(UiRequest::kAddDialog);
      break;
    case Action::kSave:
      ws_.ui_requests.push_back(UiRequest::kSaveDialog);
      break;
    case Action::kExport:
      ws_.ui_requests.push_back(UiRequest::kExportDialog);
      break;
    case Action::kSnapshot:
      ws_.ui_requests.push_back(UiRequest::kSnapshotDialog);
      break;
    case Action::kQuit:
      ws_.ui_requests.push_back(UiRequest::kQuit);
      break;
    case Action::kHelp:
      ws_.ui_requests.push_back(UiRequest::kHelp);
      break;
    case Action::kTheme:
      ws_.ui_requests.push_back(UiRequest::kTheme);
      break;
    case Action::kHistory:
      ws_.ui_requests.push_back(UiRequest::kHistory);
      break;
    case Action::kUndo:
      apply(Undo{});
      break;
    case Action::kRedo:
      apply(Redo{});
      break;
    case Action::kCancel:
      apply(Cancel{});
      break;
    case Action::kConfirm:
      run_all(ws_.tools.confirm(viewport_.tool_context(ws_.tools.pointer_px())));
      break;
    case Action::kRecompute:
      apply(Recompute{});
      break;
    case Action::kSelectAll:
      edit_selection(SelectionEdit::kAll);
      break;
    case Action::kSelectNone:
      edit_selection(SelectionEdit::kNone);
      break;
    case Action::kInvert:
      edit_selection(SelectionEdit::kInvert);
      break;
    case Action::kGrow:
      edit_selection(SelectionEdit::kGrow);
      break;
    case Action::kShrink:
      edit_selection(SelectionEdit::kShrink);
      break;
    case Action::kLargestPart:
      edit_selection(SelectionEdit::kLargestPart);
      break;
    case Action::kFloaters:
      apply(ShowFloaters{!viewport_.floaters_shown()});
      break;
    case Action::kSeeThrough:
      change_view([](ViewState& v) { v.see_through = !v.see_through; });
      break;
    case Action::kDelete:
      apply(DeleteSelected{});
      break;
    case Action::kNewObject:
      apply(NewObject{});
      break;
    case Action::kBrushSmaller:
      scale_brush(1 / kBrushStep);
      break;
    case Action::kBrushLarger:
      scale_brush(kBrushStep);
      break;
    case Action::kPartLarger:
      apply(StepScale{1});
      break;
    case Action::kPartSmaller:
      apply(StepScale{-1});
      break;
    case Action::kIsolate:
      display(DisplayMode::kIsolate);
      break;
    case Action::kHide:
      display(DisplayMode::kHide);
      break;
    case Action::kSideBySide:
      display(DisplayMode::kSideBySide);
      break;
    case Action::kShowAll:
      change_view([](ViewState& v) { v.display = DisplayMode::kWhole; });
      break;
    case Action::kTint:
      change_view([](ViewState& v) { v.tint = !v.tint; });
      break;
    case Action::kOutline:
      change_view([](ViewState& v) { v.outline = !v.outline; });
      break;
    case Action::kHeat:
      change_view([](ViewState& v) { v.heat = !v.heat; });
      break;
    case Action::kFrameObject:
      viewport_.frame_object();
      break;
    case Action::kFrameScene:
      camera().frame_scene();
      break;
    case Action::kViewFront:
      apply(LookAlong{level_direction(document().up_world, false)});
      break;
    case Action::kViewRight:
      apply(LookAlong{level_direction(document().up_world, true)});
      break;
    case Action::kViewTop:
      apply(LookAlong{-document().up_world});
      break;
    case Action::kBackdrop:
      apply(NextBackdrop{});
      break;
    case Action::kCentres:
      change_view([](ViewState& v) { v.centres = !v.centres; });
      break;
    case Action::kRings:
      change_view([](ViewState& v) { v.rings = !v.rings; });
      break;
    case Action::kGrid:
      change_view([](ViewState& v) { v.grid = !v.grid; });
      break;
    case Action::kNextCamera:
      step_camera(1);
      break;
    case Action::kPreviousCamera:
      step_camera(-1);
      break;
    default:
      break;  // flight keys act while they are held
  }
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
