// The chart of sessions click by click, on measured files written by hand.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "program_runner.h"

using namespace splatcut;
using namespace splatcut::testing;
using nlohmann::json;

TEST_CASE("click-chart: means over objects, shares of sessions, a line a suite and the one of all") {
  const Workplace place;
  const auto object = [](const std::vector<std::vector<double>>& iou_after, double noc90) {
    json robot = {{"noc85", 1.5}, {"noc90", noc90}, {"sessions", json::array()}};
    for (const std::vector<double>& iou : iou_after) robot["sessions"].push_back({{"iou_after", iou}});
    return json{{"any_view", robot}};
  };
  for (const char* suite : {"one", "two", "longer"}) place.make_folder(suite);
  // The first object's second session falls below .9 again, which it had reached.
  const json first = object({{0.5, 0.75}, {1.0, 0.75}}, 10.5), second = object({{0.25, 0.5}}, 20);
  place.write("one/eval.json", json{{"scenes", {first, second}}}.dump());
  place.write("two/eval.json", json{{"scenes", {object({{0.5, 1.0}}, 2)}}}.dump());
  const Result result = place.run("click-chart one/eval.json two/eval.json -o chart");
  REQUIRE_MESSAGE(result.code == 0, result.err);
  const std::string third = fmt::format("{}", 1.0 / 3);
  CHECK(place.text("chart/clicks.csv") ==
        "one: 2 objects,iou,reached_90\n1,0.5," + third + "\n2,0.625," + third +
            "\n\n\ntwo: 1 object,iou,reached_90\n1,0.5,0\n2,1,1\n\n\nall: 3 objects,iou,reached_90\n" +
            "1,0.5,0.25\n2,0.75,0.5\n");
  CHECK(result.out.find("| one | 2 | 0.500 | 0.625 | 1.5 | 15.2 |\n") != std::string::npos);
  CHECK(result.out.find("| all | 3 | 0.500 | 0.750 | 1.5 | 10.8 |\n") != std::string::npos);
  CHECK(place.text("chart/clicks.svg").find("all: 3 objects") != std::string::npos);
  CHECK(place.exists("chart/clicks.png"));

  place.write("longer/eval.json", json{{"scenes", {object({{0.5, 0.6, 0.7}}, 20)}}}.dump());
  place.write("without.json", json{{"scenes", {{{"name", "apple"}}}}}.dump());
  place.write("none.json", json{{"scenes", json::array()}}.dump());
  for (const auto& [given, said] : {std::pair{"one/eval.json longer/eval.json", "3 clicks beside one of 2"},
                                    {"without.json", "no eval.json of eval --any-view"},
                                    {"none.json", "no session of the any-view robot"}}) {
    const Result refused = place.run(std::string("click-chart ") + given + " -o refused");
    CHECK(refused.code == 1);
    CHECK_MESSAGE(refused.err.find(said) != std::string::npos, refused.err);
  }
  CHECK_FALSE(place.exists("refused"));
}
