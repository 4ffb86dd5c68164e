// Reader of .lcc (XGRIDS, its white paper): a text that says ranges and levels of detail. Beside it stand
//   index.bin        units of the ground plan: x, y (16 bits), then of each level, the finest first: its
//                    Gaussians (32 bits), where they begin in data.bin (64 bits), their bytes (32 bits)
//   data.bin         32 bytes a Gaussian: position 3 float; colour and opacity 4 bytes; scale 3 x 16 bits
//                    between min and max; rotation 3 x 10 bits, -1 to 1 over sqrt(2), and the number of
//                    the largest of x y z w, 2 bits; a normal, 3 x 16 bits
//   shcoef.bin       64 bytes a Gaussian, in the same order: 15 coefficients of 11, 10 and 11 bits between
//                    min and max, and 4 bytes of nothing
//   environment.bin  what lies around, each Gaussian as in data.bin, behind it as in shcoef.bin; may be
//                    missing
// Axes are x right, y forward, z up.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/json_file.h"
#include "core/spoken_list.h"
#include "scene/cloud/quantise.h"
#include "scene/formats/decode.h"
#include "scene/formats/lcc_axes.h"
#include "scene/packing/incomplete.h"

namespace splatcut {

namespace {

using nlohmann::json;
namespace fs = std::filesystem;

constexpr std::size_t kLccRow = 32, kLccShRow = 64;

[[noreturn]] void refuse_lcc(const fs::path& path, const std::string& what) {
  throw Error(path.string(), what, "Export it again, or as .ply, from the program that made it");
}

// Of three channels or axes.
struct LccRange {
  glm::vec3 least{0}, most{0};
  glm::vec3 at(const glm::vec3& fraction) const { return least + (most - least) * fraction; }
};

struct LccMeta {
  std::size_t levels = 0;
  bool harmonics = false;
  LccRange scale, sh, far_scale, far_sh;  // far: of the environment
};

LccRange range_of(const fs::path& path, const json& attribute) {
  LccRange range;
  for (auto [key, to] : {std::pair{"min", &range.least}, {"max", &range.most}})
    for (int i = 0; i < 3; ++i) (*to)[i] = attribute.at(key).at(static_cast<std::size_t>(i)).get<float>();
  constexpr float kMost = 1e15f;
  for (const glm::vec3& bound : {range.least, range.most})
    if (!(std::max({std::abs(bound.x), std::abs(bound.y), std::abs(bound.z)}) <= kMost))
      refuse_lcc(path, fmt::format("the range of an attribute goes beyond {:g}", kMost));
  return range;
}

LccMeta meta_of(const MappedFile& file) {
  const json text = parse_json(file.path(), file.text());
  const auto attribute = [&](const char* name) -> const json* {
    for (const json& each : text.at("attributes"))
      if (each.at("name") == name) return &each;
    return nullptr;
  };
  const auto range = [&](const char* name, const LccRange& otherwise) {
    const json* found = attribute(name);
    return found ? range_of(file.path(), *found) : otherwise;
  };
  LccMeta meta;
  const json& levels = text.at("totalLevel");
  if (!levels.is_number_unsigned() || levels == 0u || levels > SceneLevels::kMost)
    refuse_lcc(file.path(),
               fmt::format("its number of levels is {}, not 1 to {}", json_text(levels), SceneLevels::kMost));
  meta.levels = levels.get<std::size_t>();
  const json* scale = attribute("scale");
  if (!scale) refuse_lcc(file.path(), "has no range of scales");
  meta.scale = range_of(file.path(), *scale);
  const std::string type = text.value("fileType", "");
  meta.harmonics = type == "Quality" || (type != "Portable" && attribute("shcoef"));
  if (meta.harmonics && !attribute("shcoef")) refuse_lcc(file.path(), "has no range of spherical harmonics");
  meta.sh = range("shcoef", {});
  meta.far_scale = range("envscale", meta.scale);
  meta.far_sh = range("envshcoef", meta.sh);
  return meta;
}

// Gaussians that lie one behind the other, never none.
struct LccPart {
  const std::byte *rows = nullptr, *sh = nullptr;  // sh: null for none
  std::size_t row_bytes = kLccRow, sh_bytes = kLccShRow;
  std::size_t count = 0, first_row = 0;
  const LccRange *scale = nullptr, *sh_range = nullptr;
};

glm::quat lcc_rotation(std::uint32_t bits) {
  constexpr float kRoot = 1.41421356f;
  const auto largest = bits >> 30;
  std::array<float, 4> xyzw{};
  float sum = 0;
  std::uint32_t next = 0;
  for (std::uint32_t i = 0; i < 4; ++i) {
    if (i == largest) continue;
    xyzw[i] = (from_steps(bits >> (10 * next++), 10) * 2 - 1) / kRoot;
    sum += xyzw[i] * xyzw[i];
  }
  xyzw[largest] = std::sqrt(std::max(0.0f, 1 - sum));
  return glm::normalize(glm::quat(xyzw[3], xyzw[0], xyzw[1], xyzw[2]));
}

// A source of decode_rows().
struct LccRows {
  std::vector<LccPart> parts;  // by first_row
  std::size_t count = 0;
  ShTurn turn{glm::mat3_cast(kLccUpright)};

  void add(LccPart part) {
    if (part.count == 0) return;
    part.first_row = count;
    count += part.count;
    parts.push_back(part);
  }
  const LccPart& part_of(std::size_t* row) const {
    const LccPart& part = *std::prev(std::ranges::upper_bound(parts, *row, {}, &LccPart::first_row));
    *row -= part.first_row;
    return part;
  }
  static glm::vec3 scale(const LccPart& part, const std::byte* row) {
    const auto step = [&](std::size_t i) { return from_steps(load<std::uint16_t>(row + 16 + 2 * i), 16); };
    return part.scale->at({step(0), step(1), step(2)});
  }
  glm::vec3 position(std::size_t row) const {
    const LccPart& part = part_of(&row);
    const std::byte* at = part.rows + row * part.row_bytes;
    if (!is_size(scale(part, at))) return kDroppedRow;
    return lcc_turned({load<float>(at), load<float>(at + 4), load<float>(at + 8)});
  }
  void decode(std::size_t row, GaussianCloud& cloud, std::size_t g) const {
    const LccPart& part = part_of(&row);
    const std::byte* at = part.rows + row * part.row_bytes;
    cloud.scale[g] = scale(part, at);
    cloud.rotation[g] = glm::normalize(kLccUpright * lcc_rotation(load<std::uint32_t>(at + 22)));
    cloud.f_dc[g] =
        f_dc_from_colour(glm::vec3(byte_at(at + 12), byte_at(at + 13), byte_at(at + 14)) / 255.0f);
    cloud.opacity[g] = byte_at(at + 15) / 255.0f;
    if (!part.sh) return;
    const std::span<float> rest = std::span(cloud.sh_rest).subspan(g * cloud.sh_stride(), cloud.sh_stride());
    for (std::size_t k = 0; k < 15; ++k) {
      const auto bits = load<std::uint32_t>(part.sh + row * part.sh_bytes + 4 * k);
      const glm::vec3 value =
          part.sh_range->at({from_steps(bits, 11), from_steps(bits >> 11, 10), from_steps(bits >> 21, 11)});
      for (std::size_t c = 0; c < 3; ++c) rest[15 * c + k] = value[static_cast<int>(c)];
    }
    turn.apply(rest, 3);
  }
};

// The files beside the text.
struct LccFiles {
  std::unique_ptr<MappedFile> index, data, sh, environment;  // the last two: null for none
};

// One that may be missing may be empty, too.
std::unique_ptr<MappedFile> beside(const MappedFile& file, const char* name, bool may_be_missing,
                                   Scene* scene) {
  const fs::path path = file.path().parent_path() / name;
  std::error_code ignored;
  if (fs::status(path, ignored).type() == fs::file_type::not_found) {
    if (may_be_missing) return nullptr;
    throw Error(file.path().string(), fmt::format("{} is missing beside it", name), "Copy the whole folder");
  }
  scene->files.push_back(path);
  if (may_be_missing && fs::file_size(path, ignored) == 0) {
    add_sentence(fmt::format("{} beside it is empty", name), &scene->oddity);
    return nullptr;
  }
  return std::make_unique<MappedFile>(path);
}

void add_units(const LccFiles& files, const LccMeta& meta, std::size_t level, LccRows* rows) {
  const std::span<const std::byte> index = files.index->bytes();
  const std::size_t unit_bytes = 4 + 16 * meta.levels;
  if (index.size() % unit_bytes != 0)
    refuse_lcc(files.index->path(), fmt::format("its {} bytes are no whole number of units of {} levels",
                                                index.size(), meta.levels));
  const std::uint64_t bytes = files.data->bytes().size();
  for (std::size_t at = 4 + 16 * level; at < index.size(); at += unit_bytes) {
    const auto count = load<std::uint32_t>(index.data() + at);
    const auto begin = load<std::uint64_t>(index.data() + at + 4);
    if (begin % kLccRow != 0 || begin > bytes || count > (bytes - begin) / kLccRow)
      refuse_lcc(
          files.index->path(),
          fmt::format("a unit has {} Gaussians from byte {} of data.bin, which has {}", count, begin, bytes));
    if (files.sh && 2 * begin + std::uint64_t{count} * kLccShRow > files.sh->bytes().size())
      refuse_lcc(files.sh->path(), incomplete("a unit's spherical harmonics lie beyond its end"));
    rows->add({.rows = files.data->bytes().data() + begin,
               .sh = files.sh ? files.sh->bytes().data() + 2 * begin : nullptr,
               .count = count,
               .scale = &meta.scale,
               .sh_range = &meta.sh});
  }
}

void add_environment(const MappedFile& file, const LccMeta& meta, LccRows* rows) {
  const std::size_t row_bytes = meta.harmonics ? kLccRow + kLccShRow : kLccRow, size = file.bytes().size();
  if (size % row_bytes != 0)
    refuse_lcc(file.path(),
               incomplete(fmt::format("its {} bytes are no whole number of {}", size, row_bytes)));
  const std::byte* data = file.bytes().data();
  rows->add({.rows = data,
             .sh = meta.harmonics ? data + kLccRow : nullptr,
             .row_bytes = row_bytes,
             .sh_bytes = row_bytes,
             .count = size / row_bytes,
             .scale = &meta.far_scale,
             .sh_range = &meta.far_sh});
}

void read_lcc_parts(const MappedFile& file, const LoadOptions& options, Scene& scene, const Job& job) {
  const LccMeta meta = meta_of(file);
  const std::size_t level = std::min<std::size_t>(options.lod, meta.levels - 1);
  const LccFiles files{beside(file, "index.bin", false, &scene), beside(file, "data.bin", false, &scene),
                       meta.harmonics ? beside(file, "shcoef.bin", false, &scene) : nullptr,
                       beside(file, "environment.bin", true, &scene)};
  LccRows rows;
  add_units(files, meta, level, &rows);
  if (files.environment) add_environment(*files.environment, meta, &rows);
  if (rows.count == 0)
    refuse_lcc(file.path(), fmt::format("its level of detail {} holds no Gaussians", level));
  if (rows.count > std::numeric_limits<std::uint32_t>::max())
    refuse_lcc(file.path(), fmt::format("promises {} Gaussians", rows.count));
  std::uint64_t bytes = 0;
  for (const auto* each : {&files.index, &files.data, &files.sh, &files.environment})
    if (*each) bytes += (*each)->bytes().size();
  const int degree = meta.harmonics ? 3 : 0;
  check_cloud_size(file.path(), bytes, rows.count, degree);
  if (meta.levels > 1) scene.left_out = level_read(meta.levels, level);
  decode_rows(rows, rows.count, degree, scene, job);
}

template <class Read>
auto of_lcc(const MappedFile& file, const Read& read) {
  try {
    return read();
  } catch (const json::exception& error) {
    refuse_lcc(file.path(), fmt::format("is not the text of an .lcc ({})", fault_of(error)));
  }
}

void read_lcc(const MappedFile& file, const LoadOptions& options, Scene& scene, const Job& job) {
  of_lcc(file, [&] { read_lcc_parts(file, options, scene, job); });
}

SceneLevels levels_of_lcc(const MappedFile& file) {
  return of_lcc(file, [&] {
    const LccMeta meta = meta_of(file);
    SceneLevels levels{std::vector<std::uint64_t>(meta.levels), meta.harmonics ? 3 : 0};
    Scene ignored;
    const std::unique_ptr<MappedFile> index = beside(file, "index.bin", false, &ignored);
    const std::size_t unit_bytes = 4 + 16 * meta.levels;
    for (std::size_t unit = 0; unit + unit_bytes <= index->bytes().size(); unit += unit_bytes)
      for (std::size_t level = 0; level < meta.levels; ++level)
        levels.gaussians[level] += load<std::uint32_t>(index->bytes().data() + unit + 4 + 16 * level);
    return levels;
  });
}

}  // namespace

constinit const SceneFormat SceneFormat::kLcc = {
    .name = "lcc",
    .extension = ".lcc",
    .levels = levels_of_lcc,
    .read = read_lcc,
};

}  // namespace splatcut
