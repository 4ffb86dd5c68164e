#include <fmt/format.h>

#include "app/lab/study/study_grid.h"
#include "app/lab/study/study_plan.h"
#include "app/lab/study/study_scenes.h"

namespace splatcut {

namespace {

// A draw's clicks are made once, for all that is asked of them.
void plan_clicks(StudyGrid* grid) {
  for (int draw = 1; draw <= grid->draws(); ++draw)
    for (const bool reordered : {false, true})
      for (int clicks = reordered ? 2 : 1; clicks <= 3; ++clicks) {
        StudyCell& cell = grid->add(reordered ? "click order" : "click jitter", "unsteady hand", clicks);
        cell.clicks = clicks;
        cell.reordered = reordered;
        cell.draw = static_cast<std::uint64_t>(draw);
      }
}

void plan_views_of_it(StudyGrid* grid) {
  const auto drawn = [&](const char* experiment, double StudyCell::*what, double unit,
                         std::initializer_list<double> values) {
    for (const double x : grid->some(values))
      grid->drawn(experiment, "3 clicks", x, {}, [&](StudyCell& cell) { cell.*what = unit * x; });
  };
  drawn("strokes", &StudyCell::stroke_px, 1, {16, 64});
  drawn("step back", &StudyCell::step_back, 1, {0.6, 3, 1, 2, 4, 6});
  drawn("object share", &StudyCell::object_share, 0.01, {1, 50, 5, 20});
  drawn("occlusion", &StudyCell::hidden, 0.01, {50, 75});
  drawn("other resolution", &StudyCell::picture_scale, 1, {0.25, 1});
  drawn("wrong up", &StudyCell::up_tilt_deg, 1, {90});
  drawn("scene scale", &StudyCell::scene_scale, 1, {0.01, 100});
}

struct Bad {
  const char* kind;
  std::vector<int> px;
};

void plan_bad_masks(StudyGrid* grid) {
  for (const Bad& bad : {Bad{"erode", {4, 8}}, Bad{"dilate", {8}}, Bad{"shift", {16, 32}}, Bad{"empty", {0}},
                         Bad{"full", {0}}})
    for (const int px : bad.px) {
      if (grid->quick() && px != bad.px.front()) continue;
      for (const double percent : grid->some({25, 50}))
        grid->drawn("bad masks", px == 0 ? bad.kind : fmt::format("{} {} px", bad.kind, px), percent, {},
                    [&](StudyCell& cell) {
                      cell.masks = 9;
                      cell.disturbance = {bad.kind, std::max(1, px)};  // 0 px would be no disturbance
                      cell.disturbed_share = percent / 100;
                    });
    }
}

// On still lifes that have what is hard.
void plan_still_lifes(StudyGrid* grid) {
  for (double number = 0; const HardStillLife& hard : hard_still_lifes()) {
    for (int draw = 1; draw <= grid->draws() && (hard.quick || !grid->quick()); ++draw)
      for (const int clicks : {1, 3}) {
        StudyCell& cell = grid->add("hard scenes", clicks == 1 ? "1 click" : "3 clicks", number);
        cell.still_life = hard.name;
        cell.clicks = clicks;
        cell.draw = static_cast<std::uint64_t>(draw);
      }
    ++number;
  }
}

}  // namespace

void plan_stability(StudyGrid* grid) {
  plan_clicks(grid);
  plan_views_of_it(grid);
  plan_bad_masks(grid);
  plan_still_lifes(grid);
}

const std::vector<StabilityAxis>& stability_axes() {
  static const std::vector<StabilityAxis> axes = [] {
    std::vector<StabilityAxis> all = {
        {"click jitter", "click_jitter", "The same object, clicked again and again", "clicks",
         "set xtics 1\nset offsets 0.2, 0.2, 0, 0\n"},
        {"click order", "click_order", "The same clicks in another order", "clicks",
         "set xtics 1\nset offsets 0.2, 0.2, 0, 0\n"},
        {"strokes", "long_strokes", "Strokes across whatever comes in place of clicks",
         "length of each stroke (pixels of its view)", "set logscale x 2\n"},
        {"step back", "step_back", "Clicked from nearer and farther", "distance (of each view's own)",
         "set logscale x 2\n"},
        {"object share", "object_share", "Small and large in the clicked views",
         "object's share of the picture (%)", "set logscale x\n"},
        {"occlusion", "occlusion", "Hidden in the first view by a board", "hidden share of the object (%)",
         ""},
        {"other resolution", "other_resolution", "Clicked in smaller pictures",
         "width of the pictures (of their own)", "set logscale x 2\n"},
        {"wrong up", "wrong_up", "Up is not up", "tilt (degrees)", ""},
        {"scene scale", "scene_scale", "The same scene in other units", "scale (times)", "set logscale x\n"},
        {"bad masks", "bad_masks", "Some of the masks are wrong",
         "share of the views whose mask is wrong (%)", ""},
    };
    std::string names;
    for (int number = 0; const HardStillLife& hard : hard_still_lifes())
      names += fmt::format("{}'{}' {}", number ? ", " : "", hard.name, number), ++number;
    all.push_back(
        {"hard scenes", "hard_scenes", "Still lifes that have what is hard", "",
         fmt::format(
             "set xtics ({}) rotate by -25\nset xrange [-0.4:*]\nset offsets 0, 0.6, 0, 0\nset bmargin 6\n",
             names)});
    return all;
  }();
  return axes;
}

bool is_stability(const std::string& experiment) {
  return std::ranges::find(stability_axes(), experiment, &StabilityAxis::experiment) !=
         stability_axes().end();
}

}  // namespace splatcut
