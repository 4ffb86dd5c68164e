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
  const ClickMeanings* offered = modifiers == Modifiers{} ? clicks_.offer() : nullptr;
  if (offered && code >= '1' && code - '1' < std::ssize(offered->outlines))
    return apply(ChooseMeaning{code - '1'});
  const Action action = action_for(code, modifiers);
  if (action == Action::kBrushSmaller || action == Action::kBrushLarger) {
    // A keyboard repeats 30 times a second: the size doubles in one all the same.
    constexpr double kStepSeconds = 0.16;
    if (repeated && ws_.clock_s - brush_repeated_s_ < kStepSeconds) return;
    brush_repeated_s_ = ws_.clock_s;
  }
  if (is_flight(action))
    held_keys_.insert(code);
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

void Studio::pointer(std::function<void()> event) {
  if (!ws_.scene) return;
  if (held_pointer_.empty() && viewport_.display_current())
    event();
  else
    held_pointer_.push_back(std::move(event));
}

void Studio::pointer_pressed(const glm::vec2& pixel, PointerButton button, const Modifiers& modifiers) {
  pointer([this, pixel, button, modifiers] {
    viewport_.press_in(viewport_.pane_at(pixel));
    run_all(ws_.tools.press(viewport_.in_pane(pixel), button, modifiers, viewport_.tool_context(pixel)));
  });
}

void Studio::pointer_left() {
  clicks_.pointer_inside(false);
}

void Studio::pointer_moved(const glm::vec2& pixel, const Modifiers& modifiers) {
  clicks_.pointer_inside(true);
  hold(modifiers);
  pointer([this, pixel, modifiers] {
    run_all(ws_.tools.move(viewport_.in_pane(pixel), modifiers, viewport_.tool_context(pixel)));
  });
}

void Studio::pointer_released(const glm::vec2& pixel, PointerButton button, const Modifiers& modifiers) {
  pointer([this, pixel, button, modifiers] {
    run_all(ws_.tools.release(viewport_.in_pane(pixel), button, modifiers, viewport_.tool_context(pixel)));
  });
}

void Studio::pointer_double_clicked(const glm::vec2& pixel) {
  pointer([this, pixel] {
    run_all(ws_.tools.double_click(viewport_.in_pane(pixel), viewport_.tool_context(pixel)));
  });
}

void Studio::wheel(float steps, const Modifiers& modifiers) {
  if (!ws_.scene) return;
  if (!flight().moving())
    return run_all(ws_.tools.wheel(steps, modifiers, viewport_.tool_context(ws_.tools.pointer_px())));
  constexpr float kSpeedStep = 1.25f, kSlowest = 0.02f, kFastest = 50;
  ViewState view = ws_.view;
  view.fly_speed = std::clamp(view.fly_speed * std::pow(kSpeedStep, steps), kSlowest, kFastest);
  apply(SetView{view});
  ws_.say(Message::Kind::kInfo, fmt::format("Flying at {:.2g} times the usual speed", view.fly_speed));
}

}  // namespace splatcut
