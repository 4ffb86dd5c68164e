// The fit: on decisions whose best weights are known, and by the program on a still life.
#include <doctest/doctest.h>

#include <nlohmann/json.hpp>

#include "app/measure/decisions.h"
#include "core/counter_rng.h"
#include "fit_suites.h"
#include "program_runner.h"

using namespace splatcut;
using namespace splatcut::testing;
using nlohmann::json;

namespace {

// A candidate is worth the more the less it has of kRare, and nothing else matters; in scene `odd`, the more
// it has.
std::vector<Decision> rare_is_worse(std::size_t scenes, std::size_t odd) {
  std::vector<Decision> all;
  CounterRng random(5, 0);
  for (std::size_t scene = 0; scene < scenes; ++scene)
    for (int d = 0; d < 5; ++d) {
      Decision decision{.scene = scene, .of = DecisionOf::kFirstClick, .meanings = {}};
      for (int m = 0; m < 6; ++m) {
        Meaning meaning;
        const float rare = random.between(0, 1);
        weight(&meaning.terms, Term::kRare) = rare;
        weight(&meaning.terms, Term::kFrame) = random.between(0, 1);
        meaning.iou = scene == odd ? rare : 1 - rare;
        decision.meanings.push_back(meaning);
      }
      all.push_back(decision);
    }
  return all;
}

}  // namespace

TEST_CASE("fit: weights follow what candidates are worth, terms that say nothing stay small") {
  const std::vector<Decision> decisions = rare_is_worse(4, 4);
  TermValues fitted = fitted_terms(decisions, DecisionOf::kFirstClick, std::vector<bool>(4, true));
  CHECK(weight(&fitted, Term::kRare) > 3);
  CHECK(std::abs(weight(&fitted, Term::kFrame)) < 0.3f * weight(&fitted, Term::kRare));
  CHECK(weight(&fitted, Term::kOpposed) == 0);  // no candidate has it
  CHECK(fitted_terms(decisions, DecisionOf::kCorrection, std::vector<bool>(4, true)) ==
        TermValues{});  // no correction is known
  CHECK(fitted_terms(decisions, DecisionOf::kFirstClick, std::vector<bool>(4, true)) == fitted);
  TermValues without = fitted_terms(decisions, DecisionOf::kFirstClick, std::vector<bool>(4, true),
                                    {.without = 1u << static_cast<unsigned>(Term::kRare)});
  CHECK(weight(&without, Term::kRare) == 0);
}

TEST_CASE("fit: a scene counts by being in, not by how many decisions it has") {
  std::vector<Decision> decisions = rare_is_worse(2, 1);
  TermValues with = fitted_terms(decisions, DecisionOf::kFirstClick, {true, false});
  CHECK(weight(&with, Term::kRare) > 3);
  TermValues odd = fitted_terms(decisions, DecisionOf::kFirstClick, {false, true});
  CHECK(weight(&odd, Term::kRare) < -3);
  const TermValues both = fitted_terms(decisions, DecisionOf::kFirstClick, {true, true});
  std::vector<Decision> twice = decisions;
  for (const Decision& d : decisions)
    if (d.scene == 1) twice.push_back(d);
  const TermValues again = fitted_terms(twice, DecisionOf::kFirstClick, {true, true});
  for (std::size_t t = 0; t < kTerms; ++t) CHECK(again[t] == doctest::Approx(both[t]).epsilon(0.1));
}

TEST_CASE(
    "fit by the program: a row a scene, as shipped, fitted with it and without it, and what it refuses") {
  const Workplace place;
  write_fit_suites(place);
  const std::string command = "fit made/some.json other/some.json --robot-clicks 2 --starts 1 -o ";
  const Result result = place.run_program(lab_program(), command + "out");
  REQUIRE_MESSAGE(result.code == 0, result.err);
  const json fit = json::parse(place.text("out/fit.json"));
  REQUIRE(fit["scenes"].size() == 4);
  CHECK(fit["scenes"][0]["capture"] == fit["scenes"][1]["capture"]);  // left out together
  CHECK(fit["scenes"][0]["capture"] != fit["scenes"][2]["capture"]);
  for (const json& scene : fit["scenes"])
    for (const char* key : {"shipped", "fitted_with", "fitted_without"})
      CHECK_MESSAGE(scene[key].size() == 2, key);
  CHECK(fit["scenes"][0]["weights_without"] == fit["scenes"][1]["weights_without"]);
  const Result wrong = place.run_program(lab_program(), command + "wrong --without colour");
  CHECK(wrong.code == 1);
  CHECK(wrong.err.find("colour") != std::string::npos);
}
