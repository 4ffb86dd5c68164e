#include "app/picture/hidden_share.h"

#include <numeric>

#include "scene/raster/rasterizer.h"

namespace splatcut {

namespace {

double sum(const Image<float>& image) {
  return std::accumulate(image.pixels().begin(), image.pixels().end(), 0.0);
}

}  // namespace

double hidden_share(const OpenedScene& scene, const std::vector<std::uint8_t>& labels, const Camera& camera,
                    float apart, const Job& job) {
  RasterOptions options;
  options.colour = false;
  options.depth = true;
  options.labels = labels;
  options.blocks = scene.blocks.get();
  const RasterOutput seen = rasterize(*scene.cloud, camera, options, job);
  options.shown = labels;
  const RasterOutput alone = rasterize(*scene.cloud, camera, options, job);
  if (job.cancelled()) return 0;
  double hidden = 0;
  for (std::size_t i = 0; i < alone.label_share.pixels().size(); ++i) {
    const float z = seen.median_depth.pixels()[i];  // 0: nothing there is opaque
    if (z > 0 && z < alone.median_depth.pixels()[i] - apart)
      hidden += alone.label_share.pixels()[i] - seen.label_share.pixels()[i];
  }
  const double all = sum(alone.label_share);
  return all > 0 ? hidden / all : 0;
}

}  // namespace splatcut
