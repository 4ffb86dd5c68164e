// The one door to a cut: the same labels whatever was cut before, requests told apart, and a heat map of
// what was weighed.
#include <doctest/doctest.h>

#include <algorithm>
#include <chrono>
#include <set>

#include "app/measure/robot_user.h"
#include "segment/masks/mask_tools.h"
#include "small_table.h"

using namespace splatcut;
using namespace splatcut::testing;

TEST_CASE("session: kept steps, flow and other objects before it change no label") {
  Session session = fresh_session();
  std::vector<Asked> steps;
  Asked a = click_on("apple"), m = click_on("mug");
  steps.push_back(a);
  a.settings.smoothness = 30;
  steps.push_back(a);
  steps.push_back(m);
  a.request.strokes.push_back(stroke_from_behind("apple", SeedLabel::kRest));
  steps.push_back(a);
  a.settings.smoothness = 0.05f;
  steps.push_back(a);
  m.request.left_out = {fresh_session().cut(m.request, m.settings).views.at(1).camera};
  steps.push_back(m);
  Asked code = click_on("apple");
  code.settings = preset("paper-code");
  steps.push_back(code);
  code.settings.smoothness = 0.7f;
  steps.push_back(code);
  a.settings.smoothness.reset();
  steps.push_back(a);
  for (std::size_t i = 0; i < steps.size(); ++i) {
    CAPTURE(i);
    // Cancelled on the way, sooner or later: that must leave no trace either.
    std::stop_source stop;
    Job cancelled;
    cancelled.stop = stop.get_token();
    std::size_t snapshots = 0;
    const auto stop_soon = [&](CutPhase, const CutResult&) {
      if (snapshots++ == i % 3) stop.request_stop();
    };
    cancelled.on_progress = [&](std::string_view stage, double) {
      if (stage == "cut") stop.request_stop();
    };
    const auto& [request, settings] = steps[i];
    session.cut(request, settings, cancelled, stop_soon);
    const CutResult kept = session.cut(request, settings);
    REQUIRE(kept.outcome == Outcome::kDone);
    CHECK(std::ranges::count(kept.labels, 1) > 0);
    CHECK(kept.labels == fresh_session().cut(request, settings).labels);
  }
}

TEST_CASE("session: without neighbours the heat map decides every label, corrections and all") {
  auto [request, settings] = click_on("apple");
  settings.smoothness = 0;  // label = w > 1/2, but for what the trimming takes
  for (const bool corrected : {false, true}) {
    CAPTURE(corrected);
    if (corrected) request.strokes.push_back(stroke_from_behind("apple", SeedLabel::kRest));
    Session session = fresh_session();
    const CutResult report = session.cut(request, settings);
    REQUIRE(report.outcome == Outcome::kDone);
    if (corrected) {
      CHECK(std::ranges::any_of(report.views, [&](const ViewReport& view) {
        return glm::distance(view.camera.centre_world(), request.strokes.back().camera.centre_world()) <
               1e-4f;
      }));
    }
    const std::vector<float> w = session.likelihood_of(request, settings);
    REQUIRE(w.size() == report.labels.size());
    std::size_t object = 0, wrong = 0, trimmed = 0;
    for (std::size_t g = 0; g < w.size(); ++g) {
      constexpr float kRounding = 1e-5f;
      object += report.labels[g];
      wrong += report.labels[g] ? w[g] < 0.5f - kRounding : 0;
      trimmed += !report.labels[g] && w[g] > 0.5f + kRounding;
    }
    MESSAGE(object << " object, " << trimmed << " trimmed");
    CHECK(object > 100);
    CHECK(wrong == 0);
    CHECK(10 * trimmed < object);
  }
}

TEST_CASE("session: a view that comes again is known again, whatever comes in between") {
  const auto [request, settings] = click_on("apple");
  const StrokedView behind = stroke_from_behind("apple", SeedLabel::kRest);
  const StrokedView first = request.strokes.front();
  StrokedView again = first;
  again.strokes = {click(first.strokes.front().points_px.front() + glm::vec2(30, -20), SeedLabel::kRest)};
  StrokedView both = first;
  both.strokes.push_back(again.strokes.front());
  again.camera.camera_from_world_translation *= 1 + 1e-6f;  // as it comes out of a file
  CutRequest in_turns, by_view;
  in_turns.strokes = {first, behind, again};
  by_view.strokes = {both, behind};
  CHECK(strokes_by_view(in_turns.strokes).size() == 2);
  CutRequest exact = in_turns;
  exact.strokes.back().camera = first.camera;
  CHECK(fresh_session().cut(in_turns, settings).labels == fresh_session().cut(exact, settings).labels);
  CHECK(key_of(in_turns) != key_of(by_view));
}

TEST_CASE("session: a view is left out by its camera, one that is not looked at changes nothing") {
  auto [request, settings] = click_on("mug");
  settings.settled_views = 12;  // the orbit is looked at whole
  Session session = fresh_session();
  const CutResult all = session.cut(request, settings);
  REQUIRE(all.views.size() > 3);
  request.left_out = {small_table().scene.cameras[3]};  // none of the orbit's
  CHECK(session.cut(request, settings).labels == all.labels);
  request.left_out.push_back(all.views[2].camera);
  const CutResult without = session.cut(request, settings);
  REQUIRE(without.views.size() == all.views.size());
  CHECK_FALSE(without.views[2].used);
  CHECK(without.views[2].reason == "left out");
  for (const std::size_t v : {1u, 3u}) CHECK(without.views[v].used == all.views[v].used);
}

// Half of the mug is no part of the scene, nothing stands out at its border: masks alone say it.
TEST_CASE("session: one given mask is kept in its own view, whatever parts there are") {
  const SmallTable& t = small_table();
  const Camera& camera = t.scene.cameras[0];
  const auto mug = std::ranges::find(t.scene.label_name, "mug") - t.scene.label_name.begin();
  std::vector<std::uint8_t> whole(t.cloud->size());
  for (std::size_t g = 0; g < whole.size(); ++g) whole[g] = t.scene.label[g] == mug;
  Mask upper = thresholded(render_labels({*t.cloud, nullptr}, camera, whole), 0.5f);
  const PixelRect box = bounds(upper);
  for (int y = (box.y0 + box.y1) / 2; y < upper.height(); ++y)
    for (int x = 0; x < upper.width(); ++x) upper.at(x, y) = 0;
  CutRequest request;
  request.first_mask = {camera, upper};
  const CutResult cut = fresh_session().cut(request, preset("default"));
  const double kept = iou(upper, thresholded(render_labels({*t.cloud, nullptr}, camera, cut.labels), 0.5f));
  MESSAGE("image IoU with the given mask: " << kept);
  CHECK(kept > 0.95);
}

TEST_CASE("session: what shines through a masked object from behind is not taken for it") {
  const SmallTable& t = small_table();
  const Camera& camera = t.scene.cameras[0];
  const auto mug = std::ranges::find(t.scene.label_name, "mug") - t.scene.label_name.begin();
  GaussianCloud faint = *t.cloud;
  std::vector<std::uint8_t> whole(faint.size());
  for (std::size_t g = 0; g < whole.size(); ++g) {
    whole[g] = t.scene.label[g] == mug;
    if (whole[g]) faint.opacity[g] *= 0.2f;
  }
  CutRequest request;
  request.first_mask = {camera, thresholded(render_labels({*t.cloud, nullptr}, camera, whole), 0.5f)};
  Session session({.cloud = std::make_shared<const GaussianCloud>(faint), .photographs = t.scene.cameras});
  const CutResult cut = session.cut(request, preset("default"));
  std::size_t taken = 0;
  for (std::size_t g = 0; g < whole.size(); ++g) taken += cut.labels[g] && !whole[g];
  MESSAGE("of the rest taken: " << taken << " of " << whole.size());
  CHECK(taken < 150);  // 396 where it is pinned, too
}

TEST_CASE("session: given masks of several views mean what they show, whatever parts there are") {
  const SmallTable& t = small_table();
  const auto mug = std::ranges::find(t.scene.label_name, "mug") - t.scene.label_name.begin();
  glm::vec3 middle(0);
  float count_of_mug = 0;
  for (std::size_t g = 0; g < t.scene.label.size(); ++g)
    if (t.scene.label[g] == mug) middle += t.cloud->position[g], ++count_of_mug;
  middle /= count_of_mug;
  std::vector<std::uint8_t> half(t.cloud->size());
  for (std::size_t g = 0; g < half.size(); ++g)
    half[g] = t.scene.label[g] == mug && t.cloud->position[g].y < middle.y;
  CutRequest request;
  for (const std::size_t v : {0u, 2u, 4u, 6u}) {
    GivenView given{t.scene.cameras[v], {}};
    given.mask = thresholded(render_labels({*t.cloud, nullptr}, given.camera, half), 0.5f);
    if (request.first_mask)
      request.masks.push_back(std::move(given));
    else
      request.first_mask = std::move(given);
  }
  const CutResult cut = fresh_session().cut(request, preset("default"));
  REQUIRE(cut.outcome == Outcome::kDone);
  const Camera& left_out = t.scene.cameras[1];
  const Mask truth = thresholded(render_labels({*t.cloud, nullptr}, left_out, half), 0.5f);
  const Mask seen = thresholded(render_labels({*t.cloud, nullptr}, left_out, cut.labels), 0.5f);
  MESSAGE("image IoU in a view that was not given: " << iou(truth, seen));
  CHECK(iou(truth, seen) > 0.95);
}

TEST_CASE("session: what marks nothing is an outcome, from parts and from pixels alike") {
  for (const bool parts : {true, false}) {
    CAPTURE(parts);
    CutSettings settings;
    settings.first_mask_from = parts ? FirstMaskFrom::kParts : FirstMaskFrom::kPixels;
    settings.orbit.views = 0;
    Session session = fresh_session();
    CutRequest request;
    const auto nothing = [&] {
      const CutResult result = session.cut(request, settings);
      CHECK(result.outcome == Outcome::kNothingFound);
      CHECK(std::ranges::count(result.labels, 1) == 0);
      return result.reason;
    };
    CHECK(nothing().starts_with("no stroke marks the object"));
    request.strokes = {{small_table().scene.cameras[0], {click({5, 5}, SeedLabel::kRest)}}};
    CHECK(nothing().starts_with("no stroke marks the object"));
    request.strokes = {{small_table().scene.cameras[0], {click({-500, -500}, SeedLabel::kObject)}}};
    CHECK(nothing().starts_with("the strokes mark nothing"));
    const Camera& camera = small_table().scene.cameras[0];
    request.first_mask = {camera, Mask(camera.width_px, camera.height_px)};
    CHECK(nothing() == "the mask covers nothing of the scene");
  }
}

TEST_CASE("session: keys of two requests differ where anything that is said does") {
  const CutRequest base = click_on("mug").request;
  const Camera& camera = small_table().scene.cameras[2];
  std::vector<CutRequest> requests(9, base);
  requests[1].strokes.push_back(requests[1].strokes.front());
  requests[2].strokes.push_back({requests[2].strokes.front().camera, {}});
  requests[3].left_out = {camera};
  requests[4].views = {camera};
  requests[5].masks = {{camera, Mask(4, 3)}};
  requests[6].first_mask = {camera, Mask(4, 3)};
  requests[7].up_world = glm::vec3(0, -1, 0);
  requests[8].among = std::make_shared<const std::vector<std::uint8_t>>(small_table().cloud->size(), 1);
  requests.push_back(base);
  first_stroke(&requests.back().strokes)->size_step = 1;
  const StrokedView& clicked = base.strokes.front();
  requests.push_back(base);
  requests.back().strokes = {{clicked.camera, {{SeedLabel::kObject, 2, {{5, 5}, {90, 70}}}}}};
  requests.push_back(base);
  requests.back().strokes = {{clicked.camera, {box_around({5, 5}, {90, 70}, SeedLabel::kObject)}}};
  std::set<std::string> keys;
  for (const CutRequest& request : requests) keys.insert(key_of(request));
  CHECK(keys.size() == requests.size());
}

TEST_CASE("session: among some of the Gaussians a request is answered as in a scene of these alone") {
  const LabelledScene& scene = small_table().scene;
  const auto apple = std::ranges::find(scene.label_name, "apple") - scene.label_name.begin();
  std::vector<std::uint8_t> set(scene.label.size());
  std::ranges::transform(scene.label, set.begin(), [&](auto label) { return label != apple; });
  std::vector<std::uint32_t> rows;
  for (std::uint32_t g = 0; g < set.size(); ++g)
    if (set[g]) rows.push_back(g);
  REQUIRE(rows.size() < set.size());
  Session session = fresh_session(),
          alone({.cloud = std::make_shared<const GaussianCloud>(permuted(*small_table().cloud, rows)),
                 .photographs = scene.cameras});
  const auto in_scene = [&](const auto& local) {
    auto all = std::remove_cvref_t<decltype(local)>(set.size(), 0);
    for (std::size_t i = 0; i < rows.size(); ++i) all[rows[i]] = local[i];
    return all;
  };
  auto [request, settings] = click_on("mug");
  CutRequest among = request;
  among.among = std::make_shared<const std::vector<std::uint8_t>>(set);
  const CutResult there = alone.cut(request, settings);
  REQUIRE(std::ranges::count(there.labels, 1) > 0);
  const CutResult here = session.cut(among, settings, {}, [&](CutPhase, const CutResult& so_far) {
    REQUIRE(so_far.labels.size() == set.size());
  });
  CHECK(here.labels == in_scene(there.labels));
  CHECK(here.prior == in_scene(there.prior));
  CHECK(session.likelihood_of(among, settings) == in_scene(alone.likelihood_of(request, settings)));
  CHECK(session.first_mask(among, settings) == alone.first_mask(request, settings));
  const StrokedView behind = stroke_from_behind("apple", SeedLabel::kObject);  // what stands behind it
  const CameraStroke next{behind.camera, behind.strokes.front()};
  CHECK(session.preview(among, next, settings).after ==
        in_scene(alone.preview(request, next, settings).after));

  // Strokes that see some of these alone see the same of them; what sees none of them is nowhere.
  std::vector<std::uint8_t> half(set.size()), half_there;
  for (std::size_t g = 0; g < half.size(); ++g) half[g] = g % 2;
  for (const std::uint32_t row : rows) half_there.push_back(half[row]);
  CutRequest half_seen = request;
  among.strokes.front().seen = std::make_shared<const std::vector<std::uint8_t>>(half);
  half_seen.strokes.front().seen = std::make_shared<const std::vector<std::uint8_t>>(half_there);
  CHECK(session.cut(among, settings).labels == in_scene(alone.cut(half_seen, settings).labels));
  std::vector<std::uint8_t> others(set.size());
  for (std::size_t g = 0; g < others.size(); ++g) others[g] = !set[g];
  among.strokes.front().seen = std::make_shared<const std::vector<std::uint8_t>>(others);
  CHECK(session.cut(among, settings).outcome == Outcome::kNothingFound);

  // All of them, or none, are no scene of their own.
  among = request;
  among.among = std::make_shared<const std::vector<std::uint8_t>>(set.size(), 1);
  CHECK(session.cut(among, settings).labels == fresh_session().cut(request, settings).labels);
}
