#include "segment/knn_graph.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <limits>
#include <nanoflann.hpp>

namespace splatcut {

namespace {

// nanoflann reads the positions in place through this.
struct PointSource {
  const std::vector<glm::vec3>& position;
  std::size_t kdtree_get_point_count() const { return position.size(); }
  float kdtree_get_pt(std::size_t i, std::size_t axis) const { return position[i][static_cast<int>(axis)]; }
  template <class Bounds>
  bool kdtree_get_bbox(Bounds&) const {
    return false;
  }
};

using Tree = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, PointSource>, PointSource, 3, std::uint32_t>;

constexpr std::size_t kLeafSize = 16, kChunk = 4096;

}  // namespace

FlowGraph knn_graph(const GaussianCloud& cloud, const KnnOptions& options, const Job& job) {
  const std::size_t n = cloud.size();
  const std::size_t k = std::min<std::size_t>(static_cast<std::size_t>(options.neighbours), n > 0 ? n - 1 : 0);
  if (k == 0) return graph_from_edges(n, {});
  const PointSource source{cloud.position};
  Tree tree(3, source, nanoflann::KDTreeSingleIndexAdaptorParams(kLeafSize));
  tree.buildIndex();
  constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
  std::vector<std::uint32_t> neighbour(n * k, kNone);
  tbb::parallel_for(std::size_t{0}, (n + kChunk - 1) / kChunk, [&](std::size_t chunk) {
    if (job.cancelled()) return;
    std::vector<std::uint32_t> found(k + 1);
    std::vector<float> distance2(k + 1);
    for (std::size_t g = chunk * kChunk; g < std::min(n, (chunk + 1) * kChunk); ++g) {
      const std::size_t count = tree.knnSearch(&cloud.position[g].x, k + 1, found.data(), distance2.data());
      std::size_t used = 0;  // the point itself is among them, unless k + 1 twins lie on it
      for (std::size_t i = 0; i < count && used < k; ++i)
        if (found[i] != g) neighbour[g * k + used++] = found[i];
    }
  });
  std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;
  edges.reserve(n * k * 2 / 3);
  const auto lists = [&](std::uint32_t g, std::uint32_t h) {
    return std::find(&neighbour[g * k], &neighbour[g * k] + k, h) != &neighbour[g * k] + k;
  };
  for (std::uint32_t g = 0; g < n; ++g)
    for (std::size_t i = 0; i < k; ++i) {
      const std::uint32_t h = neighbour[g * k + i];
      if (h != kNone && (g < h || !lists(h, g))) edges.emplace_back(g, h);
    }
  return graph_from_edges(n, edges);
}

}  // namespace splatcut
