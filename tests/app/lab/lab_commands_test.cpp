// splatcut-lab run in folders of its own: eval's measures and study's charts.
#include <doctest/doctest.h>

#include <nlohmann/json.hpp>

#include "program_runner.h"
#include "small_still_life.h"

using namespace splatcut::testing;
using nlohmann::json;

TEST_CASE("eval reports every measure of a suite with truth labels") {
  StillLife& life = still_life();
  Workplace& place = life.place;
  const std::string truth = place.text("made/small.labels.u8");
  const json names = json::parse(place.text("made/seeds.json"))["labels"];
  const auto apple = static_cast<char>(std::find(names.begin(), names.end(), "apple") - names.begin());
  std::string apple_only = truth;
  for (char& label : apple_only) label = label == apple ? '\1' : '\0';
  place.write("made/apple.labels.u8", apple_only);
  const json view = {{"position", {0.3, -1.2, -2.4}},
                     {"target", {0.3, -0.2, 0}},
                     {"up", {0, -1, 0}},
                     {"fov_y_deg", 45},
                     {"size", {240, 180}}};
  json entry = {{"name", "apple"},
                {"scene", "small.ply"},
                {"cameras", "cameras.json"},
                {"truth", {{"labels", "apple.labels.u8"}}},
                {"reference", {{"camera", "view_00"}}},
                {"clicks", "robot"},
                {"test_views", {view}}};
  place.write("made/suite.json", json{{"scenes", {entry}}}.dump());
  const Result result = place.run("eval made/suite.json --draws 2 -o measured");
  REQUIRE_MESSAGE(result.code == 0, result.err);
  CHECK(result.out.find("median / least of 2 draws") != std::string::npos);
  CHECK(result.out.find("apple") != std::string::npos);
  const json measured = json::parse(place.text("measured/eval.json"));
  REQUIRE(measured["scenes"].size() == 1);
  const json& scene = measured["scenes"][0];
  for (const json& scores : {scene, measured["mean"]}) {
    CHECK(has_keys(scores,
                   {"name", "image_iou", "accuracy", "boundary_iou", "gaussian_iou", "mask_iou_after_clicks",
                    "image_iou_after_clicks", "noc85", "noc90", "ms", "total_ms"}));
    CHECK(has_keys(scores["image_iou_after_clicks"], {"1", "3", "5"}));
    CHECK(scores["mask_iou_after_clicks"].size() == 8);
  }
  CHECK(scene["draws"]["median"].size() == 8);
  CHECK(scene["draws"]["least"][7] <= scene["draws"]["median"][7]);
  CHECK(scene["image_iou"].get<double>() > 0.7);
  CHECK(scene["image_iou"].get<double>() <= 1.0);
  CHECK(scene["ms"].contains("cut"));
  CHECK(scene["enough"]["views"] == 1);  // fast looks at the reference alone
  CHECK(scene["enough"]["pixels"].get<int>() > 0);
  CHECK(scene["enough"]["gaussians"].get<int>() > 0);
  CHECK(scene["enough"]["why"] == "no view around the object was asked for");
  CHECK(measured["mean"]["enough"]["views"] == 1);
  CHECK_FALSE(measured["mean"]["enough"].contains("why"));
  CHECK(place.run("eval made/suite.json -o measured").code == 1);

  // A scene known by masks of photographs only has no truth of the reference: such a scene is left out, by
  // name.
  json photographed = entry;
  photographed["name"] = "photographed";
  photographed["truth"] = {{"masks", "photos"}};
  photographed["clicks"] = {{{"x", 10}, {"y", 10}}};
  place.make_folder("made/photos");
  REQUIRE(place.run("render " + life.scene + " --what alpha " + life.camera + " -o view_00.png").code == 0);
  place.write("made/photos/view_00.png", place.text("view_00.png"));
  place.write("made/both.json", json{{"scenes", {photographed, entry}}}.dump());
  const Result truth_given = place.run("eval made/both.json --first-mask truth --masks truth -o from_truth");
  REQUIRE_MESSAGE(truth_given.code == 0, truth_given.err);
  CHECK(truth_given.err.find("photographed: left out") != std::string::npos);
  const json from_truth = json::parse(place.text("from_truth/eval.json"));
  REQUIRE(from_truth["scenes"].size() == 1);
  CHECK(from_truth["scenes"][0]["image_iou"].get<double>() > 0.8);
  place.write("made/photos_only.json", json{{"scenes", {photographed}}}.dump());
  const Result nothing_left = place.run("eval made/photos_only.json --first-mask truth -o nothing");
  CHECK(nothing_left.code == 1);
  CHECK(nothing_left.err.find("no scene of the suite") != std::string::npos);
}

TEST_CASE("eval --masks others scores each view by a cut from the true masks of the others") {
  Workplace& place = still_life().place;
  place.write("made/apple.labels.u8", still_life().truth_of("apple"));
  const auto view = [](double x) {
    return json{{"position", {x, -1.2, -2.4}},
                {"target", {0.3, -0.2, 0}},
                {"up", {0, -1, 0}},
                {"fov_y_deg", 45},
                {"size", {240, 180}}};
  };
  const auto measured = [&](const json& views, const std::string& options) {
    const json entry = {
        {"name", "apple"},        {"scene", "small.ply"}, {"truth", {{"labels", "apple.labels.u8"}}},
        {"reference", view(0.3)}, {"clicks", "robot"},    {"test_views", views}};
    place.write("made/others.json", json{{"scenes", {entry}}}.dump());
    return place.run("eval made/others.json --masks others --overwrite -o others " + options);
  };
  const json two = {view(-0.6), view(1.2)}, three = {view(-0.6), view(0.3), view(1.2)};
  REQUIRE(measured(three, "").code == 0);
  const json all = json::parse(place.text("others/eval.json"));
  CHECK(all["clicks"] == 0);
  CHECK(all["scenes"][0]["image_iou"].get<double>() > 0.95);
  CHECK(all["scenes"][0]["enough"]["why"] == "all 2 given masks");
  REQUIRE(measured(two, "").code == 0);
  const json of_two = json::parse(place.text("others/eval.json"));
  CHECK(of_two["scenes"][0]["image_iou"].get<double>() > 0.8);

  const Result one = measured(json::array({view(0.3)}), "");
  CHECK(one.code == 1);
  CHECK(one.err.find("apple: left out") != std::string::npos);
  for (const char* other : {"--clicks 3", "--first-mask truth", "--draws 2", "--parts-only"})
    CHECK_MESSAGE(measured(three, other).code == 2, other);
}

TEST_CASE("scribbles of a suite are an answer of their own, beside clicks or alone") {
  StillLife& life = still_life();
  Workplace& place = life.place;
  json entry;
  const json suite = json::parse(place.text("made/suite.json"));
  for (const json& e : suite["scenes"])
    if (e["name"] == "apple") entry = e;
  REQUIRE(entry.is_object());
  const auto comma = life.click.find(',');
  const int x = std::stoi(life.click.substr(0, comma)), y = std::stoi(life.click.substr(comma + 1));
  const auto line = [](int x0, int y0, int x1, int y1) {
    return json::array({{{"label", "object"}, {"radius_px", 4}, {"points", {{x0, y0}, {x1, y1}}}}});
  };
  entry["test_views"] = json::array({entry["test_views"][0]});
  const auto measured = [&](const json& e, const std::string& name) {
    place.write("made/" + name + ".json", json{{"scenes", {e}}}.dump());
    const Result result = place.run("eval made/" + name + ".json --no-curve -o " + name);
    REQUIRE_MESSAGE(result.code == 0, result.err);
    return json::parse(place.text(name + "/eval.json"))["scenes"][0];
  };
  CHECK(measured(entry, "robot_only")["image_iou_by_scribbles"].is_null());
  json both = entry;
  both["scribbles"] = line(x - 10, y, x + 10, y);
  const json of_both = measured(both, "robot_and_scribbles");
  CHECK(of_both["mask_iou_after_clicks"].size() == 3);
  json alone = both;
  alone.erase("clicks");
  const json of_alone = measured(alone, "scribbles_alone");
  CHECK(of_alone["mask_iou_after_clicks"].empty());
  CHECK(of_alone["image_iou"] == of_alone["image_iou_by_scribbles"]);
  CHECK(of_alone["image_iou"] == of_both["image_iou_by_scribbles"]);
  CHECK(of_alone["image_iou"].get<double>() > 0.4);  // a part of it, as the hierarchy has it
  alone["clicks"] = json::array();
  CHECK(measured(alone, "no_clicks")["image_iou"] == of_alone["image_iou"]);
  alone["scribbles"] = line(5, 5, 25, 5);  // a corner: not the apple
  CHECK(measured(alone, "corner")["image_iou"].get<double>() < 0.2);
  alone.erase("scribbles");
  place.write("made/neither.json", json{{"scenes", {alone}}}.dump());
  const Result neither = place.run("eval made/neither.json -o neither");
  CHECK(neither.code == 1);
  CHECK(neither.err.find("neither clicks nor scribbles") != std::string::npos);
}

TEST_CASE("study measures, goes on where it was stopped, heals a line cut off, and draws charts and a page") {
  StillLife& life = still_life();
  Workplace& place = life.place;
  const std::string command =
      "study made/suite.json -o studied --quick --draws 2 --cells 3 --only needed --only views --only "
      "trade-off";
  const Result stopped = place.run_interrupted(command, 1500);
  CHECK((stopped.code == 1 || stopped.signal == SIGINT || stopped.code == 0));
  if (stopped.code == 1) CHECK(stopped.err.find("goes on") != std::string::npos);
  const Result done = place.run(command);
  REQUIRE_MESSAGE(done.code == 0, done.err);
  const std::string cells = place.text("studied/cells.jsonl");
  for (const char* file :
       {"results.csv", "results.json", "study.md", "charts/views.svg", "charts/views.csv",
        "charts/trade_off.svg", "charts/stages.png", "charts/views.png", "charts/needed_width.svg"})
    CHECK_MESSAGE(place.exists(std::string("studied/") + file), file);
  CHECK(place.text("studied/study.md").find("](charts/views.svg)") != std::string::npos);
  const json results = json::parse(place.text("studied/results.json"));
  const auto lines = static_cast<std::size_t>(std::count(cells.begin(), cells.end(), '\n'));
  CHECK(results["results"].size() == lines);
  const std::string csv = place.text("studied/results.csv");
  CHECK(static_cast<std::size_t>(std::count(csv.begin(), csv.end(), '\n')) == lines + 1);
  for (const json& r : results["results"]) {
    CHECK(r["image_iou"].get<double>() >= 0);
    CHECK(r["image_iou"].get<double>() <= 1);
    CHECK(r["cpu_ms"].get<double>() >= 0);
  }
  REQUIRE(place.run(command + " --no-charts").code == 0);
  CHECK(place.text("studied/cells.jsonl") == cells);  // nothing was left to measure
  place.write("studied/cells.jsonl", cells.substr(0, cells.size() - 20));
  REQUIRE(place.run(command + " --no-charts").code == 0);
  const std::string healed = place.text("studied/cells.jsonl");
  CHECK(static_cast<std::size_t>(std::count(healed.begin(), healed.end(), '\n')) == lines);
  place.write("studied/cells.jsonl", "no measurement\n");
  const Result foreign = place.run(command);
  CHECK(foreign.code == 1);
  CHECK(foreign.err.find("is not a list of measurements") != std::string::npos);
  CHECK(place.run("study made/suite.json -o other --only nonsense").code == 1);
}
