// Masks of several views in a folder say which object is meant.
#include <doctest/doctest.h>

#include <nlohmann/json.hpp>

#include "cut_program.h"

using namespace splatcut::testing;
using nlohmann::json;

namespace {

void copy(const std::string& from, const std::string& to) {
  still_life().place.write(to, still_life().place.text(from));
}

// A folder with the apple's masks: view and name of each.
void mask_folder(const std::string& folder, const std::vector<std::pair<int, std::string>>& masks,
                 const std::string& size = kSize) {
  const Workplace& place = still_life().place;
  std::filesystem::remove_all(place / folder);
  place.make_folder(folder);
  for (const auto& [view, name] : masks) {
    std::filesystem::create_directories((place / (folder + "/" + name)).parent_path());
    copy(apple_mask(view, size), folder + "/" + name);
  }
}

}  // namespace

TEST_CASE("--masks: masks of several cameras, found by name, are all used, the object is the one they show") {
  const Workplace& place = still_life().place;
  mask_folder("masks", {{0, "view_00.png"}, {3, "view_03.JPG.png"}, {7, "inner/view_07.PNG"}});
  place.write("masks/notes.txt", "not a mask");
  REQUIRE(place.run(cut_with(std::string(kSize) + " --masks masks/ -o by_masks")).code == 0);
  const json report = json::parse(place.text("by_masks/report.json"));
  CHECK(report["settings"]["reference"] == "view_00");
  REQUIRE(report["views"].size() == 3);
  for (const json& view : report["views"]) CHECK(view["used"] == true);
  CHECK(iou(place.text("by_masks/labels.u8"), still_life().truth_of("apple")) > 0.8);

  // --camera chooses the reference where that camera has a mask; otherwise the first with one is taken, and
  // said so.
  REQUIRE(place.run(cut_with(std::string(kSize) + " --masks masks --camera view_07 -o from_7")).code == 0);
  CHECK(json::parse(place.text("from_7/report.json"))["settings"]["reference"] == "view_07");
  const Result other = place.run(cut_with(std::string(kSize) + " --masks masks --camera 1 -o from_1"));
  REQUIRE(other.code == 0);
  CHECK(other.err.find("\"view_01\" has no mask, \"view_00\" is the reference") != std::string::npos);
  CHECK(place.text("from_1/labels.u8") == place.text("by_masks/labels.u8"));
}

TEST_CASE(
    "--masks: half the size, a black one and one without a camera, and a sentence on how all were "
    "understood") {
  const Workplace& place = still_life().place;
  mask_folder("mixed", {{0, "view_00_mask.png"}, {3, "view_03.png"}, {7, "photo_7.png"}});
  black_mask("mixed/view_05.png");
  const Result result = place.run(cut_with(" --masks mixed -o by_mixed"));
  REQUIRE_MESSAGE(result.code == 0, result.err);
  CHECK(result.err.find("3 of 4 masks have a camera; taken for the object: white; scaled by 2; 1 black: "
                        "there all is rest") != std::string::npos);
  CHECK(result.err.find("1 mask has no camera and is left out") != std::string::npos);
  CHECK(iou(place.text("by_mixed/labels.u8"), still_life().truth_of("apple")) > 0.8);
}

TEST_CASE("--masks: masks larger than any view is looked at serve as well") {
  const Workplace& place = still_life().place;
  const std::string large = " --size 2016x1512";
  std::filesystem::remove_all(place / "large_masks");
  place.make_folder("large_masks");
  for (const int view : {0, 3}) {
    const std::string to = "large_masks/view_0" + std::to_string(view) + ".png";
    apple_mask(view);
    REQUIRE(place
                .run("render " + still_life().scene + " " + still_life().cameras + " --camera " +
                     std::to_string(view) + large + " --what labels --labels apple.labels.u8 -o " + to)
                .code == 0);
  }
  REQUIRE(place.run(cut_with(large + " --masks large_masks -o by_large")).code == 0);
  const json report = json::parse(place.text("by_large/report.json"));
  REQUIRE(report["views"].size() == 2);
  CHECK(report["views"][1]["used"] == true);
  CHECK(iou(place.text("by_large/labels.u8"), still_life().truth_of("apple")) > 0.8);
}

TEST_CASE("--masks with one mask is --mask, in the camera's own size, too") {
  const Workplace& place = still_life().place;
  mask_folder("one", {{3, "view_03.png"}}, "");
  REQUIRE(place.run(cut_with(" --masks one -o by_folder")).code == 0);
  REQUIRE(place.run(cut_with(" --camera view_03 --mask one/view_03.png -o by_file")).code == 0);
  for (const char* file : {"labels.u8", "object.ply", "object.png", "tint.png", "masks.png"})
    CHECK_MESSAGE(place.text(std::string("by_folder/") + file) == place.text(std::string("by_file/") + file),
                  file);
}

TEST_CASE("--mask without --camera says in which camera's view it was taken, with --camera it need not") {
  const Workplace& place = still_life().place;
  mask_folder("first", {{0, "any.png"}});
  const std::string cut = cut_with(std::string(kSize) + " --mask first/any.png --views 0");
  const Result guessed = place.run(cut + " -o guessed"), named = place.run(cut + " --camera 0 -o named");
  REQUIRE(guessed.code == 0);
  REQUIRE(named.code == 0);
  CHECK(guessed.err.find("first/any.png: taken as a mask of the camera view_00, the first of ") !=
        std::string::npos);
  CHECK(named.err.find("taken as a mask") == std::string::npos);
  CHECK(place.text("guessed/labels.u8") == place.text("named/labels.u8"));
}

TEST_CASE("masks that cannot be used are refused, with the file and the reason, and nothing is written") {
  const Workplace& place = still_life().place;
  const std::string masks = cut_with(std::string(kSize) + " --masks bad");
  refused(cut_with(" --masks nowhere"), {}, {"nowhere", "No such file"});
  place.make_folder("bad");
  refused(masks, {}, {"bad", "holds no masks", "NAME.png"});
  mask_folder("bad", {{3, "photo_3.png"}});
  refused(masks, {}, {"photo_3.png", "no camera is called \"photo_3\"", "view_00"});
  mask_folder("bad", {{0, "view_00.png"}, {0, "view_00.jpg.png"}});
  refused(masks, {}, {"view_00", "another mask"});
  mask_folder("bad", {{0, "view_00.png"}});
  refused(cut_with(" --size 400x400 --masks bad"), {}, {"view_00.png", "504x378", "--size"});
  std::filesystem::remove(place / "bad/view_00.png");
  black_mask("bad/view_03.png");
  refused(masks, {}, {"bad", "all masks are black"});
  refused(cut_with(std::string(kSize) + " --camera 3 --mask bad/view_03.png"), {}, {"view_03.png", "empty"});
  mask_folder("bad", {{0, "view_00.png"}});
  place.write("bad/view_03.png", place.text("bad/view_00.png").substr(0, 200));
  refused(masks, {}, {"view_03.png"});
  mask_folder("bad", {{0, "view_00.png"}});
  refused("cut " + still_life().scene + " --masks bad", {}, {"--cameras"});
  refused(masks + " --camera-pos 0,-1,-4 --camera-target 0,0,0", {}, {"--camera-pos", "--camera"});
  refused(masks + " --click 5,5", {}, {"--masks"}, 2);
  refused(masks + " --mask bad/view_00.png", {}, {"--mask"}, 2);
  refused(masks + " --parts-only", {}, {"--parts-only"}, 2);
  // Two cameras of one name cannot be told apart.
  json cameras = json::parse(place.text("made/cameras.json"));
  cameras[1]["img_name"] = "view_00";
  place.write("twins.json", cameras.dump());
  refused("cut " + still_life().scene + " --cameras twins.json --masks bad" + kSize, {},
          {"2 cameras", "view_00"});
}

TEST_CASE("render --all-cameras: a mask for each camera, the same as one by one") {
  const Workplace& place = still_life().place;
  const std::string one = apple_mask(0);
  const std::string how = "render " + still_life().scene + " " + still_life().cameras + kSize +
                          " --what labels --labels apple.labels.u8";
  const Result result = place.run(how + " --all-cameras -o masks_of_all");
  REQUIRE_MESSAGE(result.code == 0, result.err);
  const json cameras = json::parse(place.text("made/cameras.json"));
  CHECK(place.files_in("masks_of_all").size() == cameras.size());
  CHECK(place.text("masks_of_all/view_00.png") == place.text(one));
  CHECK(place.run(how + " --all-cameras -o masks_of_all").code == 1);  // it is there
  CHECK(place.run(cut_with(kSize) + " --masks masks_of_all -o by_all").code == 0);
}
