// The study: its arithmetic by hand, what it does to scenes, whose measurements it counts.
// study_runs_test.cpp runs it whole.
#include <algorithm>
#include <nlohmann/json.hpp>

#include "app/lab/eval_suite.h"
#include "app/lab/study/study_scenes.h"
#include "app/lab/study/study_tables.h"
#include "app/lab/study/study_variants.h"
#include "app/measure/robot_user.h"
#include "program_runner.h"
#include "segment/masks/mask_tools.h"
#include "segment/superpoints/orbit.h"

using namespace splatcut;
using namespace splatcut::testing;
using nlohmann::json;

namespace {

json result(const std::string& series, double x, double iou, double cpu_ms, const std::string& warned = "") {
  return {{"experiment", "e"},
          {"series", series},
          {"x", x},
          {"preset", "default"},
          {"set", json::array()},
          {"scene", "s"},
          {"image_iou", iou},
          {"boundary_iou", 0.5},
          {"gaussian_iou", nullptr},
          {"cpu_ms", cpu_ms},
          {"looked_at_mpx", cpu_ms / 100},
          {"warned", warned},
          {"stages", {{"cut", cpu_ms}}}};
}

// The apple of a still life of 8,000 Gaussians, loaded.
std::unique_ptr<LoadedCase> apple(const Workplace& place) {
  REQUIRE(place.run("make-scene small -o made --gaussians 8000").code == 0);
  for (const json& entry : read_suite(place / "made/suite.json"))
    if (entry.at("name") == "apple") return load_case(entry, place / "made", {}, {});
  FAIL("there is no apple");
  return nullptr;
}

double share_seen(const EvaluationCase& test, int width) {
  const Mask mask = labels_seen(test, limited_to_width(test.reference, width), test.truth_labels);
  return static_cast<double>(count(mask)) / static_cast<double>(mask.size());
}

}  // namespace

TEST_CASE("scores over scenes and draws: quantiles, failures, and whether they were said") {
  StudyResults results;
  for (int i = 1; i <= 20; ++i)
    results.push_back(result("a", 1, 0.05 * i, i, i == 3 || i == 20 ? "another size" : ""));
  results.push_back(result("a", 2, 1, 5));
  const std::vector<SettingScore> scores = scores_of(results);
  REQUIRE(scores.size() == 2);
  const SettingScore& s = scores[0];
  CHECK(s.runs == 20);
  CHECK(s.iou == doctest::Approx(0.525));
  CHECK(s.least == doctest::Approx(0.05));
  CHECK(s.p10 == doctest::Approx(0.1));
  CHECK(s.median == doctest::Approx(0.5));
  CHECK(s.cpu_ms == 10);
  CHECK(s.failed == 17);  // .05 to .85
  CHECK(s.failed_warned == 1);
  CHECK(s.fine_warned == 1);
  CHECK(s.stages.at("cut") == doctest::Approx(10.5));
}

TEST_CASE("what is nearly as good as the best of its scene does not fail") {
  const StudyResults results = {result("a", 1, 0.7, 1), result("a", 2, 0.82, 1), result("a", 3, 0.86, 1)};
  const StudyResults some = failing(results);
  REQUIRE(some.size() == 1);
  CHECK(some[0]["x"] == 1);
  const std::vector<SettingScore> scores = scores_of(results);
  CHECK(scores[0].failed == 1);
  CHECK(scores[1].failed == 0);
}

TEST_CASE("the front: what nothing cheaper beats, and how far others are behind it") {
  const std::vector<SettingScore> scores =
      scores_of({result("slow", 0, 0.9, 400), result("quick", 0, 0.7, 100), result("worse", 0, 0.6, 200),
                 result("middle", 0, 0.8, 200)});
  const std::vector<SettingScore> front = pareto_front(scores);
  REQUIRE(front.size() == 3);
  CHECK(front[0].series == "quick");
  CHECK(front[1].series == "middle");
  CHECK(front[2].series == "slow");
  CHECK(behind_front(scores[0], scores, &SettingScore::cpu_ms) == 0);
  CHECK(behind_front(scores[2], scores, &SettingScore::cpu_ms) == doctest::Approx(0.2));
  CHECK(behind_front(scores[2], scores, &SettingScore::looked_at_mpx) == doctest::Approx(0.2));
}

TEST_CASE("a board hides the stated share of the object in the first view, and nothing in the truth") {
  const Workplace place;
  const auto loaded = apple(place);
  const double whole = share_seen(loaded->test, 320);
  for (const double hidden : {0.25, 0.5, 0.75}) {
    const GaussianCloud cloud = with_board(loaded->test, hidden);
    EvaluationCase test = loaded->test;
    test.cloud = &cloud;
    test.truth_labels.resize(cloud.size(), 0);
    CHECK(share_seen(test, 320) / whole == doctest::Approx(1 - hidden).epsilon(0.12));
    CHECK(cloud.sh_rest.size() == cloud.size() * cloud.sh_stride());
    CHECK(std::equal(loaded->scene.cloud.position.begin(), loaded->scene.cloud.position.end(),
                     cloud.position.begin()));
  }
  CHECK(with_board(loaded->test, 0).size() == loaded->scene.cloud.size());
}

TEST_CASE("a view is aimed so that the object fills the stated share of it, and shows the clicked surface") {
  const Workplace place;
  const auto loaded = apple(place);
  const EvaluationCase& test = loaded->test;
  const Mask& truth = *test.reference_truth;
  const ViewClick click{test.reference, *robot_click(truth, Mask(truth.width(), truth.height()))};
  const auto point = clicked_point(*test.cloud, click);
  REQUIRE(point);
  for (const double share : {0.002, 0.05, 0.3}) {
    EvaluationCase aimed = test;
    aimed.reference = framed(test.reference, *point, truth, share);
    CHECK(share_seen(aimed, 640) == doctest::Approx(share).epsilon(0.15));
    CHECK(aimed.reference.centre_world().x == doctest::Approx(test.reference.centre_world().x));
    const auto there = clicked_from(aimed.reference, *test.cloud, click);
    REQUIRE(there);
    CHECK(there->stroke.points_px.front().x == doctest::Approx(0.5 * test.reference.width_px).epsilon(0.01));
  }
  CHECK(!clicked_from(approached(test.reference, *point, -1), *test.cloud, click));  // from behind it
  EvaluationCase half = test;
  resize_tests(&half, 0.5);
  CHECK(half.test_views[0].width_px == 504);
  CHECK(half.truth_masks[0].height() == 378);
  CHECK(score_images(half, half.truth_labels).iou == 1);
}

TEST_CASE("a study counts what its own program measured, not what another one left in the folder") {
  const Workplace place;
  const std::string command =
      "study -o study --quick --cells 1 --draws 1 --gaussians 2500 --only views --no-charts";
  const auto lines = [&] {
    const std::string cells = place.text("study/cells.jsonl");
    return std::ranges::count(cells, '\n');
  };
  const auto results = [&] { return std::ssize(json::parse(place.text("study/results.json"))["results"]); };
  REQUIRE(place.run(command).code == 0);
  const auto own = lines();
  REQUIRE(own > 0);
  CHECK(results() == own);
  // The same program but for a byte that nobody reads.
  std::filesystem::copy(lab_program(), place / "other-lab");
  std::ofstream(place / "other-lab", std::ios::binary | std::ios::app) << 'x';
  const Result other = place.run_program((place / "other-lab").string(), command);
  CHECK(other.code == 0);
  CHECK(other.err.find("measurements of another program") != std::string::npos);
  CHECK(lines() == 2 * own);
  CHECK(results() == own);
  REQUIRE(place.run(command).code == 0);  // its own are still there
  CHECK(lines() == 2 * own);
  CHECK(results() == own);
}
