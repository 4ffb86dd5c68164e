// What the study runs on: the user's suites, and still lifes it makes where there is none or where one has
// what is hard.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/job.h"
#include "scene/still_life/still_life.h"

namespace splatcut {

struct HardStillLife {
  std::string name;
  StillLifeOptions options;
  bool quick = true;  // part of --quick
};
const std::vector<HardStillLife>& hard_still_lifes();

struct StudyScene {
  nlohmann::json entry;
  std::filesystem::path folder;
  std::string name;        // for tables; of the still life and its object
  std::string key;         // tells it from others, and from itself with another entry or scene file
  std::string still_life;  // empty: a main scene
};

struct StudyScenesOptions {
  std::vector<std::filesystem::path> suites;  // empty: the plain still life is the main scene
  std::vector<std::string> still_lifes;       // those that are asked
  std::filesystem::path folder;               // where still lifes are kept
  std::size_t gaussians = 80000;              // of each
  bool quick = false;                         // two scenes of each suite, two objects of each still life
};

// Still lifes are made where they are not there yet. Throws Error where the job was cancelled.
std::vector<StudyScene> study_scenes(const StudyScenesOptions& options, const Job& job);

}  // namespace splatcut
