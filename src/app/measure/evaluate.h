// How good is a cutout: the measures of one scene against its truth.
//
// Truth is labels per Gaussian or masks of the test views. Pictures of labels: object white, everything
// else black and occluding, threshold 0.5 (the protocol of Jain et al., GaussianCut, 2024). A view in
// which the truth covers less than 0.1 % of the pixels does not count.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "app/measure/alone_score.h"
#include "segment/session/session.h"

namespace splatcut {

inline constexpr int kRobotClicks = 8;
inline constexpr int kClicksNotReached = 20;  // NoC where kRobotClicks are not enough

// A view in which the object may be clicked, with the clicks that are given there; none: the robot's.
struct GivenReference {
  Camera camera;
  Strokes clicks;
};

struct EvaluationCase {
  std::string name;
  const GaussianCloud* cloud = nullptr;
  PrepareOptions prepare;                  // of its sessions
  std::vector<std::uint8_t> truth_labels;  // per Gaussian of the cloud, or empty
  std::vector<std::uint8_t> own_labels;    // of them, what a perfect capture would hold; or empty: all
  std::vector<Camera> test_views;
  std::vector<Mask> truth_masks;  // per test view
  Camera reference;
  std::vector<GivenReference> more_references;  // of the same object, for the any-view robot
  glm::vec3 up_world{0, -1, 0};
  std::vector<Camera> scene_cameras;    // of its photographs, where known
  std::optional<Mask> reference_truth;  // needed by the robot
  Strokes clicks;                       // one after the other; none: the robot's, or the scribbles alone
  Strokes scribbles;                    // another answer, all at once
  bool scribbles_alone = false;         // no clicks but these
  KeptViews* kept_views = nullptr;      // of the cloud, for measuring; null: each view is drawn afresh
};

// A session on the case's scene, which must outlive it. Nothing is kept yet.
Session session_of(const EvaluationCase& scene);

// The strokes, as they are made in the reference.
CutRequest request_of(const EvaluationCase& scene, const Strokes& strokes);

struct EvaluationOptions {
  CutSettings settings;
  int clicks = 3;  // for the final cut
  bool truth_first_mask = false;
  bool truth_masks = false;  // in orbit views; needs truth_labels
  // No click at all: each test view that counts is left out in turn, the true masks of the others are given,
  // and the cutout is scored in the one left out. Needs two that count.
  bool masks_of_others = false;
  bool alone = false;       // the object by itself, too, as it is and with clean edges
  bool click_curve = true;  // mask IoU after 1..8 clicks, image IoU after 1, 3, 5
};

struct SceneScore {
  std::string name;
  double image_iou = 0, accuracy = 0, boundary_iou = 0;
  double psnr_db = 0, ssim = 0;  // of the object on black, see evaluate_picture.h
  std::optional<CutoutScore> alone;
  std::optional<double> gaussian_iou;
  std::vector<double> mask_iou_after_clicks;     // 1..8, robot only
  std::map<int, double> image_iou_after_clicks;  // 1, 3, 5
  std::optional<double> image_iou_by_scribbles;  // where the scene has some
  std::optional<int> noc85, noc90;
  LookedAt enough;                  // views and pixels of the final cut,
  std::size_t nodes_touched = 0;    // Gaussians that its solver looked at,
  std::string why_enough;           // and why there were no more views
  std::vector<std::string> doubts;  // what is said of the final cut
  std::vector<StageTime> stages;
  double total_ms = 0;
};

// The robot's strokes on the first mask, in reference pixels, and the mask's IoU after each. session: of the
// case's scene. draw: see robot_click.
struct RobotSession {
  Strokes strokes;                // fewer than clicks where nothing was wrong any more
  std::vector<double> iou_after;  // clicks values
};
// Throws Error where the truth of the reference is unknown.
RobotSession robot_session(const EvaluationCase& scene, Session* session, const CutSettings& settings,
                           int clicks, std::uint64_t draw = 0, const Job& job = {});

// Clicks until the IoU reaches the goal; kClicksNotReached where it does not.
int clicks_to(const std::vector<double>& iou_after, double goal);

// Whether the truth covers enough of its view for the view to count.
bool counts(const Mask& truth);

// Where the view shows the labelled Gaussians.
Mask labels_seen(const EvaluationCase& scene, const Camera& camera, const std::vector<std::uint8_t>& labels);

// Means over the test views that count.
struct ImageScore {
  double iou = 0, accuracy = 0, boundary = 0;
};
ImageScore score_images(const EvaluationCase& scene, const std::vector<std::uint8_t>& labels);
double label_iou(const std::vector<std::uint8_t>& truth, const std::vector<std::uint8_t>& labels);

// Fills truth_masks and reference_truth from truth_labels.
void render_truth(EvaluationCase* scene);

// Throws Error where the case lacks the truth that the options ask for.
SceneScore evaluate(const EvaluationCase& scene, const EvaluationOptions& options, const Job& job = {});

}  // namespace splatcut
