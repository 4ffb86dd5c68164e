// Properties of a chunk of a .rad file (rad.cpp), and how their numbers are written:
//   center       position x y z
//   rgb, alpha   colour that f_dc shows; opacity
//   scales       standard deviations
//   orientation  x y z of a quaternion whose w is at least 0. Encoded as oct88r8, three bytes a Gaussian: its
//                axis as a point u v of an octahedron, and its angle from 0 to pi
//   sh1 to sh3   9, 15 and 21 components, coefficient by coefficient
//   child_count, child_start
//                a tree of levels of detail: a Gaussian stands for its children, which are merged in it
// Encodings of numbers: f32 and f16; both with _lebytes: first all lowest bytes, last all highest; r8: from
// `min` to `max` in 255 steps; s8: from -`max` to `max` in 127 steps each way; both with _delta: each byte is
// the difference from the one before; ln_f16 and ln_0r8: logarithms, where 0 in ln_0r8 means size 0.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "scene/formats/decode.h"

namespace splatcut::rad {

enum class RadEncoding {
  kNone,
  kF32,
  kF16,
  kF32Bytes,
  kF16Bytes,
  kR8,
  kS8,
  kLnF16,
  kLn0R8,
  kOct,
  kU16,
  kU32
};

struct RadEncodingName {
  const char* name;
  RadEncoding encoding;
  std::size_t bytes;  // of a value
  bool differences = false;
};
constexpr std::array<RadEncodingName, 13> kRadEncodings{{{"f32", RadEncoding::kF32, 4},
                                                         {"f16", RadEncoding::kF16, 2},
                                                         {"f32_lebytes", RadEncoding::kF32Bytes, 4},
                                                         {"f16_lebytes", RadEncoding::kF16Bytes, 2},
                                                         {"r8", RadEncoding::kR8, 1},
                                                         {"r8_delta", RadEncoding::kR8, 1, true},
                                                         {"s8", RadEncoding::kS8, 1},
                                                         {"s8_delta", RadEncoding::kS8, 1, true},
                                                         {"ln_f16", RadEncoding::kLnF16, 2},
                                                         {"ln_0r8", RadEncoding::kLn0R8, 1},
                                                         {"oct88r8", RadEncoding::kOct, 1},
                                                         {"u16", RadEncoding::kU16, 2},
                                                         {"u32", RadEncoding::kU32, 4}}};

enum RadField : std::size_t {
  kCentre,
  kAlpha,
  kRgb,
  kScales,
  kOrientation,
  kSh1,
  kSh2,
  kSh3,
  kChildren,
  kFirstChild,
  kRadFields
};
struct RadFieldName {
  const char* name;
  std::size_t components;
  bool needed;
  std::array<RadEncoding, 4> may;  // and kNone where there are fewer
};
using enum RadEncoding;
constexpr std::array<RadFieldName, kRadFields> kRadNames{
    {{"center", 3, true, {kF32, kF16, kF32Bytes, kF16Bytes}},
     {"alpha", 1, true, {kF32, kF16, kR8}},
     {"rgb", 3, true, {kF32, kF16, kR8}},
     {"scales", 3, true, {kF32, kLnF16, kLn0R8}},
     {"orientation", 3, true, {kF32, kF16, kOct}},
     {"sh1", 9, false, {kF32, kF16, kR8, kS8}},
     {"sh2", 15, false, {kF32, kF16, kR8, kS8}},
     {"sh3", 21, false, {kF32, kF16, kR8, kS8}},
     {"child_count", 1, false, {kU16}},
     {"child_start", 1, false, {kU32}}}};

// One property of a chunk, unpacked.
struct RadValues {
  RadEncoding encoding = RadEncoding::kNone;
  float least = 0, most = 0;
  std::size_t count = 0, components = 0;
  Bytes bytes;  // empty: the chunk has no such property

  float at(std::size_t i, std::size_t component) const;
  std::uint32_t whole(std::size_t i) const {
    return encoding == RadEncoding::kU16 ? load<std::uint16_t>(bytes.data() + 2 * i)
                                         : load<std::uint32_t>(bytes.data() + 4 * i);
  }
  std::uint8_t byte(std::size_t plane, std::size_t i) const {
    return std::to_integer<std::uint8_t>(bytes[plane * count + i]);
  }
};

std::array<float, 4> rad_rotation(const RadValues& values, std::size_t i);  // x y z w

[[noreturn]] void refuse_rad(const std::filesystem::path& path, const std::string& what);

// The encoding that a chunk's text says. Throws Error for one that the property does not have.
const RadEncodingName& encoding_of(const std::filesystem::path& path, const nlohmann::json& said,
                                   const RadFieldName& name);

// Turns differences into values. count: number of values of each component.
void sum_differences(std::size_t count, Bytes* bytes);

}  // namespace splatcut::rad
