// cut writes its Gaussians in metres by a known length, and upright on its foot.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

#include "cut_program.h"

using namespace splatcut::testing;
using nlohmann::json;

namespace {

json info(const std::string& file) {
  const Result result = still_life().place.run("info " + file + " --json");
  REQUIRE_MESSAGE(result.code == 0, result.err);
  return json::parse(result.out);
}

// Largest and smallest along an axis of the corners of an .obj.
std::pair<double, double> range(const std::string& obj, int axis) {
  std::istringstream lines(obj);
  std::pair<double, double> range{1e9, -1e9};
  std::string word;
  for (double at[3]; lines >> word >> at[0] >> at[1] >> at[2];)
    if (word == "v") range = {std::min(range.first, at[axis]), std::max(range.second, at[axis])};
  return range;
}

double side(const json& info, int axis) {
  return info["bounds_98"]["max"][axis].get<double>() - info["bounds_98"]["min"][axis].get<double>();
}

std::string cut_apple(const std::string& rest) {
  return still_life().cut("--click " + still_life().click_on("apple") +
                          " --edges keep --write object,rest,objects,labels,hull " + rest);
}

}  // namespace

TEST_CASE(
    "cut --scale-by: all files are as much larger as the report says, and twice the metres is twice as "
    "large") {
  const Workplace& place = still_life().place;
  const std::string ends = still_life().click_on("apple") + "," + still_life().click_on("mug");
  REQUIRE(place.run(cut_apple("-o as_it_is")).code == 0);
  for (const char* metres : {"1", "2"}) {
    const Result result = place.run(cut_apple("--scale-by " + ends + "," + metres + " -o metres_" + metres));
    REQUIRE_MESSAGE(result.code == 0, result.err);
  }
  const auto scale = [&](const std::string& folder) {
    return json::parse(place.text(folder + "/report.json"))["placed"]["scale"].get<double>();
  };
  CHECK(scale("as_it_is") == 1);
  CHECK(scale("metres_2") == doctest::Approx(2 * scale("metres_1")));
  for (const char* file : {"/object.ply", "/rest.ply", "/objects.ply"}) {
    const json was = info(std::string("as_it_is") + file), is = info(std::string("metres_2") + file);
    CHECK(is["gaussians"] == was["gaussians"]);
    for (const char* end : {"min", "max"})
      for (int axis = 0; axis < 3; ++axis)  // about 0, 0, 0
        CHECK(is["bounds_98"][end][axis].get<double>() ==
              doctest::Approx(scale("metres_2") * was["bounds_98"][end][axis].get<double>()).epsilon(1e-4));
  }
  CHECK(place.text("metres_2/objects.ply").find("object_id") != std::string::npos);
  CHECK(place.text("metres_2/labels.u8") == place.text("as_it_is/labels.u8"));
}

TEST_CASE("cut --origin foot --up +z: the object stands on the ground, in the middle") {
  const Workplace& place = still_life().place;
  REQUIRE(place.run(cut_apple("--origin foot --up +z -o standing")).code == 0);
  const json is = info("standing/object.ply");
  const double tall = side(is, 2);
  CHECK(std::abs(is["bounds_98"]["min"][2].get<double>()) < 0.02 * tall);
  const std::string hull = place.text("standing/object.hull.obj");
  for (int axis = 0; axis < 3; ++axis) {
    const auto [least, most] = range(hull, axis);
    CHECK(least < is["bounds_98"]["min"][axis].get<double>());
    CHECK(most > is["bounds_98"]["max"][axis].get<double>());
    CHECK(most - least < 1.1 * side(is, axis));
  }
  for (int axis = 0; axis < 2; ++axis)
    CHECK(std::abs(is["bounds_98"]["min"][axis].get<double>() + is["bounds_98"]["max"][axis].get<double>()) <
          0.02 * tall);
}

TEST_CASE("cut: files say which way is up where it is known, and pictures of them stand so") {
  const Workplace& place = still_life().place;
  const auto up_of = [&](const std::string& file) {
    const json said = info(file);
    return said.contains("up") ? said["up"] : json();
  };
  REQUIRE(place.run(cut_apple("--up +z --origin foot -o placed_up")).code == 0);
  for (const char* file : {"object.ply", "rest.ply", "objects.ply"}) {
    CAPTURE(file);
    CHECK(up_of(std::string("placed_up/") + file) == json{0, 0, 1});
  }
  REQUIRE(place.run(cut_apple("-o known_up")).code == 0);  // by the cameras
  CHECK_FALSE(up_of("known_up/object.ply").is_null());
  const std::string guessed = "cut " + still_life().scene +
                              " --camera-pos 0,-1,-3 --camera-target 0,0,0 --box 400,300,600,500 "
                              "--edges keep --write object,rest";
  REQUIRE(place.run(guessed + " -o guessed_up").code == 0);
  CHECK(up_of("guessed_up/rest.ply").is_null());
  REQUIRE(place.run(guessed + " --camera-up 0,-1,0 -o told_up").code == 0);
  CHECK(up_of("told_up/rest.ply") == json{0, -1, 0});

  // Written anew, it says the same; a picture of it is that of --camera-up.
  REQUIRE(place.run("convert placed_up/rest.ply -o up.sog").code == 0);
  CHECK(up_of("up.sog") == json{0, 0, 1});
  const auto picture = [&](const std::string& options) {
    const Result result =
        place.run("render placed_up/rest.ply --size 64x48 --overwrite -o up.png " + options);
    REQUIRE_MESSAGE(result.code == 0, result.err);
    return place.text("up.png");
  };
  CHECK(picture("") == picture("--camera-up 0,0,1"));
  CHECK(picture("") != picture("--camera-up 0,-1,0"));
}

TEST_CASE("cut --scale-by: what is no known length is refused in words") {
  const std::string at = still_life().click_on("apple");
  refused(cut_apple("--scale-by " + at + ",1"), {}, {"--scale-by", "no known length"});
  refused(cut_apple("--scale-by " + at + ",1,2,3x"), {}, {"--scale-by", "no known length"});
  refused(cut_apple("--scale-by " + at + ",1,2,0"), {}, {"--scale-by", "not larger than 0"});
  refused(cut_apple("--scale-by " + at + "," + at + ",1"), {}, {"--scale-by", "the same place"});
  refused(cut_apple("--scale-by " + at + ",1,2,1e37"), {}, {"--scale-by", "times as large: 1e-06 to 1e+06"});
  refused(cut_apple("--scale-by " + at + ",90000,2,1"), {}, {"--scale-by", "outside of the"});
  CHECK(still_life().place.run(cut_apple("--origin foot --up x -o value")).code == 1);
}
