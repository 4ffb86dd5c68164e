// Stable least-significant-digit radix sort of (key, value) pairs.
#pragma once

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

namespace splatcut {

template <class Key>
struct KeyValue {
  Key key;
  std::uint32_t value;
};

// Sorts by the low `key_bits` bits of key, ascending, equal keys in their given order. A digit in which
// all keys agree costs one counting pass only. `scratch` is resized as needed. Few items want few bits per
// digit.
template <int kDigitBits = 11, class Key>
void radix_sort(std::vector<KeyValue<Key>>& items, std::vector<KeyValue<Key>>& scratch, int key_bits) {
  constexpr std::uint32_t kBuckets = 1u << kDigitBits;
  scratch.resize(items.size());
  for (int shift = 0; shift < key_bits; shift += kDigitBits) {
    std::array<std::uint32_t, kBuckets> count{};
    for (const auto& item : items) ++count[(item.key >> shift) & (kBuckets - 1)];
    if (!items.empty() && count[(items.front().key >> shift) & (kBuckets - 1)] == items.size()) continue;
    std::uint32_t sum = 0;
    for (auto& c : count) sum += std::exchange(c, sum);
    for (const auto& item : items) scratch[count[(item.key >> shift) & (kBuckets - 1)]++] = item;
    items.swap(scratch);
  }
}

}  // namespace splatcut
