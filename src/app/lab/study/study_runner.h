// Runs cells of the study on one scene of a suite.
#pragma once

#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "app/lab/eval_suite.h"
#include "app/lab/study/study_cell.h"
#include "app/measure/any_view.h"
#include "scene/raster/projected_view.h"

namespace splatcut {

struct TimedCut {
  CutResult result;
  double cpu_ms = 0;  // of all threads, from the strokes to the labels
};

class StudyRunner {
 public:
  // The scene is loaded with the first cell. folder: what the entry's paths are relative to.
  StudyRunner(nlohmann::json entry, std::filesystem::path folder, PreparedCache cache);

  // What was measured, with the scene's name and the cell's settings; null where the scene cannot be asked
  // this (photographs without true labels, a first click that nobody can make from there), or where the job
  // was cancelled. "warned": what the program tells its user, in words, or empty.
  nlohmann::json run(const StudyCell& cell, const Job& job);

  // For a look at what failed: the cell's cutout in the view asked from (or, of photographs, in the first
  // with a truth) as it is, the rest darkened; red what is missing, blue what is too much.
  Image<Rgb8> picture(const StudyCell& cell, const Job& job);

 private:
  struct Setup {
    EvaluationCase test;
    CutSettings settings;
    CutRequest request;
    std::optional<TimedCut> answer;  // where it is known already
  };
  // What the last unsteady hand did, and what came of each click.
  struct Hand {
    std::string key;
    ViewClicks clicks;
    std::vector<TimedCut> after;
  };
  // The scene in other units, or with a board in it.
  struct Variant {
    double scale = 1, hidden = 0;
    GaussianCloud cloud;
    std::vector<std::uint8_t> truth;
  };
  ImageScore score_of(const StudyCell& cell, const EvaluationCase& test,
                      const std::vector<std::uint8_t>& labels);
  TimedCut cut(const Setup& setup, const Job& job) const;
  void load(const Job& job);
  // Null where the scene cannot be asked this, or the job was cancelled.
  std::unique_ptr<Setup> set_up(const StudyCell& cell, const Job& job);
  void say(const StudyCell& cell, const Job& job, Setup* setup) const;
  void say_by_hand(const StudyCell& cell, const Job& job, Setup* setup);
  void watch_hand(const StudyCell& cell, const Setup& setup, Session* session, const Job& job);
  void change_scene(const StudyCell& cell, EvaluationCase* test);

  nlohmann::json entry_;
  std::filesystem::path folder_;
  PreparedCache cache_;
  std::unique_ptr<LoadedCase> loaded_;
  Variant variant_;  // the last one; none is kept where there was none
  std::optional<KeptViews>
      measured_views_;  // of the scene as it was loaded; cuts, which are timed, have their own
  std::map<std::uint64_t, ImageScore> scores_;
  Hand hand_;
  std::string session_key_;         // what the scene of that session was
  std::optional<Session> session_;  // of unsteady hands
  bool first_ = true;               // nothing was cut yet
};

}  // namespace splatcut
