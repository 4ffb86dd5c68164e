// Sides of objects in the order of their thumbnails, with what nobody saw there of what strokes changed, as
// they are kept beside the document.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "app/document/document.h"
#include "scene/camera/camera.h"

namespace splatcut {

// Gaussians that a side is in doubt of, as it shows them: out of the object, or in it.
struct OpenDoubt {
  std::vector<std::uint32_t> out, in;
  bool is_border = false;  // true: of both sides of a border through a surface; else strokes took, or added
};
using OpenDoubts = std::vector<std::shared_ptr<const OpenDoubt>>;

struct DoubtfulSide {
  ObjectId object = 0;
  Camera camera;
  bool looked_at = false;  // true: somebody looked at it, so its doubts end with the next stroke
  OpenDoubts open{};
  // Doubts are shared as long as they stay.
  bool operator==(const DoubtfulSide& other) const {
    return object == other.object && looked_at == other.looked_at && open == other.open &&
           same_camera(camera, other.camera);
  }
};

}  // namespace splatcut
