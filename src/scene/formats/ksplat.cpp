// .ksplat (mkkellogg): a header of 4096 bytes, section headers of 1024, then the sections, each with bucket
// sizes, bucket centres and rows. Read only: its author advises against making new ones.
//   level 0   all numbers are float
//   level 1   positions are uint16 around the centre of a bucket of 256 neighbours, other numbers half float
//   level 2   as 1, with SH as bytes over the range that the header names
// Rows: position, linear scale, rotation w x y z, colour and opacity in 4 bytes, SH degree by degree, in each
// of them all of red, then green, then blue. Axes are those of .ply.
#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "core/error.h"
#include "scene/cloud/quantise.h"
#include "scene/formats/decode.h"
#include "scene/packing/incomplete.h"

namespace splatcut {

namespace {

constexpr std::size_t kHeaderBytes = 4096, kSectionHeaderBytes = 1024;
constexpr std::size_t kSectionsAt = 4, kGaussiansAt = 16, kLevelAt = 20, kLeastShAt = 36, kMostShAt = 40;
constexpr int kMaxLevel = 2;

struct RowLayout {
  std::size_t scale, rotation, colour, sh, sh_bytes;  // where they begin; bytes of an SH coefficient
};
constexpr RowLayout kLayouts[] = {{12, 24, 40, 44, 4}, {6, 12, 20, 24, 2}, {6, 12, 20, 24, 1}};

// As the header of a section has it.
struct SectionHeader {
  std::uint32_t gaussians, room, bucket_size, buckets;
  float block_size;
  std::uint16_t bucket_bytes, unused;
  std::uint32_t steps, storage, full_buckets, partly_filled;
  std::uint16_t sh_degree;
};

struct KSection {
  std::size_t first_row = 0, rows = 0, row_bytes = 0;
  int sh_degree = 0;
  const std::byte* data = nullptr;
  const std::byte* centres = nullptr;
  float step = 0;
  float zero = 0;  // the uint16 that stands for a bucket's centre
  std::size_t bucket_size = 1, full_buckets = 0;
  std::vector<std::size_t> partly_filled_end;  // row behind each of the buckets that are not full

  std::size_t bucket_of(std::size_t row) const {
    if (row < full_buckets * bucket_size) return row / bucket_size;
    return full_buckets + static_cast<std::size_t>(std::ranges::upper_bound(partly_filled_end, row) -
                                                   partly_filled_end.begin());
  }
};

struct KRows {
  int level = 0, degree = 0;
  float least_sh = 0, most_sh = 0;
  std::vector<KSection> sections;

  const KSection& section_of(std::size_t* row) const {
    const auto next = std::ranges::upper_bound(sections, *row, {}, &KSection::first_row);
    const KSection& section = *std::prev(next);
    *row -= section.first_row;
    return section;
  }
  float number(const std::byte* at, std::size_t index) const {
    return level == 0 ? load<float>(at + 4 * index) : half_to_float(load<std::uint16_t>(at + 2 * index));
  }
  glm::vec3 scale(const std::byte* row) const {
    const std::byte* at = row + kLayouts[level].scale;
    return {number(at, 0), number(at, 1), number(at, 2)};
  }
  glm::quat rotation(const std::byte* row) const {
    const std::byte* at = row + kLayouts[level].rotation;
    return {number(at, 0), number(at, 1), number(at, 2), number(at, 3)};
  }
  float sh(const std::byte* row, std::size_t index) const {
    const std::byte* at = row + kLayouts[level].sh;
    if (level < 2) return number(at, index);
    return least_sh + byte_at(at + index) / 255.0f * (most_sh - least_sh);
  }
  glm::vec3 centre(const KSection& section, std::size_t index, const std::byte* row) const {
    if (level == 0) return {load<float>(row), load<float>(row + 4), load<float>(row + 8)};
    const std::byte* bucket = section.centres + section.bucket_of(index) * 3 * sizeof(float);
    glm::vec3 p;
    for (int c = 0; c < 3; ++c)
      p[c] = (static_cast<float>(load<std::uint16_t>(row + 2 * c)) - section.zero) * section.step +
             load<float>(bucket + 4 * c);
    return p;
  }
  glm::vec3 position(std::size_t index) const {
    const KSection& section = section_of(&index);
    const std::byte* row = section.data + index * section.row_bytes;
    const glm::vec3 s = scale(row);
    const glm::quat q = rotation(row);
    const float norm_squared = glm::dot(q, q);
    const bool good =
        is_size(s) && norm_squared > 0 && std::isfinite(norm_squared) && sh_is_finite(section, row);
    return good ? centre(section, index, row) : kDroppedRow;
  }
  bool sh_is_finite(const KSection& section, const std::byte* row) const {
    for (std::size_t i = 0; i < 3 * static_cast<std::size_t>(sh_rest_coefficients(section.sh_degree)); ++i)
      if (!std::isfinite(sh(row, i))) return false;
    return true;
  }
  void decode(std::size_t index, GaussianCloud& cloud, std::size_t g) const {
    const KSection& section = section_of(&index);
    const std::byte* row = section.data + index * section.row_bytes;
    const std::byte* colour = row + kLayouts[level].colour;
    cloud.scale[g] = scale(row);
    cloud.rotation[g] = glm::normalize(rotation(row));
    cloud.f_dc[g] =
        f_dc_from_colour(glm::vec3(byte_at(colour), byte_at(colour + 1), byte_at(colour + 2)) / 255.0f);
    cloud.opacity[g] = byte_at(colour + 3) / 255.0f;
    const auto per_channel = static_cast<std::size_t>(sh_rest_coefficients(degree));
    float* rest = cloud.sh_rest.data() + g * cloud.sh_stride();
    std::size_t next = 0;
    for (int d = 1; d <= section.sh_degree; ++d)
      for (std::size_t c = 0; c < 3; ++c)
        for (auto k = static_cast<std::size_t>(sh_rest_coefficients(d - 1));
             k < static_cast<std::size_t>(sh_rest_coefficients(d)); ++k)
          rest[c * per_channel + k] = sh(row, next++);
  }
};

// Takes the next bytes of the file; throws Error where it ends before.
const std::byte* take(const MappedFile& file, std::size_t bytes, std::size_t* at) {
  if (bytes > file.bytes().size() - *at)
    throw Error(file.path().string(),
                incomplete(fmt::format("{} bytes are wanted at byte {}, the file has {}", bytes, *at,
                                       file.bytes().size())));
  const std::byte* begin = file.bytes().data() + *at;
  *at += bytes;
  return begin;
}

// *at: where the section's data begin, then where they end.
KSection read_section(const MappedFile& file, const SectionHeader& header, int level, std::size_t first_row,
                      std::size_t* at) {
  const auto refuse = [&](const char* what) { throw Error(file.path().string(), what); };
  constexpr std::uint32_t kUsualSteps = 32767;
  if (header.sh_degree > 3) refuse("a section has spherical harmonics beyond degree 3");
  if (header.gaussians > header.room) refuse("a section holds more Gaussians than it has room for");
  KSection section;
  section.first_row = first_row;
  section.rows = header.gaussians;
  section.sh_degree = header.sh_degree;
  section.row_bytes =
      kLayouts[level].sh +
      kLayouts[level].sh_bytes * 3 * static_cast<std::size_t>(sh_rest_coefficients(header.sh_degree));
  const std::byte* sizes = take(file, std::size_t{header.partly_filled} * 4, at);
  section.centres = take(file, std::size_t{header.buckets} * header.bucket_bytes, at);
  section.data = take(file, header.room * section.row_bytes, at);
  if (level == 0) return section;
  const std::uint32_t steps = header.steps ? header.steps : kUsualSteps;
  section.zero = static_cast<float>(steps);
  section.step = header.block_size / 2 / section.zero;
  section.bucket_size = std::max(1u, header.bucket_size);
  section.full_buckets = header.full_buckets;
  std::size_t end = section.full_buckets * section.bucket_size;
  for (std::size_t b = 0; b < header.partly_filled; ++b)
    section.partly_filled_end.push_back(end += load<std::uint32_t>(sizes + 4 * b));
  if (header.bucket_bytes != 3 * sizeof(float) ||
      std::size_t{header.full_buckets} + header.partly_filled > header.buckets || end < header.gaussians)
    refuse("the buckets of a section do not hold its Gaussians");
  return section;
}

KRows read_sections(const MappedFile& file, std::size_t* gaussians) {
  std::size_t at = 0;
  const std::byte* header = take(file, kHeaderBytes, &at);
  const int major = std::to_integer<int>(header[0]), minor = std::to_integer<int>(header[1]);
  KRows rows;
  rows.level = load<std::uint16_t>(header + kLevelAt);
  if (major != 0 || minor < 1 || rows.level > kMaxLevel)
    throw Error(file.path().string(), fmt::format("version {}.{} of .ksplat, level {}, is not supported",
                                                  major, minor, rows.level));
  rows.least_sh = load<float>(header + kLeastShAt);
  rows.most_sh = load<float>(header + kMostShAt);
  if (rows.least_sh == 0 && rows.most_sh == 0) rows.least_sh = -1.5f, rows.most_sh = 1.5f;
  const std::size_t sections = load<std::uint32_t>(header + kSectionsAt);
  const std::byte* section_headers = take(file, sections * kSectionHeaderBytes, &at);
  for (std::size_t s = 0; s < sections; ++s) {
    const auto section = load<SectionHeader>(section_headers + s * kSectionHeaderBytes);
    rows.sections.push_back(read_section(file, section, rows.level, *gaussians, &at));
    *gaussians += section.gaussians;
    rows.degree = std::max(rows.degree, rows.sections.back().sh_degree);
  }
  std::erase_if(rows.sections, [](const KSection& section) { return section.rows == 0; });
  if (*gaussians == 0 || *gaussians != load<std::uint32_t>(header + kGaussiansAt))
    throw Error(file.path().string(), fmt::format("{} Gaussians are in its sections, the header promises {}",
                                                  *gaussians, load<std::uint32_t>(header + kGaussiansAt)));
  return rows;
}

void read_ksplat(const MappedFile& file, const LoadOptions&, Scene& scene, const Job& job) {
  std::size_t gaussians = 0;
  const KRows rows = read_sections(file, &gaussians);
  decode_rows(rows, gaussians, rows.degree, scene, job);
}

}  // namespace

constinit const SceneFormat SceneFormat::kKsplat = {
    .name = "ksplat",
    .extension = ".ksplat",
    .read = read_ksplat,
};

}  // namespace splatcut
