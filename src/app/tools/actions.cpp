#include "app/tools/actions.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <vector>

namespace splatcut {

namespace {

constexpr Modifiers kPlain{}, kShift{true, false, false}, kCtrl{false, true, false},
    kCtrlShift{true, true, false};

struct ToolAction {
  const Tool* tool;
  Action action;
};
constexpr ToolAction kToolActions[] = {
#define SPLATCUT_TOOL_ACTION(tool) {&Tool::k##tool, Action::kTool##tool},
    SPLATCUT_TOOLS(SPLATCUT_TOOL_ACTION)
#undef SPLATCUT_TOOL_ACTION
};

constexpr const char *kTools = "Tools", *kMovesCursor = "A cursor in the picture (Shift far, Alt near)",
                     *kPresses = "Click at that cursor, or close the polygon",
                     *kLarger = "The last click takes more", *kSmaller = "The last click takes less";

// Those of the tools stand in their rows.
constexpr std::array kOwnBindings = {
    Binding{Action::kOpen, 'O', kCtrl, "File", "Open a scene or a work file"},
    Binding{Action::kAddScene, 'O', kCtrlShift, "File", "Add a scene to this one"},
    Binding{Action::kSave, 'S', kCtrl, "File", "Save the work"},
    Binding{Action::kExport, 'E', kCtrl, "File", "Export"},
    Binding{Action::kSnapshot, key::kF12, kPlain, "File", "Picture of this view"},
    Binding{Action::kSettings, ',', kCtrl, "File", "Settings of the program"},
    Binding{Action::kQuit, 'Q', kCtrl, "File", "Quit"},
    Binding{Action::kUndo, 'Z', kCtrl, "Edit", "Undo"},
    Binding{Action::kRedo, 'Z', kCtrlShift, "Edit", "Redo"},
    Binding{Action::kRedo, 'Y', kCtrl, "Edit", "Redo"},
    Binding{Action::kHistory, 'U', kCtrl, "Edit", "Show or hide the history"},
    Binding{Action::kCancel, key::kEscape, kPlain, "Edit", "Cancel the job or the shape; then back to Click"},
    Binding{Action::kRecompute, 'R', kPlain, "Edit", "Compute the cutout again"},
    Binding{Action::kCursor, key::kLeft, kPlain, kTools, kMovesCursor},
    Binding{Action::kCursor, key::kRight, kPlain, kTools, kMovesCursor},
    Binding{Action::kCursor, key::kUp, kPlain, kTools, kMovesCursor},
    Binding{Action::kCursor, key::kDown, kPlain, kTools, kMovesCursor},
    Binding{Action::kConfirm, key::kEnter, kPlain, kTools, kPresses},
    Binding{Action::kConfirm, key::kKeypadEnter, kPlain, kTools, kPresses},
    Binding{Action::kBrushSmaller, '[', kPlain, kTools, "Smaller brush"},
    Binding{Action::kBrushLarger, ']', kPlain, kTools, "Larger brush"},
    Binding{Action::kSeeThrough, 'V', kPlain, kTools, "Visible only, or see-through"},
    Binding{Action::kByCentre, 'V', kShift, kTools, "By centres, or by whole Gaussians"},
    Binding{Action::kPartLarger, '=', kPlain, kTools, kLarger},
    Binding{Action::kPartLarger, key::kKeypadAdd, kPlain, kTools, kLarger},
    Binding{Action::kPartLarger, key::kPageUp, kPlain, kTools, kLarger},
    Binding{Action::kPartSmaller, '-', kPlain, kTools, kSmaller},
    Binding{Action::kPartSmaller, key::kKeypadSubtract, kPlain, kTools, kSmaller},
    Binding{Action::kPartSmaller, key::kPageDown, kPlain, kTools, kSmaller},
    Binding{Action::kSelectAll, 'A', kCtrl, "Selection", "Select all"},
    Binding{Action::kSelectNone, 'D', kCtrl, "Selection", "Select none"},
    Binding{Action::kSelectNone, 'A', kCtrlShift, "Selection", "Select none"},
    Binding{Action::kInvert, 'I', kCtrl, "Selection", "Invert"},
    Binding{Action::kGrow, '=', kCtrl, "Selection", "Grow"},
    Binding{Action::kGrow, key::kKeypadAdd, kCtrl, "Selection", "Grow"},
    Binding{Action::kShrink, '-', kCtrl, "Selection", "Shrink"},
    Binding{Action::kShrink, key::kKeypadSubtract, kCtrl, "Selection", "Shrink"},
    Binding{Action::kLargestPart, 'L', kCtrl, "Selection", "Keep the largest part"},
    Binding{Action::kFloaters, 'L', kCtrlShift, "Selection", "Show floaters"},
    Binding{Action::kDelete, key::kDelete, kPlain, "Selection", "Delete from the scene"},
    Binding{Action::kNewObject, 'N', kCtrl, "Selection", "New object"},
    Binding{Action::kIsolate, 'I', kPlain, "Display", "Isolate the object"},
    Binding{Action::kHide, 'H', kPlain, "Display", "Hide the object"},
    Binding{Action::kShowAll, 'H', kShift, "Display", "Show everything"},
    Binding{Action::kFillHole, 'H', kCtrl, "Display", "Hide it, fill its hole"},
    Binding{Action::kSideBySide, 'B', kPlain, "Display",
            "Side by side; of the object alone: as it is, and clean"},
    Binding{Action::kCleanEdges, 'I', kShift, "Display", "Clean edges of the object alone, and in exports"},
    Binding{Action::kTint, 'T', kPlain, "Display", "Tint"},
    Binding{Action::kOutline, 'O', kPlain, "Display", "Outline"},
    Binding{Action::kHeat, 'M', kPlain, "Display", "Likelihood heat map"},
    Binding{Action::kSeenHeat, 'M', kShift, "Display", "The object alone, by how many views saw it"},
    Binding{Action::kBackdrop, 'J', kPlain, "Display", "Next background"},
    Binding{Action::kCentres, 'X', kPlain, "Display", "Centres of the Gaussians"},
    Binding{Action::kRings, 'X', kShift, "Display", "Rings of the Gaussians"},
    Binding{Action::kGrid, 'G', kShift, "Display", "Grid on the ground"},
    Binding{Action::kTheme, 'L', kPlain, "Display", "Light or dark"},
    Binding{Action::kHelp, key::kF1, kPlain, "Display", "This page"},
    Binding{Action::kHelp, '/', kShift, "Display", "This page"},
    Binding{Action::kFrameObject, 'F', kPlain, "Camera", "Frame the object"},
    Binding{Action::kFrameScene, 'F', kShift, "Camera", "Frame the scene"},
    Binding{Action::kFrameScene, key::kHome, kPlain, "Camera", "Frame the scene"},
    Binding{Action::kOpeningView, key::kHome, kShift, "Camera", "The view in which the scene opened"},
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

// Tools first under their heading.
std::vector<Binding> all_bindings() {
  std::vector<Binding> all(kOwnBindings.begin(), kOwnBindings.end());
  auto at = std::ranges::find(all, std::string_view(kTools), &Binding::group);
  for (const ToolAction& a : kToolActions)
    at = all.insert(at, {a.action, a.tool->key, kPlain, kTools, a.tool->name}) + 1;
  return all;
}

std::string plain_name(int code) {
  switch (code) {
    case key::kEscape:
      return "Esc";
    case key::kEnter:
      return "Enter";
    case key::kKeypadEnter:
      return "Keypad Enter";
    case key::kDelete:
      return "Del";
    case key::kLeft:
      return "Left";
    case key::kRight:
      return "Right";
    case key::kUp:
      return "Up";
    case key::kDown:
      return "Down";
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
  static const std::vector<Binding> bindings = all_bindings();
  return bindings;
}

Action action_of(const Tool& tool) {
  const auto found = std::ranges::find_if(kToolActions, [&](const ToolAction& a) { return *a.tool == tool; });
  return found == std::end(kToolActions) ? Action::kNone : found->action;
}

const Tool* tool_of(Action action) {
  const auto found = std::ranges::find(kToolActions, action, &ToolAction::action);
  return found == std::end(kToolActions) ? nullptr : found->tool;
}

Action action_for(int code, const Modifiers& modifiers) {
  const std::span<const Binding> bindings = key_bindings();
  const auto exact = std::ranges::find_if(
      bindings, [&](const Binding& b) { return b.key == code && b.modifiers == modifiers; });
  if (exact != bindings.end()) return exact->action;
  if (code == key::kEnter || code == key::kKeypadEnter)
    return Action::kConfirm;           // as a click with those keys
  if (code == '=' && modifiers.shift)  // "+" is Shift+= on many keyboards
    return action_for(code, {false, modifiers.ctrl, modifiers.alt});
  if (modifiers.ctrl) return Action::kNone;
  const auto moves = std::ranges::find_if(bindings, [&](const Binding& b) {
    return b.key == code && (is_flight(b.action) || b.action == Action::kCursor);
  });
  return moves != bindings.end() ? moves->action : Action::kNone;
}

glm::vec2 arrow_direction(int code) {
  return {static_cast<float>((code == key::kRight) - (code == key::kLeft)),
          static_cast<float>((code == key::kDown) - (code == key::kUp))};
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
  for (const Binding& b : key_bindings())
    if (b.action == action) keys += (keys.empty() ? "" : ", ") + key_name(b.key, b.modifiers);
  return keys;
}

const char* name_of(Action action) {
  const auto found = std::ranges::find(key_bindings(), action, &Binding::action);
  return found == key_bindings().end() ? "" : found->what;
}

std::string short_name_of(Action action) {
  const std::string_view name = name_of(action);
  return std::string(name.substr(0, std::min({name.size(), name.find(" ("), name.find("; ")})));
}

}  // namespace splatcut
