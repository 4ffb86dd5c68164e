// A process that does jobs of a batch, one after the other, as the batch hands them to it on stdin; the last
// scene stays. What a job does to the process (it may run out of memory) is then that job's failure alone.
#pragma once

#include <filesystem>

#include "app/cli/batch_jobs.h"
#include "app/console/command_line.h"

namespace splatcut {

// A line of JSON for the worker, and back.
nlohmann::json handed(const BatchJob& job);

// For each line of stdin a line of result on stdout, until stdin ends. It does not outlive its parent.
void run_batch_worker(const std::filesystem::path& folder, bool overwrite, const CommonOptions& common);

}  // namespace splatcut
