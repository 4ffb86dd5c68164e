// Reader of .spz, versions 1 to 4.
#include <fmt/format.h>
#include <tbb/parallel_for.h>
#include <zlib.h>
#include <zstd.h>

#include <algorithm>
#include <bit>
#include <memory>

#include "scene/decode.h"
#include "scene/error.h"
#include "scene/quantise.h"
#include "scene/scene_formats.h"
#include "scene/spz_layout.h"

namespace splatcut {

namespace {

constexpr int kMaxFileDegree = 4;  // v4 allows it; coefficients beyond degree 3 are left out
constexpr std::size_t kStreamTableAt = 16;
constexpr std::size_t kV4HeaderBytes = 32;
// Memory is taken as data arrives, so that a small file that promises much is refused at little cost.
constexpr std::size_t kFirstBuffer = 1 << 22;

// Unpacked between two looks at the stop token: some 10 ms.
constexpr std::size_t kChunk = 1 << 22;

using Bytes = std::vector<std::byte>;

void grow(Bytes& bytes, std::size_t wanted) {
  bytes.resize(std::min(wanted, std::max(kFirstBuffer, 2 * bytes.size())));
}

// Inflates one gzip stream piece by piece.
class GzipReader {
 public:
  explicit GzipReader(const MappedFile& file) : file_(file), in_(file.bytes()) {
    constexpr int kGzipOnly = 16 + MAX_WBITS;
    if (inflateInit2(&stream_, kGzipOnly) != Z_OK)
      throw Error(file.path().string(), "the gzip reader failed to start");
  }
  GzipReader(const GzipReader&) = delete;
  GzipReader& operator=(const GzipReader&) = delete;
  ~GzipReader() { inflateEnd(&stream_); }

  // Fewer bytes when cancelled.
  Bytes read(std::size_t count, const Job& job) {
    Bytes out;
    for (std::size_t done = 0; done < count && !job.cancelled();) {
      if (done == out.size()) grow(out, count);
      done += read_some(std::span(out).subspan(done), done);
    }
    return out;
  }

 private:
  std::size_t read_some(std::span<std::byte> out, std::size_t done) {
    const auto in = in_.first(std::min(in_.size(), kChunk));
    stream_.next_in = reinterpret_cast<Bytef*>(const_cast<std::byte*>(in.data()));
    stream_.avail_in = static_cast<uInt>(in.size());
    stream_.next_out = reinterpret_cast<Bytef*>(out.data());
    const std::size_t room = std::min(out.size(), kChunk);
    stream_.avail_out = static_cast<uInt>(room);
    const int result = inflate(&stream_, Z_NO_FLUSH);
    in_ = in_.subspan(in.size() - stream_.avail_in);
    const std::size_t written = room - stream_.avail_out;
    if (written > 0) return written;
    const std::size_t at = file_.bytes().size() - in_.size();
    if (result == Z_OK || result == Z_STREAM_END || result == Z_BUF_ERROR)
      throw Error(file_.path().string(),
                  fmt::format("truncated: the gzip data ends at byte {} after {} unpacked bytes", at, done));
    throw Error(file_.path().string(), fmt::format("the gzip data is damaged at byte {}", at));
  }

  const MappedFile& file_;
  std::span<const std::byte> in_;
  z_stream stream_{};
};

// Incomplete when cancelled.
Bytes unpack_zstd(const MappedFile& file, std::span<const std::byte> packed, std::size_t size,
                  std::size_t index, const Job& job) {
  const std::unique_ptr<ZSTD_DStream, std::size_t (*)(ZSTD_DStream*)> stream(ZSTD_createDStream(),
                                                                             ZSTD_freeDStream);
  ZSTD_inBuffer in{packed.data(), packed.size(), 0};
  Bytes bytes;
  for (std::size_t done = 0; done < size && !job.cancelled();) {
    if (done == bytes.size()) grow(bytes, size);
    ZSTD_outBuffer out{bytes.data(), std::min(bytes.size(), done + kChunk), done};
    const std::size_t result = ZSTD_decompressStream(stream.get(), &out, &in);
    if (ZSTD_isError(result))
      throw Error(file.path().string(),
                  fmt::format("stream {} is damaged ({})", index, ZSTD_getErrorName(result)));
    if (out.pos == done && in.pos == in.size)
      throw Error(file.path().string(),
                  fmt::format("stream {} ends after {} of {} bytes", index, done, size));
    done = out.pos;
  }
  return bytes;
}

float half_to_float(std::uint16_t half) {
  const int exponent = half >> 10 & 31;
  const float mantissa = static_cast<float>(half & 1023);
  const float magnitude = exponent == 0    ? std::ldexp(mantissa, -24)
                          : exponent == 31 ? std::numeric_limits<float>::quiet_NaN()
                                           : std::ldexp(mantissa + 1024.0f, exponent - 25);
  return half & 0x8000 ? -magnitude : magnitude;
}

struct SpzRows {
  spz::Header header;
  std::array<std::span<const std::byte>, spz::kAttributes> attributes;
  std::size_t sh_bytes = 0;
  int degree = 0;  // at most 3

  const std::byte* at(int attribute, std::size_t row, std::size_t bytes) const {
    return attributes[static_cast<std::size_t>(attribute)].data() + row * bytes;
  }
  float coordinate(std::size_t row, std::size_t axis) const {
    if (header.version == 1) return half_to_float(load<std::uint16_t>(at(0, row, 6) + 2 * axis));
    const std::byte* b = at(0, row, 9) + 3 * axis;
    const auto byte = [&](std::size_t i) { return std::to_integer<std::uint32_t>(b[i]); };
    const auto fixed = static_cast<std::int32_t>(byte(0) << 8 | byte(1) << 16 | byte(2) << 24) >> 8;
    return std::ldexp(static_cast<float>(fixed), -header.fractional_bits);
  }
  glm::vec3 position(std::size_t row) const {
    return {coordinate(row, 0), -coordinate(row, 1), -coordinate(row, 2)};
  }
  // x y z w in the file's axes.
  std::array<float, 4> file_rotation(std::size_t row) const {
    std::array<float, 4> q{};
    float sum = 0;
    if (header.version < 3) {
      const std::byte* b = at(4, row, 3);
      for (std::size_t i = 0; i < 3; ++i) {
        q[i] = byte_at(b + i) / 127.5f - 1.0f;
        sum += q[i] * q[i];
      }
      q[3] = std::sqrt(std::max(0.0f, 1.0f - sum));
      return q;
    }
    std::uint32_t v = load<std::uint32_t>(at(4, row, 4));
    const std::uint32_t largest = v >> 30;
    for (std::uint32_t i = 4; i-- > 0;) {
      if (i == largest) continue;
      q[i] = from_steps(v, 9) * std::sqrt(0.5f) * (v >> 9 & 1 ? -1.0f : 1.0f);
      sum += q[i] * q[i];
      v >>= 10;
    }
    q[largest] = std::sqrt(std::max(0.0f, 1.0f - sum));
    return q;
  }
  void decode(std::size_t row, GaussianCloud& cloud, std::size_t g) const {
    const std::array<float, 4> q = file_rotation(row);
    cloud.rotation[g] = glm::normalize(glm::quat(q[3], q[0], -q[1], -q[2]));
    cloud.opacity[g] = byte_at(at(1, row, 1)) / 255.0f;
    const std::byte *colour = at(2, row, 3), *scale = at(3, row, 3);
    for (int c = 0; c < 3; ++c) {
      cloud.f_dc[g][c] = (byte_at(colour + c) / 255.0f - 0.5f) / spz::kColourScale;
      cloud.scale[g][c] = std::exp(byte_at(scale + c) / spz::kLogScaleSteps + spz::kLogScaleMin);
    }
    const auto coefficients = static_cast<std::size_t>(sh_rest_coefficients(degree));
    const std::byte* sh = at(5, row, sh_bytes);
    float* rest = cloud.sh_rest.data() + g * 3 * coefficients;
    for (std::size_t k = 0; k < coefficients; ++k)
      for (std::size_t c = 0; c < 3; ++c)
        rest[c * coefficients + k] = (byte_at(sh + 3 * k + c) - 128.0f) / 128.0f * spz::kShFlip[k];
  }
};

void check_header(const MappedFile& file, const spz::Header& header) {
  const auto refuse = [&](const std::string& what) { throw Error(file.path().string(), what); };
  constexpr int kMaxFractionalBits = 24;
  if (header.magic != spz::kMagic) refuse("is not a .spz file: the mark \"NGSP\" is missing");
  if (header.version < 1 || header.version > 4)
    refuse(fmt::format("version {} of .spz is not supported", header.version));
  if (header.sh_degree > (header.version == 4 ? kMaxFileDegree : 3))
    refuse(fmt::format("spherical harmonics of degree {} are not supported", header.sh_degree));
  if (header.fractional_bits > kMaxFractionalBits)
    refuse(fmt::format("{} fractional bits in positions of 24 bits", header.fractional_bits));
  if (header.points == 0) refuse("the file holds no Gaussians");
}

SpzRows rows_for(const spz::Header& header) {
  SpzRows rows;
  rows.header = header;
  rows.sh_bytes = spz::attribute_bytes(header.version, header.sh_degree)[5];
  rows.degree = std::min<int>(header.sh_degree, 3);
  return rows;
}

void read_gzip(const MappedFile& file, Scene& scene, const Job& job) {
  GzipReader reader(file);
  const Bytes begin_of_data = reader.read(sizeof(spz::Header), job);
  if (job.cancelled()) return;
  const auto header = load<spz::Header>(begin_of_data.data());
  check_header(file, header);
  if (header.version > 3)
    throw Error(file.path().string(), fmt::format("version {} inside gzip data", header.version));
  SpzRows rows = rows_for(header);
  const auto row_bytes = spz::attribute_bytes(header.version, header.sh_degree);
  std::size_t total = 0;
  for (const std::size_t bytes : row_bytes) total += bytes * header.points;
  job.progress("unpacking", 0.0);
  const Bytes data = reader.read(total, job);
  if (job.cancelled()) return;
  std::size_t begin = 0;
  for (std::size_t a = 0; a < row_bytes.size(); ++a) {
    rows.attributes[a] = std::span(data).subspan(begin, row_bytes[a] * header.points);
    begin += row_bytes[a] * header.points;
  }
  decode_rows(rows, header.points, rows.degree, scene, job);
}

struct StreamEntry {
  std::uint64_t packed_bytes, bytes;
};

void read_streams(const MappedFile& file, Scene& scene, const Job& job) {
  const std::span<const std::byte> all = file.bytes();
  const auto truncated = [&](std::string_view what) {
    throw Error(file.path().string(), fmt::format("truncated: {} reaches beyond byte {}", what, all.size()));
  };
  if (all.size() < kV4HeaderBytes) truncated("the header");
  const auto header = load<spz::Header>(all.data());
  check_header(file, header);
  if (header.version != 4)
    throw Error(file.path().string(), fmt::format("version {} outside gzip data", header.version));
  const auto row_bytes = spz::attribute_bytes(header.version, header.sh_degree);
  const std::size_t streams = header.sh_degree > 0 ? 6 : 5;
  if (header.streams < streams)
    throw Error(file.path().string(),
                fmt::format("{} streams found, {} are wanted", header.streams, streams));
  const std::size_t table = load<std::uint32_t>(all.data() + kStreamTableAt);
  std::size_t begin = table + header.streams * sizeof(StreamEntry);
  if (table < kV4HeaderBytes || begin > all.size()) truncated("the table of streams");
  std::array<std::span<const std::byte>, spz::kAttributes> packed;
  for (std::size_t s = 0; s < streams; ++s) {
    const auto entry = load<StreamEntry>(all.data() + table + s * sizeof(StreamEntry));
    if (entry.packed_bytes > all.size() - begin) truncated(fmt::format("stream {}", s));
    if (entry.bytes != row_bytes[s] * header.points)
      throw Error(file.path().string(), fmt::format("stream {} has {} bytes for {} Gaussians of {} bytes", s,
                                                    entry.bytes, header.points, row_bytes[s]));
    packed[s] = all.subspan(begin, entry.packed_bytes);
    begin += entry.packed_bytes;
  }
  job.progress("unpacking", 0.0);
  std::array<Bytes, spz::kAttributes> data;
  tbb::parallel_for(std::size_t{0}, streams, [&](std::size_t s) {
    data[s] = unpack_zstd(file, packed[s], row_bytes[s] * header.points, s, job);
  });
  if (job.cancelled()) return;
  SpzRows rows = rows_for(header);
  for (std::size_t s = 0; s < streams; ++s) rows.attributes[s] = data[s];
  decode_rows(rows, header.points, rows.degree, scene, job);
}

}  // namespace

void read_spz(const MappedFile& file, Scene& scene, const Job& job) {
  constexpr std::byte kGzipFirst{0x1f};
  if (file.bytes()[0] == kGzipFirst)
    read_gzip(file, scene, job);
  else
    read_streams(file, scene, job);
}

}  // namespace splatcut
