#include "app/lab/study/study_tables.h"

#include <algorithm>
#include <cmath>

namespace splatcut {

namespace {

// What tells settings of one series apart, in few words.
std::string label_of(const nlohmann::json& result) {
  if (result.at("preset") != "default") return result.at("preset").get<std::string>();
  std::string label;
  for (const auto& assignment : result.at("set"))
    label.append(label.empty() ? "" : " ").append(assignment.get<std::string>());
  return label.empty() ? "default" : label;
}

struct Group {
  SettingScore score;
  std::vector<double> cpu_ms, iou;
  int with_labels = 0;
};

// Below that image IoU a cutout of the scene fails.
std::map<std::string, double> limits_of(const StudyResults& results) {
  std::map<std::string, double> limits;
  for (const nlohmann::json& r : results) {
    double& limit = limits[r.at("scene")];
    limit = std::clamp(r.at("image_iou").get<double>() - kNearBest, limit, kFails);
  }
  return limits;
}

void add(const nlohmann::json& r, double limit, Group* group) {
  SettingScore& s = group->score;
  const double iou = r.at("image_iou");
  const bool failed = iou < limit, warned = !r.at("warned").get<std::string>().empty();
  s.iou += iou;
  s.boundary += r.at("boundary_iou").get<double>();
  if (r.at("gaussian_iou").is_number()) {
    s.gaussian_iou += r.at("gaussian_iou").get<double>();
    ++group->with_labels;
  }
  s.looked_at_mpx += r.at("looked_at_mpx").get<double>();
  s.failed += failed;
  s.failed_warned += failed && warned;
  s.fine_warned += !failed && warned;
  group->iou.push_back(iou);
  group->cpu_ms.push_back(r.at("cpu_ms"));
  for (const auto& [stage, ms] : r.at("stages").items()) s.stages[stage] += ms.get<double>();
  ++s.runs;
}

SettingScore finished(Group g) {
  SettingScore& s = g.score;
  const double n = s.runs;
  for (double* sum : {&s.iou, &s.boundary, &s.looked_at_mpx}) *sum /= n;
  s.gaussian_iou /= std::max(1, g.with_labels);
  for (auto& [stage, ms] : s.stages) ms /= n;
  s.cpu_ms = quantile(g.cpu_ms, 0.5);
  s.least = quantile(g.iou, 0);
  s.p10 = quantile(g.iou, 0.1);
  s.median = quantile(g.iou, 0.5);
  return std::move(s);
}

}  // namespace

StudyResults of_experiment(const StudyResults& all, const std::string& experiment) {
  StudyResults some;
  std::ranges::copy_if(all, std::back_inserter(some),
                       [&](const nlohmann::json& r) { return r.at("experiment") == experiment; });
  return some;
}

StudyResults failing(const StudyResults& of_one_experiment) {
  StudyResults some;
  const auto limits = limits_of(of_one_experiment);
  std::ranges::copy_if(of_one_experiment, std::back_inserter(some), [&](const nlohmann::json& r) {
    return r.at("image_iou").get<double>() < limits.at(r.at("scene"));
  });
  return some;
}

double quantile(std::vector<double> values, double share) {
  std::ranges::sort(values);
  const auto rank = static_cast<std::ptrdiff_t>(std::ceil(share * static_cast<double>(values.size()))) - 1;
  return values[static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(rank, 0, std::ssize(values) - 1))];
}

std::vector<SettingScore> scores_of(const StudyResults& results) {
  std::vector<Group> groups;
  const auto limits = limits_of(results);
  for (const nlohmann::json& r : results) {
    const std::string label = label_of(r), series = r.at("series");
    const double x = r.at("x");
    auto it = std::ranges::find_if(groups, [&](const Group& g) {
      return g.score.series == series && g.score.x == x && g.score.label == label;
    });
    if (it == groups.end()) {
      groups.emplace_back();
      it = groups.end() - 1;
      it->score.series = series;
      it->score.label = label;
      it->score.x = x;
    }
    add(r, limits.at(r.at("scene")), &*it);
  }
  std::vector<SettingScore> scores;
  for (Group& g : groups) scores.push_back(finished(std::move(g)));
  return scores;
}

std::vector<SettingScore> pareto_front(std::vector<SettingScore> scores) {
  std::ranges::sort(scores, [](const SettingScore& a, const SettingScore& b) {
    return a.cpu_ms != b.cpu_ms ? a.cpu_ms < b.cpu_ms : a.iou > b.iou;
  });
  std::vector<SettingScore> front;
  for (SettingScore& s : scores)
    if (front.empty() || s.iou > front.back().iou) front.push_back(std::move(s));
  return front;
}

double behind_front(const SettingScore& score, const std::vector<SettingScore>& all,
                    double SettingScore::*cost) {
  double best = score.iou;
  for (const SettingScore& other : all)
    if (other.*cost <= score.*cost) best = std::max(best, other.iou);
  return best - score.iou;
}

std::string csv_field(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

std::vector<std::string> experiments_of(const StudyResults& all) {
  std::vector<std::string> names;
  for (const nlohmann::json& r : all)
    if (const std::string name = r.at("experiment"); std::ranges::find(names, name) == names.end())
      names.push_back(name);
  return names;
}

}  // namespace splatcut
