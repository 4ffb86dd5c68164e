// Clean edges in the window: when they are computed, what is shown, what was decided of them.
#include <doctest/doctest.h>

#include <algorithm>
#include <string>

#include "hands_on_edges.h"

using namespace splatcut;
using namespace splatcut::testing;

namespace {

// Without the larger half of its Gaussians the apple, alone, looks from no side as in the scene.
void leave_the_small_ones(HeadlessApp& app) {
  const auto labels = app.studio().labels(app.studio().document().active);
  const std::vector<float> size = property_values(*app.studio().scene()->cloud, Property::kSize);
  std::vector<float> own;
  for (std::size_t g = 0; g < size.size(); ++g)
    if (labels[g]) own.push_back(size[g]);
  const auto middle = own.begin() + static_cast<std::ptrdiff_t>(own.size() / 2);
  std::ranges::nth_element(own, middle);
  app.studio().apply(SelectRange{Property::kSize, *middle, 1e9f, SetOperation::kRemove});
  REQUIRE(app.settle());
}

}  // namespace

TEST_CASE("hands: alone, the object is drawn with clean edges, beside itself as it is, or as it is") {
  Hands hands = hands_on_sample();
  take_what_touches_it(hands);
  const CleanObject clean = cleaned_without_window(hands);
  CAPTURE(clean.report.reason);
  REQUIRE(changed(clean.report));
  const ObjectId object = hands.studio().document().active;
  const std::uint64_t document = hands.studio().history().serial();
  const auto drawn = [&](Action action) {
    hands.studio().run(action);
    REQUIRE(hands.app.settle());
    REQUIRE(hands.studio().viewport().picture());
    return hands.studio().viewport().picture()->frames;
  };
  const auto shows = [&](const Frame& frame, const GaussianCloud& cloud, const Flags& shown) {
    const Camera camera = hands.studio().viewport().pane_camera();
    const auto own = raster_frame(cloud, camera, shown, hands.studio().viewport().draw_limits());
    return std::ranges::equal(frame.colour.pixels(), own->colour.pixels());
  };
  const Flags labels = make_flags(hands.studio().labels(object));
  const GaussianCloud& scene = *hands.studio().scene()->cloud;

  auto frames = drawn(Action::kIsolate);
  CHECK(shows(*frames[0], clean.cloud, nullptr));
  CHECK_FALSE(shows(*frames[0], scene, labels));
  const auto& hits = frames[0]->first_hit.pixels();  // of the scene: a click on the picture means these
  CHECK(std::ranges::all_of(
      hits, [&](std::int32_t g) { return g < 0 || std::ranges::binary_search(clean.gaussian, g); }));
  CHECK(std::ranges::any_of(hits, [](std::int32_t g) { return g >= 0; }));

  frames = drawn(Action::kSideBySide);
  REQUIRE(frames.size() == 2);
  CHECK(shows(*frames[0], scene, labels));
  CHECK(shows(*frames[1], clean.cloud, nullptr));

  drawn(Action::kSideBySide);
  CHECK(hands.studio().view().display == DisplayMode::kIsolate);
  frames = drawn(Action::kCleanEdges);
  CHECK(shows(*frames[0], scene, labels));
  CHECK(hands.studio().labels(object) == *labels);
  CHECK(hands.studio().history().serial() == document);
}

TEST_CASE("hands: edges are made clean beforehand while nothing else is to do, and again for other labels") {
  Hands hands(true, working_ahead(), kSample);
  const auto wait = [&] { hands.app.frames(120); };  // two seconds
  const auto isolated = [&] {
    hands.studio().run(Action::kIsolate);
    REQUIRE(hands.app.settle());
    return hands.studio().viewport().clean(0);
  };
  REQUIRE_FALSE(hands.studio().clean_edges());
  wait();
  REQUIRE(hands.app.settle());
  CHECK(hands.studio().clean_edges());  // before anybody asks
  const auto first = isolated();
  REQUIRE(first);
  CHECK(first->gaussian == cleaned_without_window(hands).gaussian);
  CHECK(hands.studio().progress().busy == false);
  hands.studio().apply(EditSelection{SelectionEdit::kShrink});
  REQUIRE(hands.app.settle());
  const auto second = hands.studio().viewport().clean(0);
  const CleanObject again = cleaned_without_window(hands);
  REQUIRE((second != nullptr) == again.report.cleaned);
  if (second) CHECK(second->gaussian == again.gaussian);
  hands.studio().apply(Undo{});
  REQUIRE(hands.app.settle());
  CHECK(hands.studio().viewport().clean(0) == first);
}

TEST_CASE("hands: while a changed object is cleaned anew, what stays of it keeps its clean edges") {
  Hands hands = hands_on_sample();
  take_what_touches_it(hands);
  hands.app.key('I');
  REQUIRE(hands.app.settle());
  const auto first = hands.studio().viewport().clean(0);
  REQUIRE(first);
  REQUIRE(first->report.left > 0);
  const Flags before = hands.studio().viewport().active_labels();
  hands.studio().apply(EditSelection{SelectionEdit::kGrow});
  for (int i = 0; i < 3000 && hands.studio().viewport().active_labels() == before; ++i) hands.app.frames(1);
  const Flags now = hands.studio().viewport().active_labels();
  REQUIRE(count_flags(*now) > count_flags(*before));
  const auto meanwhile = hands.studio().viewport().clean(0);
  REQUIRE(meanwhile);
  CHECK_FALSE(meanwhile->report.cleaned);
  std::vector<std::uint32_t> expected = first->gaussian;
  for (std::uint32_t g = 0; g < now->size(); ++g)
    if ((*now)[g] && !(*before)[g]) expected.push_back(g);
  std::ranges::sort(expected);
  CHECK(meanwhile->gaussian == expected);
  const GaussianCloud& scene = *hands.studio().scene()->cloud;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    const auto old = std::ranges::lower_bound(first->gaussian, expected[i]);
    const bool stays = old != first->gaussian.end() && *old == expected[i];
    const GaussianCloud& from = stays ? first->cloud : scene;
    const std::size_t row = stays ? static_cast<std::size_t>(old - first->gaussian.begin()) : expected[i];
    REQUIRE(meanwhile->cloud.position[i] == from.position[row]);
    REQUIRE(meanwhile->cloud.scale[i] == from.scale[row]);
  }
  REQUIRE(hands.app.settle());
  const auto second = hands.studio().viewport().clean(0);
  REQUIRE(second != meanwhile);
  if (second) CHECK(second->report.cleaned);
}

TEST_CASE("hands: edges that the guard keeps are cleaned anyway by a button, shown and exported so") {
  const ScratchFolder folder("anyway");
  Hands hands = hands_on_sample();
  leave_the_small_ones(hands.app);
  const std::size_t labelled = hands.selected();
  hands.app.key('I');
  REQUIRE(hands.app.settle());
  hands.app.frames(2);
  const auto before = hands.studio().clean_edges();
  REQUIRE(before);
  REQUIRE_FALSE(before->cleaned);
  REQUIRE(before->views > 0);
  CHECK_FALSE(hands.studio().viewport().clean(0));
  const UiRect button = hands.app.button("Clean anyway");
  REQUIRE(button.size().x > 0);
  hands.app.click(0.5f * (button.min + button.max));
  REQUIRE(hands.app.settle());
  const auto clean = hands.studio().viewport().clean(0);
  REQUIRE(clean);
  CHECK(clean->report.forced);
  const OpenedScene& scene = *hands.studio().scene();
  const CleanObject expected =
      clean_object({*scene.cloud, hands.studio().labels(hands.studio().document().active),
                    hands.studio().document().up_world, scene.views().cameras, false, true});
  CHECK(clean->gaussian == expected.gaussian);
  CHECK(clean->cloud.position == expected.cloud.position);
  hands.studio().apply(
      Export{{ExportWhat::kObject, SceneFormat::kPly, folder / "anyway.ply", false, {}, true}});
  REQUIRE(hands.app.settle());
  CHECK(load_scene(folder / "anyway.ply").cloud.size() == expected.cloud.size());
  CHECK(hands.said().find("edges cleaned anyway") != std::string::npos);
  hands.studio().apply(Export{{ExportWhat::kRest, SceneFormat::kPly, folder / "rest.ply", false, {}, true}});
  REQUIRE(hands.app.settle());
  CHECK(hands.said().find("edges cleaned anyway") != std::string::npos);
  SaveTurntable turn{.path = folder / "turn", .frames = 2, .clean_edges = true};
  turn.width_px = turn.height_px = 64;
  hands.studio().apply(turn);
  REQUIRE(hands.app.settle());
  CHECK(hands.said().find("edges cleaned anyway") != std::string::npos);
  // Other labels are another question.
  hands.studio().apply(EditSelection{SelectionEdit::kShrink});
  REQUIRE(hands.app.settle());
  hands.app.frames(2);
  const auto after = hands.studio().clean_edges();
  REQUIRE(after);
  REQUIRE_FALSE(after->cleaned);
  CHECK_FALSE(after->forced);
  CHECK(hands.selected() != labelled);
}

TEST_CASE("hands: what the guard says and its button fit into a small window") {
  HeadlessApp app(640, 480);
  app.interface_state().hint_wanted = false;
  app.open(kSample);
  REQUIRE(app.settle());
  app.click(app.screen_of(kOnApple));
  REQUIRE(app.settle());
  leave_the_small_ones(app);
  app.key('I');
  app.wait_for_message_to_go();
  REQUIRE(app.studio().clean_edges());
  REQUIRE_FALSE(app.studio().clean_edges()->cleaned);
  const UiRect button = app.button("Clean anyway"), view = app->interface().viewport();
  REQUIRE(button.size().x > 0);
  CHECK(button.min.x >= view.min.x);
  CHECK(button.max.x <= view.max.x);
  app.click(0.5f * (button.min + button.max));
  REQUIRE(app.settle());
  REQUIRE(app.studio().clean_edges());
  CHECK(app.studio().clean_edges()->forced);
}

TEST_CASE("hands: edges are cleaned anew where up changes") {
  Hands hands = hands_on_sample();
  hands.app.key('I');
  REQUIRE(hands.app.settle());
  hands.app.frames(2);
  const auto before = hands.studio().viewport().clean(0);
  REQUIRE(before);
  const glm::vec3& up = hands.studio().document().up_world;
  hands.studio().apply(SetUp{glm::normalize(up + glm::vec3(0.3f, 0, 0.2f))});
  REQUIRE(hands.app.settle());
  hands.app.frames(2);
  REQUIRE(hands.app.settle());
  REQUIRE(hands.studio().viewport().clean(0));
  CHECK(hands.studio().viewport().clean(0) != before);
}

TEST_CASE("hands: to clean anyway is decided while the worker finds out that edges stay") {
  Hands hands = hands_on_sample();
  leave_the_small_ones(hands.app);
  hands.app.key('I');
  REQUIRE(hands.app.frames_until([&] { return hands.studio().progress().kind == TaskKind::kClean; }));
  hands.studio().apply(CleanAnyway{});
  REQUIRE(hands.app.settle());
  hands.app.frames(2);
  REQUIRE(hands.studio().viewport().clean(0));
  CHECK(hands.studio().viewport().clean(0)->report.forced);
}

TEST_CASE("hands: what was decided of edges outlives files that are added and taken out") {
  Hands hands = hands_on_sample();
  leave_the_small_ones(hands.app);
  hands.app.key('I');
  hands.studio().apply(CleanAnyway{});
  REQUIRE(hands.app.settle());
  const auto forced = [&] {
    REQUIRE(hands.app.settle());
    hands.app.frames(120);
    REQUIRE(hands.app.settle());
    const auto clean = hands.studio().clean_edges();
    return clean && clean->forced;
  };
  CHECK(forced());
  hands.studio().apply(AddScene{.path = kSmallSample});
  CHECK(forced());
  hands.studio().apply(Undo{});
  CHECK(forced());
  hands.studio().apply(Redo{});
  CHECK(forced());
  hands.studio().apply(RemoveScene{hands.studio().scene()->files.back().id});
  CHECK(forced());
}

TEST_CASE("clean objects: so many decisions are kept, and equal labels are one") {
  Hands hands(false);
  CleanObjects clean(std::shared_ptr<const OpenedScene>(std::shared_ptr<void>(), hands.studio().scene()));
  std::vector<std::uint8_t> labels(hands.studio().scene()->cloud->size(), 0);
  const auto numbered = [&](std::size_t i) {
    std::vector<std::uint8_t> one = labels;
    one[i] = 1;
    return make_flags(std::move(one));
  };
  for (std::size_t i = 0; i < CleanObjects::kMostDecisions; ++i) clean.clean_anyway(numbered(i));
  clean.clean_anyway(numbered(0));
  CHECK(clean.decisions().size() == CleanObjects::kMostDecisions);
  clean.clean_anyway(numbered(CleanObjects::kMostDecisions));
  CHECK(clean.decisions().size() == CleanObjects::kMostDecisions);
  CHECK(clean.is_cleaned_anyway(numbered(0)));
  CHECK_FALSE(clean.is_cleaned_anyway(numbered(1)));
  CHECK(clean.is_cleaned_anyway(numbered(2)));
}

TEST_CASE("clean objects: labels that were only asked about are not kept") {
  Hands hands(false);
  CleanObjects clean(std::shared_ptr<const OpenedScene>(std::shared_ptr<void>(), hands.studio().scene()));
  Flags labels = make_flags(std::vector<std::uint8_t>(hands.studio().scene()->cloud->size(), 0));
  const std::weak_ptr<Flags::element_type> seen = labels;
  CHECK_FALSE(clean.is_cleaned_anyway(labels));
  labels.reset();
  CHECK(seen.expired());
}

TEST_CASE("hands: how many Gaussians clean edges leave out of an export is known before") {
  const ScratchFolder folder("left_out");
  Hands hands = hands_on_sample();
  take_what_touches_it(hands);
  hands.app.key('I');  // shown alone, it is cleaned
  REQUIRE(hands.app.settle());
  const std::optional<CleanReport> clean = hands.studio().clean_edges();
  REQUIRE(clean);
  CHECK(clean->left > 0);
  CHECK(clean->left == cleaned_without_window(hands).report.left);
}
