// Writer of .spz, versions 3 (gzip) and 4 (zstd), always in axes x right, y up, z back. Version 4 says so.
// Common readers of version 3 take any byte behind the attributes for a damaged file: there the comment of
// gzip's header, which nobody reads, says it to us.
#include <fmt/format.h>
#include <zlib.h>
#include <zstd.h>
#include <zstd_errors.h>

#include <algorithm>
#include <array>
#include <new>

#include "core/atomic_file.h"
#include "core/error.h"
#include "scene/cloud/fixed_steps.h"
#include "scene/cloud/quantise.h"
#include "scene/formats/said_up.h"
#include "scene/formats/spz_layout.h"
#include "scene/packing/packed_size.h"

namespace splatcut {

namespace {

using Buffer = std::vector<std::uint8_t>;

void add_position(Buffer& out, const glm::vec3& position, const FixedSteps& steps) {
  const glm::vec3 file = kRightUpBack.position(position);
  for (const float v : {file.x, file.y, file.z}) {
    const auto bits = static_cast<std::uint32_t>(static_cast<std::int32_t>(steps.rounded(v)));
    for (int shift = 0; shift < 24; shift += 8) out.push_back(static_cast<std::uint8_t>(bits >> shift));
  }
}

void add_rotation(Buffer& out, const glm::quat& rotation) {
  const glm::quat file = kRightUpBack.rotation(rotation);
  const std::array<float, 4> q{file.x, file.y, file.z, file.w};
  const std::uint32_t largest = largest_of(q);
  std::uint32_t packed = largest;
  for (std::uint32_t i = 0; i < 4; ++i) {
    if (i == largest) continue;
    const bool negative = (q[i] < 0) != (q[largest] < 0);
    packed = packed << 10 | (negative ? 1u << 9 : 0u) | to_steps(std::abs(q[i]) / std::sqrt(0.5f), 9);
  }
  for (int shift = 0; shift < 32; shift += 8) out.push_back(static_cast<std::uint8_t>(packed >> shift));
}

void add_sh_bytes(Buffer& out, std::span<const float> rest) {
  static constexpr std::array<float, 15> kSigns = kRightUpBack.sh();
  const std::size_t coefficients = rest.size() / 3;
  for (std::size_t k = 0; k < coefficients; ++k)
    for (std::size_t c = 0; c < 3; ++c)
      out.push_back(to_byte(rest[c * coefficients + k] * kSigns[k] * 128.0f + 128.0f));
}

spz::Header header_of(const Scene& scene, std::span<const std::uint32_t> gaussians, const FixedSteps& steps) {
  spz::Header header;
  header.points = static_cast<std::uint32_t>(gaussians.size());
  header.sh_degree = static_cast<std::uint8_t>(scene.cloud.sh_degree);
  header.fractional_bits = static_cast<std::uint8_t>(steps.bits);
  if (scene.cloud.antialiased) header.flags |= spz::kFlagAntialiased;
  return header;
}

// Of all Gaussians one attribute after the other, in the order of spz::attribute_bytes().
std::array<Buffer, spz::kAttributes> attributes(const GaussianCloud& cloud,
                                                std::span<const std::uint32_t> gaussians,
                                                const FixedSteps& steps) {
  std::array<Buffer, spz::kAttributes> out;
  for (const std::uint32_t g : gaussians) {
    add_position(out[0], cloud.position[g], steps);
    out[1].push_back(to_byte(255.0f * cloud.opacity[g]));
    for (int c = 0; c < 3; ++c) {
      out[2].push_back(to_byte(255.0f * (cloud.f_dc[g][c] * spz::kColourScale + 0.5f)));
      out[3].push_back(to_byte((std::log(cloud.scale[g][c]) - spz::kLogScaleMin) * spz::kLogScaleSteps));
    }
    add_rotation(out[4], cloud.rotation[g]);
    add_sh_bytes(out[5], cloud.sh_rest_of(g));
  }
  return out;
}

class GzipWriter {
 public:
  GzipWriter(AtomicFile& out, std::string comment) : out_(out), comment_(std::move(comment)) {
    constexpr int kGzip = 16 + MAX_WBITS, kMemoryLevel = 8;
    const int result =
        deflateInit2(&stream_, Z_DEFAULT_COMPRESSION, Z_DEFLATED, kGzip, kMemoryLevel, Z_DEFAULT_STRATEGY);
    if (result == Z_MEM_ERROR) throw std::bad_alloc();
    if (result != Z_OK) throw Error("spz", "the gzip writer failed to start");
    header_.comment = reinterpret_cast<Bytef*>(comment_.data());
    deflateSetHeader(&stream_, &header_);
  }
  GzipWriter(const GzipWriter&) = delete;
  GzipWriter& operator=(const GzipWriter&) = delete;
  ~GzipWriter() { deflateEnd(&stream_); }

  void write(std::span<const std::byte> data) {
    for (; !data.empty(); data = data.subspan(std::min(data.size(), kPiece)))
      deflate_piece(data.first(std::min(data.size(), kPiece)), Z_NO_FLUSH);
  }
  void finish() { deflate_piece({}, Z_FINISH); }

 private:
  static constexpr std::size_t kPiece = 1 << 20;

  void deflate_piece(std::span<const std::byte> data, int flush) {
    stream_.next_in = reinterpret_cast<Bytef*>(const_cast<std::byte*>(data.data()));
    stream_.avail_in = static_cast<uInt>(data.size());
    do {
      stream_.next_out = reinterpret_cast<Bytef*>(piece_.data());
      stream_.avail_out = static_cast<uInt>(piece_.size());
      deflate(&stream_, flush);
      out_.write(std::span(piece_).first(piece_.size() - stream_.avail_out));
    } while (stream_.avail_out == 0);
  }

  AtomicFile& out_;
  z_stream stream_{};
  std::string comment_;
  gz_header header_{};
  std::vector<std::byte> piece_ = std::vector<std::byte>(kPiece);
};

template <class T>
std::span<const std::byte> bytes_of(const T& value) {
  return std::as_bytes(std::span(&value, 1));
}

void write_version_3(AtomicFile& out, const spz::Header& header, std::span<const Buffer> attributes,
                     const std::optional<glm::vec3>& up) {
  std::string comment(spz::kOurComment);
  if (up) comment += std::string(spz::kUpInComment) + words_for_up(*up, kRightUpBack);
  GzipWriter gzip(out, comment);
  gzip.write(bytes_of(header));
  for (const Buffer& attribute : attributes) gzip.write(std::as_bytes(std::span(attribute)));
  gzip.finish();
}

Buffer zstd_packed(const Buffer& data) {
  constexpr int kLevel = 9;  // a tenth smaller than the usual 3, still faster than gzip
  Buffer packed(ZSTD_compressBound(data.size()));
  const std::size_t bytes = ZSTD_compress(packed.data(), packed.size(), data.data(), data.size(), kLevel);
  if (ZSTD_getErrorCode(bytes) == ZSTD_error_memory_allocation) throw std::bad_alloc();
  if (ZSTD_isError(bytes)) throw Error("spz", ZSTD_getErrorName(bytes));
  packed.resize(bytes);
  return packed;
}

void write_version_4(AtomicFile& out, const spz::Header& first, std::span<const Buffer> attributes,
                     const std::optional<glm::vec3>& up) {
  spz::HeaderV4 header;
  header.first = first;
  header.first.version = 4;
  header.first.flags |= spz::kFlagExtensions;
  header.first.streams = static_cast<std::uint8_t>(first.sh_degree > 0 ? 6 : 5);
  header.table_begin = sizeof(spz::HeaderV4) + sizeof(spz::AxesRecord) + (up ? sizeof(spz::UpRecord) : 0);
  out.write(bytes_of(header));
  out.write(bytes_of(spz::AxesRecord{}));
  if (up) {
    const glm::vec3 said = up_to_say(*up, kRightUpBack);
    out.write(bytes_of(spz::UpRecord{.up = {said.x, said.y, said.z}}));
  }
  std::vector<spz::StreamEntry> table;
  std::vector<Buffer> streams;
  for (const Buffer& attribute : attributes.first(header.first.streams)) {
    streams.push_back(zstd_packed(attribute));
    table.push_back({streams.back().size(), attribute.size()});
  }
  out.write(std::as_bytes(std::span(table)));
  for (const Buffer& stream : streams) out.write(std::as_bytes(std::span(stream)));
}

Losses spz_losses(const Scene& scene, std::span<const std::uint32_t> gaussians, const FixedSteps& steps) {
  const GaussianCloud& cloud = scene.cloud;
  constexpr std::size_t kMostOfOlderReaders = 10'000'000;  // in Niantic's load-spz.cc of versions 1 to 3
  Losses losses;
  if (gaussians.size() > kMostOfOlderReaders)
    losses.add(
        "programs with the format's older library open it as empty, as it has more than 10,000,000 "
        "Gaussians");
  losses.add("positions are rounded to 24 bits, all other values to 8 to 10 bits");
  losses.add(steps.moved(cloud, gaussians));
  losses.add(clamped_colours(cloud, gaussians, spz::kColourRange));
  losses.add(clamped_log_scales(cloud, gaussians, spz::kLogScaleRange));
  losses.add(clamped_sh(cloud, gaussians, spz::kShByteRange));
  losses.add(origin_left_out(scene));
  losses.add(properties_left_out(scene));
  return losses;
}

}  // namespace

std::string write_spz(AtomicFile& out, const Scene& scene, std::span<const std::uint32_t> gaussians,
                      const SaveOptions& options) {
  const FixedSteps steps(scene.cloud, gaussians);
  steps.check("spz", scene.cloud, gaussians);
  const spz::Header header = header_of(scene, gaussians, steps);
  const auto packed = attributes(scene.cloud, gaussians, steps);
  if (options.spz_version == 4)
    write_version_4(out, header, packed, options.up);
  else
    write_version_3(out, header, packed, options.up);
  return spz_losses(scene, gaussians, steps).sentence();
}

FormatPlan plan_spz(const Scene& scene, std::span<const std::uint32_t> gaussians, bool) {
  const std::vector<std::uint32_t> sample = spread_runs(gaussians);
  const FixedSteps steps(scene.cloud, gaussians);
  std::size_t packed = 0;
  for (const Buffer& attribute : attributes(scene.cloud, sample, steps))
    packed += deflated_bytes(std::as_bytes(std::span(attribute)));
  return {.bytes = packed * gaussians.size() / std::max<std::size_t>(1, sample.size()) + 64,
          .about = true,
          .kept = "What the scene says of Gaussians, quantised and packed.",
          .lost = spz_losses(scene, gaussians, steps).in_full()};
}

}  // namespace splatcut
