// The one door to a cut: the same labels whatever was cut before, requests told apart, and a heat map of
// what was weighed.
#include "segment/session/session.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <chrono>
#include <set>

#include "app/measure/robot_user.h"
#include "scene/still_life/still_life.h"
#include "segment/masks/mask_tools.h"
#include "segment/session/doubts.h"
#include "segment/superpoints/orbit.h"

using namespace splatcut;

namespace {

struct SmallTable {
  LabelledScene scene;
  std::shared_ptr<const GaussianCloud> cloud;
};

const SmallTable& small_table() {
  static const SmallTable made = [] {
    SmallTable t;
    StillLifeOptions options;
    options.gaussians = 25000;
    t.scene = make_still_life(options);
    t.cloud = std::make_shared<const GaussianCloud>(t.scene.cloud);
    return t;
  }();
  return made;
}

Session fresh_session() {
  return Session({.cloud = small_table().cloud, .photographs = small_table().scene.cameras});
}

CutSettings with_views_around() {
  CutSettings settings = preset("default");
  settings.orbit.views = kViewsAround;
  return settings;
}

// An object's request and settings.
struct Asked {
  CutRequest request;
  CutSettings settings = with_views_around();
};

Asked click_on(const std::string& object) {
  const LabelledScene& scene = small_table().scene;
  const auto seed = std::ranges::find(scene.seeds, object, &LabelledScene::SeedClick::object);
  REQUIRE(seed != scene.seeds.end());
  Asked asked;
  asked.request.strokes = {
      {scene.cameras[static_cast<std::size_t>(seed->camera)], {click(seed->pixel, SeedLabel::kObject)}}};
  return asked;
}

// A stroke on the object from the other side of the table.
StrokedView stroke_from_behind(const std::string& object, SeedLabel label) {
  const LabelledScene& scene = small_table().scene;
  const auto number = std::ranges::find(scene.label_name, object) - scene.label_name.begin();
  glm::vec3 middle(0);
  float count = 0;
  for (std::size_t g = 0; g < scene.label.size(); ++g)
    if (scene.label[g] == number) middle += scene.cloud.position[g], ++count;
  const Camera& camera = scene.cameras[5];
  const glm::vec2 at = camera.pixel_from_camera(camera.camera_from_world(middle / count));
  return {camera, {Stroke{label, 6, {at - glm::vec2(12, 0), at + glm::vec2(12, 0)}}}};
}

}  // namespace

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

TEST_CASE("session: a box around each thing of the table means the thing, in a neighbourhood of it") {
  const LabelledScene& scene = small_table().scene;
  Session session({.cloud = small_table().cloud, .photographs = scene.cameras, .most_gaussians = 12000});
  CutSettings settings;
  for (const char* name : {"mug", "apple", "orange", "plant", "pot", "books"}) {
    CAPTURE(name);
    const auto number = std::ranges::find(scene.label_name, name) - scene.label_name.begin();
    std::vector<std::uint8_t> truth(scene.label.size());
    for (std::size_t g = 0; g < truth.size(); ++g) truth[g] = scene.label[g] == number;
    const auto seen = [&](const std::vector<std::uint8_t>& labels) {
      return thresholded(render_labels({scene.cloud}, scene.cameras[0], labels, {}), 0.5f);
    };
    CutRequest request;
    request.strokes = {{scene.cameras[0], {*robot_box(seen(truth), 0.05f)}}};
    const CutResult result = session.cut(request, settings);
    REQUIRE(result.outcome == Outcome::kDone);
    CHECK(result.looked_at_gaussians < scene.cloud.size());
    CHECK(iou(seen(truth), seen(result.labels)) > 0.9);
  }
}

TEST_CASE("session: sizes are the last stroke's, and of one that hits nothing there are none") {
  const auto session_of_cells = [] {
    return Session({.cloud = small_table().cloud,
                    .photographs = small_table().scene.cameras,
                    .most_gaussians = small_table().cloud->size() / 3});
  };
  auto [request, settings] = click_on("mug");
  Session session = session_of_cells();
  const StrokedView clicked = request.strokes.front();
  const CutResult first = session.cut(request, settings);
  CHECK(first.sizes > 1);
  const auto with = [&](const glm::vec2& pixel, int size_step) {
    CutRequest more = request;
    more.strokes.push_back({clicked.camera, {click(pixel, SeedLabel::kRest)}});
    last_stroke(&more.strokes)->size_step = size_step;
    return more;
  };
  const CutResult missed = session.cut(with({5, 5}, 0), settings);
  CHECK(missed.labels == first.labels);
  CHECK(missed.sizes == 0);
  CHECK(missed.size_masks.empty());
  // Nor at a pixel that was clicked in another view.
  CutRequest elsewhere = with(clicked.strokes.front().points_px.front() + glm::vec2(25, 15), 0);
  REQUIRE(session.cut(elsewhere, settings).sizes > 1);
  Camera away = clicked.camera;
  away.camera_from_world_translation.x += 40;
  elsewhere.strokes.push_back({away, elsewhere.strokes.back().strokes});
  CHECK(session.cut(elsewhere, settings).sizes == 0);
  const glm::vec2 on_it = clicked.strokes.front().points_px.front() + glm::vec2(25, 15);
  const CutResult corrected = session.cut(with(on_it, 0), settings);
  REQUIRE(corrected.sizes > 1);
  CHECK(corrected.size_masks.size() == corrected.sizes);
  CHECK(corrected.size == corrected.likeliest_size);
  const int step = corrected.size + 1 < corrected.sizes ? 1 : -1;
  const CutResult other = session.cut(with(on_it, step), settings);
  CHECK(other.size == corrected.size + static_cast<std::size_t>(step));
  CHECK(other.sizes == corrected.sizes);
  CHECK((std::ranges::count(other.labels, 1) < std::ranges::count(corrected.labels, 1)) == (step > 0));
  CHECK(other.labels == session_of_cells().cut(with(on_it, step), settings).labels);
}

TEST_CASE("session: a place that grows finds the sizes of all strokes again, as what they change there") {
  const LabelledScene& scene = small_table().scene;
  Session session(
      {.cloud = small_table().cloud, .photographs = scene.cameras, .most_gaussians = scene.cloud.size() / 3});
  CutSettings settings = preset("default");
  settings.parts_only = true;
  for (const auto& [first, third] : {std::pair{"pot", "lamp"}, {"pot", "books"}, {"orange", "lamp"}}) {
    CAPTURE(first);
    CAPTURE(third);
    CutRequest request = click_on(first).request;
    request.strokes.push_back(click_on("apple").request.strokes.front());
    int& step = last_stroke(&request.strokes)->size_step;
    step = 3;
    CutResult two = session.cut(request, settings);
    while (two.looked_at_gaussians == scene.cloud.size() && --step > 0) two = session.cut(request, settings);
    REQUIRE(step > 0);
    CHECK(two.size == two.likeliest_size + static_cast<std::size_t>(step));  // as the wheel counts
    request.strokes.push_back(click_on(third).request.strokes.front());
    const CutResult three = session.cut(request, settings);
    REQUIRE(three.looked_at_gaussians > two.looked_at_gaussians);
    const auto name = std::ranges::find(scene.label_name, third) - scene.label_name.begin();
    std::size_t lost = 0, more = 0;
    for (std::size_t g = 0; g < scene.cloud.size(); ++g) {
      lost += two.labels[g] && !three.labels[g];
      more += !two.labels[g] && three.labels[g] && scene.label[g] != name;
    }
    MESSAGE("step ", step, ": ", lost, " lost, ", more, " more");
    CHECK(lost < 200);  // of some 2400
    CHECK(more < 400);
  }
}

TEST_CASE("session: sizes are of what was made last, whatever is applied last") {
  auto [request, settings] = click_on("mug");
  Session session = fresh_session();
  const CutResult alone = session.cut(request, settings);
  // Beside it, before it: applied after it, and nothing to change.
  CutRequest both = request;
  both.strokes.insert(both.strokes.begin(),
                      {request.strokes.front().camera, {click({40, 40}, SeedLabel::kRest)}});
  CHECK(session.cut(both, settings).sizes == alone.sizes);
  CHECK(last_stroke(both.strokes) == first_stroke(both.strokes));
  last_stroke(&both.strokes)->size_step = first_stroke(&request.strokes)->size_step = -1;
  CHECK(session.cut(both, settings).labels == session.cut(request, settings).labels);
}

TEST_CASE("session: a cut of small reach is the same, or ends where it would prepare more than that") {
  const LabelledScene& scene = small_table().scene;
  const auto session_of = [&](std::size_t most_gaussians) {
    return Session({.cloud = small_table().cloud,
                    .photographs = scene.cameras,
                    .most_gaussians = most_gaussians,
                    .most_ahead = most_gaussians});
  };
  auto [request, settings] = click_on("mug");
  Session session = session_of(scene.cloud.size() / 3), all = session_of(scene.cloud.size());
  CHECK(session.cut(request, settings, {}, {}, CutReach::kSmall).labels ==
        session_of(scene.cloud.size() / 3).cut(request, settings).labels);
  first_stroke(&request.strokes)->size_step = 40;  // the table and all on it
  CHECK(session.cut(request, settings, {}, {}, CutReach::kSmall).outcome == Outcome::kCancelled);
  const CutResult far = session.cut(request, settings);
  CHECK(far.outcome == Outcome::kDone);
  CHECK(far.looked_at_gaussians > scene.cloud.size() / 3);
  CHECK(far.labels == session_of(scene.cloud.size() / 3).cut(request, settings).labels);  // no trace is left
  // What is prepared already costs nothing, however large.
  CHECK(session.cut(request, settings, {}, {}, CutReach::kSmall).labels == far.labels);
  CHECK(all.cut(request, settings, {}, {}, CutReach::kSmall).outcome == Outcome::kDone);
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

TEST_CASE("session: a preview is what the next click makes of the parts, and leaves no trace") {
  auto [request, settings] = click_on("mug");
  settings.parts_only = true;
  settings.join_enclosed = false;
  Session session = fresh_session();
  const StrokedView behind = stroke_from_behind("apple", SeedLabel::kObject);
  const CameraStroke next{behind.camera, click(behind.strokes.front().points_px.front(), SeedLabel::kObject)};
  CutRequest nothing, told = request;
  told.strokes.push_back({next.camera, {next.stroke}});
  const CameraStroke first{request.strokes.front().camera, request.strokes.front().strokes.front()};
  const Session::Preview before_all = session.preview(nothing, first, settings);
  CHECK(std::ranges::count(before_all.before, 1) == 0);
  CHECK(before_all.after == fresh_session().cut(request, settings).labels);
  const Session::Preview preview = session.preview(request, next, settings);
  CHECK(preview.before == before_all.after);
  CHECK(preview.after == fresh_session().cut(told, settings).labels);
  CHECK(preview.after != preview.before);
  CHECK(session.cut(request, settings).labels == preview.before);
  CHECK(session.cut(told, settings).labels == preview.after);
  std::stop_source stop;
  stop.request_stop();
  CHECK(fresh_session()
            .preview(request, next, settings, {.stop = stop.get_token(), .on_progress = {}})
            .after.empty());
}

TEST_CASE("session: what a click needs and is made ready is not made again") {
  const auto [request, settings] = click_on("mug");
  const CameraStroke first{request.strokes.front().camera, request.strokes.front().strokes.front()};
  Session session = fresh_session();
  session.make_ready(first, settings);
  std::set<std::string, std::less<>> stages;
  const Job watched{.stop = {},
                    .on_progress = [&](std::string_view stage, double) { stages.emplace(stage); }};
  CHECK(session.cut(request, settings, watched).labels == fresh_session().cut(request, settings).labels);
  CHECK(stages.contains("first mask"));
  CHECK_FALSE(stages.contains("parts"));
  CHECK_FALSE(stages.contains("graph"));
}

TEST_CASE("session: the stages of a cut hold what every place has cost that it prepared, once") {
  auto [request, settings] = click_on("mug");
  first_stroke(&request.strokes)->size_step = 40;  // more than the first place
  const auto cloud = small_table().cloud;
  Session session(
      {.cloud = cloud, .photographs = small_table().scene.cameras, .most_gaussians = cloud->size() / 3});
  double between_ms = 0, last_done = 0;  // between two callbacks of one place
  auto last = std::chrono::steady_clock::now();
  const Job watched{.stop = {}, .on_progress = [&](std::string_view stage, double done) {
                      if (stage != "parts") return;
                      if (done > last_done) between_ms += ms_since(last);
                      last = std::chrono::steady_clock::now();
                      last_done = done;
                    }};
  const auto parts_ms = [&](const Job& job) {
    const CutResult result = session.cut(request, settings, job);
    CHECK(result.looked_at_gaussians > cloud->size() / 3);
    const auto found = std::ranges::find(result.stages, "parts", &StageTime::name);
    return found == result.stages.end() ? 0 : found->ms;
  };
  CHECK(parts_ms(watched) >= between_ms);
  CHECK(between_ms > 0);
  CHECK(parts_ms({}) == 0);
}

TEST_CASE("session: things of one colour that touch are parted by three corrections") {
  StillLifeOptions options;
  options.gaussians = 40000;
  options.contact = options.low_contrast = true;
  const LabelledScene scene = make_still_life(options);
  const auto cloud = std::make_shared<const GaussianCloud>(scene.cloud);
  Session session({.cloud = cloud, .photographs = scene.cameras});
  for (const std::string name : {"apple", "mug", "orange"}) {
    CAPTURE(name);
    const auto seed = std::ranges::find(scene.seeds, name, &LabelledScene::SeedClick::object);
    const Camera& camera = scene.cameras[static_cast<std::size_t>(seed->camera)];
    const auto number = std::ranges::find(scene.label_name, name) - scene.label_name.begin();
    std::vector<std::uint8_t> labels(scene.label.size());
    for (std::size_t g = 0; g < labels.size(); ++g) labels[g] = scene.label[g] == number;
    const Mask truth = thresholded(render_labels(*cloud, camera, labels), 0.5f);
    CutRequest request;
    request.strokes = {{camera, {click(seed->pixel, SeedLabel::kObject)}}};
    double agrees = 0;
    for (int corrections = 0; corrections <= 3; ++corrections) {
      const CutResult result = session.cut(request, CutSettings());
      const Mask shown = thresholded(render_labels(*cloud, camera, result.labels), 0.5f);
      agrees = iou(shown, truth);
      if (const auto next = robot_click(truth, shown)) request.strokes.front().strokes.push_back(*next);
    }
    CHECK(agrees > 0.95);
  }
}

TEST_CASE("session: views to look from show the labels, and have no say") {
  auto [request, settings] = click_on("apple");
  settings = preset("default");
  Session session = fresh_session();
  const CutResult result = session.cut(request, settings);
  CHECK(result.views.size() == 1);  // after a click the default asks no view around the object
  const std::vector<GivenView> around = session.look_around(request, result, settings, 6);
  REQUIRE(around.size() > 3);
  CHECK(around.size() <= 6);
  for (const GivenView& view : around) {
    CHECK_FALSE(same_view(view.camera, result.views.front().camera));
    CHECK(count(view.mask) > 0);
    CHECK(iou(view.mask,
              thresholded(render_labels(*small_table().cloud, view.camera, result.labels), 0.5f)) == 1);
  }
  // A small piece that is seen from one side: where it was more before, all sides are asked for.
  CutResult piece = result;
  const Camera& eye = request.strokes.front().camera;
  const ObjectExtent all = object_extent(*small_table().cloud, result.labels);
  for (std::size_t g = 0; g < piece.labels.size(); ++g)
    piece.labels[g] &= glm::dot(small_table().cloud->position[g] - all.centre_world, eye.forward_world()) <
                       -0.5f * all.radius;
  const auto of_piece = session.look_around(request, piece, settings, 6);
  const auto of_both = session.look_around(request, piece, settings, 6, {}, result.labels);
  CHECK(of_piece.size() < of_both.size());
  CHECK(std::ranges::any_of(of_both, [](const GivenView& v) { return count(v.mask) == 0; }));
  CutRequest more = request;
  more.strokes.push_back(stroke_from_behind("apple", SeedLabel::kRest));
  CHECK(session.cut(more, settings).labels == fresh_session().cut(more, settings).labels);
  CutResult nothing = result;
  nothing.labels.assign(nothing.labels.size(), 0);
  CHECK(session.look_around(request, nothing, settings, 6).empty());
}

TEST_CASE("session: snapshots tell how far the cut is") {
  const auto [request, settings] = click_on("apple");
  std::vector<CutPhase> phases;
  std::vector<std::uint8_t> by_parts;
  std::size_t views = 0;
  const auto note = [&](CutPhase phase, const CutResult& result) {
    phases.push_back(phase);
    if (phase == CutPhase::kParts) by_parts = result.labels;
    CHECK(result.views.size() >= views);  // they are only added
    views = result.views.size();
  };
  Session session = fresh_session();
  session.cut(request, settings, {}, note);
  REQUIRE(phases.size() > 4);
  CHECK(phases[0] == CutPhase::kParts);
  CHECK(phases[1] == CutPhase::kFirstMask);
  CHECK(phases.back() == CutPhase::kSettled);
  CHECK(std::ranges::is_sorted(phases));
  CHECK(std::ranges::count(phases, CutPhase::kFirstMask) == 1);
  CutSettings alone = settings;
  alone.parts_only = true;
  alone.join_enclosed = false;
  CHECK(by_parts == fresh_session().cut(request, alone).labels);

  phases.clear();
  views = 0;
  CutRequest more = request;
  more.strokes.push_back(stroke_from_behind("apple", SeedLabel::kRest));
  session.cut(more, settings, {}, note);
  CHECK(phases.front() == CutPhase::kFirstMask);  // the graph stands
}
