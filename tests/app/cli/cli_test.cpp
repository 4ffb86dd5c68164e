// The program itself, run in folders of its own: sentences, files, bytes.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <set>

#include "app/console/mask_options.h"
#include "program_runner.h"
#include "scene/formats/scene_file.h"
#include "small_still_life.h"
#include "synthetic_cloud.h"

using namespace splatcut::testing;
using nlohmann::json;

using namespace splatcut;

namespace {

// ball.ply of 300 Gaussians, and labels that take all of it.
void write_ball(const Workplace& place) {
  Scene scene;
  scene.cloud = random_cloud(300, 5, 0, 0.3f);
  for (float& opacity : scene.cloud.opacity) opacity = 0.8f;
  scene.file_rows = scene.cloud.size();
  save_scene(place / "ball.ply", scene, {}, SceneFormat::kPly);
  place.write("all.labels.u8", std::string(300, '\1'));
}

}  // namespace

TEST_CASE("cli: what settles masks of other views asks for such views, unless their number is said") {
  const auto views = [](const char* preset_name, const MaskOptions& options) {
    CutSettings settings = preset(preset_name);
    options.apply(&settings);
    return settings.orbit.views;
  };
  MaskOptions none, refined, warped, both;
  refined.refine = "grabcut";
  warped.propagate = both.propagate = "warp";
  both.views = 3;
  CHECK(views("default", none) == kViewsAsNeeded);
  CHECK(views("default", refined) == kViewsAround);
  CHECK(views("default", warped) == kViewsAround);
  CHECK(views("default", both) == 3);
  CHECK(views("paper", refined) == 40);
}

TEST_CASE("a cut of the whole scene gives it all, a rest without Gaussians and a sentence") {
  const Workplace place;
  write_ball(place);
  const std::string at = " --camera-pos 0,0,-5 --camera-target 0,0,0 --size 96x72";
  REQUIRE(place
              .run("render ball.ply" + at +
                   " --what labels --labels all.labels.u8 --background 1,1,1 -o white.png")
              .code == 0);
  const Result result = place.run("cut ball.ply" + at + " --mask white.png --edges keep -o out");
  REQUIRE_MESSAGE(result.code == 0, result.err);
  CHECK(result.err.find("takes the whole scene") != std::string::npos);
  CHECK(load_scene(place / "out/object.ply").cloud.size() == 300);
  CHECK(place.text("out/rest.ply").find("element vertex 0\n") != std::string::npos);
  CHECK(json::parse(place.text("out/report.json"))["object"]["gaussians"] == 300);
}

TEST_CASE("a mask without a camera is doubted where it has another size than the view, else not") {
  const Workplace place;
  write_ball(place);
  const std::string white = "render ball.ply --what labels --labels all.labels.u8 --background 1,1,1";
  REQUIRE(place.run(white + " -o view.png").code == 0);
  REQUIRE(place.run(white + " --size 144x108 -o other.png").code == 0);
  const std::string at = " --camera-pos 0,0,-5 --camera-target 0,0,0", cut = "cut ball.ply --edges keep";
  struct Case {
    std::string options;
    bool doubted;
  };
  int number = 0;
  for (const Case& c :
       {Case{" --mask other.png", true}, Case{" --mask view.png", false},
        Case{" --mask other.png --size 144x108", false}, Case{" --mask other.png" + at, false}}) {
    CAPTURE(c.options);
    const std::string folder = "cut_" + std::to_string(number++);
    const Result result = place.run(cut + c.options + " -o " + folder);
    REQUIRE_MESSAGE(result.code == 0, result.err);
    const std::string doubt =
        "other.png has 144 x 108 pixels, the view 1008 x 756: it may be of another view. Give the mask's own "
        "with --cameras and --camera";
    CHECK((result.err.find(doubt) != std::string::npos) == c.doubted);
    const json report = json::parse(place.text(folder + "/report.json"));
    CHECK(std::ranges::count(report["doubts"], json(doubt)) == (c.doubted ? 1 : 0));
  }
  place.write("jobs.jsonl", R"({"name": "one", "scene": "ball.ply", "mask": "other.png", "edges": "keep"})");
  REQUIRE(place.run("batch jobs.jsonl -o batch").code == 0);
  CHECK(place.text("batch/one/result.json").find("other.png has 144 x 108 pixels") != std::string::npos);
}

TEST_CASE("cameras that see nothing of the scene are said, those that see some of it are not") {
  const Workplace place;
  Scene scene;
  scene.cloud = random_cloud(50, 5, 0, 0.3f);
  scene.file_rows = scene.cloud.size();
  save_scene(place / "ball.ply", scene, {}, SceneFormat::kPly);
  const auto looking = [&](const std::string& rotation) {
    place.write(
        "cameras.json",
        R"([{"img_name": "a", "width": 96, "height": 72, "fx": 90, "fy": 90, "position": [0, 0, -5], "rotation": )" +
            rotation + "}]");
    const Result result = place.run("render ball.ply --cameras cameras.json -o a.png --overwrite");
    CHECK(result.code == 0);
    return result.err;
  };
  CHECK(looking("[[1, 0, 0], [0, 1, 0], [0, 0, 1]]").empty());
  CHECK(looking("[[-1, 0, 0], [0, 1, 0], [0, 0, -1]]").find("see nothing of the scene") != std::string::npos);
}

TEST_CASE(
    "a scene on a map is cut as it is near 0, 0, 0, by cameras of the map, and its files are on the map") {
  const Workplace place;
  constexpr glm::dvec3 kMap{500000, 100, 4500000};
  Scene scene;
  scene.cloud = random_cloud(300, 5, 0, 0.3f);
  for (float& opacity : scene.cloud.opacity) opacity = 0.8f;
  for (std::size_t g = 0; g < 300; g += 2) scene.cloud.position[g].x += 2;  // two balls beside each other
  scene.file_rows = scene.cloud.size();
  save_scene(place / "near.ply", scene, {}, SceneFormat::kPly);
  Scene far = with_cloud(scene, scene.cloud);
  far.origin = kMap;
  save_scene(place / "far.ply", far, {}, SceneFormat::kPly);
  const auto cut = [&](const std::string& name, const glm::dvec3& middle) {
    const auto at = [&](double z) { return fmt::format("{},{},{}", middle.x + 1, middle.y, middle.z + z); };
    const Result result =
        place.run(fmt::format("cut {0}.ply --camera-pos {1} --camera-target {2} --camera-up 0,-1,0 --size "
                              "96x72 --click 30,36 --edges keep -o {0}",
                              name, at(-5), at(0)));
    REQUIRE_MESSAGE(result.code == 0, result.err);
    return result.err;
  };
  cut("near", {0, 0, 0});
  CHECK(cut("far", kMap).find("is taken off its positions") != std::string::npos);
  CHECK(place.text("far/labels.u8") == place.text("near/labels.u8"));
  CHECK(place.text("far/object.png") == place.text("near/object.png"));
  CHECK(place.text("far/object.ply").find("property double x") != std::string::npos);
  const json report = json::parse(place.text("far/report.json"));
  const glm::dvec3 origin{report["scene"]["origin"][0], report["scene"]["origin"][1],
                          report["scene"]["origin"][2]};
  CHECK(glm::length(origin - kMap) < 2);
  const json info = json::parse(place.run("info --json --quiet far.ply").out);
  CHECK(info["origin"] == report["scene"]["origin"]);
  CHECK(info["bounds_98"]["min"][0].get<double>() > 499998);
  CHECK(place.run("merge far/object.ply far/rest.ply -o all.ply").code == 0);
  CHECK(json::parse(place.run("info --json --quiet all.ply").out)["bounds_98"] == info["bounds_98"]);
}

TEST_CASE("a pixel that is said to be object and rest is said") {
  StillLife& life = still_life();
  const Result result = life.place.run(
      life.cut("--click " + life.click + " --click " + life.click + ":rest --write labels -o contradicts"));
  CHECK(result.err.find("is said to be both object and rest") != std::string::npos);
}

TEST_CASE("a box on the command line is the box of a file of seeds, and cuts what fills it") {
  StillLife& life = still_life();
  const Workplace& place = life.place;
  const auto refused = [&](const std::string& box, const std::string& word) {
    CAPTURE(box);
    const Result result = place.run(life.cut("--box " + box + " -o refused"));
    CHECK(result.code == 1);
    CHECK(result.err.find(word) != std::string::npos);
    CHECK_FALSE(place.exists("refused"));
  };
  refused("1,2,3", "x0,y0,x1,y1");
  refused("1,2,3,4,5", "x0,y0,x1,y1");
  refused("1,2,3,4:sky", "object or rest");
  refused("5,5,7,90", "less than 6 pixels");
  refused("-50,-50,-5,-5", "less than 6 pixels");
  refused("nan,5,90,90", "outside of any picture");
  const Result help = place.run("cut --help");
  CHECK(help.out.find("--box") != std::string::npos);
  int x = 0, y = 0;
  REQUIRE(std::sscanf(life.click.c_str(), "%d,%d", &x, &y) == 2);
  const auto corner = [&](int by) { return std::to_string(x + by) + "," + std::to_string(y + by); };
  const std::string box = corner(-30) + "," + corner(30);
  place.write("box.json",
              R"({"clicks": [], "boxes": [{"corners": [[)" + corner(-30) + "], [" + corner(30) + "]]}]}");
  REQUIRE(place.run(life.cut("--box " + box + " --write labels -o by_box")).code == 0);
  REQUIRE(place.run(life.cut("--seeds box.json --write labels -o by_box_file")).code == 0);
  CHECK(place.text("by_box/labels.u8") == place.text("by_box_file/labels.u8"));
  REQUIRE(place.run(life.cut("--box " + box + " --click " + life.click + ":rest --write labels -o corrected"))
              .code == 0);
  CHECK(place.text("corrected/labels.u8") != place.text("by_box/labels.u8"));
}

TEST_CASE("cut --choice takes the meaning that the key of seeds takes, and says where there are fewer") {
  StillLife& life = still_life();
  const Workplace& place = life.place;
  const std::string sample = project_folder() + "/assets/sample/";
  const auto cut = [&](const std::string& said, const std::string& to) {
    const Result result =
        place.run("cut " + sample + "sample.compressed.ply --cameras " + sample +
                  "cameras.json --camera 0 --parts-only --edges keep --write labels " + said + " -o " + to);
    CHECK(result.code == 0);
    return json::parse(place.text(to + "/report.json"));
  };
  place.write("second.json", R"({"clicks": [{"label": "object", "x": 330, "y": 300}], "choice": 2})");
  const json first = cut("--click 330,300", "first"), second = cut("--click 330,300 --choice 2", "second");
  REQUIRE(first["choices"] > 1);
  CHECK(first["choice"] == 1);
  CHECK(second["choice"] == 2);
  CHECK(second["choices"] == first["choices"]);
  CHECK(place.text("first/labels.u8") != place.text("second/labels.u8"));
  cut("--seeds second.json", "by_file");
  CHECK(place.text("by_file/labels.u8") == place.text("second/labels.u8"));
  CHECK(first["certainty"] < 1);
  CHECK(second["certainty"] == 1);  // it was chosen

  const Result none = place.run(life.cut("--click " + life.click + " --choice 3 --write labels -o third"));
  CHECK(none.code == 0);
  const json third = json::parse(place.text("third/report.json"));
  REQUIRE(third["choices"] < 3);
  CHECK(none.err.find("only: this is") != std::string::npos);
}

TEST_CASE("a relative cache folder is ignored") {
  StillLife& life = still_life();
  CHECK(life.place
            .run_with({"XDG_CACHE_HOME=relative", "HOME=" + (life.place / "home").string()},
                      life.cut("--click " + life.click + " --write labels -o cached"))
            .code == 0);
  CHECK_FALSE(life.place.exists("relative"));
}

TEST_CASE("cut writes every file of a cutout, by click, by seeds and by mask, and a complete report") {
  StillLife& life = still_life();
  Workplace& place = life.place;
  REQUIRE(place.run(life.cut("--click " + life.click + " --edges keep -o by_click")).code == 0);
  const std::set<std::string> files = {"labels.u8",   "masks.png", "object.ply", "object.png",
                                       "report.json", "rest.ply",  "rest.png",   "tint.png"};
  CHECK(place.files_in("by_click") == files);

  const json report = json::parse(place.text("by_click/report.json"));
  CHECK(has_keys(report, {"version", "settings", "scene", "object", "views", "cut", "stages", "total_ms",
                          "peak_rss_mb"}));
  CHECK(report["scene"]["gaussians"] == 20000);
  CHECK(has_keys(report["cut"], {"nodes", "arcs", "energy", "flow"}));
  CHECK(report["cut"]["energy"].get<double>() == report["cut"]["flow"].get<double>());
  REQUIRE(report["views"].size() >= 1);  // fast looks from the first view alone
  CHECK(has_keys(report["enough"], {"views", "pixels", "gaussians", "why"}));
  CHECK(report["enough"]["views"] == 1);
  for (const json& view : report["views"]) CHECK(has_keys(view, {"used", "confidence", "mask_px"}));
  for (const json& stage : report["stages"]) CHECK(has_keys(stage, {"name", "ms"}));

  // Labels, object and rest agree in their numbers, and the apple is in the object.
  const std::string labels = place.text("by_click/labels.u8"), truth = place.text("made/small.labels.u8");
  REQUIRE(labels.size() == 20000);
  const auto ones = static_cast<std::size_t>(std::count(labels.begin(), labels.end(), '\1'));
  CHECK(report["object"]["gaussians"] == ones);
  CHECK(json::parse(place.run("info by_click/object.ply --json").out)["gaussians"] == ones);
  CHECK(json::parse(place.run("info by_click/rest.ply --json").out)["gaussians"] == 20000 - ones);
  const json names = json::parse(place.text("made/seeds.json"))["labels"];
  const auto apple = static_cast<char>(std::find(names.begin(), names.end(), "apple") - names.begin());
  std::size_t both = 0;
  for (std::size_t row = 0; row < labels.size(); ++row) both += labels[row] == '\1' && truth[row] == apple;
  CHECK(2 * both > static_cast<std::size_t>(std::count(truth.begin(), truth.end(), apple)));
  CHECK(2 * ones < labels.size());

  const auto comma = life.click.find(',');
  place.write("seeds.json", R"({"clicks": [{"x": )" + life.click.substr(0, comma) + R"(, "y": )" +
                                life.click.substr(comma + 1) + "}]}");
  REQUIRE(place.run(life.cut("--seeds seeds.json --write labels -o by_seeds")).code == 0);
  CHECK(place.text("by_seeds/labels.u8") == labels);

  REQUIRE(place
              .run("render " + life.scene + " " + life.camera +
                   " --what labels --labels by_click/labels.u8 -o mask.png")
              .code == 0);
  const Result by_mask = place.run(life.cut("--mask mask.png --write labels -o by_mask --json"));
  REQUIRE(by_mask.code == 0);
  CHECK(json::parse(by_mask.out)["object"]["gaussians"].get<double>() ==
        doctest::Approx(static_cast<double>(ones)).epsilon(0.2));
  CHECK(place.leftovers().empty());
}

TEST_CASE("existing output is refused without --overwrite, and nothing in it changes") {
  StillLife& life = still_life();
  Workplace& place = life.place;
  place.make_folder("there");
  place.write("there/object.ply", "precious");
  place.write("there/notes.txt", "mine");
  place.write("view.png", "precious");
  place.write("copy.splat", "precious");
  const std::string cut = life.cut("--click " + life.click + " -o there");
  for (const std::string& arguments :
       {cut, "render " + life.scene + " -o view.png", "convert " + life.scene + " -o copy.splat"}) {
    const Result result = place.run(arguments);
    CHECK(result.code == 1);
    CHECK_MESSAGE(result.err.find("--overwrite") != std::string::npos, result.err);
  }
  CHECK(place.text("there/object.ply") == "precious");
  CHECK(place.text("view.png") == "precious");
  CHECK(place.text("copy.splat") == "precious");
  REQUIRE(place.run(cut + " --overwrite").code == 0);
  CHECK(place.text("there/object.ply").starts_with("ply"));
  CHECK(place.text("there/notes.txt") == "mine");
}

TEST_CASE("an input that has the name of what is written first is kept") {
  const Workplace& place = still_life().place;
  const std::string scene = place.text("made/small.ply");
  place.write("new.ply.splatcut.part", scene);
  const Result result = place.run("convert new.ply.splatcut.part -o new.ply");
  CHECK(result.code == 1);
  CHECK_MESSAGE(result.err.find("is read here") != std::string::npos, result.err);
  CHECK(place.text("new.ply.splatcut.part") == scene);
  std::filesystem::remove(place / "new.ply.splatcut.part");
}

TEST_CASE("Gaussians that cannot be used are left out with a sentence") {
  const Workplace place;
  std::string text = "ply\nformat ascii 1.0\nelement vertex 3\n";
  for (const char* property : {"x", "y", "z", "f_dc_0", "f_dc_1", "f_dc_2", "opacity", "scale_0", "scale_1",
                               "scale_2", "rot_0", "rot_1", "rot_2", "rot_3"})
    text += std::string("property float ") + property + "\n";
  text += "end_header\n";
  for (const char* x : {"0", "nan", "1"}) text += std::string(x) + " 0 0 1 1 1 3 -3 -3 -3 1 0 0 0\n";
  place.write("three.ply", text);
  const char* const said = "1 of its 3 Gaussians are left out";
  for (const char* command : {"convert three.ply -o two.splat", "render three.ply -o two.png --size 32x24"}) {
    const Result result = place.run(command);
    CHECK(result.code == 0);
    CHECK_MESSAGE(result.err.find(said) != std::string::npos, result.err);
  }
  place.write("ask.sh",
              R"(echo '{"id": 1, "do": "open", "scene": "three.ply"}' | )" + splatcut_program() + " serve");
  const Result served = place.run_program("/bin/bash", "ask.sh");
  CHECK_MESSAGE(served.out.find(said) != std::string::npos, served.out);
}

TEST_CASE("the bytes of a cutout do not depend on --threads") {
  StillLife& life = still_life();
  Workplace& place = life.place;
  for (const char* threads : {"1", "3"})
    REQUIRE(
        place
            .run(life.cut("--click " + life.click + " --no-cache --threads " + threads + " -o on_" + threads))
            .code == 0);
  for (const char* file :
       {"object.ply", "rest.ply", "labels.u8", "object.png", "rest.png", "tint.png", "masks.png"}) {
    CAPTURE(file);
    CHECK(place.text(std::string("on_3/") + file) == place.text(std::string("on_1/") + file));
  }
}

TEST_CASE(
    "what was prepared is kept: the second run reads it and writes the same bytes, --no-cache does neither") {
  StillLife& life = still_life();
  Workplace place;  // its cache is empty
  const auto stages = [&](const std::string& folder) {
    std::set<std::string> names;
    const json report = json::parse(place.text(folder + "/report.json"));
    for (const json& stage : report["stages"]) names.insert(stage["name"]);
    return names;
  };
  const std::string cut = life.cut("--click " + life.click);
  REQUIRE(place.run(cut + " --no-cache -o without").code == 0);
  CHECK_FALSE(place.exists("cache"));
  REQUIRE(place.run(cut + " -o first").code == 0);
  REQUIRE(place.files_in("cache/splatcut").size() == 1);
  CHECK(stages("first").contains("parts"));
  REQUIRE(place.run(cut + " -o second").code == 0);
  CHECK(stages("second").contains("cache"));
  CHECK_FALSE(stages("second").contains("parts"));
  for (const char* file :
       {"object.ply", "rest.ply", "labels.u8", "object.png", "rest.png", "tint.png", "masks.png"}) {
    CAPTURE(file);
    const std::string one = place.text(std::string("without/") + file);
    CHECK(place.text(std::string("first/") + file) == one);
    CHECK(place.text(std::string("second/") + file) == one);
  }
  // Damaged: made again, written again.
  const std::string kept = "cache/splatcut/" + *place.files_in("cache/splatcut").begin();
  const std::string bytes = place.text(kept);
  place.write(kept, bytes.substr(0, bytes.size() / 2));
  REQUIRE(place.run(cut + " --write labels -o third").code == 0);
  CHECK(stages("third").contains("parts"));
  CHECK(place.text("third/labels.u8") == place.text("without/labels.u8"));
  CHECK(place.text(kept) == bytes);
  // A folder that cannot be made is no reason to stop.
  std::filesystem::remove_all(place / "cache");
  place.write("cache", "a file");
  CHECK(place.run(cut + " --write labels -o fourth").code == 0);
}

TEST_CASE("--set sets what a switch sets, and refuses what it does not know with a list of what it does") {
  StillLife& life = still_life();
  Workplace& place = life.place;
  REQUIRE(place.run(life.cut("--click " + life.click + " --smoothness 3 --write labels -o by_switch")).code ==
          0);
  REQUIRE(
      place.run(life.cut("--click " + life.click + " --set smoothness=3 --write labels -o by_set")).code ==
      0);
  CHECK(place.text("by_set/labels.u8") == place.text("by_switch/labels.u8"));
  CHECK(json::parse(place.text("by_set/report.json"))["settings"]["set"] == json({"smoothness=3"}));
  REQUIRE(place
              .run(life.cut("--click " + life.click +
                            " --set energy.pairwise=paper --set energy.hard=1 --write labels -o other"))
              .code == 0);
  CHECK(json::parse(place.text("other/report.json"))["cut"]["energy"] !=
        json::parse(place.text("by_set/report.json"))["cut"]["energy"]);
  const auto refused = [&](const std::string& assignment, const char* says) {
    const Result result =
        place.run(life.cut("--click " + life.click + " --set " + assignment + " -o refused"));
    CHECK_MESSAGE(result.code == 1, assignment);
    CHECK_MESSAGE(result.err.find(says) != std::string::npos, result.err);
  };
  refused("energy.lamda=3", "energy.lambda, ");
  refused("=3", "there is no such setting");
  refused("energy.lambda", "from 0 to 500");
  refused("energy.lambda=", "from 0 to 500");
  refused("energy.lambda=3x", "from 0 to 500");
  refused("energy.lambda=nan", "from 0 to 500");
  refused("energy.lambda=-1", "from 0 to 500");
  refused("energy.pairwise=best", "overlap, paper or paper-code");
  refused("energy.hard=yes", "0 or 1");
  refused("neighbours=0", "a whole number from 1 to 254");
  CHECK_FALSE(place.exists("refused"));
}

TEST_CASE("render --lowpass draws thin splats thinner, and by default as in training") {
  StillLife& life = still_life();
  Workplace& place = life.place;
  const auto picture = [&](const std::string& name, const std::string& how) {
    REQUIRE(place.run("render " + life.scene + " --size 160x120 -o " + name + how).code == 0);
    return place.text(name);
  };
  const std::string usual = picture("usual.png", "");
  CHECK(picture("trained.png", " --lowpass 0.3") == usual);
  CHECK(picture("web.png", " --lowpass 0.075") != usual);
}

TEST_CASE("Ctrl+C ends a run with 1 and leaves nothing half written") {
  StillLife& life = still_life();
  Workplace& place = life.place;
  REQUIRE(place.run("make-scene large -o large --gaussians 300000 --format ply").code == 0);
  place.write("large/suite.json",
              R"({"scenes": [{"name": "a", "scene": "large.ply", "cameras": "cameras.json",
      "truth": {"labels": "large.labels.u8"}, "reference": {"camera": "view_00"}, "clicks": "robot", "test_views": [{"camera": "view_06"}]}]})");
  for (const std::string& arguments :
       {"cut large/large.ply --cameras large/cameras.json --camera 0 --click " + life.click,
        std::string("eval large/suite.json"), std::string("make-scene more --gaussians 3000000")})
    for (const int after_ms : {5, 60, 300, 700}) {
      CAPTURE(arguments);
      CAPTURE(after_ms);
      const Result result = place.run_interrupted(arguments + " -o stopped", after_ms);
      // A signal before the program has set its handler ends it by that signal.
      CHECK_MESSAGE((result.code == 1 || result.signal == SIGINT), result.code);
      if (result.code == 1) CHECK_MESSAGE(result.err.find("cancelled") != std::string::npos, result.err);
      CHECK_FALSE(place.exists("stopped"));
      CHECK(place.leftovers().empty());
    }
  for (const int after_ms : {5, 10, 20, 40}) {
    CAPTURE(after_ms);
    const Result result = place.run_interrupted("info large/large.ply --json", after_ms);
    if (result.code == 1) CHECK_MESSAGE(result.err.find("cancelled") != std::string::npos, result.err);
    if (result.code == 0) CHECK(json::parse(result.out)["gaussians"] == 300000);  // read whole, never a part
  }
}
