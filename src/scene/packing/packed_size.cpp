#include "scene/packing/packed_size.h"

#include <zlib.h>

#include <new>

namespace splatcut {

std::vector<std::uint32_t> spread_runs(std::span<const std::uint32_t> all) {
  constexpr std::size_t kRuns = 16, kLength = 512;
  if (all.size() <= kRuns * kLength) return {all.begin(), all.end()};
  std::vector<std::uint32_t> out;
  for (std::size_t r = 0; r < kRuns; ++r) {
    const auto run = all.subspan((all.size() - kLength) * r / (kRuns - 1), kLength);
    out.insert(out.end(), run.begin(), run.end());
  }
  return out;
}

std::size_t deflated_bytes(std::span<const std::byte> data) {
  uLongf bytes = compressBound(static_cast<uLong>(data.size()));
  std::vector<Bytef> packed(bytes);
  if (compress(packed.data(), &bytes, reinterpret_cast<const Bytef*>(data.data()),
               static_cast<uLong>(data.size())) != Z_OK)
    throw std::bad_alloc();  // nothing else can be wrong: there is room
  return bytes;
}

}  // namespace splatcut
