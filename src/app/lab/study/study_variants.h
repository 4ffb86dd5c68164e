// What the study does to a scene and to its first view before it asks.
#pragma once

#include <optional>

#include "app/measure/any_view.h"
#include "scene/cloud/gaussian_cloud.h"

namespace splatcut {

// The same scene in other units.
GaussianCloud rescaled(const GaussianCloud& cloud, float scale);
EvaluationCase rescaled(EvaluationCase test, float scale);

// An opaque board between the reference and the object that hides the stated share, [0, 1), of the object's
// pixels from the left. cloud: test's, copied; the board's Gaussians come last.
GaussianCloud with_board(const EvaluationCase& test, double hidden_share);

// What the click hits; none where that is nothing.
std::optional<glm::vec3> clicked_point(const GaussianCloud& cloud, const ViewClick& click);

// The click on the same surface in another view; none where that does not see it.
std::optional<ViewClick> clicked_from(const Camera& other, const GaussianCloud& cloud,
                                      const ViewClick& click);

// Turned to the point, with the focal length by which the object, whose mask in `camera` is given, covers
// about that share of the picture.
Camera framed(const Camera& camera, const glm::vec3& point_world, const Mask& object, double share);

// Test pictures and their truth, `factor` times as wide.
void resize_tests(EvaluationCase* test, double factor);

glm::vec3 tilted(const glm::vec3& up, const Camera& reference, double degrees);

}  // namespace splatcut
