#include "segment/max_flow.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <boost/graph/adjacency_list.hpp>
#include <boost/graph/boykov_kolmogorov_max_flow.hpp>
#include <random>
#include <set>

using namespace splatcut;

namespace {

struct Problem {
  FlowGraph graph;
  std::vector<std::int32_t> capacity;
  std::vector<std::int64_t> terminal;
};

// Small ranges make ties and zero capacities common; few edges leave parts disconnected.
Problem random_problem(std::mt19937& random, std::uint32_t nodes, std::size_t edge_count, int range) {
  std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
  for (std::size_t e = 0; e < edge_count; ++e) {
    const auto a = static_cast<std::uint32_t>(random() % nodes), b = static_cast<std::uint32_t>(random() % nodes);
    if (a != b) edges.insert(std::minmax(a, b));
  }
  Problem p;
  p.graph = graph_from_edges(nodes, std::vector(edges.begin(), edges.end()));
  for (std::size_t arc = 0; arc < p.graph.arcs(); ++arc) p.capacity.push_back(static_cast<std::int32_t>(random() % range));
  for (std::uint32_t n = 0; n < nodes; ++n) p.terminal.push_back(static_cast<std::int64_t>(random() % (2 * range)) - range);
  return p;
}

std::int64_t boost_flow(const Problem& p) {
  using Traits = boost::adjacency_list_traits<boost::vecS, boost::vecS, boost::directedS>;
  using Graph = boost::adjacency_list<
      boost::vecS, boost::vecS, boost::directedS,
      boost::property<boost::vertex_index_t, long,
                      boost::property<boost::vertex_color_t, boost::default_color_type,
                                      boost::property<boost::vertex_distance_t, long,
                                                      boost::property<boost::vertex_predecessor_t, Traits::edge_descriptor>>>>,
      boost::property<boost::edge_capacity_t, long,
                      boost::property<boost::edge_residual_capacity_t, long,
                                      boost::property<boost::edge_reverse_t, Traits::edge_descriptor>>>>;
  const std::size_t nodes = p.graph.nodes();
  Graph g(nodes + 2);
  auto capacity = boost::get(boost::edge_capacity, g);
  auto reverse = boost::get(boost::edge_reverse, g);
  const auto add = [&](std::size_t a, std::size_t b, long there, long back) {
    const auto e = boost::add_edge(a, b, g).first, r = boost::add_edge(b, a, g).first;
    capacity[e] = there;
    capacity[r] = back;
    reverse[e] = r;
    reverse[r] = e;
  };
  for (std::uint32_t n = 0; n < nodes; ++n) {
    if (p.terminal[n] > 0) add(nodes, n, p.terminal[n], 0);
    if (p.terminal[n] < 0) add(n, nodes + 1, -p.terminal[n], 0);
    for (std::uint32_t arc = p.graph.first_arc[n]; arc < p.graph.first_arc[n + 1]; ++arc)
      if (p.graph.head[arc] > n) add(n, p.graph.head[arc], p.capacity[arc], p.capacity[p.graph.reverse_arc[arc]]);
  }
  return boost::boykov_kolmogorov_max_flow(g, nodes, nodes + 1);
}

}  // namespace

TEST_CASE("min_cut finds the least energy, and its smallest source set, of all cuts of 1000 small graphs") {
  std::mt19937 random(5);
  for (int trial = 0; trial < 1000; ++trial) {
    CAPTURE(trial);
    const auto nodes = static_cast<std::uint32_t>(2 + random() % 11);
    const Problem p = random_problem(random, nodes, random() % (3 * nodes), 1 + static_cast<int>(random() % 12));
    std::int64_t best = std::numeric_limits<std::int64_t>::max();
    std::uint32_t smallest = 0;
    std::vector<std::uint8_t> side(nodes);
    for (std::uint32_t cut = 0; cut < (1u << nodes); ++cut) {
      for (std::uint32_t n = 0; n < nodes; ++n) side[n] = cut >> n & 1;
      const std::int64_t energy = cut_energy(p.graph, p.capacity, p.terminal, side);
      if (energy < best) smallest = cut;
      else if (energy == best) smallest &= cut;  // minimum cuts are closed under intersection
      best = std::min(best, energy);
    }
    const MinCutReport report = min_cut(p.graph, p.capacity, p.terminal);
    REQUIRE(report.energy == best);
    REQUIRE(report.flow == best);
    for (std::uint32_t n = 0; n < nodes; ++n) REQUIRE(report.source_side[n] == (smallest >> n & 1));
  }
}

TEST_CASE("min_cut has the flow of Boost's solver on graphs of up to 50,000 nodes") {
  std::mt19937 random(9);
  for (const std::uint32_t nodes : {200u, 2000u, 2000u, 20000u, 50000u}) {
    CAPTURE(nodes);
    const Problem p = random_problem(random, nodes, 4 * nodes, 1000);
    const MinCutReport report = min_cut(p.graph, p.capacity, p.terminal);
    CHECK(report.flow == boost_flow(p));
    CHECK(report.energy == report.flow);
  }
}

TEST_CASE("a path of three nodes, by hand") {
  const std::vector<std::pair<std::uint32_t, std::uint32_t>> edges = {{0, 1}, {1, 2}};
  const FlowGraph graph = graph_from_edges(3, edges);
  std::vector<std::int32_t> capacity(4, 0);
  capacity[graph.first_arc[0]] = 5;      // 0 -> 1
  capacity[graph.first_arc[1] + 1] = 3;  // 1 -> 2
  const std::vector<std::int64_t> terminal = {10, 0, -10};
  const MinCutReport report = min_cut(graph, capacity, terminal, 7);
  CHECK(report.flow == 7 + 3 + 0);
  CHECK(report.source_side == std::vector<std::uint8_t>{1, 1, 0});
}
