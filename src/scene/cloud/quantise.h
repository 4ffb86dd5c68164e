// Small fixed-point helpers that the compact scene formats share. Internal to src/scene.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>
#include <limits>

namespace splatcut {

// The constant SH basis function, 1 / (2 sqrt(pi)), one unit in the last place below kShC0 of splat_math.h:
// what these formats write keeps its bytes.
constexpr float kShC0Rounded = 0.28209479f;

inline glm::vec3 f_dc_from_colour(const glm::vec3& colour) {
  return (colour - 0.5f) / kShC0Rounded;
}
inline glm::vec3 colour_from_f_dc(const glm::vec3& f_dc) {
  return 0.5f + kShC0Rounded * f_dc;
}

// A flat Gaussian has 0, of which some readers take a logarithm, and others divide by it.
inline glm::vec3 never_flat(const glm::vec3& scale) {
  constexpr float kSmallest = 1e-20f;
  return glm::max(scale, kSmallest);
}

// The nearest step of 0..2^bits-1 that stands for value in [0, 1]; NaN becomes 0.
inline std::uint32_t to_steps(float value, int bits) {
  const float max = static_cast<float>((1u << bits) - 1);
  return value > 0 ? static_cast<std::uint32_t>(std::min(value, 1.0f) * max + 0.5f) : 0u;
}
inline float from_steps(std::uint32_t steps, int bits) {
  const std::uint32_t max = (1u << bits) - 1;
  return static_cast<float>(steps & max) / static_cast<float>(max);
}
inline std::uint8_t to_byte(float value) {  // nearest integer, clamped to 0..255
  return static_cast<std::uint8_t>(std::clamp(std::round(value), 0.0f, 255.0f));
}
inline float byte_at(const std::byte* at) {
  return static_cast<float>(std::to_integer<int>(*at));
}

// Index of the component of largest magnitude.
inline std::uint32_t largest_of(const std::array<float, 4>& v) {
  return static_cast<std::uint32_t>(
      std::max_element(v.begin(), v.end(), [](float a, float b) { return std::abs(a) < std::abs(b); }) -
      v.begin());
}

// IEEE half precision; infinity becomes NaN.
inline float half_to_float(std::uint16_t half) {
  const int exponent = half >> 10 & 31;
  const float mantissa = static_cast<float>(half & 1023);
  const float magnitude = exponent == 0    ? std::ldexp(mantissa, -24)
                          : exponent == 31 ? std::numeric_limits<float>::quiet_NaN()
                                           : std::ldexp(mantissa + 1024.0f, exponent - 25);
  return half & 0x8000 ? -magnitude : magnitude;
}

template <class T>
T load(const std::byte* at) {
  T value;
  std::memcpy(&value, at, sizeof value);
  return value;
}

}  // namespace splatcut
