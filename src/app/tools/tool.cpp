// The list of tools, and what their files share.
#include "app/tools/tool.h"

#include <algorithm>
#include <array>
#include <cassert>

#include "app/tools/tool_hand.h"
#include "core/lower_case.h"

namespace splatcut {

namespace {

constexpr std::array kAllTools = {
#define SPLATCUT_LIST_TOOL(tool) &Tool::k##tool,
    SPLATCUT_TOOLS(SPLATCUT_LIST_TOOL)
#undef SPLATCUT_LIST_TOOL
};

}  // namespace

std::span<const Tool* const> tools() {
  return kAllTools;
}

const Tool& tool_of(ToolId id) {
  return *kAllTools[static_cast<std::size_t>(id)];
}

Tool::operator ToolId() const {
  const auto row = std::ranges::find_if(kAllTools, [&](const Tool* tool) { return *tool == *this; });
  assert(row != kAllTools.end());
  return static_cast<ToolId>(row - kAllTools.begin());
}

SetOperation ToolState::held_operation() const {
  return operation(ViewState{});
}

SetOperation ToolState::operation(const ViewState& view) const {
  if (modifiers.alt || (modifiers.shift && modifiers.ctrl)) return SetOperation::kIntersect;
  if (modifiers.shift) return SetOperation::kAdd;
  if (modifiers.ctrl) return SetOperation::kRemove;
  return view.operation;
}

void ToolHand::ask_stroke(Stroke stroke) {
  if (state.modifiers.alt)
    ask(IntersectStroke{context.pane_camera, std::move(stroke), context.seen()});
  else
    ask(AddStroke{context.pane_camera, std::move(stroke), context.seen()});
}

void ToolHand::ask_region(Mask region, std::vector<glm::vec2> path_px) {
  ask(SelectRegion{context.pane_camera, std::move(region), operation(), std::move(path_px),
                   lower_case(tool_of(context.view.tool).name)});
}

IconMark icon_line(std::vector<glm::vec2> points, float wider) {
  return {IconMark::Kind::kLine, std::move(points), 0, wider};
}

IconMark icon_loop(std::vector<glm::vec2> points) {
  return {IconMark::Kind::kLoop, std::move(points)};
}

IconMark icon_dot(float x, float y, float radius) {
  return {IconMark::Kind::kDot, {{x, y}}, radius};
}

IconMark icon_ring(float x, float y, float radius) {
  return {IconMark::Kind::kRing, {{x, y}}, radius};
}

}  // namespace splatcut
