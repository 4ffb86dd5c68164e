#include "other_solvers.h"

#include <boost/graph/boykov_kolmogorov_max_flow.hpp>
#include <boost/graph/compressed_sparse_row_graph.hpp>
#include <boost/graph/push_relabel_max_flow.hpp>
#include <boost/range/iterator_range.hpp>
#include <opencv2/core.hpp>
#include <opencv2/imgproc/detail/gcgraph.hpp>

namespace splatcut::bench {

namespace {

using Row = boost::compressed_sparse_row_graph<boost::directedS>;
using Edge = boost::graph_traits<Row>::edge_descriptor;

// The problem with source and sink as nodes, in Boost's compressed rows, the fastest of its graphs to build
// and to walk.
struct BoostGraph {
  Row graph;
  std::vector<long> capacity, residual;
  std::vector<Edge> reverse;
  std::size_t source, sink;

  explicit BoostGraph(const CutProblem& p) : source(p.graph.nodes()), sink(p.graph.nodes() + 1) {
    const std::size_t n = p.graph.nodes();
    std::vector<std::pair<std::size_t, std::size_t>> ends;
    std::vector<std::size_t> back;  // index of the reverse edge
    ends.reserve(p.graph.arcs() + 2 * n);
    std::vector<std::size_t> at(p.graph.arcs()), source_at(n, 0);
    for (std::uint32_t v = 0; v < n; ++v) {
      for (std::uint32_t arc = p.graph.first_arc[v]; arc < p.graph.first_arc[v + 1]; ++arc) {
        at[arc] = ends.size();
        ends.emplace_back(v, p.graph.head[arc]);
        capacity.push_back(p.capacity[arc]);
      }
      if (p.terminal[v] == 0) continue;
      source_at[v] = ends.size();
      ends.emplace_back(v, p.terminal[v] > 0 ? source : sink);
      capacity.push_back(p.terminal[v] > 0 ? 0 : -p.terminal[v]);
    }
    std::vector<std::size_t> partner(ends.size());
    for (std::size_t arc = 0; arc < at.size(); ++arc) partner[at[arc]] = at[p.graph.reverse_arc[arc]];
    for (const bool from_source : {true, false})
      for (std::uint32_t v = 0; v < n; ++v) {
        if (p.terminal[v] == 0 || (p.terminal[v] > 0) != from_source) continue;
        partner[source_at[v]] = ends.size();
        partner.push_back(source_at[v]);
        ends.emplace_back(from_source ? source : sink, v);
        capacity.push_back(from_source ? p.terminal[v] : 0);
      }
    graph = Row(boost::edges_are_sorted, ends.begin(), ends.end(), n + 2);
    residual.resize(ends.size());
    std::vector<Edge> all(ends.size());
    for (const Edge e : boost::make_iterator_range(edges(graph))) all[get(boost::edge_index, graph, e)] = e;
    reverse.resize(ends.size());
    for (std::size_t e = 0; e < ends.size(); ++e) reverse[e] = all[partner[e]];
  }
  template <class T>
  auto edge_map(std::vector<T>& values) {
    return boost::make_iterator_property_map(values.begin(), get(boost::edge_index, graph));
  }
  template <class T>
  auto vertex_map(std::vector<T>& values) {
    return boost::make_iterator_property_map(values.begin(), get(boost::vertex_index, graph));
  }
};

}  // namespace

std::int64_t boost_boykov_kolmogorov(const CutProblem& problem) {
  BoostGraph g(problem);
  const std::size_t n = num_vertices(g.graph);
  std::vector<Edge> predecessor(n);
  std::vector<boost::default_color_type> colour(n);
  std::vector<long> distance(n);
  return boost::boykov_kolmogorov_max_flow(g.graph, g.edge_map(g.capacity), g.edge_map(g.residual),
                                           g.edge_map(g.reverse), g.vertex_map(predecessor),
                                           g.vertex_map(colour), g.vertex_map(distance),
                                           get(boost::vertex_index, g.graph), g.source, g.sink);
}

std::int64_t boost_push_relabel(const CutProblem& problem) {
  BoostGraph g(problem);
  return boost::push_relabel_max_flow(g.graph, g.source, g.sink, g.edge_map(g.capacity),
                                      g.edge_map(g.residual), g.edge_map(g.reverse),
                                      get(boost::vertex_index, g.graph));
}

std::int64_t opencv_gcgraph(const CutProblem& p) {
  const auto n = static_cast<unsigned>(p.graph.nodes());
  cv::detail::GCGraph<long long> g(n, static_cast<unsigned>(p.graph.arcs()));
  for (std::uint32_t v = 0; v < n; ++v) {
    g.addVtx();
    g.addTermWeights(static_cast<int>(v), std::max<std::int64_t>(p.terminal[v], 0),
                     std::max<std::int64_t>(-p.terminal[v], 0));
  }
  for (std::uint32_t v = 0; v < n; ++v)
    for (std::uint32_t arc = p.graph.first_arc[v]; arc < p.graph.first_arc[v + 1]; ++arc)
      if (p.graph.head[arc] > v)
        g.addEdges(static_cast<int>(v), static_cast<int>(p.graph.head[arc]), p.capacity[arc],
                   p.capacity[p.graph.reverse_arc[arc]]);
  return g.maxFlow();
}

}  // namespace splatcut::bench
