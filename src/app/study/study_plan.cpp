#include "app/study/study_plan.h"

#include <fmt/format.h>

#include <initializer_list>

namespace splatcut {

namespace {

using Settings = std::vector<std::string>;

class Plan {
 public:
  explicit Plan(int draws, bool quick) : draws_(draws), quick_(quick) {}

  void trade_off();
  void views();
  void tables();
  void sparse();
  void stability();
  void bad_masks();
  void needed();
  std::vector<StudyCell> take() { return std::move(cells_); }

 private:
  StudyCell& add(const std::string& experiment, const std::string& series, double x, Settings set = {}) {
    StudyCell& cell = cells_.emplace_back();
    cell.experiment = experiment;
    cell.series = series;
    cell.x = x;
    cell.set = std::move(set);
    return cell;
  }
  // The first values only where it must be quick.
  std::vector<double> some(std::initializer_list<double> values) const {
    return {values.begin(), quick_ ? std::min(values.begin() + 2, values.end()) : values.end()};
  }

  int draws_;
  bool quick_;
  std::vector<StudyCell> cells_;
};

// Image IoU against seconds: ways to a first mask, views, resolution, propagators, presets.
void Plan::trade_off() {
  for (const char* preset : {"fast", "default", "best", "paper", "paper-code"}) {
    if (quick_ && std::string(preset).starts_with("paper")) continue;
    add("trade-off", "preset", 0).preset = preset;
  }
  add("trade-off", "parts alone", 0).parts_only = true;
  add("trade-off", "usual pipeline", 0,
      {"first.from=pixels", "first.solver=grabcut", "views.propagate=dis", "views.refine=grabcut", "energy.coarse=1", "views.settled_change=0", "trim=0"});
  for (const double views : some({2, 12, 0, 6}))
    for (const double width : some({400, 256, 512})) {
      const Settings size = {fmt::format("views.most={}", views), fmt::format("work_width_px={}", width), "views.settled_change=0"};
      add("trade-off", "parts, cut", views, size);
    }
  for (const double views : some({2, 12, 6}))
    for (const char* first : {"grabcut", "pixelcut"})
      for (const char* carry : {"lift", "warp", "dis"})
        for (const char* refine : {"none", "grabcut", "pixelcut"}) {
          if (quick_ && (std::string(carry) == "warp" || std::string(refine) == "none")) continue;
          add("trade-off", fmt::format("{}, {}", first, carry), views,
              {"first.from=pixels", fmt::format("first.solver={}", first), fmt::format("views.propagate={}", carry), fmt::format("views.refine={}", refine),
               fmt::format("views.most={}", views), "views.settled_change=0"});
        }
  for (const char* carry : {"warp", "dis", "lift"})
    for (const char* refine : {"grabcut", "pixelcut"}) {
      if (quick_ && std::string(carry) != "dis") continue;
      add("trade-off", fmt::format("parts, {}", carry), 6,
          {fmt::format("views.propagate={}", carry), fmt::format("views.refine={}", refine), "views.most=6", "views.settled_change=0"});
    }
}

// Number of views, with true masks in all of them.
void Plan::views() {
  for (const double views : some({4, 20, 2, 8, 40}))
    for (const char* series : {"ours", "paper", "threshold"}) {
      const std::string name = series;
      StudyCell& cell = add("views", name, views, {fmt::format("views.most={}", views), "views.settled_change=0", "first.from=pixels", "trim=0"});
      if (name == "paper") cell.preset = name;  // its energy as it is shipped
      if (name == "threshold") cell.set.push_back("energy.coarse=1");
      cell.first = "truth";
      cell.true_masks = true;
    }
}

// One setting at a time, in the paper's layout.
void Plan::tables() {
  const auto sweep = [&](const char* table, const char* name, std::initializer_list<double> values, const Settings& base = {}) {
    for (const double v : some(values))
      for (const bool true_masks : {false, true}) {
        Settings set = base;
        set.push_back(fmt::format("{}={}", name, v));
        StudyCell& cell = add(table, true_masks ? "true masks of 6 views" : "from 3 clicks", v, set);
        cell.true_masks = true_masks;
        if (true_masks) cell.set.insert(cell.set.end(), {"views.most=6", "views.settled_change=0"});
      }
  };
  sweep("neighbours", "neighbours", {10, 1, 50, 100});
  sweep("clusters", "energy.rest_clusters", {1, 5, 10, 20}, {"energy.lambda_u=1"});
  sweep("lambda", "energy.lambda", {0.5, 4, 1, 2});
  sweep("gamma of colour", "energy.gamma_colour", {0.5, 4, 1, 2});
  sweep("gamma of position", "energy.gamma_position", {0.5, 4, 1, 2});
  sweep("threshold tau", "energy.tau", {0.5, 0.9, 0.1, 0.3, 0.7}, {"energy.coarse=1"});
  sweep("hard counts", "energy.hard", {0, 1});
  sweep("visibility", "energy.visibility", {1, 0});
  sweep("trim", "trim", {1, 0});
  sweep("hidden view test", "views.hidden_test", {1, 0}, {"views.settled_change=0"});
}

// What little input does, with and without the cut.
void Plan::sparse() {
  for (const char* coarse : {"0", "1"}) {
    const std::string with = std::string(coarse) == "0" ? "cut" : "threshold", set = std::string("energy.coarse=") + coarse;
    add("sparse input", with, 0, {set, "first.from=pixels", "views.most=0", "trim=0"}).first = "strokes";
    add("sparse input", with, 1, {set, "first.from=pixels", "views.most=0", "trim=0"}).first = "truth";
    StudyCell& many = add("sparse input", with, 2, {set, "first.from=pixels", "views.most=12", "views.settled_change=0", "trim=0"});
    many.first = "truth";
    many.true_masks = true;
  }
}

void Plan::stability() {
  for (int draw = 1; draw <= draws_; ++draw)
    for (const int clicks : {1, 2, 3}) {
      StudyCell& cell = add("click jitter", fmt::format("{} clicks", clicks), draw);
      cell.clicks = clicks;
      cell.draw = static_cast<std::uint64_t>(draw);
    }
  for (const double length : some({4, 32, 8, 16, 64}))
    for (int draw = 1; draw <= std::max(1, draws_ / 5); ++draw) {
      StudyCell& cell = add("strokes across the border", "3 strokes", length);
      cell.stroke_px = length;
      cell.draw = static_cast<std::uint64_t>(draw);
    }
  for (const double scale : some({0.01, 100, 0.1, 10, 1})) add("scene scale", "3 clicks", scale).scene_scale = scale;
  for (const double tilt : some({30, 90, 180, 0})) add("wrong up", "3 clicks", tilt, {"views.settled_change=0", "views.most=6"}).up_tilt_deg = tilt;
  for (const double sizes : some({0.8, 4, 1.2, 1.6, 2.5})) add("orbit distance", "3 clicks", sizes, {fmt::format("views.distance_sizes={}", sizes), "views.settled_change=0", "views.most=6"});
  for (const double back : some({0.6, 3, 1, 2, 6})) add("step back", "3 clicks", back).step_back = back;
}

void Plan::bad_masks() {
  struct Bad {
    const char* kind;
    std::initializer_list<double> px;
  };
  for (const Bad& bad : {Bad{"erode", {4, 2, 8}}, Bad{"dilate", {4, 2, 8}}, Bad{"shift", {16, 8, 32}}, Bad{"holes", {6, 3}}, Bad{"empty", {1}}, Bad{"full", {1}}})
    for (const double px : quick_ ? std::vector<double>{*bad.px.begin()} : std::vector<double>(bad.px))
      for (const double share : some({0.25, 0.5, 1}))
        for (const char* solver : {"ours", "threshold"}) {
          StudyCell& cell = add("bad masks", fmt::format("{} {} px, {}", bad.kind, px, solver), share,
                                {"first.from=pixels", "views.most=8", "views.settled_change=0", std::string("energy.coarse=") + (std::string(solver) == "ours" ? "0" : "1")});
          cell.first = "truth";
          cell.true_masks = true;
          cell.disturbance = {bad.kind, static_cast<int>(px)};
          cell.disturbed_share = share;
        }
}

// The smallest of each that loses nothing, from a true first mask.
void Plan::needed() {
  const auto sweep = [&](const char* series, const char* name, std::initializer_list<double> values, const Settings& more) {
    for (const double v : some(values)) {
      Settings set = more;
      set.push_back(fmt::format("{}={}", name, v));
      add("needed", series, v, set);
    }
  };
  sweep("views", "views.most", {0, 12, 1, 2, 3, 6}, {"views.settled_change=0"});
  sweep("width (px)", "work_width_px", {256, 400, 96, 128, 192, 320, 512}, {"least_object_px=0"});
  sweep("neighbours", "neighbours", {6, 10, 3, 4, 20}, {});
}

}  // namespace

std::vector<StudyCell> study_plan(int draws, bool quick) {
  Plan plan(draws, quick);
  plan.trade_off();
  plan.views();
  plan.tables();
  plan.sparse();
  plan.stability();
  plan.bad_masks();
  plan.needed();
  return plan.take();
}

}  // namespace splatcut
