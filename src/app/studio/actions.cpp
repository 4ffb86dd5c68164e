#include "app/studio/actions.h"

#include <algorithm>
#include <array>

namespace splatcut {

namespace {

constexpr Modifiers kPlain{}, kShift{true, false, false}, kCtrl{false, true, false},
    kCtrlShift{true, true, false};

constexpr std::array kBindings = {
    Binding{Action::kOpen, 'O', kCtrl, "File", "Open a scene or a work file"},
    Binding{Action::kSave, 'S', kCtrl, "File", "Save the work"},
    Binding{Action::kExport, 'E', kCtrl, "File", "Export"},
    Binding{Action::kSnapshot, key::kF12, kPlain, "File", "Picture of this view"},
    Binding{Action::kQuit, 'Q', kCtrl, "File", "Quit"},
    Binding{Action::kUndo, 'Z', kCtrl, "Edit", "Undo"},
    Binding{Action::kRedo, 'Z', kCtrlShift, "Edit", "Redo"},
    Binding{Action::kRedo, 'Y', kCtrl, "Edit", "Redo"},
    Binding{Action::kHistory, 'U', kCtrl, "Edit", "Show or hide the history"},
    Binding{Action::kCancel, key::kEscape, kPlain, "Edit", "Cancel the job, the shape, then the tool"},
    Binding{Action::kConfirm, key::kEnter, kPlain, "Edit", "Close the polygon"},
    Binding{Action::kConfirm, key::kKeypadEnter, kPlain, "Edit", "Close the polygon"},
    Binding{Action::kRecompute, 'R', kPlain, "Edit", "Compute the cutout again"},
    Binding{Action::kToolNavigate, '1', kPlain, "Tools", "Navigate"},
    Binding{Action::kToolClick, '2', kPlain, "Tools", "Click an object"},
    Binding{Action::kToolScribble, '3', kPlain, "Tools", "Scribble"},
    Binding{Action::kToolBox, '4', kPlain, "Tools", "Box around the object"},
    Binding{Action::kToolBrush, '5', kPlain, "Tools", "Brush"},
    Binding{Action::kToolLasso, '6', kPlain, "Tools", "Lasso"},
    Binding{Action::kToolRectangle, '7', kPlain, "Tools", "Rectangle"},
    Binding{Action::kToolPolygon, '8', kPlain, "Tools", "Polygon"},
    Binding{Action::kToolSphere, '9', kPlain, "Tools", "Sphere"},
    Binding{Action::kToolVolume, 'Y', kPlain, "Tools", "Box in space"},
    Binding{Action::kToolColour, 'C', kPlain, "Tools", "Eyedropper: select by colour"},
    Binding{Action::kToolFlood, 'G', kPlain, "Tools", "Flood: neighbours of one colour"},
    Binding{Action::kToolGround, '0', kPlain, "Tools", "Set up: three points of the ground"},
    Binding{Action::kToolMeasure, 'K', kPlain, "Tools", "Measure between two points"},
    Binding{Action::kBrushSmaller, '[', kPlain, "Tools", "Smaller brush"},
    Binding{Action::kBrushLarger, ']', kPlain, "Tools", "Larger brush"},
    Binding{Action::kSeeThrough, 'V', kPlain, "Tools", "Visible only, or see-through"},
    Binding{Action::kPartLarger, key::kPageUp, kPlain, "Tools", "Larger part of what was clicked"},
    Binding{Action::kPartSmaller, key::kPageDown, kPlain, "Tools", "Smaller part of what was clicked"},
    Binding{Action::kSelectAll, 'A', kCtrl, "Selection", "Select all"},
    Binding{Action::kSelectNone, 'D', kCtrl, "Selection", "Select none"},
    Binding{Action::kSelectNone, 'A', kCtrlShift, "Selection", "Select none"},
    Binding{Action::kInvert, 'I', kCtrl, "Selection", "Invert"},
    Binding{Action::kGrow, '=', kPlain, "Selection", "Grow"},
    Binding{Action::kGrow, key::kKeypadAdd, kPlain, "Selection", "Grow"},
    Binding{Action::kShrink, '-', kPlain, "Selection", "Shrink"},
    Binding{Action::kShrink, key::kKeypadSubtract, kPlain, "Selection", "Shrink"},
    Binding{Action::kLargestPart, 'L', kCtrl, "Selection", "Keep the largest part"},
    Binding{Action::kFloaters, 'L', kCtrlShift, "Selection", "Show floaters"},
    Binding{Action::kDelete, key::kDelete, kPlain, "Selection", "Delete from the scene"},
    Binding{Action::kNewObject, 'N', kCtrl, "Selection", "New object"},
    Binding{Action::kIsolate, 'I', kPlain, "Display", "Isolate the object"},
    Binding{Action::kIsolate, key::kTab, kPlain, "Display", "Isolate the object"},
    Binding{Action::kHide, 'H', kPlain, "Display", "Hide the object"},
    Binding{Action::kShowAll, 'H', kShift, "Display", "Show everything"},
    Binding{Action::kSideBySide, 'B', kPlain, "Display", "Side by side"},
    Binding{Action::kTint, 'T', kPlain, "Display", "Tint"},
    Binding{Action::kOutline, 'O', kPlain, "Display", "Outline"},
    Binding{Action::kHeat, 'M', kPlain, "Display", "Likelihood heat map"},
    Binding{Action::kBackdrop, 'J', kPlain, "Display", "Next background"},
    Binding{Action::kCentres, 'X', kPlain, "Display", "Centres of the Gaussians"},
    Binding{Action::kTheme, 'L', kPlain, "Display", "Light or dark"},
    Binding{Action::kHelp, key::kF1, kPlain, "Display", "This page"},
    Binding{Action::kHelp, '/', kShift, "Display", "This page"},
    Binding{Action::kFrameObject, 'F', kPlain, "Camera", "Frame the object"},
    Binding{Action::kFrameScene, 'F', kShift, "Camera", "Frame the scene"},
    Binding{Action::kFrameScene, key::kHome, kPlain, "Camera", "Frame the scene"},
    Binding{Action::kNextCamera, 'N', kPlain, "Camera", "Next camera of the capture"},
    Binding{Action::kPreviousCamera, 'P', kPlain, "Camera", "Previous camera"},
    Binding{Action::kViewFront, key::kKeypad1, kPlain, "Camera", "Look from the front"},
    Binding{Action::kViewRight, key::kKeypad3, kPlain, "Camera", "Look from the right"},
    Binding{Action::kViewTop, key::kKeypad7, kPlain, "Camera", "Look from above"},
    Binding{Action::kFlyForward, 'W', kPlain, "Camera", "Fly forward (Shift fast, Alt slow, wheel: speed)"},
    Binding{Action::kFlyBack, 'S', kPlain, "Camera", "Fly back"},
    Binding{Action::kFlyLeft, 'A', kPlain, "Camera", "Fly left"},
    Binding{Action::kFlyRight, 'D', kPlain, "Camera", "Fly right"},
    Binding{Action::kFlyUp, 'E', kPlain, "Camera", "Fly up"},
    Binding{Action::kFlyDown, 'Q', kPlain, "Camera", "Fly down"},
};

std::string plain_name(int code) {
  switch (code) {
    case key::kEscape:
      return "Esc";
    case key::kEnter:
      return "Enter";
    case key::kKeypadEnter:
      return "Keypad Enter";
    case key::kTab:
      return "Tab";
    case key::kDelete:
      return "Del";
    case key::kHome:
      return "Home";
    case key::kPageUp:
      return "Page Up";
    case key::kPageDown:
      return "Page Down";
    case key::kF1:
      return "F1";
    case key::kF12:
      return "F12";
    case key::kKeypad1:
      return "Keypad 1";
    case key::kKeypad3:
      return "Keypad 3";
    case key::kKeypad7:
      return "Keypad 7";
    case key::kKeypadAdd:
      return "Keypad +";
    case key::kKeypadSubtract:
      return "Keypad -";
    case '=':
      return "+";
    default:
      return std::string(1, static_cast<char>(code));
  }
}

}  // namespace

std::span<const Binding> key_bindings() {
  return kBindings;
}

Action action_for(int code, const Modifiers& modifiers) {
  const auto exact = std::ranges::find_if(
      kBindings, [&](const Binding& b) { return b.key == code && b.modifiers == modifiers; });
  if (exact != kBindings.end()) return exact->action;
  if (modifiers.ctrl) return Action::kNone;
  const auto flight =
      std::ranges::find_if(kBindings, [&](const Binding& b) { return b.key == code && is_flight(b.action); });
  if (flight != kBindings.end()) return flight->action;
  // "+" is Shift+= on many keyboards.
  return code == '=' && modifiers.shift ? Action::kGrow : Action::kNone;
}

std::string key_name(int code, const Modifiers& modifiers) {
  if (code == '/' && modifiers == kShift) return "?";
  std::string name;
  if (modifiers.ctrl) name += "Ctrl+";
  if (modifiers.alt) name += "Alt+";
  if (modifiers.shift) name += "Shift+";
  return name + plain_name(code);
}

std::string keys_of(Action action) {
  std::string keys;
  for (const Binding& b : kBindings)
    if (b.action == action) keys += (keys.empty() ? "" : ", ") + key_name(b.key, b.modifiers);
  return keys;
}

const char* name_of(Action action) {
  const auto found = std::ranges::find(kBindings, action, &Binding::action);
  return found == kBindings.end() ? "" : found->what;
}

}  // namespace splatcut
