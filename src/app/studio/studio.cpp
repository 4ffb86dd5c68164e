// Events, actions and messages.
#include "app/studio/studio.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <thread>

#include "core/error.h"

namespace splatcut {

namespace {

constexpr std::size_t kMessagesKept = 100;

// Of the axes across `up`, one that a view can follow: z (or y) for the front, x (or y) for the right.
glm::vec3 level_direction(const glm::vec3& up, bool right) {
  const glm::vec3 ahead = std::abs(up.z) < 0.9f ? glm::vec3(0, 0, 1) : glm::vec3(0, 1, 0);
  const glm::vec3 front = glm::normalize(ahead - glm::dot(ahead, up) * up);
  return right ? -glm::cross(front, up) : front;
}

}  // namespace

Studio::Studio(StudioOptions options)
    : options_(std::move(options)), frames_(options_.wake), tasks_(options_.wake, options_.inline_tasks) {
  tasks_.on_error = [this](const std::string& text) { say(Message::Kind::kError, text); };
  find_autosave();
}

Studio::~Studio() = default;

void Studio::say(Message::Kind kind, std::string text) {
  messages_.push_back({kind, std::move(text), clock_s_});
  if (messages_.size() > kMessagesKept) messages_.pop_front();
}

void Studio::apply(const Command& command) {
  try {
    std::visit([this](const auto& c) { perform(c); }, command);
  } catch (const Error& error) {
    say(Message::Kind::kRefused, error.what());
  } catch (const std::exception& error) {
    say(Message::Kind::kError, sentence_of(error));
  }
}

void Studio::run_all(const std::vector<Command>& commands) {
  for (const Command& command : commands) apply(command);
}

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
  if (!scene_) return "Open a scene first";
  switch (action) {
    case Action::kUndo:
      return history_.can_undo() ? "" : "There is nothing to undo";
    case Action::kRedo:
      return history_.can_redo() ? "" : "There is nothing to redo";
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
      if (!prepared_ && action != Action::kDelete && action != Action::kSelectNone)
        return "Neighbours are still being prepared";
      return {};
    case Action::kHeat:
      return active && !active->cut_key.empty() ? "" : "There is no cutout yet: click an object";
    case Action::kRecompute:
      return active && !active->views.empty() ? "" : "The object has no strokes";
    case Action::kNextCamera:
    case Action::kPreviousCamera:
      return scene_->cameras.empty() ? "No camera file was found beside the scene" : "";
    case Action::kConfirm:
      return view_.tool.confirm && tools_.at_work() ? "" : "There is no polygon to close";
    case Action::kPartLarger:
      return why_not_step(1);
    case Action::kPartSmaller:
      return why_not_step(-1);
    default:
      return {};
  }
}

void Studio::run(Action action) {
  if (action == Action::kNone) return;
  if (const std::string reason = why_not(action); !reason.empty()) {
    say(Message::Kind::kRefused, fmt::format("{}: {}", name_of(action), reason));
    return;
  }
  if (const Tool* tool = tool_of(action)) {
    ViewState view = view_;
    view.tool = *tool;
    return apply(SetView{view});
  }
  const auto edit_selection = [&](SelectionEdit edit) { apply(EditSelection{edit}); };
  const auto change_view = [&](const auto& change) {
    ViewState view = view_;
    change(view);
    apply(SetView{view});
  };
  const auto display = [&](DisplayMode mode) {
    change_view([&](ViewState& v) { v.display = v.display == mode ? DisplayMode::kWhole : mode; });
  };
  constexpr float kBrushStep = 1.12f;
  switch (action) {
    case Action::kOpen:
      ui_requests_.push_back(UiRequest::kOpenDialog);
      break;
    case Action::kSave:
      ui_requests_.push_back(UiRequest::kSaveDialog);
      break;
    case Action::kExport:
      ui_requests_.push_back(UiRequest::kExportDialog);
      break;
    case Action::kSnapshot:
      ui_requests_.push_back(UiRequest::kSnapshotDialog);
      break;
    case Action::kQuit:
      ui_requests_.push_back(UiRequest::kQuit);
      break;
    case Action::kHelp:
      ui_requests_.push_back(UiRequest::kHelp);
      break;
    case Action::kTheme:
      ui_requests_.push_back(UiRequest::kTheme);
      break;
    case Action::kHistory:
      ui_requests_.push_back(UiRequest::kHistory);
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
      run_all(tools_.confirm(tool_context(tools_.pointer_px())));
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
      apply(ShowFloaters{!highlight_floaters_});
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
    case Action::kFrameObject: {
      const std::vector<std::uint8_t> own = labels(document().active);
      std::vector<glm::vec3> positions;
      for (std::size_t g = 0; g < own.size(); ++g)
        if (own[g]) positions.push_back(scene_->cloud->position[g]);
      camera_.frame(robust_bounds(positions, 0.96), viewport_camera(), covered_bottom_px_);
      break;
    }
    case Action::kFrameScene:
      camera_.frame_scene();
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
    case Action::kPreviousCamera: {
      // The nearest given camera says where in the row we are.
      const glm::vec3 eye = camera_.pose().position_world;
      const auto& cameras = scene_->cameras;
      const auto distance = [&](const Camera& c) { return glm::length(c.centre_world() - eye); };
      const auto nearest = std::ranges::min_element(cameras, {}, distance);
      const auto count = static_cast<std::ptrdiff_t>(cameras.size());
      constexpr float kThereShare = 1e-4f;
      const bool there = distance(*nearest) < kThereShare * camera_.scene_size();
      const std::ptrdiff_t step = !there ? 0 : action == Action::kNextCamera ? 1 : count - 1;
      apply(GoToCamera{cameras[static_cast<std::size_t>((nearest - cameras.begin() + step) % count)]});
      break;
    }
    default:
      break;  // flight keys act while they are held
  }
}

void Studio::scale_brush(float factor) {
  ViewState view = view_;
  view.brush_px = std::clamp(view.brush_px * factor, kLeastBrushPx, kMostBrushPx);
  apply(SetView{view});
}

void Studio::hold(const Modifiers& modifiers) {
  held_modifiers_ = modifiers;
  tools_.hold(modifiers);
}

void Studio::key_pressed(int code, const Modifiers& modifiers, bool repeated) {
  Modifiers now = modifiers;  // X11 does not count the key itself yet
  now.shift |= code == key::kLeftShift || code == key::kRightShift;
  now.ctrl |= code == key::kLeftControl || code == key::kRightControl;
  now.alt |= code == key::kLeftAlt || code == key::kRightAlt;
  hold(now);
  const ClickMeanings* offered = modifiers == Modifiers{} ? offer() : nullptr;
  if (offered && code >= '1' && code - '1' < std::ssize(offered->outlines))
    return apply(ChooseMeaning{code - '1'});
  const Action action = action_for(code, modifiers);
  if (action == Action::kBrushSmaller || action == Action::kBrushLarger) {
    // A keyboard repeats 30 times a second: the size doubles in one all the same.
    constexpr double kStepSeconds = 0.16;
    if (repeated && clock_s_ - brush_repeated_s_ < kStepSeconds) return;
    brush_repeated_s_ = clock_s_;
  }
  if (is_flight(action))
    held_keys_.insert(code);
  else
    run(action);
}

void Studio::key_released(int code) {
  held_keys_.erase(code);
  Modifiers now = held_modifiers_;
  if (code == key::kLeftShift || code == key::kRightShift) now.shift = false;
  if (code == key::kLeftControl || code == key::kRightControl) now.ctrl = false;
  if (code == key::kLeftAlt || code == key::kRightAlt) now.alt = false;
  hold(now);
}

void Studio::release_keys() {
  held_keys_.clear();
  hold({});
}

Flight Studio::flight() const {
  Flight flight;
  for (const int code : held_keys_) {
    const Action action = action_for(code, {});
    flight.forward += (action == Action::kFlyForward) - (action == Action::kFlyBack);
    flight.right += (action == Action::kFlyRight) - (action == Action::kFlyLeft);
    flight.down += (action == Action::kFlyDown) - (action == Action::kFlyUp);
  }
  flight.speed = view_.fly_speed * (held_modifiers_.shift ? 4.0f : held_modifiers_.alt ? 0.2f : 1.0f);
  return flight;
}

void Studio::pointer_pressed(const glm::vec2& pixel, PointerButton button, const Modifiers& modifiers) {
  if (!scene_) return;
  pressed_pane_ = pane_at(pixel);
  run_all(tools_.press(in_pane(pixel), button, modifiers, tool_context(pixel)));
}

void Studio::pointer_left() {
  pointer_inside_ = false;
}

void Studio::pointer_moved(const glm::vec2& pixel, const Modifiers& modifiers) {
  pointer_inside_ = true;
  hold(modifiers);
  if (scene_) run_all(tools_.move(in_pane(pixel), modifiers, tool_context(pixel)));
}

void Studio::pointer_released(const glm::vec2& pixel, PointerButton button, const Modifiers& modifiers) {
  if (scene_) run_all(tools_.release(in_pane(pixel), button, modifiers, tool_context(pixel)));
}

void Studio::pointer_double_clicked(const glm::vec2& pixel) {
  if (scene_) run_all(tools_.double_click(in_pane(pixel), tool_context(pixel)));
}

void Studio::wheel(float steps, const Modifiers& modifiers) {
  if (!scene_) return;
  if (!flight().moving()) return run_all(tools_.wheel(steps, modifiers, tool_context(tools_.pointer_px())));
  constexpr float kSpeedStep = 1.25f, kSlowest = 0.02f, kFastest = 50;
  ViewState view = view_;
  view.fly_speed = std::clamp(view.fly_speed * std::pow(kSpeedStep, steps), kSlowest, kFastest);
  apply(SetView{view});
  say(Message::Kind::kInfo, fmt::format("Flying at {:.2g} times the usual speed", view.fly_speed));
}

bool Studio::settle(double most_seconds) {
  const auto start = std::chrono::steady_clock::now();
  while (std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() < most_seconds) {
    update(1.0 / 60);
    if (idle()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  return false;
}

}  // namespace splatcut
