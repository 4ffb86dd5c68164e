// Bounds of runs of Gaussians. In Morton order neighbours in memory are neighbours in space, so that drawings
// and searches pass over whole runs that lie elsewhere.
//
// In: a cloud. Out: per run of 256 Gaussians the box of their centres and the largest standard deviation.
// The bounds hold for the cloud as it was; a cloud that is changed needs new ones. Cost: one pass over
// positions and scales; 28 bytes a run.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "scene/cloud/gaussian_cloud.h"

namespace splatcut {

struct CloudBlock {
  Box centres_world;
  float longest_sigma = 0;  // scene units
};

class CloudBlocks {
 public:
  static constexpr std::size_t kGaussians = 256;

  CloudBlocks() = default;
  explicit CloudBlocks(const GaussianCloud& cloud);

  std::size_t gaussians() const { return gaussians_; }  // of the cloud
  std::span<const CloudBlock> blocks() const { return blocks_; }
  // Gaussians of the cloud whose centres lie in the box, ascending.
  std::vector<std::uint32_t> rows_in(const GaussianCloud& cloud, const Box& box) const;
  // How many they are.
  std::size_t count_in(const GaussianCloud& cloud, const Box& box) const;

 private:
  std::vector<CloudBlock> blocks_;
  std::size_t gaussians_ = 0;
};

bool contains(const Box& box, const glm::vec3& point);
bool meet(const Box& a, const Box& b);

}  // namespace splatcut
