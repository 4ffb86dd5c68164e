// The Gaussians of one .sog, unpacked to its pictures: what the readers of .sog and of streamed scenes, which
// are several of them, decode. Internal to src/scene/formats.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>

#include "core/image.h"
#include "core/job.h"
#include "core/mapped_file.h"
#include "scene/cloud/gaussian_cloud.h"

namespace splatcut {

// A source of decode_rows(): row is the number of a Gaussian's pixel.
struct SogRows {
  // 256 numbers for each of four channels: a codebook, or the steps of a range.
  using Tables = std::array<std::array<float, 256>, 4>;

  std::size_t count = 0;  // Gaussians; the pictures may have more pixels
  int degree = 0;
  bool antialiased = false;
  std::optional<glm::dvec3> up;                           // as said_up.h has it
  std::map<std::filesystem::path, std::uint64_t> packed;  // the files that were read, in bytes

  glm::vec3 least{0}, most{0};  // of the logarithms of positions
  Image<Rgba8> low, high, quats, scales, sh0, centroids, labels;
  Tables scale_tables{}, sh0_tables{}, sh_tables{};
  bool logits = false;      // opacities of version 1
  std::size_t palette = 0;  // entries

  glm::vec3 position(std::size_t row) const;
  // The degree of the cloud may be higher than that of the rows: the other coefficients stay as they are.
  void decode(std::size_t row, GaussianCloud& cloud, std::size_t g) const;

  std::uint64_t packed_bytes() const;
  std::uint64_t unpacked_bytes() const;  // of the pictures that were read so far
};

// From an archive, or from the meta.json of a folder. Incomplete when cancelled. Throws Error for what is no
// .sog, for pictures with fewer pixels than Gaussians, and for what check_expansion() refuses
// of all its pictures together.
SogRows read_sog_rows(const MappedFile& file, const Job& job);

// The degree that its text says; 3 where it does not.
int degree_of_sog(const MappedFile& file);

}  // namespace splatcut
