// The table of tools. Keys, tooltips, the column, what the pointer does and what is drawn over the picture
// follow from it. A tool is one file in src/app/tools that defines its row, and one line in
// app/document/tool_id.h.
#pragma once

#include <glm/glm.hpp>
#include <span>
#include <string_view>
#include <vector>

#include "app/document/tool_id.h"

namespace splatcut {

struct Camera;
struct ToolHand;
struct ToolOverlay;
struct ToolState;

// Symbols are marks in a square from -1 to 1, x right, y down: the icon font has none for most tools.
struct IconMark {
  enum class Kind { kLine, kLoop, kDot, kRing };
  Kind kind = Kind::kLine;
  std::vector<glm::vec2> points;  // the centre of a dot or ring
  float radius = 0;               // of a dot or ring
  float wider = 0;                // than other lines, points of the screen
};
using Icon = std::vector<IconMark>;

// What is drawn over the picture while a tool is at work.
enum class ToolShape { kNone, kPath, kRectangle, kPolygon, kCircle, kPoints };

// One row. A value that is copied freely; rows are equal where their names are. The functions are null where
// nothing happens; see tool_hand.h for what they are given.
struct Tool {
  enum class Drag { kNavigates, kPath, kCorners };  // the last two: collects points, or the first and last
  enum class Selects { kNothing, kPixels, kColours, kSpace };

  const char* name = "";      // on the F1 page and in the tooltip: "Click an object"
  int key = 0;                // without modifiers
  const char* sentence = "";  // in the tooltip
  const char* hint = "";      // in the bar; {} stands for how many points are set
  Icon (*icon)() = nullptr;
  bool first_of_group = false;  // a line in the column above it

  Drag drag = Drag::kNavigates;  // what a left drag does
  bool right_drags = false;      // the right button draws as the left one does
  float brush = 0;               // radius of what it draws, of the brush size; 0: no brush
  bool strokes = false;          // what it draws goes to the cut
  bool shows_keys = false;       // strokes: the pointer's sign says what the keys that are held make of them
  Selects selects = Selects::kNothing;  // Gaussians, by hand

  void (*press)(ToolHand& hand) = nullptr;    // a shape begins
  void (*move)(ToolHand& hand) = nullptr;     // the path has changed
  void (*release)(ToolHand& hand) = nullptr;  // the path is done
  void (*click)(ToolHand& hand) = nullptr;
  void (*double_click)(ToolHand& hand) = nullptr;
  void (*confirm)(ToolHand& hand) = nullptr;  // Enter

  ToolShape shape = ToolShape::kNone;  // made of the path, unless show() gives it other points
  void (*show)(const ToolState& state, const Camera& camera, ToolOverlay* out) = nullptr;

  friend bool operator==(const Tool& a, const Tool& b) { return std::string_view(a.name) == b.name; }
  operator ToolId() const;

#define SPLATCUT_DECLARE_TOOL(tool) static const Tool k##tool;
  SPLATCUT_TOOLS(SPLATCUT_DECLARE_TOOL)
#undef SPLATCUT_DECLARE_TOOL
};

std::span<const Tool* const> tools();  // by their ids
const Tool& tool_of(ToolId id);

}  // namespace splatcut
