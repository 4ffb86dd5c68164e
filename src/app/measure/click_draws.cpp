#include "app/measure/click_draws.h"

#include <algorithm>

namespace splatcut {

namespace {

// The views whose true mask is known and shows the object, each as the one that is clicked.
std::vector<EvaluationCase> clicked_views(const EvaluationCase& scene) {
  if (scene.reference_truth) return {scene};
  std::vector<EvaluationCase> views;
  for (std::size_t v = 0; v < scene.test_views.size() && v < scene.truth_masks.size(); ++v) {
    if (!counts(scene.truth_masks[v])) continue;
    views.push_back(scene);
    views.back().reference = scene.test_views[v];
    views.back().reference_truth = scene.truth_masks[v];
  }
  return views;
}

double median_of(std::vector<double> values) {
  std::ranges::sort(values);
  const std::size_t n = values.size();
  return n % 2 ? values[n / 2] : 0.5 * (values[n / 2 - 1] + values[n / 2]);
}

}  // namespace

ClickDraws draw_clicks(const EvaluationCase& scene, const CutSettings& settings, int clicks, int draws,
                       const Job& job) {
  ClickDraws result;
  Session session = session_of(scene);
  for (const EvaluationCase& view : clicked_views(scene))
    for (int draw = 0; draw < draws && !job.cancelled(); ++draw)
      result.iou_after.push_back(
          robot_session(view, &session, settings, clicks, static_cast<std::uint64_t>(draw), job).iou_after);
  if (result.iou_after.empty() || job.cancelled()) return result;
  const auto n = static_cast<double>(result.iou_after.size());
  for (std::size_t k = 0; k < static_cast<std::size_t>(clicks); ++k) {
    std::vector<double> at;
    for (const auto& ious : result.iou_after) at.push_back(ious[k]);
    result.median.push_back(median_of(at));
    result.least.push_back(std::ranges::min(at));
    if (k > 0) result.least_from_second = std::min(result.least_from_second, result.least.back());
  }
  for (const auto& ious : result.iou_after) {
    const int noc90 = clicks_to(ious, 0.90);
    result.mean_noc85 += clicks_to(ious, 0.85) / n;
    result.mean_noc90 += noc90 / n;
    result.most_noc90 = std::max(result.most_noc90, noc90);
  }
  return result;
}

}  // namespace splatcut
