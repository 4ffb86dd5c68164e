// One measurement of the study: a setting, what is made worse, and which chart or table it belongs to.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "app/measure/mask_disturbance.h"

namespace splatcut {

struct StudyCell {
  std::string experiment;  // chart or table
  std::string series;      // line of the chart, row of the table
  std::string still_life;  // runs on the scenes of that name only, see study_scenes.h; empty: on the study's
                           // main scenes
  double x = 0;            // severity or size; its unit is the experiment's
  std::string preset = "default";
  std::vector<std::string> set;  // NAME=VALUE, see settings_table.h
  std::string first =
      "clicks";  // clicks; truth: the true mask of the reference; strokes: nothing but their own pixels
  bool parts_only = false;
  bool true_masks = false;  // in the other views
  int clicks = 3;
  std::uint64_t draw = 0;       // of the robot's hand, and of all else by chance; 0 is steady
  std::uint64_t order = 0;      // of the clicks, by chance; 0 as they were made
  MaskDisturbance disturbance;  // of true masks ...
  double disturbed_share = 1;   // ... in that share of the views
  double stroke_px = 0;         // clicks drawn out to strokes of that length, in a direction by chance
  double scene_scale = 1;       // of positions, sizes and cameras
  double up_tilt_deg = 0;       // of what is taken for up
  double step_back = 1;         // the reference's distance, in its own
  double hidden = 0;            // share of the object that a board hides in the reference
  double object_share = 0;      // of the reference's pixels, by its focal length; 0: as it is
  double score_scale = 1;       // width of the test pictures, in their own
};

inline nlohmann::json to_json(const StudyCell& c) {
  return {{"experiment", c.experiment},
          {"series", c.series},
          {"still_life", c.still_life},
          {"x", c.x},
          {"preset", c.preset},
          {"set", c.set},
          {"first", c.first},
          {"parts_only", c.parts_only},
          {"true_masks", c.true_masks},
          {"clicks", c.clicks},
          {"draw", c.draw},
          {"order", c.order},
          {"disturbance", c.disturbance.kind},
          {"disturbance_px", c.disturbance.px},
          {"disturbed_share", c.disturbed_share},
          {"stroke_px", c.stroke_px},
          {"scene_scale", c.scene_scale},
          {"up_tilt_deg", c.up_tilt_deg},
          {"step_back", c.step_back},
          {"hidden", c.hidden},
          {"object_share", c.object_share},
          {"score_scale", c.score_scale}};
}

}  // namespace splatcut
