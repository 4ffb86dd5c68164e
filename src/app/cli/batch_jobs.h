// The jobs of `splatcut batch`: a file with a line of JSON for each, whose fields are the options of `cut`.
//
//   {"name": "lamp", "scene": "room.ply", "camera-pos": [0, -1, -4], "camera-target": "0,0,0",
//    "click": ["512,384", [40, 40]], "write": ["object", "labels"], "parts-only": true}
// A list gives an option several times, a list of numbers is one value with commas, true gives a switch;
// "seeds" may be the object itself in place of its file. "name" becomes the name of the job's folder; without
// it, "job_" and the number of the line. Empty lines and lines that begin with # are none.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "app/cli/cut_run.h"

namespace splatcut {

struct BatchJob {        // NOLINT(bugprone-exception-escape): moving JSON throws nothing
  std::string name;      // of its folder, too
  std::size_t line = 0;  // in the file, from 1
  nlohmann::json asked;  // the line
  std::string scene_key, scene;
  std::string error;  // why it is no job; empty: it is one
};

// Throws Error where the file cannot be read or holds no job. A line that is no job becomes one with an
// error.
std::vector<BatchJob> read_jobs(const std::filesystem::path& path);

// The jobs in the order in which they are done: scene after scene, each where its first job stands. part of
// `parts`: jobs of equal number, within one, and all of a scene in as few parts as that allows.
std::vector<BatchJob> jobs_of_part(std::vector<BatchJob> jobs, std::size_t part, std::size_t parts);

// Reads the fields of a job as the options of `cut`. Throws Error for what is none of them.
void read_arguments(const nlohmann::json& asked, const std::string& where, CutArguments* args);

}  // namespace splatcut
