// Stable least-significant-digit radix sort of (key, value) pairs.
#pragma once

#include <algorithm>
#include <array>
#include <cassert>
#include <cstdint>
#include <span>
#include <utility>

namespace splatcut {

template <class Key>
struct KeyValue {
  Key key;
  std::uint32_t value;
};

// Sorts by the bits first_bit <= b < end_bit of key, ascending, equal ones in their given order. A digit in
// which all keys agree costs one counting pass only. scratch: as many items. Few items want few bits per
// digit.
template <int kDigitBits, class Key>
void radix_sort(std::span<KeyValue<Key>> items, std::span<KeyValue<Key>> scratch, int first_bit,
                int end_bit) {
  constexpr std::uint32_t kBuckets = 1u << kDigitBits;
  assert(items.size() == scratch.size());
  if (items.size() < 2) return;
  std::span<KeyValue<Key>> from = items, to = scratch;
  for (int shift = first_bit; shift < end_bit; shift += kDigitBits) {
    const Key mask = (Key{1} << std::min(kDigitBits, end_bit - shift)) - 1;
    const auto digit = [&](const KeyValue<Key>& item) { return (item.key >> shift) & mask; };
    std::array<std::uint32_t, kBuckets> count{};
    for (const auto& item : from) ++count[digit(item)];
    if (count[digit(from.front())] == from.size()) continue;
    std::uint32_t sum = 0;
    for (auto& c : count) sum += std::exchange(c, sum);
    for (const auto& item : from) to[count[digit(item)]++] = item;
    std::swap(from, to);
  }
  if (from.data() != items.data()) std::copy(from.begin(), from.end(), items.begin());
}

}  // namespace splatcut
