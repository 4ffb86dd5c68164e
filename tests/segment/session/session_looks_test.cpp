// What is shown before, while and after a cut runs: previews, stages, snapshots, views to look from.
#include <doctest/doctest.h>

#include <algorithm>
#include <chrono>
#include <set>

#include "app/measure/robot_user.h"
#include "core/stage_clock.h"
#include "segment/masks/mask_tools.h"
#include "small_table.h"

using namespace splatcut;
using namespace splatcut::testing;

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
