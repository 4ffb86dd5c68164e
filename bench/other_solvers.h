// Maximum flow by other libraries, graphs built from ours, for comparison.
#pragma once

#include <cstdint>

#include "cut_problems.h"

namespace splatcut::bench {

std::int64_t boost_boykov_kolmogorov(const CutProblem& problem);
std::int64_t boost_push_relabel(const CutProblem& problem);
std::int64_t opencv_gcgraph(const CutProblem& problem);

}  // namespace splatcut::bench
