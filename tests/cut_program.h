// Cuts of the still life by the program, true masks to give them, and requests that it refuses.
#pragma once

#include <doctest/doctest.h>

#include <initializer_list>
#include <string>
#include <vector>

#include "program_runner.h"
#include "small_still_life.h"

namespace splatcut::testing {

inline constexpr const char* kSize = " --size 504x378";

inline double iou(const std::string& a, const std::string& b) {
  REQUIRE(a.size() == b.size());
  std::size_t both = 0, either = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    both += a[i] && b[i];
    either += a[i] || b[i];
  }
  return either ? static_cast<double>(both) / static_cast<double>(either) : 1.0;
}

// The true mask of the apple in a view, in the same place for every test.
inline std::string apple_mask(int view, const std::string& size = kSize) {
  const Workplace& place = still_life().place;
  const std::string name = "truth_" + std::to_string(view) + (size.empty() ? "_full" : "") + ".png";
  if (place.exists(name)) return name;
  place.write("apple.labels.u8", still_life().truth_of("apple"));
  REQUIRE(place
              .run("render " + still_life().scene + " " + still_life().cameras + " --camera " +
                   std::to_string(view) + size + " --what labels --labels apple.labels.u8 -o " + name)
              .code == 0);
  return name;
}

inline void black_mask(const std::string& name) {  // nothing is labelled
  const Workplace& place = still_life().place;
  place.write("none.labels.u8", std::string(20000, '\0'));
  REQUIRE(place
              .run("render " + still_life().scene + " " + still_life().camera + kSize +
                   " --what labels --labels none.labels.u8 --overwrite -o " + name)
              .code == 0);
}

inline std::string cut_with(const std::string& rest) {
  return "cut " + still_life().scene + " " + still_life().cameras + rest;
}

inline void refused(const std::string& arguments, const std::vector<std::string>& whole,
                    std::initializer_list<const char*> parts, int code = 1) {
  const Workplace& place = still_life().place;
  const Result result = place.run(arguments + " -o refused", whole);
  CAPTURE(arguments);
  CAPTURE(result.err);
  CHECK(result.code == code);
  if (code == 1) {  // before the sentence, what a program of the user's printed
    const std::size_t sentence = result.err.rfind("splatcut: ");
    REQUIRE(sentence != std::string::npos);
    CHECK((sentence == 0 || result.err[sentence - 1] == '\n'));
    CHECK(result.err.find('\n', sentence) == result.err.size() - 1);
    CHECK(result.err.ends_with(".\n"));
  }
  for (const char* part : parts) CHECK_MESSAGE(result.err.find(part) != std::string::npos, part);
  CHECK_FALSE(place.exists("refused"));
  CHECK(place.leftovers().empty());
}

}  // namespace splatcut::testing
