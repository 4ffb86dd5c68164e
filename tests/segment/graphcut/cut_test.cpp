// The cut of real energies: warm solves against fresh ones, the proof of the sub-graph, confidence, weights.
#include "segment/graphcut/cut.h"

#include <doctest/doctest.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <glm/gtc/quaternion.hpp>

#include "cut_energy.h"
#include "places.h"
#include "scene/formats/scene_file.h"
#include "scene/raster/splat_math.h"
#include "segment/graphcut/k_nearest.h"
#include "segment/graphcut/knn_graph.h"
#include "segment/masks/mask_tools.h"
#include "still_life_mug.h"
#include "synthetic_cloud.h"

using namespace splatcut;
using namespace splatcut::testing;

namespace {

void add_view(const GaussianCloud& cloud, const Camera& camera, const std::vector<std::uint8_t>& object,
              int dilation_px, MaskedSums& sums) {
  add_masked_view(cloud, camera,
                  dilated(thresholded(render_labels(cloud, camera, object), 0.5f), dilation_px), sums);
}

struct Labelled {
  GaussianCloud cloud;
  std::vector<std::uint8_t> object;
  std::vector<Camera> cameras;
};

Labelled labelled_mug(std::size_t gaussians) {
  MugScene made = still_life_with_mug(gaussians);
  Labelled out{std::move(made.cloud), std::move(made.mug), {}};
  for (const Camera& camera : made.cameras) out.cameras.push_back(limited_to_width(camera, 160));
  return out;
}

// Views come one by one, as in the pipeline; after each, the solver that is kept must say what a fresh one
// says.
void check_view_by_view(const Labelled& scene, std::size_t views) {
  const FlowGraph graph = knn_graph(scene.cloud);
  const std::vector<std::int32_t> capacity = arc_capacities(scene.cloud, graph, {});
  CutSolver kept(scene.cloud, graph, {});
  MaskedSums sums(scene.cloud.size());
  for (std::size_t v = 0; v < views; ++v) {
    CAPTURE(v);
    add_view(scene.cloud, scene.cameras[v], scene.object, static_cast<int>(v % 3), sums);
    const Likelihood seen = likelihood(sums);
    const auto pixels = static_cast<double>(scene.cameras[v].width_px) * scene.cameras[v].height_px;
    const CutReport warm = kept.solve(seen, static_cast<int>(v) + 1, pixels);
    const CutReport fresh = CutSolver(scene.cloud, graph, {}).solve(seen, static_cast<int>(v) + 1, pixels);
    REQUIRE(warm.labels == fresh.labels);
    REQUIRE(warm.energy == fresh.energy);
    REQUIRE(warm.flow == warm.energy);
    REQUIRE(fresh.touched < graph.nodes());
    // The proof from the nodes touched alone, and the energy over the whole graph.
    const Terminals data = terminals(scene.cloud, seen, static_cast<int>(v) + 1, pixels, {});
    MaxFlow max_flow(graph, capacity);
    max_flow.set_terminals(data.net);
    REQUIRE(max_flow.solve());
    REQUIRE(max_flow.certified());
    REQUIRE(max_flow.flow() == cut_energy(graph, capacity, data.net, max_flow.source_set()));
    REQUIRE(max_flow.source_set() == warm.labels);
  }
}

double overlap_in_double(const GaussianCloud& cloud, std::size_t g, std::size_t h) {
  const auto sigma = [&](std::size_t i) {
    const glm::dmat3 r = glm::mat3_cast(glm::dquat(cloud.rotation[i]));
    const glm::dvec3 s(cloud.scale[i]);
    return r * glm::dmat3(s.x * s.x, 0, 0, 0, s.y * s.y, 0, 0, 0, s.z * s.z) * glm::transpose(r);
  };
  glm::dmat3 a = sigma(g), b = sigma(h), s = 0.5 * (a + b);
  const glm::dmat3 ridge(1e-3 * (s[0][0] + s[1][1] + s[2][2]));
  a += ridge, b += ridge, s += ridge;
  const glm::dvec3 d = glm::dvec3(cloud.position[g]) - glm::dvec3(cloud.position[h]);
  return 0.25 * glm::dot(d, glm::inverse(s) * d) +
         std::log(glm::determinant(s) / std::sqrt(glm::determinant(a) * glm::determinant(b)));
}

}  // namespace

TEST_CASE("overlap distance agrees with double precision for balls, plates and needles of mixed size") {
  for (const float scene_scale : {1e-3f, 1.0f, 1e3f}) {
    GaussianCloud cloud = random_cloud(400, 8, 0, 0.2f);
    for (std::size_t g = 0; g < cloud.size(); ++g) {
      if (g % 3 == 1) cloud.scale[g].x *= 1e-3f;
      if (g % 3 == 2) cloud.scale[g].y = cloud.scale[g].z = 1e-3f * cloud.scale[g].x;
      cloud.position[g] *= 0.2f * scene_scale;
      cloud.scale[g] *= scene_scale;
    }
    for (std::size_t g = 0; g + 1 < cloud.size(); ++g) {
      const double expected = overlap_in_double(cloud, g, g + 1);
      CHECK(overlap_distance(cloud, g, g + 1) == doctest::Approx(expected).epsilon(2e-3));
    }
  }
}

TEST_CASE("weights of Gaussians of infinite size are zero, of identical ones lambda") {
  GaussianCloud cloud;
  cloud.resize(3, 0);
  cloud.scale = {glm::vec3(0.1f), glm::vec3(0.1f), glm::vec3(std::numeric_limits<float>::infinity())};
  const FlowGraph graph =
      graph_from_edges(3, std::vector<std::pair<std::uint32_t, std::uint32_t>>{{0, 1}, {1, 2}});
  EnergyOptions options;
  options.lambda = 3;
  const auto capacity = arc_capacities(cloud, graph, options);
  CHECK(capacity[graph.first_arc[0]] == doctest::Approx(3 * kCapacityScale).epsilon(1e-6));
  CHECK(capacity[graph.first_arc[2]] == 0);
}

TEST_CASE("view by view, the kept solver's labels are a fresh solver's, and its sub-graph proves them") {
  check_view_by_view(labelled_mug(30000), 8);
}

TEST_CASE("after any change of the energy, the kept solver's labels are a fresh solver's") {
  const Labelled scene = labelled_mug(8000);
  const FlowGraph graph = knn_graph(scene.cloud);
  MaskedSums sums(scene.cloud.size());
  add_view(scene.cloud, scene.cameras[0], scene.object, 2, sums);
  const Likelihood seen = likelihood(sums);
  const auto pixels = static_cast<double>(scene.cameras[0].width_px) * scene.cameras[0].height_px;
  std::vector<CutOptions> all;
  for (const Pairwise& pairwise : pairwise_energies()) {
    CutOptions options;
    options.energy.pairwise = pairwise;
    all.push_back(options);
    constexpr std::array<float EnergyOptions::*, 6> kWeights = {
        &EnergyOptions::gamma_position, &EnergyOptions::gamma_colour, &EnergyOptions::lambda,
        &EnergyOptions::lambda_n,       &EnergyOptions::lambda_u,     &EnergyOptions::unseen_rest};
    for (float EnergyOptions::*weight : kWeights) {
      all.push_back(options);
      all.back().energy.*weight += 0.7f;
    }
  }
  CutSolver kept(scene.cloud, graph, {});
  std::vector<double> energies;
  for (std::size_t i = 0; i < all.size(); ++i) {
    CAPTURE(i);
    kept.set_options(all[i]);
    const CutReport warm = kept.solve(seen, 1, pixels);
    const CutReport fresh = CutSolver(scene.cloud, graph, all[i]).solve(seen, 1, pixels);
    CHECK(warm.labels == fresh.labels);
    CHECK(warm.energy == fresh.energy);
    energies.push_back(fresh.energy);
  }
  std::ranges::sort(energies);
  const auto distinct = std::ranges::unique(energies).begin() - energies.begin();
  CHECK(distinct > 3 * std::ssize(pairwise_energies()));  // what was changed, changes something
}

TEST_CASE("view by view, the same on a scene with a room around its objects") {
  Labelled scene{load_scene(project_folder() + "/assets/sample/sample.compressed.ply").cloud, {}, {}};
  // The object: what lies near the middle. Any set will do, the cut must be exact for it.
  const Box box = robust_bounds(scene.cloud.position, 0.5);
  const float reach = 0.3f * glm::length(box.extent());
  for (const glm::vec3& p : scene.cloud.position)
    scene.object.push_back(glm::distance(p, box.centre()) < reach);
  for (const glm::vec3& from :
       {glm::vec3(0, -0.4f, -1), glm::vec3(0.7f, -0.4f, 0.7f), glm::vec3(-0.9f, -0.3f, 0.2f)})
    scene.cameras.push_back(
        look_at(box.centre() + from * glm::length(box.extent()), box.centre(), {0, -1, 0}, 0.8f, 160, 120));
  check_view_by_view(scene, scene.cameras.size());
}

TEST_CASE("k nearest: many points in one place are neighbours of each other, and near ones of others") {
  constexpr std::size_t kTwins = 20000, kOthers = 300, kNear = 6;
  std::vector<glm::vec3> points = random_cloud(kOthers, 3).position;
  const glm::vec3 place = points[100];
  points.insert(points.begin() + 100, kTwins, place);
  const std::vector<std::uint32_t> nearest = k_nearest(points, kNear),
                                   of = k_nearest_of(points, points, kNear);
  std::vector<int> listed(points.size());
  for (std::size_t g = 0; g < points.size(); ++g) {
    std::vector<float> by_hand, others;
    for (std::size_t h = 0; h < points.size(); ++h) {
      if (h >= 100 + kNear + 1 && h < 100 + kTwins && g % 97 != 0) continue;  // as near as those before
      others.push_back(glm::distance(points[g], points[h]));
      if (h != g) by_hand.push_back(others.back());
    }
    std::partial_sort(by_hand.begin(), by_hand.begin() + kNear, by_hand.end());
    std::partial_sort(others.begin(), others.begin() + kNear, others.end());
    for (std::size_t i = 0; i < kNear; ++i) {
      const std::uint32_t h = nearest[g * kNear + i];
      REQUIRE((h < points.size() && h != g));
      REQUIRE(glm::distance(points[g], points[h]) == by_hand[i]);
      REQUIRE(glm::distance(points[g], points[of[g * kNear + i]]) == others[i]);
      ++listed[h];
    }
  }
  CHECK(*std::ranges::max_element(listed) < 200);  // no hub
}

TEST_CASE("k-NN graph: twins in one place, on any number of threads, every arc with its way back") {
  GaussianCloud cloud = random_cloud(500, 3);
  for (std::size_t g = 100; g < 140; ++g) cloud.position[g] = cloud.position[99];
  const FlowGraph graph = knn_graph(cloud, {6});
  for (std::uint32_t g = 0; g < graph.nodes(); ++g)
    for (std::uint32_t arc = graph.first_arc[g]; arc < graph.first_arc[g + 1]; ++arc) {
      REQUIRE(graph.head[arc] != g);
      REQUIRE(graph.head[graph.reverse_arc[arc]] == g);
      REQUIRE(graph.reverse_arc[graph.reverse_arc[arc]] == arc);
    }
  for (const int threads : {1, 3})
    tbb::task_arena(threads).execute([&] {
      const FlowGraph again = knn_graph(cloud, {6});
      CHECK(again.head == graph.head);
      CHECK(again.reverse_arc == graph.reverse_arc);
    });
}
