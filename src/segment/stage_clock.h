// Adds up wall-clock milliseconds per named stage.
#pragma once

#include <chrono>
#include <string>
#include <string_view>
#include <vector>

namespace splatcut {

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

 private:
  struct Booking {
    StageClock* clock;
    std::string_view name;
    std::chrono::steady_clock::time_point start;
    ~Booking() {
      clock->book(
          name, std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count());
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
