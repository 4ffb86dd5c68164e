// Tab and Shift+Tab through everything that can be pressed or typed into: the bar, the tools, the panels, the
// picture's own buttons; while a dialog or menu is open, what is in that. ImGui's own Tab stops at fields
// alone.
//
// Works on the current ImGui context: before_frame() and after_frame() stand around the building of a frame,
// the rest between frames. A search takes a frame for each item, disabled item and window that it looks at,
// and is given up after kMostFrames. Nothing throws.
#pragma once

#include <optional>

#include "app/ui/ui_context.h"

namespace splatcut {

class FocusWalk {
 public:
  void step(int direction);  // 1: to the next item, -1: to the one before; steps add up
  bool press();              // presses the item that is marked; false: none is
  bool leave();              // takes the mark away; false: there is none
  bool searching() const { return steps_ != 0 || arriving_ > 0; }  // true: more frames are needed

  void before_frame();
  void after_frame();
  // Where the marked item lies, logical points, without its name; none: none is marked.
  std::optional<ShownItem> mark() const;

 private:
  static constexpr int kMostFrames = 100;
  int direction() const { return (steps_ > 0) - (steps_ < 0); }

  int steps_ = 0;          // still to go
  int frames_left_ = 0;    // of the search for the next step
  bool begins_ = false;    // it has not looked at anything yet
  bool searched_ = false;  // in this frame
  ImGuiID marked_ = 0;     // item
  bool field_ = false;     // it is typed into
  int arriving_ = 0;       // frames until ImGui has left the field before, and takes letters for this one
};

}  // namespace splatcut
