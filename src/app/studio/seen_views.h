// Computes on the worker what the capture's views never showed of the active object, where the window shows
// that: with the object alone and its heat on, by how many views each Gaussian was seen; without the object,
// the ground that it hid from all of them. Kept in the workspace until labels or the scene's up change.
//
// A new cut stops the computation; it starts anew by itself. Where the user stopped it, it starts anew once
// the view is shown anew.
#pragma once

#include "app/workspace/viewport.h"
#include "app/workspace/workspace.h"

namespace splatcut {

class SeenViews {
 public:
  SeenViews(Workspace& workspace, const Viewport& viewport, const CutJobs& cuts)
      : ws_(workspace), viewport_(viewport), cuts_(cuts) {}

  void update();  // starts what is needed; called once a frame
  // Stops the computation that a view waits for, and gives it up as long as that view stays. Returns false if
  // no view waits.
  bool cancel();
  const UnseenGround* ground() const;  // of the active object; null: not known
  bool looking() const;                // the computation waits or runs

 private:
  SeenQuestion asked() const;
  void start(const SeenQuestion& asked);

  Workspace& ws_;
  const Viewport& viewport_;
  const CutJobs& cuts_;
  SeenQuestion answered_;  // what the workspace was found to know
  SeenQuestion given_up_;  // what was cancelled, or failed
};

}  // namespace splatcut
