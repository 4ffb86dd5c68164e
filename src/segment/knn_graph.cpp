#include "segment/knn_graph.h"

#include <algorithm>

#include "segment/k_nearest.h"

namespace splatcut {

FlowGraph knn_graph(const GaussianCloud& cloud, const KnnOptions& options, const Job& job) {
  const std::size_t n = cloud.size();
  const std::size_t k = std::min<std::size_t>(static_cast<std::size_t>(options.neighbours), n > 0 ? n - 1 : 0);
  if (k == 0) return graph_from_edges(n, {});
  const std::vector<std::uint32_t> neighbour = k_nearest(cloud.position, k, job);
  std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;
  edges.reserve(n * k * 2 / 3);
  const auto lists = [&](std::uint32_t g, std::uint32_t h) {
    return std::find(&neighbour[g * k], &neighbour[g * k] + k, h) != &neighbour[g * k] + k;
  };
  for (std::uint32_t g = 0; g < n; ++g)
    for (std::size_t i = 0; i < k; ++i) {
      const std::uint32_t h = neighbour[g * k + i];
      if (h != kNoNeighbour && (g < h || !lists(h, g))) edges.emplace_back(g, h);
    }
  return graph_from_edges(n, edges);
}

}  // namespace splatcut
