// The any-view robot: its clicks and its figures on pictures drawn by hand, and by the program on a still
// life.
#include "app/measure/any_view.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "app/lab/any_view_report.h"
#include "app/lab/scene_copies.h"
#include "app/measure/click_sheet.h"
#include "app/measure/robot_user.h"
#include "core/error.h"
#include "program_runner.h"
#include "scene/raster/rasterizer.h"

using namespace splatcut;
using namespace splatcut::testing;
using nlohmann::json;

namespace {

constexpr int kWidth = 12, kHeight = 8, kPixels = kWidth * kHeight;

Mask block(int x0, int y0, int width, int height) {
  Mask mask(kWidth, kHeight);
  for (int y = y0; y < y0 + height; ++y)
    for (int x = x0; x < x0 + width; ++x) mask.at(x, y) = kMaskObject;
  return mask;
}

Mask both(Mask a, const Mask& b) {
  for (std::size_t i = 0; i < a.size(); ++i) a.pixels()[i] |= b.pixels()[i];
  return a;
}

Camera camera_called(const std::string& name) {
  Camera camera;
  camera.name = name;
  camera.width_px = kWidth;
  camera.height_px = kHeight;
  camera.fx_px = camera.fy_px = 10;
  camera.camera_from_world_translation.x = static_cast<float>(name.back());  // cameras differ
  return camera;
}

// Two views "0" and "1" whose labels are their pixels, and a cut that answers what was written down for it.
struct Toy {
  AnyViewWorld world;
  std::vector<std::pair<Mask, Mask>> answers;
  std::size_t asked = 0;
  std::vector<Mask> meanings;  // of the first click
  std::vector<int> choices;    // with which it was asked

  Toy(Mask truth_0, Mask truth_1) {
    world.views = {{camera_called("0"), std::move(truth_0)}, {camera_called("1"), std::move(truth_1)}};
    world.cut = [this](std::span<const ViewClick> clicks, int choice, const Job&) {
      REQUIRE(clicks.size() == asked + (choice > 0 ? 0 : 1));  // all that were made so far
      choices.push_back(choice);
      const auto& [a, b] = answers.at(asked++);
      CutAnswer answer;
      answer.meanings = meanings;
      for (const Mask* m : {&a, &b})
        for (const std::uint8_t p : m->pixels()) answer.labels.push_back(p != 0);
      return answer;
    };
    world.picture = [](const Camera& camera, const std::vector<std::uint8_t>& labels) {
      Mask mask(kWidth, kHeight);
      const std::size_t first = camera.name == "0" ? 0 : kPixels;
      for (std::size_t i = 0; i < mask.size(); ++i) mask.pixels()[i] = labels[first + i] ? kMaskObject : 0;
      return mask;
    };
  }
  AnyViewStart start_in_1(const glm::vec2& pixel) const {
    return {"1", world.views[1].camera, click(pixel, SeedLabel::kObject)};
  }
};

void check_click(const ViewClick& c, const std::string& view, const glm::vec2& pixel, SeedLabel label) {
  CHECK(c.camera.name == view);
  CHECK(c.stroke.points_px.front() == pixel);
  CHECK(c.stroke.label == label);
}

}  // namespace

TEST_CASE("any view: clicks, obedience, falls and clicks to a goal are those counted by hand") {
  const Mask wide = block(2, 1, 5, 3), square = block(4, 2, 3, 3), none(kWidth, kHeight),
             extra = block(8, 4, 4, 4);
  Toy toy(wide, square);
  toy.answers = {{none, square}, {both(wide, extra), square}, {none, none}, {none, none}, {wide, square}};
  const AnyViewSession session = any_view_session(toy.world, toy.start_in_1({5.5f, 3.5f}), 7);
  REQUIRE(session.clicks.size() == 5);
  check_click(session.clicks[0], "1", {5.5f, 3.5f}, SeedLabel::kObject);
  check_click(session.clicks[1], "0", {3.5f, 2.5f},
              SeedLabel::kObject);  // the first of its three deepest pixels
  check_click(session.clicks[2], "0", {9.5f, 5.5f}, SeedLabel::kRest);    // 16 pixels too many in view 0
  check_click(session.clicks[3], "0", {3.5f, 2.5f}, SeedLabel::kObject);  // 15 are missing there, 9 in view 1
  check_click(session.clicks[4], "0", {3.5f, 2.5f}, SeedLabel::kObject);
  const double second = (15.0 / 31 + 1) / 2;
  const std::vector<double> expected = {0.5, second, 0, 0, 1, 1, 1};
  REQUIRE(session.iou_after.size() == expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i)
    CHECK(session.iou_after[i] == doctest::Approx(expected[i]));
  CHECK(session.obeyed == std::vector<bool>{true, true, true, false, true});
  CHECK(session.obeyed_share() == doctest::Approx(0.8));
  CHECK(session.worst_fall() == doctest::Approx(second));
  const json j = sessions_json({session}, 7);
  CHECK(j["iou_after_clicks"]["2"].get<double>() == doctest::Approx(second));
  CHECK(j["iou_after_clicks"]["5"] == 1);
  CHECK_FALSE(j["iou_after_clicks"].contains("8"));  // seven were made
  CHECK(j["noc85"] == 5);
  CHECK(j["noc90"] == 5);
  CHECK(j["obeyed"].get<double>() == doctest::Approx(0.8));
}

TEST_CASE(
    "any view: a hand that mends details takes each of them in turn, by chance, not the largest alone") {
  const Mask wide = block(1, 1, 10, 6), square = block(4, 2, 4, 4), none(kWidth, kHeight);
  const Mask line = block(0, 0, 12, 1);  // too thin for a detail
  const std::vector<WrongRegion> details = wrong_details(wide, both(square, line), 2);
  REQUIRE(details.size() == 1);
  CHECK(details[0].pixels == 10 * 6 - 4 * 4);
  CHECK(details[0].label == SeedLabel::kObject);
  REQUIRE(wrong_details(none, both(square, line), 2).size() == 1);
  CHECK(wrong_details(none, square, 2)[0].label == SeedLabel::kRest);
  CHECK(wrong_details(none, square, 3).empty());
  int in_small = 0, in_large = 0;
  for (std::uint64_t draw = 0; draw < 20; ++draw) {
    Toy toy(wide, square);
    toy.answers = {{none, none}, {wide, square}};
    const AnyViewSession session =
        any_view_session(toy.world, toy.start_in_1({5.5f, 3.5f}), 2, {.draw = draw, .details = 2});
    REQUIRE(session.clicks.size() == 2);
    (session.clicks[1].camera.name == "1" ? in_small : in_large) += 1;
  }
  CHECK(in_small > 4);
  CHECK(in_large > 4);
}

TEST_CASE("any view: each meaning that is offered is scored over all views") {
  const Mask wide = block(2, 1, 5, 3), square = block(4, 2, 3, 3), none(kWidth, kHeight);
  Toy toy(wide, square);
  const AnyViewStart start = toy.start_in_1({5.5f, 2.5f});
  const std::vector<std::pair<Mask, Mask>> by_choice = {{none, square}, {wide, none}, {wide, square}};
  toy.world.cut = [&](std::span<const ViewClick> clicks, int choice, const Job&) {
    REQUIRE(clicks.size() == 1);
    const auto& [a, b] = by_choice.at(static_cast<std::size_t>(choice));
    CutAnswer answer{.labels = {}, .doubts = {}, .meanings = {square, none, square}};
    for (const Mask* m : {&a, &b})
      for (const std::uint8_t p : m->pixels()) answer.labels.push_back(p != 0);
    return answer;
  };
  CHECK(iou_of_meanings(toy.world, {start.camera, start.first}) == std::vector<double>{0.5, 0.5, 1});
}

TEST_CASE("any view: an offered meaning is taken by what the clicked view shows, and costs a click") {
  const Mask wide = block(2, 1, 5, 3), square = block(4, 2, 3, 3), none(kWidth, kHeight);
  const std::vector<Mask> offered = {block(4, 2, 3, 1), none, square};  // IoU 1/3, 0, 1 in the clicked view
  Toy toy(wide, square);
  toy.meanings = offered;
  toy.answers = {{none, offered[0]}, {none, square}, {wide, square}};
  const AnyViewSession session =
      any_view_session(toy.world, toy.start_in_1({5.5f, 2.5f}), 4, {.choices = true});
  CHECK(session.choice == 2);
  CHECK(toy.choices == std::vector<int>{0, 2, 2});
  const std::vector<double> expected = {1.0 / 6, 0.5, 1, 1};
  REQUIRE(session.iou_after.size() == expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i)
    CHECK(session.iou_after[i] == doctest::Approx(expected[i]));
  CHECK(session.clicks.size() == 2);
  CHECK(session.obeyed.size() == 2);
  for (const auto& [asked_for, third] : {std::pair{false, square}, {true, block(4, 2, 3, 1)}}) {
    Toy other(wide, square);  // not asked for, or no better by a twentieth
    other.meanings = {offered[0], none, third};
    other.answers = {{none, offered[0]}, {wide, square}};
    CHECK(any_view_session(other.world, other.start_in_1({5.5f, 2.5f}), 2, {.choices = asked_for}).choice ==
          0);
    CHECK(other.choices == std::vector<int>{0, 0});
  }
}

TEST_CASE("any view: the wheel is turned as long as the clicked view gets better, and costs no click") {
  const Mask wide = block(2, 1, 5, 3), square = block(4, 2, 3, 3), none(kWidth, kHeight);
  // Of view 1, from its smallest size: IoU 1/9, 1/3, 1, 2/3. The click itself takes the first or the last.
  const std::vector<Mask> sizes = {block(5, 3, 1, 1), block(4, 2, 3, 1), square, block(4, 2, 3, 2)};
  for (const int by_itself : {0, 3}) {
    CAPTURE(by_itself);
    Toy toy(wide, square);
    std::vector<int> asked;
    toy.world.cut = [&](std::span<const ViewClick> clicks, int, const Job&) {
      const int step = clicks.front().stroke.size_step;
      if (clicks.size() == 1) asked.push_back(step);
      const int size = std::clamp(by_itself + step, 0, 3);
      CutAnswer answer;
      for (const Mask* m : {clicks.size() == 1 ? &none : &wide, &sizes.at(static_cast<std::size_t>(size))})
        for (const std::uint8_t p : m->pixels()) answer.labels.push_back(p != 0);
      return answer;
    };
    const AnyViewStart start = toy.start_in_1({5.5f, 2.5f});
    const AnyViewSession session = any_view_session(toy.world, start, 2, {.sizes = true});
    CHECK(asked == (by_itself == 0 ? std::vector{0, 1, 2, 3} : std::vector{0, 1, -1, -2}));
    REQUIRE(session.clicks.size() == 2);
    CHECK(session.clicks[0].stroke.size_step == (by_itself == 0 ? 2 : -1));
    CHECK(session.clicks[1].stroke.size_step == 0);
    CHECK(session.iou_after == std::vector<double>{0.5, 1});
    CHECK(sessions_json({session}, 2)["sessions"][0]["clicks"][0]["scale"] == (by_itself == 0 ? 2 : -1));
    asked.clear();
    CHECK(any_view_session(toy.world, start, 1).clicks[0].stroke.size_step == 0);
    CHECK(asked == std::vector{0});
  }
}

TEST_CASE(
    "any view: a sheet shows each click's view before and after it, right, missing and too much apart") {
  constexpr int kWide = 60, kHigh = 40;
  constexpr int kGap = 4;  // between pictures
  const auto box = [](int x0, int x1) {
    Mask mask(kWide, kHigh);
    for (int y = 0; y < kHigh; ++y)
      for (int x = x0; x < x1; ++x) mask.at(x, y) = kMaskObject;
    return mask;
  };
  Camera camera = camera_called("0");
  camera.width_px = kWide;
  camera.height_px = kHigh;
  AnyViewWorld world;
  world.views = {{camera, box(0, 30)}};
  world.cut = [](std::span<const ViewClick> clicks, int, const Job&) {
    return CutAnswer{std::vector<std::uint8_t>(clicks.size()), {}};
  };
  // Nothing, then too far to the right, then right.
  world.picture = [&](const Camera&, const std::vector<std::uint8_t>& labels) {
    return labels.empty() ? Mask(kWide, kHigh) : labels.size() == 1 ? box(10, 40) : box(0, 30);
  };
  const AnyViewSession session =
      any_view_session(world, {"0", camera, click({20.5f, 20.5f}, SeedLabel::kObject)}, 5);
  REQUIRE(session.clicks.size() == 2);
  const Image<Rgb8> sheet = click_sheet({}, world, session);  // of nothing: black below the tints
  REQUIRE(sheet.width() == 2 * kWide + 3 * kGap);
  REQUIRE(sheet.height() == 2 * kHigh + 3 * kGap);
  const auto at = [&](int column, int row, int x) {
    return sheet.at(kGap + column * (kWide + kGap) + x, kGap + row * (kHigh + kGap) + 2);
  };
  const Rgb8 black{}, missing = at(0, 0, 5);
  CHECK(missing[0] > missing[1]);
  CHECK(at(0, 0, 29) == missing);
  CHECK(at(0, 0, 35) == black);
  CHECK(at(0, 1, 5) == missing);
  const Rgb8 right = at(0, 1, 15), too_much = at(0, 1, 35);
  CHECK(right[1] > std::max(right[0], right[2]));
  CHECK(too_much[2] > std::max(too_much[0], too_much[1]));
  CHECK(at(0, 1, 45) == black);
  CHECK(at(1, 0, 35) == too_much);  // the second click finds what the first left
  CHECK(at(1, 1, 5) == right);
  CHECK(at(1, 1, 35) == black);
  CHECK(sheet.at(kGap + 20, kGap + 20) != missing);  // the click
  CHECK(sheet.at(kGap + 26, kGap + 20) == Rgb8{255, 255, 255});
}

TEST_CASE("any view: least and 10th percentile are of sessions, means are over them, never reached is 20") {
  std::vector<AnyViewSession> sessions(20);
  for (std::size_t i = 0; i < sessions.size(); ++i) {
    sessions[i].iou_after = {0.05 * static_cast<double>(i + 1), 0.5};
    sessions[i].ms_per_click = 10;
  }
  const json j = sessions_json(sessions, 2);
  CHECK(j["iou_after_clicks"]["1"].get<double>() == doctest::Approx(0.525));
  CHECK(j["least"]["iou_after_clicks"]["1"].get<double>() == doctest::Approx(0.05));
  CHECK(j["p10"]["iou_after_clicks"]["1"].get<double>() == doctest::Approx(0.1));
  CHECK(j["noc90"].get<double>() == doctest::Approx((3 * 1 + 17 * 20) / 20.0));
  CHECK(j["most_fall"].get<double>() == doctest::Approx(0.5));
  CHECK(j["worst_fall"].get<double>() == doctest::Approx(0.05 * 55 / 20));  // 10 of them fall, by .05 to .5
}

TEST_CASE(
    "any view: of equal regions the lowest view's, missing before extra; a label 2 px away obeys, 3 px not") {
  const Mask square = block(4, 2, 3, 3), none(kWidth, kHeight), elsewhere = block(0, 5, 3, 3);
  Toy toy(square, square);
  toy.answers = {
      {none, elsewhere}, {none, elsewhere}, {block(7, 3, 1, 1), square}, {block(8, 3, 1, 1), square}};
  const AnyViewSession session = any_view_session(toy.world, toy.start_in_1({5.5f, 3.5f}), 4);
  REQUIRE(session.clicks.size() == 4);
  for (const std::size_t i : {1, 2, 3}) check_click(session.clicks[i], "0", {5.5f, 3.5f}, SeedLabel::kObject);
  CHECK(session.obeyed == std::vector<bool>{false, false, true, false});
  CHECK(session.obeyed_pixel == std::vector<bool>{false, false, false, false});
}

TEST_CASE("any view: starts are the references and the views whose truth counts, each once") {
  EvaluationCase scene;
  scene.name = "toy";
  Mask speck(100, 100), large(100, 100);
  speck.at(50, 50) = kMaskObject;  // a ten thousandth
  for (int x = 0; x < 40; ++x) large.at(x, 20) = kMaskObject;
  scene.test_views = {camera_called("0"), camera_called("1"), camera_called("2")};
  scene.truth_masks = {large, speck, large};
  scene.reference = camera_called("3");
  CHECK(any_view_starts(scene, truth_views(scene)).size() == 2);  // nobody knows where to click in "3"
  scene.clicks = {click({7, 8}, SeedLabel::kObject), click({9, 9}, SeedLabel::kRest)};
  scene.more_references = {{camera_called("2"), {}},
                           {camera_called("4"), {click({1, 2}, SeedLabel::kObject)}}};
  const std::vector<TruthView> views = truth_views(scene);
  REQUIRE(views.size() == 2);
  const std::vector<AnyViewStart> starts = any_view_starts(scene, views);
  REQUIRE(starts.size() == 4);
  CHECK(starts[0].name == "reference 3");
  CHECK(starts[0].first.points_px.front() == glm::vec2(7, 8));
  CHECK(starts[1].name == "reference 4");
  CHECK(starts[2].name == "view 0");
  CHECK(large.at(static_cast<int>(starts[2].first.points_px.front().x), 20) != 0);
  CHECK(starts[3].name == "reference 2");
  // An unsteady hand clicks elsewhere, on the same things.
  int others = 0;
  for (std::uint64_t draw = 1; draw < 6; ++draw) {
    const AnyViewStart other = any_view_starts(scene, views, {.box_margin = {}, .draw = draw})[2];
    others += other.first.points_px != starts[2].first.points_px;
    CHECK(large.at(static_cast<int>(other.first.points_px.front().x),
                   static_cast<int>(other.first.points_px.front().y)) != 0);
  }
  CHECK(others > 0);
  // With boxes it begins where the truth is known: around it.
  const std::vector<AnyViewStart> boxed = any_view_starts(scene, views, {.box_margin = 0.0f});
  REQUIRE(boxed.size() == 2);
  CHECK(boxed[0].first.is_box());
  CHECK(boxed[0].first.points_px == robot_box(large, 0)->points_px);
  scene.truth_masks = {speck, speck, speck};
  CHECK_THROWS_AS(truth_views(scene), Error);
}

TEST_CASE("any view: the robot's box stands around the truth, by a margin, into it, and unevenly by chance") {
  Mask truth(20, 10);
  for (int y = 2; y < 7; ++y)
    for (int x = 4; x < 8; ++x) truth.at(x, y) = kMaskObject;
  using Corners = std::vector<glm::vec2>;
  CHECK(robot_box(truth, 0)->points_px == Corners{{4, 2}, {8, 7}});
  CHECK(robot_box(truth, 0.25f)->points_px == Corners{{3, 0.75f}, {9, 8.25f}});
  CHECK(robot_box(truth, -0.25f)->points_px == Corners{{5, 3.25f}, {7, 5.75f}});
  const Corners by_chance = robot_box(truth, 0.25f, 7)->points_px;
  CHECK(by_chance == robot_box(truth, 0.25f, 7)->points_px);
  CHECK(by_chance != robot_box(truth, 0.25f, 8)->points_px);
  CHECK(4 - by_chance[0].x != by_chance[1].x - 8);
  for (const auto& [out, extent] : {std::pair{glm::vec2(4, 2) - by_chance[0], glm::vec2(4, 5)},
                                    {by_chance[1] - glm::vec2(8, 7), glm::vec2(4, 5)}})
    for (const int axis : {0, 1}) {
      CHECK(out[axis] >= 0);
      CHECK(out[axis] <= 0.5f * extent[axis]);
    }
  CHECK_FALSE(robot_box(Mask(20, 10), 0));
}

TEST_CASE(
    "copies of a scene: every Gaussian is where it was, whatever its row, and a hundredth of its size off at "
    "most") {
  const Workplace place;
  REQUIRE(place.run("make-scene small -o made --gaussians 3000").code == 0);
  const Scene scene = load_scene(place / "made/small.ply");
  std::vector<std::string> names;
  for (int number = 0; number < 8; ++number) {
    const SceneCopy copy = scene_copy(scene, number);
    CAPTURE(copy.name);
    names.push_back(copy.name);
    REQUIRE(copy.scene.cloud.size() == scene.cloud.size());
    std::vector<std::uint32_t> seen = copy.origin;
    std::ranges::sort(seen);
    CHECK(std::ranges::adjacent_find(seen) == seen.end());
    float most = 0, most_sizes = 0;
    for (std::size_t g = 0; g < copy.origin.size(); ++g) {
      const std::size_t was = copy.origin[g];
      const float off = glm::distance(copy.scene.cloud.position[g], scene.cloud.position[was]);
      const glm::vec3& size = scene.cloud.scale[was];
      most = std::max(most, off);
      most_sizes = std::max(most_sizes, off / std::max({size.x, size.y, size.z}));
    }
    CHECK(most < 0.02f);  // of a room of about four units
    if (copy.name.starts_with("shuffled")) CHECK(most == 0);
    if (copy.name.starts_with("splats moved")) {
      CHECK(most > 0);
      CHECK(most_sizes < 0.0101f);
    }
    CHECK(scene_copy(scene, number).scene.cloud.position == copy.scene.cloud.position);
  }
  std::ranges::sort(names);
  CHECK(std::ranges::adjacent_find(names) == names.end());
}

TEST_CASE(
    "eval --any-view: every field, zoom along the ray, copies, several references, and what it refuses") {
  const Workplace place;
  REQUIRE(place.run("make-scene small -o made --gaussians 4000").code == 0);
  const json suite = json::parse(place.text("made/suite.json"));
  json entry;
  for (const json& e : suite["scenes"])
    if (e["name"] == "apple") entry = e;
  const json views = entry["test_views"];
  entry["test_views"] = {views[0], views[4]};
  entry.erase("reference");
  entry["references"] = {views[0], views[8]};
  json other = entry;
  other["name"] = "left out by its name";
  place.write("made/some.json", json{{"scenes", {other, entry}}}.dump());
  const std::string command = "eval made/some.json --only apple --no-curve";
  const Result result =
      place.run(command + " -o out --any-view --robot-clicks 3 --draws 2 --zoom --perturb 2");
  REQUIRE_MESSAGE(result.code == 0, result.err);
  CHECK(result.out.find("NoC85") != std::string::npos);
  const json measured = json::parse(place.text("out/eval.json"));
  REQUIRE(measured["scenes"].size() == 1);
  for (const json& s : {measured["scenes"][0], measured["mean"]}) {
    const json& robot = s["any_view"];
    for (const char* key :
         {"noc85", "noc90", "obeyed", "obeyed_pixel", "worst_fall", "most_fall", "ms_per_click"})
      CHECK_MESSAGE(robot[key].is_number(), key);
    for (const char* k : {"1", "2", "3"})
      for (const json& of : {robot, robot["least"], robot["p10"]})
        CHECK_MESSAGE(of["iou_after_clicks"][k].is_number(), k);
    for (const char* factor : {"0.4", "0.6", "1", "2", "4"})
      CHECK_MESSAGE((s["zoom"][factor].is_number() || (s["zoom"][factor].is_null() && *factor != '0')),
                    factor);
    for (const char* what : {"median", "least", "spread", "difference", "most_difference"})
      CHECK_MESSAGE(s["perturb"]["3"][what].is_number(), what);
  }
  const json& scene = measured["scenes"][0];
  CHECK(scene["doubts"].is_array());
  const json& sessions = scene["any_view"]["sessions"];
  REQUIRE(sessions.size() == 6);  // views 0 and 4, reference 8: each twice
  CHECK(scene["any_view"]["views"] == 3);
  double first = 0;
  for (std::size_t i = 0; i < 3; ++i) first += sessions[i]["iou_after"][0].get<double>() / 3;
  CHECK(scene["zoom"]["1"].get<double>() == doctest::Approx(first));
  CHECK(sessions[0]["doubts"].size() == sessions[0]["clicks"].size());
  CHECK(measured["mean"]["any_view"].contains("sessions") == false);
  // The same again: nothing hangs on what was cut before, nor on the number of threads.
  REQUIRE(place.run(command + " -o again --any-view --robot-clicks 3 --starts 2 --threads 1 --sheets").code ==
          0);
  const std::set<std::string> written = place.files_in("again");
  const auto sheets = std::ranges::count_if(
      written, [](const std::string& name) { return name.starts_with("sheet_apple_"); });
  CHECK(sheets == 2);
  const json again = json::parse(place.text("again/eval.json"))["scenes"][0]["any_view"]["sessions"];
  REQUIRE(again.size() == 2);
  CHECK(again[0] == sessions[0]);
  CHECK(again[1] == sessions[1]);
  // The chart of what was measured begins where the sessions do.
  const Result chart = place.run("click-chart out/eval.json -o chart");
  REQUIRE_MESSAGE(chart.code == 0, chart.err);
  const auto [iou, reached] = [&] {
    std::pair<double, double> row;
    std::sscanf(place.text("chart/clicks.csv").c_str(), "out: 1 object,iou,reached_90\n1,%lf,%lf", &row.first,
                &row.second);
    return row;
  }();
  CHECK(iou == doctest::Approx(scene["any_view"]["iou_after_clicks"]["1"].get<double>()));
  const auto at_once =
      std::ranges::count_if(sessions, [](const json& session) { return session["iou_after"][0] >= 0.9; });
  CHECK(reached * 6 == doctest::Approx(static_cast<double>(at_once)));
  for (const char* usage : {" --any-view --set trim=0", " --any-view --parts-only",
                            " --any-view --masks truth", " --zoom", " --perturb 2"})
    CHECK_MESSAGE(place.run(command + " -o refused" + usage).code == 2, usage);
  CHECK_FALSE(place.exists("refused"));
}
