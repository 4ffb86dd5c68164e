// The fit: on scores whose best weights are known, and by the program on a still life.
#include "app/lab/fit.h"

#include <cmath>
#include <nlohmann/json.hpp>
#include <numeric>

#include "program_runner.h"

using namespace splatcut;
using namespace splatcut::testing;
using nlohmann::json;

namespace {

// Scene i wants the first weight at wanted[i]; the second should be 0.25 everywhere.
struct Wishes {
  std::vector<double> wanted = {1, 1, 1, 4};
  float first = 2, second = 1;
  int asked = 0;

  std::vector<Weight> table() { return {{"first", &first, 0, 10}, {"second", &second, 0, 1}}; }
  double score(std::size_t scene) {
    ++asked;
    const double off = std::log(first / wanted[scene]), other = second - 0.25;
    return 1 - 0.1 * off * off - 0.1 * other * other;
  }
};

const FitOptions kThorough{.rounds = 60, .least_step = 0.005f, .least_gain = 1e-9};

}  // namespace

TEST_CASE("fit finds the best weights, leaves them as they were, and asks for each score once") {
  Wishes wishes;
  Fitter fitter(wishes.table(), 4, [&](std::size_t scene) { return wishes.score(scene); });
  const std::vector<std::size_t> all = {0, 1, 2, 3};
  const Fit fit = fitter.fit(all, kThorough);
  CHECK(fit.values[0] == doctest::Approx(std::pow(4.0, 0.25)).epsilon(0.02));  // the mean of the logarithms
  CHECK(fit.values[1] == doctest::Approx(0.25).epsilon(0.02));
  CHECK(wishes.first == 2);
  CHECK(wishes.second == 1);
  CHECK(fit.score ==
        doctest::Approx(std::accumulate(fit.scene_scores.begin(), fit.scene_scores.end(), 0.0) / 4));
  CHECK(static_cast<std::size_t>(wishes.asked) == fitter.scored());
  const int asked = wishes.asked;
  CHECK(fitter.fit(all, kThorough).values == fit.values);  // the same seed
  CHECK(wishes.asked == asked);
  CHECK(fitter.fit(all, {.rounds = 0}).values == fitter.shipped());
}

TEST_CASE("fit: a scene that is like no other gains by being fitted to and loses by being left out") {
  Wishes wishes;
  Fitter fitter(wishes.table(), 4, [&](std::size_t scene) { return wishes.score(scene); });
  const LeaveOneOut table = leave_one_out(&fitter, 4, kThorough);
  REQUIRE(table.without.size() == 4);
  CHECK(table.others[3].values[0] == doctest::Approx(1).epsilon(0.02));  // what the three others want
  const double off = std::log(4.0);
  CHECK(table.without[3] == doctest::Approx(1 - 0.1 * off * off).epsilon(0.01));
  CHECK(table.with[3] > table.without[3]);
  for (std::size_t i = 0; i < 3; ++i) CHECK(table.with[i] > table.shipped[i]);
  Wishes one;
  Fitter alone(one.table(), 1, [&](std::size_t scene) { return one.score(scene); });
  CHECK(leave_one_out(&alone, 1, kThorough).without.empty());  // nothing is left to fit to
}

TEST_CASE("fit by the program: a row a scene, as shipped, fitted with it and without it, the same twice") {
  const Workplace place;
  REQUIRE(place.run("make-scene small -o made --gaussians 4000").code == 0);
  json suite = json::parse(place.text("made/suite.json"));
  json some = json::array();
  for (json entry : suite["scenes"]) {
    if (entry["name"] != "apple" && entry["name"] != "mug") continue;
    const json view = entry["test_views"][0];
    entry["test_views"] = json::array({view});
    some.push_back(entry);
  }
  place.write("made/some.json", json{{"scenes", some}}.dump());
  const std::string command =
      " made/some.json --preset fast --robot-clicks 2 --starts 1 --rounds 2 --seed 7 -o ";
  const Result result = place.run_program(SPLATCUT_LAB_PROGRAM, "fit" + command + "out");
  REQUIRE_MESSAGE(result.code == 0, result.err);
  const json fit = json::parse(place.text("out/fit.json"));
  CHECK(fit["seed"] == 7);
  REQUIRE(fit["scenes"].size() == 2);
  double shipped = 0, with = 0;
  for (const json& scene : fit["scenes"]) {
    for (const char* key : {"shipped", "fitted_with", "fitted_without"})
      CHECK_MESSAGE(scene[key].is_number(), key);
    shipped += scene["shipped"].get<double>();
    with += scene["fitted_with"].get<double>();
  }
  CHECK(with >= shipped);
  CHECK(fit["fitted"]["smoothness"].is_number());
  REQUIRE(place.run_program(SPLATCUT_LAB_PROGRAM, "fit" + command + "again --threads 1").code == 0);
  CHECK(place.text("again/fit.json") == place.text("out/fit.json"));
}
