// Measures an object by itself and what is left of the scene without it: see alone_score.h.
#pragma once

#include <cstdint>
#include <vector>

#include "app/measure/evaluate.h"

namespace splatcut {

// object: its Gaussians and no others. Throws Error where the truth shows in none of the test views.
AloneScore score_alone(const EvaluationCase& scene, const GaussianCloud& object);

// The case with the ring of twelve (alone_score.h) as its test views. Needs true labels.
EvaluationCase in_ring(const EvaluationCase& scene);

// rest: what is left of the scene without the object. Throws as above.
RestScore score_rest(const EvaluationCase& scene, const GaussianCloud& rest);

// labels: per Gaussian of the scene, 1 = object. Throws as above. Cancelled: unspecified.
CutoutScore score_cutout(const EvaluationCase& scene, const std::vector<std::uint8_t>& labels,
                         const Job& job = {});

}  // namespace splatcut
