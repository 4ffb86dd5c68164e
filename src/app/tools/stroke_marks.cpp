#include "app/tools/stroke_marks.h"

#include <algorithm>

namespace splatcut {

std::vector<StrokeMark> StrokeMarks::in(const ObjectItem& object, const Camera& now,
                                        const SurfaceOf& surface) {
  constexpr std::size_t kMostKnown = 1024;
  if (known_.size() > kMostKnown) known_.clear();
  int asks_left = 8;  // a picture waits for them
  const auto point_of = [&](const StrokedView& view, const glm::vec2& at_px) -> std::optional<glm::vec3> {
    const auto known = std::ranges::find_if(known_, [&](const Known& k) {
      return k.at_px == at_px && same_camera(k.camera, view.camera) && same_set(k.seen, view.seen);
    });
    if (known != known_.end()) return known->point_world;
    if (asks_left-- <= 0) return {};
    const auto hit = surface.hit(view.camera, at_px, view.seen);
    known_.push_back(
        {view.camera, at_px, view.seen, hit ? std::optional(hit->position_world) : std::nullopt});
    return known_.back().point_world;
  };
  std::vector<StrokeMark> marks;
  for (std::size_t v = 0; v < object.views.size(); ++v) {
    const StrokedView& view = object.views[v];
    const bool from_here = same_pose(view.camera, now);
    const float factor = now.fy_px / view.camera.fy_px;
    for (std::size_t s = 0; s < view.strokes.size(); ++s) {
      const Stroke& stroke = view.strokes[s];
      if (!stroke.is_click()) continue;
      const glm::vec2 own_px = stroke.points_px.front();
      StrokeMark mark{v, s, own_px, own_px, stroke.label == SeedLabel::kObject, from_here};
      if (from_here) {
        mark.at_px = glm::vec2(now.cx_px, now.cy_px) +
                     factor * (own_px - glm::vec2(view.camera.cx_px, view.camera.cy_px));
      } else {
        const auto point = point_of(view, own_px);
        if (!point) continue;
        const glm::vec3 there = now.camera_from_world(*point);
        if (!(there.z > 0)) continue;
        if (surface.hides(*point)) continue;
        mark.at_px = now.pixel_from_camera(there);
      }
      marks.push_back(mark);
    }
  }
  return marks;
}

void StrokeMarks::forget() {
  known_.clear();
}

const StrokeMark* mark_at(const std::vector<StrokeMark>& marks, const glm::vec2& pixel,
                          float pixels_per_point) {
  constexpr float kRadiusPoints = 7;  // of a dot
  const auto distance = [&](const StrokeMark& m) { return glm::distance(m.at_px, pixel); };
  const auto nearest = std::ranges::min_element(marks, {}, distance);
  return nearest != marks.end() && distance(*nearest) <= kRadiusPoints * pixels_per_point ? &*nearest
                                                                                          : nullptr;
}

}  // namespace splatcut
