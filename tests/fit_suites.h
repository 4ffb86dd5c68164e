// Two suites of two objects each, from two still lifes, for runs of `fit`.
#pragma once

#include <nlohmann/json.hpp>

#include "program_runner.h"

namespace splatcut::testing {

// made/some.json and other/some.json, each of an apple and a mug that one view tests.
inline void write_fit_suites(const Workplace& place) {
  using nlohmann::json;
  for (const std::string folder : {"made", "other"}) {
    const std::string seed = folder == "made" ? "" : " --seed 2";
    REQUIRE(place.run("make-scene " + folder + " -o " + folder + " --gaussians 4000" + seed).code == 0);
    const json suite = json::parse(place.text(folder + "/suite.json"));
    json some = json::array();
    for (json entry : suite["scenes"]) {
      if (entry["name"] != "apple" && entry["name"] != "mug") continue;
      const json view = entry["test_views"][0];
      entry["test_views"] = json::array({view});
      some.push_back(entry);
    }
    place.write(folder + "/some.json", json{{"scenes", some}}.dump());
  }
}

}  // namespace splatcut::testing
