// The eye in an object's row: the scene without that object, whichever is chosen; its tint is another matter.
#include <doctest/doctest.h>

#include <algorithm>
#include <string>

#include "hands.h"

using namespace splatcut;
using namespace splatcut::testing;

namespace {

// Presses the eye in the row of an object.
void press_eye(HeadlessApp& app, ObjectId object) {
  app->interface().make_current();
  const auto rows = std::ranges::find_if(GImGui->Windows, [](const ImGuiWindow* w) {
    return w->WasActive && std::string_view(w->Name).find("side/scroll") != std::string_view::npos;
  });
  REQUIRE(rows != GImGui->Windows.end());
  const int row = static_cast<int>(object);
  GImGui->NavNextActivateId = ImHashStr("###eye", 0, ImHashData(&row, sizeof row, (*rows)->ID));
  GImGui->NavNextActivateFlags = ImGuiActivateFlags_None;
  app.frames(3);
  REQUIRE(app.settle());
}

// Whether the picture is drawn with any Gaussian of an object.
bool in_picture(Studio& studio, ObjectId object) {
  const Flags shown = studio.viewport().shown(0);
  const auto labels = studio.labels(object);
  for (std::size_t g = 0; g < labels.size(); ++g)
    if (labels[g] && (!shown || (*shown)[g])) return true;
  return false;
}

// The apple is object 1, the mug object 2 and chosen.
void begin_mug(Hands& hands) {
  hands.app.key('N', {.ctrl = true});
  hands.app.click(hands.app.screen_of(kOnMug));
  REQUIRE(hands.app.settle());
  REQUIRE(hands.studio().document().active == 2);
  REQUIRE(hands.selected() > 0);
}

}  // namespace

TEST_CASE("hands: the eye of a row hides that object in the scene, and shows it again") {
  Hands hands;
  Studio& studio = hands.studio();
  begin_mug(hands);
  const std::size_t steps = hands.steps();
  const auto apple = studio.labels(1);
  press_eye(hands.app, 1);
  CHECK_FALSE(in_picture(studio, 1));
  CHECK(in_picture(studio, 2));
  CHECK(studio.document().active == 2);
  const auto hit = studio.viewport().pick(hands.in_viewport(hands.app.screen_of(kOnApple)));
  CHECK((!hit || !apple[static_cast<std::size_t>(hit->gaussian)]));
  studio.apply(ActivateObject{1});  // choosing does not show it, nor hide the other
  REQUIRE(hands.app.settle());
  CHECK_FALSE(in_picture(studio, 1));
  CHECK(in_picture(studio, 2));
  hands.app.key('I');  // asked for alone, it shows
  REQUIRE(hands.app.settle());
  CHECK(in_picture(studio, 1));
  hands.app.key(key::kEscape);
  REQUIRE(hands.app.settle());
  CHECK_FALSE(in_picture(studio, 1));
  press_eye(hands.app, 1);
  CHECK(studio.viewport().shown(0) == nullptr);
  CHECK(hands.steps() == steps);
  CHECK(studio.labels(1) == apple);
}

TEST_CASE("hands: the eye tells what H hides, and undoes it, and H undoes what the eye hid") {
  Hands hands;
  Studio& studio = hands.studio();
  begin_mug(hands);
  hands.app.key('H');
  REQUIRE(hands.app.settle());
  REQUIRE_FALSE(in_picture(studio, 2));
  press_eye(hands.app, 2);
  CHECK(studio.view().display == DisplayMode::kWhole);
  CHECK(in_picture(studio, 2));
  press_eye(hands.app, 2);
  CHECK_FALSE(in_picture(studio, 2));
  hands.app.key('H');
  hands.app.key('H');
  REQUIRE(hands.app.settle());
  CHECK(in_picture(studio, 2));
  press_eye(hands.app, 1);
  press_eye(hands.app, 2);
  hands.app.key('H', {.shift = true});
  REQUIRE(hands.app.settle());
  CHECK(studio.viewport().shown(0) == nullptr);
}

TEST_CASE("hands: a shape passes over what the eye hid, and saved work keeps it hidden") {
  Hands hands;
  Studio& studio = hands.studio();
  begin_mug(hands);
  const auto apple = studio.labels(1);
  press_eye(hands.app, 1);
  ViewState view = studio.view();
  view.see_through = true;
  studio.apply(SetView{view});
  const Camera camera = studio.viewport().pane_camera();
  studio.apply(NewObject{});
  studio.apply(SelectRegion{camera, Mask(camera.width_px, camera.height_px, kMaskObject)});
  REQUIRE(hands.selected() > 0);
  const auto all = studio.labels(3);
  for (std::size_t g = 0; g < apple.size(); ++g) REQUIRE_FALSE((apple[g] && all[g]));
  const ScratchFolder folder("hidden_object");
  studio.apply(SaveWork{folder / "eye.splatcut.json"});
  REQUIRE(hands.app.settle());
  Hands other(false);
  other.app.open(folder / "eye.splatcut.json");
  REQUIRE(other.app.settle());
  CHECK_FALSE(in_picture(other.studio(), 1));
  CHECK(in_picture(other.studio(), 2));
  other.app.open(kSmallSample);
  REQUIRE(other.app.settle());
  CHECK(other.studio().view().hidden.empty());
}

TEST_CASE("hands: an object without a tint shows, and one that is hidden keeps its tint") {
  Hands hands;
  Studio& studio = hands.studio();
  begin_mug(hands);
  studio.apply(TintObject{1, false});
  REQUIRE(hands.app.settle());
  CHECK(in_picture(studio, 1));
  press_eye(hands.app, 2);
  CHECK(studio.document().find(2)->tinted);
  CHECK_FALSE(studio.document().find(1)->tinted);
}
