// Command lines that would do something else than they say: each is refused, or said.
#include <doctest/doctest.h>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "app/console/user_folders.h"
#include "core/png_file.h"
#include "cut_program.h"

using namespace splatcut::testing;
using nlohmann::json;

namespace {

std::string cut_of_scene(const std::string& options) {
  return "cut " + still_life().scene + " " + still_life().camera + " " + options;
}

}  // namespace

TEST_CASE("a scene behind --click or --box is the scene") {
  const StillLife& life = still_life();
  const Result result =
      life.place.run("cut " + life.camera + " --edges keep --write labels -o behind --click " +
                     life.click_on("apple") + " " + life.scene);
  CHECK_MESSAGE(result.code == 0, result.err);
  refused("cut " + life.camera + " --box 9,9,9,9 " + life.scene, {}, {"box"});
  refused(cut_of_scene("--click [670,490]"), {}, {"--click [670,490]", "is not a pixel"});
}

TEST_CASE("an empty value is refused: a variable of a script may be without one") {
  for (const char* option : {"--cameras", "--camera", "--size", "--camera-pos", "--spz-axes"})
    refused("render " + still_life().scene, {option, ""}, {option, "is empty"});
  for (const char* option : {"--seeds", "--scale-by", "--click", "--mask", "--masks", "--preset", "--text"})
    refused(cut_of_scene(""), {option, ""}, {option, "is empty"});
  refused("render " + still_life().scene + " --cameras=", {}, {"--cameras", "is empty"});
  refused("render", {""}, {"is empty"});
}

TEST_CASE("a misspelt field of seeds is refused, with the one that is nearest") {
  const Workplace& place = still_life().place;
  const auto says = [&](const json& seeds, std::initializer_list<const char*> parts) {
    place.write("misspelt.json", seeds.dump());
    refused(cut_of_scene("--seeds misspelt.json"), {}, parts);
  };
  const json click = {{"x", 9}, {"y", 9}};
  says({{"click", {click}}}, {"it has no field \"click\"", "\"clicks\" is one"});
  says({{"clicks", {{{"x", 9}, {"y", 9}, {"lable", "rest"}}}}},
       {"a click has no field \"lable\"", "\"label\""});
  says({{"clicks", {click}}, {"boxes", {{{"corner", 1}}}}}, {"a box has no field \"corner\"", "\"corners\""});
  says({{"scribbles", {{{"points", json::array()}, {"width", 3}}}}},
       {"a scribble", "\"width\"", "radius_px"});
  says({{"objects", {{{"name", "a"}, {"clicks", {click}}, {"choise", 2}}}}},
       {"object 0", "\"choise\"", "\"choice\""});
  says({{"objects", {{{"name", "a"}}}}}, {"holds neither clicks nor boxes nor scribbles"});
}

TEST_CASE("a report names the files that were written, and no others") {
  const Workplace& place = still_life().place;
  json objects = json::array();
  for (const char* thing : {"apple", "mug"}) {
    const std::string at = still_life().click_on(thing);
    const auto comma = at.find(',');
    objects.push_back(
        {{"name", thing},
         {"clicks", {{{"x", std::stoi(at.substr(0, comma))}, {"y", std::stoi(at.substr(comma + 1))}}}}});
  }
  objects[0]["name"] =
      "R\xc3\xbc"
      "be 1/2";
  place.write("pair.json", json{{"objects", objects}}.dump());
  const std::string cut =
      "cut " + still_life().scene + " " + still_life().cameras + " --seeds pair.json --edges keep";
  const Result labels = place.run(cut + " --write labels -o labels_alone");
  REQUIRE_MESSAGE(labels.code == 0, labels.err);
  CHECK(labels.out.find(".ply") == std::string::npos);
  CHECK(place.files_in("labels_alone") == std::set<std::string>{"R\xc3\xbc"
                                                                "be_1_2.labels.u8",
                                                                "mug.labels.u8", "labels.u8", "report.json"});
  for (const json& object : json::parse(place.text("labels_alone/report.json"))["objects"]) {
    CHECK_FALSE(object.contains("file"));
    CHECK(place.exists("labels_alone/" + object["labels"].get<std::string>()));
  }
}

TEST_CASE("names of other letters are those of files, and two of them are two") {
  const Workplace& place = still_life().place;
  const std::string at = still_life().click_on("apple"), x = at.substr(0, at.find(',')),
                    y = at.substr(at.find(',') + 1);
  const auto named = [&](const std::string& name) {
    return R"({"name": ")" + name + R"(", "clicks": [{"x": )" + x + R"(, "y": )" + y + "}]}";
  };
  const std::string red = "\xe7\xba\xa2", blue = "\xe8\x93\x9d";  // one letter each
  place.write("letters.json", R"({"objects": [)" + named(red) + ", " + named(blue) + "]}");
  refused(cut_of_scene("--seeds letters.json"), {},
          {"objects after it"});  // both are the apple: no name is taken
  place.write("jobs.jsonl", json{{"name", red}, {"scene", "a"}, {"click", "1,1"}}.dump() + "\n" +
                                json{{"name", blue}, {"scene", "a"}, {"click", "1,1"}}.dump() + "\n");
  const Result batch = place.run("batch jobs.jsonl -o letters_of_jobs --json");
  CHECK(batch.err.find("is that of line") == std::string::npos);
  CHECK(batch.out.find("is that of line") == std::string::npos);
}

TEST_CASE("options that would be without effect are refused") {
  const StillLife& life = still_life();
  refused("render " + life.scene + " " + life.cameras + " --camera-up 0,1,0", {}, {"--camera-up"}, 2);
  refused(cut_of_scene("--click 9,9 --coarse --smoothness 3"), {}, {"--smoothness"}, 2);
  for (const char* placing : {"--origin foot", "--up +y", "--scale-by 9,9,99,99,1"})
    refused(cut_of_scene("--click 9,9 --write labels " + std::string(placing)), {},
            {"--write names no file"});
}

TEST_CASE("a picture that no memory holds is refused with the figure") {
  const StillLife& life = still_life();
  json cameras = json::parse(life.place.text(life.cameras.substr(life.cameras.find(' ') + 1)));
  cameras[0]["width"] = cameras[0]["height"] = 131072;
  life.place.write("vast.json", json::array({cameras[0]}).dump());
  for (const char* command : {"render ", "cut --click 9,9 "})
    refused(command + life.scene + " --cameras vast.json", {}, {"131072 x 131072", "GB are free", "--size"});
}

TEST_CASE("a camera whose name holds a NUL is no name of a file") {
  const StillLife& life = still_life();
  json cameras = json::parse(life.place.text(life.cameras.substr(life.cameras.find(' ') + 1)));
  cameras[0]["img_name"] = std::string("a\0b", 3);
  life.place.write("nul.json", json::array({cameras[0]}).dump());
  refused("render " + life.scene + " --cameras nul.json --all-cameras --size 32x24", {},
          {"has no name for a file"});
}

TEST_CASE("a picture into a pipe is the picture alone") {
  const StillLife& life = still_life();
  life.place.write("pipe.sh", splatcut_program() + " render " + life.scene + " " + life.camera +
                                  " --size 32x24 -o /dev/stdout | cat > piped.png\n");
  const Result result = life.place.run_program("/bin/bash", "pipe.sh");
  CHECK(life.place.text("piped.png").ends_with(std::string("IEND\xae\x42\x60\x82")));
  CHECK(result.err.find("/dev/stdout") != std::string::npos);
}

TEST_CASE("compare sees alpha and 16 bits") {
  const Workplace& place = still_life().place;
  using splatcut::Image, splatcut::Rgba8, splatcut::write_png;
  write_png(place / "clear.png", Image<Rgba8>(4, 4));
  write_png(place / "black4.png", Image<Rgba8>(4, 4, {0, 0, 0, 255}));
  Image<std::uint16_t> grey(4, 4, 30000);
  write_png(place / "grey_a.png", grey);
  grey.at(1, 2) = 30040;
  write_png(place / "grey_b.png", grey);
  CHECK(place.run("compare clear.png black4.png").code == 1);
  CHECK(place.run("compare grey_a.png grey_b.png").code == 1);
  CHECK(place.run("compare grey_a.png grey_b.png --max-diff 1").code == 0);
  for (const char* same : {"clear.png", "black4.png", "grey_a.png"})
    CHECK(place.run("compare " + std::string(same) + " " + same).code == 0);
}

TEST_CASE("object_id where objects are to be numbered is refused before the cut") {
  const StillLife& life = still_life();
  REQUIRE(life.place
              .run(cut_of_scene("--edges keep --write objects -o numbered --click " + life.click_on("apple")))
              .code == 0);
  refused("cut numbered/objects.ply " + life.camera + " --write objects --click 0,0", {},
          {"object_id already"});
}

TEST_CASE("without HOME nothing is kept in a folder of all") {
  const std::string home = std::getenv("HOME") ? std::getenv("HOME") : "";
  const std::string cache = std::getenv("XDG_CACHE_HOME") ? std::getenv("XDG_CACHE_HOME") : "";
  ::unsetenv("HOME");
  ::unsetenv("XDG_CACHE_HOME");
  const std::string folder = splatcut::cache_folder();
  if (!home.empty()) ::setenv("HOME", home.c_str(), 1);
  if (!cache.empty()) ::setenv("XDG_CACHE_HOME", cache.c_str(), 1);
  CHECK_MESSAGE(!folder.starts_with("/tmp"), folder);
}
