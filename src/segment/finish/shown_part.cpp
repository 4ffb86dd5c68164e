#include "segment/finish/shown_part.h"

#include <algorithm>
#include <limits>

#include "scene/raster/rasterizer.h"
#include "segment/masks/mask_tools.h"

namespace splatcut {

namespace {

// Per Gaussian, whether it lies in the box around the labelled ones.
std::vector<std::uint8_t> in_box(const GaussianCloud& cloud, std::span<const std::uint8_t> labels) {
  glm::vec3 low(std::numeric_limits<float>::max()), high(std::numeric_limits<float>::lowest());
  for (std::size_t g = 0; g < cloud.size(); ++g) {
    if (!labels[g]) continue;
    low = glm::min(low, cloud.position[g]);
    high = glm::max(high, cloud.position[g]);
  }
  std::vector<std::uint8_t> in(cloud.size());
  for (std::size_t g = 0; g < cloud.size(); ++g) {
    const glm::vec3& p = cloud.position[g];
    in[g] = glm::all(glm::greaterThanEqual(p, low)) && glm::all(glm::lessThanEqual(p, high));
  }
  return in;
}

}  // namespace

ShownPart shown_part(const Drawer& scene, std::span<const std::uint8_t> labels,
                     std::span<const Camera> cameras, const Job& job) {
  const GaussianCloud& cloud = scene.cloud();
  const std::vector<std::uint8_t> box = in_box(cloud, labels);
  std::vector<std::uint8_t> outside(box.size());
  std::ranges::transform(box, outside.begin(),
                         [](std::uint8_t in) { return static_cast<std::uint8_t>(in == 0); });
  PlaneSums sums(cloud.size(), 1);
  for (std::size_t v = 0; v < cameras.size() && !job.cancelled(); ++v) {
    job.progress("what the own views show", static_cast<double>(v) / static_cast<double>(cameras.size()));
    const PixelRect object = labelled_rectangle(cloud, cameras[v], labels);
    if (object.empty()) continue;
    const PixelRect rect = grown(object, kSurroundingsPx, cameras[v].width_px, cameras[v].height_px);
    const std::vector<Image<float>> one(1, Image<float>(rect.width(), rect.height(), 1));
    RasterOptions raster;
    raster.colour = false;
    raster.roi = rect;
    raster.shown = outside;
    raster.sum_planes = one;
    raster.plane_sums = &sums;
    scene.draw(cameras[v], raster, job);
  }
  ShownPart part;
  for (std::uint32_t g = 0; g < cloud.size(); ++g) {
    if (!box[g] && sums.sum[g] == 0) continue;
    part.row.push_back(g);
    part.labels.push_back(labels[g]);
  }
  part.cloud = permuted(cloud, part.row);
  return part;
}

}  // namespace splatcut
