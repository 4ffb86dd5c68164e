// splatcut batch: a list of cuts, done by worker processes, from where an earlier run of it ended.
#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <deque>
#include <list>
#include <memory>
#include <thread>

#include "app/cli/batch_jobs.h"
#include "app/cli/batch_results.h"
#include "app/cli/batch_worker.h"
#include "app/cli/commands.h"
#include "app/console/console.h"
#include "app/console/kept_inputs.h"
#include "app/console/output_folder.h"
#include "app/console/run_program.h"
#include "core/error.h"
#include "core/json_file.h"

namespace splatcut {

namespace {

struct BatchOptions {
  std::filesystem::path jobs, output;
  int workers = 1;
  std::string shard;
  bool overwrite = false, worker = false;
};

struct Part {
  std::size_t index = 0, of = 1;
};

Part shard_of(const std::string& shard) {
  constexpr std::size_t kMostParts = 1'000'000;
  Part part;
  char rest = 0;
  if (shard.empty()) return part;
  if (std::sscanf(shard.c_str(), "%zu/%zu%c", &part.index, &part.of, &rest) != 2 || shard.front() == '-' ||
      part.of > kMostParts || part.index >= part.of)
    throw Error("--shard " + shard, "is no part of a list", "Write it as I/N, I from 0 to N-1");
  return part;
}

// A pipe's ends, closed where they were not closed before.
class Pipe {
 public:
  Pipe() {
    if (::pipe2(ends_, O_CLOEXEC) != 0)
      throw Error("splatcut batch", std::string("no pipe (") + std::strerror(errno) + ")");
  }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;
  ~Pipe() {
    close(0);
    close(1);
  }
  int operator[](int end) const { return ends_[end]; }
  void close(int end) {
    if (ends_[end] >= 0) ::close(ends_[end]);
    ends_[end] = -1;
  }

 private:
  int ends_[2] = {-1, -1};
};

// One worker process: what it is doing, and what it said so far.
class Worker {
 public:
  explicit Worker(const std::vector<std::string>& words) {
    const int failure = start_program(words, said_[1], 0, &process_, told_[0]);
    if (failure != 0)
      throw Error("splatcut batch", std::string("no worker can be started (") + std::strerror(failure) + ")");
    told_.close(0);
    said_.close(1);
  }
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;
  ~Worker() {
    if (process_ > 0) ::kill(process_, SIGKILL);
    wait();
  }

  const std::optional<BatchJob>& job() const { return job_; }
  const std::string& scene_key() const { return scene_key_; }
  int output() const { return said_[0]; }

  void give(BatchJob job) {
    const std::string line = json_text(handed(job)) + "\n";
    scene_key_ = job.scene_key;
    job_ = std::move(job);
    for (std::size_t sent = 0; sent < line.size();) {
      const ssize_t n = ::write(told_[1], line.data() + sent, line.size() - sent);
      if (n < 0 && errno == EINTR) continue;
      if (n < 0) break;  // it has ended, as its output will say
      sent += static_cast<std::size_t>(n);
    }
  }
  void no_more() { told_.close(1); }
  void end() const { ::kill(process_, SIGTERM); }

  // Reads what is there. False at the end of its output.
  bool hear() {
    char bytes[1 << 16];
    const ssize_t n = ::read(said_[0], bytes, sizeof bytes);
    if (n > 0) text_.append(bytes, static_cast<std::size_t>(n));
    return n > 0 || (n < 0 && errno == EINTR);
  }
  std::optional<nlohmann::json> result() {
    const std::size_t end = text_.find('\n');
    if (end == text_.npos) return {};
    nlohmann::json result = parse_json("worker", std::string_view(text_).substr(0, end));
    text_.erase(0, end + 1);
    job_.reset();
    return result;
  }
  // Why it ended, a sentence's part.
  std::string wait() {
    if (process_ <= 0) return {};
    int status = 0;
    while (::waitpid(process_, &status, 0) < 0 && errno == EINTR) continue;
    process_ = 0;
    if (!WIFSIGNALED(status)) return fmt::format("its process ended with code {}", WEXITSTATUS(status));
    if (WTERMSIG(status) == SIGKILL) return "its process was killed, as where memory runs out";
    return fmt::format("its process ended by signal {}", WTERMSIG(status));
  }

 private:
  Pipe told_, said_;
  pid_t process_ = 0;
  std::optional<BatchJob> job_;
  std::string scene_key_, text_;
};

class Batch {
 public:
  Batch(const BatchOptions& options, const CommonOptions& common, BatchResults* results)
      : options_(options), common_(common), results_(results) {}

  // Takes the jobs whose results do not stand.
  void plan(std::vector<BatchJob> jobs) {
    for (BatchJob& job : jobs) {
      try {
        if (!job.error.empty()) throw std::runtime_error(job.error);
        const std::filesystem::path folder = options_.output / job.name;
        std::optional<nlohmann::json> result;
        if (!options_.overwrite) result = standing_result(folder, job);
        if (result)
          results_->stands(*result);
        else
          waiting_.push_back(std::move(job));
      } catch (const std::runtime_error& error) {
        refused_.push_back(failed_result(job, error.what(), 0));
      }
    }
    stood_ = results_->size();
    all_ = jobs.size();
  }

  std::size_t stood() const { return stood_; }

  void run(const Job& job) {
    results_->begin();
    for (const nlohmann::json& result : refused_) add(result, job);
    while (!job.cancelled() && (!waiting_.empty() || !workers_.empty())) {
      start_workers();
      listen(job);
    }
    if (job.cancelled()) end_workers();
  }

 private:
  std::vector<std::string> worker_words() const {
    const int cores =
        common_.threads > 0 ? common_.threads : static_cast<int>(std::thread::hardware_concurrency());
    std::vector<std::string> words = {"/proc/self/exe",
                                      "batch",
                                      "/dev/null",
                                      "-o",
                                      options_.output.string(),
                                      "--worker",
                                      "--threads",
                                      std::to_string(std::max(1, cores / options_.workers))};
    if (options_.overwrite) words.emplace_back("--overwrite");
    if (common_.quiet) words.emplace_back("--quiet");
    if (!common_.cache) words.emplace_back("--no-cache");
    return words;
  }

  // One of the worker's scene, else the first of a scene that no worker has, else one of the scene with most
  // jobs left.
  BatchJob next_for(const std::string& scene_key) {
    const auto has_key = [](const std::string& key) {
      return [&key](const BatchJob& job) { return job.scene_key == key; };
    };
    auto next = std::ranges::find_if(waiting_, has_key(scene_key));
    if (next == waiting_.end())
      next = std::ranges::find_if(waiting_, [&](const BatchJob& job) {
        return std::ranges::none_of(workers_, [&](const auto& w) { return w.scene_key() == job.scene_key; });
      });
    if (next == waiting_.end())
      next = std::ranges::max_element(waiting_, {}, [&](const BatchJob& job) {
        return std::ranges::count_if(waiting_, has_key(job.scene_key));
      });
    BatchJob job = std::move(*next);
    waiting_.erase(next);
    return job;
  }

  void start_workers() {
    while (workers_.size() < static_cast<std::size_t>(options_.workers) && !waiting_.empty()) {
      workers_.emplace_back(worker_words());
      workers_.back().give(next_for({}));
    }
  }

  void add(const nlohmann::json& result, const Job& job) {
    results_->add(result);
    if (result.contains("error"))
      warn(fmt::format("{}: {}", result["job"].get<std::string>(), unstopped(result["error"])),
           common_.quiet);
    const std::size_t done = results_->size();
    job.progress(fmt::format("{} of {} jobs", done, all_),
                 static_cast<double>(done) / static_cast<double>(all_));
  }

  static std::string unstopped(std::string sentence) {
    if (sentence.ends_with('.')) sentence.pop_back();
    return sentence;
  }

  void listen(const Job& job) {
    constexpr int kLookMs = 100;
    std::vector<pollfd> outputs;
    for (const Worker& worker : workers_) outputs.push_back({worker.output(), POLLIN, 0});
    if (::poll(outputs.data(), outputs.size(), kLookMs) <= 0) return;
    auto output = outputs.begin();
    for (auto worker = workers_.begin(); worker != workers_.end();) {
      const bool speaks = (output++)->revents != 0;
      const bool ended = speaks && !worker->hear();
      while (const auto result = worker->result()) {
        add(*result, job);
        if (waiting_.empty())
          worker->no_more();
        else
          worker->give(next_for(worker->scene_key()));
      }
      if (ended) {
        const std::string why = worker->wait();
        if (worker->job()) {
          clear_after(*worker->job());
          add(failed_result(*worker->job(), sentence_of(Error("the job", why)), 0), job);
        }
      }
      worker = ended ? workers_.erase(worker) : std::next(worker);
    }
  }

  // Takes back what a process that is gone has half done.
  void clear_after(const BatchJob& job) const {
    try {
      const OutputFolder cleared(options_.output / job.name, true);  // as any next writer of it would
    } catch (const Error&) {  // what cannot be reached now is set right by the next run
    }
  }

  // Each takes back what it has half done.
  void end_workers() {
    for (Worker& worker : workers_) {
      worker.end();
      worker.no_more();
    }
    for (Worker& worker : workers_) worker.wait();
  }

  const BatchOptions& options_;
  const CommonOptions& common_;
  BatchResults* results_;
  std::deque<BatchJob> waiting_;
  std::vector<nlohmann::json> refused_;
  std::list<Worker> workers_;
  std::size_t stood_ = 0, all_ = 0;
};

void run_batch(const BatchOptions& options, const CommonOptions& common) {
  if (options.worker) return run_batch_worker(options.output, options.overwrite, common);
  const Part part = shard_of(options.shard);
  const std::string ending = options.shard.empty() ? "" : fmt::format(".{}-of-{}", part.index, part.of);
  for (const std::filesystem::path& file : result_files(options.output, ending))
    refuse_written_inputs(file, {options.jobs});
  std::vector<BatchJob> jobs = jobs_of_part(read_jobs(options.jobs), part.index, part.of);
  std::signal(SIGPIPE, SIG_IGN);  // a worker that ended is told so by its output
  const Job job = console_job(common.quiet);
  BatchResults results(options.output, ending);
  Batch batch(options, common, &results);
  const std::size_t count = jobs.size();
  batch.plan(std::move(jobs));
  batch.run(job);
  end_progress();
  if (job.cancelled())
    throw Error("splatcut batch",
                fmt::format("cancelled, {} of {} jobs are done", results.size() - results.failed(), count),
                "The same command goes on");
  results.finish();
  if (!common.quiet)
    fmt::print("{} jobs: {} done before, {} done, {} failed\n{}\n", count, batch.stood(),
               results.size() - batch.stood() - results.failed(), results.failed(), results.path().string());
  if (results.failed() > 0)
    throw Error("splatcut batch", fmt::format("{} of {} jobs failed", results.failed(), count),
                results.path().string() + " says why; the same command tries them again");
}

}  // namespace

void add_batch_command(CLI::App& program, const CommonOptions& common) {
  auto args = std::make_shared<BatchOptions>();
  CLI::App& command = *program.add_subcommand(
      "batch", "Cut a list of objects, a line of JSON each, and go on where it ended");
  command.footer("Example: splatcut batch jobs.jsonl -o cutouts --jobs 2");
  command
      .add_option("jobs", args->jobs,
                  "File with a job a line: {\"name\": \"lamp\", \"scene\": \"room.ply\", \"click\": "
                  "\"512,384\"}, the options of cut by their names")
      ->required();
  command
      .add_option("-o,--output", args->output,
                  "Folder to write, with a folder for each job; what stands there is not done again")
      ->required();
  constexpr int kMostWorkers = 256;
  command
      .add_option(
          "--jobs", args->workers,
          "Jobs that are done at once, each with its share of the threads and a scene of its own in memory")
      ->check(CLI::Range(1, kMostWorkers));
  command.add_option("--shard", args->shard, "I/N: only part I, from 0 to N-1, of N parts of the list");
  command.add_flag("--overwrite", args->overwrite,
                   "Do every job again, and write into folders that are there");
  command.add_flag("--worker", args->worker)->group("");  // of a batch alone
  command.callback([args, &common] { run_batch(*args, common); });
}

}  // namespace splatcut
