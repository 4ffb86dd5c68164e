// Work that is opened again: its first cut needs the answers to all strokes before the last one.
#include <doctest/doctest.h>

#include <algorithm>
#include <string_view>
#include <vector>

#include "scene/still_life/still_life.h"
#include "segment/session/local_session.h"
#include "segment/session/session.h"
#include "segment/superpoints/observing_views.h"

using namespace splatcut;

namespace {

// Eight clicks on and beside the mug of a still life, in one view.
struct EightClicks {
  SessionScene opened;
  CutRequest request;

  EightClicks() {
    StillLifeOptions options;
    options.gaussians = 15000;
    const LabelledScene scene = make_still_life(options);
    opened = {.cloud = std::make_shared<const GaussianCloud>(scene.cloud), .photographs = scene.cameras};
    const auto seed = std::ranges::find(scene.seeds, "mug", &LabelledScene::SeedClick::object);
    REQUIRE(seed != scene.seeds.end());
    request.strokes = {{scene.cameras[static_cast<std::size_t>(seed->camera)], {}}};
    for (int i = 0; i < kStrokes; ++i)
      request.strokes.front().strokes.push_back(click(
          seed->pixel + static_cast<float>(i % 3) * glm::vec2(9, 0) + static_cast<float>(i) * glm::vec2(0, 3),
          i % 3 == 2 ? SeedLabel::kRest : SeedLabel::kObject));
  }
  static constexpr int kStrokes = 8;
};

}  // namespace

TEST_CASE("earlier strokes: their answers are counted while they are computed, kept where that is stopped") {
  const auto [opened, request] = EightClicks();
  constexpr int kStrokes = EightClicks::kStrokes;
  Session session(opened);
  std::vector<double> shares, shares_of_hits;
  std::stop_source stop;
  Job watched{.stop = stop.get_token(), .on_progress = [&](std::string_view stage, double share) {
                if (stage == "what strokes hit") shares_of_hits.push_back(share);
                if (stage == "earlier strokes") shares.push_back(share);
                if (share >= 0.5 && stage == "earlier strokes") stop.request_stop();
              }};
  CHECK(session.cut(request, CutSettings(), watched).outcome == Outcome::kCancelled);
  CHECK(shares_of_hits.size() == kStrokes);
  CHECK(std::ranges::is_sorted(shares_of_hits));
  REQUIRE(shares.size() > 2);
  CHECK(shares.front() == 0);
  CHECK(shares.back() < 0.7);
  CHECK(std::ranges::is_sorted(shares));
  const std::size_t done = shares.size() - 1;
  shares.clear();
  stop = {};
  watched.stop = {};
  const CutResult result = session.cut(request, CutSettings(), watched);
  REQUIRE(result.outcome == Outcome::kDone);
  CHECK(shares.size() == kStrokes - 1 - done);
  CHECK(result.labels == Session(opened).cut(request, CutSettings()).labels);
  shares.clear();
  session.cut(request, CutSettings(), watched);
  CHECK(shares.empty());
}

TEST_CASE("earlier strokes: another smoothness, or a view left out, asks none of them for its masks again") {
  auto [opened, request] = EightClicks();
  CutSettings settings;
  settings.orbit.views = 3;
  Session session(opened);
  const CutResult first = session.cut(request, settings);
  REQUIRE(first.outcome == Outcome::kDone);
  REQUIRE(first.views.size() > 1);
  const auto looked = [](const CutResult& result) {
    return std::ranges::any_of(result.stages, [](const StageTime& s) { return s.name == "first mask"; });
  };
  CHECK(looked(first));
  CHECK(std::ranges::any_of(first.stages, [](const StageTime& s) { return s.name == "graph"; }));
  for (const float smoothness : {3.0f, 4.0f}) {
    settings.smoothness = smoothness;
    const CutResult smoother = session.cut(request, settings);
    CHECK_FALSE(looked(smoother));
    CHECK(smoother.labels == Session(opened).cut(request, settings).labels);
  }
  request.left_out = {first.views[1].camera};
  const CutResult without = session.cut(request, settings);
  CHECK_FALSE(looked(without));
  CHECK(without.labels == Session(opened).cut(request, settings).labels);
}

TEST_CASE("earlier strokes: that they mean nothing is known, too") {
  auto [opened, request] = EightClicks();
  const GaussianCloud& cloud = *opened.cloud;
  const Camera& camera = request.strokes.front().camera;
  LocalSession session({.cloud = opened.cloud,
                        .prepared = std::make_shared<const PreparedScene>(
                            prepare_scene(cloud, observing_views(cloud, camera, {0, -1, 0}, {}))),
                        .capture = {}});
  for (Stroke& stroke : request.strokes.front().strokes) {
    stroke.label = SeedLabel::kObject;
    stroke.points_px.front() = {-500, -500};
  }
  int asked = 0;
  const Job watched{.stop = {}, .on_progress = [&](std::string_view stage, double) {
                      asked += stage == "earlier strokes";
                    }};
  CHECK(session.cut(request, CutSettings(), watched).outcome == Outcome::kNothingFound);
  CHECK(asked == EightClicks::kStrokes - 1);
  asked = 0;
  CHECK(session.cut(request, CutSettings(), watched).outcome == Outcome::kNothingFound);
  CHECK(asked == 0);
}
