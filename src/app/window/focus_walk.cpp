#include "app/window/focus_walk.h"

#include <imgui_internal.h>  // windows, what Tab looks for

#include <algorithm>
#include <utility>
#include <vector>

namespace splatcut {

namespace {

// Panels in the order in which Tab goes through them.
constexpr const char* kPanels[] = {"bar", "options", "tools", "picture", "side", "status"};

// Windows with items: the root, then its children.
void add_windows(const ImGuiWindow* root, std::vector<ImGuiWindow*>* windows) {
  for (ImGuiWindow* window : GImGui->Windows)
    if (window->RootWindow == root && window->WasActive && !window->Hidden) windows->push_back(window);
}

// All that Tab goes through now.
std::vector<ImGuiWindow*> windows_to_walk() {
  std::vector<ImGuiWindow*> windows;
  if (!GImGui->OpenPopupStack.empty()) {
    if (const ImGuiWindow* popup = GImGui->OpenPopupStack.back().Window) add_windows(popup, &windows);
    return windows;
  }
  for (const char* name : kPanels)
    if (const ImGuiWindow* panel = ImGui::FindWindowByName(name)) add_windows(panel, &windows);
  return windows;
}

// Nothing is looked for in the window before.
void turn_to(ImGuiWindow* window) {
  ImGui::FocusWindow(window);
  GImGui->NavId = 0;
}

// What can be pressed; a part of a panel that scrolls is an item to ImGui, too.
bool can_be_pressed(const ImGuiNavItemData& item) {
  const bool scrolls = std::ranges::any_of(
      GImGui->Windows, [&](const ImGuiWindow* window) { return window->ChildId == item.ID; });
  return !scrolls && !(item.InFlags & (ImGuiItemFlags_Disabled | ImGuiItemFlags_NoTabStop));
}

}  // namespace

std::optional<ShownItem> FocusWalk::mark() const {
  const ImGuiContext& g = *GImGui;
  ImGuiWindow* window = g.NavWindow;
  if (marked_ == 0 || g.NavId != marked_ || !g.NavIdIsAlive || !window || !window->Active) return {};
  const ImRect rect = ImGui::WindowRectRelToAbs(window, window->NavRectRel[ImGuiNavLayer_Main]);
  return ShownItem{{}, {rect.Min.x, rect.Min.y}, {rect.Max.x, rect.Max.y}};
}

void FocusWalk::step(int direction) {
  if (steps_ == 0) begins_ = true;
  steps_ += direction;
  frames_left_ = kMostFrames;
}

bool FocusWalk::press() {
  if (!mark()) return false;
  GImGui->NavNextActivateId = marked_;
  GImGui->NavNextActivateFlags = field_ ? ImGuiActivateFlags_PreferInput : ImGuiActivateFlags_None;
  return true;
}

bool FocusWalk::leave() {
  const bool any = mark().has_value();
  marked_ = 0;
  steps_ = 0;
  return any;
}

void FocusWalk::before_frame() {
  searched_ = false;
  if (steps_ == 0) return;
  ImGuiContext& g = *GImGui;
  const std::vector<ImGuiWindow*> windows = windows_to_walk();
  if (windows.empty() || frames_left_-- == 0) {
    steps_ = 0;
    return;
  }
  const bool elsewhere = std::ranges::find(windows, g.NavWindow) == windows.end();
  if (elsewhere || (std::exchange(begins_, false) && g.NavId == 0))
    turn_to(direction() > 0 ? windows.front() : windows.back());
  g.NavMoveResultLocal.Clear();
  g.NavTabbingResultFirst.Clear();
  ImGui::NavMoveRequestForward(ImGuiDir_Down, ImGuiDir_Down,
                               ImGuiNavMoveFlags_Tabbing | ImGuiNavMoveFlags_FocusApi, 0);
  g.NavTabbingDir = direction();
  g.NavTabbingCounter = 0;
  searched_ = true;
}

void FocusWalk::after_frame() {
  if (arriving_ > 0) --arriving_;
  if (!searched_) return;
  ImGuiContext& g = *GImGui;
  const bool from_end = g.NavId == 0;
  const ImGuiNavItemData found = direction() > 0 && from_end ? g.NavTabbingResultFirst : g.NavMoveResultLocal;
  const bool wrapped = direction() < 0 && !from_end && g.NavMoveScoringItems;  // it went on to the last one
  g.NavInitRequest = false;  // where nothing is marked yet, ImGui asks for the first item, too
  g.NavInitResultId = 0;
  ImGui::NavMoveRequestCancel();
  if (found.ID == 0 || wrapped) {
    const std::vector<ImGuiWindow*> windows = windows_to_walk();
    const auto at = std::ranges::find(windows, g.NavWindow);
    if (at == windows.end()) return;
    const auto next = (at - windows.begin() + direction() + std::ssize(windows)) % std::ssize(windows);
    return turn_to(windows[static_cast<std::size_t>(next)]);
  }
  if (g.ActiveId != found.ID) ImGui::ClearActiveID();
  ImGui::SetNavID(found.ID, ImGuiNavLayer_Main, found.FocusScopeId, found.RectRel);
  if (!can_be_pressed(found)) return;  // the search goes on from there
  g.NavIdIsAlive = true;
  steps_ -= direction();
  frames_left_ = kMostFrames;
  arriving_ = 2;
  marked_ = found.ID;
  field_ = (found.InFlags & ImGuiItemFlags_Inputable) != 0;
  ImGui::ScrollToBringRectIntoView(found.Window, ImGui::WindowRectRelToAbs(found.Window, found.RectRel));
  if (field_ && steps_ == 0) press();  // a field is typed into at once
}

}  // namespace splatcut
