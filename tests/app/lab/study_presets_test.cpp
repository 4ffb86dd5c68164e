// The presets that are shipped, against all others that the study tries: slow.
#include <algorithm>
#include <nlohmann/json.hpp>

#include "app/lab/eval_suite.h"
#include "app/lab/study/study_tables.h"
#include "program_runner.h"

using namespace splatcut;
using namespace splatcut::testing;
using nlohmann::json;

TEST_CASE("the presets that are shipped are those of the study, and near its front") {
  const Workplace place;
  REQUIRE(place.run("make-scene small -o made --gaussians 12000").code == 0);
  json some = json::array();
  for (json entry : read_suite(place / "made/suite.json")) {
    if (entry["name"] != "apple" && entry["name"] != "mug") continue;
    const json views = entry["test_views"];
    entry["test_views"] = {views[0], views[9], views[18]};
    some.push_back(entry);
  }
  place.write("made/some.json", json{{"scenes", some}}.dump());
  REQUIRE(place.run("study made/some.json -o study --quick --only trade-off --cells 13 --no-charts").code ==
          0);
  const json results = json::parse(place.text("study/results.json"))["results"];
  const std::vector<SettingScore> all = scores_of({results.begin(), results.end()});
  for (const std::string name : {"fast", "default", "best"}) {
    const auto shipped = std::ranges::find_if(
        all, [&](const SettingScore& s) { return s.series == "preset" && s.label == name; });
    REQUIRE_MESSAGE(shipped != all.end(), name);
    // By what it looks at, which is the same on every machine: seconds are not.
    // Parts alone are hard to beat on clean still lifes: default and best pay .01 to .021 there for what
    // captures and straddling splats gain (docs/study.md).
    const double behind = behind_front(*shipped, all, &SettingScore::looked_at_mpx);
    CHECK_MESSAGE(behind <= (name == "fast" ? 0.005 : 0.025), name << " " << behind);
    // What the study measured is what the command does: nothing is set beside the preset.
    REQUIRE(place.run("eval made/some.json -o " + name + " --no-curve --preset " + name).code == 0);
    const json scenes = json::parse(place.text(name + "/eval.json"))["scenes"];
    REQUIRE(!scenes.empty());
    for (const json& scene : scenes) {
      const auto own = std::ranges::find_if(results, [&](const json& r) {
        return r["series"] == "preset" && r["preset"] == name && r["scene"] == scene["name"];
      });
      REQUIRE(own != results.end());
      CHECK((*own)["set"].empty());
      CHECK((*own)["image_iou"] == scene["image_iou"]);
    }
  }
}
