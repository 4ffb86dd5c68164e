// Runs cells of the study on one scene of a suite.
#pragma once

#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "app/lab/eval_suite.h"
#include "app/lab/study/study_cell.h"
#include "scene/raster/projected_view.h"

namespace splatcut {

class StudyRunner {
 public:
  // The scene is loaded with the first cell. folder: what the entry's paths are relative to.
  StudyRunner(nlohmann::json entry, std::filesystem::path folder, PreparedCache cache);

  // What was measured, with the scene's name and the cell's settings; null where the scene cannot be asked
  // this (photographs without true labels), or where the job was cancelled. "warned": what the program tells
  // its user, in words, or empty.
  nlohmann::json run(const StudyCell& cell, const Job& job);

  // For a look at what failed: the cell's cutout in the view asked from (or, of photographs, in the first
  // with a truth) as it is, the rest darkened; red what is missing, blue what is too much.
  Image<Rgb8> picture(const StudyCell& cell, const Job& job);

 private:
  struct Setup {
    EvaluationCase test;
    CutSettings settings;
    CutRequest request;  // its mask source refers to `test`
  };
  // The scene in other units, or with a board in it.
  struct Variant {
    double scale = 1, hidden = 0;
    GaussianCloud cloud;
    std::vector<std::uint8_t> truth;
  };
  ImageScore score_of(const StudyCell& cell, const EvaluationCase& test,
                      const std::vector<std::uint8_t>& labels);
  struct Timed {
    CutResult result;
    double cpu_ms = 0;  // of all threads, from the strokes to the labels
  };
  Timed cut(const Setup& setup, const Job& job) const;
  void load(const Job& job);
  // Null where the scene cannot be asked this, or the job was cancelled. The cell must outlive it.
  std::unique_ptr<Setup> set_up(const StudyCell& cell, const Job& job);
  void say(const StudyCell& cell, const Job& job, Setup* setup) const;
  void change_scene(const StudyCell& cell, EvaluationCase* test);

  nlohmann::json entry_;
  std::filesystem::path folder_;
  PreparedCache cache_;
  std::unique_ptr<LoadedCase> loaded_;
  Variant variant_;  // the last one; none is kept where there was none
  std::optional<KeptViews>
      measured_views_;  // of the scene as it was loaded; cuts, which are timed, have their own
  std::map<std::uint64_t, ImageScore> scores_;
  bool first_ = true;  // nothing was cut yet
};

}  // namespace splatcut
