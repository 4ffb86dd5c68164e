#include "app/workspace/task_thread.h"

#include <sys/resource.h>
#include <tbb/task_scheduler_observer.h>
#include <unistd.h>

#include <algorithm>
#include <exception>

#include "core/error.h"

namespace splatcut {

namespace {

// A third and a ninth of the share of a thread that draws: what is computed makes way where there are few
// cores.
constexpr int kNice = 5, kBackgroundNice = 10;

// For good: a thread may lack the privilege to raise its priority again.
void lower_priority_of_this_thread(int nice) {
  setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), nice);
}

// TBB's threads, too, once they have helped the thread that made this.
class HelpersMakeWay : public tbb::task_scheduler_observer {
 public:
  HelpersMakeWay() { observe(true); }
  ~HelpersMakeWay() override { observe(false); }
  void on_scheduler_entry(bool is_worker) override {
    if (is_worker) lower_priority_of_this_thread(kNice);
  }
};

// Runs work() on a thread of its own at low priority. Throws what work() throws.
void run_in_background(const std::function<void()>& work) {
  std::exception_ptr trouble;
  std::jthread([&] {
    lower_priority_of_this_thread(kBackgroundNice);
    try {
      work();
    } catch (...) {
      trouble = std::current_exception();
    }
  }).join();
  if (trouble) std::rethrow_exception(trouble);
}

}  // namespace

bool asked_for(TaskKind kind) {
  return kind != TaskKind::kHover && kind != TaskKind::kReady && kind != TaskKind::kAhead &&
         kind != TaskKind::kStyle && kind != TaskKind::kLarger && kind != TaskKind::kSides;
}

TaskThread::TaskThread(std::function<void()> wake, bool inline_work)
    : wake_(std::move(wake)), inline_work_(inline_work) {
  if (!inline_work_) thread_ = std::jthread([this](const std::stop_token& stop) { run(stop); });
}

TaskThread::~TaskThread() {
  {
    std::unique_lock lock(mutex_);
    std::erase_if(waiting_, [](const Task& t) { return t.order.kind != TaskKind::kSave; });
    if (running_kind_ != TaskKind::kSave) running_stop_.request_stop();
    while (running_ || !waiting_.empty()) ended_.wait(lock);
  }
  thread_.request_stop();
  if (thread_.joinable()) thread_.join();
}

void TaskThread::submit(Order order, Work work) {
  const TaskKind kind = order.kind;
  Task task{std::move(order), std::move(work), {}};
  if (inline_work_) {
    perform(task);
    deliver();
    return;
  }
  {
    const std::lock_guard lock(mutex_);
    if (kind != TaskKind::kExport && kind != TaskKind::kSave && kind != TaskKind::kSelect) stop(kind);
    if (asked_for(kind))
      for (const TaskKind by_itself : {TaskKind::kReady, TaskKind::kAhead, TaskKind::kLarger})
        stop(by_itself);
    waiting_.push_back(std::move(task));
  }
  changed_.notify_one();
}

void TaskThread::cancel(TaskKind kind) {
  const std::lock_guard lock(mutex_);
  stop(kind);
}

void TaskThread::stop(TaskKind kind) {
  std::erase_if(waiting_, [&](const Task& t) { return t.order.kind == kind; });
  if (running_ && running_kind_ == kind) running_stop_.request_stop();
}

bool TaskThread::busy(TaskKind kind) const {
  const std::lock_guard lock(mutex_);
  return (running_ && running_kind_ == kind) ||
         std::ranges::any_of(waiting_, [&](const Task& t) { return t.order.kind == kind; });
}

bool TaskThread::idle() const {
  const std::lock_guard lock(mutex_);
  return !running_ && waiting_.empty() && posted_.empty();
}

TaskThread::Progress TaskThread::progress() const {
  const std::lock_guard lock(mutex_);
  return progress_;
}

void TaskThread::post(std::function<void()> closure) {
  {
    const std::lock_guard lock(mutex_);
    posted_.push_back(std::move(closure));
  }
  if (wake_) wake_();
}

bool TaskThread::deliver() {
  std::vector<std::function<void()>> closures;
  {
    const std::lock_guard lock(mutex_);
    closures.swap(posted_);
  }
  for (const auto& closure : closures) closure();
  return !closures.empty();
}

void TaskThread::perform(Task& task) {
  Job job;
  job.stop = task.stop.get_token();
  job.on_progress = [this, kind = task.order.kind](std::string_view stage, double fraction) {
    {
      const std::lock_guard lock(mutex_);
      progress_ = {asked_for(kind), kind, std::string(stage), fraction};
    }
    if (wake_) wake_();
  };
  const auto report = [&](std::string message) {
    if (job.cancelled()) return;
    post([this, failed = task.order.failed, message = std::move(message)] {
      if (failed) failed();
      if (on_error) on_error(message);
    });
  };
  try {
    if (task.order.kind == TaskKind::kPrepare && !inline_work_)
      run_in_background([&] { task.work(job); });
    else
      task.work(job);
  } catch (const std::exception& error) {
    report(sentence_of(error));
  }
}

void TaskThread::run(const std::stop_token& stop) {
  lower_priority_of_this_thread(kNice);
  const HelpersMakeWay helpers;
  while (true) {
    std::unique_lock lock(mutex_);
    if (!changed_.wait(lock, stop, [&] { return !waiting_.empty(); })) return;
    Task task = std::move(waiting_.front());
    waiting_.pop_front();
    running_ = true;
    running_kind_ = task.order.kind;
    running_stop_ = task.stop;
    const TaskKind kind = task.order.kind;
    progress_ = {asked_for(kind), kind, {}, 0};
    lock.unlock();
    perform(task);
    lock.lock();
    running_ = false;
    progress_ = {};
    ended_.notify_all();
    lock.unlock();
    if (wake_) wake_();
  }
}

}  // namespace splatcut
