#include "segment/finish/shown_part.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <limits>

#include "scene/raster/rasterizer.h"
#include "segment/masks/mask_tools.h"

namespace splatcut {

namespace {

// Per Gaussian of the cloud, whether it lies in the box around the object.
std::vector<std::uint8_t> in_box(const GaussianCloud& cloud, const GaussianCloud& object) {
  glm::vec3 low(std::numeric_limits<float>::max()), high(std::numeric_limits<float>::lowest());
  for (const glm::vec3& p : object.position) {
    low = glm::min(low, p);
    high = glm::max(high, p);
  }
  std::vector<std::uint8_t> in(cloud.size());
  for (std::size_t g = 0; g < cloud.size(); ++g) {
    const glm::vec3& p = cloud.position[g];
    in[g] = glm::all(glm::greaterThanEqual(p, low)) && glm::all(glm::lessThanEqual(p, high));
  }
  return in;
}

}  // namespace

std::vector<std::uint32_t> labelled_rows(std::span<const std::uint8_t> labels) {
  std::vector<std::uint32_t> rows;
  std::uint64_t eight = 0;  // most of a scene is no object: eight at a time are seen to be none
  for (std::size_t g = 0; g < labels.size(); ++g) {
    if (g + sizeof eight <= labels.size()) {
      std::memcpy(&eight, labels.data() + g, sizeof eight);
      if (eight == 0) {
        g += sizeof eight - 1;
        continue;
      }
    }
    if (labels[g]) rows.push_back(static_cast<std::uint32_t>(g));
  }
  return rows;
}

void add_shown_px(const Drawer& scene, const Camera& camera, const PixelRect& rect,
                  std::span<const std::uint8_t> shown, PlaneSums* sums, const Job& job) {
  const std::vector<Image<float>> one(1, Image<float>(rect.width(), rect.height(), 1));
  RasterOptions raster;
  raster.colour = false;
  raster.roi = rect;
  raster.shown = shown;
  raster.sum_planes = one;
  raster.plane_sums = sums;
  scene.draw(camera, raster, job);
}

ShownPart shown_part(const Drawer& scene, std::span<const std::uint8_t> labels,
                     std::span<const Camera> cameras, const Job& job) {
  const GaussianCloud& cloud = scene.cloud();
  const GaussianCloud object = permuted(cloud, labelled_rows(labels));
  const std::vector<std::uint8_t> all_of_it(object.size(), 1), box = in_box(cloud, object);
  std::vector<std::uint8_t> outside(box.size());
  std::ranges::transform(box, outside.begin(),
                         [](std::uint8_t in) { return static_cast<std::uint8_t>(in == 0); });
  PlaneSums sums(cloud.size(), 1);
  for (std::size_t v = 0; v < cameras.size() && !job.cancelled(); ++v) {
    job.progress("looking where the object shows",
                 static_cast<double>(v) / static_cast<double>(cameras.size()));
    const PixelRect rect = labelled_rectangle(object, cameras[v], all_of_it);
    if (rect.empty()) continue;
    const int width = cameras[v].width_px, height = cameras[v].height_px;
    add_shown_px(scene, cameras[v], grown(rect, kSurroundingsPx, width, height), outside, &sums, job);
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
