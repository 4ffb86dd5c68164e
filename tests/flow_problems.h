// Random flow problems and solvers that share nothing with ours.
#pragma once

#include <algorithm>
#include <boost/graph/adjacency_list.hpp>
#include <boost/graph/boykov_kolmogorov_max_flow.hpp>
#include <limits>
#include <random>
#include <set>
#include <vector>

#include "cut_energy.h"
#include "segment/graphcut/flow_graph.h"

namespace splatcut::testing {

struct FlowProblem {
  FlowGraph graph;
  std::vector<std::int32_t> capacity;
  std::vector<std::int64_t> terminal;
};

// Capacities in [0, range), terminals in [-range, range): small ranges make ties and zeros common, few edges
// leave parts disconnected.
inline FlowProblem random_problem(std::mt19937& random, std::uint32_t nodes, std::size_t edge_count,
                                  int range) {
  std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
  for (std::size_t e = 0; e < edge_count; ++e) {
    const auto a = static_cast<std::uint32_t>(random() % nodes),
               b = static_cast<std::uint32_t>(random() % nodes);
    if (a != b) edges.insert(std::minmax(a, b));
  }
  FlowProblem p;
  p.graph = graph_from_edges(nodes, std::vector(edges.begin(), edges.end()));
  const auto below = [&](int limit) { return static_cast<int>(random() % static_cast<unsigned>(limit)); };
  for (std::size_t arc = 0; arc < p.graph.arcs(); ++arc) p.capacity.push_back(below(range));
  for (std::uint32_t n = 0; n < nodes; ++n) p.terminal.push_back(below(2 * range) - range);
  return p;
}

// A grid of width x height nodes with eight neighbours: a blob of sources in a field of sinks, noise on both.
inline FlowProblem grid_problem(std::mt19937& random, std::uint32_t width, std::uint32_t height,
                                int noise_percent) {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;
  const auto at = [&](std::uint32_t x, std::uint32_t y) { return y * width + x; };
  for (std::uint32_t y = 0; y < height; ++y)
    for (std::uint32_t x = 0; x < width; ++x) {
      if (x + 1 < width) edges.emplace_back(at(x, y), at(x + 1, y));
      if (y + 1 < height) edges.emplace_back(at(x, y), at(x, y + 1));
      if (x + 1 < width && y + 1 < height) edges.emplace_back(at(x, y), at(x + 1, y + 1));
      if (x > 0 && y + 1 < height) edges.emplace_back(at(x, y), at(x - 1, y + 1));
    }
  FlowProblem p;
  p.graph = graph_from_edges(static_cast<std::size_t>(width) * height, edges);
  p.capacity.resize(p.graph.arcs());
  for (std::uint32_t n = 0; n < p.graph.nodes(); ++n)
    for (std::uint32_t arc = p.graph.first_arc[n]; arc < p.graph.first_arc[n + 1]; ++arc)
      if (p.graph.head[arc] > n)
        p.capacity[arc] = p.capacity[p.graph.reverse_arc[arc]] = static_cast<int>(random() % 400);
  for (std::uint32_t y = 0; y < height; ++y)
    for (std::uint32_t x = 0; x < width; ++x) {
      const double dx = (x + 0.5) / width - 0.5, dy = (y + 0.5) / height - 0.5;
      const bool inside = dx * dx + dy * dy < 0.04;
      const bool flipped = static_cast<int>(random() % 100) < noise_percent;
      const auto strength = static_cast<std::int64_t>(random() % 1000);
      p.terminal.push_back(random() % 5 == 0 ? 0 : inside != flipped ? strength : -strength);
    }
  return p;
}

struct BruteForceCut {
  std::int64_t energy = std::numeric_limits<std::int64_t>::max();
  std::uint32_t source_set = 0;  // the smallest of the minimum cuts, a bit per node
};

// The least energy of all cuts.
inline BruteForceCut brute_force(const FlowProblem& p) {
  const auto nodes = static_cast<std::uint32_t>(p.graph.nodes());
  BruteForceCut best;
  std::vector<std::uint8_t> side(nodes);
  for (std::uint32_t cut = 0; cut < (1u << nodes); ++cut) {
    for (std::uint32_t n = 0; n < nodes; ++n) side[n] = cut >> n & 1;
    const std::int64_t energy = cut_energy(p.graph, p.capacity, p.terminal, side);
    if (energy < best.energy)
      best = {energy, cut};
    else if (energy == best.energy)
      best.source_set &= cut;  // minimum cuts are closed under intersection
  }
  return best;
}

inline std::int64_t boost_flow(const FlowProblem& p) {
  using namespace boost;
  using Traits = adjacency_list_traits<vecS, vecS, directedS>;
  using Predecessor = property<vertex_predecessor_t, Traits::edge_descriptor>;
  using Vertex =
      property<vertex_index_t, long,
               property<vertex_color_t, default_color_type, property<vertex_distance_t, long, Predecessor>>>;
  using Edge =
      property<edge_capacity_t, long,
               property<edge_residual_capacity_t, long, property<edge_reverse_t, Traits::edge_descriptor>>>;
  const std::size_t nodes = p.graph.nodes();
  adjacency_list<vecS, vecS, directedS, Vertex, Edge> g(nodes + 2);
  auto capacity = get(edge_capacity, g);
  auto reverse = get(edge_reverse, g);
  const auto add = [&](std::size_t a, std::size_t b, long there, long back) {
    const auto e = add_edge(a, b, g).first, r = add_edge(b, a, g).first;
    capacity[e] = there;
    capacity[r] = back;
    reverse[e] = r;
    reverse[r] = e;
  };
  for (std::uint32_t n = 0; n < nodes; ++n) {
    if (p.terminal[n] > 0) add(nodes, n, p.terminal[n], 0);
    if (p.terminal[n] < 0) add(n, nodes + 1, -p.terminal[n], 0);
    for (std::uint32_t arc = p.graph.first_arc[n]; arc < p.graph.first_arc[n + 1]; ++arc)
      if (p.graph.head[arc] > n)
        add(n, p.graph.head[arc], p.capacity[arc], p.capacity[p.graph.reverse_arc[arc]]);
  }
  return boykov_kolmogorov_max_flow(g, nodes, nodes + 1);
}

}  // namespace splatcut::testing
