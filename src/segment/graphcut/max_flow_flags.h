// Bits of MaxFlow's flags. Internal to src/segment.
#pragma once

#include <cstdint>

namespace splatcut {

inline constexpr std::uint8_t kActive = 1, kTouched = 2;

}  // namespace splatcut
