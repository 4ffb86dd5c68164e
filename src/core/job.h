// What a long stage is given: a way to be cancelled and a way to say how far it is.
//
// Cancelling is a normal result, not an error: a stage that sees cancelled() returns early, its result
// is then unspecified, and the caller, who sees the same token, drops it. Stages look at least every
// 50 ms. on_progress is called only on the thread that runs the stage.
#pragma once

#include <functional>
#include <stop_token>
#include <string_view>

namespace splatcut {

struct Job {
  std::stop_token stop;
  std::function<void(std::string_view stage, double fraction)> on_progress;  // fraction in [0, 1]

  bool cancelled() const { return stop.stop_requested(); }
  void progress(std::string_view stage, double fraction) const {
    if (on_progress) on_progress(stage, fraction);
  }
};

}  // namespace splatcut
