#include "app/lab/study/study_plan.h"

#include <fmt/format.h>

#include "app/lab/study/study_grid.h"
#include "segment/session/cut_settings.h"

namespace splatcut {

namespace {

struct EnergyChoice {
  const char* name;
  Settings set;
};

// As the functions of energy.h have them.
Settings settings_of(const char* pairwise, const EnergyOptions& e) {
  return {fmt::format("energy.pairwise={}", pairwise),
          fmt::format("energy.gamma_position={}", e.gamma_position),
          fmt::format("energy.gamma_colour={}", e.gamma_colour),
          fmt::format("energy.lambda={}", e.lambda),
          fmt::format("energy.visibility={:d}", e.visibility),
          fmt::format("energy.lambda_n={}", e.lambda_n),
          fmt::format("energy.lambda_u={}", e.lambda_u),
          fmt::format("energy.gamma_cluster_position={}", e.gamma_cluster_position),
          fmt::format("energy.gamma_cluster_colour={}", e.gamma_cluster_colour),
          fmt::format("energy.object_clusters={}", e.object_clusters),
          fmt::format("energy.rest_clusters={}", e.rest_clusters),
          fmt::format("energy.unseen_rest={}", e.unseen_rest),
          "trim=0"};
}

const std::vector<EnergyChoice>& energies() {
  static const std::vector<EnergyChoice> all = {
      {"ours", {}},
      {"threshold", {"energy.coarse=1", "energy.tau=0.5", "trim=0"}},
      {"paper's energy", settings_of("paper", paper_energy())},
      {"its code's energy", settings_of("paper-code", paper_code_energy())}};
  return all;
}

// How masks travel to the other views.
struct Carry {
  const char *propagate, *refine;
};
constexpr Carry kLifted{"lift", "pixelcut"}, kFlown{"dis", "grabcut"};

// First mask x views x how masks travel x energy; other numbers of pixels and views are asked in
// plan_needed().
void plan_trade_off_grid(StudyGrid* grid) {
  for (const char* first : {"parts", "grabcut"})
    for (const double views : grid->some({0, 12}))
      for (const Carry& carry : {kLifted, kFlown}) {
        if (views == 0 && carry.propagate == kFlown.propagate) continue;  // nothing is carried anywhere
        for (const EnergyChoice& energy : energies()) {
          if (grid->quick() && views == 0 && energy.name != energies().front().name) continue;
          Settings set = energy.set;
          if (first != std::string("parts"))
            set.insert(set.end(), {"first.from=pixels", std::string("first.solver=") + first});
          set.insert(set.end(), {fmt::format("views.propagate={}", carry.propagate),
                                 fmt::format("views.refine={}", carry.refine),
                                 fmt::format("views.most={}", views), "views.settled_change=0"});
          grid->add("trade-off", fmt::format("{}; {}", first, energy.name), views, set);
        }
      }
}

}  // namespace

void plan_trade_off(StudyGrid* grid) {
  const auto add = [&](const Preset& preset) { grid->add("trade-off", "preset", 0).preset = preset.name; };
  add(presets().front());
  grid->add("trade-off", "parts alone", 0).parts_only = true;
  plan_trade_off_grid(grid);
  for (const char* tau : {"0.5", "0.3"})
    grid->add("trade-off", "usual pipeline", 12,
              {"first.from=pixels", "first.solver=grabcut", "views.propagate=dis", "views.refine=grabcut",
               "energy.coarse=1", std::string("energy.tau=") + tau, "views.most=12", "views.settled_change=0",
               "trim=0"});
  std::ranges::for_each(presets().subspan(1), add);
}

namespace {

constexpr int kMasks = 7;

// As `cut --masks` is given them; one more of the reference.
void plan_views(StudyGrid* grid) {
  for (const double views : grid->some({4, 20, 1, 2, 8, 40}))
    for (const char* series : {"threshold", "paper", "ours"}) {
      const std::string name = series;
      StudyCell& cell = grid->add("views", name, views);
      if (name == "paper") cell.preset = name;  // its energy as it is shipped
      if (name == "threshold") cell.set.push_back("energy.coarse=1");
      cell.masks = static_cast<int>(views) + 1;
    }
}

// One setting at a time.
void sweep(StudyGrid* grid, const char* table, const char* name, std::initializer_list<double> values,
           Settings base = {}) {
  base.emplace_back();
  for (const double v : grid->some(values)) {
    base.back() = fmt::format("{}={}", name, v);
    grid->add(table, "7 true masks", v, base).masks = kMasks;
  }
}

// Each term of our energy, and of the paper's, left out.
void plan_terms(StudyGrid* grid) {
  const auto add = [&](const char* what, double x, const Settings& set, const Settings& base = {}) {
    StudyCell& cell = grid->add("energy terms", what, x, base);
    cell.set.insert(cell.set.end(), set.begin(), set.end());
    cell.masks = kMasks;
  };
  add("ours: all terms", 0, {});
  add("ours: no position", 1, {"energy.gamma_position=0"});
  add("ours: no colour", 2, {"energy.gamma_colour=0"});
  add("ours: no neighbours", 3, {"energy.lambda=0"});
  add("ours: no visibility", 4, {"energy.visibility=0"});
  const Settings paper = settings_of("paper", paper_energy());
  add("paper: all terms", 5, {}, paper);
  add("paper: no position", 6, {"energy.gamma_position=1000"}, paper);  // its term vanishes as gamma grows
  add("paper: no colour", 7, {"energy.lambda_n=0"}, paper);
  add("paper: no clusters", 8, {"energy.lambda_u=0"}, paper);
  add("paper: no neighbours", 9, {"energy.lambda=0"}, paper);
}

}  // namespace

void plan_tables(StudyGrid* grid) {
  plan_views(grid);
  sweep(grid, "neighbours", "neighbours", {10, 1, 50, 100});
  sweep(grid, "lambda", "energy.lambda", {0.5, 4, 1, 2});
  sweep(grid, "gamma of colour", "energy.gamma_colour", {0.5, 4, 1, 2});
  sweep(grid, "gamma of position", "energy.gamma_position", {0.1, 4, 0.5, 1, 2});
  sweep(grid, "threshold tau", "energy.tau", {0.5, 0.9, 0.1, 0.3, 0.7}, {"energy.coarse=1"});
  sweep(grid, "threshold tau", "energy.coarse", {0});  // x = 0: the cut in its place
  plan_terms(grid);
}

// The smallest of each that loses nothing.
void plan_needed(StudyGrid* grid) {
  const auto one = [&](const char* series, const char* name, std::initializer_list<double> values,
                       const Settings& more) {
    for (const double v : grid->some(values)) {
      StudyCell& cell = grid->add("needed", series, v, more);
      cell.set.push_back(fmt::format("{}={}", name, v));
    }
  };
  one("views", "views.most", {0, 12, 1, 2, 3, 6}, {"views.settled_change=0"});
  one("width (px)", "work_width_px", {256, 400, 96, 128, 192, 320, 512}, {"least_object_px=0"});
  one("neighbours", "neighbours", {6, 10, 3, 4, 20}, {});
}

std::vector<StudyCell> study_plan(int draws, bool quick) {
  StudyGrid grid(draws, quick);
  plan_trade_off(&grid);
  plan_tables(&grid);
  plan_needed(&grid);
  plan_stability(&grid);
  return grid.take();
}

}  // namespace splatcut
