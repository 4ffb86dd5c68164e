#include "segment/k_nearest.h"

#include <algorithm>
#include <nanoflann.hpp>

#include "segment/parallel.h"

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

using Tree = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, PointSource>,
                                                 PointSource, 3, std::uint32_t>;

constexpr std::size_t kLeafSize = 16;

}  // namespace

std::vector<std::uint32_t> k_nearest(const std::vector<glm::vec3>& points, std::size_t k, const Job& job) {
  const std::size_t n = points.size();
  std::vector<std::uint32_t> neighbour(n * k, kNoNeighbour);
  if (n < 2 || k == 0) return neighbour;
  const PointSource source{points};
  Tree tree(3, source, nanoflann::KDTreeSingleIndexAdaptorParams(kLeafSize));
  tree.buildIndex();
  for_chunks(n, [&](std::size_t from, std::size_t to) {
    if (job.cancelled()) return;
    std::vector<std::uint32_t> found(k + 1);
    std::vector<float> distance2(k + 1);
    for (std::size_t g = from; g < to; ++g) {
      const std::size_t count = tree.knnSearch(&points[g].x, k + 1, found.data(), distance2.data());
      std::size_t used = 0;  // the point itself is among them, unless k + 1 twins lie on it
      for (std::size_t i = 0; i < count && used < k; ++i)
        if (found[i] != g) neighbour[g * k + used++] = found[i];
    }
  });
  return neighbour;
}

std::vector<std::uint32_t> k_nearest_of(const std::vector<glm::vec3>& points,
                                        const std::vector<glm::vec3>& queries, std::size_t k,
                                        const Job& job) {
  std::vector<std::uint32_t> neighbour(queries.size() * k, kNoNeighbour);
  if (points.empty() || k == 0) return neighbour;
  const PointSource source{points};
  Tree tree(3, source, nanoflann::KDTreeSingleIndexAdaptorParams(kLeafSize));
  tree.buildIndex();
  for_chunks(queries.size(), [&](std::size_t from, std::size_t to) {
    if (job.cancelled()) return;
    std::vector<float> distance2(k);
    for (std::size_t q = from; q < to; ++q)
      tree.knnSearch(&queries[q].x, k, &neighbour[q * k], distance2.data());
  });
  return neighbour;
}

}  // namespace splatcut
