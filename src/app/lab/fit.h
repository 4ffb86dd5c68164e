// Fits weights to scenes: a pattern search, and what it gives on a scene that it was not fitted to.
//
// In: weights by name with their ranges, and the score of each scene (higher is better) with the weights as
// they stand. Out: the values with the best mean score. Search: round by round each weight in an order drawn
// by the seed, multiplied and divided by 1 + step (moved by step times its range where it is 0), the better
// kept where it gains; a round without a gain halves the step. Source: Hooke and Jeeves, "Direct search"
// solution of numerical and statistical problems, 1961, without its pattern moves. Cost: 2 x weights x rounds
// scores of each scene; scores are kept, so that fits that leave one scene out pay for what is new only. The
// same seed, the same values.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "scene/job.h"

namespace splatcut {

struct Weight {
  std::string name;
  float* value = nullptr;  // read by what is scored
  float low = 0, high = 1;
};

using WeightValues = std::vector<float>;  // in the order of the weights

struct FitOptions {
  std::uint64_t seed = 1;
  int rounds = 6;
  float first_step = 0.5f, least_step = 0.05f;
  double least_gain = 1e-4;  // of the mean score
};

struct Fit {
  WeightValues values;
  double score = 0;                  // mean over the scenes that it was fitted to
  std::vector<double> scene_scores;  // of every scene
};

class Fitter {
 public:
  // score: of scene number i with the weights as they stand; in [0, 1].
  Fitter(std::vector<Weight> weights, std::size_t scenes, std::function<double(std::size_t scene)> score);

  // Starts from the weights as they stood when the Fitter was made. Cancelled: unspecified. The weights are
  // as they stood again afterwards.
  Fit fit(std::span<const std::size_t> to_scenes, const FitOptions& options, const Job& job = {});
  // Every scene with these values.
  std::vector<double> scores_with(const WeightValues& values);

  const WeightValues& shipped() const { return shipped_; }
  std::size_t scored() const { return kept_.size(); }  // scenes scored so far, each set of values once

 private:
  double score_of(std::size_t scene, const WeightValues& values);
  double mean_score(std::span<const std::size_t> scenes, const WeightValues& values);
  void set(const WeightValues& values);

  std::vector<Weight> weights_;
  std::size_t scenes_;
  std::function<double(std::size_t)> score_;
  WeightValues shipped_;
  std::map<std::pair<std::size_t, WeightValues>, double> kept_;
};

// Per scene: its score as shipped, fitted to all scenes, and fitted to all others. With the values of each
// fit.
struct LeaveOneOut {
  std::vector<double> shipped, with, without;
  Fit all;
  std::vector<Fit> others;  // [i]: fitted without scene i
};
LeaveOneOut leave_one_out(Fitter* fitter, std::size_t scenes, const FitOptions& options, const Job& job = {});

}  // namespace splatcut
