// One measurement of the study: a setting, what is made worse, and which chart or table it belongs to.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "app/measure/mask_disturbance.h"

namespace splatcut {

// What is said of the object: true masks, where there are any; else by draw 0 the scene's own clicks, in one
// view; else those of the any-view robot with an unsteady hand (any_view.h), each where its answers are
// wrong.
struct StudyCell {
  std::string experiment;  // chart or table
  std::string series;      // line of the chart, row of the table
  std::string still_life;  // runs on the scenes of that name only, see study_scenes.h; empty: on the study's
                           // main scenes
  double x = 0;            // severity or size; its unit is the experiment's
  std::string preset = "default";
  std::vector<std::string> set;  // NAME=VALUE, see settings_table.h
  bool parts_only = false;
  int masks = 0;  // true ones that are given, of the reference and of views around the object
  int clicks = 3;
  std::uint64_t draw = 0;       // of the hand, and of all else by chance
  bool reordered = false;       // another click is told first
  MaskDisturbance disturbance;  // of true masks ...
  double disturbed_share = 1;   // ... in that share of the views around
  double stroke_px = 0;         // clicks drawn out to strokes of that length, in a direction by chance
  double scene_scale = 1;       // of positions, sizes and cameras
  double up_tilt_deg = 0;       // of what is taken for up
  double step_back = 1;         // the distance of the clicked views, in their own
  double hidden = 0;            // share of the object that a board hides in the reference, clicked first
  double object_share = 0;      // of the clicked views' pixels, by their focal length; 0: as it is
  double picture_scale = 0.5;   // width of the views that a hand clicks and is scored in, in their own
};

inline nlohmann::json to_json(const StudyCell& c) {
  return {{"experiment", c.experiment},
          {"series", c.series},
          {"still_life", c.still_life},
          {"x", c.x},
          {"preset", c.preset},
          {"set", c.set},
          {"parts_only", c.parts_only},
          {"masks", c.masks},
          {"clicks", c.clicks},
          {"draw", c.draw},
          {"reordered", c.reordered},
          {"disturbance", c.disturbance.kind},
          {"disturbance_px", c.disturbance.px},
          {"disturbed_share", c.disturbed_share},
          {"stroke_px", c.stroke_px},
          {"scene_scale", c.scene_scale},
          {"up_tilt_deg", c.up_tilt_deg},
          {"step_back", c.step_back},
          {"hidden", c.hidden},
          {"object_share", c.object_share},
          {"picture_scale", c.picture_scale}};
}

}  // namespace splatcut
