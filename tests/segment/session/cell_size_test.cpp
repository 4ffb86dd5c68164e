// A session's first cell is as small as it may be, and grows until what is labelled keeps off its faces.
// Rooms of random still lifes ask whether it stops too early: the same clicks in cells twice as large and
// larger.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "core/counter_rng.h"
#include "scene/cloud/joined_clouds.h"
#include "scene/cloud/morton.h"
#include "scene/still_life/still_life.h"
#include "segment/masks/mask_tools.h"
#include "segment/session/session.h"
#include "segment/session/stroke_hits.h"
#include "segment/superpoints/orbit.h"
#include "synthetic_cloud.h"

using namespace splatcut;
using namespace splatcut::testing;

namespace {

// Rooms apart from each other, so that a cell is seldom the scene.
struct RandomRooms {
  std::shared_ptr<const GaussianCloud> cloud;
  std::vector<CameraStroke> clicks;  // one on each object
  std::vector<int> object;           // that each click means
  std::vector<int> of;               // per Gaussian, the object whose surface it is

  explicit RandomRooms(std::uint64_t seed) {
    constexpr int kRooms = 3, kObjects = 100;
    CounterRng rng(seed, 7);
    const auto often = [&](float share) { return rng.between(0, 1) < share; };
    std::vector<GaussianCloud> rooms;
    for (int r = 0; r < kRooms; ++r) {
      StillLifeOptions options;
      options.gaussians = static_cast<std::size_t>(rng.between(6000, 15000));
      options.seed = kRooms * seed + static_cast<std::uint64_t>(r);
      options.sh_degree = 0;
      options.straddling = often(0.5f);
      options.skirts = often(0.5f);
      options.floaters = often(0.5f);
      options.contact = often(0.3f);
      options.low_contrast = often(0.3f);
      LabelledScene room = make_still_life(options);
      const glm::vec3 step(rng.between(6, 9) * static_cast<float>(r), rng.between(-1, 1), rng.between(-1, 1));
      for (glm::vec3& position : room.cloud.position) position += step;
      for (const auto& s : room.seeds) {
        Camera camera = room.cameras[static_cast<std::size_t>(s.camera)];
        camera.camera_from_world_translation -= camera.camera_from_world_rotation * step;
        const auto name = std::ranges::find(room.label_name, s.object) - room.label_name.begin();
        object.push_back(kObjects * r + static_cast<int>(name));
        clicks.push_back({camera, click(s.pixel, SeedLabel::kObject)});
      }
      for (const std::uint8_t label : room.label) of.push_back(kObjects * r + label);
      rooms.push_back(std::move(room.cloud));
    }
    const GaussianCloud all = joined(std::move(rooms));
    const std::vector<std::uint32_t> order = morton_order(all.position);
    cloud = std::make_shared<const GaussianCloud>(permuted(all, order));
    const std::vector<int> unsorted = std::exchange(of, {});
    for (const std::uint32_t g : order) of.push_back(unsorted[g]);
  }
};

CutResult cut_in(const RandomRooms& rooms, const CameraStroke& click, std::size_t most_gaussians,
                 std::vector<Camera> photographs = {}) {
  Session session(
      {.cloud = rooms.cloud, .photographs = std::move(photographs), .most_gaussians = most_gaussians});
  CutRequest request;
  request.strokes = {{click.camera, {click.stroke}}};
  return session.cut(request, CutSettings());
}

// Share of what either labels that only one does.
double difference(const std::vector<std::uint8_t>& a, const std::vector<std::uint8_t>& b) {
  std::size_t either = 0, one = 0;
  for (std::size_t g = 0; g < a.size(); ++g) {
    either += a[g] || b[g];
    one += (a[g] != 0) != (b[g] != 0);
  }
  return either ? static_cast<double>(one) / static_cast<double>(either) : 0;
}

}  // namespace

// Where the two differ, one click means one of several parts, and which of them is likeliest turns with the
// neighbours that a part is weighed beside: over 55 clicks of nine such scenes the small cells were right in
// .79 (IoU with the object), the large ones in .76, and 30 of the 55 labelled the same. Were a cell too small
// for the object, small ones would lose.
TEST_CASE("cells: a click labels in a third of the Gaussians what it labels in all of the first cell") {
  double right_small = 0, right_large = 0;
  int same = 0, clicks = 0;
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const RandomRooms rooms(seed);
    for (std::size_t i = seed % 3; i < rooms.clicks.size(); i += 3) {
      CAPTURE(seed);
      CAPTURE(i);
      const CutResult large = cut_in(rooms, rooms.clicks[i], rooms.cloud->size());
      if (large.outcome != Outcome::kDone) continue;
      const CutResult small = cut_in(rooms, rooms.clicks[i], large.looked_at_gaussians / 3);
      REQUIRE(small.outcome == Outcome::kDone);
      if (small.looked_at_gaussians == large.looked_at_gaussians) continue;
      std::vector<std::uint8_t> truth(rooms.of.size());
      for (std::size_t g = 0; g < truth.size(); ++g) truth[g] = rooms.of[g] == rooms.object[i];
      ++clicks;
      same += difference(small.labels, large.labels) <= 0.01;
      right_small += 1 - difference(small.labels, truth);
      right_large += 1 - difference(large.labels, truth);
    }
  }
  CHECK(clicks >= 12);
  CHECK(same >= 0.6 * clicks);
  CHECK(right_small / clicks >= right_large / clicks - 0.02);
}

// A meaning that needs more Gaussians than the likeliest is looked up where these are prepared, where a place
// has other meanings in another order.
// In the larger place that a second click needs, the first may mean another part: the hedge behind a pillar.
TEST_CASE("cells: what one click has given stays where the next one needs a larger place") {
  CutSettings parts;
  parts.parts_only = true;
  double lost = 0, more = 0;
  int looked_at = 0;
  for (const std::uint64_t seed : {1, 2, 3}) {
    const RandomRooms rooms(seed);
    for (std::size_t a = 0; a + 1 < rooms.clicks.size(); ++a) {
      const std::size_t b = a + 1;
      if (rooms.object[a] / 100 != rooms.object[b] / 100) continue;
      Session session({.cloud = rooms.cloud, .most_gaussians = 1500});
      CutRequest request;
      request.strokes = {{rooms.clicks[a].camera, {rooms.clicks[a].stroke}}};
      const CutResult one = session.cut(request, parts);
      request.strokes.push_back({rooms.clicks[b].camera, {rooms.clicks[b].stroke}});
      const CutResult two = session.cut(request, parts);
      if (one.outcome != Outcome::kDone || two.looked_at_gaussians <= one.looked_at_gaussians) continue;
      std::size_t given = 0, gone = 0, beside = 0;
      for (std::size_t g = 0; g < rooms.of.size(); ++g) {
        given += one.labels[g];
        gone += one.labels[g] && !two.labels[g];
        beside += !one.labels[g] && two.labels[g] && rooms.of[g] != rooms.object[b];
      }
      ++looked_at;
      lost += static_cast<double>(gone) / static_cast<double>(given);
      more += static_cast<double>(beside) / static_cast<double>(given);
    }
  }
  MESSAGE(looked_at, " pairs: ", lost, " of the first lost, ", more, " more");
  REQUIRE(looked_at > 5);
  CHECK(lost < 0.03 * looked_at);  // .034 where the first click was always asked again, and .26 more
  CHECK(more < 0.12 * looked_at);
}

TEST_CASE("cells: a meaning that is chosen is the one that was offered, and the others stay offered") {
  int offered = 0, other = 0, grown = 0;
  const RandomRooms rooms(1);
  Session session({.cloud = rooms.cloud, .most_gaussians = rooms.cloud->size() / 12});
  CutSettings settings;
  settings.parts_only = true;
  constexpr std::size_t kClicks = 8;
  for (const CameraStroke& click : std::span(rooms.clicks).first(kClicks)) {
    CutRequest request;
    request.strokes = {{click.camera, {click.stroke}}};
    const CutResult first = session.cut(request, settings);
    for (int choice = 1; choice < std::ssize(first.meanings); ++choice) {
      request.choice = choice;
      const CutResult chosen = session.cut(request, settings);
      REQUIRE(chosen.meanings.size() == first.meanings.size());
      CHECK(chosen.choice == static_cast<std::size_t>(choice));
      for (std::size_t m = 0; m < first.meanings.size(); ++m)
        CHECK(std::ranges::equal(chosen.meanings[m].pixels(), first.meanings[m].pixels()));
      const Mask& outlined = first.meanings[static_cast<std::size_t>(choice)];
      const Camera view = limited_to_width(click.camera, outlined.width());
      const Mask shown =
          thresholded(render_labels({*rooms.cloud, nullptr, &session.blocks()}, view, chosen.labels), 0.5f);
      const bool more = chosen.looked_at_gaussians > first.looked_at_gaussians;
      std::size_t both = 0;
      for (std::size_t i = 0; i < shown.pixels().size(); ++i)
        both += shown.pixels()[i] != 0 && outlined.pixels()[i] != 0;
      // Of a meaning that its cell cuts off, the outline is a part.
      const double covered = static_cast<double>(both) / static_cast<double>(count(outlined));
      ++offered;
      other += (more ? covered : iou(shown, outlined)) < 0.75;  // labels alike by .7 are the same meaning
      grown += more;
    }
  }
  CHECK(offered >= 8);
  CHECK(grown >= 3);
  CHECK(other == 0);
}

// Only from nearer than it was photographed, and only by three cameras, does a click look at more.
TEST_CASE("cells: around a click from near is prepared what is prepared from where the photographs stand") {
  const RandomRooms rooms(1);
  const CameraStroke& far = rooms.clicks[1];  // it means much the same from both
  const StrokeHits hits = stroke_hits({*rooms.cloud}, far);
  REQUIRE(hits.front());
  CameraStroke near = far;
  near.camera = approached(far.camera, *hits.front(), 0.25f);
  near.stroke.points_px = {near.camera.pixel_from_camera(near.camera.camera_from_world(*hits.front()))};
  const auto looked_at = [&](const CameraStroke& click, std::vector<Camera> photographs) {
    return cut_in(rooms, click, rooms.cloud->size(), std::move(photographs)).looked_at_gaussians;
  };
  const std::size_t from_far = looked_at(far, {}), from_near = looked_at(near, {});
  CHECK(from_near < from_far);
  CHECK(looked_at(near, std::vector<Camera>(2, far.camera)) == from_near);
  CHECK(looked_at(near, std::vector<Camera>(3, far.camera)) == from_far);
  CHECK(looked_at(far, std::vector<Camera>(3, near.camera)) == from_far);
}

// A plate of fine splats with a red spot, and coarse ones far around. Half of the plate lies within .8 of its
// middle: its usual picture is 1.84 broad.
TEST_CASE("cells: without photographs, a close-up of the subject is looked at as its usual picture is") {
  constexpr int kSteps = 90;
  const auto cloud = std::make_shared<GaussianCloud>(random_cloud(kSteps * kSteps + 1000, 3));
  for (std::size_t g = 0; g < cloud->size(); ++g) {
    cloud->opacity[g] = 0.98f;
    if (g >= kSteps * kSteps) {
      cloud->position[g] *= 30.0f / glm::length(cloud->position[g]);
      continue;
    }
    const glm::vec2 at = glm::vec2(g % kSteps, g / kSteps) * (2.0f / kSteps) - 1.0f;
    cloud->position[g] = {at, 0};
    cloud->scale[g] = {0.02f, 0.02f, 0.001f};
    cloud->rotation[g] = {1, 0, 0, 0};
    cloud->f_dc[g] = glm::length(at) < 0.12f ? glm::vec3(1.5f, -1.5f, -1.5f) : glm::vec3(0.2f);
  }
  const auto looked_at = [&](float distance) {
    Camera camera = look_at({0, 0, -distance}, glm::vec3(0), {0, -1, 0}, 0.9f, 160, 160);
    camera.fx_px = camera.fy_px = 160;  // as broad as far
    Session session({.cloud = cloud});
    CutRequest request;
    request.strokes = {{camera, {click({80, 80}, SeedLabel::kObject)}}};
    return session.cut(request, CutSettings()).looked_at_gaussians;
  };
  const std::size_t usual = looked_at(1.84f);
  CHECK(usual > 1000);
  CHECK(looked_at(0.95f) == usual);
  CHECK(looked_at(0.5f) < usual);  // one thing of many
}

TEST_CASE("cells: a splat that shows far from its centre is found, though no Gaussian lies where it is hit") {
  auto cloud = std::make_shared<GaussianCloud>();
  cloud->resize(1, 0);
  cloud->position[0] = {0, 0, 4};
  cloud->scale[0] = glm::vec3(60);
  cloud->opacity[0] = 0.99f;
  const Camera camera = look_at({30, 0, 0}, {30, 0, 4}, {0, -1, 0}, 0.9f, 320, 240);
  Session session({.cloud = cloud});
  CutRequest request;
  request.strokes = {{camera, {click({160, 120}, SeedLabel::kObject)}}};
  const CutResult result = session.cut(request, preset("default"));
  CHECK(result.labels.size() == 1);
  CHECK(session.neighbourhoods() == 1);
}
