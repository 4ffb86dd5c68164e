// Counter-based random numbers: value k of stream s is a pure function of (seed, s, k), the same on every
// compiler and in any order of evaluation. Mixing function: SplitMix64 (Steele, Lea, Flood, "Fast
// splittable pseudorandom number generators", OOPSLA 2014).
#pragma once

#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>

namespace splatcut {

constexpr std::uint64_t mixed_bits(std::uint64_t z) {
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
  return z ^ (z >> 31);
}

class CounterRng {
 public:
  CounterRng(std::uint64_t seed, std::uint64_t stream)
      : key_(mixed_bits(seed * 0x9e3779b97f4a7c15ull + mixed_bits(stream + 0x632be59bd9b4e019ull))) {}

  std::uint64_t bits() { return mixed_bits(key_ + ++counter_ * 0x9e3779b97f4a7c15ull); }
  float unit() { return static_cast<float>(bits() >> 40) * 0x1p-24f; }  // [0, 1)
  float between(float low, float high) { return low + (high - low) * unit(); }
  // Integer in [0, n), n > 0; the bias of n / 2^64 is far below anything observable here.
  std::uint64_t below(std::uint64_t n) { return bits() % n; }
  // Uniform in the unit ball.
  glm::vec3 in_ball() {
    const float z = between(-1, 1), angle = between(0, 6.2831853f), r = std::cbrt(unit());
    const float s = std::sqrt(1 - z * z);
    return r * glm::vec3(s * std::cos(angle), s * std::sin(angle), z);
  }

 private:
  std::uint64_t key_, counter_ = 0;
};

}  // namespace splatcut
