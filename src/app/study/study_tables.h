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

// One setting over all scenes.
struct SettingScore {
  std::string series, label;  // label: what tells it from others of its series
  double x = 0;
  double iou = 0, least_iou = 1, boundary = 0, gaussian_iou = 0;  // means (and the least) over the scenes
  double ms = 0;                                                  // median over the scenes
  int scenes = 0;
  std::map<std::string, double> stages;                           // mean ms
};

// One score per setting (series, x, and what was set), in order of first appearance.
std::vector<SettingScore> scores_of(const StudyResults& results);

// Those that no other beats in both time and IoU, by rising time.
std::vector<SettingScore> pareto_front(std::vector<SettingScore> scores);

// Of the image IoU over the draws, per scene and series.
struct Spread {
  std::string scene, series;
  double least = 0, p10 = 0, median = 0, p90 = 0, most = 0;
  std::size_t draws = 0;
};
std::vector<Spread> spreads_of(const StudyResults& results);

}  // namespace splatcut
