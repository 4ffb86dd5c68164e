// The hole that an object leaves, filled in the window: what is shown, and that exports write the same.
#include <doctest/doctest.h>

#include <algorithm>

#include "app/document/words.h"
#include "hands.h"
#include "segment/finish/shown_part.h"

using namespace splatcut;
using namespace splatcut::testing;

namespace {

// What the command line fills it by.
SurfacePatch filled_without_window(Hands& hands, const Flags& deleted = {}) {
  const OpenedScene& scene = *hands.studio().scene();
  const auto labels = hands.studio().labels(hands.studio().document().active);
  const std::vector<std::uint32_t> gone = deleted ? labelled_rows(*deleted) : std::vector<std::uint32_t>();
  return fill_surface(*scene.cloud, labels, gone, hands.studio().document().up_world, scene.views().cameras,
                      {});
}

void keep_edges(Hands& hands) {
  ViewState view = hands.studio().view();
  view.clean_edges = false;
  hands.studio().apply(SetView{view});
  REQUIRE(hands.app.settle());
}

bool shows(Hands& hands, const GaussianCloud& cloud) {
  const Viewport& viewport = hands.studio().viewport();
  const auto own = raster_frame(cloud, viewport.pane_camera(), nullptr, viewport.draw_limits());
  return std::ranges::equal(viewport.picture()->frames[0]->colour.pixels(), own->colour.pixels());
}

void press(Hands& hands, Action action) {
  hands.studio().run(action);
  REQUIRE(hands.app.settle());
}

}  // namespace

TEST_CASE(
    "hands: without the object the hole is shown filled, as it is exported, and only as long as wanted") {
  const ScratchFolder folder("filled");
  Hands hands = hands_on_sample();
  keep_edges(hands);
  const SurfacePatch patch = filled_without_window(hands);
  REQUIRE(patch.why_not.empty());
  const std::uint64_t document = hands.studio().history().serial();
  const auto labels = hands.studio().labels(hands.studio().document().active);
  std::vector<std::uint8_t> rest(labels.size());
  std::ranges::transform(labels, rest.begin(), [](auto l) { return std::uint8_t(!l); });
  const GaussianCloud& scene = *hands.studio().scene()->cloud;
  const GaussianCloud filled = rest_of(scene, rest, patch.changes), open = rest_of(scene, rest, {});

  press(hands, Action::kFillHole);
  CHECK(hands.studio().view().display == DisplayMode::kHide);
  CHECK(shows(hands, filled));
  CHECK_FALSE(shows(hands, open));
  const auto& hits = hands.studio().viewport().picture()->frames[0]->first_hit.pixels();
  CHECK(
      std::ranges::all_of(hits, [&](std::int32_t g) { return g < 0 || rest[static_cast<std::size_t>(g)]; }));
  CHECK(hands.studio().finish().hole_text() ==
        "Filled by " + grouped(patch.changes.given_back.size()) + " Gaussians, all invented.");
  CHECK(hands.studio().history().serial() == document);  // no work of the user's

  const auto& without = hands.studio().viewport().styles().without;
  REQUIRE(without);
  CHECK(without->patch.outline_world == patch.outline_world);
  hands.studio().apply(
      Export{{ExportWhat::kRest, SceneFormat::kPly, folder / "rest.ply", false, {}, false, true}});
  REQUIRE(hands.app.settle());
  CHECK(load_scene(folder / "rest.ply").cloud.size() == filled.size());

  press(hands, Action::kFillHole);
  CHECK(shows(hands, open));
  CHECK(hands.studio().finish().hole_text().empty());
  press(hands, Action::kFillHole);
  CHECK(shows(hands, filled));
  press(hands, Action::kShowAll);
  press(hands, Action::kIsolate);  // the object is not drawn from what the rest was drawn from
  CHECK_FALSE(shows(hands, filled));
}

TEST_CASE("hands: a hole is filled anew for other labels, and by nothing that was deleted") {
  Hands hands = hands_on_sample();
  keep_edges(hands);
  press(hands, Action::kFillHole);
  const auto first = hands.studio().viewport().styles().without;
  REQUIRE(first);
  hands.studio().apply(EditSelection{SelectionEdit::kGrow});
  REQUIRE(hands.app.settle());
  const auto second = hands.studio().viewport().styles().without;
  REQUIRE(second);
  CHECK(second != first);
  CHECK(second->patch.changes.given_back.position ==
        filled_without_window(hands).changes.given_back.position);
  hands.studio().apply(Undo{});
  REQUIRE(hands.app.settle());
  CHECK(hands.studio().viewport().styles().without == first);  // it was kept

  // Of another object all is deleted.
  const ObjectId apple = hands.studio().document().active;
  hands.studio().apply(NewObject{});
  hands.app.click(hands.app.screen_of(kOnMug));
  REQUIRE(hands.app.settle());
  REQUIRE(hands.selected() > 0);
  hands.studio().apply(DeleteSelected{});
  REQUIRE(hands.app.settle());
  hands.studio().apply(ActivateObject{apple});
  press(hands, Action::kHide);
  const auto third = hands.studio().viewport().styles().without;
  REQUIRE(third);
  CHECK(third != first);
  CHECK(third->patch.changes.given_back.position ==
        filled_without_window(hands, hands.studio().document().deleted).changes.given_back.position);
}

TEST_CASE("hands: a hole that cannot be filled is said in the picture, before an export and after it") {
  const ScratchFolder folder("open_hole");
  Hands hands = hands_on_sample();
  keep_edges(hands);
  // All but a few is taken, so nothing is left that it could touch.
  const std::vector<float> size = property_values(*hands.studio().scene()->cloud, Property::kSize);
  hands.studio().apply(SelectRange{Property::kSize, *std::ranges::min_element(size) + 0.05f, 100});
  REQUIRE(hands.app.settle());
  const SurfacePatch patch = filled_without_window(hands);
  REQUIRE_FALSE(patch.why_not.empty());
  press(hands, Action::kFillHole);
  CHECK(hands.studio().finish().hole_text() == "Not filled: " + patch.why_not + ".");
  CHECK_FALSE(hands.studio().viewport().clean(0));
  hands.app.key('E', {.ctrl = true});
  hands.app.frames(3);
  hands.app.press_item("###export", {"Everything else"});
  REQUIRE(hands.studio().finish().without());
  CHECK(hands.studio().finish().without()->patch.why_not == patch.why_not);
  hands.studio().apply(
      Export{{ExportWhat::kRest, SceneFormat::kPly, folder / "rest.ply", false, {}, false, true}});
  REQUIRE(hands.app.settle());
  CAPTURE(hands.said());
  CHECK(hands.studio().messages().back().kind == Message::Kind::kRefused);  // no green tick
  CHECK(hands.said().find("No hole is filled: " + patch.why_not) != std::string::npos);
}

TEST_CASE(
    "hands: a hole whose filling was stopped, or that was filled long ago, is filled when it is asked for "
    "again") {
  Hands hands = hands_on_sample();
  keep_edges(hands);
  const auto waits = [&] {
    return hands.studio().finish().hole_text() == "Filling the hole...  (Esc: stop)";
  };
  hands.studio().run(Action::kFillHole);
  for (int i = 0; i < 3000 && !waits(); ++i) hands.app.frames(1);
  REQUIRE(waits());
  hands.studio().apply(Cancel{});
  REQUIRE(hands.app.settle());
  CHECK(hands.said() == "Cancelled");
  CHECK(hands.studio().finish().hole_text() == "Not filled.");
  hands.app.frames(120);
  CHECK(hands.studio().finish().hole_text() == "Not filled.");  // not by itself
  press(hands, Action::kFillHole);
  press(hands, Action::kFillHole);
  CHECK(hands.studio().finish().hole_text().starts_with("Filled by "));
  press(hands, Action::kFillHole);
  // Other holes take the place of what was kept.
  const ScratchFolder folder("many_holes");
  for (const auto& [name, edges, fill] :
       {std::tuple{"a.ply", true, true}, {"b.ply", true, false}, {"c.ply", true, true}}) {
    hands.studio().apply(
        Export{{ExportWhat::kRest, SceneFormat::kPly, folder / name, false, {}, edges, fill}});
    REQUIRE(hands.app.settle());
  }
  press(hands, Action::kFillHole);
  CHECK(hands.studio().finish().hole_text().starts_with("Filled by "));
}

TEST_CASE("hands: a click on what is invented is one on what lies below it") {
  Hands hands = hands_on_sample();
  press(hands, Action::kHide);
  const glm::vec2 at = hands.in_viewport(hands.app.screen_of(kOnApple));
  press(hands, Action::kFillHole);
  const auto& hits = hands.studio().viewport().picture()->frames[0]->first_hit;
  std::optional<glm::vec2> invented;  // the nearest such pixel below the apple's middle
  for (int y = static_cast<int>(at.y); y < hits.height() && !invented; ++y)
    if (hits.at(static_cast<int>(at.x), y) < 0) invented = glm::vec2(static_cast<int>(at.x), y) + 0.5f;
  REQUIRE(invented);
  const auto hit = hands.studio().viewport().pick(*invented);
  REQUIRE(hit);
  CHECK(hands.studio().labels(hands.studio().document().active)[static_cast<std::size_t>(hit->gaussian)] ==
        0);
}

TEST_CASE("hands: what fills a hole is kept as an object of its own, which can be undone") {
  const ScratchFolder folder("kept_fill");
  Hands hands = hands_on_sample();
  Studio& studio = hands.studio();
  keep_edges(hands);
  studio.apply(KeepFill{folder / "fill.ply"});
  CHECK(hands.said().starts_with("No hole is filled"));
  CHECK_FALSE(std::filesystem::exists(folder / "fill.ply"));
  const SurfacePatch patch = filled_without_window(hands);
  const std::size_t before = studio.scene()->cloud->size(), invented = patch.changes.given_back.size();
  const auto object = studio.labels(studio.document().active);

  press(hands, Action::kFillHole);
  const Image<glm::vec3> filled = studio.viewport().picture()->frames[0]->colour;
  studio.apply(KeepFill{folder / "fill.ply"});
  REQUIRE(hands.app.settle());
  REQUIRE(studio.document().objects.size() == 2);
  const ObjectItem& fill = studio.document().objects[1];
  CHECK(fill.name == "Fill");
  CHECK_FALSE(fill.tinted);  // no tint over what one wants to look at
  CHECK(studio.document().active == studio.document().objects[0].id);
  const auto kept = studio.labels(fill.id);
  CHECK(kept.size() == before + invented);
  CHECK(count_flags(kept) == invented);
  CHECK(count_flags(*studio.document().deleted) == patch.changes.ghosts.size());
  CHECK_FALSE(studio.view().fill_hole);
  CHECK(studio.view().display == DisplayMode::kHide);
  const Image<glm::vec3>& now = studio.viewport().picture()->frames[0]->colour;
  double error = 0;
  for (std::size_t i = 0; i < now.pixels().size(); ++i)
    error = std::max(error, static_cast<double>(glm::length(now.pixels()[i] - filled.pixels()[i])));
  CHECK(error < 0.05);
  CHECK(load_scene(folder / "fill.ply").cloud.size() == invented);

  CHECK(studio.files().fills_hole_of(studio.document().active));

  hands.app.key('Z', {.ctrl = true});
  REQUIRE(hands.app.settle());
  CHECK(studio.document().objects.size() == 1);
  CHECK_FALSE(studio.document().deleted);
  hands.app.key('Z', {.ctrl = true});
  REQUIRE(hands.app.settle());
  CHECK(studio.document().objects.size() == 1);
  CHECK_FALSE(studio.files().fills_hole_of(studio.document().active));
  CHECK(studio.scene()->cloud->size() == before);
  CHECK(studio.labels(studio.document().active) == object);
  CHECK(std::filesystem::exists(folder / "fill.ply"));
  for (int redone = 0; redone < 2; ++redone) {
    hands.app.key('Y', {.ctrl = true});
    REQUIRE(hands.app.settle());
  }
  CHECK(studio.labels(studio.document().objects[1].id) == kept);

  const std::filesystem::path work = folder / "work.splatcut.json";
  studio.apply(SaveWork{work});
  REQUIRE(hands.app.settle());
  studio.apply(OpenScene{work});
  REQUIRE(hands.app.settle());
  REQUIRE(studio.document().objects.size() == 2);
  CHECK(studio.files().fills_hole_of(studio.document().objects[0].id));
  CHECK_FALSE(studio.files().fills_hole_of(studio.document().objects[1].id));
}

TEST_CASE(
    "hands: a fill that is kept while another file is added stays an object; one of an older hole does not "
    "come") {
  const ScratchFolder folder("fill_and_file");
  Hands hands = hands_on_sample();
  Studio& studio = hands.studio();
  keep_edges(hands);
  press(hands, Action::kFillHole);
  std::filesystem::copy_file(kSmallSample, folder / "other.compressed.ply");
  studio.apply(KeepFill{folder / "fill.ply"});
  REQUIRE(hands.app.frames_until([&] { return studio.files().changing(); }));
  studio.apply(AddScene{folder / "other.compressed.ply"});
  REQUIRE(hands.app.settle());
  REQUIRE(studio.scene()->files.size() == 3);
  REQUIRE(studio.document().objects.size() == 2);
  CHECK(count_flags(studio.labels(studio.document().objects[1].id)) == studio.scene()->files[1].gaussians);

  Hands other = hands_on_sample();
  keep_edges(other);
  press(other, Action::kFillHole);
  other.studio().apply(KeepFill{folder / "late.ply"});
  other.studio().apply(Undo{});  // before it is written
  REQUIRE(other.app.settle());
  CHECK(std::filesystem::exists(folder / "late.ply"));
  CHECK(other.studio().scene()->files.size() == 1);
  CHECK(std::ranges::any_of(other.studio().messages(), [](const Message& m) {
    return m.text.find("is written, but not added") != std::string::npos;
  }));
}
