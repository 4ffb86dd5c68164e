// Worker thread for tasks that take long: load, prepare, cut, select, export. A task works on snapshots and
// returns its results as closures, which the main thread runs in deliver().
//
// The latest request wins: a new task drops the waiting task of its kind and stops the running one. Exports,
// saves and selections are the exception: they all run, one after the other, because each is a file or a step
// of the history that the user asked for. Any task that was asked for stops what only prepares a click,
// cuts ahead or draws a thumbnail larger. Tasks run at a lower priority than what draws the window, and
// preparing runs at a lower one still, so that pictures come first even if there are few cores. Cancelling is
// a normal end. Shutdown: saves that wait are done, other tasks are stopped or dropped, and the thread is
// joined.
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
  kSeen,  // finds out what no view showed of an object
  kSelect,
  kStyle,
  kHover,
  kReady,   // prepares a click that may come
  kAhead,   // cuts at a size that may be asked for
  kLarger,  // draws a thumbnail larger
  kSides,   // looks for sides from which less hides an object
  kExport,
  kSave,
  kAutosave
};

// True if the user asked for tasks of this kind. False: the program does them by itself, and nobody waits.
bool asked_for(TaskKind kind);

class TaskThread {
 public:
  // Work of a task, run on the worker. What it throws is reported to Order::failed, then to on_error, unless
  // the task was stopped or replaced.
  using Work = std::function<void(const Job& job)>;

  struct Order {
    TaskKind kind;
    std::function<void()> failed;  // called in deliver() if the work throws
    Order(TaskKind task_kind, std::function<void()> on_failure = {})
        : kind(task_kind), failed(std::move(on_failure)) {}
  };

  struct Progress {
    bool busy = false;  // true: a task runs that is asked_for()
    TaskKind kind = TaskKind::kLoad;
    std::string stage;
    double fraction = 0;  // share of the stage that is done, [0, 1]
  };

  // wake: is called from the worker when there is something to deliver. inline_work: every task runs and is
  // delivered inside submit(), for tests that need one order of events.
  explicit TaskThread(std::function<void()> wake = {}, bool inline_work = false);
  ~TaskThread();

  void submit(Order order, Work work);
  void cancel(TaskKind kind);
  bool busy(TaskKind kind) const;  // true: a task of this kind waits or runs
  bool idle() const;               // true: nothing waits, runs, or is to be delivered
  Progress progress() const;

  // Hands a closure to the main thread. Tasks call it on the worker.
  void post(std::function<void()> closure);

  // Runs the closures that were posted; called on the main thread. Returns true if there were any.
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
  void stop(TaskKind kind);  // under mutex_

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
  std::jthread thread_;  // last member: the thread ends before what it uses is destroyed
};

}  // namespace splatcut
