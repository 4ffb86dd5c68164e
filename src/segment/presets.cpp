#include "scene/error.h"
#include "segment/pipeline.h"

namespace splatcut {

PipelineOptions preset(const std::string& name) {
  PipelineOptions options;
  if (name == "default") return options;
  if (name == "fast") {
    options.orbit.views = 4;
    options.work_width_px = 256;
  } else if (name == "best") {
    options.orbit.views = 20;
    options.settled_change = 0;  // all of them
    options.work_width_px = 512;
  } else if (name == "paper" || name == "paper-code") {
    const bool code = name == "paper-code";
    options.orbit.views = 40;
    options.settled_change = 0;
    options.first_mask_from = FirstMaskFrom::kPixels;
    options.cut.energy = code ? paper_code_energy() : paper_energy();
    if (code) options.neighbours = 9;
    options.trim = false;
  } else {
    throw Error("--preset " + name, "there is no such preset", "Take fast, default, best, paper or paper-code");
  }
  return options;
}

PrepareOptions prepare_options(const PipelineOptions& options) {
  PrepareOptions prepare;
  prepare.graph.neighbours = options.neighbours;
  prepare.cache = options.cache;
  prepare.with_parts = options.first_mask_from == FirstMaskFrom::kParts;
  return prepare;
}

}  // namespace splatcut
