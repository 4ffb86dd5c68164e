// What the views of the capture showed of an object, as the window shows it: by how many views each of its
// Gaussians was seen, and the ground that it hid from all of them.
#pragma once

#include <memory>
#include <vector>

#include "app/document/document.h"
#include "app/document/opened_scene.h"
#include "app/document/view_state.h"
#include "segment/finish/seen_from.h"
#include "segment/finish/unseen_ground.h"

namespace splatcut {

// What a view asks of the active object.
enum class SeenWhat { kNothing, kHeat, kGround };
struct SeenQuestion {
  SeenWhat what = SeenWhat::kNothing;
  Flags labels;  // of the object
  glm::vec3 up_world{0};
  bool operator==(const SeenQuestion&) const = default;
};
SeenQuestion question_of(const ViewState& view, const Flags& labels, const glm::vec3& up_world);

struct SeenObject {
  Flags labels;  // of the object
  glm::vec3 up_world{0};
  std::shared_ptr<const std::vector<float>> heat;  // see heat_of(); null: not known
  std::shared_ptr<const UnseenGround> ground;      // null: not known

  bool is_of(const Flags& other, const glm::vec3& other_up_world) const {
    return up_world == other_up_world && (labels == other || *labels == *other);
  }
  bool answers(const SeenQuestion& question) const;
};

// known: of another question, kept if it is of the same object; may be null. Cancelled: unspecified.
std::shared_ptr<const SeenObject> seen_object(const SeenQuestion& question, const SeenObject* known,
                                              const OpenedScene& scene, const Job& job);

// Per Gaussian of the scene, for heat_colour(): 1 (red) for those that no view saw, falling to 0 (blue) for
// those that half of the views saw, as a side of a solid thing is seen by about half of the views around it.
// 0 for what is not the object's. seen: of these labels, by views.
std::vector<float> heat_of(const SeenFrom& seen, const std::vector<std::uint8_t>& labels);

}  // namespace splatcut
