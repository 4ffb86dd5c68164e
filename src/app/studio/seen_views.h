// Computes on the worker what the capture's views never showed of the active object, where the window shows
// that: with the object alone and its heat on, by how many views each Gaussian was seen; without the object,
// the ground that it hid from all of them. Kept in the workspace until labels or the scene's up change.
//
// A new cut stops the computation; it starts anew by itself.
#pragma once

#include "app/studio/viewport.h"
#include "app/studio/workspace.h"

namespace splatcut {

class SeenViews {
 public:
  SeenViews(Workspace& workspace, const Viewport& viewport, const CutJobs& cuts)
      : ws_(workspace), viewport_(viewport), cuts_(cuts) {}

  void update();  // starts what is needed; called once a frame
  // Stops the computation, and gives it up for these labels. Returns false if none runs.
  bool cancel();
  const UnseenGround* ground() const;  // of the active object; null: not known

 private:
  bool known(const Flags& labels) const;  // the workspace holds something of the object with these labels
  void start(const Flags& labels, bool heat);

  Workspace& ws_;
  const Viewport& viewport_;
  const CutJobs& cuts_;
  Flags given_up_;  // labels for which it was cancelled, or failed
};

}  // namespace splatcut
