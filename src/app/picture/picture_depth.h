// Whether the last picture shows a point in space, or something before it: for what is drawn over the
// picture.
//
// The point is looked up in the picture's own camera, so a picture that lags behind a moving view still
// answers for the place. A reference to the frame is kept: the frame must outlive it. Cost: two products of
// matrix and vector a question.
#pragma once

#include <glm/glm.hpp>
#include <optional>

#include "app/picture/frame_thread.h"

namespace splatcut {

class PictureDepth {
 public:
  // pane: of the picture. No picture, or none of that pane: nothing hides anything.
  PictureDepth(const FrameResult* picture, std::size_t pane);

  // The surface that the picture shows before the point, more than `slack` (scene units along the view axis)
  // before it; none: the point is seen, or lies where the picture knows nothing.
  std::optional<glm::vec3> before(const glm::vec3& point_world, float slack = 0) const;

 private:
  const Frame* frame_ = nullptr;
};

}  // namespace splatcut
