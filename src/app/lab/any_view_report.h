// What the any-view robot finds on a scene, as JSON and as rows of a table.
//
// "any_view": {"iou_after_clicks": {"1", "2", "3", "5", "8", "10"}, "noc85", "noc90", "obeyed",
// "obeyed_pixel", "worst_fall", "ms_per_click"}: means over sessions (starts times draws); "least" and "p10":
// of iou_after_clicks over sessions, the least and the 10th percentile; "most_fall": the largest worst_fall;
// "views", "clicks", "sessions": [{"start", "draw", "choice", "iou_after", "obeyed", "clicks", "doubts"}]; a
// box among the clicks has its other corner as "to".
// NoC: 20 where the IoU is never reached. "offers": {"likeliest", "best", "offered"}: image IoU of the first
// stroke's likeliest meaning and of the best that is offered, and how many are; means over starts. "zoom":
// {"0.4", "0.6", "1", "2", "4"}: image IoU of the first click alone with the camera at so many times the
// distance, mean over starts. "perturb": {"copies", "1" | "3" | "5" | "10": {"median", "least", "spread",
// "difference", "most_difference"}}: the same clicks on copies of the scene: mean over starts of the IoU's
// median, least and spread (largest less least) over the copies; the median and the largest of |IoU of a copy
// - IoU of the scene| over starts and copies.
#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "app/lab/eval_suite.h"
#include "app/measure/any_view.h"

namespace splatcut {

struct AnyViewOptions {
  std::string preset = "default";
  int clicks = 10;
  int draws = 1;   // sessions a start; the first with a steady hand
  int starts = 0;  // the first so many; 0: all
  bool zoom = false;
  bool choices = false;               // the robot takes what is offered for the first click
  bool sizes = false;                 // it turns the wheel after each click
  float near = 1;                     // it corrects from that share of the distance
  float details = 0;                  // it corrects details of so many pixels, see AnyViewHand
  std::optional<float> box_margin{};  // it begins with a box, see FirstStrokes
  int copies = 0;                     // of the scene, for "perturb"
  // Where set, each session's click_sheet(), with a name that serves as a file's.
  std::function<void(const std::string& name, const Image<Rgb8>& sheet)> on_sheet{};
};

// {"any_view": ..., and "offers", "zoom", "perturb" where asked}. Cancelled: incomplete.
nlohmann::json any_view_json(const LoadedCase& loaded, const AnyViewOptions& options, const Job& job);

// "any_view" of these sessions.
nlohmann::json sessions_json(const std::vector<AnyViewSession>& sessions, int clicks);

// A table of all scenes and their mean: result as eval.json has it.
void print_any_view(const nlohmann::json& result);

}  // namespace splatcut
