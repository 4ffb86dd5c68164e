// What reader and writer of glTF with KHR_gaussian_splatting share. Internal to src/scene/formats.
//
// Values are activated: scale linear, opacity 0 to 1; rotation x y z w; SH a VEC3 for each coefficient.
// Drafts of the extension had the logarithm of the scale, which shows in negative numbers. Axes are x left, y
// up, z forward.
#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "scene/formats/scene_file.h"

namespace splatcut::gltf {

constexpr const char* kExtension = "KHR_gaussian_splatting";
constexpr std::string_view kGlbMark = "glTF";
constexpr std::uint32_t kJsonChunk = 0x4e4f534a, kBinaryChunk = 0x004e4942;
constexpr int kInt8 = 5120, kUint8 = 5121, kInt16 = 5122, kUint16 = 5123, kFloat = 5126;
constexpr int kPointsMode = 0;  // of a primitive

struct GlbHeader {
  std::uint32_t magic, version, bytes;
};
struct ChunkHeader {
  std::uint32_t bytes, type;
};

inline std::string attribute_name(const char* what) {
  return fmt::format("{}:{}", kExtension, what);
}
inline std::string sh_name(int degree, int coefficient) {
  return fmt::format("{}:SH_DEGREE_{}_COEF_{}", kExtension, degree, coefficient);
}

}  // namespace splatcut::gltf

namespace splatcut {

std::string write_glb(AtomicFile& out, const Scene& scene, std::span<const std::uint32_t> gaussians,
                      const SaveOptions& options);
FormatPlan plan_glb(const Scene& scene, std::span<const std::uint32_t> gaussians, bool moved);

}  // namespace splatcut
