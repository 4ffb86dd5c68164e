#include "segment/session/cut_settings.h"

#include "scene/error.h"

namespace splatcut {

CutSettings preset(const std::string& name) {
  CutSettings options;
  // Smoother than the energy's own defaults: better on photographs and straddling splats (docs/study.md).
  options.cut.energy.lambda = 2;
  options.cut.energy.v0_px_per_view_at_400 = 3;
  // The picture may add what the parts missed: a mask too small is the worse mistake (docs/masks.md).
  constexpr RefineOptions kGenerous{.solver = MaskSolver::kPixelCut, .grow_px = 4};
  if (name == "default") {
    options.refine = kGenerous;
  } else if (name == "fast") {
    options.orbit.views = 0;
    options.work_width_px = 256;
  } else if (name == "best") {
    options.settled_change = 0;  // all of them
    options.refine = kGenerous;
  } else if (name == "paper" || name == "paper-code") {
    const bool code = name == "paper-code";
    options.orbit.views = 40;
    options.settled_change = 0;
    options.first_mask_from = FirstMaskFrom::kPixels;
    options.cut.energy = code ? paper_code_energy() : paper_energy();
    if (code) options.neighbours = 9;
    options.trim = false;
  } else {
    throw Error("--preset " + name, "there is no such preset",
                "Take fast, default, best, paper or paper-code");
  }
  return options;
}

void check(const CutSettings& settings) {
  if (!settings.cut_parts && settings.first_mask_from != FirstMaskFrom::kParts)
    throw Error("settings", "the parts cannot be the answer where the first mask comes from pixels",
                "Leave one of the two out");
}

PrepareOptions prepare_options(const CutSettings& settings, const PreparedCache& cache) {
  PrepareOptions prepare;
  prepare.graph.neighbours = settings.neighbours;
  prepare.cache = cache;
  prepare.with_parts = settings.first_mask_from == FirstMaskFrom::kParts;
  return prepare;
}

}  // namespace splatcut
