// What the study does to a scene and to its first view before it asks.
#pragma once

#include "app/measure/evaluate.h"
#include "scene/cloud/gaussian_cloud.h"

namespace splatcut {

// The same scene in other units.
GaussianCloud rescaled(const GaussianCloud& cloud, float scale);
EvaluationCase rescaled(EvaluationCase test, float scale);

// An opaque board between the reference and the object that hides the stated share, [0, 1), of the object's
// pixels from the left. cloud: test's, copied; the board's Gaussians come last.
GaussianCloud with_board(const EvaluationCase& test, double hidden_share);

// Moves the reference to `factor` of its distance from the object.
void step_back(EvaluationCase* test, float factor);

// Turns the reference to the object and sets its focal length so that the object covers about that share of
// the picture; less where the frame would cut it off first.
void fill_picture(EvaluationCase* test, double share);

// Test pictures and their truth, `factor` times as wide.
void resize_tests(EvaluationCase* test, double factor);

glm::vec3 tilted(const glm::vec3& up, const Camera& reference, double degrees);

}  // namespace splatcut
