// Frames the object (F), and where something stands before it offers to look from a side where less does: the
// next F, while the view has not moved. Where it was in sight and would be no more, it goes there at once.
// Sides are looked for on the worker.
#pragma once

#include <optional>

#include "app/workspace/viewport.h"
#include "app/workspace/workspace.h"

namespace splatcut {

class FreeSides {
 public:
  FreeSides(Workspace& workspace, Viewport& viewport) : ws_(workspace), viewport_(viewport) {}

  void frame();
  void forget() { offer_.reset(); }  // the next frame() takes no side that was offered

 private:
  void frame_placed();

  struct Offer {
    ObjectId object;
    CameraPose from;
    Framing side;
  };

  Workspace& ws_;
  Viewport& viewport_;
  std::optional<Offer> offer_;
};

}  // namespace splatcut
