#include "app/console/mask_options.h"

#include <CLI/CLI.hpp>
#include <algorithm>

#include "core/error.h"
#include "segment/session/settings_table.h"

namespace splatcut {

void MaskOptions::add_to(CLI::App& command, bool with_truth) {
  truth_too = with_truth;
  command.add_option("--first-mask", first_mask,
                     std::string("parts: the hierarchy of parts; grabcut, pixelcut: from the one picture") +
                         (truth_too ? "; truth: the true mask" : ""));
  const Setting& as_set = *std::ranges::find(settings_table(), "views.propagate", &Setting::name);
  command.add_option("--propagate", propagate, as_set.sentence);
  command.add_option("--refine", refine, "What settles masks in the other views: none, grabcut or pixelcut");
  constexpr int kMostViews = 400;  // of the setting
  command
      .add_option("--views", views,
                  "Most views around the object, 0 to 400; else by the preset: default none after clicks, "
                  "12 with a mask")
      ->check(CLI::Range(0, kMostViews));
  command.add_flag("--parts-only", parts_only, "The parts are the answer: no other views, no graph cut");
}

void MaskOptions::apply(CutSettings* settings) const {
  if (first_mask == "grabcut" || first_mask == "pixelcut") {
    set_setting("first.from", "pixels", settings);
    set_setting("first.solver", first_mask, settings);
  } else if (first_mask == "parts") {
    set_setting("first.from", "parts", settings);
  } else if (!first_mask.empty() && !(truth_too && first_mask == "truth")) {
    throw Error("--first-mask " + first_mask, "there is no such first mask",
                std::string("It takes parts, grabcut, pixelcut") + (truth_too ? " or truth" : ""));
  }
  if (!propagate.empty()) set_setting("views.propagate", propagate, settings);
  if (!refine.empty()) set_setting("views.refine", refine, settings);
  if (views)
    set_setting("views.most", std::to_string(*views), settings);
  else if (settings->orbit.views == kViewsAsNeeded && (!propagate.empty() || !refine.empty()))
    settings->orbit.views = kViewsAround;  // they speak of other views
  if (parts_only) settings->parts_only = true;
}

}  // namespace splatcut
