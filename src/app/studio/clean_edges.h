// Computes the active object with clean edges on the worker: at once if the object is shown alone, else while
// the worker has nothing else to do, so that the object is there when the user asks for it.
//
// A new cut, a scene that opens and a change of labels stop the computation; it starts anew by itself, as it
// does where up changes, or the user asks to clean anyway.
#pragma once

#include "app/document/document.h"
#include "app/studio/viewport.h"
#include "app/studio/workspace.h"

namespace splatcut {

class CleanEdges {
 public:
  CleanEdges(Workspace& workspace, const Viewport& viewport, const CutJobs& cuts)
      : ws_(workspace), viewport_(viewport), cuts_(cuts) {}

  void perform(const CleanAnyway&);
  void update();  // starts what is needed; called once a frame
  // Stops the computation that a view waits for, and gives it up as it was asked for. Returns false if no
  // view waits.
  bool cancel();

 private:
  struct Asked {
    Flags labels;
    glm::vec3 up_world{0};
    bool anyway = false;
    bool operator==(const Asked&) const = default;
  };
  Asked now() const;  // what seen_ asks for
  void start();

  Workspace& ws_;
  const Viewport& viewport_;
  const CutJobs& cuts_;
  Asked settled_;            // what is computed, or was given up
  Flags seen_;               // labels at the last update()
  double seen_since_s_ = 0;  // clock time since which labels and worker are quiet
};

}  // namespace splatcut
