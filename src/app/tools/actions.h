// Key bindings: one table that the keyboard, the menus, the tooltips and the F1 page all read.
#pragma once

#include <glm/vec2.hpp>
#include <span>
#include <string>

#include "app/tools/tool.h"

namespace splatcut {

// Key codes as GLFW numbers them; letters and digits are their ASCII capitals.
namespace key {
inline constexpr int kEscape = 256, kEnter = 257, kTab = 258, kBackspace = 259, kInsert = 260, kDelete = 261;
inline constexpr int kRight = 262, kLeft = 263, kDown = 264, kUp = 265, kPageUp = 266, kPageDown = 267,
                     kHome = 268, kEnd = 269;
inline constexpr int kF1 = 290, kF12 = 301;
inline constexpr int kKeypad1 = 321, kKeypad3 = 323, kKeypad7 = 327;
inline constexpr int kKeypadSubtract = 333, kKeypadAdd = 334, kKeypadEnter = 335;
inline constexpr int kLeftShift = 340, kLeftControl = 341, kLeftAlt = 342, kRightShift = 344,
                     kRightControl = 345, kRightAlt = 346;
inline constexpr int kCount = 512;
}  // namespace key

struct Modifiers {
  bool shift = false, ctrl = false, alt = false;
  bool operator==(const Modifiers&) const = default;
};

enum class Action {
  kNone,
  kOpen,
  kAddScene,
  kSave,
  kExport,
  kSnapshot,
  kQuit,
  kUndo,
  kRedo,
  kCancel,
  kCursor,
  kConfirm,
  kRecompute,
  kHelp,
  kSettings,
  kTheme,
  kHistory,
  kSelectAll,
  kSelectNone,
  kInvert,
  kGrow,
  kShrink,
  kLargestPart,
  kFloaters,
  kSeeThrough,
  kByCentre,
  kDelete,
  kNewObject,
#define SPLATCUT_TOOL_ACTION(tool) kTool##tool,
  SPLATCUT_TOOLS(SPLATCUT_TOOL_ACTION)
#undef SPLATCUT_TOOL_ACTION
      kBrushSmaller,
  kBrushLarger,
  kPartLarger,
  kPartSmaller,
  kIsolate,
  kHide,
  kShowAll,
  kSideBySide,
  kCleanEdges,
  kTint,
  kOutline,
  kHeat,
  kSeenHeat,
  kFillHole,
  kBackdrop,
  kCentres,
  kRings,
  kGrid,
  kFrameObject,
  kFrameScene,
  kOpeningView,
  kNextCamera,
  kPreviousCamera,
  kViewFront,
  kViewRight,
  kViewTop,
  kFlyForward,
  kFlyBack,
  kFlyLeft,
  kFlyRight,
  kFlyUp,
  kFlyDown,
};

struct Binding {
  Action action;
  int key;
  Modifiers modifiers;
  const char* group;  // heading on the F1 page
  const char* what;   // name of the action: "Undo"
};

std::span<const Binding> key_bindings();

// The action that selects a tool, and the tool that an action selects; null: the action selects no tool.
Action action_of(const Tool& tool);
const Tool* tool_of(Action action);

// The action bound to a key; kNone: nothing is bound. Flight keys and arrows keep their action while Shift
// or Alt is held.
Action action_for(int key, const Modifiers& modifiers);

std::string key_name(int key, const Modifiers& modifiers);  // name of a key: "Ctrl+Shift+Z"
std::string keys_of(Action action);  // all keys of the action: "Ctrl+Shift+Z, Ctrl+Y"; empty: it has none
const char* name_of(Action action);  // Binding::what of the action
// The same without what explains it, as sentences about it begin: "Side by side".
std::string short_name_of(Action action);

// Direction in the picture of an arrow key, x right, y down; 0, 0: it is no arrow key.
glm::vec2 arrow_direction(int key);

constexpr bool is_flight(Action action) {
  return action >= Action::kFlyForward && action <= Action::kFlyDown;
}

// True for actions that put the view elsewhere at once.
constexpr bool goes_to_view(Action action) {
  return action >= Action::kFrameObject && action <= Action::kViewTop;
}

}  // namespace splatcut
