// Few values for many: what .sog keeps of numbers. Internal to src/scene.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace splatcut {

// 256 numbers in rising order that stand for all of the values: the values themselves where no more than
// 256 differ; else the codebook of Lloyd (Least squares quantization in PCM, 1982), begun with runs of about
// the same squared error. Values are finite; empty values give zeros. O(n log n).
using Codebook = std::array<float, 256>;
Codebook codebook_of(std::vector<float> values);
std::uint8_t nearest_in(const Codebook& codebook, float value);

// Rows that share an entry, and the entries, which are means of their rows.
struct RowPalette {
  std::vector<std::uint32_t> entry_of;  // of each row
  std::vector<float> entries;           // row-major, as wide as the rows
  std::size_t size(std::size_t width) const { return width ? entries.size() / width : 0; }
};
// rows: row-major, `width` finite values each. No more than `most` entries: a box of rows is halved at the
// mean of its widest spread, that of the largest squared error first, as colour pictures are reduced
// (Heckbert 1982, Wu 1991). Rows that are equal share an entry; with no more different rows than `most`, each
// is its own. O(n width log most).
RowPalette palette_of(std::span<const float> rows, std::size_t width, std::size_t most);

}  // namespace splatcut
