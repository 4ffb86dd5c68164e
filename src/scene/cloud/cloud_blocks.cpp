#include "scene/cloud/cloud_blocks.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cassert>

namespace splatcut {

namespace {

bool holds(const Box& outer, const Box& inner) {
  return contains(outer, inner.min) && contains(outer, inner.max);
}

// visit(row) for the Gaussians of a block whose centres lie in the box.
template <class Visit>
void visit_in(const GaussianCloud& cloud, const CloudBlock& block, std::size_t first, const Box& box,
              const Visit& visit) {
  if (!meet(block.centres_world, box)) return;
  const std::size_t end = std::min(cloud.size(), first + CloudBlocks::kGaussians);
  const bool all = holds(box, block.centres_world);
  for (std::size_t g = first; g < end; ++g)
    if (all || contains(box, cloud.position[g])) visit(static_cast<std::uint32_t>(g));
}

}  // namespace

bool contains(const Box& box, const glm::vec3& point) {
  return glm::all(glm::lessThanEqual(box.min, point)) && glm::all(glm::lessThanEqual(point, box.max));
}

bool meet(const Box& a, const Box& b) {
  return glm::all(glm::lessThanEqual(a.min, b.max)) && glm::all(glm::lessThanEqual(b.min, a.max));
}

CloudBlocks::CloudBlocks(const GaussianCloud& cloud)
    : blocks_((cloud.size() + kGaussians - 1) / kGaussians), gaussians_(cloud.size()) {
  tbb::parallel_for(std::size_t{0}, blocks_.size(), [&](std::size_t b) {
    const std::size_t first = b * kGaussians, end = std::min(cloud.size(), first + kGaussians);
    Box box{cloud.position[first], cloud.position[first]};
    float longest = 0;
    for (std::size_t g = first; g < end; ++g) {
      box.min = glm::min(box.min, cloud.position[g]);
      box.max = glm::max(box.max, cloud.position[g]);
      longest = std::max({longest, cloud.scale[g].x, cloud.scale[g].y, cloud.scale[g].z});
    }
    blocks_[b] = {box, longest};
  });
}

std::vector<std::uint32_t> CloudBlocks::rows_in(const GaussianCloud& cloud, const Box& box) const {
  assert(cloud.size() == gaussians_);
  std::vector<std::uint32_t> rows;
  for (std::size_t b = 0; b < blocks_.size(); ++b)
    visit_in(cloud, blocks_[b], b * kGaussians, box, [&](std::uint32_t g) { rows.push_back(g); });
  return rows;
}

std::size_t CloudBlocks::count_in(const GaussianCloud& cloud, const Box& box) const {
  assert(cloud.size() == gaussians_);
  std::size_t count = 0;
  for (std::size_t b = 0; b < blocks_.size(); ++b)
    visit_in(cloud, blocks_[b], b * kGaussians, box, [&](std::uint32_t) { ++count; });
  return count;
}

}  // namespace splatcut
