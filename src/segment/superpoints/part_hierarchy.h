// A training-free hierarchy of parts over the Gaussians: what a click can mean.
//
// In: cloud. Out: a binary forest whose leaves are superpoints (some 40 Gaussians of one surface) and whose
// inner nodes are unions of two neighbouring parts, least different first. Every Gaussian belongs to one
// leaf. The right weights of merging are unknown, so there are several trees over the same leaves, merged
// with slightly different weights: a part that most trees hold is more likely an object.
//   superpoints: Felzenszwalb and Huttenlocher, Efficient Graph-Based Image Segmentation, IJCV 2004, on
//     k-NN edges weighted by colour, normal, concavity, gap and distance: SuperpointOptions
//   merging: cost = difference (least area / median leaf area)^p / (shared border / lesser perimeter)^q
//   concavity = (n - n').(mu' - mu) / |mu' - mu|
//   gap: Mahalanobis distance of two Gaussians in their mean covariance
// Built once per scene; depends on the scene and on the observing views alone. Same input, same bits.
// Cost: about 2 s per 300,000 Gaussians on two cores.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "segment/superpoints/part_looks.h"
#include "segment/superpoints/part_model.h"
#include "segment/superpoints/surface_features.h"

namespace splatcut {

inline constexpr std::uint32_t kNoPart = 0xffffffffu;

// Per node; leaves are 0..leaves-1, a parent comes after its children.
struct PartTree {
  std::vector<std::uint32_t> parent;                   // kNoPart at a root
  std::vector<std::array<std::uint32_t, 2>> children;  // kNoPart twice at a leaf
  std::vector<float> area;                             // scene units squared
  std::vector<float> cut;                              // length of the border, likeness-weighted, scene units
  std::vector<float> merge_cost;                       // of the children; 0 at a leaf
  std::vector<PartLooks> looks;                        // in the observing views; empty: nobody looked
  std::size_t nodes() const { return parent.size(); }
};

struct PartHierarchy {
  std::uint32_t leaves = 0;
  std::vector<std::uint32_t> leaf_of;  // per Gaussian of the cloud; kNoPart in a scene without core
  std::vector<PartTree> trees;         // over the same leaves; those that count lightness less last
  std::size_t plain_trees = 0;
  std::vector<glm::vec3> leaf_centre_world;
  std::vector<float> leaf_area;  // of one side, scene units squared
};

// Cancelled: what comes back is incomplete and must not be used.
PartHierarchy build_part_hierarchy(const GaussianCloud& cloud, std::span<const Camera> observing,
                                   const PartOptions& options = {}, const Job& job = {});

// The same from features that are known.
PartHierarchy build_part_hierarchy(const GaussianCloud& cloud, const SurfaceFeatures& features,
                                   const PartOptions& options = {}, const Job& job = {});

}  // namespace splatcut
