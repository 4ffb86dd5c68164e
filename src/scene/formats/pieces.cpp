#include "scene/formats/pieces.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <variant>

#include "core/error.h"
#include "scene/formats/decode.h"
#include "scene/formats/lcc_axes.h"
#include "scene/formats/sog_rows.h"
#include "scene/formats/spz_rows.h"

namespace splatcut {

namespace {

using nlohmann::json;
namespace fs = std::filesystem;

// Each Gaussian once: so few bytes cannot stand for many.
void check_overlaps(const PieceIndex& index) {
  std::vector<PieceRange> sorted = index.ranges();
  std::ranges::sort(sorted, [](const PieceRange& a, const PieceRange& b) {
    return a.piece != b.piece ? a.piece < b.piece : a.offset < b.offset;
  });
  const auto twice = std::ranges::adjacent_find(sorted, [](const PieceRange& a, const PieceRange& b) {
    return a.piece == b.piece && a.offset + a.count > b.offset;
  });
  if (twice != sorted.end())
    refuse_index(index.file(), fmt::format("two leaves show the same Gaussians of {}",
                                           index.pieces()[twice->piece].string()));
}

// The file stays open: what is not packed is read in place.
struct Piece {
  std::unique_ptr<MappedFile> file;
  std::variant<SogRows, SpzRows> rows;

  std::size_t count() const {
    return std::visit([](const auto& own) { return own.count; }, rows);
  }
  int degree() const {
    return std::visit([](const auto& own) { return own.degree; }, rows);
  }
  std::uint64_t unpacked_bytes() const {
    return std::visit([](const auto& own) { return own.unpacked_bytes(); }, rows);
  }
  bool antialiased() const {
    return std::visit([](const auto& own) { return own.antialiased; }, rows);
  }
  std::map<fs::path, std::uint64_t> packed() const {
    if (const auto* sog = std::get_if<SogRows>(&rows)) return sog->packed;
    return {{file->path(), file->bytes().size()}};
  }
};

// A source of decode_rows().
struct PieceRows {
  std::vector<Piece> pieces;
  std::vector<PieceRange> ranges;  // by first_row
  std::size_t count = 0;
  int degree = 0;  // the highest of the pieces
  PieceAxes axes = PieceAxes::kPly;
  ShTurn turn{glm::mat3_cast(kLccUpright)};

  const Piece& piece_of_row(std::size_t* row) const {
    const PieceRange& range = *std::prev(std::ranges::upper_bound(ranges, *row, {}, &PieceRange::first_row));
    *row = range.offset + *row - range.first_row;
    return pieces[range.piece];
  }
  glm::vec3 position(std::size_t row) const {
    const Piece& piece = piece_of_row(&row);
    const glm::vec3 p = std::visit([&](const auto& own) { return own.position(row); }, piece.rows);
    return axes == PieceAxes::kLcc ? lcc_turned(p) : p;
  }
  void decode(std::size_t row, GaussianCloud& cloud, std::size_t g) const {
    const Piece& piece = piece_of_row(&row);
    std::visit([&](const auto& own) { own.decode(row, cloud, g); }, piece.rows);
    if (axes != PieceAxes::kLcc) return;
    cloud.rotation[g] = glm::normalize(kLccUpright * cloud.rotation[g]);
    turn.apply(std::span(cloud.sh_rest).subspan(g * cloud.sh_stride(), cloud.sh_stride()), cloud.sh_degree);
  }
};

// Checked after each piece against all files read so far: many names must not take what one may not.
class PieceBounds {
 public:
  explicit PieceBounds(const MappedFile& file) : path_(file.path()) {
    files_[path_] = packed_ = file.bytes().size();
  }
  void add(const Piece& piece) {
    for (const auto& [path, bytes] : piece.packed())
      if (files_.emplace(path, bytes).second) packed_ += bytes;
    unpacked_ += piece.unpacked_bytes();
    check_expansion(path_, packed_, unpacked_);
  }
  // Also where a piece without spherical harmonics takes those of another.
  void check_cloud(const PieceRows& rows) const { check_cloud_size(path_, packed_, rows.count, rows.degree); }

 private:
  fs::path path_;
  std::map<fs::path, std::uint64_t> files_;
  std::uint64_t packed_ = 0, unpacked_ = 0;
};

std::unique_ptr<MappedFile> open_piece(const MappedFile& index, const fs::path& name) {
  const fs::path path = index.path().parent_path() / name;
  std::error_code ignored;
  if (fs::status(path, ignored).type() == fs::file_type::not_found)
    throw Error(index.path().string(), fmt::format("its piece {} is missing", name.string()),
                "Copy the whole folder, with all folders in it");
  return std::make_unique<MappedFile>(path);
}

Piece read_piece(const MappedFile& index, const fs::path& name, const Job& job) {
  Piece piece{open_piece(index, name), {}};
  if (SceneFormat::kSpz.recognises(*piece.file))
    piece.rows = read_spz_rows(*piece.file, job);
  else
    piece.rows = read_sog_rows(*piece.file, job);
  return piece;
}

void number_rows(const PieceIndex& index, PieceRows* rows) {
  for (PieceRange& range : rows->ranges) {
    const std::size_t all = rows->pieces[range.piece].count();
    if (range.count >= PieceIndex::kToTheEnd) range.count = all - std::min(all, range.offset);
    if (range.count == 0 || range.offset + range.count > all)
      refuse_index(index.file(),
                   fmt::format("a leaf shows the Gaussians {} to {} of {}, which has {}", range.offset,
                               range.offset + range.count, index.pieces()[range.piece].string(), all));
    range.first_row = rows->count;
    rows->count += range.count;
  }
  if (rows->count > PieceIndex::kMostGaussians)
    refuse_index(index.file(), fmt::format("promises {} Gaussians", rows->count));
}

// Incomplete when cancelled.
PieceRows rows_of_pieces(const PieceIndex& index, const Job& job) {
  PieceRows rows;
  rows.ranges = index.ranges();
  std::vector<fs::path> names = index.pieces();
  if (index.environment()) names.push_back(*index.environment());
  PieceBounds bounds(index.file());
  for (const fs::path& name : names) {
    job.progress("unpacking pictures",
                 static_cast<double>(rows.pieces.size()) / static_cast<double>(names.size()));
    rows.pieces.push_back(read_piece(index.file(), name, job));
    if (job.cancelled()) return rows;
    bounds.add(rows.pieces.back());
    rows.degree = std::max(rows.degree, rows.pieces.back().degree());
  }
  if (index.environment()) rows.ranges.push_back({rows.pieces.size() - 1, 0, rows.pieces.back().count()});
  number_rows(index, &rows);
  bounds.check_cloud(rows);
  return rows;
}

}  // namespace

void refuse_index(const MappedFile& file, const std::string& what) {
  throw Error(file.path().string(), what, "Write it again with the program that made it");
}

fs::path path_in_folder(const MappedFile& file, const std::string& name) {
  const fs::path path = fs::path(name).lexically_normal();
  const bool inside =
      !path.is_absolute() && !path.empty() && *path.begin() != ".." && name.find('\0') == std::string::npos;
  if (!inside)
    refuse_index(file, fmt::format("names the piece {}, which is not in its folder", json_text(name)));
  return path;
}

std::size_t piece_number(const MappedFile& file, const json& value, const char* what, const char* whose) {
  if (!value.is_number_unsigned() || value.get<std::uint64_t>() > PieceIndex::kMostGaussians)
    refuse_index(file, fmt::format("the {} of {} is {}, not a whole number up to {}", what, whose,
                                   value.is_number() ? json_text(value) : value.type_name(),
                                   PieceIndex::kMostGaussians));
  return value.get<std::size_t>();
}

void PieceIndex::add(const std::string& name, std::size_t offset, std::size_t count) {
  const fs::path path = path_in_folder(file_, name);
  const auto [at, is_new] = numbers_.emplace(path, pieces_.size());
  if (is_new) pieces_.push_back(path);
  ranges_.push_back({at->second, offset, count});
}

void PieceIndex::set_environment(const std::string& name) {
  environment_ = path_in_folder(file_, name);
  if (numbers_.contains(*environment_)) refuse_index(file_, "its environment is also a piece of its tree");
}

std::uint64_t PieceIndex::gaussians() const {
  std::uint64_t sum = 0;
  for (const PieceRange& range : ranges_) sum += range.count;
  return sum;
}

int degree_of_piece(const MappedFile& index, const fs::path& name) {
  const std::unique_ptr<MappedFile> file = open_piece(index, name);
  return SceneFormat::kSpz.recognises(*file) ? degree_of_spz(*file) : degree_of_sog(*file);
}

void read_pieces(const PieceIndex& index, PieceAxes axes, Scene& scene, const Job& job) {
  check_overlaps(index);
  if (index.pieces().empty() && !index.environment())
    refuse_index(index.file(), "its tree holds no Gaussians");
  PieceRows rows = rows_of_pieces(index, job);
  if (job.cancelled()) return;
  rows.axes = axes;
  for (const Piece& piece : rows.pieces)
    for (const auto& [path, bytes] : piece.packed()) scene.files.push_back(path);
  scene.cloud.antialiased = std::ranges::all_of(rows.pieces, &Piece::antialiased);
  decode_rows(rows, rows.count, rows.degree, scene, job);
}

}  // namespace splatcut
