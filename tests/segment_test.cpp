// Graph, energy, likelihood, seeds, masks and the robot, each against an answer known by other means.
#include <doctest/doctest.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <set>

#include "app/measure/evaluate.h"
#include "app/measure/mask_measures.h"
#include "app/measure/robot_user.h"
#include "cut_in_view.h"
#include "scene/raster/rasterizer.h"
#include "segment/graphcut/energy.h"
#include "segment/graphcut/knn_graph.h"
#include "segment/graphcut/likelihood.h"
#include "segment/masks/mask_tools.h"
#include "segment/masks/trim.h"
#include "segment/session/session.h"
#include "synthetic_cloud.h"

using namespace splatcut;
using namespace splatcut::testing;

TEST_CASE("k-NN graph: the edges of brute force, each once, the same on 1, 2, 3 threads") {
  const GaussianCloud cloud = random_cloud(600, 2);
  constexpr int kNeighbours = 6;
  std::set<std::pair<std::uint32_t, std::uint32_t>> expected;
  for (std::uint32_t g = 0; g < cloud.size(); ++g) {
    std::vector<std::uint32_t> others;
    for (std::uint32_t h = 0; h < cloud.size(); ++h)
      if (h != g) others.push_back(h);
    std::ranges::sort(others, {},
                      [&](std::uint32_t h) { return glm::distance(cloud.position[g], cloud.position[h]); });
    for (int i = 0; i < kNeighbours; ++i)
      expected.insert(std::minmax(g, others[static_cast<std::size_t>(i)]));
  }
  const FlowGraph graph = knn_graph(cloud, {kNeighbours});
  std::set<std::pair<std::uint32_t, std::uint32_t>> found;
  for (std::uint32_t g = 0; g < graph.nodes(); ++g)
    for (std::uint32_t arc = graph.first_arc[g]; arc < graph.first_arc[g + 1]; ++arc) {
      CHECK(graph.head[graph.reverse_arc[arc]] == g);
      found.insert(std::minmax(g, graph.head[arc]));
    }
  CHECK(found == expected);
  CHECK(graph.arcs() == 2 * expected.size());
  for (const int threads : {1, 2, 3})
    tbb::task_arena(threads).execute([&] { CHECK(knn_graph(cloud, {kNeighbours}).head == graph.head); });
}

TEST_CASE("overlap distance of two equal spheres is d^2 / (4 s^2), at any scene scale") {
  for (const float scale : {0.01f, 1.0f, 100.0f}) {
    GaussianCloud pair;
    pair.resize(2, 0);
    pair.scale = {glm::vec3(0.5f * scale), glm::vec3(0.5f * scale)};
    pair.position = {glm::vec3(0), glm::vec3(2 * scale, 0, 0)};
    // The ridge adds 0.3 % to the variance.
    CHECK(overlap_distance(pair, 0, 1) == doctest::Approx(0.25 * 4 / (0.25 * 1.003)).epsilon(1e-4));
    CHECK(overlap_distance(pair, 0, 0) == doctest::Approx(0).epsilon(1e-5));
  }
}

TEST_CASE("overlap distance of concentric spheres of variance 1 and 4: 3 ln(2.5 / 2)") {
  GaussianCloud pair;
  pair.resize(2, 0);
  pair.scale = {glm::vec3(1), glm::vec3(2)};
  CHECK(overlap_distance(pair, 0, 1) == doctest::Approx(3 * std::log(1.25)).epsilon(5e-3));
}

TEST_CASE("terminals: w weighs source against sink, visibility scales both, unseen says nothing") {
  const GaussianCloud cloud = random_cloud(3, 1);
  const Likelihood seen{{1.0f, 0.25f, 0.0f}, {1000, 4, 0}};
  EnergyOptions options;
  options.v0_px_per_view_at_400 = 0.8f;
  const Terminals t = terminals(cloud, seen, 12, 400.0 * 300.0, options);  // v0 = 9.6 px
  CHECK(t.net[0] == std::llround(kCapacityScale));
  CHECK(t.net[1] == doctest::Approx((0.25 - 0.75) * 4 / 9.6 * kCapacityScale).epsilon(1e-5));
  CHECK(t.net[2] == 0);
}

TEST_CASE("paper weights: psi = exp(-gamma_p |dmu|^2) + exp(-gamma_c |dbeta|^2), times lambda") {
  GaussianCloud pair;
  pair.resize(2, 0);
  pair.position[1] = {1, 2, 2};
  pair.f_dc[1] = {0, 1, 0};
  const FlowGraph graph = graph_from_edges(2, std::vector<std::pair<std::uint32_t, std::uint32_t>>{{0, 1}});
  const auto capacity = arc_capacities(pair, graph, paper_energy());
  const double psi = std::exp(-0.1 * 9) + std::exp(-1.0);
  CHECK(capacity[0] == doctest::Approx(0.5 * psi * kCapacityScale).epsilon(1e-5));
  CHECK(capacity[1] == capacity[0]);
}

TEST_CASE("likelihood is the share of the weight inside the mask") {
  MaskedSums sums(2);
  sums.total = {4 * 65536, 0};
  sums.inside = {65536, 0};
  const Likelihood l = likelihood(sums);
  CHECK(l.w == std::vector<float>{0.25f, 0.0f});
  CHECK(l.seen_px == std::vector<float>{4.0f, 0.0f});
}

TEST_CASE("IoU, accuracy and bounds of two overlapping rectangles") {
  Mask a(20, 10), b(20, 10);
  for (int y = 2; y < 8; ++y)
    for (int x = 2; x < 10; ++x) {
      a.at(x, y) = kMaskObject;
      b.at(x + 4, y) = kMaskObject;
    }
  CHECK(iou(a, b) == doctest::Approx(24.0 / 72));
  CHECK(pixel_accuracy(a, b) == doctest::Approx(1 - 48.0 / 200));
  CHECK(bounds(b) == PixelRect{6, 2, 14, 8});
  CHECK(iou(Mask(4, 4), Mask(4, 4)) == 1);
}

TEST_CASE("the robot clicks the middle of the truth, then the middle of the largest error, then stops") {
  Mask truth(60, 40), mask(60, 40);
  for (int y = 10; y < 31; ++y)
    for (int x = 10; x < 31; ++x) truth.at(x, y) = kMaskObject;
  const auto first = robot_click(truth, mask);
  REQUIRE(first);
  CHECK(first->points_px[0] == glm::vec2(20.5f, 20.5f));
  mask = truth;
  for (int y = 15; y < 24; ++y)
    for (int x = 40; x < 49; ++x) mask.at(x, y) = kMaskObject;
  const auto second = robot_click(truth, mask);
  REQUIRE(second);
  CHECK(second->label == SeedLabel::kRest);
  CHECK(second->points_px[0] == glm::vec2(44.5f, 19.5f));
  CHECK_FALSE(robot_click(truth, truth));
}

namespace {

struct Balls {
  GaussianCloud cloud;
  std::vector<std::uint8_t> ball;  // per Gaussian: from 1; 0 is the floor
  std::vector<std::uint8_t> only(std::uint8_t number) const {
    std::vector<std::uint8_t> labels(ball.size());
    std::ranges::transform(ball, labels.begin(), [&](std::uint8_t b) { return b == number; });
    return labels;
  }
};

// Red balls of radius 0.5 on a grey floor (y down).
Balls balls_on_floor(const std::vector<glm::vec3>& centres_world) {
  constexpr std::size_t kBall = 3000, kFloor = 6000;
  Balls made;
  GaussianCloud& cloud = made.cloud;
  const std::size_t on_balls = kBall * centres_world.size();
  cloud.resize(on_balls + kFloor, 0);
  made.ball.assign(cloud.size(), 0);
  for (std::size_t g = 0; g < cloud.size(); ++g) {
    const double t = (static_cast<double>(g % kBall) + 0.5) / kBall,
                 turn = std::fmod(static_cast<double>(g) * 0.6180339887, 1.0);
    if (g < on_balls) {
      const double z = 1 - 2 * t, r = std::sqrt(1 - z * z), angle = 2 * std::numbers::pi * turn;
      cloud.position[g] =
          centres_world[g / kBall] + glm::vec3(0.5 * r * std::cos(angle), 0.5 * z, 0.5 * r * std::sin(angle));
      cloud.scale[g] = glm::vec3(0.025f);
      cloud.f_dc[g] = {1.4f, -1.2f, -1.2f};
      made.ball[g] = static_cast<std::uint8_t>(g / kBall + 1);
    } else {
      const double f = (static_cast<double>(g - on_balls) + 0.5) / kFloor;
      cloud.position[g] = glm::vec3(4 * f - 2, 0, 4 * turn - 2);
      cloud.scale[g] = {0.05f, 0.005f, 0.05f};
      cloud.f_dc[g] = {0.3f, 0.35f, 0.4f};
    }
    cloud.opacity[g] = 0.95f;
    cloud.file_row[g] = static_cast<std::uint32_t>(g);
  }
  return made;
}

}  // namespace

TEST_CASE("pipeline: two balls of one colour that touch are told apart by clicks") {
  const std::vector<glm::vec3> centres = {{-0.5f, -0.52f, 0}, {0.5f, -0.52f, 0}};
  const Balls made = balls_on_floor(centres);
  const Camera camera = look_at({0, -1.2f, -4}, {0, -0.4f, 0}, {0, -1, 0}, 0.8f, 320, 240);
  const auto on = [&](const glm::vec3& point_world, SeedLabel label) {
    return click(camera.pixel_from_camera(camera.camera_from_world(point_world)), label);
  };
  const auto cut_by = [&](const Strokes& strokes) {
    return cut_in_view(made.cloud, camera, {0, -1, 0}, strokes, preset("default")).labels;
  };
  for (const std::uint8_t wanted : std::array<std::uint8_t, 2>{1, 2}) {
    const glm::vec3 &mine = centres[wanted - 1u], &other = centres[2u - wanted];
    const Stroke rest = on(other, SeedLabel::kRest);
    CHECK(label_iou(made.only(wanted), cut_by({on(mine, SeedLabel::kObject), rest})) > 0.95);
    // Clicked where they touch, a little on its side.
    const glm::vec3 between = glm::mix(mine, other, 0.45f) - glm::vec3(0, 0, 0.15f);
    CHECK(label_iou(made.only(wanted), cut_by({on(between, SeedLabel::kObject), rest})) > 0.9);
  }
}

TEST_CASE("pipeline: one click cuts a ball off its floor, the same on 1 and 2 threads") {
  const Balls made = balls_on_floor({{0, -0.52f, 0}});
  const GaussianCloud& cloud = made.cloud;
  const std::vector<std::uint8_t> truth = made.only(1);
  const Camera camera = look_at({0, -1.2f, -3}, {0, -0.4f, 0}, {0, -1, 0}, 0.8f, 320, 240);
  const glm::vec3 ball_camera = camera.camera_from_world({0, -0.52f, 0});
  const Strokes strokes = {click(camera.pixel_from_camera(ball_camera), SeedLabel::kObject)};
  const CutResult report = cut_in_view(cloud, camera, {0, -1, 0}, strokes, CutSettings());
  REQUIRE(report.outcome == Outcome::kDone);
  std::size_t wrong = 0;
  for (std::size_t g = 0; g < cloud.size(); ++g) wrong += report.labels[g] != truth[g];
  CHECK(wrong < cloud.size() / 100);
  tbb::task_arena(1).execute([&] {
    CHECK(cut_in_view(cloud, camera, {0, -1, 0}, strokes, CutSettings()).labels == report.labels);
  });

  // Small in its first view: more pixels there, and no more than usual where cameras come near.
  CutSettings coarse = preset("default");
  coarse.work_width_px = 80;
  coarse.orbit.views = kViewsAround;
  const CutResult small = cut_in_view(cloud, camera, {0, -1, 0}, strokes, coarse);
  REQUIRE(small.views.size() > 1);
  CHECK(small.views.front().camera.width_px > 150);
  for (const ViewReport& view : std::span(small.views).subspan(1)) CHECK(view.camera.width_px == 80);
  CHECK(label_iou(truth, small.labels) > 0.95);
}

TEST_CASE(
    "trim: a faint splat that sticks out leaves the object, one behind something nearer and one unseen "
    "stay") {
  // Depth 4: the object, solid (0); haze beside it in the open (1), haze beside it behind a nearer solid (2,
  // 3); outside of the picture (4).
  GaussianCloud cloud;
  cloud.resize(5, 0);
  cloud.position = {{0, 0, 4}, {1.2f, 0, 4}, {-1.2f, 0, 4}, {-0.6f, 0, 2}, {50, 0, 4}};
  for (std::size_t g = 0; g < cloud.size(); ++g) {
    const bool solid = g == 0 || g == 3;
    cloud.scale[g] = glm::vec3(solid ? 0.15f : 0.1f);
    cloud.opacity[g] = solid ? 0.99f : 0.3f;
  }
  const Camera camera = look_at({0, 0, 0}, {0, 0, 4}, {0, -1, 0}, 1.0f, 160, 120);
  const std::vector<std::uint8_t> labels = {1, 1, 1, 0, 1};
  const Mask mask = thresholded(render_labels(cloud, camera, labels), 0.5f);
  const auto trimmed = [&](const TrimView& view) {
    std::vector<std::uint8_t> left = labels;
    CHECK(trim(cloud, {&view, 1}, {}, &left) == 1);
    return left;
  };
  CHECK(trimmed({camera, &mask}) == std::vector<std::uint8_t>{1, 0, 1, 0, 1});
  RasterOptions whole_scene;
  whole_scene.depth = true;
  const Image<float> depth = rasterize(cloud, camera, whole_scene).median_depth;
  CHECK(trimmed({camera, &mask, &depth}) == std::vector<std::uint8_t>{1, 0, 1, 0, 1});
  const Image<float> open(camera.width_px,
                          camera.height_px);  // nothing is nearer: what sticks out leaves everywhere
  std::vector<std::uint8_t> left = labels;
  const TrimView view{camera, &mask, &open};
  CHECK(trim(cloud, {&view, 1}, {}, &left) == 2);
}

TEST_CASE("labelled rectangle: every pixel that shows a labelled Gaussian lies inside, few that do not") {
  for (int seed = 0; seed < 20; ++seed) {
    const GaussianCloud cloud = random_cloud(300, static_cast<std::uint64_t>(seed));
    const Camera camera = look_at({0.3f, -0.2f, -3}, {0, 0, 0}, {0, -1, 0}, 0.9f, 160, 120);
    std::vector<std::uint8_t> labels(cloud.size(), 0);
    for (std::size_t g = 0; g < 3; ++g) labels[(g * 97 + static_cast<std::size_t>(seed)) % labels.size()] = 1;
    RasterOptions options;
    options.shown = labels;
    const RasterOutput alone = rasterize(cloud, camera, options);
    const PixelRect rect = labelled_rectangle(cloud, camera, labels);
    bool all_inside = true;
    for (int y = 0; y < 120; ++y)
      for (int x = 0; x < 160; ++x)
        all_inside &=
            alone.alpha.at(x, y) == 0 || (x >= rect.x0 && x < rect.x1 && y >= rect.y0 && y < rect.y1);
    CHECK(all_inside);
    // The picture of labels is that of a rendering without a rectangle, bit for bit.
    std::vector<glm::vec3> white(cloud.size());
    for (std::size_t g = 0; g < cloud.size(); ++g) white[g] = glm::vec3(labels[g]);
    RasterOptions whole;
    whole.colour_override = white;
    const RasterOutput expected = rasterize(cloud, camera, whole);
    const Image<float> share = render_labels(cloud, camera, labels);
    bool same = true;
    for (std::size_t i = 0; i < share.size(); ++i) same &= share.pixels()[i] == expected.colour.pixels()[i].r;
    CHECK(same);
  }
}
