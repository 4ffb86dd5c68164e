// A still life of 20,000 Gaussians, made once by the program, with a click on each of its things.
#pragma once

#include <doctest/doctest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>

#include "program_runner.h"

namespace splatcut::testing {

struct StillLife {
  Workplace place;
  std::string scene = (place / "made/small.ply").string();
  std::string cameras = "--cameras " + (place / "made/cameras.json").string();
  std::string camera = cameras + " --camera 0";
  std::string click;  // on the apple

  StillLife() {
    REQUIRE(place.run("make-scene small -o made --gaussians 20000").code == 0);
    click = click_on("apple");
  }

  std::string cut(const std::string& rest) const { return "cut " + scene + " " + camera + " " + rest; }

  std::string click_on(const std::string& thing) const {
    const nlohmann::json seeds = nlohmann::json::parse(place.text("made/seeds.json"));
    for (const nlohmann::json& object : seeds["objects"])
      if (object["object"] == thing) {
        const nlohmann::json& at = object["clicks"][0];
        return std::to_string(at["x"].get<int>()) + "," + std::to_string(at["y"].get<int>());
      }
    FAIL("there is no ", thing);
    return {};
  }

  // 1 where the Gaussian belongs to the thing, in file order.
  std::string truth_of(const std::string& thing) const {
    const nlohmann::json names = nlohmann::json::parse(place.text("made/seeds.json"))["labels"];
    const auto label = static_cast<char>(std::find(names.begin(), names.end(), thing) - names.begin());
    std::string labels = place.text("made/small.labels.u8");
    for (char& l : labels) l = l == label ? '\1' : '\0';
    return labels;
  }
};

inline bool has_keys(const nlohmann::json& object, std::initializer_list<const char*> keys) {
  for (const char* key : keys)
    if (!object.contains(key)) {
      MESSAGE("lacks ", std::string(key));
      return false;
    }
  return true;
}

inline StillLife& still_life() {
  static StillLife made;
  return made;
}

}  // namespace splatcut::testing
