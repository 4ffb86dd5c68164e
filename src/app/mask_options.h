// The part of the command line about where masks come from, of `cut` and `eval`.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "segment/session/cut_settings.h"

namespace splatcut {

struct MaskOptions {
  std::string first_mask, propagate, refine;  // empty: as the preset says
  int views = -1;
  bool parts_only = false;

  // truth_too: --first-mask takes truth as well, for measuring.
  void add_to(CLI::App& command, bool truth_too);
  void apply(CutSettings* options) const;
};

}  // namespace splatcut
