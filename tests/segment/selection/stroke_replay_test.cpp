// Strokes on the still life: obeyed, replayed alike, near the truth.
#include <doctest/doctest.h>
#include <tbb/task_arena.h>

#include <algorithm>

#include "app/measure/robot_user.h"
#include "core/counter_rng.h"
#include "segment/masks/mask_tools.h"
#include "segment/selection/click_selection.h"
#include "segment/selection/stroke_replay.h"
#include "segment/superpoints/orbit.h"
#include "still_life_table.h"

using namespace splatcut;
using namespace splatcut::testing;

namespace {

using Labels = std::vector<std::uint8_t>;

bool shows_object(const LeafView& view, const Labels& labels, const glm::vec2& pixel) {
  return shown(view.gaussians, view.camera, labels)
             .at(static_cast<int>(pixel.x), static_cast<int>(pixel.y)) != 0;
}

// Whether the scene covers the pixel at all.
bool covered(const LeafView& view, const glm::vec2& pixel) {
  float sum = 0;
  for (const GroupWeight& w : view.gaussians.at(static_cast<std::size_t>(pixel.y) * view.camera.width_px +
                                                static_cast<std::size_t>(pixel.x)))
    sum += w.weight;
  return sum >= 0.6f;
}

}  // namespace

TEST_CASE("selection: strokes speak of what was seen alone") {
  const Table& t = table();
  const Target mug = target(t, "mug");
  const glm::vec2 at = robot_click(mug.truth, Mask(mug.truth.width(), mug.truth.height()))->points_px.front();
  StrokeReplay replay(t.prepared.parts);
  std::vector<CameraStroke> strokes = {{mug.camera, click(at, SeedLabel::kObject)}};
  const Labels first = replay.replay(t.cloud, strokes, {}).labels();
  auto seen = std::make_shared<Labels>(first);
  for (std::uint8_t& s : *seen) s = s ? 0 : 1;
  strokes.push_back({mug.camera, click(at, SeedLabel::kObject), seen});
  const Labels hidden = replay.replay(t.cloud, strokes, {}).labels();
  const LeafView behind = leaf_view(t.cloud, t.prepared.parts, mug.camera, {}, seen);
  REQUIRE(covered(behind, at));
  CHECK(shows_object(behind, hidden, at));
  CHECK_FALSE(shows_object(behind, first, at));
  strokes.back().seen = nullptr;  // told of the whole it is no news
  CHECK_FALSE(shows_object(behind, replay.replay(t.cloud, strokes, {}).labels(), at));
  CHECK(hidden == [&] {
    StrokeReplay again(t.prepared.parts);
    strokes.back().seen = std::make_shared<Labels>(*seen);  // the same set elsewhere
    return again.replay(t.cloud, strokes, {}).labels();
  }());
}

TEST_CASE("selection: the same first click from nearer means the same part") {
  const Table& t = table();
  for (const std::string object : {"mug", "apple", "orange", "pot", "books"}) {
    const Target on = target(t, object);
    const Stroke first = *robot_click(on.truth, Mask(on.camera.width_px, on.camera.height_px));
    const glm::vec2 pixel = first.points_px.front();
    RasterOptions raster;
    raster.depth = true;
    const float depth = rasterize(t.cloud, on.camera, raster)
                            .median_depth.at(static_cast<int>(pixel.x), static_cast<int>(pixel.y));
    const auto labels_from = [&](const Camera& camera) {
      StrokeReplay replay(t.prepared.parts);
      return replay.replay(t.cloud, std::vector<CameraStroke>{{camera, first}}, {}).labels();
    };
    const Mask as_seen = shown(on.leaves.gaussians, on.camera, labels_from(on.camera));
    for (const float share : {0.6f, 0.4f}) {
      CAPTURE(object);
      CAPTURE(share);
      const Camera nearer = approached(on.camera, on.camera.world_from_pixel(pixel, depth), share);
      CHECK(iou(shown(on.leaves.gaussians, on.camera, labels_from(nearer)), as_seen) >
            0.93);  // the pot with a leaf less; else .99
    }
  }
}

TEST_CASE("selection: soft views sum what the rasteriser draws") {
  const Table& t = table();
  const Target on = target(t, "apple");
  const auto index = std::ranges::find(t.scene.label_name, "apple") - t.scene.label_name.begin();
  Labels labels(t.cloud.size());
  for (std::size_t g = 0; g < labels.size(); ++g) labels[g] = t.label[g] == index;
  const Mask mask = shown(on.leaves.gaussians, on.camera, labels);
  CHECK(iou(mask, on.truth) > 0.995);
  RasterOptions raster;
  raster.colour = false;
  const Image<float> alpha = rasterize(t.cloud, on.camera, raster).alpha;
  double most = 0;
  for (std::size_t i = 0; i < alpha.size(); ++i) {
    double sum = 0;
    for (const GroupWeight& w : on.leaves.gaussians.at(i)) sum += w.weight;
    CHECK(sum <= alpha.pixels()[i] + 1e-4);
    most = std::max(most, alpha.pixels()[i] - sum);
  }
  CHECK(most < 0.2);  // what is too faint to be listed
}

TEST_CASE("selection: every click is obeyed, object clicks only add, rest clicks only remove") {
  const Table& t = table();
  const Target on = target(t, "mug");
  CounterRng rng(3, 0);
  int told = 0;
  for (int draw = 0; draw < 8; ++draw) {
    ClickSelection selection(t.prepared.parts, {});
    Labels before(t.cloud.size(), 0);
    for (int i = 0; i < 8; ++i) {
      const bool object = i == 0 || rng.below(2) == 0;
      const glm::vec2 pixel(rng.between(0, 400), rng.between(0, static_cast<float>(on.camera.height_px)));
      const bool heard =
          selection.apply(on.leaves, click(pixel, object ? SeedLabel::kObject : SeedLabel::kRest));
      if (heard && covered(on.leaves, pixel)) {
        ++told;
        CHECK(shows_object(on.leaves, selection.labels(), pixel) == object);
      }
      bool monotone = true;
      for (std::size_t g = 0; g < before.size(); ++g)
        monotone &= object ? selection.labels()[g] >= before[g] : selection.labels()[g] <= before[g];
      CHECK(monotone);
      before = selection.labels();
    }
  }
  CHECK(told > 40);
}

TEST_CASE("selection: objects of the still life in three robot clicks") {
  const Table& t = table();
  double first = 0, third = 0;
  const std::vector<std::string> objects = {"mug", "apple", "orange", "plant", "pot", "books"};
  for (const std::string& object : objects) {
    const Target on = target(t, object);
    ClickSelection selection(t.prepared.parts, {});
    std::vector<double> ious;
    Mask mask(on.camera.width_px, on.camera.height_px);
    for (int i = 0; i < 3; ++i) {
      if (const auto next = robot_click(on.truth, mask)) selection.apply(on.leaves, *next);
      mask = shown(on.leaves.gaussians, on.camera, selection.labels());
      ious.push_back(iou(mask, on.truth));
    }
    MESSAGE(object, " ", ious[0], " ", ious[1], " ", ious[2]);
    first += ious[0] / static_cast<double>(objects.size());
    third += ious[2] / static_cast<double>(objects.size());
  }
  CHECK(first > 0.7);
  CHECK(third > 0.93);
}

TEST_CASE("selection: replayed strokes give what strokes one by one give, on any number of threads") {
  const Table& t = table();
  const Target apple = target(t, "apple"), mug = target(t, "mug");
  const auto said = [](const Target& on, float x, float y, SeedLabel label) {
    return CameraStroke{on.camera, click({x, y}, label)};
  };
  const std::vector<CameraStroke> strokes = {
      said(mug, 30, 200, SeedLabel::kRest), said(apple, 200, 150, SeedLabel::kObject),
      said(mug, 150, 120, SeedLabel::kObject), said(apple, 60, 60, SeedLabel::kRest)};
  StrokeReplay once(t.prepared.parts), growing(t.prepared.parts);
  const Labels all = once.replay(t.cloud, strokes, {}).labels();
  Labels grown;
  for (std::size_t n = 2; n <= strokes.size(); ++n)
    grown = growing.replay(t.cloud, std::span(strokes).first(n), {}).labels();
  CHECK(grown == all);
  growing.replay(t.cloud, std::span(strokes).first(2), {});  // undone
  std::stop_source stop;
  stop.request_stop();
  StrokeReplay stopped(t.prepared.parts);
  stopped.replay(t.cloud, strokes, {}, {.stop = stop.get_token(), .on_progress = {}});
  CHECK(stopped.replay(t.cloud, strokes, {}).labels() == all);  // nothing half made is kept
  CHECK(growing.replay(t.cloud, strokes, {}).labels() == all);
  tbb::task_arena(1).execute([&] {
    StrokeReplay alone(t.prepared.parts);
    CHECK(alone.replay(t.cloud, strokes, {}).labels() == all);
  });
  // Views beyond the limit go, but for the last one, and nothing depends on them.
  constexpr std::size_t kNothing = 1;
  std::vector<CameraStroke> from_two = {strokes[1], strokes[2]};
  from_two[1].camera = limited_to_width(mug.camera, 200);
  StrokeReplay small(t.prepared.parts, kUnknownCapture, kNothing), large(t.prepared.parts);
  const Labels seen_twice = large.replay(t.cloud, from_two, {}).labels();
  CHECK(small.replay(t.cloud, from_two, {}).labels() == seen_twice);
  CHECK(small.view_bytes() > 0);
  CHECK(small.view_bytes() < 0.6 * static_cast<double>(large.view_bytes()));
}

// From near the picture holds the clicked leaves of the plant and little of the rest of it.
TEST_CASE("selection: a correction means from near what it means from where the view holds the whole thing") {
  const Table& t = table();
  const auto middle_of = [&](const char* object) {
    const Target on = target(t, object);
    const glm::vec2 at = robot_click(on.truth, Mask(on.truth.width(), on.truth.height()))->points_px.front();
    return CameraStroke{on.camera, click(at, SeedLabel::kObject)};
  };
  const CameraStroke far = middle_of("plant");
  const glm::vec2 at = far.stroke.points_px.front();
  const auto depth_in = [&](const Camera& camera) {
    return leaf_view(t.cloud, t.prepared.parts, camera)
        .depth.at(static_cast<int>(at.x), static_cast<int>(at.y));
  };
  const float depth = depth_in(far.camera);
  CameraStroke near = far;
  near.camera = approached(far.camera, far.camera.world_from_pixel(at, depth), 0.35f);
  REQUIRE(depth_in(near.camera) == doctest::Approx(0.35 * depth).epsilon(0.05));  // the same leaf
  for (const char* other : {"mug", "apple", "books", "lamp"}) {
    INFO(other);
    const auto after = [&](const CameraStroke& correction) {
      const Capture capture{.photographs = t.scene.cameras, .subject = {}};
      StrokeReplay replay(t.prepared.parts, capture);
      return ClickSelection(
          replay.replay(t.cloud, std::vector<CameraStroke>{middle_of(other), correction}, {}));
    };
    const ClickSelection from_far = after(far), from_near = after(near);
    std::size_t both = 0, either = 0;
    for (std::size_t g = 0; g < t.cloud.size(); ++g) {
      both += from_far.labels()[g] && from_near.labels()[g];
      either += from_far.labels()[g] || from_near.labels()[g];
    }
    CHECK(static_cast<double>(both) > 0.98 * static_cast<double>(either));
    // Its sizes are outlined in the picture that was clicked.
    REQUIRE(!from_near.size_masks().empty());
    for (const Mask& size : from_near.size_masks())
      CHECK(static_cast<float>(size.width()) / static_cast<float>(size.height()) ==
            doctest::Approx(static_cast<float>(near.camera.width_px) /
                            static_cast<float>(near.camera.height_px))
                .epsilon(0.02));
    const Mask& taken = from_near.size_masks()[from_near.size()];
    const float scale = static_cast<float>(taken.width()) / static_cast<float>(near.camera.width_px);
    CHECK(taken.at(static_cast<int>(scale * at.x), static_cast<int>(scale * at.y)) == kMaskObject);
  }
}
