// Computes on the worker the active object with clean edges, and the scene without it where its hole is to be
// filled: at once if that is shown, else while the worker has nothing else to do, so that it is there when
// the user asks for it.
//
// A new cut, a scene that opens and a change of labels stop the computation; it starts anew by itself, as it
// does where up or what is deleted changes.
#pragma once

#include <array>
#include <string>

#include "app/document/document.h"
#include "app/workspace/viewport.h"
#include "app/workspace/workspace.h"

namespace splatcut {

class CleanEdges {
 public:
  CleanEdges(Workspace& workspace, const Viewport& viewport, const CutJobs& cuts)
      : ws_(workspace), viewport_(viewport), cuts_(cuts) {}

  void update();  // starts what is needed; called once a frame
  // Stops the computation that a view waits for, and gives it up as it was asked for. Returns false if no
  // view waits.
  bool cancel();
  // What a view that is to show the hole filled says of it; empty: no view is.
  std::string hole_text() const;
  // The scene without the active object, as it would be exported now; null: not known.
  std::shared_ptr<const SceneWithout> without() const;

 private:
  struct Asked {
    bool fills = false;  // the scene without the object; else the object alone
    Leaving leaving;
    bool operator==(const Asked&) const = default;
  };
  Asked asked(bool fills) const;  // of seen_
  bool known(const Asked& asked) const;
  bool shows(bool fills) const;  // the view does
  bool computes(bool fills) const;
  // Computes it, if it is not known and was not given up; has it shown, if another made it meanwhile.
  void ask(bool fills);
  void start(const Asked& asked);
  Asked& given_up(bool fills) { return given_up_[fills ? 1 : 0]; }

  Workspace& ws_;
  const Viewport& viewport_;
  const CutJobs& cuts_;
  std::array<Asked, 2> given_up_;  // what was cancelled, or failed, since the view last began to show it
  // What the view was last drawn anew for: once each, as a preview of a cut has no clean edges to wait for.
  std::array<Asked, 2> shown_again_;
  std::array<bool, 2> shown_{};  // shows() at the last update()
  bool fills_ = false;           // which was started last
  Flags seen_;                   // labels at the last update()
  double seen_since_s_ = 0;      // clock time since which labels and worker are quiet
};

}  // namespace splatcut
