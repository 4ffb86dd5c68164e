// What the parts of the plan are written with.
#pragma once

#include <algorithm>
#include <initializer_list>
#include <string>
#include <utility>
#include <vector>

#include "app/lab/study/study_cell.h"

namespace splatcut {

using Settings = std::vector<std::string>;  // NAME=VALUE

class StudyGrid {
 public:
  StudyGrid(int draws, bool quick) : draws_(draws), quick_(quick) {}

  int draws() const { return draws_; }
  bool quick() const { return quick_; }
  std::vector<StudyCell> take() { return std::move(cells_); }

  // Valid until the next one.
  StudyCell& add(const std::string& experiment, const std::string& series, double x, Settings set = {}) {
    StudyCell& cell = cells_.emplace_back();
    cell.experiment = experiment;
    cell.series = series;
    cell.x = x;
    cell.set = std::move(set);
    return cell;
  }

  // The first two values only where it must be quick.
  std::vector<double> some(std::initializer_list<double> values) const {
    return {values.begin(), quick_ ? std::min(values.begin() + 2, values.end()) : values.end()};
  }

  // One cell a draw of an unsteady hand, changed by `change`.
  template <class Change>
  void drawn(const std::string& experiment, const std::string& series, double x, const Settings& set,
             Change change) {
    for (int draw = 1; draw <= draws_; ++draw) {
      StudyCell& cell = add(experiment, series, x, set);
      cell.draw = static_cast<std::uint64_t>(draw);
      change(cell);
    }
  }

 private:
  int draws_;
  bool quick_;
  std::vector<StudyCell> cells_;
};

void plan_trade_off(StudyGrid* grid);
void plan_tables(StudyGrid* grid);  // those of the paper
void plan_needed(StudyGrid* grid);
void plan_stability(StudyGrid* grid);

}  // namespace splatcut
