#include <fmt/format.h>

#include "app/lab/study/study_grid.h"
#include "app/lab/study/study_plan.h"
#include "app/lab/study/study_scenes.h"

namespace splatcut {

namespace {

void plan_clicks(StudyGrid* grid) {
  for (const int clicks : {1, 2, 3})
    grid->drawn("click jitter", "unsteady robot", clicks, {}, [&](StudyCell& cell) { cell.clicks = clicks; });
  for (const int clicks : {2, 3, 5}) {
    if (grid->quick() && clicks == 2) continue;
    grid->drawn("click order", "steady robot's clicks, shuffled", clicks, {}, [&](StudyCell& cell) {
      cell.clicks = clicks;
      cell.order = std::exchange(cell.draw, 0);
    });
  }
  for (const double length : grid->some({4, 32, 8, 16, 64}))
    grid->drawn("strokes across the border", "3 strokes", length, {},
                [&](StudyCell& cell) { cell.stroke_px = length; });
}

void plan_views_of_it(StudyGrid* grid) {
  const Settings six = {"views.settled_change=0", "views.most=6"};
  for (const double scale : grid->some({0.01, 100, 0.1, 10, 1}))
    grid->drawn("scene scale", "3 clicks", scale, {}, [&](StudyCell& c) { c.scene_scale = scale; });
  for (const double tilt : grid->some({30, 180, 90, 0}))
    grid->drawn("wrong up", "3 clicks", tilt, six, [&](StudyCell& c) { c.up_tilt_deg = tilt; });
  for (const double sizes : grid->some({0.8, 4, 1.2, 1.6, 2.5})) {
    Settings set = six;
    set.push_back(fmt::format("views.distance_sizes={}", sizes));
    grid->drawn("orbit distance", "3 clicks", sizes, set, [](StudyCell&) {});
  }
  for (const double back : grid->some({0.6, 3, 1, 2, 6}))
    grid->drawn("step back", "3 clicks", back, {}, [&](StudyCell& c) { c.step_back = back; });
  for (const double percent : grid->some({0.2, 50, 1, 5, 20}))
    grid->drawn("object share", "3 clicks", percent, {},
                [&](StudyCell& c) { c.object_share = percent / 100; });
  for (const double hidden : grid->some({25, 75, 0, 50}))
    grid->drawn("occlusion", "3 clicks", hidden, {}, [&](StudyCell& c) { c.hidden = hidden / 100; });
  for (const double times : grid->some({0.25, 2, 0.5, 1}))
    grid->drawn("other resolution", "3 clicks", times, {}, [&](StudyCell& c) { c.score_scale = times; });
  for (const double views : grid->some({0, 2, 1, 4})) {
    Settings set = {"first.from=pixels", "views.settled_change=0", fmt::format("views.most={}", views)};
    grid->drawn("too few views", "from pixels, 3 clicks", views, set, [](StudyCell&) {});
    set.erase(set.begin());
    grid->drawn("too few views", "from parts, 3 clicks", views, set, [](StudyCell&) {});
  }
}

struct Bad {
  const char* kind;
  std::vector<int> px;
};

void plan_bad_masks(StudyGrid* grid) {
  for (const Bad& bad : {Bad{"erode", {4, 2, 8}}, Bad{"dilate", {4, 2, 8}}, Bad{"shift", {16, 8, 32}},
                         Bad{"holes", {6, 3}}, Bad{"empty", {0}}, Bad{"full", {0}}})
    for (const int px : bad.px) {
      if (grid->quick() &&
          (px != bad.px.front() || bad.kind == std::string("dilate") || bad.kind == std::string("holes")))
        continue;
      for (const double percent : grid->some({25, 50, 12.5}))
        for (const char* solver : {"cut", "threshold"})
          grid->drawn("bad masks",
                      px == 0 ? fmt::format("{}, {}", bad.kind, solver)
                              : fmt::format("{} {} px, {}", bad.kind, px, solver),
                      percent,
                      {"first.from=pixels", "views.most=8", "views.settled_change=0",
                       std::string("energy.coarse=") + (std::string(solver) == "cut" ? "0" : "1")},
                      [&](StudyCell& cell) {
                        cell.first = "truth";
                        cell.true_masks = true;
                        cell.disturbance = {bad.kind, std::max(1, px)};  // 0 px would be no disturbance
                        cell.disturbed_share = percent / 100;
                      });
    }
}

// On still lifes that have what is hard.
void plan_still_lifes(StudyGrid* grid) {
  double number = 0;
  for (const HardStillLife& hard : hard_still_lifes()) {
    const bool thin = hard.thin_width > 0;
    if (grid->quick() && !hard.quick) continue;
    for (const int clicks : {1, 3}) {
      if (thin && clicks == 1) continue;
      grid->drawn(thin ? "thin parts" : "hard scenes",
                  fmt::format("{} click{}", clicks, clicks == 1 ? "" : "s"), thin ? hard.thin_width : number,
                  {}, [&](StudyCell& cell) {
                    cell.still_life = hard.name;
                    cell.clicks = clicks;
                  });
    }
    if (!thin) ++number;
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
        {"strokes across the border", "long_strokes", "Strokes that run across the border",
         "length of each stroke (pixels of the reference)", "set logscale x 2\n"},
        {"scene scale", "scene_scale", "The same scene in other units", "scale (times)", "set logscale x\n"},
        {"wrong up", "wrong_up", "Up is not up", "tilt (degrees)", ""},
        {"orbit distance", "orbit_distance", "Orbit views nearer and farther", "distance (object sizes)", ""},
        {"step back", "step_back", "The first view nearer and farther", "distance (of the reference's own)",
         "set logscale x 2\n"},
        {"object share", "object_share", "Small and large in the first view",
         "object's share of the picture (%)", "set logscale x\n"},
        {"occlusion", "occlusion", "Hidden in the first view by a board", "hidden share of the object (%)",
         ""},
        {"other resolution", "other_resolution", "Rendered larger and smaller than it was cut",
         "width of the test pictures (of their own)", "set logscale x 2\n"},
        {"too few views", "too_few_views", "Few views", "views beside the first", "set xtics 1\n"},
        {"bad masks", "bad_masks", "Some of the masks are wrong",
         "share of the views whose mask is wrong (%)", ""},
        {"thin parts", "thin_parts", "Thin parts by width (lamp, plant, mug)",
         "width of leaves, handle and cable (of the usual)", "set logscale x 2\n"},
    };
    std::string names;
    int number = 0;
    for (const HardStillLife& hard : hard_still_lifes())
      if (hard.thin_width == 0)
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
