// Writer of .spz version 3.
#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <array>

#include "scene/error.h"
#include "scene/quantise.h"
#include "scene/scene_formats.h"
#include "scene/spz_layout.h"

namespace splatcut {

namespace {

constexpr float kFixedLimit = 8388607.0f;  // 2^23 - 1
constexpr int kUsualFractionalBits = 12;

using Buffer = std::vector<std::uint8_t>;

// As many bits, up to the usual 12, as let the farthest coordinate fit into 24; more for a scene that the
// usual steps would be too coarse for. Throws Error where none do.
std::uint8_t fractional_bits_for(const GaussianCloud& cloud, std::span<const std::uint32_t> gaussians) {
  float farthest = 0;
  for (const std::uint32_t g : gaussians)
    for (int axis = 0; axis < 3; ++axis) farthest = std::max(farthest, std::abs(cloud.position[g][axis]));
  int bits = kUsualFractionalBits;
  while (bits > 0 && std::ldexp(farthest, bits) > kFixedLimit) --bits;
  constexpr float kCoarse = 1 << kUsualFractionalBits;
  constexpr int kMostFractionalBits = 24;
  while (farthest > 0 && bits < kMostFractionalBits && std::ldexp(farthest, bits) < kCoarse) ++bits;
  constexpr float kFewestSteps = 256;
  if (std::ldexp(farthest, bits) > kFixedLimit || (farthest > 0 && std::ldexp(farthest, bits) < kFewestSteps))
    throw Error("spz", fmt::format("coordinates up to {:g} cannot be written in 24 bits", farthest),
                "Choose another format, or scale the scene");
  return static_cast<std::uint8_t>(bits);
}

void add_position(Buffer& out, const glm::vec3& position, int fractional_bits) {
  for (const float v : {position.x, -position.y, -position.z}) {
    const float fixed = std::clamp(std::round(std::ldexp(v, fractional_bits)), -kFixedLimit, kFixedLimit);
    const auto bits = static_cast<std::uint32_t>(static_cast<std::int32_t>(fixed));
    for (int shift = 0; shift < 24; shift += 8) out.push_back(static_cast<std::uint8_t>(bits >> shift));
  }
}

void add_rotation(Buffer& out, const glm::quat& rotation) {
  const std::array<float, 4> q{rotation.x, -rotation.y, -rotation.z, rotation.w};
  const std::uint32_t largest = largest_of(q);
  std::uint32_t packed = largest;
  for (std::uint32_t i = 0; i < 4; ++i) {
    if (i == largest) continue;
    const bool negative = (q[i] < 0) != (q[largest] < 0);
    packed = packed << 10 | (negative ? 1u << 9 : 0u) | to_steps(std::abs(q[i]) / std::sqrt(0.5f), 9);
  }
  for (int shift = 0; shift < 32; shift += 8) out.push_back(static_cast<std::uint8_t>(packed >> shift));
}

void add_sh(Buffer& out, std::span<const float> rest) {
  const std::size_t coefficients = rest.size() / 3;
  for (std::size_t k = 0; k < coefficients; ++k)
    for (std::size_t c = 0; c < 3; ++c)
      out.push_back(to_byte(rest[c * coefficients + k] * spz::kShFlip[k] * 128.0f + 128.0f));
}

// How many have no axis that can be written, or one that is too long.
std::size_t beyond_scales(const GaussianCloud& cloud, std::span<const std::uint32_t> gaussians) {
  const float least = std::exp(spz::kLogScaleMin),
              most = std::exp(spz::kLogScaleMin + 255 / spz::kLogScaleSteps);
  return static_cast<std::size_t>(std::ranges::count_if(gaussians, [&](std::uint32_t g) {
    const glm::vec3& s = cloud.scale[g];
    const float longest = std::max({s.x, s.y, s.z});
    return longest < least || longest > most;
  }));
}

Buffer packed(const GaussianCloud& cloud, std::span<const std::uint32_t> gaussians) {
  spz::Header header;
  header.points = static_cast<std::uint32_t>(gaussians.size());
  header.sh_degree = static_cast<std::uint8_t>(cloud.sh_degree);
  header.fractional_bits = fractional_bits_for(cloud, gaussians);
  Buffer out(sizeof header);
  std::memcpy(out.data(), &header, sizeof header);
  for (const std::uint32_t g : gaussians) add_position(out, cloud.position[g], header.fractional_bits);
  for (const std::uint32_t g : gaussians) out.push_back(to_byte(255.0f * cloud.opacity[g]));
  for (const std::uint32_t g : gaussians)
    for (int c = 0; c < 3; ++c)
      out.push_back(to_byte(255.0f * (cloud.f_dc[g][c] * spz::kColourScale + 0.5f)));
  for (const std::uint32_t g : gaussians)
    for (int c = 0; c < 3; ++c)
      out.push_back(to_byte((std::log(cloud.scale[g][c]) - spz::kLogScaleMin) * spz::kLogScaleSteps));
  for (const std::uint32_t g : gaussians) add_rotation(out, cloud.rotation[g]);
  for (const std::uint32_t g : gaussians) add_sh(out, cloud.sh_rest_of(g));
  return out;
}

}  // namespace

std::string write_spz(AtomicFile& out, const GaussianCloud& cloud, std::span<const std::uint32_t> gaussians) {
  const Buffer data = packed(cloud, gaussians);
  z_stream stream{};
  constexpr int kGzip = 16 + MAX_WBITS, kMemoryLevel = 8;
  if (deflateInit2(&stream, Z_DEFAULT_COMPRESSION, Z_DEFLATED, kGzip, kMemoryLevel, Z_DEFAULT_STRATEGY) !=
      Z_OK)
    throw Error("spz", "the gzip writer failed to start");
  const std::unique_ptr<z_stream, int (*)(z_stream*)> guard(&stream, deflateEnd);
  constexpr std::size_t kPiece = 1 << 20;
  std::vector<std::byte> piece(kPiece);
  for (std::size_t begin = 0; begin < data.size(); begin += kPiece) {
    const std::size_t count = std::min(kPiece, data.size() - begin);
    stream.next_in = const_cast<Bytef*>(data.data() + begin);
    stream.avail_in = static_cast<uInt>(count);
    const int flush = begin + count == data.size() ? Z_FINISH : Z_NO_FLUSH;
    do {
      stream.next_out = reinterpret_cast<Bytef*>(piece.data());
      stream.avail_out = static_cast<uInt>(piece.size());
      deflate(&stream, flush);
      out.write(std::span(piece).first(piece.size() - stream.avail_out));
    } while (stream.avail_out == 0);
  }
  std::string loss = "positions are rounded to 24 bits, all other values to 8 to 10 bits";
  if (const std::size_t count = beyond_scales(cloud, gaussians); count > 0)
    loss += fmt::format("; {} Gaussians are smaller or larger than the format knows sizes", count);
  return loss;
}

}  // namespace splatcut
