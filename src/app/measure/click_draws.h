// How well the first mask does when the hand is unsteady: the robot's clicks, drawn again and again.
//
// Where the truth is labels, the reference is clicked; where it is masks of photographs, each of them in
// turn.
#pragma once

#include <vector>

#include "app/measure/evaluate.h"

namespace splatcut {

struct ClickDraws {
  std::vector<std::vector<double>> iou_after;  // per draw: mask IoU after 1, 2, ... clicks
  std::vector<double> median, least;           // per number of clicks, over the draws
  double mean_noc85 = 0,
         mean_noc90 = 0;  // clicks to an IoU of .85, .90; kClicksNotReached where they never do
  int most_noc90 = 0;
  double least_from_second = 1;  // least IoU of any draw from the second click on
};

// draws sessions of `clicks` clicks, the first with a steady hand. Empty where the truth of no view is known.
// Cancelled: incomplete, must not be used.
ClickDraws draw_clicks(const EvaluationCase& scene, const CutSettings& settings, int clicks, int draws,
                       const Job& job = {});

}  // namespace splatcut
