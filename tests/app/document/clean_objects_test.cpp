// The cache of objects with clean edges, as several threads ask it.
#include <doctest/doctest.h>

#include <chrono>
#include <thread>
#include <vector>

#include "app/document/clean_objects.h"

using namespace splatcut;

TEST_CASE("clean objects: labels that another thread lets go of meanwhile are compared with no more") {
  constexpr std::size_t kGaussians = 200000;
  constexpr int kRounds = 30, kAtOnce = 12;
  const CleanObjects clean(nullptr);  // nothing is computed here
  const auto ask = [&clean](std::uint8_t thread) {
    for (int round = 0; round < kRounds; ++round) {
      std::vector<Flags> asked;
      for (int i = 0; i < kAtOnce; ++i) {  // all differ at their ends alone: comparing takes its time
        std::vector<std::uint8_t> labels(kGaussians, 1);
        labels[kGaussians - 1] = thread;
        labels[kGaussians - 2] = static_cast<std::uint8_t>(i);
        asked.push_back(make_flags(std::move(labels)));
        CHECK(clean.known(asked.back(), {0, 1, 0}) == nullptr);
      }
      for (; !asked.empty(); asked.pop_back()) std::this_thread::sleep_for(std::chrono::microseconds(50));
    }
  };
  std::vector<std::thread> threads;
  for (std::uint8_t thread = 0; thread < 4; ++thread) threads.emplace_back(ask, thread);
  for (std::thread& thread : threads) thread.join();
}
