// Reader of .rad, the format of Spark.
//
// The file: the mark "RAD0", the length of a JSON text (32 bits), the text, zeros up to a multiple of 8, then
// chunks. The text says `count` (Gaussians of all levels of detail), `maxSh`, and for each chunk where it
// begins after the text, or the name of a file beside this one (.radc) that holds it. A chunk: the mark
// "RADC", its own text in the same way, the length of its data (64 bits), and the data: properties, each
// beginning at a multiple of 8 and packed by deflate. A property stores all values of its first component,
// then all of the second, and so on; rad_values.h says which there are. Positions have the axes of the scene
// that the file was made of; they are read as those of a .ply.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/json_file.h"
#include "scene/cloud/quantise.h"
#include "scene/formats/decode.h"
#include "scene/formats/pieces.h"
#include "scene/formats/rad_values.h"
#include "scene/packing/incomplete.h"

namespace splatcut {

namespace {

using namespace rad;
using nlohmann::json;
namespace fs = std::filesystem;

struct RadChunk {
  std::size_t first = 0, count = 0;
  std::array<RadValues, kRadFields> fields;
};

// A source of decode_rows(): the Gaussians of one level of detail.
struct RadRows {
  std::vector<RadChunk> chunks;
  std::vector<std::uint32_t> taken;  // of all Gaussians; empty: all
  std::size_t count = 0;
  int degree = 0;

  const RadChunk& chunk_of(std::size_t* row) const {
    if (!taken.empty()) *row = taken[*row];
    const RadChunk& chunk = *std::prev(std::ranges::upper_bound(chunks, *row, {}, &RadChunk::first));
    *row -= chunk.first;
    return chunk;
  }
  static glm::vec3 vec3(const RadValues& values, std::size_t i) {
    return {values.at(i, 0), values.at(i, 1), values.at(i, 2)};
  }
  glm::vec3 position(std::size_t row) const {
    const RadChunk& chunk = chunk_of(&row);
    const std::array<float, 4> q = rad_rotation(chunk.fields[kOrientation], row);
    bool good = is_finite(vec3(chunk.fields[kRgb], row)) && is_size(vec3(chunk.fields[kScales], row)) &&
                std::isfinite(q[0] + q[1] + q[2] + q[3]) && !std::isnan(chunk.fields[kAlpha].at(row, 0));
    for (int band = 1; band <= degree; ++band) {
      const RadValues& sh = chunk.fields[kSh1 + static_cast<std::size_t>(band) - 1];
      for (std::size_t c = 0; good && c < sh.components; ++c) good = std::isfinite(sh.at(row, c));
    }
    return good ? vec3(chunk.fields[kCentre], row) : kDroppedRow;
  }
  void decode(std::size_t row, GaussianCloud& cloud, std::size_t g) const {
    const RadChunk& chunk = chunk_of(&row);
    cloud.f_dc[g] = f_dc_from_colour(vec3(chunk.fields[kRgb], row));
    cloud.opacity[g] = std::clamp(chunk.fields[kAlpha].at(row, 0), 0.0f, 1.0f);
    cloud.scale[g] = vec3(chunk.fields[kScales], row);
    const std::array<float, 4> q = rad_rotation(chunk.fields[kOrientation], row);
    cloud.rotation[g] = glm::normalize(glm::quat(q[3], q[0], q[1], q[2]));
    float* rest = cloud.sh_rest.data() + g * cloud.sh_stride();
    const std::size_t all = cloud.sh_stride() / 3;
    std::size_t k = 0;
    for (int band = 1; band <= degree; ++band) {
      const RadValues& sh = chunk.fields[kSh1 + static_cast<std::size_t>(band) - 1];
      for (std::size_t c = 0; c < sh.components; ++c) rest[c % 3 * all + k + c / 3] = sh.at(row, c);
      k += sh.components / 3;
    }
  }
};

// Reads bytes of a file from front to back.
class RadBytes {
 public:
  RadBytes(const fs::path& path, std::span<const std::byte> bytes) : path_(path), left_(bytes) {}

  std::span<const std::byte> take(std::uint64_t count) {
    if (count > left_.size())
      refuse_rad(path_,
                 incomplete(fmt::format("{} bytes are wanted where {} are left", count, left_.size())));
    const auto taken = left_.first(count);
    left_ = left_.subspan(count);
    return taken;
  }
  // Reads a text that follows a mark of four letters.
  json text(std::string_view mark) {
    const auto head = take(8);
    if (std::string_view(reinterpret_cast<const char*>(head.data()), 4) != mark)
      refuse_rad(path_, fmt::format("the mark \"{}\" is missing", mark));
    const auto bytes = take(load<std::uint32_t>(head.data() + 4));
    take(std::min<std::size_t>((8 - bytes.size() % 8) % 8, left_.size()));
    return parse_json(path_, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
  }
  std::span<const std::byte> left() const { return left_; }

 private:
  const fs::path& path_;
  std::span<const std::byte> left_;
};

Bytes unpacked_values(const fs::path& path, const json& said, std::span<const std::byte> packed,
                      std::size_t wanted, const Job& job) {
  const json packing = said.value("compression", json());
  if (packing == "gz") return GzipReader(path, packed, -MAX_WBITS).read(wanted, job);
  if (!packing.is_null()) refuse_rad(path, fmt::format("the packing {} is not read", json_text(packing)));
  if (packed.size() < wanted)
    refuse_rad(path, incomplete(fmt::format("{} has {} of {} bytes", json_text(said.at("property")),
                                            packed.size(), wanted)));
  return {packed.begin(), packed.begin() + static_cast<std::ptrdiff_t>(wanted)};
}

// Opened file: its text, its chunks, and a limit on how much they may unpack to.
class RadFile {
 public:
  explicit RadFile(const MappedFile& file) : file_(file), bytes_(file.path(), file.bytes()) {
    meta_ = bytes_.text("RAD0");
    if (meta_.at("version") != 1 || meta_.value("type", "gsplat") != "gsplat")
      refuse_rad(file.path(),
                 fmt::format("its version is {}, and its type {}; 1 and \"gsplat\" are read",
                             json_text(meta_.at("version")), json_text(meta_.value("type", json()))));
    count_ = whole_number(meta_.at("count"));
    if (count_ == 0 || count_ > std::numeric_limits<std::uint32_t>::max())
      refuse_rad(file.path(), fmt::format("promises {} Gaussians", count_));
    packed_ = file.bytes().size();
  }
  std::size_t count() const { return count_; }
  int said_degree() const {
    return static_cast<int>(std::min<std::size_t>(3, whole_number(meta_.value("maxSh", json(0)))));
  }
  // Reads all chunks. only_tree: reads their tree alone. If cancelled, the list is incomplete.
  std::vector<RadChunk> chunks(bool only_tree, const Job& job);
  const std::vector<fs::path>& others() const { return others_; }  // files of chunks
  std::uint64_t packed() const { return packed_; }                 // bytes of all files

 private:
  RadChunk chunk(const fs::path& path, std::span<const std::byte> bytes, std::size_t first, bool only_tree,
                 const Job& job);
  RadValues values(const fs::path& path, const json& said, RadField field, std::size_t count,
                   std::span<const std::byte> payload, const Job& job);

  const MappedFile& file_;
  RadBytes bytes_;
  json meta_;
  std::size_t count_ = 0;
  std::uint64_t packed_ = 0, unpacked_ = 0;
  std::vector<fs::path> others_;
};

std::vector<RadChunk> RadFile::chunks(bool only_tree, const Job& job) {
  std::vector<RadChunk> all;
  std::size_t first = 0;
  std::set<fs::path> seen;  // a file that many chunks name counts once
  const json& list = meta_.at("chunks");
  for (const json& said : list) {
    job.progress("unpacking", static_cast<double>(all.size()) / static_cast<double>(list.size()));
    const std::size_t offset = whole_number(said.at("offset")), size = whole_number(said.at("bytes"));
    std::unique_ptr<MappedFile> beside;
    std::span<const std::byte> from = bytes_.left();
    if (said.contains("filename")) {
      const fs::path name = path_in_folder(file_, said.at("filename").get<std::string>());
      beside = std::make_unique<MappedFile>(file_.path().parent_path() / name);
      from = beside->bytes();
      if (seen.insert(beside->path()).second) {
        others_.push_back(beside->path());
        packed_ += from.size();
      }
    }
    const fs::path& path = beside ? beside->path() : file_.path();
    if (offset > from.size() || size > from.size() - offset)
      refuse_rad(path, incomplete(fmt::format("a chunk has {} bytes from byte {} on", size, offset)));
    all.push_back(chunk(path, from.subspan(offset, size), first, only_tree, job));
    if (job.cancelled()) return all;
    first += all.back().count;
  }
  if (first != count_)
    refuse_rad(file_.path(), fmt::format("its chunks hold {} Gaussians, not {}", first, count_));
  return all;
}

RadChunk RadFile::chunk(const fs::path& path, std::span<const std::byte> bytes, std::size_t first,
                        bool only_tree, const Job& job) {
  RadBytes in(path, bytes);
  const json text = in.text("RADC");
  RadChunk chunk;
  chunk.first = first;
  chunk.count = whole_number(text.at("count"));
  if (text.at("version") != 1 || whole_number(text.at("base")) != first || chunk.count == 0 ||
      chunk.count > count_ - first)
    refuse_rad(path, fmt::format("a chunk does not hold the Gaussians from {} on, of {}", first, count_));
  const auto payload = in.take(load<std::uint64_t>(in.take(8).data()));
  for (const json& said : text.at("properties")) {
    const auto known = std::ranges::find(kRadNames, said.at("property").get<std::string>(),
                                         [](const RadFieldName& f) { return std::string(f.name); });
    if (known == kRadNames.end()) {
      if (said.at("property") == "sh_label")
        refuse_rad(path, "its spherical harmonics are shared (sh_label), which is not read");
      continue;
    }
    const auto field = static_cast<RadField>(known - kRadNames.begin());
    if (only_tree && field != kChildren && field != kFirstChild) continue;
    chunk.fields[field] = values(path, said, field, chunk.count, payload, job);
  }
  for (std::size_t f = 0; f < kRadFields && !only_tree; ++f)
    if (kRadNames[f].needed && chunk.fields[f].bytes.empty())
      refuse_rad(path, fmt::format("a chunk has no property \"{}\"", kRadNames[f].name));
  return chunk;
}

RadValues RadFile::values(const fs::path& path, const json& said, RadField field, std::size_t count,
                          std::span<const std::byte> payload, const Job& job) {
  const RadFieldName& name = kRadNames[field];
  const RadEncodingName& encoding = encoding_of(path, said, name);
  RadValues values;
  values.encoding = encoding.encoding;
  values.count = count;
  values.components = name.components;
  values.most = said.value("max", 1.0f);
  values.least = said.value("min", 0.0f);
  const std::size_t offset = whole_number(said.at("offset")), size = whole_number(said.at("bytes"));
  if (offset > payload.size() || size > payload.size() - offset)
    refuse_rad(path, incomplete(fmt::format("\"{}\" has {} bytes from byte {} on", name.name, size, offset)));
  const std::size_t wanted = encoding.bytes * name.components * count;
  unpacked_ += wanted;
  check_expansion(file_.path(), packed_, unpacked_);
  values.bytes = unpacked_values(path, said, payload.subspan(offset, size), wanted, job);
  if (encoding.differences && !job.cancelled()) sum_differences(count, &values.bytes);
  return values;
}

constexpr std::uint8_t kUnreached = 255;

// Number of steps from the root, the first Gaussian, to each Gaussian. Empty if there is no tree.
std::vector<std::uint8_t> rad_depths(const fs::path& path, const std::vector<RadChunk>& chunks,
                                     std::size_t count) {
  if (std::ranges::any_of(chunks, [](const RadChunk& c) {
        return c.fields[kChildren].bytes.empty() || c.fields[kFirstChild].bytes.empty();
      }))
    return {};
  std::vector<std::uint8_t> depths(count, kUnreached);
  std::vector<std::uint32_t> reached = {0};
  reached.reserve(count);
  depths[0] = 0;
  for (std::size_t i = 0; i < reached.size(); ++i) {
    const std::size_t node = reached[i];
    const RadChunk& chunk = *std::prev(std::ranges::upper_bound(chunks, node, {}, &RadChunk::first));
    const std::uint64_t children = chunk.fields[kChildren].whole(node - chunk.first),
                        begin = chunk.fields[kFirstChild].whole(node - chunk.first);
    if (children == 0) continue;
    if (begin + children > count || depths[node] + 1 >= kUnreached)
      refuse_rad(path,
                 fmt::format("Gaussian {} has {} children from {} on, of {}", node, children, begin, count));
    for (std::uint64_t child = begin; child < begin + children; ++child) {
      if (depths[child] != kUnreached)
        refuse_rad(path, fmt::format("Gaussian {} is reached twice in its tree", child));
      depths[child] = static_cast<std::uint8_t>(depths[node] + 1);
      reached.push_back(static_cast<std::uint32_t>(child));
    }
  }
  return depths;
}

bool has_children(const std::vector<RadChunk>& chunks, std::size_t node) {
  const RadChunk& chunk = *std::prev(std::ranges::upper_bound(chunks, node, {}, &RadChunk::first));
  return chunk.fields[kChildren].whole(node - chunk.first) > 0;
}

// Gaussians of a level of detail. Level 0 is the leaves. Level N is the Gaussians N steps above the deepest
// leaf, and the leaves above those.
std::vector<std::uint32_t> rad_level(const std::vector<RadChunk>& chunks,
                                     const std::vector<std::uint8_t>& depths, unsigned deepest,
                                     unsigned level) {
  const unsigned depth = deepest - std::min(level, deepest);
  std::vector<std::uint32_t> taken;
  for (std::size_t node = 0; node < depths.size(); ++node)
    if (depths[node] == depth || (depths[node] < depth && !has_children(chunks, node)))
      taken.push_back(static_cast<std::uint32_t>(node));
  return taken;
}

unsigned deepest_of(const std::vector<std::uint8_t>& depths) {
  unsigned deepest = 0;
  for (const std::uint8_t depth : depths)
    if (depth != kUnreached) deepest = std::max<unsigned>(deepest, depth);
  return deepest;
}

template <class Read>
auto of_rad(const MappedFile& file, const Read& read) {
  try {
    RadFile rad(file);
    return read(rad);
  } catch (const json::exception& error) {
    refuse_rad(file.path(), fmt::format("its text is not that of a .rad ({})", fault_of(error)));
  }
}

int degree_of(const std::vector<RadChunk>& chunks) {
  int degree = 3;
  for (const RadChunk& chunk : chunks)
    for (int band = degree; band >= 1; --band)
      if (chunk.fields[kSh1 + static_cast<std::size_t>(band) - 1].bytes.empty()) degree = band - 1;
  return degree;
}

void read_rad(const MappedFile& file, const LoadOptions& options, Scene& scene, const Job& job) {
  of_rad(file, [&](RadFile& rad) {
    RadRows rows;
    rows.chunks = rad.chunks(false, job);
    if (job.cancelled()) return;
    rows.count = rad.count();
    rows.degree = degree_of(rows.chunks);
    const std::vector<std::uint8_t> depths = rad_depths(file.path(), rows.chunks, rows.count);
    if (const unsigned deepest = deepest_of(depths); deepest > 0) {
      const unsigned level = std::min(options.lod, deepest);
      rows.taken = rad_level(rows.chunks, depths, deepest, level);
      rows.count = rows.taken.size();
      scene.left_out = level_read(deepest + 1, level);
      if (const auto lost = std::ranges::count(depths, kUnreached); lost > 0)
        scene.left_out += fmt::format("; {} Gaussians that its tree does not reach are left out", lost);
      if (level > 0) scene.left_out += "; opacities of merged Gaussians above 1 are read as 1";
    }
    check_cloud_size(file.path(), rad.packed(), rows.count, rows.degree);
    scene.files.insert(scene.files.end(), rad.others().begin(), rad.others().end());
    decode_rows(rows, rows.count, rows.degree, scene, job);
  });
}

SceneLevels levels_of_rad(const MappedFile& file) {
  return of_rad(file, [&](RadFile& rad) {
    const std::vector<RadChunk> chunks = rad.chunks(true, {});
    const std::vector<std::uint8_t> depths = rad_depths(file.path(), chunks, rad.count());
    const unsigned deepest = deepest_of(depths);
    SceneLevels levels{{}, rad.said_degree()};
    for (unsigned level = 0; deepest > 0 && level <= deepest; ++level)
      levels.gaussians.push_back(rad_level(chunks, depths, deepest, level).size());
    return levels;
  });
}

bool is_rad(const MappedFile& file) {
  return begins_with(file, "RAD0");
}

}  // namespace

constinit const SceneFormat SceneFormat::kRad = {
    .name = "rad",
    .extension = ".rad",
    .recognises = is_rad,
    .levels = levels_of_rad,
    .read = read_rad,
};

}  // namespace splatcut
