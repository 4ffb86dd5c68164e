// Numbers of the study put together: what its charts and tables show.
#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace splatcut {

using StudyResults = std::vector<nlohmann::json>;

// The results of one experiment, in the order in which they were finished.
StudyResults of_experiment(const StudyResults& all, const std::string& experiment);

// The smallest value that at least that share of the values reach; values must not be empty.
double quantile(std::vector<double> values, double share);

// A cutout fails below an image IoU of .9, unless it is within .05 of the best of its scene in the
// experiment: what most nearly is as good as can be.
inline constexpr double kFails = 0.9, kNearBest = 0.05;

// Those that fail of one experiment's results.
StudyResults failing(const StudyResults& of_one_experiment);

// One setting over all scenes and draws.
struct SettingScore {
  std::string series, label;  // label: what tells it from others of its series
  double x = 0;
  double iou = 0, boundary = 0, gaussian_iou = 0;  // means
  double least = 1, p10 = 0, median = 0;           // of the image IoU
  double cpu_ms = 0;                               // median, of all threads
  double looked_at_mpx = 0;                        // mean
  int runs = 0;                                    // scenes x draws
  int failed = 0, failed_warned = 0,
      fine_warned = 0;                   // how many fail, of those how many with a word; words without need
  std::map<std::string, double> stages;  // mean ms
};

// One score per setting (series, x, and what was set), in order of first appearance; of one experiment.
std::vector<SettingScore> scores_of(const StudyResults& results);

// Those that no other beats in both cost and IoU, by rising cost.
std::vector<SettingScore> pareto_front(std::vector<SettingScore> scores);

// By how much the best IoU that costs no more is better; 0 on the front. cost: see the presets' test.
double behind_front(const SettingScore& score, const std::vector<SettingScore>& all,
                    double SettingScore::*cost);

// As a field of CSV: in quotes where it needs them.
std::string csv_field(const std::string& text);

// The names of the experiments, in order of first appearance.
std::vector<std::string> experiments_of(const StudyResults& all);

}  // namespace splatcut
