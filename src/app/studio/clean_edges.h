// Makes the active object's edges clean on the worker: at once where the object is shown alone, else while
// nothing else is to do, so that it is there when it is asked for.
//
// A cut that starts, a scene that is opened and a new selection stop it; it starts anew by itself.
#pragma once

#include "app/document/document.h"
#include "app/studio/viewport.h"
#include "app/studio/workspace.h"

namespace splatcut {

class CleanEdges {
 public:
  CleanEdges(Workspace& workspace, const Viewport& viewport, const CutJobs& cuts)
      : ws_(workspace), viewport_(viewport), cuts_(cuts) {}

  void update();  // once a frame
  // Stops what a view waits for; it is not made again for the same labels. False where no view waits.
  bool cancel();

 private:
  void start(const Flags& labels);

  Workspace& ws_;
  const Viewport& viewport_;
  const CutJobs& cuts_;
  Flags settled_;  // labels whose edges are made, or were given up
  Flags seen_;     // labels of the last frame
  double seen_since_s_ = 0;
};

}  // namespace splatcut
