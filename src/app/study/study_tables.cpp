#include "app/study/study_tables.h"

#include <algorithm>
#include <cmath>

namespace splatcut {

namespace {

// What tells settings of one series apart, in few words.
std::string label_of(const nlohmann::json& result) {
  if (result.at("preset") != "default") return result.at("preset").get<std::string>();
  std::string label;
  for (const auto& assignment : result.at("set")) label += (label.empty() ? "" : " ") + assignment.get<std::string>();
  return label.empty() ? "default" : label;
}

struct Group {
  SettingScore score;
  std::vector<double> ms;
  int with_labels = 0;
};

}  // namespace

StudyResults of_experiment(const StudyResults& all, const std::string& experiment) {
  StudyResults some;
  std::ranges::copy_if(all, std::back_inserter(some), [&](const nlohmann::json& r) { return r.at("experiment") == experiment; });
  return some;
}

double quantile(std::vector<double> values, double share) {
  std::ranges::sort(values);
  const auto rank = static_cast<std::ptrdiff_t>(std::ceil(share * static_cast<double>(values.size()))) - 1;
  return values[static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(rank, 0, std::ssize(values) - 1))];
}

std::vector<SettingScore> scores_of(const StudyResults& results) {
  std::vector<Group> groups;
  for (const nlohmann::json& r : results) {
    const std::string label = label_of(r), series = r.at("series");
    const double x = r.at("x"), iou = r.at("image_iou");
    auto it = std::ranges::find_if(groups, [&](const Group& g) { return g.score.series == series && g.score.x == x && g.score.label == label; });
    if (it == groups.end()) {
      groups.emplace_back();
      it = groups.end() - 1;
      it->score.series = series;
      it->score.label = label;
      it->score.x = x;
    }
    SettingScore& s = it->score;
    s.iou += iou;
    s.least_iou = std::min(s.least_iou, iou);
    s.boundary += r.at("boundary_iou").get<double>();
    if (r.at("gaussian_iou").is_number()) {
      s.gaussian_iou += r.at("gaussian_iou").get<double>();
      ++it->with_labels;
    }
    it->ms.push_back(r.at("ms"));
    for (const auto& [stage, ms] : r.at("stages").items()) s.stages[stage] += ms.get<double>();
    ++s.scenes;
  }
  std::vector<SettingScore> scores;
  for (Group& g : groups) {
    const double n = g.score.scenes;
    g.score.iou /= n;
    g.score.boundary /= n;
    g.score.gaussian_iou /= std::max(1, g.with_labels);
    for (auto& [stage, ms] : g.score.stages) ms /= n;
    g.score.ms = quantile(g.ms, 0.5);
    scores.push_back(std::move(g.score));
  }
  return scores;
}

std::vector<SettingScore> pareto_front(std::vector<SettingScore> scores) {
  std::ranges::sort(scores, [](const SettingScore& a, const SettingScore& b) { return a.ms != b.ms ? a.ms < b.ms : a.iou > b.iou; });
  std::vector<SettingScore> front;
  for (SettingScore& s : scores)
    if (front.empty() || s.iou > front.back().iou) front.push_back(std::move(s));
  return front;
}

std::vector<Spread> spreads_of(const StudyResults& results) {
  std::map<std::pair<std::string, std::string>, std::vector<double>> values;
  for (const nlohmann::json& r : results) values[{r.at("scene"), r.at("series")}].push_back(r.at("image_iou"));
  std::vector<Spread> spreads;
  for (const auto& [at, v] : values)
    spreads.push_back({at.first, at.second, quantile(v, 0), quantile(v, 0.1), quantile(v, 0.5), quantile(v, 0.9), quantile(v, 1), v.size()});
  return spreads;
}

}  // namespace splatcut
