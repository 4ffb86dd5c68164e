// Adds up wall-clock milliseconds per named stage.
#pragma once

#include <chrono>
#include <new>
#include <string>
#include <string_view>
#include <vector>

namespace splatcut {

inline double ms_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

struct StageTime {
  std::string name;
  double ms = 0;
};

class StageClock {
 public:
  explicit StageClock(std::vector<StageTime>* stages) : stages_(stages) {}

  // Runs work() and books its time on `name`.
  template <class Work>
  auto time(std::string_view name, const Work& work) {
    const Booking booking{this, name, std::chrono::steady_clock::now()};
    return work();
  }

  void book(const std::vector<StageTime>& times) {
    for (const StageTime& stage : times) book(stage.name, stage.ms);
  }

 private:
  struct Booking {
    StageClock* clock;
    std::string_view name;
    std::chrono::steady_clock::time_point start;
    ~Booking() {
      const double ms = ms_since(start);
      try {
        clock->book(name, ms);
      } catch (const std::bad_alloc&) {
        // Without memory the stage goes without its time; an exception may be on its way already.
      }
    }
  };

  void book(std::string_view name, double ms) {
    for (StageTime& stage : *stages_)
      if (stage.name == name) {
        stage.ms += ms;
        return;
      }
    stages_->push_back({std::string(name), ms});
  }

  std::vector<StageTime>* stages_;
};

}  // namespace splatcut
