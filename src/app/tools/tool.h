// The table of tools. Keys, tooltips, the column, the work of the pointer and the marks over the picture
// follow from it. To add a tool, define its row in a file of src/app/tools, and add a line to
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

// One mark of a tool's symbol, in a square from -1 to 1, x right, y down. Symbols are drawn, because the icon
// font has none for most tools.
struct IconMark {
  enum class Kind { kLine, kLoop, kDot, kRing };
  Kind kind = Kind::kLine;
  std::vector<glm::vec2> points;  // points of a line or loop; the centre of a dot or ring
  float radius = 0;               // radius of a dot or ring
  float wider = 0;                // width beyond that of other lines, logical pixels
};
using Icon = std::vector<IconMark>;

// Shape that the interface draws over the picture while a tool is at work.
enum class ToolShape { kNone, kPath, kRectangle, kPolygon, kCircle, kPoints };

// One row of the table. It is a value that may be copied freely; rows are equal if their names are. A
// function that is null does nothing; tool_hand.h says what the functions are given.
struct Tool {
  // Work of a left drag: it moves the camera, or collects all points of its path, or its first and last
  // point.
  enum class Drag { kNavigates, kPath, kCorners };
  enum class Selects { kNothing, kPixels, kColours, kSpace };

  const char* name = "";      // name on the F1 page and in the tooltip: "Click an object"
  int key = 0;                // key code, without modifiers
  const char* sentence = "";  // text of the tooltip
  const char* hint = "";      // text in the bar; {} stands for the number of points set
  Icon (*icon)() = nullptr;
  bool first_of_group = false;  // true: a line stands above the tool in the column

  Drag drag = Drag::kNavigates;
  bool right_drags = false;  // true: the right button draws as the left one does
  float brush = 0;           // radius of what the tool draws over that of the brush; 0: the tool has no brush
  bool strokes = false;      // true: what the tool draws goes to the cut
  bool shows_keys = false;   // true: a sign at the pointer shows what the held keys make of a stroke
  bool clicks_object = false;  // true: a click of either button corrects the object, without any drag
  Selects selects = Selects::kNothing;  // what the tool selects by hand: by pixels, by colour, or in space

  void (*press)(ToolHand& hand) = nullptr;    // a shape begins
  void (*move)(ToolHand& hand) = nullptr;     // the path has changed
  void (*release)(ToolHand& hand) = nullptr;  // the path is done
  void (*click)(ToolHand& hand) = nullptr;
  void (*double_click)(ToolHand& hand) = nullptr;
  void (*confirm)(ToolHand& hand) = nullptr;  // the user pressed Enter

  ToolShape shape = ToolShape::kNone;  // shape made of the path, unless show() sets other points
  void (*show)(const ToolState& state, const Camera& camera, ToolOverlay* out) = nullptr;

  friend bool operator==(const Tool& a, const Tool& b) { return std::string_view(a.name) == b.name; }
  operator ToolId() const;

#define SPLATCUT_DECLARE_TOOL(tool) static const Tool k##tool;
  SPLATCUT_TOOLS(SPLATCUT_DECLARE_TOOL)
#undef SPLATCUT_DECLARE_TOOL
};

std::span<const Tool* const> tools();  // all tools, in the order of ToolId
const Tool& tool_of(ToolId id);

}  // namespace splatcut
