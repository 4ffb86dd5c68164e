// Passes over flags of all Gaussians, a byte each, that take 16 bytes at a time: the window waits for them.
#pragma once

#include <algorithm>
#include <cassert>
#include <cstdint>
#include <vector>

namespace splatcut {

// Changes each byte by the one of the same place. The compiler takes 16 at a time where the change is no
// branch.
template <class Change>
void change_each(std::vector<std::uint8_t>* bytes, const std::vector<std::uint8_t>& by, Change change) {
  assert(bytes->size() == by.size());
  std::uint8_t* to = bytes->data();
  const std::uint8_t* from = by.data();
  const std::size_t n = bytes->size();
  for (std::size_t g = 0; g < n; ++g) to[g] = change(to[g], from[g]);
}

inline void add_flags(const std::vector<std::uint8_t>& flags, std::vector<std::uint8_t>* to) {
  change_each(to, flags, [](std::uint8_t a, std::uint8_t b) { return static_cast<std::uint8_t>(a | b); });
}
inline void take_out_flags(const std::vector<std::uint8_t>& flags, std::vector<std::uint8_t>* of) {
  change_each(of, flags, [](std::uint8_t a, std::uint8_t b) { return b != 0 ? std::uint8_t{0} : a; });
}
inline void keep_flags_in(const std::vector<std::uint8_t>& flags, std::vector<std::uint8_t>* of) {
  change_each(of, flags, [](std::uint8_t a, std::uint8_t b) { return b != 0 ? a : std::uint8_t{0}; });
}

// How many of n places something holds for. A byte counts to 255, and 16 of them count at a time.
template <class Holds>
std::size_t count_places(std::size_t n, Holds holds) {
  constexpr std::size_t kMost = 255;
  std::size_t count = 0;
  for (std::size_t begin = 0; begin < n; begin += kMost) {
    const std::size_t end = std::min(n, begin + kMost);
    std::uint8_t some = 0;
    for (std::size_t g = begin; g < end; ++g) some = static_cast<std::uint8_t>(some + holds(g));
    count += some;
  }
  return count;
}

inline std::size_t count_both(const std::vector<std::uint8_t>& a, const std::vector<std::uint8_t>& b) {
  return count_places(a.size(), [x = a.data(), y = b.data()](std::size_t g) { return (x[g] & y[g]) != 0; });
}

}  // namespace splatcut
