#include "app/document/seen_object.h"

#include <algorithm>
#include <bit>

namespace splatcut {

std::vector<float> heat_of(const SeenFrom& seen, const std::vector<std::uint8_t>& labels) {
  const float many = 0.5f * static_cast<float>(seen.views.size());
  std::vector<float> heat(labels.size(), 0.0f);
  std::size_t own = 0;
  for (std::size_t g = 0; g < labels.size(); ++g)
    if (labels[g]) {
      const auto by = static_cast<float>(std::popcount(seen.by_views.at(own++)));
      heat[g] = many > 0 ? std::clamp(1 - by / many, 0.0f, 1.0f) : 1.0f;
    }
  return heat;
}

}  // namespace splatcut
