// Ids of the tools. The row of a tool in the table of app/tools/tool.h says what the tool does.
#pragma once

// List of the tools, in the order in which the window's column shows them.
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
