#include "segment/session/cut_settings.h"

#include <algorithm>

#include "core/error.h"

namespace splatcut {

namespace {

CutSettings by_default() {
  return {};
}

CutSettings fast() {
  CutSettings settings;
  settings.orbit.views = 0;
  settings.work_width_px = 256;
  settings.refine = {.solver = MaskSolver::kNone};
  return settings;
}

CutSettings best() {
  CutSettings settings;
  settings.orbit.views = kViewsAround;
  settings.settled_change = 0;  // all of them
  return settings;
}

CutSettings paper() {
  CutSettings settings;
  settings.orbit.views = 40;
  settings.settled_change = 0;
  settings.first_mask_from = FirstMaskFrom::kPixels;
  settings.refine = {.solver = MaskSolver::kNone};
  settings.cut.energy = paper_energy();
  settings.trim = false;
  return settings;
}

CutSettings paper_code() {
  CutSettings settings = paper();
  settings.cut.energy = paper_code_energy();
  settings.neighbours = 9;
  return settings;
}

constexpr Preset kPresets[] = {
    {"fast", "Fast", "Your views in few pixels: quickest, for a first look", fast},
    {"default", "Default", "Your views; with a mask, some around the object, too", by_default},
    {"best", "Best", "Your views and twelve around the object: slower", best},
    {"paper", "Paper", "GaussianCut's literal energy and number of views", paper},
    {"paper-code", "Code", "The energy of GaussianCut's published code, which differs from the paper",
     paper_code},
};

}  // namespace

std::span<const Preset> presets() {
  return kPresets;
}

std::string preset_names() {
  std::string names;
  for (const Preset& preset : kPresets)
    names += std::string(names.empty()                       ? ""
                         : &preset == std::end(kPresets) - 1 ? " or "
                                                             : ", ") +
             preset.name;
  return names;
}

CutSettings preset(const std::string& name) {
  const auto found = std::ranges::find_if(kPresets, [&](const Preset& p) { return name == p.name; });
  if (found == std::end(kPresets))
    throw Error("preset \"" + name + "\"", "there is no such preset", "Take " + preset_names());
  return found->settings();
}

PrepareOptions prepare_options(const CutSettings& settings, const PreparedCache& cache,
                               const PartModel& model) {
  PrepareOptions prepare;
  prepare.graph.neighbours = settings.neighbours;
  prepare.cache = cache;
  prepare.model = model;
  prepare.with_parts = settings.first_mask_from == FirstMaskFrom::kParts;
  return prepare;
}

}  // namespace splatcut
