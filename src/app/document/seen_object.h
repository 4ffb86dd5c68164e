// What the views of the capture showed of an object, as the window shows it: by how many views each of its
// Gaussians was seen, and the ground that it hid from all of them.
#pragma once

#include <memory>
#include <vector>

#include "app/document/document.h"
#include "segment/finish/seen_from.h"
#include "segment/finish/unseen_ground.h"

namespace splatcut {

struct SeenObject {
  Flags labels;  // of the object
  glm::vec3 up_world{0};
  std::shared_ptr<const std::vector<float>> heat;  // see heat_of(); null: not known
  std::shared_ptr<const UnseenGround> ground;      // null: not known
};

// Per Gaussian of the scene, for heat_colour(): 1 (red) for those that no view saw, falling to 0 (blue) for
// those that half of the views saw, as a side of a solid thing is seen by about half of the views around it.
// 0 for what is not the object's. seen: of these labels, by views.
std::vector<float> heat_of(const SeenFrom& seen, const std::vector<std::uint8_t>& labels);

}  // namespace splatcut
