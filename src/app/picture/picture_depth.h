// Depth test against the last picture, for what is drawn over it: does the picture show a point in space, or
// something before the point?
//
// The picture's own camera projects the point, so that a picture which lags behind a moving view still gives
// the right answer. The frame must outlive this object. Cost: two products of matrix and vector a question.
#pragma once

#include <glm/glm.hpp>
#include <optional>

#include "app/picture/frame_thread.h"

namespace splatcut {

class PictureDepth {
 public:
  // pane: index of a pane of the picture. If picture is null or lacks that pane, nothing hides anything.
  PictureDepth(const FrameResult* picture, std::size_t pane);

  // World point of the surface that hides the point; none: the point is seen, or the picture knows nothing
  // there.
  // slack: length by which the surface must lie before the point, along the view axis, scene units.
  std::optional<glm::vec3> before(const glm::vec3& point_world, float slack = 0) const;

 private:
  const Frame* frame_ = nullptr;
};

}  // namespace splatcut
