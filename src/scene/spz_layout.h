// What reader and writer of .spz (Niantic) share. Internal to src/scene.
//
// Attributes stand apart, in this order: positions, opacities, colours, scales, rotations, SH.
//   position   v1: 3 half floats; v2+: 3 x 24-bit fixed point with fractional_bits
//   opacity    u8 / 255;   colour  f_dc = (u8 / 255 - 0.5) / 0.15;   scale  logarithm = u8 / 16 - 10
//   rotation   v1, v2: x y z as u8 / 127.5 - 1 with w >= 0
//              v3+: the smallest three of x y z w, 2 + 3 x (sign + 9) bits
//   SH         (u8 - 128) / 128, coefficient by coefficient, red green blue together
//
// v1 to v3 are one gzip stream that begins with Header. v4 is Header, a table of stream sizes, and one zstd
// stream per attribute.
// Axes are x right, y up, z back (RUB); ours are x right, y down, z forward: y and z change sign.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "scene/gaussian_cloud.h"

namespace splatcut::spz {

constexpr std::uint32_t kMagic = 0x5053474e;  // "NGSP"

struct Header {
  std::uint32_t magic = kMagic, version = 3, points = 0;
  std::uint8_t sh_degree = 0, fractional_bits = 12, flags = 0, streams = 0;  // streams: v4 only
};
static_assert(sizeof(Header) == 16);

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

// Signs that SH coefficients 1..15 take when y and z change sign: that of the product of y and z in them.
constexpr std::array<float, 15> kShFlip{-1, -1, 1, -1, 1, 1, -1, 1, -1, 1, -1, -1, 1, -1, 1};

}  // namespace splatcut::spz
