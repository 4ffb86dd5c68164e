// cut --edges: what is written of an object.
#include <doctest/doctest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "small_still_life.h"

using namespace splatcut::testing;
using nlohmann::json;

namespace {

// The rows of a binary .ply, one after the other.
std::string rows_of(const std::string& ply) {
  const std::string end = "end_header\n";
  return ply.substr(ply.find(end) + end.size());
}

}  // namespace

TEST_CASE("cut --edges keep writes the rows of object and rest byte for byte") {
  const StillLife& life = still_life();
  const Workplace& place = life.place;
  REQUIRE(place.run(life.cut("--click " + life.click + " --edges keep -o edges_kept")).code == 0);
  const std::string labels = place.text("edges_kept/labels.u8"), rows = rows_of(place.text("made/small.ply"));
  const std::size_t row_bytes = rows.size() / labels.size();
  std::string object, rest;
  for (std::size_t row = 0; row < labels.size(); ++row)
    (labels[row] ? object : rest) += rows.substr(row * row_bytes, row_bytes);
  CHECK(rows_of(place.text("edges_kept/object.ply")) == object);
  CHECK(rows_of(place.text("edges_kept/rest.ply")) == rest);
  const json edges = json::parse(place.text("edges_kept/report.json"))["edges"];
  CHECK(edges["edges"] == "keep");
  CHECK_FALSE(edges.contains("why_kept"));
}

TEST_CASE("cut makes edges clean, says what it did, and does not change labels") {
  const StillLife& life = still_life();
  const Workplace& place = life.place;
  const std::string click = "--click " + life.click_on("mug");
  REQUIRE(place.run(life.cut(click + " -o edges_clean")).code == 0);
  REQUIRE(place.run(life.cut(click + " --edges keep -o edges_as_they_are")).code == 0);
  const json report = json::parse(place.text("edges_clean/report.json")), edges = report["edges"];
  REQUIRE(edges["edges"] == "clean");
  CHECK(has_keys(edges, {"views", "agreed", "used", "ms", "left", "split", "made_solid", "recoloured"}));
  const std::size_t written = json::parse(place.run("info edges_clean/object.ply --json").out)["gaussians"];
  CHECK(edges["gaussians"] == written);
  CHECK(report["object"]["gaussians"] == written + edges["left"].get<std::size_t>());
  CHECK(edges["recoloured"] > 0);
  for (const char* same : {"labels.u8", "tint.png", "masks.png"})
    CHECK(place.text(std::string("edges_clean/") + same) ==
          place.text(std::string("edges_as_they_are/") + same));
  CHECK(place.text("edges_clean/object.ply") != place.text("edges_as_they_are/object.ply"));
}

TEST_CASE("cut: of columns that only the scene has, clean edges leave none, and every way says so") {
  const StillLife& life = still_life();
  const Workplace& place = life.place;
  const std::string scene = place.text("made/small.ply"), rows = rows_of(scene),
                    header = scene.substr(0, scene.size() - rows.size());
  const std::size_t row_bytes = rows.size() / 20000;
  std::string own = header;
  own.insert(own.find("end_header"), "property float trust\n");
  for (std::size_t at = 0; at < rows.size(); at += row_bytes)
    own += rows.substr(at, row_bytes) + std::string(4, '\1');
  place.write("own.ply", own);
  const std::string click = "--camera 0 --click " + life.click_on("mug");
  const char* const lost = "the property \"trust\" is left out";
  const Result cleaned = place.run("cut own.ply " + life.cameras + " " + click + " -o own_clean");
  REQUIRE(cleaned.code == 0);
  const json report = json::parse(place.text("own_clean/report.json"));
  REQUIRE(report["edges"]["edges"] == "clean");
  CHECK(report["lost"] == json{{"object.ply", lost}});
  CHECK_MESSAGE(cleaned.err.find("object.ply: " + std::string(lost)) != std::string::npos, cleaned.err);
  const Result kept = place.run("cut own.ply " + life.cameras + " " + click + " --edges keep -o own_kept");
  REQUIRE(kept.code == 0);
  CHECK_FALSE(json::parse(place.text("own_kept/report.json")).contains("lost"));
  CHECK(kept.err.find("trust") == std::string::npos);
  place.write("own.jsonl", json{{"name", "mug"},
                                {"scene", "own.ply"},
                                {"cameras", "made/cameras.json"},
                                {"camera", 0},
                                {"click", life.click_on("mug")}}
                               .dump());
  REQUIRE(place.run("batch own.jsonl -o own_batch").code == 0);
  const json result = json::parse(place.text("own_batch/mug/result.json"));
  CHECK(result["warnings"] == json::array({"object.ply: " + std::string(lost)}));
}

TEST_CASE(
    "cut: ghosts leave the rest with the object, other rows stay byte for byte, what is given back follows") {
  const StillLife& life = still_life();
  const Workplace& place = life.place;
  REQUIRE(place.run("make-scene hard -o hard --gaussians 20000 --straddling --skirts").code == 0);
  const json seeds = json::parse(place.text("hard/seeds.json"));
  std::size_t changed = 0;
  for (const json& thing : seeds["objects"]) {
    const std::string name = thing["object"];
    if (name != "orange" && name != "mug" && name != "apple") continue;
    const json& at = thing["clicks"][0];
    REQUIRE(place
                .run("cut " + (place / "hard/hard.ply").string() + " --cameras " +
                     (place / "hard/cameras.json").string() + " --camera 0 --click " + at["x"].dump() + "," +
                     at["y"].dump() + " -o hard_" + name)
                .code == 0);
    const json edges = json::parse(place.text("hard_" + name + "/report.json"))["edges"];
    if (edges["edges"] != "clean") continue;
    const std::string labels = place.text("hard_" + name + "/labels.u8"),
                      rows = rows_of(place.text("hard/hard.ply")),
                      rest = rows_of(place.text("hard_" + name + "/rest.ply"));
    const std::size_t row_bytes = rows.size() / labels.size(), ghosts = edges["ghosts"],
                      back = edges["given_back"],
                      unlabelled = static_cast<std::size_t>(std::ranges::count(labels, '\0'));
    changed += ghosts + back;
    REQUIRE(rest.size() == row_bytes * (unlabelled - ghosts + back));
    std::size_t found = 0;
    for (std::size_t row = 0; row < labels.size() && found < unlabelled - ghosts; ++row)
      if (!labels[row] && rest.compare(found * row_bytes, row_bytes, rows, row * row_bytes, row_bytes) == 0)
        ++found;
    CHECK(found == unlabelled - ghosts);
  }
  CHECK(changed > 0);
}

TEST_CASE("cut --edges: the same bytes on one thread and on three, and a wrong word is refused") {
  const StillLife& life = still_life();
  const Workplace& place = life.place;
  const std::string click = "--click " + life.click_on("mug");
  for (const char* threads : {"1", "3"})
    REQUIRE(place.run(life.cut(click + " --threads " + threads + " -o edges_on_" + threads)).code == 0);
  CHECK(place.text("edges_on_1/object.ply") == place.text("edges_on_3/object.ply"));
  CHECK(place.text("edges_on_1/rest.ply") == place.text("edges_on_3/rest.ply"));
  CHECK(place.text("edges_on_1/object.png") == place.text("edges_on_3/object.png"));
  CHECK(place.run(life.cut(click + " --edges sharp -o edges_wrong")).code == 1);
}

TEST_CASE("cut --fill surface: the rest ends with what is invented, other rows stay byte for byte") {
  const StillLife& life = still_life();
  const Workplace& place = life.place;
  const std::string cut = "--click " + life.click_on("mug") + " --edges keep --overwrite -o ";
  REQUIRE(place.run(life.cut(cut + "hole")).code == 0);
  REQUIRE(place.run(life.cut(cut + "filled --fill surface --write rest,labels,fill")).code == 0);
  const json report = json::parse(place.text("filled/report.json")), fill = report["edges"]["fill"];
  CHECK_FALSE(json::parse(place.text("hole/report.json"))["edges"].contains("fill"));
  REQUIRE(fill["filled"] == true);
  const std::size_t invented = fill["invented"], replaced = fill["replaced"];
  CHECK(invented > 0);
  CHECK(has_keys(fill, {"pieces", "area", "rim_error"}));
  const std::string hole = rows_of(place.text("hole/rest.ply")),
                    rest = rows_of(place.text("filled/rest.ply"));
  const std::size_t row_bytes = rows_of(place.text("made/small.ply")).size() / 20000,
                    rows = rest.size() / row_bytes;
  CHECK(rows == hole.size() / row_bytes - replaced + invented);
  std::size_t next = 0;  // of the rest as it was
  for (std::size_t row = 0; row + invented < rows; ++row, next += row_bytes) {
    const std::string stays = rest.substr(row * row_bytes, row_bytes);
    while (next < hole.size() && hole.compare(next, row_bytes, stays) != 0) next += row_bytes;
    REQUIRE(next < hole.size());
  }
  CHECK(place.text("filled/labels.u8") == place.text("hole/labels.u8"));
  const Result again = place.run("info filled/rest.ply --json");
  CHECK(json::parse(again.out)["gaussians"] == rows);
  // What is invented stands in a file of its own, too.
  const std::string alone = rows_of(place.text("filled/fill.ply"));
  REQUIRE(alone.size() % invented == 0);
  const auto places = [&](const std::string& bytes, std::size_t row, std::size_t stride) {
    std::multiset<std::string> all;
    for (; row * stride < bytes.size(); ++row) all.insert(bytes.substr(row * stride, 3 * sizeof(float)));
    return all;
  };
  CHECK(places(alone, 0, alone.size() / invented) == places(rest, rows - invented, row_bytes));
  CHECK_FALSE(place.exists("hole/fill.ply"));
}

TEST_CASE(
    "every cut reports from which sides its object was never seen, and what share of its surface that is") {
  const StillLife& life = still_life();
  const Workplace& place = life.place;
  const auto cut =
      place.run(life.cut("--click " + life.click + " --edges keep --write labels -o never_seen"));
  REQUIRE(cut.code == 0);
  const json seen = json::parse(place.text("never_seen/report.json"))["edges"]["seen"];
  CHECK(seen["never_from"] == json::array({"below"}));
  CHECK(seen["unseen_share"] > 0.15);
  CHECK(seen["unseen_share"] < 0.4);
  CHECK(seen["sides"].size() == 6);
  CHECK_FALSE(seen.contains("views"));
  CHECK(cut.out.find("never seen from below") != std::string::npos);
}
