// The view of an object: F frames it in the picture, and alone it is what the view turns
// around.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <vector>

#include "hands.h"
#include "scene/cloud/strays.h"
#include "scene/raster/rasterizer.h"
#include "segment/masks/mask_tools.h"
#include "synthetic_cloud.h"

using namespace splatcut;
using namespace splatcut::testing;

namespace {

// The share of the active object's pixels that the rest of the scene covers in the present view.
double covered_share(Hands& hands) {
  const GaussianCloud& cloud = *hands.studio().scene()->cloud;
  const Camera camera = limited_to_width(hands.studio().viewport().pane_camera(), 200);
  const auto labels = hands.studio().labels(hands.studio().document().active);
  const Mask seen = thresholded(render_labels({cloud, nullptr}, camera, labels), 0.5f);
  RasterOptions alone;
  alone.shown = labels;
  const Mask whole = thresholded(rasterize(cloud, camera, alone).alpha, 0.5f);
  return 1 - static_cast<double>(count(seen)) / static_cast<double>(count(whole));
}

// Where the active object is seen, in logical points of the picture.
UiRect seen_object(Hands& hands) {
  const Camera camera = hands.studio().viewport().pane_camera();
  const std::vector<std::uint8_t> labels = hands.studio().labels(hands.studio().document().active);
  const Image<float> weight = render_labels(hands.studio().scene()->scene->cloud, camera, labels);
  UiRect box{glm::vec2(1e9f), glm::vec2(-1e9f)};
  for (int y = 0; y < weight.height(); ++y)
    for (int x = 0; x < weight.width(); ++x)
      if (weight.at(x, y) > 0.5f) {
        box.min = glm::min(box.min, glm::vec2(x, y));
        box.max = glm::max(box.max, glm::vec2(x + 1, y + 1));
      }
  return box;
}

}  // namespace

TEST_CASE("hands: F frames the object") {
  Hands hands;
  hands.app.key('F');
  REQUIRE(hands.app.settle());
  const auto labels = hands.studio().labels(hands.studio().document().active);
  const GaussianCloud& cloud = *hands.studio().scene()->cloud;
  const UiRect view = hands.app->interface().viewport();
  std::size_t inside = 0, all = 0;
  float top = 1e9f, bottom = -1e9f;
  for (std::size_t g = 0; g < labels.size(); ++g) {
    if (!labels[g]) continue;
    const glm::vec2 at = hands.seen_at(cloud.position[g]);
    ++all;
    const bool seen = view.contains(at);
    inside += seen;
    if (seen) top = std::min(top, at.y), bottom = std::max(bottom, at.y);
  }
  CHECK(static_cast<double>(inside) > 0.97 * static_cast<double>(all));
  CHECK(bottom - top > 0.4f * view.size().y);
}

TEST_CASE("hands: where something stands before the object, F again looks from a side where less does") {
  Hands hands;
  Studio& studio = hands.studio();
  const auto frame = [&] {
    hands.app.key('F');
    REQUIRE(hands.app.settle());
    return studio.camera().pose();
  };
  frame();
  CHECK(hands.said().find("F again") == std::string::npos);
  CameraPose worst = studio.camera().pose();
  double most = 0;
  for (int turn = 0; turn < 24; ++turn) {
    studio.camera().orbit(
        {turn == 0 ? 0.0f : 43.6f, turn == 0 ? -60.0f : 0.0f});  // 15 degrees, low above the table
    if (const double covered = covered_share(hands); covered > most) {
      most = covered;
      worst = studio.camera().pose();
    }
  }
  REQUIRE(most > 0.4);
  studio.camera().set_pose(worst);
  REQUIRE(hands.app.settle());
  const CameraPose first = frame();
  const double before = covered_share(hands);
  REQUIRE(before > 0.3);
  CHECK(hands.said().find("Something stands before Object 1: F again") == 0);
  const glm::vec3 forward = studio.viewport().pane_camera().forward_world();
  CHECK(frame() != first);
  CHECK(covered_share(hands) < before - 0.1);
  CHECK(glm::dot(studio.viewport().pane_camera().forward_world(), forward) > std::cos(glm::radians(46.0f)));
  studio.camera().set_pose(worst);  // an offer is for the view in which it was made
  REQUIRE(hands.app.settle());
  CHECK(frame() == first);
}

TEST_CASE("hands: F never leaves the object behind a wall") {
  Hands hands = hands_on_sample(false);
  hands.app.click(hands.app.screen_of({450, 640}));  // the table, all of which is seen from outside the room
  REQUIRE(hands.selected() > 50000);
  hands.app.key('F');
  REQUIRE(hands.app.settle());
  CHECK(covered_share(hands) < 0.5);
  CHECK(hands.said().find("Something stands before Object 1: shown from a side") == 0);
}

TEST_CASE("hands: what an object is set into does not stand before it") {
  const ScratchFolder folder("rivet");
  Scene scene;  // half of a ball in a sheet whose blurred splats lie over it, seen from the front
  GaussianCloud& cloud = scene.cloud;
  constexpr std::size_t kBall = 400, kSheet = 3000;
  cloud = random_cloud(kBall + kSheet, 5, 0, 0.04f);
  for (std::size_t g = 0; g < cloud.size(); ++g) {
    const bool ball = g < kBall;
    const glm::vec3 p = cloud.position[g];
    cloud.position[g] = ball ? 0.1f * glm::normalize(p) : glm::vec3(p.x, p.y, 0.05f * p.z - 0.06f);
    cloud.opacity[g] = ball ? 0.9f : 0.5f;
  }
  scene.file_rows = cloud.size();
  save_scene(folder / "rivet.ply", scene, {}, SceneFormat::kPly);
  Hands hands(false, with_kept_scenes(), folder / "rivet.ply");
  Studio& studio = hands.studio();
  studio.apply(SelectVolume{{true, {0, 0, 0}, glm::vec3(0.11f)}});
  REQUIRE(hands.app.settle());
  REQUIRE(hands.selected() > kBall / 4);
  studio.apply(GoToCamera{look_at({0, 0, -1}, {0, 0, 0}, {0, -1, 0}, 0.9f, 640, 480)});
  REQUIRE(hands.app.settle());
  hands.app.key('F');
  REQUIRE(hands.app.settle());
  CHECK(hands.said().find("stands before") == std::string::npos);
}

TEST_CASE("hands: F that waits for a cut, with I, is dropped where the view was turned meanwhile") {
  for (const bool turned : {false, true}) {
    Hands hands = hands_on_sample(false);
    hands.app.click(hands.app.screen_of(kOnApple));
    hands.app.key('I');
    hands.app.key('F');
    REQUIRE(hands.said().find("as soon as") != std::string::npos);
    const CameraPose asked = hands.studio().camera().pose();
    if (turned) hands.app.drag({{300, 400}, {340, 400}, {400, 410}}, PointerButton::kRight);
    const CameraPose left = hands.studio().camera().pose();
    CHECK((left == asked) == !turned);
    REQUIRE(hands.app.settle());
    CHECK(hands.studio().view().display == DisplayMode::kIsolate);
    CHECK((hands.studio().camera().pose() == left) == turned);
  }
}

TEST_CASE("hands: F pressed while an object is computed frames what comes, as F after that does") {
  constexpr glm::vec2 kPageOfBook{360, 300};
  for (const bool other_meaning : {false, true}) {
    CAPTURE(other_meaning);
    std::vector<CameraPose> framed;
    for (const bool hasty : {true, false}) {
      Hands hands = hands_on_sample(false);
      const auto wait = [&] { REQUIRE((hasty || hands.app.settle())); };
      hands.app.click(hands.app.screen_of(kPageOfBook));
      if (other_meaning) {
        REQUIRE(hands.app.settle());
        REQUIRE(hands.studio().clicks().offer());
        hands.app.key('3');
      }
      wait();
      REQUIRE(hands.studio().cutting() == hasty);
      hands.app.key('F');
      REQUIRE(hands.app.settle());
      framed.push_back(hands.studio().camera().pose());
    }
    CHECK(framed[0].distance == doctest::Approx(framed[1].distance).epsilon(0.01));
    CHECK(glm::distance(framed[0].position_world, framed[1].position_world) < 0.01f * framed[1].distance);
  }
}

TEST_CASE("hands: F lets the object fill four fifths of the picture") {
  Hands hands = hands_on_sample();
  hands.app.key('I');  // nothing stands before it
  for (const glm::vec2 turn : {glm::vec2(0), glm::vec2(160, 30), glm::vec2(-90, 60)}) {
    hands.studio().camera().orbit(turn);
    hands.app.key('F');
    REQUIRE(hands.app.settle());
    const UiRect seen = seen_object(hands);
    const Camera camera = hands.studio().viewport().pane_camera();
    const glm::vec2 picture(camera.width_px, camera.height_px), share = seen.size() / picture;
    CAPTURE(share.x);
    CAPTURE(share.y);
    CHECK(std::max(share.x, share.y) > 0.74f);
    CHECK(std::max(share.x, share.y) < 0.88f);
    const glm::vec2 middle = 0.5f * (seen.min + seen.max) / picture;
    CHECK(std::abs(middle.x - 0.5f) < 0.03f);
    CHECK(std::abs(middle.y - 0.5f) < 0.03f);
  }
}

TEST_CASE("hands: alone, the object is what the view turns around, corrected or not") {
  Hands hands = hands_on_sample();
  hands.app.key('I');
  REQUIRE(hands.app.settle());
  const glm::vec3 rim = hands.under(hands.app.screen_of(kOnApple + glm::vec2(40, 20)));
  hands.app.click(hands.seen_at(rim));  // a correction far from the middle
  REQUIRE(hands.app.settle());
  const auto middle = [&] {
    const UiRect seen = seen_object(hands);
    return 0.5f * (seen.min + seen.max);
  };
  const glm::vec2 before = middle();
  hands.studio().camera().orbit({400, 0});
  REQUIRE(hands.app.settle());
  CHECK(glm::distance(before, middle()) < 12);
}

TEST_CASE("hands: F frames the object as if strays far behind it were not there") {
  Hands hands = hands_on_sample();
  hands.app.key('F');
  REQUIRE(hands.app.settle());
  const float distance = hands.studio().camera().pose().distance;
  const GaussianCloud& cloud = *hands.studio().scene()->cloud;
  const auto labels = hands.studio().labels(hands.studio().document().active);
  const Camera camera = hands.studio().viewport().pane_camera();
  // The farthest from it, a twentieth as many.
  std::vector<std::size_t> order(cloud.size());
  for (std::size_t g = 0; g < order.size(); ++g) order[g] = g;
  const glm::vec3 middle = camera.centre_world() + distance * camera.forward_world();
  std::ranges::sort(order, std::ranges::greater(),
                    [&](std::size_t g) { return glm::distance(cloud.position[g], middle); });
  std::vector<std::uint8_t> with_strays = labels;
  for (std::size_t i = 0; i < count_flags(labels) / 20; ++i) with_strays[order[7 * i]] = 1;
  const auto rotation = hands.studio().camera().pose().camera_from_world;
  const auto framed = [&](const std::vector<glm::vec3>& of) {
    return hands.studio().camera().framing(of, camera, rotation).pose.distance;
  };
  std::vector<glm::vec3> all;
  for (std::size_t g = 0; g < cloud.size(); ++g)
    if (with_strays[g]) all.push_back(cloud.position[g]);
  const float alone = framed(hands.studio().viewport().object_points());
  CHECK(framed(all) > 1.3f * alone);  // what it was
  CHECK(framed(shown_points(cloud, with_strays)) == doctest::Approx(alone).epsilon(0.05));
}

TEST_CASE("hands: looked at from the front, right or above, the object stays in the picture") {
  Hands hands = hands_on_sample();
  hands.app.key('F');
  REQUIRE(hands.app.settle());
  for (const int code : {int(key::kKeypad1), int(key::kKeypad3), int(key::kKeypad7)}) {
    CAPTURE(code);
    hands.studio().camera().zoom(5);  // too near
    hands.app.frames(2);
    hands.app.key(code);
    REQUIRE(hands.app.settle());
    const auto labels = hands.studio().labels(hands.studio().document().active);
    std::size_t inside = 0, all = 0;
    for (std::size_t g = 0; g < labels.size(); ++g) {
      if (!labels[g]) continue;
      const glm::vec2 at = hands.seen_at(hands.studio().scene()->cloud->position[g]);
      ++all;
      inside += hands.app->interface().viewport().contains(at);
    }
    CHECK(static_cast<double>(inside) > 0.97 * static_cast<double>(all));
  }
}
