#include "app/cli/batch_worker.h"

#include <fmt/format.h>
#include <sys/prctl.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <iostream>

#include "app/cli/batch_results.h"
#include "app/console/console.h"
#include "app/console/kept_inputs.h"
#include "core/atomic_file.h"
#include "core/error.h"
#include "core/json_file.h"
#include "core/stage_clock.h"

namespace splatcut {

namespace {

struct BatchWorker {
  std::filesystem::path folder;
  bool overwrite = false;
  const CommonOptions& common;
  Job job;
  std::optional<SharedScene> scene = {};
};

BatchJob job_from(const nlohmann::json& line) {
  BatchJob job;
  job.name = line.at("name");
  job.line = line.at("line");
  job.asked = line.at("asked");
  job.scene = job.asked.value("scene", "");
  return job;
}

nlohmann::json cut_objects_json(const std::vector<CutObject>& objects) {
  nlohmann::json list = nlohmann::json::array();
  for (const CutObject& object : objects) {
    list.push_back({{"gaussians", std::ranges::count(object.result.labels, 1)}, {"doubts", object.doubts()}});
    if (!object.name.empty()) list.back()["name"] = object.name;
  }
  return list;
}

// What an earlier result of ours listed and the new one does not.
void remove_old(const std::filesystem::path& folder, const nlohmann::json& before,
                const nlohmann::json& files) {
  std::error_code ignored;
  for (const nlohmann::json& file : before)
    if (std::ranges::find(files, file) == files.end())
      std::filesystem::remove(folder / std::filesystem::path(file.get<std::string>()).filename(), ignored);
}

nlohmann::json do_job(const BatchJob& job, BatchWorker* worker) {
  const auto start = std::chrono::steady_clock::now();
  CutArguments args;
  read_arguments(job.asked, fmt::format("line {}", job.line), &args);
  const std::filesystem::path folder = worker->folder / job.name;
  refuse_written_inputs(folder, args.inputs());
  const ObjectInput input = args.object.read(args.camera);
  const nlohmann::json before = listed_files(folder);
  OutputFolder out(folder, worker->overwrite || !before.is_null());
  if (!worker->scene || worker->scene->key() != args.scene_key()) {
    worker->scene.reset();  // first: two scenes may not find room
    worker->scene.emplace(args, prepared_cache(worker->common), true, worker->job);
    if (worker->job.cancelled()) worker->scene.reset();
    stop_if_cancelled(worker->job, "splatcut batch");
  }
  refuse_written_inputs(folder, worker->scene->scene().files);
  nlohmann::json warnings = args.how.remarks(worker->scene->scene());
  const FinishedCut run =
      run_cut_in(&*worker->scene, args, input, out,
                 {.quiet = true,
                  .times = false,
                  .warn = [&](const std::string& sentence) { warnings.push_back(sentence); }},
                 worker->job);
  nlohmann::json result = {{"job", job.name},
                           {"line", job.line},
                           {"scene", args.scene.string()},
                           {"objects", cut_objects_json(run.objects)},
                           {"warnings", warnings},
                           {"folder", job.name},
                           {"files", out.names()},
                           {"seconds", rounded_seconds(ms_since(start))},
                           {"asked", job.asked}};
  write_text_file(out.file(kResultFile), json_text(result, 2) + "\n");
  stop_if_cancelled(worker->job, "splatcut batch");
  out.commit();
  if (!before.is_null()) remove_old(folder, before, result["files"]);
  return result;
}

}  // namespace

nlohmann::json handed(const BatchJob& job) {
  return {{"name", job.name}, {"line", job.line}, {"asked", job.asked}};
}

void run_batch_worker(const std::filesystem::path& folder, bool overwrite, const CommonOptions& common) {
  ::prctl(PR_SET_PDEATHSIG,
          SIGKILL);  // its parent's folder is soon another's; where it ended already, so does stdin
  BatchWorker worker{folder, overwrite, common, console_job(true)};
  for (std::string line; std::getline(std::cin, line);) {
    const BatchJob job = job_from(parse_json("stdin", line));
    const auto start = std::chrono::steady_clock::now();
    nlohmann::json result;
    try {
      result = do_job(job, &worker);
    } catch (const std::exception& error) {
      if (worker.job.cancelled()) return;
      result = failed_result(job, sentence_of(error), ms_since(start));
    }
    std::cout << json_text(result) << std::endl;
  }
}

}  // namespace splatcut
