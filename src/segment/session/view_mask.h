// The object in views other than the reference: the labels so far, rendered or propagated there, settled by
// the picture; from nearer where something else hides the object.
#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <vector>

#include "segment/masks/propagate.h"
#include "segment/session/cut_result.h"
#include "segment/session/cut_task.h"

namespace splatcut {

struct ViewPicture {
  Image<Rgb8> rgb;
  Image<float> depth;  // expected
  Image<float> median_depth;
};
ViewPicture view_picture(const Drawer& drawer, const Camera& camera, const Job& job);

Mask labels_in_view(const Drawer& drawer, const Camera& camera, const std::vector<std::uint8_t>& labels,
                    const Job& job);

// report: used, or not with the reason, as everything hides the object. picture: empty where it was not
// drawn.
struct FoundView {
  ViewReport report;
  ViewPicture picture;
};

// seen: the views before, of a propagator that is of pictures. Of the result, labels are read and times are
// booked. Nothing: cancelled.
std::optional<FoundView> find_in_view(const CutTask& task, const Camera& camera,
                                      const glm::vec3& object_centre_world, std::span<const SeenView> seen,
                                      CutResult* result);

}  // namespace splatcut
