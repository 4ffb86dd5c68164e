// What a batch says of its jobs: DIR/NAME/result.json of each that is done, DIR/results.jsonl with a line of
// each as it ends, and DIR/summary.csv.
//
// A job's folder appears as a whole, with its result in it: what stands there is done, however the batch
// ended. The lines are made of it anew at the start, and put in the order of the list at the end. Of two
// runs, killed between or not, they differ in "seconds" alone.
#pragma once

#include <array>
#include <cstdio>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "app/cli/batch_jobs.h"
#include "core/atomic_file.h"

namespace splatcut {

inline constexpr const char* kResultFile = "result.json";

// The result that stands in the job's folder; none where there is none, where it is that of another job, or
// where a file of it is missing. Throws Error where the folder is there and nothing of a batch.
std::optional<nlohmann::json> standing_result(const std::filesystem::path& folder, const BatchJob& job);

// The names that the result in a folder lists; null where there is no result.
nlohmann::json listed_files(const std::filesystem::path& folder);

double rounded_seconds(double ms);
nlohmann::json failed_result(const BatchJob& job, const std::string& error, double ms);

// The lines and the table in a folder. ending: of their names, "" or ".0-of-2".
std::array<std::filesystem::path, 2> result_files(const std::filesystem::path& folder,
                                                  const std::string& ending);

class BatchResults {
 public:
  // Throws Error where they cannot be written, or where another
  // batch writes them.
  BatchResults(const std::filesystem::path& folder, const std::string& ending);
  BatchResults(const BatchResults&) = delete;
  BatchResults& operator=(const BatchResults&) = delete;
  ~BatchResults();

  void stands(const nlohmann::json& result);  // from an earlier run
  void begin();                               // writes what stands
  void add(const nlohmann::json& result);     // appends a line
  void finish();                              // lines in order, and the summary

  std::size_t size() const { return results_.size(); }
  std::size_t failed() const { return failed_; }
  const std::filesystem::path& path() const { return paths_[0]; }

 private:
  std::string lines() const;
  std::string table() const;

  std::array<std::filesystem::path, 2> paths_;  // result_files()
  std::optional<HeldFile> lock_;
  std::FILE* file_ = nullptr;
  std::map<std::size_t, nlohmann::json> results_;  // by line of the list
  std::size_t failed_ = 0;
};

}  // namespace splatcut
