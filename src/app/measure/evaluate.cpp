#include "app/measure/evaluate.h"

#include <algorithm>
#include <chrono>
#include <numeric>

#include "app/measure/evaluate_alone.h"
#include "app/measure/evaluate_picture.h"
#include "app/measure/mask_measures.h"
#include "app/measure/robot_user.h"
#include "core/error.h"
#include "core/stage_clock.h"
#include "segment/masks/mask_tools.h"
#include "segment/session/doubts.h"

namespace splatcut {

namespace {

constexpr double kLeastTruthShare = 0.001;

Strokes first_strokes(const Strokes& strokes, int n) {
  return {strokes.begin(), strokes.begin() + std::min<std::ptrdiff_t>(n, std::ssize(strokes))};
}

CutRequest request_with(const EvaluationCase& scene, const EvaluationOptions& options,
                        const Strokes& strokes) {
  CutRequest request = request_of(scene, strokes);
  if (options.truth_first_mask) {
    if (!scene.reference_truth)
      throw Error(scene.name, "--first-mask truth needs the truth of the reference view");
    request.strokes.clear();
    request.first_mask = {scene.reference, *scene.reference_truth};
  }
  if (options.truth_masks) {
    if (scene.truth_labels.empty()) throw Error(scene.name, "--masks truth needs truth labels");
    request.mask_source = [&scene](const Camera& camera) {
      return labels_seen(scene, camera, scene.truth_labels);
    };
  }
  return request;
}

// The case with one test view, and with the masks of all others that count for a request.
CutRequest leave_out(std::size_t left_out, EvaluationCase* scene) {
  CutRequest request;
  for (std::size_t v = 0; v < scene->test_views.size(); ++v) {
    if (v == left_out || !counts(scene->truth_masks[v])) continue;
    GivenView given{scene->test_views[v], scene->truth_masks[v]};
    if (request.first_mask)
      request.masks.push_back(std::move(given));
    else
      request.first_mask = std::move(given);
  }
  if (!request.first_mask) throw Error(scene->name, "--masks others needs two views whose truth is known");
  scene->test_views = {scene->test_views[left_out]};
  scene->truth_masks = {scene->truth_masks[left_out]};
  return request;
}

// Means over the views left out; what it looked at is the last one's. No stages, no doubts.
SceneScore evaluate_left_out(const EvaluationCase& scene, const EvaluationOptions& options, const Job& job) {
  const CutSettings& settings = options.settings;
  SceneScore mean;
  if (options.alone) mean.alone.emplace();
  mean.name = scene.name;
  const auto views = std::ranges::count_if(scene.truth_masks, counts);
  const auto share = 1.0 / static_cast<double>(std::max<std::ptrdiff_t>(1, views));
  Session session = session_of(scene);
  for (std::size_t v = 0; v < scene.test_views.size(); ++v) {
    if (!counts(scene.truth_masks[v])) continue;
    EvaluationCase left_out = scene;
    const CutRequest request = leave_out(v, &left_out);
    const auto start = std::chrono::steady_clock::now();
    const CutResult result = session.cut(request, settings, job);
    if (job.cancelled()) return mean;
    mean.total_ms += share * ms_since(start);
    const ImageScore images = score_images(left_out, result.labels);
    mean.image_iou += share * images.iou;
    mean.accuracy += share * images.accuracy;
    mean.boundary_iou += share * images.boundary;
    const PictureScore pictures = score_pictures(left_out, result.labels);
    mean.psnr_db += share * pictures.psnr_db;
    mean.ssim += share * pictures.ssim;
    if (options.alone) add_share(score_cutout(left_out, result.labels, job), share, &*mean.alone);
    mean.enough = looked_at(result.views);
    mean.nodes_touched = result.cut.touched;
    mean.why_enough = result.why_enough;
  }
  return mean;
}

}  // namespace

Session session_of(const EvaluationCase& scene) {
  const std::shared_ptr<void> elsewhere;  // the case's owner owns them
  return Session({{elsewhere, scene.cloud}, {}, scene.up_world, scene.scene_cameras, scene.prepare});
}

CutRequest request_of(const EvaluationCase& scene, const Strokes& strokes) {
  CutRequest request;
  request.strokes = {{scene.reference, strokes}};
  return request;
}

int clicks_to(const std::vector<double>& iou_after, double goal) {
  const auto reached = std::ranges::find_if(iou_after, [&](double v) { return v >= goal; });
  return reached == iou_after.end() ? kClicksNotReached : static_cast<int>(reached - iou_after.begin()) + 1;
}

double label_iou(const std::vector<std::uint8_t>& truth, const std::vector<std::uint8_t>& labels) {
  std::size_t both = 0, either = 0;
  for (std::size_t g = 0; g < truth.size(); ++g) {
    both += truth[g] && labels[g];
    either += truth[g] || labels[g];
  }
  return either ? static_cast<double>(both) / static_cast<double>(either) : 1.0;
}

bool counts(const Mask& truth) {
  return static_cast<double>(count(truth)) >= kLeastTruthShare * static_cast<double>(truth.size());
}

Mask labels_seen(const EvaluationCase& scene, const Camera& camera, const std::vector<std::uint8_t>& labels) {
  return thresholded(render_labels({*scene.cloud, scene.kept_views}, camera, labels), 0.5f);
}

ImageScore score_images(const EvaluationCase& scene, const std::vector<std::uint8_t>& labels) {
  ImageScore sum;
  int views = 0;
  for (std::size_t v = 0; v < scene.test_views.size(); ++v) {
    const Mask& truth = scene.truth_masks[v];
    if (!counts(truth)) continue;
    const Mask seen = labels_seen(scene, scene.test_views[v], labels);
    sum.iou += iou(truth, seen);
    sum.accuracy += pixel_accuracy(truth, seen);
    sum.boundary += boundary_iou(truth, seen);
    ++views;
  }
  if (views == 0) throw Error(scene.name, "the truth shows in none of its test views");
  return {sum.iou / views, sum.accuracy / views, sum.boundary / views};
}

// The robot works on the mask's own picture size.
RobotSession robot_session(const EvaluationCase& scene, Session* session, const CutSettings& settings,
                           int clicks, std::uint64_t draw, const Job& job) {
  const Camera work = limited_to_width(scene.reference, settings.work_width_px);
  const float to_reference = static_cast<float>(scene.reference.width_px) / static_cast<float>(work.width_px);
  if (scene.truth_labels.empty() && !scene.reference_truth)
    throw Error(scene.name, "the robot needs the truth of the reference view");
  const Mask truth = scene.truth_labels.empty()
                         ? resized_mask(*scene.reference_truth, work.width_px, work.height_px)
                         : labels_seen(scene, work, scene.truth_labels);
  Mask mask(work.width_px, work.height_px);
  RobotSession robot;
  for (int i = 0; i < clicks && !job.cancelled(); ++i) {
    if (const auto next = robot_click(truth, mask, draw ? draw * 16 + static_cast<std::uint64_t>(i) : 0)) {
      const Strokes scaled_click = scaled({*next}, to_reference);
      robot.strokes.push_back(scaled_click.front());
      const Mask found = session->first_mask(request_of(scene, robot.strokes), settings, job);
      if (job.cancelled()) break;  // there is no mask
      mask = resized_mask(found, work.width_px, work.height_px);
    }
    robot.iou_after.push_back(iou(truth, mask));
  }
  return robot;
}

void render_truth(EvaluationCase* scene) {
  scene->truth_masks.clear();
  for (const Camera& view : scene->test_views)
    scene->truth_masks.push_back(labels_seen(*scene, view, scene->truth_labels));
  scene->reference_truth = labels_seen(*scene, scene->reference, scene->truth_labels);
}

SceneScore evaluate(const EvaluationCase& scene, const EvaluationOptions& options, const Job& job) {
  if (options.masks_of_others) return evaluate_left_out(scene, options, job);
  SceneScore score;
  score.name = scene.name;
  const bool scribbles_alone = scene.scribbles_alone && !options.truth_first_mask;
  Strokes strokes = scribbles_alone ? scene.scribbles : scene.clicks;
  Session session = session_of(scene);
  if (strokes.empty() && !options.truth_first_mask) {
    const RobotSession robot =
        robot_session(scene, &session, options.settings,
                      options.click_curve ? std::max(kRobotClicks, options.clicks) : options.clicks, 0, job);
    strokes = robot.strokes;
    score.mask_iou_after_clicks = robot.iou_after;
    if (options.click_curve) {
      score.noc85 = clicks_to(robot.iou_after, 0.85);
      score.noc90 = clicks_to(robot.iou_after, 0.90);
    }
  }
  if (options.click_curve && !options.truth_first_mask && !scribbles_alone)
    for (const int n : {1, 3, 5}) {
      const CutResult result =
          session.cut(request_with(scene, options, first_strokes(strokes, n)), options.settings, job);
      if (job.cancelled()) return score;
      score.image_iou_after_clicks[n] = score_images(scene, result.labels).iou;
    }
  Session timed = session_of(scene);  // that knows nothing yet
  const CutRequest request =
      request_with(scene, options, scribbles_alone ? strokes : first_strokes(strokes, options.clicks));
  const auto start = std::chrono::steady_clock::now();
  const CutResult result = timed.cut(request, options.settings, job);
  score.total_ms = ms_since(start);
  score.stages = result.stages;
  score.enough = looked_at(result.views);
  score.nodes_touched = result.cut.touched;
  score.why_enough = result.why_enough;
  score.doubts = doubts(result);
  if (job.cancelled()) return score;
  const ImageScore images = score_images(scene, result.labels);
  score.image_iou = images.iou;
  score.accuracy = images.accuracy;
  score.boundary_iou = images.boundary;
  const PictureScore pictures = score_pictures(scene, result.labels);
  score.psnr_db = pictures.psnr_db;
  score.ssim = pictures.ssim;
  if (options.alone) score.alone = score_cutout(scene, result.labels, job);
  if (scribbles_alone) score.image_iou_by_scribbles = score.image_iou;
  if (!scribbles_alone && !scene.scribbles.empty() && !options.truth_first_mask) {
    const CutResult by_scribbles =
        session.cut(request_with(scene, options, scene.scribbles), options.settings, job);
    if (!job.cancelled()) score.image_iou_by_scribbles = score_images(scene, by_scribbles.labels).iou;
  }
  if (!scene.truth_labels.empty()) score.gaussian_iou = label_iou(scene.truth_labels, result.labels);
  return score;
}

}  // namespace splatcut
