// Keys right after another object was chosen are about that one.
#include <doctest/doctest.h>

#include <cmath>

#include "hands.h"

using namespace splatcut;
using namespace splatcut::testing;

namespace {

// The apple is Object 1, the orange Object 2.
struct TwoObjects : Hands {
  TwoObjects() {
    app.key('N', {false, true, false});
    app.click(app.screen_of(kOnOrange));
    REQUIRE(selected() > 0);
    REQUIRE(studio().document().active == 2);
  }
  void choose(ObjectId object) {
    studio().apply(ActivateObject{object});
    REQUIRE(app.settle());
  }
  glm::vec3 middle() {
    glm::vec3 sum(0);
    const std::vector<glm::vec3> points = studio().viewport().object_points();
    for (const glm::vec3& p : points) sum += p;
    return sum / static_cast<float>(points.size());
  }
  // The share of the picture's pixels that show something.
  double shown() {
    REQUIRE(app.settle());
    const Frame& frame = *studio().viewport().picture()->frames.front();
    std::size_t seen = 0;
    for (const float alpha : frame.alpha.pixels()) seen += alpha > 0.5f;
    return static_cast<double>(seen) / static_cast<double>(frame.alpha.pixels().size());
  }
};

}  // namespace

TEST_CASE("chosen object: its tint lies over those of others that hold the same Gaussians") {
  TwoObjects hands;
  hands.studio().apply(DuplicateObject{1});
  REQUIRE(hands.app.settle());
  REQUIRE(hands.studio().document().objects.size() == 3);
  for (const std::size_t number : {0, 1, 2}) {
    CAPTURE(number);
    const ObjectId id = hands.studio().document().objects[number].id;
    hands.choose(id);
    const auto labels = hands.studio().labels(id);
    const Flags owner = hands.studio().viewport().style(0).owner;
    REQUIRE(owner);
    for (std::size_t g = 0; g < labels.size(); ++g)
      if (labels[g]) REQUIRE((*owner)[g] == number + 1);
  }
}

TEST_CASE("chosen object: F frames it, whatever was offered for another one, alone or not") {
  TwoObjects hands;
  Studio& studio = hands.studio();
  // Whether from there something stands before Object 1.
  const auto another_is_offered = [&](const CameraPose& from) {
    hands.choose(1);
    studio.apply(SetView{});
    studio.camera().set_pose(from);
    hands.app.key('F');
    REQUIRE(hands.app.settle());
    return hands.said().find("F again") != std::string::npos;
  };
  hands.choose(1);
  constexpr float kTurnPx = 43.6f;
  studio.camera().orbit({15 * kTurnPx, -60});  // the first side found; others are looked at should it be none
  CameraPose from = studio.camera().pose();
  for (int turn = 0; turn < 24 && !another_is_offered(from); ++turn) {
    studio.camera().orbit({kTurnPx, 0});
    from = studio.camera().pose();
  }
  for (const bool alone : {true, false}) {
    CAPTURE(alone);
    REQUIRE(another_is_offered(from));
    if (alone) hands.app.key('I');
    hands.choose(2);
    hands.app.key('F');
    REQUIRE(hands.app.settle());
    const UiRect view = hands.app->interface().viewport();
    CHECK(glm::distance(hands.seen_at(hands.middle()), 0.5f * (view.min + view.max)) < 0.3f * view.size().y);
    if (alone) CHECK(hands.shown() > 0.05);
  }
}

TEST_CASE("chosen object: alone, it is what the view turns around") {
  TwoObjects hands;
  hands.choose(1);
  hands.app.key('I');
  REQUIRE(hands.app.settle());
  hands.choose(2);
  CHECK(glm::distance(hands.studio().camera().turned_around(), hands.middle()) < 0.1f);
}

TEST_CASE("chosen object: the keys of other meanings are of its click, or say why they take none") {
  TwoObjects hands;
  Studio& studio = hands.studio();
  hands.choose(1);
  REQUIRE(studio.clicks().offer());
  hands.app.key('2');
  REQUIRE(hands.app.settle());
  CHECK(studio.document().active_object()->choice == 1);
  hands.app.key('I');
  REQUIRE(hands.app.settle());
  hands.app.key('2');
  CHECK(hands.said() == "What else the click can mean is shown in the whole scene (Shift+H)");
  hands.app.key('H', {true, false, false});
  hands.app.key('1');
  REQUIRE(hands.app.settle());
  CHECK(studio.document().active_object()->choice == 0);
}

TEST_CASE("chosen object: of opened work other meanings are waited for where they are not known yet") {
  const ScratchFolder folder("meanings_come");
  Hands hands;
  hands.studio().apply(SaveWork{folder / "apple.splatcut.json"});
  REQUIRE(hands.app.settle());
  hands.studio().apply(OpenScene{folder / "apple.splatcut.json"});
  while (!hands.studio().idle() && !hands.said().starts_with("small_sample")) hands.app.frames(1);
  hands.app.key('2');
  REQUIRE(hands.app.settle());
  REQUIRE(hands.studio().clicks().offer());
  CHECK(hands.studio().document().active_object()->choice == 1);
}
