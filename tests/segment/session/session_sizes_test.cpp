// Sizes of strokes, and the places in which they are answered.
#include <doctest/doctest.h>

#include <algorithm>
#include <chrono>
#include <ctime>

#include "app/measure/robot_user.h"
#include "segment/masks/mask_tools.h"
#include "small_table.h"

using namespace splatcut;
using namespace splatcut::testing;

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

TEST_CASE("session: in a place that grows the strokes of before give what they gave, sizes and all") {
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
    CHECK(lost < 50);  // of some 2400
    CHECK(more < 150);
  }
}

// The sizes that a small place knows end before those of a larger one, in which what touches its sides is
// answered.
TEST_CASE("session: each step of the wheel takes more, also where the place grows, until no size is left") {
  const LabelledScene& scene = small_table().scene;
  CutSettings settings = preset("default");
  settings.parts_only = true;
  for (const char* name : {"mug", "apple", "orange", "pot"}) {
    CAPTURE(name);
    Session session({.cloud = small_table().cloud, .most_gaussians = scene.cloud.size() / 5});
    CutRequest request = click_on(name).request;
    CutResult before = session.cut(request, settings);
    const std::size_t looked_at = before.looked_at_gaussians;
    int& step = last_stroke(&request.strokes)->size_step;
    while (before.size + 1 < before.sizes) {
      ++step;
      CAPTURE(step);
      CutResult next = session.cut(request, settings);
      REQUIRE(std::ranges::count(next.labels, 1) > std::ranges::count(before.labels, 1));
      before = std::move(next);
    }
    CHECK(before.looked_at_gaussians > looked_at);
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

TEST_CASE("session: steps beyond the last size cost nothing, and change nothing") {
  auto [request, settings] = click_on("mug");
  settings.parts_only = true;
  Session session = fresh_session();
  const glm::vec2 pixel = request.strokes.front().strokes.front().points_px.front();
  request.strokes.push_back(
      {request.strokes.front().camera, {click(pixel + glm::vec2(25, 15), SeedLabel::kRest)}});
  const CutResult own = session.cut(request, settings);
  REQUIRE(own.sizes > 1);
  int& step = last_stroke(&request.strokes)->size_step;
  const auto cpu_s = [&](int steps, CutResult* result) {
    step = steps;
    const std::clock_t start = std::clock();
    *result = session.cut(request, settings);
    return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  };
  CutResult last, beyond;
  const double to_last = cpu_s(-std::max(1, static_cast<int>(own.likeliest_size)), &last),
               to_beyond = cpu_s(-kMostSizeSteps, &beyond);
  MESSAGE(own.sizes, " sizes: ", to_last, " s to the smallest, ", to_beyond, " s beyond");
  CHECK(last.size == 0);
  CHECK(beyond.size == 0);
  CHECK(beyond.labels == last.labels);
  CHECK(to_beyond < 0.3 + to_last);
  step = -kMostSizeSteps;
  CHECK(fresh_session().cut(request, settings).labels == last.labels);
}
