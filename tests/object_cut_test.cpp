// What the window runs after every stroke: the same labels whatever was cut before, and a heat map of what
// was weighed.
#include "segment/object_cut.h"

#include <doctest/doctest.h>

#include <algorithm>

#include "scene/still_life/still_life.h"

using namespace splatcut;

namespace {

struct Table {
  LabelledScene scene;
  std::shared_ptr<const GaussianCloud> cloud;
  std::shared_ptr<const PreparedScene> prepared;
};

const Table& table() {
  static const Table made = [] {
    Table t;
    StillLifeOptions options;
    options.gaussians = 25000;
    t.scene = make_still_life(options);
    t.cloud = std::make_shared<const GaussianCloud>(t.scene.cloud);
    t.prepared = std::make_shared<const PreparedScene>(
        prepare_scene(*t.cloud, t.scene.cameras.front(), {0, -1, 0}, t.scene.cameras));
    return t;
  }();
  return made;
}

ObjectCutter fresh_cutter() {
  return {table().cloud, std::make_shared<SceneSolvers>(table().cloud, table().prepared)};
}

ObjectCutInput click_on(const std::string& object) {
  const LabelledScene& scene = table().scene;
  const auto seed = std::ranges::find(scene.seeds, object, &LabelledScene::SeedClick::object);
  REQUIRE(seed != scene.seeds.end());
  ObjectCutInput input;
  input.views = {
      {scene.cameras[static_cast<std::size_t>(seed->camera)], {click(seed->pixel, SeedLabel::kObject)}}};
  return input;
}

// A stroke on the object from the other side of the table.
StrokedView stroke_from_behind(const std::string& object, SeedLabel label) {
  const LabelledScene& scene = table().scene;
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

TEST_CASE("object cut: kept steps, flow and other objects before it change no label") {
  const auto solvers = std::make_shared<SceneSolvers>(table().cloud, table().prepared);
  ObjectCutter apple(table().cloud, solvers), mug(table().cloud, solvers);
  std::vector<std::pair<ObjectCutter*, ObjectCutInput>> steps;
  ObjectCutInput a = click_on("apple"), m = click_on("mug");
  steps.emplace_back(&apple, a);
  a.smoothness = 30;
  steps.emplace_back(&apple, a);
  steps.emplace_back(&mug, m);
  a.views.push_back(stroke_from_behind("apple", SeedLabel::kRest));
  steps.emplace_back(&apple, a);
  a.smoothness = 0.05f;
  steps.emplace_back(&apple, a);
  m.left_out = {1};
  steps.emplace_back(&mug, m);
  ObjectCutInput code = click_on("apple");
  code.preset = "paper-code";
  steps.emplace_back(&mug, code);
  code.smoothness = 0.7f;
  steps.emplace_back(&mug, code);
  a.smoothness.reset();
  steps.emplace_back(&apple, a);
  for (std::size_t i = 0; i < steps.size(); ++i) {
    CAPTURE(i);
    // Cancelled on the way, sooner or later: that must leave no trace either.
    std::stop_source stop;
    Job cancelled;
    cancelled.stop = stop.get_token();
    std::size_t snapshots = 0;
    const auto stop_soon = [&](const PipelineReport&) {
      if (snapshots++ == i % 3) stop.request_stop();
    };
    cancelled.on_progress = [&](std::string_view stage, double) {
      if (stage == "cut") stop.request_stop();
    };
    steps[i].first->cut(steps[i].second, stop_soon, cancelled);
    const ObjectCutReport kept = steps[i].first->cut(steps[i].second);
    REQUIRE(kept.outcome == Outcome::kDone);
    CHECK(std::ranges::count(kept.labels, 1) > 0);
    CHECK(kept.labels == fresh_cutter().cut(steps[i].second).labels);
  }
}

TEST_CASE("object cut: paper-code cuts on its nine neighbours, not on the ten that are prepared") {
  const PipelineOptions code = preset("paper-code");
  REQUIRE(code.neighbours == 9);
  SceneSolvers solvers(table().cloud, table().prepared);
  CHECK(solvers.prepared(code, {}).graph.listed == 9);
  CHECK(&solvers.prepared(preset("default"), {}) == table().prepared.get());
}

TEST_CASE("object cut: without neighbours the heat map decides every label, corrections and all") {
  ObjectCutInput input = click_on("apple");
  input.smoothness = 0;  // label = w > 1/2, but for what the trimming takes
  for (const bool corrected : {false, true}) {
    CAPTURE(corrected);
    if (corrected) input.views.push_back(stroke_from_behind("apple", SeedLabel::kRest));
    ObjectCutter cutter = fresh_cutter();
    const ObjectCutReport report = cutter.cut(input);
    REQUIRE(report.outcome == Outcome::kDone);
    if (corrected) {
      CHECK(report.views.back().confidence == 1);
      CHECK_FALSE(report.views.back().disagreed);
    }
    const std::vector<float> w = cutter.likelihood_of(input);
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
