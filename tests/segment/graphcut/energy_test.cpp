// Every term of the energy on a handful of Gaussians, against its formula worked out by hand.
#include "segment/graphcut/energy.h"

#include <doctest/doctest.h>

#include <cmath>

#include "segment/graphcut/knn_graph.h"
#include "segment/session/session.h"

using namespace splatcut;

namespace {

// Three balls on a line at 0, 1, 3; the last has another colour, at distance 2 in f_dc.
GaussianCloud three_on_a_line() {
  GaussianCloud cloud;
  cloud.resize(3, 0);
  cloud.position = {{0, 0, 0}, {1, 0, 0}, {3, 0, 0}};
  cloud.scale.assign(3, glm::vec3(0.5f));
  cloud.f_dc[2] = {0, 2, 0};
  return cloud;
}

// psi of an edge, from its capacity.
double psi(const GaussianCloud& cloud, const FlowGraph& graph, const EnergyOptions& options,
           std::uint32_t from, std::uint32_t to) {
  const auto capacity = arc_capacities(cloud, graph, options);
  for (std::uint32_t arc = graph.first_arc[from]; arc < graph.first_arc[from + 1]; ++arc)
    if (graph.head[arc] == to) {
      CHECK(capacity[arc] == capacity[graph.reverse_arc[arc]]);
      return capacity[arc] / kCapacityScale / static_cast<double>(options.lambda);
    }
  FAIL("no such edge");
  return 0;
}

constexpr double kRounded = 2e-6;  // of capacities

}  // namespace

TEST_CASE("overlap: every part of psi can be left out, and what is left is its formula") {
  GaussianCloud cloud = three_on_a_line();
  const FlowGraph graph = knn_graph(cloud, {1});
  EnergyOptions options;
  options.gamma_position = options.gamma_colour = 0;
  CHECK(psi(cloud, graph, options, 1, 2) == doctest::Approx(1).epsilon(kRounded));
  options.gamma_colour = 0.5f;
  CHECK(psi(cloud, graph, options, 1, 2) == doctest::Approx(std::exp(-0.5 * 4)).epsilon(kRounded));
  options.gamma_position = 0.2f;
  // Two balls of variance 1/4 two apart: D = 1/4 * 4 / (1/4 + ridge of 3e-3 / 4).
  CHECK(psi(cloud, graph, options, 1, 2) ==
        doctest::Approx(std::exp(-0.5 * 4 - 0.2 * 4 / 1.003)).epsilon(1e-4));
}

TEST_CASE("overlap: Gaussians without size hold together alike in any unit, and wholly at one place") {
  EnergyOptions options;
  options.gamma_colour = 0;
  options.gamma_position = 0.01f;
  for (const float unit : {1e-6f, 1e-3f, 1.0f, 1e3f, 1e6f}) {
    CAPTURE(unit);
    GaussianCloud cloud = three_on_a_line();
    cloud.scale.assign(3, glm::vec3(0));
    for (glm::vec3& position : cloud.position) position *= unit;
    const FlowGraph graph = knn_graph(cloud, {1});
    // S is the ridge alone, a thousandth of the squared distance: D = 1/4 of 1000.
    CHECK(psi(cloud, graph, options, 1, 2) == doctest::Approx(std::exp(-0.01 * 250)).epsilon(1e-4));
    cloud.position[1] = cloud.position[2];
    CHECK(psi(cloud, graph, options, 1, 2) == doctest::Approx(1).epsilon(kRounded));
  }
}

TEST_CASE("paper-code: plain distances, half and half, mutual neighbours twice") {
  const GaussianCloud cloud = three_on_a_line();
  const FlowGraph graph = knn_graph(cloud, {1});  // 0 and 1 choose each other, 2 chooses 1
  const EnergyOptions options = paper_code_energy();
  const auto weight = [&](std::uint32_t g, std::uint32_t h) {
    return static_cast<double>(options.lambda) * psi(cloud, graph, options, g, h);
  };
  CHECK(weight(0, 1) == doctest::Approx(2 * (0.5 * std::exp(-1.0) + 0.5)).epsilon(kRounded));
  CHECK(weight(1, 2) == doctest::Approx(0.5 * std::exp(-2.0) + 0.5 * std::exp(-2.0)).epsilon(kRounded));
}

TEST_CASE("the largest lambda on the largest psi stays within what the maximum flow takes") {
  GaussianCloud cloud;
  cloud.resize(2, 0);
  EnergyOptions options = paper_code_energy();
  options.lambda = 500;
  for (const std::int32_t c : arc_capacities(cloud, knn_graph(cloud, {1}), options))
    CHECK(c == (1 << 30) - 1);
}

TEST_CASE("data term: visibility on and off, what no view has seen") {
  const GaussianCloud cloud = three_on_a_line();
  const Likelihood seen{{1.0f, 0.25f, 0.0f}, {1000, 4.8f, 0}};
  const auto net = [&](const EnergyOptions& options, std::size_t g) {
    return static_cast<double>(terminals(cloud, seen, 12, 400.0 * 300.0, options).net[g]) /
           kCapacityScale;  // v0 = 9.6 px
  };
  EnergyOptions options;
  options.v0_px_per_view_at_400 = 0.8f;
  CHECK(net(options, 0) == doctest::Approx(1).epsilon(kRounded));
  CHECK(net(options, 1) == doctest::Approx(-0.5 * 0.5).epsilon(kRounded));
  CHECK(net(options, 2) == 0);
  options.visibility = false;
  CHECK(net(options, 1) == doctest::Approx(-0.5).epsilon(kRounded));
  CHECK(net(options, 2) == 0);
  options.unseen_rest = 0.25f;
  CHECK(net(options, 2) == -0.25);
}

TEST_CASE("cluster term: the likest cluster of either side") {
  // Confident: 0 and 1 object, 2 and 3 rest; 4 is in doubt.
  GaussianCloud cloud;
  cloud.resize(5, 0);
  cloud.position = {{0, 0, 0}, {2, 0, 0}, {10, 0, 0}, {14, 0, 0}, {4, 0, 0}};
  cloud.f_dc = {{1, 0, 0}, {0, 0, 0}, {0, 1, 0}, {0, 0, 0}, {0, 0, 0}};
  const Likelihood seen{{1, 0.95f, 0, 0.05f, 0.5f}, {99, 99, 99, 99, 99}};
  const auto net = [&](const EnergyOptions& options) {
    const Terminals t = terminals(cloud, seen, 1, 400.0 * 300.0, options);
    return static_cast<double>(t.net[4]) / kCapacityScale;  // of the data term alone: 0
  };
  EnergyOptions paper = paper_energy();  // object cluster at (1, 0, 0), colour (1/2, 0, 0)
  paper.rest_clusters = 2;               // 2 and 3 themselves
  const double likest_rest = std::max(std::exp(-36.0) + std::exp(-1.0), std::exp(-100.0) + 1);
  CHECK(net(paper) == doctest::Approx(std::exp(-9.0) + std::exp(-0.25) - likest_rest).epsilon(1e-5));
  paper.gamma_cluster_colour = 0;
  CHECK(net(paper) == doctest::Approx(std::exp(-9.0) - std::exp(-36.0)).epsilon(1e-4));
  paper.lambda_u = 0;
  CHECK(net(paper) == 0);
  const EnergyOptions code =
      paper_code_energy();  // a cluster per Gaussian, mean colours (1/2, 0, 0) and (0, 1/2, 0)
  CHECK(net(code) == doctest::Approx(0.5 * (std::exp(-0.1 * 2) - std::exp(-0.1 * 6))).epsilon(1e-5));
}

TEST_CASE("presets: paper-code has the settings of the published code") {
  const CutSettings options = preset("paper-code");
  CHECK(options.neighbours == 9);
  CHECK(options.cut.energy.pairwise == Pairwise::kPaperCode);
  CHECK(options.cut.energy.object_clusters == 5);
  CHECK(options.cut.energy.rest_clusters == 5);
  CHECK_FALSE(options.cut.energy.visibility);
}
