// Marks of an object's clicks in the picture, from wherever one looks.
//
// A click stands where it hit the surface: a pixel drawn for each, once. Pixels are a pane's, x right, y
// down.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "app/document/document.h"
#include "app/tools/tool_hand.h"

namespace splatcut {

struct StrokeMark {
  std::size_t view = 0, stroke = 0;  // indices into ObjectItem::views and the strokes of that
  glm::vec2 made_px{0};              // its place in the picture in which it was made
  glm::vec2 at_px{0};                // the same in this picture
  bool object = true;                // false: a click on the rest
  bool from_here = false;            // true: the camera stands as it did when the click was made
};

// What the marks ask of the scene. hit: the surface under a pixel of any camera, of the visible Gaussians
// (null: all). hides: whether the last picture shows something before a point.
struct SurfaceOf {
  std::function<std::optional<PickedPoint>(const Camera& camera, const glm::vec2& pixel,
                                           const Flags& visible)>
      hit;
  std::function<bool(const glm::vec3& point_world)> hides;
};

class StrokeMarks {
 public:
  // Clicks of the object that the camera shows. One that was made from elsewhere shows unless something
  // stands before it; of those whose surface is not known yet, a few are asked for in a call.
  std::vector<StrokeMark> in(const ObjectItem& object, const Camera& now, const SurfaceOf& surface);
  void forget();  // forgets the surfaces: the scene, or what is drawn of it, is another

 private:
  struct Known {
    Camera camera;
    glm::vec2 at_px{0};
    SeenGaussians seen;
    std::optional<glm::vec3> point_world;
  };
  std::vector<Known> known_;
};

// The mark under a pixel; null: none is.
const StrokeMark* mark_at(const std::vector<StrokeMark>& marks, const glm::vec2& pixel,
                          float pixels_per_point);

}  // namespace splatcut
