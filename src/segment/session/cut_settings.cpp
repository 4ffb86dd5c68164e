#include "segment/session/cut_settings.h"

#include <algorithm>

#include "core/error.h"
#include "core/spoken_list.h"

namespace splatcut {

namespace {

CutSettings as_the_paper(const EnergyOptions& energy) {
  CutSettings settings;
  settings.orbit.views = 40;
  settings.settled_change = 0;
  settings.first_mask_from = FirstMaskFrom::kPixels;
  settings.refine = {.solver = MaskSolver::kNone};
  settings.cut.energy = energy;
  settings.trim = false;
  return settings;
}

// A preset is one row here. In the order of lists.
constexpr Preset kPresets[] = {
    {"fast", "Fast", "Your views in few pixels: quickest, for a first look", false,
     [] {
       CutSettings settings;
       settings.orbit.views = 0;
       settings.work_width_px = 256;
       settings.refine = {.solver = MaskSolver::kNone};
       return settings;
     }},
    {"default", "Default", "Your views; with a mask, some around the object, too", false,
     [] { return CutSettings(); }},
    {"best", "Best", "Your views and twelve around the object: slower", false,
     [] {
       CutSettings settings;
       settings.orbit.views = kViewsAround;
       settings.settled_change = 0;  // all of them
       return settings;
     }},
    {"paper", "Paper", "GaussianCut's literal energy and number of views", true,
     [] { return as_the_paper(paper_energy()); }},
    {"paper-code", "Code", "The energy of GaussianCut's published code, which differs from the paper", true,
     [] {
       CutSettings settings = as_the_paper(paper_code_energy());
       settings.neighbours = 9;
       return settings;
     }},
};

}  // namespace

std::span<const Preset> presets() {
  return kPresets;
}

std::string preset_names() {
  std::vector<std::string> names;
  for (const Preset& preset : kPresets) names.emplace_back(preset.name);
  return spoken_list(names);
}

CutSettings preset(const std::string& name) {
  const auto found = std::ranges::find_if(kPresets, [&](const Preset& p) { return name == p.name; });
  if (found == std::end(kPresets))
    throw Error("preset \"" + name + "\"", "there is no such preset", "Take " + preset_names());
  return found->settings();
}

}  // namespace splatcut
