// Clean edges in the window: when they are computed, and what is shown.
#include <doctest/doctest.h>

#include <algorithm>
#include <string>

#include "app/ui/panels.h"
#include "hands_on_edges.h"

using namespace splatcut;
using namespace splatcut::testing;

TEST_CASE("hands: alone, the object is drawn with clean edges, beside itself as it is, or as it is") {
  Hands hands = hands_on_sample();
  take_what_touches_it(hands);
  const CleanObject clean = cleaned_without_window(hands);
  CAPTURE(clean.report.why_not);
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

TEST_CASE("clean objects: labels that were only asked about are not kept") {
  Hands hands(false);
  CleanObjects clean(std::shared_ptr<const OpenedScene>(std::shared_ptr<void>(), hands.studio().scene()));
  Flags labels = make_flags(std::vector<std::uint8_t>(hands.studio().scene()->cloud->size(), 0));
  const std::weak_ptr<Flags::element_type> seen = labels;
  CHECK_FALSE(clean.known(labels, {0, -1, 0}));
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

TEST_CASE("hands: edges that an export cleaned are shown in the view that waited for it") {
  const ScratchFolder folder("shown_after_export");
  Hands hands = hands_on_sample();
  take_what_touches_it(hands);
  Export order{{ExportWhat::kObject, SceneFormat::kPly, folder / "apple.ply"}};
  order.request.clean_edges = true;
  hands.studio().run(Action::kIsolate);
  CHECK(hands.studio().exports().doing() == "");
  hands.studio().apply(order);  // before the view could ask: the worker is busy with the export
  CHECK(hands.said() == "Exporting apple.ply once edges are clean");
  const std::string coming = hands.said();
  CHECK(hands.app.frames_until([&] { return status_text(hands.studio()).starts_with(coming); }));
  REQUIRE(hands.app.settle());
  CHECK(hands.said().find("apple.ply") != std::string::npos);
  CHECK(hands.studio().messages().back().stays);
  CHECK(hands.studio().exports().doing() == "");
  REQUIRE(std::filesystem::exists(folder / "apple.ply"));
  REQUIRE(hands.studio().clean_edges());
  hands.app.frames(3);
  REQUIRE(hands.app.settle());
  REQUIRE(hands.studio().viewport().clean(0));
  CHECK(hands.studio().viewport().clean(0)->gaussian == cleaned_without_window(hands).gaussian);
}
