// What the surface looks like at each Gaussian: smoothed normal and colour, and which Gaussians are surface.
//
// Core Gaussians make the surface: opaque enough, not among the largest, and seen by some observing view
// (where views are given). Everything else is attached to the parts afterwards.
//   normal: the shortest axis of Sigma, towards the views that see it, averaged over the neighbours
//   colour: 0.5 + C0 f_dc, averaged over the neighbours of like colour
// Cost: one k-NN search and a few passes over its edges. Same input, same bits, on any number of threads.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "core/job.h"
#include "scene/camera/camera.h"
#include "scene/raster/projected_view.h"
#include "segment/superpoints/part_model.h"

namespace splatcut {

// Arrays of core.size(), unless said otherwise.
struct SurfaceFeatures {
  std::vector<std::uint32_t> core;       // indices into the cloud, ascending
  std::vector<std::uint32_t> neighbour;  // core.size() * k, indices into core, kNoNeighbour for none
  std::size_t k = 0;
  std::vector<glm::vec3> position_world;
  std::vector<glm::vec3> normal_world;  // unit
  std::vector<glm::vec3> colour;        // linear in f_dc, about [0, 1]
  std::vector<float> spacing;  // side of the piece of surface that one Gaussian stands for, scene units
};

SurfaceFeatures surface_features(const Drawer& drawer, std::span<const Camera> observing,
                                 const SurfaceOptions& options, const Job& job = {});

}  // namespace splatcut
