// The any-view robot: a simulated user who corrects the largest error of any view whose truth is known, again
// and again, on the cut that the window runs. It begins with a click or with a box, which counts as one.
//
// In: views with their true masks, a start, a cut (all clicks so far, in order, to labels) and a picture of
// labels. First click: the middle of the truth in the start's view, or the click that the scene gives where
// no truth of that view is known; first box: around that truth. Every further one: the middle (largest
// distance to its border; ties: the lowest pixel) of the largest wrong region over all views (pixels; ties:
// the lowest view, missing before extra). All clicks stay. After each the mean image IoU over all views is
// taken; where nothing is wrong any more it stays as it is. Source: the protocol of Xu et al., Deep
// Interactive Object Selection, 2016, over several views. Cost: one cut and one picture a view each click.
// Cancelled: incomplete, must not be used. With choices: where the program offers other meanings of the first
// click, the robot looks at them as a person does, in the clicked view alone, and takes the one whose IoU
// with that view's truth is the highest and at least .05 above the likeliest's. That costs a click. With
// sizes, it turns the wheel after each click, up and else down, as long as that view's IoU gains at least
// .002 by it. That costs none.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "app/measure/evaluate.h"
#include "segment/session/session.h"

namespace splatcut {

struct ViewClick {
  Camera camera;
  Stroke stroke;  // in the camera's pixels
};
using ViewClicks = std::vector<ViewClick>;

struct CutAnswer {
  std::vector<std::uint8_t> labels;  // per Gaussian, 1 = object
  std::vector<std::string> doubts;   // sentences
  std::vector<Mask> meanings{};      // of the first click in its view, see CutResult
};

struct TruthView {
  Camera camera;
  Mask truth;
};

struct AnyViewWorld {
  std::vector<TruthView> views;
  // choice: of the first click's meanings.
  std::function<CutAnswer(std::span<const ViewClick> in_order, int choice, const Job&)> cut;
  std::function<Mask(const Camera&, const std::vector<std::uint8_t>& labels)> picture;
  const GaussianCloud* cloud = nullptr;  // for clicks from near; null: there are none
};

struct AnyViewStart {
  std::string name;
  Camera camera;
  Stroke first;
};

struct AnyViewSession {
  std::string start;
  std::uint64_t draw = 0;         // 0: a steady hand
  ViewClicks clicks;              // fewer than asked where nothing was wrong any more
  int choice = 0;                 // of the first click's meanings; above 0 it took the second click
  std::vector<double> iou_after;  // mean over the views after 1, 2, ... clicks
  // Per click: its label shows within 2 px of it, at the end of its own cut. Of a box: most of what shows is
  // in it.
  std::vector<bool> obeyed;
  std::vector<bool> obeyed_pixel;                // the same of the clicked pixel itself
  std::vector<std::vector<std::string>> doubts;  // per click
  double ms_per_click = 0;                       // of the cuts, mean

  double obeyed_share() const;
  double worst_fall() const;  // of the IoU by a further click, at least 0
};

struct AnyViewHand {
  std::uint64_t draw = 0;  // 0: a steady one
  bool choices = false;    // takes what is offered
  bool sizes = false;      // turns the wheel after a click
  float near = 1;          // corrects from that share of the distance, where what is wrong shows from there
  float details =
      0;  // above 0: corrects any of wrong_details() of so many pixels by chance, while there is one
};
AnyViewSession any_view_session(const AnyViewWorld& world, const AnyViewStart& start, int clicks,
                                const AnyViewHand& hand = {}, const Job& job = {});

// Mean image IoU over the views of these clicks.
double iou_of_clicks(const AnyViewWorld& world, std::span<const ViewClick> clicks, const Job& job = {});

// The same of a first stroke by each of its meanings that are offered, the likeliest first.
std::vector<double> iou_of_meanings(const AnyViewWorld& world, const ViewClick& first, const Job& job = {});

// The cut of the window on one scene: what is prepared, the solver and the views drawn last serve all
// sessions.
class WindowCut {
 public:
  WindowCut(const EvaluationCase& scene, const std::string& preset);
  CutAnswer operator()(std::span<const ViewClick> in_order, int choice, const Job& job);

 private:
  Session session_;
  CutSettings settings_;
};

// The scene must outlive what is returned; views: of the scene, or of the one it is a copy of.
AnyViewWorld window_world(const EvaluationCase& scene, std::vector<TruthView> views,
                          std::shared_ptr<WindowCut> cut);

// Test views whose truth counts, then references whose truth is known, each camera once. Throws Error where
// there is none.
std::vector<TruthView> truth_views(const EvaluationCase& scene);

// How the robot begins.
struct FirstStrokes {
  std::optional<float> box_margin;  // with a box, larger by this share of each extent (robot_user.h); a click
  std::uint64_t draw = 0;           // 0: a steady hand
};

// The references, then the truth views, each camera once. A reference without truth starts with the first
// click that is given there; without that, or where boxes are asked for, it is none.
std::vector<AnyViewStart> any_view_starts(const EvaluationCase& scene, std::span<const TruthView> views,
                                          const FirstStrokes& how = {});

// The start's first click with the camera at `factor` of its distance from what the click hits, along the
// same ray: the same pixel. None where the click hits nothing, or from there something else, as a wall that
// now stands before it.
std::optional<ViewClick> zoomed_click(const GaussianCloud& cloud, const AnyViewStart& start, float factor);

}  // namespace splatcut
