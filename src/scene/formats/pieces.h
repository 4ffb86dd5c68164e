// Scenes of several files: pieces (.sog, .spz), and an index that says which Gaussians of which piece are
// shown at which level of detail. What the readers of such indices share. Internal to src/scene/formats.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/json_file.h"
#include "core/mapped_file.h"
#include "scene/formats/scene_file.h"

namespace splatcut {

[[noreturn]] void refuse_index(const MappedFile& file, const std::string& what);

// A name that an index has as a path in its folder, the same for all spellings. Throws Error for one that
// leaves it.
std::filesystem::path path_in_folder(const MappedFile& file, const std::string& name);

// Gaussians of a piece, never none.
struct PieceRange {
  std::size_t piece = 0, offset = 0, count = 0, first_row = 0;
};

// What is shown of which pieces, range by range, then the environment: a piece that no range names.
class PieceIndex {
 public:
  static constexpr std::uint64_t kMostGaussians = 0xffffffff;
  static constexpr std::size_t kToTheEnd = 0xffffffffffff;  // a count, of what its piece says itself

  explicit PieceIndex(const MappedFile& file) : file_(file) {}

  // name: a path in the folder of the index. Throws Error for one that leaves it.
  void add(const std::string& name, std::size_t offset, std::size_t count);
  void set_environment(const std::string& name);

  const MappedFile& file() const { return file_; }
  const std::vector<std::filesystem::path>& pieces() const { return pieces_; }
  const std::vector<PieceRange>& ranges() const { return ranges_; }
  const std::optional<std::filesystem::path>& environment() const { return environment_; }
  std::uint64_t gaussians() const;  // without the environment

 private:
  const MappedFile& file_;
  std::vector<std::filesystem::path> pieces_;  // each once
  std::vector<PieceRange> ranges_;
  std::optional<std::filesystem::path> environment_;
  std::map<std::filesystem::path, std::size_t> numbers_;  // of pieces
};

// Axes of the pieces' numbers: those of a .ply, or those of .lcc.
enum class PieceAxes { kPly, kLcc };

// Reads what the index shows; rows are numbered in its order, the degree of spherical harmonics is the
// highest of the pieces. Throws Error for a Gaussian that is shown twice, for ranges beyond their pieces, and
// for pieces that are missing, damaged, or together more than check_expansion() allows.
void read_pieces(const PieceIndex& index, PieceAxes axes, Scene& scene, const Job& job);

// The degree that a piece says, as far as its text or header does without being unpacked.
int degree_of_piece(const MappedFile& index, const std::filesystem::path& name);

// A whole number up to kMostGaussians. whose: "a leaf". Throws Error for anything else.
std::size_t piece_number(const MappedFile& file, const nlohmann::json& value, const char* what,
                         const char* whose);

}  // namespace splatcut
