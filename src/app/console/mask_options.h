// The part of the command line about where masks come from, of `cut` and `eval`.
#pragma once

#include <optional>
#include <string>

#include "segment/session/cut_settings.h"

namespace CLI {
class App;
}

namespace splatcut {

struct MaskOptions {
  std::string first_mask, propagate, refine;  // empty: as the preset says
  std::optional<int> views;
  bool parts_only = false, truth_too = false;

  // with_truth: --first-mask takes truth as well, for measuring.
  void add_to(CLI::App& command, bool with_truth);
  // Throws Error for what they do not take.
  void apply(CutSettings* settings) const;
};

}  // namespace splatcut
