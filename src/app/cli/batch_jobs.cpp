#include "app/cli/batch_jobs.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <map>
#include <set>

#include "app/document/export_plan.h"
#include "core/error.h"
#include "core/json_file.h"
#include "core/mapped_file.h"

namespace splatcut {

namespace {

// "0,-1,-4" of a list of numbers.
std::string word_of(const nlohmann::json& value, const std::string& where) {
  if (value.is_string() && value.get_ref<const std::string&>().empty()) throw Error(where, "is empty");
  if (value.is_string()) return value.get<std::string>();
  if (value.is_number() || value.is_object()) return json_text(value);
  const bool numbers = value.is_array() && !value.empty() &&
                       std::ranges::all_of(value, [](const auto& v) { return v.is_number(); });
  if (!numbers) throw Error(where, "is neither text nor a number nor a list of them");
  std::string word;
  for (const nlohmann::json& number : value) word += (word.empty() ? "" : ",") + json_text(number);
  return word;
}

std::vector<std::string> words_of(const CLI::Option& option, const nlohmann::json& value,
                                  const std::string& where) {
  const std::string name = "--" + option.get_lnames().front();
  if (option.get_expected_max() == 0) {
    if (!value.is_boolean()) throw Error(where, "is neither true nor false");
    return value.get<bool>() ? std::vector{name} : std::vector<std::string>();
  }
  if (value.is_object() && name != "--seeds") throw Error(where, "is an object, where a value is wanted");
  const bool several = option.get_expected_max() > 1 && value.is_array();
  const bool of_numbers = several && !value.empty() && value.front().is_number();
  if (!several || of_numbers) return {name + "=" + word_of(value, where)};
  std::vector<std::string> words;
  for (const nlohmann::json& one : value) words.push_back(name + "=" + word_of(one, where));
  return words;
}

// As the name of a folder.
std::string name_of_job(const nlohmann::json& asked, std::size_t line) {
  if (!asked.is_object() || !asked.contains("name")) return fmt::format("job_{:05}", line);
  const nlohmann::json& name = asked.at("name");
  if (!name.is_string() || name.get_ref<const std::string&>().empty())
    throw Error("\"name\"", "is no text", "The job's folder is called after it");
  return file_name_of(name);
}

BatchJob job_of(std::string_view text, std::size_t line) {
  BatchJob job{.name = fmt::format("job_{:05}", line),
               .line = line,
               .asked = {},
               .scene_key = {},
               .scene = {},
               .error = {}};
  const std::string where = fmt::format("line {}", line);
  try {
    job.asked = parse_json(where, text);
    if (!job.asked.is_object()) throw Error(where, "is no object with \"scene\" and \"click\"");
    job.name = name_of_job(job.asked, line);
    CutArguments args;
    read_arguments(job.asked, where, &args);
    job.scene_key = args.scene_key();
    job.scene = args.scene.string();
  } catch (const std::exception& error) {
    job.error = sentence_of(error);
  }
  return job;
}

void refuse_same_names(std::vector<BatchJob>* jobs) {
  std::map<std::string, std::size_t> taken;
  for (BatchJob& job : *jobs) {
    if (!job.error.empty()) continue;
    const auto [at, is_new] = taken.try_emplace(job.name, job.line);
    if (is_new) continue;
    job.error = sentence_of(Error(fmt::format("line {}", job.line),
                                  fmt::format("the folder {} is that of line {}", job.name, at->second),
                                  "Give it another \"name\""));
    job.name = fmt::format("job_{:05}", job.line);
  }
}

}  // namespace

void read_arguments(const nlohmann::json& asked, const std::string& where, CutArguments* args) {
  CLI::App options;
  options.set_help_flag("");
  args->add_to(options);
  if (!asked.contains("scene") || !asked.at("scene").is_string()) throw Error(where, "names no \"scene\"");
  if (asked.at("scene") == "") throw Error(where, "\"scene\" is empty");
  std::vector<std::string> words;
  for (const auto& [key, value] : asked.items()) {
    if (key == "name" || key == "scene") continue;
    const CLI::Option* option = options.get_option_no_throw("--" + key);
    if (!option)
      throw Error(where, fmt::format("\"{}\" is no option of a cut", key), "splatcut cut --help lists them");
    const std::vector<std::string> more = words_of(*option, value, fmt::format("{}: \"{}\"", where, key));
    words.insert(words.end(), more.begin(), more.end());
  }
  words.insert(words.end(), {"--", asked.at("scene").get<std::string>()});
  std::ranges::reverse(words);  // as CLI11 wants them
  try {
    options.parse(std::move(words));
  } catch (const CLI::ParseError& error) {
    throw Error(where, error.what());
  }
}

std::vector<BatchJob> read_jobs(const std::filesystem::path& path) {
  const std::string text = text_of_file(path);
  std::vector<BatchJob> jobs;
  std::size_t number = 0;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    std::string_view line = std::string_view(text).substr(at, end - at);
    at = end + 1;
    ++number;
    const std::size_t start = line.find_first_not_of(" \t\r");
    if (start == line.npos || line[start] == '#') continue;
    jobs.push_back(job_of(line, number));
  }
  if (jobs.empty()) throw Error(path.string(), "holds no job");
  refuse_same_names(&jobs);
  return jobs;
}

std::vector<BatchJob> jobs_of_part(std::vector<BatchJob> jobs, std::size_t part, std::size_t parts) {
  std::map<std::string, std::size_t> first;  // line at which a scene first stands
  for (const BatchJob& job : jobs) first.try_emplace(job.scene_key, job.line);
  std::ranges::stable_sort(jobs, {}, [&](const BatchJob& job) { return first.at(job.scene_key); });
  const auto border = [&](std::size_t i) {
    return jobs.begin() + static_cast<std::ptrdiff_t>(i * jobs.size() / parts);
  };
  return {border(part), border(part + 1)};
}

}  // namespace splatcut
