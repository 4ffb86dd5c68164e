// A file of seeds says which objects are meant, one or several.
#include <doctest/doctest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "cut_program.h"

using namespace splatcut::testing;
using nlohmann::json;

namespace {

json one_click(const std::string& thing) {
  const std::string at = still_life().click_on(thing);
  const auto comma = at.find(',');
  return json::array({json{{"x", std::stoi(at.substr(0, comma))}, {"y", std::stoi(at.substr(comma + 1))}}});
}

}  // namespace

TEST_CASE(
    "several objects: each is what it is alone, less what later ones claim, and everything lies in one "
    "file") {
  const Workplace& place = still_life().place;
  for (const char* thing : {"apple", "mug"})
    REQUIRE(place
                .run(still_life().cut("--click " + still_life().click_on(thing) + " --edges keep -o alone_" +
                                      thing))
                .code == 0);
  const std::string apple = place.text("alone_apple/labels.u8"), mug = place.text("alone_mug/labels.u8");
  // The second claims what the first does; the third has a camera of its own.
  place.write("three.json", json{{"objects",
                                  {{{"name", "red apple"}, {"clicks", one_click("apple")}},
                                   {{"object", "mug"}, {"camera", 0}, {"clicks", one_click("mug")}},
                                   {{"name", "again"}, {"camera", "view_00"}, {"clicks", one_click("mug")}}}}}
                                .dump());
  refused(still_life().cut("--seeds three.json"), {}, {"\"mug\"", "objects after it"});
  place.write("two.json", json{{"objects",
                                {{{"name", "red apple"}, {"clicks", one_click("apple")}},
                                 {{"object", "mug"}, {"camera", "view_00"}, {"clicks", one_click("mug")}}}}}
                              .dump());
  const Result result = place.run("cut " + still_life().scene + " " + still_life().cameras +
                                  " --seeds two.json --edges keep --json -o both");
  REQUIRE_MESSAGE(result.code == 0, result.err);
  CHECK(place.files_in("both") ==
        std::set<std::string>{"labels.u8", "mug.labels.u8", "mug.masks.png", "mug.ply", "mug.png",
                              "mug.tint.png", "red_apple.labels.u8", "red_apple.masks.png", "red_apple.ply",
                              "red_apple.png", "red_apple.tint.png", "report.json", "rest.ply", "rest.png"});
  std::string owner(20000, '\0'), first = apple;
  for (std::size_t g = 0; g < owner.size(); ++g) owner[g] = mug[g] ? '\2' : apple[g] ? '\1' : '\0';
  for (std::size_t g = 0; g < owner.size(); ++g) first[g] = owner[g] == '\1';
  CHECK(place.text("both/labels.u8") == owner);
  CHECK(place.text("both/mug.labels.u8") == mug);
  CHECK(place.text("both/red_apple.labels.u8") == first);
  CHECK(place.text("both/mug.ply") == place.text("alone_mug/object.ply"));
  CHECK(place.text("both/mug.tint.png") == place.text("alone_mug/tint.png"));
  const json report = json::parse(result.out);
  REQUIRE(report["objects"].size() == 2);
  std::size_t in_files = json::parse(place.run("info both/rest.ply --json").out)["gaussians"];
  CHECK(report["rest"]["gaussians"] == in_files);
  for (const json& object : report["objects"]) {
    const std::size_t gaussians =
        json::parse(place.run("info both/" + object["file"].get<std::string>() + " --json").out)["gaussians"];
    CHECK(object["gaussians"] == gaussians);
    CHECK(object["camera"] == "view_00");
    CHECK(object["views"].size() >= 1);
    in_files += gaussians;
  }
  CHECK(in_files == 20000);
  CHECK(report["objects"][0]["name"] == "red apple");
  CHECK(report["objects"][0]["index"] == 1);
  CHECK(report["objects"][0]["left_to_later"] ==
        std::count(apple.begin(), apple.end(), '\1') - std::count(first.begin(), first.end(), '\1'));
  CHECK(report["stages"][0]["name"] == "load");
  for (const json& object : report["objects"]) {  // each prepares what is around it, once
    int prepared = 0;
    for (const json& stage : object["stages"]) prepared += stage["name"] == "parts";
    CHECK(prepared <= 1);
  }
}

TEST_CASE("what is claimed by two is the later one's") {
  const Workplace& place = still_life().place;
  // Two clicks, so the first is both things; the second takes its own back.
  json both = one_click("apple");
  both.push_back(one_click("mug")[0]);
  place.write("overlap.json",
              json{{"objects",
                    {{{"name", "both"}, {"clicks", both}}, {{"name", "mug"}, {"clicks", one_click("mug")}}}}}
                  .dump());
  const Result result = place.run(still_life().cut("--seeds overlap.json --json -o overlap"));
  REQUIRE_MESSAGE(result.code == 0, result.err);
  const std::string mug = place.text("overlap/mug.labels.u8"), owner = place.text("overlap/labels.u8"),
                    first = place.text("overlap/both.labels.u8");
  const json report = json::parse(result.out);
  CHECK(report["objects"][0]["left_to_later"].get<int>() > 100);
  CHECK(iou(mug, still_life().truth_of("mug")) > 0.7);
  const std::string apple = still_life().truth_of("apple");
  std::size_t kept = 0;
  for (std::size_t g = 0; g < apple.size(); ++g) kept += apple[g] && first[g];
  CHECK(10 * kept > 9 * static_cast<std::size_t>(std::count(apple.begin(), apple.end(), '\1')));
  for (std::size_t g = 0; g < owner.size(); ++g) {
    if ((owner[g] == '\2') == (mug[g] == '\1') && (owner[g] == '\1') == (first[g] == '\1')) continue;
    FAIL("row ", g);
  }
}

TEST_CASE("a choice in the seeds takes another meaning of the first click") {
  const Workplace& place = still_life().place;
  const auto labels = [&](const json& seeds, const std::string& file) {
    place.write("choice.json", seeds.dump());
    const Result result =
        place.run(still_life().cut("--seeds choice.json --parts-only --write labels --overwrite -o chosen"));
    REQUIRE_MESSAGE(result.code == 0, result.err);
    return place.text("chosen/" + file);
  };
  int others = 0;
  for (const char* thing : {"mug", "books", "plant", "pot"}) {
    const json clicks = one_click(thing);
    const std::string likeliest = labels({{"clicks", clicks}}, "labels.u8");
    CHECK(labels({{"clicks", clicks}, {"choice", 1}}, "labels.u8") == likeliest);
    const std::string second = labels({{"clicks", clicks}, {"choice", 2}}, "labels.u8");
    others += second != likeliest;
    const json named = {{"objects", json::array({json{{"name", "it"}, {"clicks", clicks}, {"choice", 2}}})}};
    CHECK(labels(named, "it.labels.u8") == second);
  }
  CHECK(others > 0);
}

TEST_CASE("a hole is not filled with a copy of what leaves with its object") {
  const Workplace& place = still_life().place;
  const auto fill_of_mug = [&](const json& others) {
    json objects = others;
    objects.push_back({{"name", "mug"}, {"clicks", one_click("mug")}});
    place.write("leaving.json", json{{"objects", objects}}.dump());
    const Result result = place.run(
        still_life().cut("--seeds leaving.json --edges keep --fill surface --json --overwrite -o leaving"));
    REQUIRE_MESSAGE(result.code == 0, result.err);
    return json::parse(result.out)["objects"].back()["edges"]["fill"];
  };
  CHECK(fill_of_mug(json::array())["filled"] == true);
  const json table = {{"name", "table"}, {"clicks", json::array({json{{"x", 30}, {"y", 500}}})}};
  const json without = fill_of_mug(json::array({table}));
  CHECK_MESSAGE(without["filled"] == false, without.dump());
}

TEST_CASE("seeds may name their camera, of one object or of all") {
  const Workplace& place = still_life().place;
  const auto labels = [&](const std::string& how, const std::string& file) {
    const Result result = place.run("cut " + still_life().scene + " " + still_life().cameras + " " + how +
                                    " --parts-only --write labels --json --overwrite -o named");
    REQUIRE_MESSAGE(result.code == 0, result.err);
    return std::pair(place.text("named/" + file), json::parse(result.out));
  };
  const std::string at = still_life().click_on("mug");
  const auto [asked, said] = labels("--camera view_01 --click " + at, "labels.u8");
  json one = {{"camera", "view_01"}, {"clicks", one_click("mug")}};
  place.write("one.json", one.dump());
  const auto [named, report] = labels("--camera 0 --seeds one.json", "labels.u8");
  CHECK(named == asked);
  // A name that nothing else takes: fill.ply is written where that is asked for.
  place.write("of_fill.json", json{{"objects", {{{"name", "fill"}, {"clicks", one_click("mug")}}}}}.dump());
  CHECK(labels("--camera view_01 --seeds of_fill.json", "fill.labels.u8").first == asked);
  CHECK(report["settings"]["reference"] == "view_01");
  refused(still_life().cut("--seeds one.json --click 9,9"), {}, {"--click", "--seeds names another"});
  refused("cut " + still_life().scene + " " + still_life().cameras +
              " --seeds one.json --camera-pos 0,-1,-3 --camera-target 0,0,0",
          {}, {"--seeds", "--camera-pos another view"});
  one["name"] = "it";
  one.erase("camera");
  json all = {{"camera", 1}, {"objects", json::array({one})}};
  place.write("all.json", all.dump());
  const auto [of_all, objects] = labels("--camera 0 --seeds all.json", "it.labels.u8");
  CHECK(of_all == asked);
  CHECK(objects["objects"][0]["camera"] == "view_01");
  all["choice"] = 2;
  place.write("all.json", all.dump());
  refused(still_life().cut("--seeds all.json"), {}, {"all.json", "\"choice\" stands beside \"objects\""});
}

TEST_CASE("seeds come through a pipe, too, of one object or several") {
  const Workplace& place = still_life().place;
  const json one = {{"clicks", one_click("apple")}, {"choice", 1}};
  json several = {{"objects", json::array({one})}};
  several["objects"][0]["name"] = "apple";
  for (const json& seeds : {one, several}) {
    place.write("seeds.json", seeds.dump());
    place.write("piped.sh",
                "cat seeds.json | " + splatcut_program() + " " +
                    still_life().cut("--seeds /dev/stdin --parts-only --write labels --overwrite -o piped"));
    const Result piped = place.run_program("/bin/sh", "piped.sh");
    REQUIRE_MESSAGE(piped.code == 0, piped.err);
    REQUIRE(
        place.run(still_life().cut("--seeds seeds.json --parts-only --write labels --overwrite -o from_file"))
            .code == 0);
    CHECK(place.text("piped/labels.u8") == place.text("from_file/labels.u8"));
  }
}

TEST_CASE("files of objects that cannot be used are refused") {
  const Workplace& place = still_life().place;
  const json clicks = one_click("apple");
  const auto with = [&](const json& objects, std::initializer_list<const char*> parts,
                        const std::string& more = "") {
    place.write("objects.json", json{{"objects", objects}}.dump());
    refused(still_life().cut("--seeds objects.json" + more), {}, parts);
  };
  const json apple = {{"name", "apple"}, {"clicks", clicks}};
  with(json::array(), {"objects.json", "1 to 255"});
  with(json::array({json{{"clicks", clicks}}}), {"object 0", "name"});
  with({apple, {{"name", "mug"}}}, {"object 1", "neither clicks"});
  with({apple, apple}, {"apple.ply", "taken"});
  with({{{"name", "a b"}, {"clicks", clicks}}, {{"name", "a/b"}, {"clicks", clicks}}}, {"a_b.ply", "taken"});
  with(json::array({json{{"name", "rest"}, {"clicks", clicks}}}), {"rest.ply", "taken"});
  with(json::array({json{{"name", "objects"}, {"clicks", clicks}}}), {"objects.ply", "taken"});
  with(json::array({json{{"name", "fill"}, {"clicks", clicks}}}), {"--write fill", "fill.ply", "\"fill\""},
       " --write rest,fill --fill surface");
  with(json::array({json{{"name", "apple"}, {"camera", "none"}, {"clicks", clicks}}}), {"camera \"none\""});
  with(json::array({json{{"name", "apple"}, {"camera", 1.5}, {"clicks", clicks}}}), {"\"camera\""});
  with(json::array({json{{"name", "apple"}, {"clicks", json::array({json{{"x", 5000}, {"y", 3}}})}}}),
       {"5000", "outside"});
  with(json::array({json{{"name", "apple"}, {"clicks", json::array({json{{"x", "left"}}})}}}),
       {"object 0", "form"});
  with(json::array({json{{"name", "apple"}, {"choice", 4}, {"clicks", clicks}}}), {"object 0", "\"choice\""});
  with(json::array({json{{"name", "apple"}, {"choice", "second"}, {"clicks", clicks}}}), {"from 1 to 3"});
  with(json::array({apple}), {"--click", "in the file"}, " --click 5,5");
  with(json::array({json{{"name", "apple"}, {"clicks", clicks[0]}}}), {"object 0", "form"});
  place.write("objects.json", json{{"objects", {apple}}, {"clicks", clicks}}.dump());
  refused(still_life().cut("--seeds objects.json"), {}, {"objects.json", "beside \"objects\""});
  place.write(
      "objects.json",
      json{{"objects", json::array({json{{"name", "apple"}, {"camera", "view_00"}, {"clicks", clicks}}})}}
          .dump());
  refused("cut " + still_life().scene + " --seeds objects.json", {}, {"\"apple\"", "--cameras"});
}

TEST_CASE("several objects: one file holds them all, each row as it is and with the number of its object") {
  const Workplace& place = still_life().place;
  place.write("pair.json", json{{"objects",
                                 {{{"name", "red apple"}, {"clicks", one_click("apple")}},
                                  {{"name", "mug"}, {"clicks", one_click("mug")}}}}}
                               .dump());
  const std::string cut = " " + still_life().camera + " --seeds pair.json --write labels,objects ";
  REQUIRE(place.run("cut " + still_life().scene + cut + "-o pair").code == 0);
  CHECK(place.files_in("pair") == std::set<std::string>{"labels.u8", "mug.labels.u8", "objects.json",
                                                        "objects.ply", "red_apple.labels.u8", "report.json"});
  CHECK(json::parse(place.text("pair/objects.json")) ==
        json{{"objects", {{{"object_id", 1}, {"name", "red apple"}}, {{"object_id", 2}, {"name", "mug"}}}}});
  const auto rows_of = [](const std::string& file, std::size_t* row_bytes) {
    const std::size_t start = file.find("end_header\n") + 11;
    const std::size_t count = std::stoul(file.substr(file.find("element vertex ") + 15));
    *row_bytes = (file.size() - start) / count;
    return file.substr(start);
  };
  const auto check = [&](const std::string& folder, const std::string& scene) {
    const std::string labels = place.text(folder + "/labels.u8"), file = place.text(folder + "/objects.ply");
    const std::size_t at = file.find("property uchar object_id\nend_header\n");
    REQUIRE(at != std::string::npos);  // last, so that programs that count columns find theirs
    std::size_t bytes = 0, own_bytes = 0, row = 0;
    const std::string rows = rows_of(file, &bytes), all = rows_of(place.text(scene), &own_bytes);
    CHECK(bytes == own_bytes + 1);
    for (std::size_t g = 0; g < labels.size(); ++g) {
      if (labels[g] == '\0') continue;
      REQUIRE(rows.substr(row, own_bytes) == all.substr(g * own_bytes, own_bytes));
      REQUIRE(rows[row + own_bytes] == labels[g]);
      row += bytes;
    }
    CHECK(row == rows.size());
  };
  check("pair", "made/small.ply");
  // From a format whose rows are written anew; `convert` writes the same values.
  REQUIRE(place.run("convert " + still_life().scene + " -o pair.splat").code == 0);
  REQUIRE(place.run("convert pair.splat -o pair_again.ply").code == 0);
  REQUIRE(place.run("cut pair.splat" + cut + "-o pair_anew").code == 0);
  check("pair_anew", "pair_again.ply");
  // The file is a scene; an object of it would be numbered twice.
  CHECK(place.run("info pair/objects.ply").code == 0);
  refused("cut pair/objects.ply" + cut, {}, {"object_id already"});
}
