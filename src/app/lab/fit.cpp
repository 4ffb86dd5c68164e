#include "app/lab/fit.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "scene/counter_rng.h"

namespace splatcut {

namespace {

std::vector<std::size_t> all_below(std::size_t n) {
  std::vector<std::size_t> all(n);
  std::iota(all.begin(), all.end(), std::size_t{0});
  return all;
}

std::vector<std::size_t> drawn_order(std::size_t n, std::uint64_t seed, int round) {
  std::vector<std::size_t> order = all_below(n);
  CounterRng random(seed, static_cast<std::uint64_t>(round));
  for (std::size_t i = n; i > 1; --i) std::swap(order[i - 1], order[random.below(i)]);
  return order;
}

// The weight one step up and one step down, within its range.
std::vector<float> tries(const Weight& weight, float value, float step) {
  const float range = weight.high - weight.low;
  std::vector<float> all = value == 0 ? std::vector<float>{step * range, -step * range}
                                      : std::vector<float>{value * (1 + step), value / (1 + step)};
  for (float& v : all) v = std::clamp(v, weight.low, weight.high);
  std::erase(all, value);
  return all;
}

}  // namespace

Fitter::Fitter(std::vector<Weight> weights, std::size_t scenes, std::function<double(std::size_t)> score)
    : weights_(std::move(weights)), scenes_(scenes), score_(std::move(score)) {
  for (const Weight& w : weights_) shipped_.push_back(*w.value);
}

void Fitter::set(const WeightValues& values) {
  for (std::size_t i = 0; i < weights_.size(); ++i) *weights_[i].value = values[i];
}

double Fitter::score_of(std::size_t scene, const WeightValues& values) {
  const auto [it, fresh] = kept_.try_emplace({scene, values}, 0);
  if (fresh) {
    set(values);
    it->second = score_(scene);
    set(shipped_);
  }
  return it->second;
}

double Fitter::mean_score(std::span<const std::size_t> scenes, const WeightValues& values) {
  double sum = 0;
  for (const std::size_t scene : scenes) sum += score_of(scene, values);
  return sum / static_cast<double>(scenes.size());
}

std::vector<double> Fitter::scores_with(const WeightValues& values) {
  std::vector<double> scores;
  for (std::size_t scene = 0; scene < scenes_; ++scene) scores.push_back(score_of(scene, values));
  return scores;
}

Fit Fitter::fit(std::span<const std::size_t> to_scenes, const FitOptions& options, const Job& job) {
  Fit best{shipped_, mean_score(to_scenes, shipped_), {}};
  float step = options.first_step;
  for (int round = 0; round < options.rounds && step >= options.least_step && !job.cancelled(); ++round) {
    bool gained = false;
    for (const std::size_t w : drawn_order(weights_.size(), options.seed, round))
      for (const float value : tries(weights_[w], best.values[w], step)) {
        if (job.cancelled()) return best;
        WeightValues tried = best.values;
        tried[w] = value;
        const double score = mean_score(to_scenes, tried);
        if (score < best.score + options.least_gain) continue;
        best.values = std::move(tried);
        best.score = score;
        gained = true;
        break;
      }
    if (!gained) step /= 2;
  }
  if (!job.cancelled()) best.scene_scores = scores_with(best.values);
  return best;
}

LeaveOneOut leave_one_out(Fitter* fitter, std::size_t scenes, const FitOptions& options, const Job& job) {
  LeaveOneOut table;
  const std::vector<std::size_t> all = all_below(scenes);
  table.shipped = fitter->scores_with(fitter->shipped());
  table.all = fitter->fit(all, options, job);
  table.with = table.all.scene_scores;
  for (std::size_t left_out = 0; left_out < scenes && scenes > 1 && !job.cancelled(); ++left_out) {
    std::vector<std::size_t> others = all;
    std::erase(others, left_out);
    table.others.push_back(fitter->fit(others, options, job));
    if (!job.cancelled()) table.without.push_back(table.others.back().scene_scores[left_out]);
  }
  return table;
}

}  // namespace splatcut
