#include "app/document/stroke_hits.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

namespace splatcut {

DrawnPart drawn_part_of(std::shared_ptr<const GaussianCloud> cloud,
                        std::shared_ptr<const CloudBlocks> blocks) {
  return [cloud = std::move(cloud), blocks = std::move(blocks)](const Camera& camera, const PixelRect& part,
                                                                const Flags& visible) {
    RasterOptions options;
    options.colour = false;
    options.depth = true;
    options.roi = part;
    options.blocks = blocks.get();
    if (visible) options.shown = *visible;
    return rasterize(*cloud, camera, options);
  };
}

std::vector<std::int32_t> hits_of(const CameraStroke& s, const DrawnPart& drawn) {
  if (s.stroke.points_px.empty()) return {};
  constexpr int kWidthPx = 160;
  const glm::vec2& first = s.stroke.points_px.front();
  const bool box = s.stroke.is_box();
  const Camera camera = box ? limited_to_width(s.camera, kWidthPx) : s.camera;
  const float scale = static_cast<float>(camera.width_px) / static_cast<float>(s.camera.width_px);
  const glm::vec2 last = box ? s.stroke.points_px[1] : first;
  const glm::ivec2 most(camera.width_px, camera.height_px),
      low = glm::clamp(glm::ivec2(glm::floor(scale * first)), glm::ivec2(0), most),
      high = glm::clamp(glm::ivec2(glm::floor(scale * last)) + 1, glm::ivec2(0), most);
  const PixelRect part{low.x, low.y, high.x, high.y};
  if (part.empty()) return {};
  const RasterOutput picture = drawn(camera, part, s.seen);
  std::vector<std::int32_t> hits;
  std::ranges::copy_if(picture.first_hit.pixels(), std::back_inserter(hits), [](auto g) { return g >= 0; });
  return hits;
}

std::vector<std::vector<std::int32_t>> hits_of(const ObjectItem& object, const DrawnPart& drawn) {
  std::vector<std::vector<std::int32_t>> hits;
  for (const StrokedView& view : object.views)
    for (const Stroke& stroke : view.strokes)
      if (stroke.label == SeedLabel::kObject)
        hits.push_back(hits_of({view.camera, stroke, view.seen}, drawn));
  return hits;
}

}  // namespace splatcut
