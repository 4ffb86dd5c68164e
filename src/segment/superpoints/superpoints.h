// Superpoints: the leaves of the hierarchy of parts. See part_hierarchy.h.
#pragma once

#include "segment/superpoints/part_hierarchy.h"

namespace splatcut {

// How two neighbouring surface Gaussians differ.
struct SurfaceEdge {
  std::uint32_t a = 0, b = 0;  // indices into core, a < b
  float colour = 0;            // |dc|
  float normal = 0;            // 1 - n.n'
  float concavity = 0;         // > 0 in an inner corner, < 0 over an edge
  float gap = 0;               // Mahalanobis distance
  float length = 0;            // border that the edge stands for, scene units
  float distance = 0;          // over the spacing
};

// Each undirected edge of the k-NN lists once, in order of the Gaussian that lists it.
std::vector<SurfaceEdge> surface_edges(const GaussianCloud& cloud, const SurfaceFeatures& features);

struct Superpoints {
  std::uint32_t count = 0;
  std::vector<std::uint32_t> of;  // per core Gaussian
};
Superpoints superpoints(const SurfaceFeatures& features, std::span<const SurfaceEdge> edges,
                        const SuperpointOptions& options);

}  // namespace splatcut
