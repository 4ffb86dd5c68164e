// Values by their rank.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace splatcut {

// The upper one of two in the middle; 0 of none.
inline float median(std::vector<float> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + std::ssize(values) / 2;
  std::ranges::nth_element(values, middle);
  return *middle;
}

// The value that at least the share (0 to 1, float or double) of the others does not exceed; 0 of none. The
// order of the values changes.
template <class Share>
float quantile(std::vector<float>* values, Share share) {
  if (values->empty()) return 0;
  const auto at =
      values->begin() + static_cast<std::ptrdiff_t>(share * static_cast<Share>(values->size() - 1));
  std::ranges::nth_element(*values, at);
  return *at;
}

}  // namespace splatcut
