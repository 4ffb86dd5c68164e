// A worker for what takes long: load, prepare, cut, select, export. Work runs on snapshots; what it finds
// comes back as closures that the main thread runs in deliver().
//
// A task of a kind replaces the waiting and stops the running task of the same kind: the latest request wins.
// Exports and saved work wait for each other: each is a file that somebody asked for. Everything runs at a
// lower priority than what draws the window, preparing lower still: pictures of the scene come first, also
// where there are few cores. Cancel is a normal end.
// Shutdown: work that waits to be saved is saved, other tasks are stopped or dropped, the thread is joined.
#pragma once

#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "core/job.h"

namespace splatcut {

enum class TaskKind {
  kLoad,
  kPrepare,
  kCut,
  kClean,
  kSelect,
  kStyle,
  kHover,
  kReady,  // ahead of a click
  kExport,
  kSave,
  kAutosave
};

// False: the program does it by itself, nobody waits for its end.
bool asked_for(TaskKind kind);

class TaskThread {
 public:
  // Runs on the worker. What it throws arrives in `failed` of its own order, then in on_error; trouble of a
  // task that was stopped or replaced is dropped.
  using Work = std::function<void(const Job& job)>;

  struct Order {
    TaskKind kind;
    std::function<void()> failed;  // called in deliver()
    Order(TaskKind task_kind, std::function<void()> on_failure = {})
        : kind(task_kind), failed(std::move(on_failure)) {}
  };

  struct Progress {
    bool busy = false;  // with something that is asked_for()
    TaskKind kind = TaskKind::kLoad;
    std::string stage;
    double fraction = 0;  // [0, 1]
  };

  // wake: called from the worker when there is something to deliver. inline_work: every task runs and is
  // delivered inside submit(), for tests that want one order of events.
  explicit TaskThread(std::function<void()> wake = {}, bool inline_work = false);
  ~TaskThread();

  void submit(Order order, Work work);
  void cancel(TaskKind kind);
  bool busy(TaskKind kind) const;  // waiting or running
  bool idle() const;
  Progress progress() const;

  // From the worker: `closure` will run on the main thread.
  void post(std::function<void()> closure);

  // Main thread: runs what was posted. True where there was anything.
  bool deliver();

  std::function<void(const std::string& message)> on_error;  // called in deliver()

 private:
  struct Task {
    Order order;
    Work work;
    std::stop_source stop;
  };
  void run(const std::stop_token& stop);
  void perform(Task& task);

  std::function<void()> wake_;
  const bool inline_work_;
  mutable std::mutex mutex_;
  std::condition_variable_any changed_, ended_;
  std::deque<Task> waiting_;
  bool running_ = false;
  TaskKind running_kind_ = TaskKind::kLoad;
  std::stop_source running_stop_;
  Progress progress_;
  std::vector<std::function<void()>> posted_;
  std::jthread thread_;  // last: ends before the rest goes
};

}  // namespace splatcut
