// Reader of LCC2 (XGRIDS): several .sog or .spz, the pieces, and an .lcc2, a text with a tree. Its root has
// the names of the pieces and, maybe, the number of one that lies around; each node below it has one level of
// detail of its part of the scene, as a piece or as a range of one, and its children have the next finer one:
//   totalLevels     N; a node d steps below the root has level N - d, 0 the finest
//   splatType       ".sog" or ".spz"; the pieces say it themselves
//   lodSplats       Gaussians of each level, the finest first
//   root.splatFiles names, from the folder of the text; root.data.env.name: the number of the environment's
//   child           nodes, as a list or by name
//   data.3dgs       name: the number of the piece; start, count: the range, without them all of it
// Older files say lod_level, lod_3dgs_info (the coarsest first) and root.files (with / before and without
// .sog behind). Some writers leave commas before closing brackets. Axes are those of .lcc.
#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string>

#include "core/error.h"
#include "scene/formats/pieces.h"

namespace splatcut {

namespace {

using nlohmann::json;
namespace fs = std::filesystem;

constexpr const char* kNode = "a node";

// JSON, whose text may end lists with a comma.
std::string without_last_commas(std::string_view text) {
  std::string kept;
  std::size_t comma = std::string::npos;  // in `kept`, with blanks alone behind it
  bool in_string = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (!in_string && (c == '}' || c == ']') && comma != std::string::npos) kept[comma] = ' ';
    if (c == ',' && !in_string)
      comma = kept.size();
    else if (c != ' ' && c != '\t' && c != '\r' && c != '\n')
      comma = std::string::npos;
    kept += c;
    if (c == '"') in_string = !in_string;
    if (in_string && c == '\\' && i + 1 < text.size()) kept += text[++i];
  }
  return kept;
}

struct Lcc2Text {
  explicit Lcc2Text(const MappedFile& mapped);

  const MappedFile& file;
  json text;
  std::size_t levels = 0;
  std::vector<std::string> names;          // of the pieces
  std::optional<std::size_t> environment;  // its number

  const json& root() const { return text.at("root"); }
  const std::string& name_of_piece(std::size_t index) const;
  std::uint64_t said_gaussians(std::size_t level) const;  // 0 for none

 private:
  bool is_old() const { return text.contains("lod_level"); }
};

Lcc2Text::Lcc2Text(const MappedFile& mapped) : file(mapped) {
  text = parse_json(file.path(), without_last_commas(file.text()));
  levels = piece_number(file, text.at(is_old() ? "lod_level" : "totalLevels"), "number of levels", "it");
  if (levels == 0 || levels > SceneLevels::kMost)
    refuse_index(file, fmt::format("has {} levels of detail, not 1 to {}", levels, SceneLevels::kMost));
  for (const json& said : root().at(is_old() ? "files" : "splatFiles")) {
    std::string name = said.get<std::string>();
    if (is_old() && name.starts_with('/')) name.erase(0, 1);
    if (is_old() && !name.ends_with(".sog")) name += ".sog";
    names.push_back(std::move(name));
  }
  const json data = root().value("data", json::object());
  if (data.is_object() && data.contains("env"))
    environment = piece_number(file, data.at("env").at("name"), "piece", "the environment");
}

const std::string& Lcc2Text::name_of_piece(std::size_t index) const {
  if (index >= names.size())
    refuse_index(file, fmt::format("a node is in piece {}, counted from 0, of {}", index, names.size()));
  return names[index];
}

std::uint64_t Lcc2Text::said_gaussians(std::size_t level) const {
  const json counts = text.value(is_old() ? "lod_3dgs_info" : "lodSplats", json::array());
  if (level >= counts.size()) return 0;
  const json& count = counts.at(is_old() ? counts.size() - 1 - level : level);
  return count.is_number_unsigned() ? count.get<std::uint64_t>() : 0;
}

// Of each part of the scene the level wanted, or the finest that it has where that is coarser.
void collect_nodes(const Lcc2Text& said, const json& node, std::size_t depth, std::size_t wanted,
                   PieceIndex* taken) {
  const MappedFile& file = said.file;
  if (!node.is_object()) refuse_index(file, fmt::format("a node of its tree is {}", node.type_name()));
  const std::size_t level = said.levels - depth;
  const auto children = node.find("child"), data = node.find("data");
  const bool inner = children != node.end() && !children->empty();
  const bool has_data = data != node.end() && data->is_object() && data->contains("3dgs");
  if (depth > 0 && has_data && (level == wanted || !inner)) {
    const json& range = data->at("3dgs");
    const std::size_t piece = piece_number(file, range.at("name"), "piece", kNode);
    if (said.environment == piece) return;
    const std::size_t start =
        range.contains("start") ? piece_number(file, range.at("start"), "start", kNode) : 0;
    const std::size_t count = range.contains("count") ? piece_number(file, range.at("count"), "count", kNode)
                                                      : PieceIndex::kToTheEnd;
    if (count > 0) taken->add(said.name_of_piece(piece), start, count);
  }
  if (!inner || level <= wanted) return;
  if (!children->is_structured()) refuse_index(file, "the children of a node of its tree are no list");
  for (const json& child : *children) collect_nodes(said, child, depth + 1, wanted, taken);
}

PieceIndex index_of(const Lcc2Text& said, std::size_t wanted) {
  PieceIndex taken(said.file);
  collect_nodes(said, said.root(), 0, wanted, &taken);
  return taken;
}

// The converter takes a name without a file for a scene without surroundings, too.
void add_surroundings(const Lcc2Text& said, PieceIndex* index) {
  if (!said.environment) return;
  const std::string& name = said.name_of_piece(*said.environment);
  std::error_code ignored;
  if (fs::exists(said.file.path().parent_path() / name, ignored)) index->set_environment(name);
}

template <class Read>
auto of_lcc2(const MappedFile& file, const Read& read) {
  try {
    return read(Lcc2Text(file));
  } catch (const json::exception& error) {
    refuse_index(file, fmt::format("is not the text of an .lcc2 ({})", fault_of(error)));
  }
}

void read_lcc2(const MappedFile& file, const LoadOptions& options, Scene& scene, const Job& job) {
  of_lcc2(file, [&](const Lcc2Text& said) {
    const std::size_t level = std::min<std::size_t>(options.lod, said.levels - 1);
    PieceIndex index = index_of(said, level);
    if (index.pieces().empty())
      refuse_index(file, fmt::format("its level of detail {} holds no Gaussians", level));
    add_surroundings(said, &index);
    if (said.levels > 1) scene.left_out = level_read(said.levels, level);
    read_pieces(index, PieceAxes::kLcc, scene, job);
    // Pieces of other levels are the scene's, too: nothing is written over them.
    for (const std::string& name : said.names) scene.files.push_back(file.path().parent_path() / name);
  });
}

SceneLevels levels_of_lcc2(const MappedFile& file) {
  return of_lcc2(file, [&](const Lcc2Text& said) {
    SceneLevels levels;
    for (std::size_t level = 0; level < said.levels; ++level) {
      const PieceIndex index = index_of(said, level);
      const std::uint64_t counted = index.gaussians();
      levels.gaussians.push_back(counted < PieceIndex::kToTheEnd ? counted : said.said_gaussians(level));
      if (level == 0 && !index.pieces().empty())
        levels.sh_degree = degree_of_piece(file, index.pieces().front());
    }
    return levels;
  });
}

}  // namespace

constinit const SceneFormat SceneFormat::kLcc2 = {
    .name = "lcc2",
    .extension = ".lcc2",
    .levels = levels_of_lcc2,
    .read = read_lcc2,
};

}  // namespace splatcut
