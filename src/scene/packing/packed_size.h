// How small a lot of data packs, told from a part of it. Internal to src/scene.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace splatcut {

// 16 runs of 512 neighbours spread evenly over all; all where there are no more. Neighbours look alike, which
// is what packs well.
std::vector<std::uint32_t> spread_runs(std::span<const std::uint32_t> all);

// Of the data as gzip packs them.
std::size_t deflated_bytes(std::span<const std::byte> data);

}  // namespace splatcut
