// The tools by name. What each does is its row of the table in app/tools/tool.h.
#pragma once

// In the order of the column.
// clang-format off
#define SPLATCUT_TOOLS(tool) \
  tool(Navigate)             \
  tool(Click)                \
  tool(Scribble)             \
  tool(Box)                  \
  tool(Brush)                \
  tool(Lasso)                \
  tool(Rectangle)            \
  tool(Polygon)              \
  tool(Sphere)               \
  tool(Volume)               \
  tool(Colour)               \
  tool(Flood)                \
  tool(Ground)               \
  tool(Measure)
// clang-format on

namespace splatcut {

enum class ToolId {
#define SPLATCUT_TOOL_ID(tool) k##tool,
  SPLATCUT_TOOLS(SPLATCUT_TOOL_ID)
#undef SPLATCUT_TOOL_ID
};

}  // namespace splatcut
