// Walks from pixel to pixel.
#pragma once

#include <array>
#include <glm/glm.hpp>

namespace splatcut {

// To the four neighbours of a pixel.
inline constexpr std::array<glm::ivec2, 4> kFourSteps = {glm::ivec2(1, 0), glm::ivec2(-1, 0),
                                                         glm::ivec2(0, 1), glm::ivec2(0, -1)};

}  // namespace splatcut
