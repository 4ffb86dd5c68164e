// What reader and writer of .spz (Niantic) share. Internal to src/scene/formats.
//
// Attributes stand apart, in this order: positions, opacities, colours, scales, rotations, SH.
//   position   v1: 3 half floats; v2+: 3 x 24-bit fixed point with fractional_bits
//   opacity    u8 / 255;   colour  f_dc = (u8 / 255 - 0.5) / 0.15;   scale  logarithm = u8 / 16 - 10
//   rotation   v1, v2: x y z as u8 / 127.5 - 1 with w >= 0
//              v3+: the smallest three of x y z w, 2 + 3 x (sign + 9) bits
//   SH         (u8 - 128) / 128, coefficient by coefficient, red green blue together
//
// v1 to v3 are one gzip stream that begins with Header (older files: the same without gzip). v4 is HeaderV4,
// extensions, a table of stream sizes, and one zstd stream per attribute.
// Extensions: records of type, size and content, behind the attributes or, in v4, before the table. The one
// of Adobe names the axes. Without it they are x right, y up, z back (RUB), says the format's text, which not
// all writers do. One of ours says which way is up; readers pass over records that they do not know.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "scene/formats/losses.h"
#include "scene/formats/scene_file.h"
#include "scene/formats/spz_axes.h"

namespace splatcut::spz {

constexpr std::uint32_t kMagic = 0x5053474e;  // "NGSP"

struct Header {
  std::uint32_t magic = kMagic, version = 3, points = 0;
  std::uint8_t sh_degree = 0, fractional_bits = 12, flags = 0, streams = 0;  // streams: v4 only
};
static_assert(sizeof(Header) == 16);
constexpr std::uint8_t kFlagAntialiased = 1, kFlagExtensions = 2;

struct HeaderV4 {
  Header first;
  std::uint32_t table_begin = 32, reserved[3] = {};
};
static_assert(sizeof(HeaderV4) == 32);
struct StreamEntry {
  std::uint64_t packed_bytes, bytes;
};

// Numbers 1 to 8 of the axes: bit 0 right, bit 1 up, bit 2 forward, plus one; 9 to 16 exchange y and z.
constexpr std::uint32_t kAxesExtension = 0xadbe0003;
constexpr std::uint32_t kAxesUnspecified = 0, kAxesRightUpBack = 4, kAxesLast = 8;
struct AxesRecord {
  std::uint32_t type = kAxesExtension, bytes = 4, axes = kAxesRightUpBack;
};

// Which way is up, in the axes of the file.
constexpr std::uint32_t kUpExtension = 0x53430001;
struct UpRecord {
  std::uint32_t type = kUpExtension, bytes = 12;
  std::array<float, 3> up{};
};

// Of gzip, around what is written here: the axes are those of the format's text. Behind it may stand
// kUpInComment and three numbers.
constexpr std::string_view kOurComment = "splatcut: x right, y up, z back", kUpInComment = "; up ";

constexpr float kColourScale = 0.15f;
constexpr float kLogScaleSteps = 16.0f, kLogScaleMin = -10.0f;

constexpr int kAttributes = 6;

// Bytes per Gaussian of each attribute.
constexpr std::array<std::size_t, kAttributes> attribute_bytes(std::uint32_t version, int sh_degree) {
  return {version == 1 ? 6u : 9u,
          1,
          3,
          3,
          version >= 3 ? 4u : 3u,
          3 * static_cast<std::size_t>(sh_rest_coefficients(sh_degree))};
}

// What the bytes reach, half a step on either side included.
constexpr Reach kColourRange{(-0.5f / 255 - 0.5f) / kColourScale, (255.5f / 255 - 0.5f) / kColourScale};
constexpr Reach kLogScaleRange{kLogScaleMin - 0.5f / kLogScaleSteps, kLogScaleMin + 255.5f / kLogScaleSteps};
constexpr Reach kShByteRange{-128.5f / 128, 127.5f / 128};

}  // namespace splatcut::spz

namespace splatcut {

FormatPlan plan_spz(const Scene& scene, std::span<const std::uint32_t> gaussians, bool moved);
std::string write_spz(AtomicFile& out, const Scene& scene, std::span<const std::uint32_t> gaussians,
                      const SaveOptions& options);

}  // namespace splatcut
