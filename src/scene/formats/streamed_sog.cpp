// Reader of streamed .sog (PlayCanvas): several .sog, the pieces, and lod-meta.json, a tree whose leaves say
// which Gaussians of which piece they show at which level of detail; 0 is the finest. Taken are the Gaussians
// of each leaf's finest level, leaf by leaf, then those of the environment, a piece that no leaf names.
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <limits>
#include <map>
#include <optional>
#include <string>

#include "core/error.h"
#include "core/json_file.h"
#include "scene/formats/decode.h"
#include "scene/formats/sog_rows.h"

namespace splatcut {

namespace {

using nlohmann::json;
namespace fs = std::filesystem;

constexpr std::size_t kMostStreamed = std::numeric_limits<std::uint32_t>::max();

[[noreturn]] void refuse_index(const MappedFile& file, const std::string& what) {
  throw Error(file.path().string(), what, "Write it again with the program that made it");
}

// Gaussians of a piece, never none.
struct LodRange {
  std::size_t piece = 0, offset = 0, count = 0, first_row = 0;
};

// A name in the index as a path in its folder, the same for all spellings.
fs::path path_in_folder(const MappedFile& file, const std::string& name) {
  const fs::path path = fs::path(name).lexically_normal();
  const bool inside =
      !path.is_absolute() && !path.empty() && *path.begin() != ".." && name.find('\0') == std::string::npos;
  if (!inside)
    refuse_index(file, fmt::format("names the piece {}, which is not in its folder", json_text(name)));
  return path;
}

std::size_t whole_number(const MappedFile& file, const json& object, const char* key) {
  const json& value = object.at(key);
  if (!value.is_number_unsigned() || value.get<std::uint64_t>() > kMostStreamed)
    refuse_index(file, fmt::format("the {} of a leaf is {}, not a whole number up to {}", key,
                                   value.is_number() ? json_text(value) : value.type_name(), kMostStreamed));
  return value.get<std::size_t>();
}

unsigned level_of(const MappedFile& file, const std::string& key) {
  unsigned level = 0;
  const char* end = key.data() + key.size();
  const auto [at, failure] = std::from_chars(key.data(), end, level);
  if (failure != std::errc() || at != end)
    refuse_index(file, fmt::format("a leaf has the level of detail {}, which is no number", json_text(key)));
  return level;
}

// What lod-meta.json says, as far as it is taken.
class LodIndex {
 public:
  LodIndex(const MappedFile& file, unsigned lod);

  std::vector<fs::path> pieces;  // in the folder of the index, each once
  std::vector<LodRange> ranges;  // in the order of leaves
  std::optional<fs::path> environment;
  bool others = false;  // there are levels that are not taken

 private:
  void collect(const json& node, const json& names, int depth);
  void add_leaf(const json& lods, const json& names);
  std::size_t piece_of(const json& names, std::size_t index);
  void check_overlaps() const;

  const MappedFile& file_;
  unsigned lod_;
  std::map<fs::path, std::size_t> numbers_;  // of pieces
};

LodIndex::LodIndex(const MappedFile& file, unsigned lod) : file_(file), lod_(lod) {
  const json index =
      parse_json(file.path(), {reinterpret_cast<const char*>(file.bytes().data()), file.bytes().size()});
  if (const json version = index.value("version", json(1)); version != 1)
    throw Error(file.path().string(),
                fmt::format("version {} of a streamed scene is not supported",
                            version.is_number() ? json_text(version) : version.type_name()));
  collect(index.at("tree"), index.at("filenames"), 0);
  check_overlaps();
  if (!index.contains("environment") || index.at("environment").is_null()) return;
  environment = path_in_folder(file, index.at("environment").get<std::string>());
  if (numbers_.contains(*environment)) refuse_index(file, "its environment is also a piece of its tree");
}

void LodIndex::collect(const json& node, const json& names, int depth) {
  constexpr int kDeepest = 1000;
  if (depth > kDeepest) refuse_index(file_, fmt::format("its tree is deeper than {} nodes", kDeepest));
  if (!node.is_object()) refuse_index(file_, fmt::format("a node of its tree is {}", node.type_name()));
  const auto list = node.find("children"), lods = node.find("lods");
  const bool inner = list != node.end() && !list->empty(), leaf = lods != node.end() && !lods->empty();
  if (inner && leaf) refuse_index(file_, "a node of its tree has both children and levels of detail");
  if (inner && !list->is_array()) refuse_index(file_, "the children of a node of its tree are no list");
  if (leaf && !lods->is_object()) refuse_index(file_, "the levels of detail of a leaf have no numbers");
  if (leaf) add_leaf(*lods, names);
  if (!inner) return;
  for (const json& child : *list) collect(child, names, depth + 1);
}

void LodIndex::add_leaf(const json& lods, const json& names) {
  const json* taken = nullptr;
  unsigned taken_level = 0;
  std::size_t levels = 0;
  for (const auto& [key, lod] : lods.items()) {
    const unsigned level = level_of(file_, key);
    if (whole_number(file_, lod, "count") == 0) continue;
    ++levels;
    // The finest of those that are no finer than wanted, else the coarsest.
    const bool better = !taken || (level >= lod_ ? taken_level < lod_ || level < taken_level
                                                 : taken_level < lod_ && level > taken_level);
    if (!better) continue;
    taken = &lod;
    taken_level = level;
  }
  if (!taken) return;
  others = others || levels > 1;
  ranges.push_back({piece_of(names, whole_number(file_, *taken, "file")),
                    whole_number(file_, *taken, "offset"), whole_number(file_, *taken, "count")});
}

std::size_t LodIndex::piece_of(const json& names, std::size_t index) {
  if (index >= names.size())
    refuse_index(file_, fmt::format("a leaf is in piece {}, counted from 0, of {}", index, names.size()));
  const fs::path path = path_in_folder(file_, names.at(index).get<std::string>());
  const auto [at, is_new] = numbers_.emplace(path, pieces.size());
  if (is_new) pieces.push_back(path);
  return at->second;
}

// Each Gaussian once: so few bytes cannot stand for many.
void LodIndex::check_overlaps() const {
  std::vector<LodRange> sorted = ranges;
  std::ranges::sort(sorted, [](const LodRange& a, const LodRange& b) {
    return a.piece != b.piece ? a.piece < b.piece : a.offset < b.offset;
  });
  const auto twice = std::ranges::adjacent_find(sorted, [](const LodRange& a, const LodRange& b) {
    return a.piece == b.piece && b.offset < a.offset + a.count;
  });
  if (twice != sorted.end())
    refuse_index(file_,
                 fmt::format("two leaves show the same Gaussians of {}", pieces[twice->piece].string()));
}

// A source of decode_rows().
struct StreamedRows {
  std::vector<SogRows> pieces;
  std::vector<LodRange> ranges;  // by first_row
  std::size_t count = 0;
  int degree = 0;  // the highest of the pieces

  const SogRows& piece_of_row(std::size_t* row) const {
    const LodRange& range = *std::prev(std::ranges::upper_bound(ranges, *row, {}, &LodRange::first_row));
    *row = range.offset + *row - range.first_row;
    return pieces[range.piece];
  }
  glm::vec3 position(std::size_t row) const {
    const SogRows& piece = piece_of_row(&row);
    return piece.position(row);
  }
  void decode(std::size_t row, GaussianCloud& cloud, std::size_t g) const {
    const SogRows& piece = piece_of_row(&row);
    piece.decode(row, cloud, g);
  }
};

// Checked after each piece against all files read so far: many names must not take what one may not.
class StreamedBounds {
 public:
  explicit StreamedBounds(const MappedFile& file) : path_(file.path()) {
    files_[path_] = packed_ = file.bytes().size();
  }
  void add(const SogRows& piece) {
    for (const auto& [path, bytes] : piece.packed)
      if (files_.emplace(path, bytes).second) packed_ += bytes;
    unpacked_ += piece.unpacked_bytes();
    check_expansion(path_, packed_, unpacked_);
  }
  // Also where a piece without spherical harmonics takes those of another.
  void check_cloud(const StreamedRows& rows) const {
    check_cloud_size(path_, packed_, rows.count, rows.degree);
  }

 private:
  fs::path path_;
  std::map<fs::path, std::uint64_t> files_;
  std::uint64_t packed_ = 0, unpacked_ = 0;
};

SogRows read_piece(const MappedFile& index, const fs::path& name, const Job& job) {
  const fs::path path = index.path().parent_path() / name;
  std::error_code ignored;
  if (fs::status(path, ignored).type() == fs::file_type::not_found)
    throw Error(index.path().string(), fmt::format("its piece {} is missing", name.string()),
                "Copy the whole folder, with all folders in it");
  const MappedFile file(path);
  return read_sog_rows(file, job);
}

void number_rows(const MappedFile& file, const LodIndex& index, StreamedRows* rows) {
  for (LodRange& range : rows->ranges) {
    const std::size_t all = rows->pieces[range.piece].count;
    if (range.offset + range.count > all)
      refuse_index(file, fmt::format("a leaf shows the Gaussians {} to {} of {}, which has {}", range.offset,
                                     range.offset + range.count, index.pieces[range.piece].string(), all));
    range.first_row = rows->count;
    rows->count += range.count;
  }
  if (rows->count > kMostStreamed) refuse_index(file, fmt::format("promises {} Gaussians", rows->count));
}

// Incomplete when cancelled.
StreamedRows rows_of_pieces(const MappedFile& file, LodIndex index, const Job& job) {
  StreamedRows rows;
  rows.ranges = std::move(index.ranges);
  if (index.environment) index.pieces.push_back(*index.environment);
  StreamedBounds bounds(file);
  for (const fs::path& name : index.pieces) {
    job.progress("unpacking pictures",
                 static_cast<double>(rows.pieces.size()) / static_cast<double>(index.pieces.size()));
    rows.pieces.push_back(read_piece(file, name, job));
    if (job.cancelled()) return rows;
    bounds.add(rows.pieces.back());
    rows.degree = std::max(rows.degree, rows.pieces.back().degree);
  }
  if (index.environment) rows.ranges.push_back({rows.pieces.size() - 1, 0, rows.pieces.back().count});
  number_rows(file, index, &rows);
  bounds.check_cloud(rows);
  return rows;
}

void read_streamed_sog(const MappedFile& file, const LoadOptions& options, Scene& scene, const Job& job) {
  try {
    LodIndex index(file, options.lod);
    if (index.pieces.empty() && !index.environment) refuse_index(file, "its tree holds no Gaussians");
    if (index.others)
      scene.left_out =
          options.lod == 0
              ? "Coarser levels of detail are left out: of each part of the scene the finest is read"
              : fmt::format(
                    "Of each part of the scene the level of detail {} is read, or the coarsest that it has",
                    options.lod);
    const StreamedRows rows = rows_of_pieces(file, std::move(index), job);
    if (job.cancelled()) return;
    for (const SogRows& piece : rows.pieces) piece.add_files(&scene);
    scene.cloud.antialiased = std::ranges::all_of(rows.pieces, &SogRows::antialiased);
    decode_rows(rows, rows.count, rows.degree, scene, job);
  } catch (const json::exception& error) {
    refuse_index(file, fmt::format("is not the index of a streamed scene ({})", fault_of(error)));
  }
}

bool is_streamed_sog(const MappedFile& file) {
  const std::string_view text(reinterpret_cast<const char*>(file.bytes().data()), file.bytes().size());
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  return first != text.npos && text[first] == '{' && text.find("\"filenames\"") != text.npos &&
         text.find("\"tree\"") != text.npos;
}

}  // namespace

constinit const SceneFormat SceneFormat::kStreamedSog = {
    .name = "streamed sog",
    .extension = "lod-meta.json",
    .has_levels = true,
    .recognises = is_streamed_sog,
    .read = read_streamed_sog,
};

}  // namespace splatcut
