// The Gaussians of one .spz, unpacked: what the readers of .spz and of scenes of several files decode.
// Internal to src/scene/formats.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "scene/formats/spz_layout.h"
#include "scene/packing/unpack.h"

namespace splatcut {

// A source of decode_rows(). Moved, not copied: the attributes lie in `unpacked`, or in the mapped file.
struct SpzRows {
  spz::Header header;
  std::size_t count = 0;
  int degree = 0;  // of the cloud; what a file has beyond degree 3 is left out
  bool antialiased = false;
  AxisSigns axes;  // numbers as they stand in the file until others are set
  std::array<float, 15> sh_signs = AxisSigns{}.sh();
  std::array<std::span<const std::byte>, spz::kAttributes> attributes;
  std::size_t sh_bytes = 0;
  std::vector<Bytes> unpacked;
  Bytes extensions;   // records
  bool ours = false;  // the packing has kOurComment
  std::optional<glm::dvec3> up_in_comment;

  SpzRows() = default;
  SpzRows(const SpzRows&) = delete;
  SpzRows& operator=(const SpzRows&) = delete;
  SpzRows(SpzRows&&) = default;
  SpzRows& operator=(SpzRows&&) = default;

  glm::vec3 position(std::size_t row) const;
  // The degree of the cloud may be higher than that of the rows: the other coefficients stay as they are.
  void decode(std::size_t row, GaussianCloud& cloud, std::size_t g) const;
  std::uint64_t unpacked_bytes() const;

 private:
  const std::byte* at(int attribute, std::size_t row, std::size_t bytes) const {
    return attributes[static_cast<std::size_t>(attribute)].data() + row * bytes;
  }
  float coordinate(std::size_t row, std::size_t axis) const;
  std::array<float, 4> file_rotation(std::size_t row) const;  // x y z w in the file's axes
};

// Incomplete when cancelled. Throws Error for what is no .spz and for what check_expansion() refuses. The
// file must stay open.
SpzRows read_spz_rows(const MappedFile& file, const Job& job);

// The degree that its header says, at most 3.
int degree_of_spz(const MappedFile& file);

}  // namespace splatcut
