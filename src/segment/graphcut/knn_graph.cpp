#include "segment/graphcut/knn_graph.h"

#include <algorithm>
#include <atomic>
#include <cassert>
#include <utility>

#include "core/parallel.h"
#include "segment/graphcut/k_nearest.h"

namespace splatcut {

namespace {

using Counts = std::vector<std::atomic<std::uint32_t>>;

// The lists of k_nearest, all of them full, as directed edges g -> h. An arc of g is one of its list, or
// leads back to a node that lists g without being listed by it.
struct Lists {
  static constexpr std::uint8_t kNowhere = 255;

  std::vector<std::uint32_t> neighbour;
  std::size_t k;
  std::vector<std::uint8_t>
      place_of_me;   // per entry g -> h: where g stands in h's list, kNowhere if it does not
  Counts one_sided;  // per node: by how many it is listed without listing them

  Lists(std::vector<std::uint32_t> nearest, std::size_t n, std::size_t per_node)
      : neighbour(std::move(nearest)), k(per_node), place_of_me(n * per_node), one_sided(n) {
    for_each_index(n, [&](std::size_t node) {
      const auto g = static_cast<std::uint32_t>(node);
      for (std::size_t i = g * k; i < (g + 1) * k; ++i) {
        place_of_me[i] = place(neighbour[i], g);
        if (place_of_me[i] == kNowhere) one_sided[neighbour[i]].fetch_add(1, std::memory_order_relaxed);
      }
    });
  }
  std::uint8_t place(std::uint32_t in, std::uint32_t wanted) const {
    std::uint8_t found = kNowhere;  // no early exit: a loop without branches costs less
    for (std::size_t i = 0; i < k; ++i)
      found = neighbour[in * k + i] == wanted ? static_cast<std::uint8_t>(i) : found;
    return found;
  }
};

// The arcs of a node: its list, nearest first, then the one-sided ones by their node.
void fill_heads(Lists& lists, FlowGraph& graph) {
  const std::size_t k = lists.k;
  for_each_index(graph.nodes(), [&](std::size_t node) {
    const auto g = static_cast<std::uint32_t>(node);
    for (std::size_t i = 0; i < k; ++i) {
      const std::uint32_t h = lists.neighbour[g * k + i];
      graph.head[graph.first_arc[g] + i] = h;
      if (lists.place_of_me[g * k + i] ==
          Lists::kNowhere)  // threads race for the places; the sort settles the order
        graph.head[graph.first_arc[h + 1] - lists.one_sided[h].fetch_sub(1, std::memory_order_relaxed)] = g;
    }
  });
  for_each_index(graph.nodes(), [&](std::size_t node) {
    const auto g = static_cast<std::uint32_t>(node);
    std::sort(&graph.head[graph.first_arc[g]] + k,
              &graph.head[graph.first_arc[g]] + (graph.first_arc[g + 1] - graph.first_arc[g]));
  });
}

void pair_arcs(const Lists& lists, FlowGraph& graph) {
  const std::size_t k = lists.k;
  for_each_index(graph.nodes(), [&](std::size_t node) {
    const auto g = static_cast<std::uint32_t>(node);
    for (std::size_t i = 0; i < k; ++i) {
      const std::uint32_t h = lists.neighbour[g * k + i],
                          arc = graph.first_arc[g] + static_cast<std::uint32_t>(i);
      const std::uint8_t place = lists.place_of_me[g * k + i];
      std::uint32_t back = graph.first_arc[h] + place;
      if (place == Lists::kNowhere) {
        back = graph.first_arc[h] + static_cast<std::uint32_t>(k);
        while (graph.head[back] != g) ++back;
        graph.reverse_arc[back] = arc;
      }
      graph.reverse_arc[arc] = back;
    }
  });
}

}  // namespace

FlowGraph knn_graph(const GaussianCloud& cloud, const KnnOptions& options, const Job& job) {
  const std::size_t n = cloud.size();
  assert(options.neighbours < Lists::kNowhere);
  const std::size_t k =
      std::min<std::size_t>(static_cast<std::size_t>(options.neighbours), n > 0 ? n - 1 : 0);
  if (k == 0) return graph_from_edges(n, {});
  std::vector<std::uint32_t> nearest = k_nearest(cloud.position, k, job);
  if (job.cancelled()) return graph_from_edges(n, {});
  Lists lists(std::move(nearest), n, k);
  FlowGraph graph;
  graph.listed = static_cast<std::uint32_t>(k);
  graph.first_arc.assign(n + 1, 0);
  for (std::size_t g = 0; g < n; ++g)
    graph.first_arc[g + 1] = graph.first_arc[g] + static_cast<std::uint32_t>(k) + lists.one_sided[g];
  graph.head.resize(graph.first_arc.back());
  graph.reverse_arc.resize(graph.first_arc.back());
  fill_heads(lists, graph);
  pair_arcs(lists, graph);
  return graph;
}

}  // namespace splatcut
