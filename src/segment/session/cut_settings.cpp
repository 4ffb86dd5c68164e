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

// A preset is one row here: the daily one, then those for comparison with the paper.
constexpr Preset kPresets[] = {
    {"default", "Default", "Your views; with a mask, some around the object, too",
     []() -> CutSettings { return {}; }},
    {"paper", "Paper", "GaussianCut's literal energy and number of views",
     [] { return as_the_paper(paper_energy()); }},
    {"paper-code", "Code", "The energy of GaussianCut's published code, which differs from the paper",
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
