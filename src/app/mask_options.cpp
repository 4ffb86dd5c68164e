#include "app/mask_options.h"

#include <vector>

#include "app/tuning_options.h"

namespace splatcut {

void MaskOptions::add_to(CLI::App& command, bool truth_too) {
  std::vector<std::string> ways = {"parts", "grabcut", "pixelcut"};
  if (truth_too) ways.push_back("truth");
  command
      .add_option("--first-mask", first_mask,
                  std::string("parts: the hierarchy of parts; grabcut, pixelcut: from the one picture") +
                      (truth_too ? "; truth: the true mask" : ""))
      ->check(CLI::IsMember(ways));
  command
      .add_option("--propagate", propagate,
                  "lift: labels of the cut rendered into the next view; warp: masks through depth; dis: "
                  "along optical flow")
      ->check(CLI::IsMember({"lift", "warp", "dis"}));
  command.add_option("--refine", refine, "What settles masks in the other views: none, grabcut or pixelcut")
      ->check(CLI::IsMember({"none", "grabcut", "pixelcut"}));
  command.add_option("--views", views, "Most views beside the first")->check(CLI::Range(0, 400));
  command.add_flag("--parts-only", parts_only, "The parts are the answer: no other views, no graph cut");
}

void MaskOptions::apply(CutSettings* options) const {
  const auto set = [options](const std::string& name, const std::string& value) {
    if (!value.empty()) set_tuning_option(name + "=" + value, options);
  };
  if (first_mask == "grabcut" || first_mask == "pixelcut") {
    set("first.from", "pixels");
    set("first.solver", first_mask);
  } else if (first_mask == "parts") {
    set("first.from", "parts");
  }
  set("views.propagate", propagate);
  set("views.refine", refine);
  if (views >= 0) options->orbit.views = views;
  options->cut_parts = !parts_only;
}

}  // namespace splatcut
