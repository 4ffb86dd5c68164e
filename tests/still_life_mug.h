// A still life whose mug is the object, in Morton order, and what masks of it say; for tests and benchmarks.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "scene/cloud/morton.h"
#include "scene/raster/rasterizer.h"
#include "scene/still_life/still_life.h"

namespace splatcut::testing {

struct MugScene {
  GaussianCloud cloud;
  std::vector<std::uint8_t> mug;  // per Gaussian, 1 = object
  std::vector<Camera> cameras;    // as the generator gives them
};

inline MugScene still_life_with_mug(std::size_t gaussians) {
  StillLifeOptions options;
  options.gaussians = gaussians;
  const LabelledScene made = make_still_life(options);
  const std::vector<std::uint32_t> order = morton_order(made.cloud.position);
  const auto mug = std::ranges::find(made.label_name, "mug") - made.label_name.begin();
  MugScene scene{permuted(made.cloud, order), {}, made.cameras};
  for (const std::uint32_t g : order) scene.mug.push_back(made.label[g] == mug);
  return scene;
}

inline void add_masked_view(const GaussianCloud& cloud, const Camera& camera, const Mask& mask,
                            MaskedSums& sums) {
  RasterOptions options;
  options.colour = false;
  options.sum_mask = &mask;
  options.sums = &sums;
  rasterize(cloud, camera, options);
}

}  // namespace splatcut::testing
