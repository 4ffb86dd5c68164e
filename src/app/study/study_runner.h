// Runs cells of the study on one scene of a suite.
#pragma once

#include <map>
#include <memory>
#include <nlohmann/json.hpp>

#include "app/eval_suite.h"
#include "app/study/study_cell.h"

namespace splatcut {

class StudyRunner {
 public:
  // The scene is loaded with the first cell. folder: what the entry's paths are relative to.
  StudyRunner(nlohmann::json entry, std::filesystem::path folder, PreparedCache cache);

  // What was measured, with the scene's name and the cell's settings; null where the scene cannot be asked this (photographs
  // without true labels), or where the job was cancelled.
  nlohmann::json run(const StudyCell& cell, const Job& job);

  // The cutout of the cell in the reference view, the rest darkened: for a look at what failed.
  Image<Rgb8> picture(const StudyCell& cell, const Job& job);

 private:
  struct Setup {
    EvaluationCase test;
    PipelineOptions pipeline;
    Strokes strokes;
    bool possible = true;
  };
  PipelineReport cut(const StudyCell& cell, Setup* setup, const Job& job) const;
  void load(const PipelineOptions& pipeline, const Job& job);
  Setup set_up(const StudyCell& cell, const Job& job);
  void choose_strokes(const StudyCell& cell, const Job& job, Setup* setup) const;
  const PreparedScene& prepared_for(const PipelineOptions& pipeline, const Job& job);
  void scale_to(double scale, const PipelineOptions& pipeline, const Job& job);

  nlohmann::json entry_;
  std::filesystem::path folder_;
  PreparedCache cache_;
  std::unique_ptr<LoadedCase> loaded_;
  int loaded_neighbours_ = 0;
  std::map<int, PreparedScene> prepared_;  // of other numbers of neighbours
  double scale_ = 1;                       // of what follows
  GaussianCloud scaled_cloud_;
  PreparedScene scaled_prepared_;
};

}  // namespace splatcut
