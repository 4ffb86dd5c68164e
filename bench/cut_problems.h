// Cut problems as the pipeline meets them: twelve views around an object whose masks are wrong near the
// border.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "scene/cloud/gaussian_cloud.h"
#include "segment/graphcut/max_flow.h"

namespace splatcut::bench {

struct CutProblem {
  std::string name;
  FlowGraph graph;
  std::vector<std::int32_t> capacity;                   // of lambda = 1
  std::vector<std::int64_t> terminal, terminal_before;  // of all views; of all but the last
  std::vector<glm::vec3> position;                      // where strokes are painted
  std::vector<std::uint8_t> truth;                      // per node: 1 = the object
};

// The mug of a still life; made once per size.
const CutProblem& still_life_problem(std::size_t gaussians);

// The same object in a scene with twice as much around it: all that is not the object once more, seen and in
// no mask.
CutProblem with_twice_the_background(const CutProblem& problem);

// The entries with truth labels of a suite (see the README's `eval`), in its order.
std::vector<CutProblem> suite_problems(const std::filesystem::path& suite);

}  // namespace splatcut::bench
