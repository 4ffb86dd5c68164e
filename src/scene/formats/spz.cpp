// Reader of .spz, versions 1 to 4.
#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <optional>

#include "core/error.h"
#include "scene/cloud/quantise.h"
#include "scene/formats/decode.h"
#include "scene/formats/said_up.h"
#include "scene/formats/spz_rows.h"
#include "scene/packing/incomplete.h"
#include "scene/packing/unpack.h"
#include "scene/raster/guessed_up.h"

namespace splatcut {

float SpzRows::coordinate(std::size_t row, std::size_t axis) const {
  if (header.version == 1) return half_to_float(load<std::uint16_t>(at(0, row, 6) + 2 * axis));
  const std::byte* b = at(0, row, 9) + 3 * axis;
  const auto byte = [&](std::size_t i) { return std::to_integer<std::uint32_t>(b[i]); };
  const auto fixed = static_cast<std::int32_t>(byte(0) << 8 | byte(1) << 16 | byte(2) << 24) >> 8;
  return std::ldexp(static_cast<float>(fixed), -header.fractional_bits);
}

glm::vec3 SpzRows::position(std::size_t row) const {
  return axes.position({coordinate(row, 0), coordinate(row, 1), coordinate(row, 2)});
}

std::array<float, 4> SpzRows::file_rotation(std::size_t row) const {
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

void SpzRows::decode(std::size_t row, GaussianCloud& cloud, std::size_t g) const {
  const std::array<float, 4> q = file_rotation(row);
  cloud.rotation[g] = glm::normalize(axes.rotation({q[3], q[0], q[1], q[2]}));
  cloud.opacity[g] = byte_at(at(1, row, 1)) / 255.0f;
  const std::byte *colour = at(2, row, 3), *scale = at(3, row, 3);
  for (int c = 0; c < 3; ++c) {
    cloud.f_dc[g][c] = (byte_at(colour + c) / 255.0f - 0.5f) / spz::kColourScale;
    cloud.scale[g][c] = std::exp(byte_at(scale + c) / spz::kLogScaleSteps + spz::kLogScaleMin);
  }
  const auto own = static_cast<std::size_t>(sh_rest_coefficients(degree));
  const std::size_t all = cloud.sh_stride() / 3;
  const std::byte* sh = at(5, row, sh_bytes);
  float* rest = cloud.sh_rest.data() + g * cloud.sh_stride();
  for (std::size_t k = 0; k < own; ++k)
    for (std::size_t c = 0; c < 3; ++c)
      rest[c * all + k] = (byte_at(sh + 3 * k + c) - 128.0f) / 128.0f * sh_signs[k];
}

std::uint64_t SpzRows::unpacked_bytes() const {
  std::uint64_t bytes = 0;
  for (const Bytes& part : unpacked) bytes += part.size();
  return bytes;
}

namespace {

constexpr int kMaxFileDegree = 4, kMaxDegree = 3;  // v4 allows the first, the second is read

void check_header(const MappedFile& file, const spz::Header& header) {
  const auto refuse = [&](const std::string& what) { throw Error(file.path().string(), what); };
  constexpr int kMaxFractionalBits = 24;
  if (header.magic != spz::kMagic) refuse("is not a .spz file: the mark \"NGSP\" is missing");
  if (header.version < 1 || header.version > 4)
    refuse(fmt::format("version {} of .spz is not supported", header.version));
  if (header.sh_degree > (header.version == 4 ? kMaxFileDegree : kMaxDegree))
    refuse(fmt::format("spherical harmonics of degree {} are not supported", header.sh_degree));
  if (header.fractional_bits > kMaxFractionalBits)
    refuse(fmt::format("{} fractional bits in positions of 24 bits", header.fractional_bits));
  if (header.points == 0) refuse("the file holds no Gaussians");
}

// What the first record of a type holds, among those of an extension block; none where it has fewer bytes.
template <class Content>
std::optional<Content> content_of(const SpzRows& rows, std::uint32_t type) {
  struct RecordHead {
    std::uint32_t type, bytes;
  };
  std::span<const std::byte> records = rows.extensions;
  while (rows.header.flags & spz::kFlagExtensions && records.size() >= sizeof(RecordHead)) {
    const auto head = load<RecordHead>(records.data());
    records = records.subspan(sizeof head);
    if (head.bytes > records.size()) break;  // of a vendor who has no sizes
    if (head.type == type && head.bytes >= sizeof(Content)) return load<Content>(records.data());
    records = records.subspan(head.bytes);
  }
  return {};
}

// The axes that a record names; none where no record does.
std::optional<AxisSigns> axes_said(const MappedFile& file, const SpzRows& rows) {
  const auto axes = content_of<std::uint32_t>(rows, spz::kAxesExtension);
  if (!axes) return {};
  if (*axes > spz::kAxesLast)
    throw Error(file.path().string(), fmt::format("its axes (number {}) exchange y and z", *axes),
                "Convert it to axes x right, y up, z back with the program that wrote it");
  const std::uint32_t bits = (*axes == spz::kAxesUnspecified ? spz::kAxesRightUpBack : *axes) - 1;
  return AxisSigns{bits & 1 ? 1.0f : -1.0f, bits & 2 ? -1.0f : 1.0f, bits & 4 ? 1.0f : -1.0f};
}

SaidUp up_of(const SpzRows& rows) {
  if (rows.up_in_comment) return rows.up_in_comment;
  const auto up = content_of<std::array<float, 3>>(rows, spz::kUpExtension);
  return up ? SaidUp(glm::dvec3((*up)[0], (*up)[1], (*up)[2])) : std::nullopt;
}

const char* words_for(SpzAxes axes) {
  return axes == SpzAxes::kPly ? "x right, y down, z forward, as in a .ply"
                               : "x right, y up, z back, as the text of the format says";
}

void decode_in(const AxisSigns& axes, SpzRows* rows, Scene& scene, const Job& job) {
  rows->axes = axes;
  rows->sh_signs = axes.sh();
  decode_rows(*rows, rows->count, rows->degree, scene, job);
}
void decode_in(SpzAxes axes, SpzRows* rows, Scene& scene, const Job& job) {
  decode_in(axes == SpzAxes::kPly ? AxisSigns{} : kRightUpBack, rows, scene, job);
  scene.taken_axes = axes;
}

void decode_unsaid(const LoadOptions& options, SpzRows* rows, Scene& scene, const Job& job) {
  decode_in(options.spz_axes.value_or(SpzAxes::kRub), rows, scene, job);
  if (job.cancelled()) return;
  const char* why = "nothing says otherwise";
  if (options.spz_axes) {
    why = "as was asked for";
  } else if (const auto seen = axes_by_cameras(scene.cloud, options.cameras)) {
    why = "the cameras see more of the scene so";
    if (seen != scene.taken_axes) decode_in(*seen, rows, scene, job);
  } else if (const std::optional<bool> standing = stands(scene.cloud)) {
    why = "so the scene stands, the other way it is on its head";
    if (!*standing) decode_in(SpzAxes::kPly, rows, scene, job);
  }
  scene.axes_note =
      fmt::format("The .spz file does not say its axes. Taken: {} ({})", words_for(*scene.taken_axes), why);
}

// Against what the file says.
void decode_asked(SpzAxes axes, SpzRows* rows, Scene& scene, const Job& job) {
  decode_in(axes, rows, scene, job);
  scene.axes_note =
      fmt::format("The .spz file says its axes, but others were asked for. Taken: {}", words_for(axes));
}

void decode(const MappedFile& file, const LoadOptions& options, SpzRows& rows, Scene& scene, const Job& job) {
  scene.cloud.antialiased = rows.antialiased;
  if (rows.header.sh_degree > rows.degree)
    scene.left_out =
        fmt::format("Spherical harmonics of degree {} are left out, those up to degree {} are read",
                    rows.header.sh_degree, rows.degree);
  auto said = axes_said(file, rows);
  if (!said && rows.ours) said = kRightUpBack;
  if (!said) return decode_unsaid(options, &rows, scene, job);
  if (options.spz_axes) return decode_asked(*options.spz_axes, &rows, scene, job);
  decode_in(*said, &rows, scene, job);
}

SpzRows rows_for(const spz::Header& header) {
  SpzRows rows;
  rows.header = header;
  rows.count = header.points;
  rows.antialiased = header.flags & spz::kFlagAntialiased;
  rows.sh_bytes = spz::attribute_bytes(header.version, header.sh_degree)[5];
  rows.degree = std::min<int>(header.sh_degree, kMaxDegree);
  return rows;
}

std::size_t attributes_size(const spz::Header& header) {
  std::size_t total = 0;
  for (const std::size_t bytes : spz::attribute_bytes(header.version, header.sh_degree))
    total += bytes * header.points;
  return total;
}

// data: the attributes of versions 1 to 3, one behind the other.
void set_attributes(std::span<const std::byte> data, SpzRows* rows) {
  const auto row_bytes = spz::attribute_bytes(rows->header.version, rows->header.sh_degree);
  std::size_t begin = 0;
  for (std::size_t a = 0; a < row_bytes.size(); ++a) {
    rows->attributes[a] = data.subspan(begin, row_bytes[a] * rows->count);
    begin += row_bytes[a] * rows->count;
  }
}

SpzRows rows_of_gzip(const MappedFile& file, const Job& job) {
  constexpr std::size_t kMostExtensionBytes = 1 << 16;
  GzipReader reader(file);
  const Bytes begin_of_data = reader.read(sizeof(spz::Header), job);
  if (job.cancelled()) return {};
  const auto header = load<spz::Header>(begin_of_data.data());
  if (header.magic != spz::kMagic)
    throw Error(file.path().string(), "is packed by gzip, and what is inside is no .spz",
                "Unpack it (gunzip) and give the scene inside");
  check_header(file, header);
  if (header.version > 3)
    throw Error(file.path().string(), fmt::format("version {} inside gzip data", header.version));
  check_expansion(file.path(), file.bytes().size(), attributes_size(header));
  SpzRows rows = rows_for(header);
  rows.unpacked.push_back(reader.read(attributes_size(header), job));
  if (job.cancelled()) return rows;
  set_attributes(rows.unpacked[0], &rows);
  if (header.flags & spz::kFlagExtensions) rows.extensions = reader.read_rest(kMostExtensionBytes);
  reader.check_end();
  const std::string comment = reader.comment();
  std::string_view rest = comment;
  rows.ours = comment.starts_with(spz::kOurComment);
  rest.remove_prefix(rows.ours ? spz::kOurComment.size() : rest.size());
  if (rest.starts_with(spz::kUpInComment))
    rows.up_in_comment = up_from_words(rest.substr(spz::kUpInComment.size()));
  return rows;
}

SpzRows rows_as_they_are(const MappedFile& file, const spz::Header& header) {
  const std::span<const std::byte> data = file.bytes().subspan(sizeof header);
  const std::size_t wanted = attributes_size(header);
  if (data.size() < wanted)
    throw Error(file.path().string(),
                incomplete(fmt::format("{} Gaussians take {} bytes, the file ends at byte {}", header.points,
                                       wanted + sizeof header, file.bytes().size())));
  SpzRows rows = rows_for(header);
  set_attributes(data.first(wanted), &rows);
  rows.extensions.assign(data.begin() + static_cast<std::ptrdiff_t>(wanted), data.end());
  return rows;
}

// The packed bytes of each stream. Throws Error for a table that does not fit file and header.
std::vector<std::span<const std::byte>> packed_streams(const MappedFile& file, const spz::HeaderV4& header) {
  const std::span<const std::byte> all = file.bytes();
  const auto truncated = [&](std::string_view what) {
    throw Error(file.path().string(), incomplete(fmt::format("{} reaches beyond byte {}", what, all.size())));
  };
  const auto row_bytes = spz::attribute_bytes(header.first.version, header.first.sh_degree);
  const std::size_t streams = header.first.sh_degree > 0 ? 6 : 5;
  if (header.first.streams < streams)
    throw Error(file.path().string(),
                fmt::format("{} streams found, {} are wanted", header.first.streams, streams));
  const std::size_t table = header.table_begin;
  std::size_t begin = table + header.first.streams * sizeof(spz::StreamEntry);
  if (table < sizeof header || begin > all.size()) truncated("the table of streams");
  std::vector<std::span<const std::byte>> packed;
  for (std::size_t s = 0; s < streams; ++s) {
    const auto entry = load<spz::StreamEntry>(all.data() + table + s * sizeof(spz::StreamEntry));
    if (entry.packed_bytes > all.size() - begin) truncated(fmt::format("stream {}", s));
    if (entry.bytes != row_bytes[s] * header.first.points)
      throw Error(file.path().string(), fmt::format("stream {} has {} bytes for {} Gaussians of {} bytes", s,
                                                    entry.bytes, header.first.points, row_bytes[s]));
    packed.push_back(all.subspan(begin, entry.packed_bytes));
    begin += entry.packed_bytes;
  }
  return packed;
}

SpzRows rows_of_streams(const MappedFile& file, const Job& job) {
  if (file.bytes().size() < sizeof(spz::HeaderV4))
    throw Error(file.path().string(),
                incomplete(fmt::format("the header reaches beyond byte {}", file.bytes().size())));
  const auto header = load<spz::HeaderV4>(file.bytes().data());
  const auto packed = packed_streams(file, header);
  check_expansion(file.path(), file.bytes().size(), attributes_size(header.first));
  const auto row_bytes = spz::attribute_bytes(header.first.version, header.first.sh_degree);
  SpzRows rows = rows_for(header.first);
  rows.unpacked.resize(packed.size());
  tbb::parallel_for(std::size_t{0}, packed.size(), [&](std::size_t s) {
    rows.unpacked[s] = unpack_zstd(file, packed[s], row_bytes[s] * header.first.points, s, job);
  });
  for (std::size_t s = 0; s < packed.size(); ++s) rows.attributes[s] = rows.unpacked[s];
  const auto records = file.bytes().subspan(sizeof header, header.table_begin - sizeof header);
  rows.extensions.assign(records.begin(), records.end());
  return rows;
}

constexpr std::byte kGzipFirst{0x1f};

spz::Header plain_header(const MappedFile& file) {
  if (file.bytes().size() < sizeof(spz::Header))
    throw Error(file.path().string(),
                incomplete(fmt::format("the header reaches beyond byte {}", file.bytes().size())));
  const auto header = load<spz::Header>(file.bytes().data());
  check_header(file, header);
  return header;
}

void read_spz(const MappedFile& file, const LoadOptions& options, Scene& scene, const Job& job) {
  job.progress("unpacking", 0.0);
  SpzRows rows = read_spz_rows(file, job);
  if (!job.cancelled()) decode(file, options, rows, scene, job);
  take_up(up_of(rows), rows.axes, &scene);
}

bool is_spz(const MappedFile& file) {
  return begins_with(file, "NGSP") || begins_with(file, "\x1f\x8b\x08");
}

}  // namespace

SpzRows read_spz_rows(const MappedFile& file, const Job& job) {
  if (file.bytes()[0] == kGzipFirst) return rows_of_gzip(file, job);
  const spz::Header header = plain_header(file);
  return header.version == 4 ? rows_of_streams(file, job) : rows_as_they_are(file, header);
}

int degree_of_spz(const MappedFile& file) {
  if (file.bytes()[0] != kGzipFirst) return std::min<int>(plain_header(file).sh_degree, kMaxDegree);
  GzipReader reader(file);
  const Bytes header = reader.read(sizeof(spz::Header), {});
  return std::min<int>(load<spz::Header>(header.data()).sh_degree, kMaxDegree);
}

constinit const SceneFormat SceneFormat::kSpz = {
    .name = "spz",
    .extension = ".spz",
    .axes = kRightUpBack,
    .recognises = is_spz,
    .read = read_spz,
    .write = write_spz,
    .plan = plan_spz,
};

}  // namespace splatcut
