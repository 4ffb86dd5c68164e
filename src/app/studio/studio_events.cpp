// Keys, pointer and wheel.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "app/studio/studio.h"

namespace splatcut {

void Studio::scale_brush(float factor) {
  ViewState view = ws_.view;
  view.brush_px = std::clamp(view.brush_px * factor, kLeastBrushPx, kMostBrushPx);
  apply(SetView{view});
}

void Studio::hold(const Modifiers& modifiers) {
  ws_.held_modifiers = modifiers;
  ws_.tools.hold(modifiers);
}

void Studio::key_pressed(int code, const Modifiers& modifiers, bool repeated) {
  Modifiers now = modifiers;  // X11 does not count the key itself yet
  now.shift |= code == key::kLeftShift || code == key::kRightShift;
  now.ctrl |= code == key::kLeftControl || code == key::kRightControl;
  now.alt |= code == key::kLeftAlt || code == key::kRightAlt;
  hold(now);
  if (modifiers == Modifiers{} && (clicks_.chooses_by(code) || (code == '1' && held_actions_.meaning)))
    return choose_meaning(code - '1');
  const Action action = action_for(code, modifiers);
  if (modifiers == Modifiers{} && clicks_.lacks_meaning(code)) {
    const std::string reason = clicks_.why_no_meaning(action);
    clicks_.decline_offer();
    run(action);
    return ws_.say(Message::Kind::kInfo, reason);
  }
  if (action == Action::kBrushSmaller || action == Action::kBrushLarger) {
    // A keyboard repeats 30 times a second: the size doubles in one all the same.
    constexpr double kStepSeconds = 0.16;
    if (repeated && ws_.clock_s - brush_repeated_s_ < kStepSeconds) return;
    brush_repeated_s_ = ws_.clock_s;
  }
  if (is_flight(action))
    held_keys_.insert(code);
  else if (action == Action::kCursor && ws_.scene)
    move_cursor(arrow_direction(code));
  else
    run(action);
}

void Studio::key_released(int code) {
  held_keys_.erase(code);
  Modifiers now = ws_.held_modifiers;
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
  if (ws_.tools.at_work()) return flight;  // the view stays under what is drawn
  for (const int code : held_keys_) {
    const Action action = action_for(code, {});
    flight.forward += (action == Action::kFlyForward) - (action == Action::kFlyBack);
    flight.right += (action == Action::kFlyRight) - (action == Action::kFlyLeft);
    flight.down += (action == Action::kFlyDown) - (action == Action::kFlyUp);
  }
  flight.speed = ws_.view.fly_speed * (ws_.held_modifiers.shift ? 4.0f
                                       : ws_.held_modifiers.alt ? 0.2f
                                                                : 1.0f);
  return flight;
}

void Studio::pointer(std::function<void()> event, bool moves_alone) {
  if (!ws_.scene) return;
  const DisplayMode comes = ws_.view.display;
  const bool one_pane =
      viewport_.panes() == 1 && comes != DisplayMode::kSideBySide && comes != DisplayMode::kBeforeAfter;
  if (held_pointer_.empty() && (viewport_.display_current() || (moves_alone && one_pane)))
    event();
  else
    held_pointer_.push_back(std::move(event));
}

void Studio::press_at(const glm::vec2& pixel, PointerButton button, const Modifiers& modifiers) {
  const auto event = [this, pixel, button, modifiers] {
    viewport_.press_in(viewport_.pane_at(pixel));
    run_all(ws_.tools.press(viewport_.in_pane(pixel), button, modifiers,
                            viewport_.tool_context(viewport_.pane_at(pixel))));
  };
  pointer(event, button == PointerButton::kMiddle);
}

void Studio::move_to(const glm::vec2& pixel, const Modifiers& modifiers) {
  clicks_.pointer_inside(true);
  const auto event = [this, pixel, modifiers] {
    run_all(ws_.tools.move(viewport_.in_pane(pixel), modifiers,
                           viewport_.tool_context(viewport_.pane_at(pixel))));
  };
  pointer(event, !ws_.tools.dragging() || ws_.tools.moves_camera());
}

void Studio::release_at(const glm::vec2& pixel, PointerButton button, const Modifiers& modifiers) {
  const auto event = [this, pixel, button, modifiers] {
    run_all(ws_.tools.release(viewport_.in_pane(pixel), button, modifiers,
                              viewport_.tool_context(viewport_.pane_at(pixel))));
  };
  pointer(event, ws_.tools.moves_camera());
}

void Studio::double_click_at(const glm::vec2& pixel) {
  const auto event = [this, pixel] {
    run_all(
        ws_.tools.double_click(viewport_.in_pane(pixel), viewport_.tool_context(viewport_.pane_at(pixel))));
  };
  pointer(event, false);
}

void Studio::pointer_pressed(const glm::vec2& pixel, PointerButton button, const Modifiers& modifiers) {
  hide_cursor();
  press_at(pixel, button, modifiers);
}

void Studio::pointer_left() {
  hide_cursor();
  mouse_px_.reset();
  clicks_.pointer_inside(false);
}

void Studio::pointer_moved(const glm::vec2& pixel, const Modifiers& modifiers) {
  hide_cursor();
  mouse_px_ = pixel;
  hold(modifiers);
  move_to(pixel, modifiers);
}

void Studio::pointer_released(const glm::vec2& pixel, PointerButton button, const Modifiers& modifiers) {
  release_at(pixel, button, modifiers);
}

void Studio::pointer_double_clicked(const glm::vec2& pixel) {
  double_click_at(pixel);
}

glm::vec2 Studio::within_picture(const glm::vec2& pixel) const {
  return glm::clamp(pixel, glm::vec2(0), glm::max(viewport_.size_px() - glm::vec2(1), glm::vec2(0)));
}

// The cursor appears at the mouse, or in the middle of the picture.
void Studio::move_cursor(const glm::vec2& direction) {
  constexpr float kStepPoints = 8, kFarPoints = 40, kNearPoints = 1;
  const Modifiers& held = ws_.held_modifiers;
  const float step = held.shift ? kFarPoints : held.alt ? kNearPoints : kStepPoints;
  const glm::vec2 panes(static_cast<float>(viewport_.panes()), 1);
  const glm::vec2 middle = 0.5f * within_picture(viewport_.size_px()) / panes;
  const glm::vec2 from = cursor_px_ ? *cursor_px_ : mouse_px_.value_or(middle);
  cursor_px_ = within_picture(from + step * viewport_.pixels_per_point() * direction);
  move_to(*cursor_px_, cursor_press_.value_or(held));
}

// A click of the left button; a tool that draws is pressed by one Enter and let go by the next.
void Studio::press_cursor() {
  const glm::vec2 at = *cursor_px_;
  const Tool& tool = tool_of(ws_.view.tool);
  if (cursor_press_) return release_at(at, PointerButton::kLeft, *std::exchange(cursor_press_, {}));
  if (tool.double_click && std::exchange(cursor_click_px_, {}) == at) return double_click_at(at);
  cursor_click_px_ = at;
  press_at(at, PointerButton::kLeft, ws_.held_modifiers);
  if (tool.drag == Tool::Drag::kNavigates) return release_at(at, PointerButton::kLeft, ws_.held_modifiers);
  cursor_press_ = ws_.held_modifiers;
  ws_.say(Message::Kind::kInfo, "Arrows draw, Enter ends it, Esc drops it");
}

bool Studio::abandon_shape() {
  const bool any = ws_.tools.abandon();
  if (cursor_press_) release_at(*cursor_px_, PointerButton::kLeft, *std::exchange(cursor_press_, {}));
  return any;
}

bool Studio::hide_cursor() {
  if (!cursor_px_) return false;
  if (cursor_press_) abandon_shape();
  cursor_px_.reset();
  cursor_click_px_.reset();
  clicks_.pointer_inside(mouse_px_.has_value());
  return true;
}

void Studio::wheel(float steps, const Modifiers& modifiers) {
  if (!ws_.scene) return;
  const bool sizes = !modifiers.alt && !ws_.tools.at_work() && clicks_.wheel_takes_sizes();
  if (!flight().moving() && sizes && steps != 0) return apply(StepScale{steps > 0 ? 1 : -1});
  if (!flight().moving())
    return run_all(ws_.tools.wheel(
        steps, modifiers,
        viewport_.tool_context(viewport_.pane_at(cursor_px_.value_or(mouse_px_.value_or(glm::vec2(0)))))));
  constexpr float kSpeedStep = 1.25f, kSlowest = 0.02f, kFastest = 50;
  ViewState view = ws_.view;
  view.fly_speed = std::clamp(view.fly_speed * std::pow(kSpeedStep, steps), kSlowest, kFastest);
  apply(SetView{view});
  const std::string times = fmt::format("{:.2g}", view.fly_speed);
  ws_.say(Message::Kind::kInfo, times == "1" ? std::string("Flying at the usual speed")
                                             : "Flying at " + times + " times the usual speed");
}

}  // namespace splatcut
