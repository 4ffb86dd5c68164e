#include "segment/graphcut/k_nearest.h"

#include <algorithm>
#include <nanoflann.hpp>

#include "core/parallel.h"

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

// Points in a row that all lie in one place, as copies do in Morton order: a search there would look at each
// of them.
struct Run {
  std::size_t begin, end;
};

std::vector<Run> runs_longer_than(std::size_t most, const std::vector<glm::vec3>& points) {
  std::vector<Run> runs;
  for (std::size_t begin = 0, end = 0; begin < points.size(); begin = end) {
    for (end = begin + 1; end < points.size() && points[end] == points[begin];) ++end;
    if (end - begin > most) runs.push_back({begin, end});
  }
  return runs;
}

// The points, at most `most` of each run of equal ones: any of a run is as near as the others.
struct Thinned {
  std::vector<glm::vec3> points;
  std::vector<std::uint32_t> original;
};

Thinned thinned(const std::vector<glm::vec3>& points, const std::vector<Run>& runs, std::size_t most) {
  Thinned out;
  auto run = runs.begin();
  for (std::size_t g = 0; g < points.size(); ++g) {
    if (run != runs.end() && g == run->begin + most) g = (run++)->end;
    if (g == points.size()) break;
    out.points.push_back(points[g]);
    out.original.push_back(static_cast<std::uint32_t>(g));
  }
  return out;
}

// Neighbours in a long run are those that follow, round and round: no point has more than k that list it.
std::vector<std::uint32_t> k_nearest_with_runs(const std::vector<glm::vec3>& points,
                                               const std::vector<Run>& runs, std::size_t k, const Job& job) {
  const Thinned few = thinned(points, runs, k + 1);
  const std::vector<std::uint32_t> of_few = k_nearest(few.points, k, job);
  std::vector<std::uint32_t> neighbour(points.size() * k, kNoNeighbour);
  for (std::size_t g = 0; g < few.points.size(); ++g)
    for (std::size_t i = 0; i < k; ++i)
      if (const std::uint32_t h = of_few[g * k + i]; h != kNoNeighbour)
        neighbour[few.original[g] * k + i] = few.original[h];
  for (const Run& run : runs)
    for (std::size_t g = run.begin; g < run.end; ++g)
      for (std::size_t i = 0; i < k; ++i)
        neighbour[g * k + i] =
            static_cast<std::uint32_t>(run.begin + (g - run.begin + 1 + i) % (run.end - run.begin));
  return neighbour;
}

}  // namespace

std::vector<std::uint32_t> k_nearest(const std::vector<glm::vec3>& points, std::size_t k, const Job& job) {
  const std::size_t n = points.size();
  if (const std::vector<Run> runs = runs_longer_than(k + 1, points); !runs.empty())
    return k_nearest_with_runs(points, runs, k, job);
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
  if (const std::vector<Run> runs = runs_longer_than(std::max<std::size_t>(k, 1), points); !runs.empty()) {
    const Thinned few = thinned(points, runs, std::max<std::size_t>(k, 1));
    std::vector<std::uint32_t> found = k_nearest_of(few.points, queries, k, job);
    for (std::uint32_t& h : found)
      if (h != kNoNeighbour) h = few.original[h];
    return found;
  }
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
