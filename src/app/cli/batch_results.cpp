#include "app/cli/batch_results.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <utility>

#include "core/error.h"
#include "core/json_file.h"

namespace splatcut {

namespace {

// A cell of CSV (RFC 4180).
std::string cell(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == text.npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? "\"\"" : std::string(1, c);
  return quoted + "\"";
}

// The line of results.jsonl: the result without what was asked, which the list says.
std::string line_of(nlohmann::json result) {
  result.erase("asked");
  return json_text(result) + "\n";
}

Error cannot_write(const std::filesystem::path& path) {
  return {path.string(), std::string("cannot be written (") + std::strerror(errno) + ")",
          "Make room there; what is done stands, and the same command goes on"};
}

// Written by a batch, of any job.
bool is_result(const nlohmann::json& result) {
  const auto has = [](const nlohmann::json& in, const char* key, auto&& is) {
    return in.is_object() && in.contains(key) && is(in.at(key));
  };
  const auto text = [](const nlohmann::json& v) { return v.is_string(); };
  const auto number = [](const nlohmann::json& v) { return v.is_number(); };
  const auto list = [](const nlohmann::json& v) { return v.is_array(); };
  const auto any = [](const nlohmann::json&) { return true; };
  const auto object = [&](const nlohmann::json& v) {
    return has(v, "gaussians", number) && has(v, "doubts", list);
  };
  return has(result, "job", text) && has(result, "scene", text) && has(result, "seconds", number) &&
         has(result, "asked", any) && has(result, "files", list) && has(result, "objects", list) &&
         std::ranges::all_of(result.at("files"), text) && std::ranges::all_of(result.at("objects"), object);
}

}  // namespace

std::optional<nlohmann::json> standing_result(const std::filesystem::path& folder, const BatchJob& job) {
  std::error_code failure;
  if (!std::filesystem::exists(folder, failure)) return {};
  const Error of_others(folder.string(), "is there already and is no result of a batch",
                        "Move it, or give --overwrite to write into it");
  if (!std::filesystem::exists(folder / kResultFile, failure)) throw of_others;
  nlohmann::json result = json_of_file(folder / kResultFile);
  if (!is_result(result)) throw of_others;
  if (result["asked"] != job.asked) return {};
  for (const nlohmann::json& file : result["files"])
    if (!std::filesystem::exists(folder / file.get<std::string>(), failure)) return {};
  result["line"] = job.line;  // which may have moved
  return result;
}

nlohmann::json listed_files(const std::filesystem::path& folder) {
  std::error_code failure;
  if (!std::filesystem::exists(folder / kResultFile, failure)) return {};
  const nlohmann::json result = json_of_file(folder / kResultFile);
  return is_result(result) ? result.at("files") : nlohmann::json();
}

double rounded_seconds(double ms) {
  return std::round(ms) / 1000;
}

nlohmann::json failed_result(const BatchJob& job, const std::string& error, double ms) {
  return {{"job", job.name},
          {"line", job.line},
          {"scene", job.scene},
          {"error", error},
          {"seconds", rounded_seconds(ms)}};
}

std::array<std::filesystem::path, 2> result_files(const std::filesystem::path& folder,
                                                  const std::string& ending) {
  return {folder / ("results" + ending + ".jsonl"), folder / ("summary" + ending + ".csv")};
}

BatchResults::BatchResults(const std::filesystem::path& folder, const std::string& ending)
    : paths_(result_files(folder, ending)) {
  std::error_code failure;
  std::filesystem::create_directories(folder, failure);
  if (failure) throw Error(folder.string(), "cannot be created (" + failure.message() + ")");
  // Beside the names that an AtomicFile and the folder of a job take meanwhile.
  lock_.emplace(folder / ("results.lock" + ending + ".splatcut.part"), folder);
}

BatchResults::~BatchResults() {
  if (file_) std::fclose(file_);
}

void BatchResults::stands(const nlohmann::json& result) {
  results_[result.at("line").get<std::size_t>()] = result;
}

void BatchResults::begin() {
  write_text_file(paths_[0], lines(), PowerCut::kMayLeaveNone);
  file_ = std::fopen(paths_[0].c_str(), "abe");
  if (!file_) throw cannot_write(paths_[0]);
}

void BatchResults::add(const nlohmann::json& result) {
  const std::string line = line_of(result);
  if (std::fwrite(line.data(), 1, line.size(), file_) != line.size() || std::fflush(file_) != 0)
    throw cannot_write(paths_[0]);
  failed_ += result.contains("error");
  stands(result);
}

std::string BatchResults::lines() const {
  std::string text;
  for (const auto& [line, result] : results_) text += line_of(result);
  return text;
}

std::string BatchResults::table() const {
  std::string text = "job,line,scene,state,objects,gaussians,doubts,seconds,error\n";
  for (const auto& [line, result] : results_) {
    std::size_t gaussians = 0, objects = 0, doubts = 0;
    if (result.contains("objects"))
      for (const nlohmann::json& object : result["objects"]) {
        ++objects;
        gaussians += object.at("gaussians").get<std::size_t>();
        doubts += object.at("doubts").size();
      }
    text +=
        fmt::format("{},{},{},{},{},{},{},{},{}\n", cell(result.value("job", "")), line,
                    cell(result.value("scene", "")), result.contains("error") ? "failed" : "done", objects,
                    gaussians, doubts, result.value("seconds", 0.0), cell(result.value("error", "")));
  }
  return text;
}

void BatchResults::finish() {
  std::fclose(std::exchange(file_, nullptr));
  write_text_file(paths_[0], lines());
  write_text_file(paths_[1], table());
}

}  // namespace splatcut
