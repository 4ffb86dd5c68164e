// One measurement of the study: a setting, what is made worse, and which chart or table it belongs to.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "segment/mask_disturbance.h"

namespace splatcut {

struct StudyCell {
  std::string experiment;  // chart or table
  std::string series;      // line of the chart, column of the table
  double x = 0;            // severity or size; its unit is the experiment's
  std::string preset = "default";
  std::vector<std::string> set;   // NAME=VALUE, see tuning_options.h
  std::string first = "clicks";   // clicks; truth: the true mask of the reference; strokes: nothing but their own pixels
  bool parts_only = false;
  bool true_masks = false;        // in the other views
  int clicks = 3;
  std::uint64_t draw = 0;         // of the robot's hand; 0 is steady
  MaskDisturbance disturbance;    // of true masks ...
  double disturbed_share = 1;     // ... in that share of the views
  double stroke_px = 0;           // clicks drawn out to strokes of that length, in a direction by chance
  double scene_scale = 1;         // of positions, sizes and cameras
  double up_tilt_deg = 0;         // of what is taken for up
  double step_back = 1;           // the reference's distance, in its own
};

inline nlohmann::json to_json(const StudyCell& c) {
  return {{"experiment", c.experiment}, {"series", c.series}, {"x", c.x}, {"preset", c.preset}, {"set", c.set}, {"first", c.first},
          {"parts_only", c.parts_only}, {"true_masks", c.true_masks}, {"clicks", c.clicks}, {"draw", c.draw},
          {"disturbance", c.disturbance.kind}, {"disturbance_px", c.disturbance.px}, {"disturbed_share", c.disturbed_share},
          {"stroke_px", c.stroke_px}, {"scene_scale", c.scene_scale}, {"up_tilt_deg", c.up_tilt_deg}, {"step_back", c.step_back}};
}

}  // namespace splatcut
