// Cells, the Gaussians and views of a neighbourhood, and a session that prepares no more than one.
#include "segment/superpoints/neighbourhood.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "core/counter_rng.h"
#include "scene/cloud/morton.h"
#include "scene/still_life/still_life.h"
#include "segment/session/session.h"
#include "segment/superpoints/orbit.h"
#include "synthetic_cloud.h"

using namespace splatcut;
using namespace splatcut::testing;

namespace {

WholeScene whole_scene(GaussianCloud made) {
  const auto cloud = std::make_shared<const GaussianCloud>(permuted(made, morton_order(made.position)));
  return {cloud, std::make_shared<const CloudBlocks>(*cloud), {0, -1, 0}, {}};
}

// The still life, and the same at `distance` along x, so that the two are two rooms.
GaussianCloud two_tables(const LabelledScene& scene, float distance) {
  GaussianCloud cloud = scene.cloud;
  const std::size_t n = cloud.size();
  std::vector<std::uint32_t> twice(2 * n);
  for (std::size_t g = 0; g < 2 * n; ++g) twice[g] = static_cast<std::uint32_t>(g % n);
  GaussianCloud both = permuted(cloud, twice);
  for (std::size_t g = n; g < 2 * n; ++g) both.position[g].x += distance;
  return both;
}

}  // namespace

TEST_CASE("cells: a thing half as large as a cell keeps an eighth of a side from its faces") {
  CounterRng rng(3, 1);
  for (int i = 0; i < 200; ++i) {
    const glm::vec3 at(rng.between(-40, 40), rng.between(-40, 40), rng.between(-40, 40));
    const float size = std::exp(rng.between(-4, 3));
    const Cell cell = cell_around(at, level_above(2 * size));
    CHECK(cell.side() >= 2 * size);
    CHECK(cell.side() < 4 * size * 1.0001f);
    const Box inner{cell.box_world().min + 0.1249f * cell.side(),
                    cell.box_world().max - 0.1249f * cell.side()};
    CHECK(contains(inner, at - 0.5f * size));
    CHECK(contains(inner, at + 0.5f * size));
  }
}

TEST_CASE("a neighbourhood holds the Gaussians of its cell, as they are, and views that look at it") {
  const WholeScene scene = whole_scene(random_cloud(3000, 9));
  Place place;
  place.cell = place.looked_at = cell_around({0.2f, -0.3f, 0.1f}, -1);
  place.eye = look_at({0.2f, -0.3f, -2}, {0.2f, -0.3f, 0.1f}, {0, -1, 0}, 0.9f, 320, 240);
  const Neighbourhood near = prepare_neighbourhood(scene, place, nullptr);
  REQUIRE(!near.row.empty());
  CHECK(near.row == scene.blocks->rows_in(*scene.cloud, place.cell.box_world()));
  for (std::size_t i = 0; i < near.row.size(); ++i)
    REQUIRE(near.cloud->position[i] == scene.cloud->position[near.row[i]]);
  for (const float closer : {1.0f, 2.0f}) {
    place.closer = closer;
    const std::vector<Camera> views = views_around(scene, place, {});
    CHECK(views.size() == 12);
    const float distance = glm::distance(views.front().centre_world(), place.looked_at.centre_world());
    for (const Camera& view : std::span(views).subspan(1)) {
      CHECK(glm::distance(view.centre_world(), place.looked_at.centre_world()) ==
            doctest::Approx(1.5f * closer * distance).epsilon(1e-3));
      const glm::vec3 at = view.camera_from_world(place.looked_at.centre_world());
      CHECK(std::abs(at.x / at.z) < 1e-3f);
      CHECK(std::abs(at.y / at.z) < 1e-3f);
    }
  }
  place.whole = true;
  CHECK(prepare_neighbourhood(scene, place, nullptr).cloud == scene.cloud);
}

TEST_CASE("a side is touched where what is labelled reaches it and the scene goes on beyond") {
  GaussianCloud line;  // along x from -1 to 1
  line.resize(2000, 0);
  for (std::size_t g = 0; g < line.size(); ++g) {
    line.position[g] = {-1 + 0.001f * static_cast<float>(g), 0, 0};
    line.scale[g] = glm::vec3(0.001f);
    line.opacity[g] = 1;
  }
  const WholeScene scene = whole_scene(line);
  const auto touched = [&](const glm::vec3& centre, float low, float high) {
    Place place;
    place.cell = cell_around(centre, 0);  // one unit wide
    const Neighbourhood near = prepare_neighbourhood(scene, place, nullptr);
    std::vector<std::uint8_t> labels;
    for (const glm::vec3& p : near.cloud->position) labels.push_back(p.x >= low && p.x <= high);
    return touches_side(scene, near, labels);
  };
  CHECK_FALSE(touched({0, 0, 0}, -0.4f, 0.4f));
  CHECK(touched({0, 0, 0}, -0.4f, 0.5f));
  CHECK(touched({0, 0, 0}, -0.5f, 0.4f));
  CHECK_FALSE(touched({0.75f, 0, 0}, 0.4f, 1));    // the scene ends at 1, before the face at 1.25
  CHECK_FALSE(touched({0.5f, 0, 0}, 0.2f, 1.0f));  // and at the face: nothing is beyond
  CHECK(touched({0.5f, 0, 0}, -0.1f, 1.0f));
}

TEST_CASE("session: a click in another room prepares that room, and gives what it gives in the first") {
  StillLifeOptions options;
  options.gaussians = 20000;
  const LabelledScene scene = make_still_life(options);
  const Box room = robust_bounds(scene.cloud.position);
  const float distance = std::ldexp(1.0f, level_above(4 * glm::length(room.extent())));
  const auto both = std::make_shared<const GaussianCloud>(two_tables(scene, distance));
  Session session({.cloud = both});
  const auto& seed = scene.seeds.front();
  const Camera& here = scene.cameras[static_cast<std::size_t>(seed.camera)];
  Camera there = here;
  there.camera_from_world_translation -= here.camera_from_world_rotation * glm::vec3(distance, 0, 0);
  const auto labels_from = [&](const Camera& camera) {
    CutRequest request;
    request.strokes = {{camera, {click(seed.pixel, SeedLabel::kObject)}}};
    CutResult result = session.cut(request, preset("default"));
    REQUIRE(result.outcome == Outcome::kDone);
    CHECK(result.looked_at_gaussians <= scene.cloud.size());
    return result.labels;
  };
  const std::vector<std::uint8_t> first = labels_from(here), second = labels_from(there);
  const std::size_t n = scene.cloud.size();
  CHECK(std::ranges::count(first, 1) > 100);
  CHECK(std::ranges::count(std::span(first).subspan(n), 1) == 0);
  CHECK(std::ranges::count(std::span(second).first(n), 1) == 0);
  // Cells repeat at that distance, a power of two, so that both rooms are cut alike but for rounding.
  std::size_t differ = 0;
  for (std::size_t g = 0; g < n; ++g) differ += first[g] != second[n + g];
  CHECK(differ < static_cast<std::size_t>(std::ranges::count(first, 1)) / 50);
}

TEST_CASE("session: the same labels whatever was cut before, however little is kept") {
  StillLifeOptions options;
  options.gaussians = 15000;
  const LabelledScene scene = make_still_life(options);
  const auto cloud = std::make_shared<const GaussianCloud>(scene.cloud);
  const auto request_for = [&](std::size_t seed) {
    CutRequest request;
    const auto& s = scene.seeds[seed];
    request.strokes = {
        {scene.cameras[static_cast<std::size_t>(s.camera)], {click(s.pixel, SeedLabel::kObject)}}};
    return request;
  };
  Session keeps({.cloud = cloud}), forgets({.cloud = cloud, .most_bytes = 1});
  for (const std::size_t seed : {0u, 1u, 2u, 1u, 0u}) {
    const CutRequest request = request_for(seed);
    Session fresh({.cloud = cloud});
    const std::vector<std::uint8_t> expected = fresh.cut(request, preset("default")).labels;
    CHECK(keeps.cut(request, preset("default")).labels == expected);
    CHECK(forgets.cut(request, preset("default")).labels == expected);
    CHECK(forgets.neighbourhoods() == 1);
  }
}

TEST_CASE("session: what is kept of known places is counted whole, and trimmed where they grow") {
  StillLifeOptions options;
  options.gaussians = 15000;
  const LabelledScene scene = make_still_life(options);
  const auto cloud = std::make_shared<const GaussianCloud>(scene.cloud);
  const auto& seed = scene.seeds.front();
  const auto request_from = [&](const Camera& camera, int strokes) {
    CutRequest request;
    request.strokes = {{camera, {click(seed.pixel, SeedLabel::kObject)}}};
    for (int i = 1; i < strokes; ++i)
      request.strokes.front().strokes.push_back(
          click(seed.pixel + static_cast<float>(4 * i) * glm::vec2(1, 0), SeedLabel::kObject));
    return request;
  };
  const Camera& camera = scene.cameras[static_cast<std::size_t>(seed.camera)];
  const Camera nearer = approached(camera, camera.world_from_pixel(seed.pixel, 1), 0.7f);
  Session session({.cloud = cloud});
  session.cut(request_from(camera, 1), preset("default"));
  session.cut(request_from(nearer, 1), preset("default"));
  REQUIRE(session.neighbourhoods() == 2);
  const std::size_t two = session.kept_bytes();
  Session bounded({.cloud = cloud, .most_bytes = two});
  std::vector<std::uint8_t> expected;
  for (int strokes = 1; strokes < 6; ++strokes)
    for (const Camera& from : {camera, nearer}) {  // no place is new after the first two
      bounded.cut(request_from(from, strokes), preset("default"));
      if (bounded.neighbourhoods() > 1) CHECK(bounded.kept_bytes() <= two);
      expected = session.cut(request_from(from, strokes), preset("default")).labels;
      CHECK(bounded.cut(request_from(from, strokes), preset("default")).labels == expected);
    }
  CHECK(session.kept_bytes() > two);  // as it grows where it may
}
