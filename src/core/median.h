// The middle of some values.
#pragma once

#include <algorithm>
#include <vector>

namespace splatcut {

// The upper one of two; 0 of none.
inline float median(std::vector<float> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + std::ssize(values) / 2;
  std::ranges::nth_element(values, middle);
  return *middle;
}

}  // namespace splatcut
