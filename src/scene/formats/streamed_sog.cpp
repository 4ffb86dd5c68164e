// Reader of streamed .sog (PlayCanvas): several .sog, the pieces, and lod-meta.json, a tree whose leaves say
// which Gaussians of which piece they show at which level of detail; 0 is the finest. Taken are the Gaussians
// of each leaf's finest level, leaf by leaf, then those of the environment, a piece that no leaf names.
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <string>

#include "core/error.h"
#include "scene/formats/pieces.h"

namespace splatcut {

namespace {

using nlohmann::json;

constexpr const char* kLeaf = "a leaf";

unsigned level_of(const MappedFile& file, const std::string& key) {
  unsigned level = 0;
  const char* end = key.data() + key.size();
  const auto [at, failure] = std::from_chars(key.data(), end, level);
  if (failure != std::errc() || at != end)
    refuse_index(file, fmt::format("a leaf has the level of detail {}, which is no number", json_text(key)));
  return level;
}

// What lod-meta.json says, as far as it is taken.
struct LodIndex {
  LodIndex(const MappedFile& mapped, const json& text, unsigned wanted);

  PieceIndex taken;
  unsigned coarsest = 0;  // level
  bool others = false;    // there are levels that are not taken

 private:
  void collect(const json& node, int depth);
  void add_leaf(const json& lods);
  const std::string& name_of_piece(std::size_t index) const;

  const MappedFile& file_;
  const json& names_;
  unsigned lod_;
};

LodIndex::LodIndex(const MappedFile& mapped, const json& text, unsigned wanted)
    : taken(mapped), file_(mapped), names_(text.at("filenames")), lod_(wanted) {
  if (const json version = text.value("version", json(1)); version != 1)
    throw Error(file_.path().string(),
                fmt::format("version {} of a streamed scene is not supported",
                            version.is_number() ? json_text(version) : version.type_name()));
  collect(text.at("tree"), 0);
  if (!text.contains("environment") || text.at("environment").is_null()) return;
  taken.set_environment(text.at("environment").get<std::string>());
}

void LodIndex::collect(const json& node, int depth) {
  constexpr int kDeepest = 1000;
  if (depth > kDeepest) refuse_index(file_, fmt::format("its tree is deeper than {} nodes", kDeepest));
  if (!node.is_object()) refuse_index(file_, fmt::format("a node of its tree is {}", node.type_name()));
  const auto list = node.find("children"), lods = node.find("lods");
  const bool inner = list != node.end() && !list->empty(), leaf = lods != node.end() && !lods->empty();
  if (inner && leaf) refuse_index(file_, "a node of its tree has both children and levels of detail");
  if (inner && !list->is_array()) refuse_index(file_, "the children of a node of its tree are no list");
  if (leaf && !lods->is_object()) refuse_index(file_, "the levels of detail of a leaf have no numbers");
  if (leaf) add_leaf(*lods);
  if (!inner) return;
  for (const json& child : *list) collect(child, depth + 1);
}

void LodIndex::add_leaf(const json& lods) {
  const json* best = nullptr;
  unsigned best_level = 0;
  std::size_t levels = 0;
  for (const auto& [key, lod] : lods.items()) {
    const unsigned level = level_of(file_, key);
    if (piece_number(file_, lod.at("count"), "count", kLeaf) == 0) continue;
    ++levels;
    coarsest = std::max(coarsest, level);
    // The finest of those that are no finer than wanted, else the coarsest.
    const bool better = !best || (level >= lod_ ? best_level < lod_ || level < best_level
                                                : best_level < lod_ && level > best_level);
    if (!better) continue;
    best = &lod;
    best_level = level;
  }
  if (!best) return;
  others = others || levels > 1;
  const std::size_t piece = piece_number(file_, best->at("file"), "file", kLeaf);
  taken.add(name_of_piece(piece), piece_number(file_, best->at("offset"), "offset", kLeaf),
            piece_number(file_, best->at("count"), "count", kLeaf));
}

const std::string& LodIndex::name_of_piece(std::size_t index) const {
  if (index >= names_.size())
    refuse_index(file_, fmt::format("a leaf is in piece {}, counted from 0, of {}", index, names_.size()));
  return names_.at(index).get_ref<const std::string&>();
}

// What reading the text throws is about this file.
template <class Read>
auto of_index(const MappedFile& file, const Read& read) {
  try {
    return read(parse_json(file.path(), file.text()));
  } catch (const json::exception& error) {
    refuse_index(file, fmt::format("is not the index of a streamed scene ({})", fault_of(error)));
  }
}

void read_streamed_sog(const MappedFile& file, const LoadOptions& options, Scene& scene, const Job& job) {
  of_index(file, [&](const json& text) {
    const LodIndex index(file, text, options.lod);
    if (index.others)
      scene.left_out =
          options.lod == 0
              ? "Coarser levels of detail are left out: of each part of the scene the finest is read"
              : fmt::format(
                    "Of each part of the scene the level of detail {} is read, or the coarsest that it has",
                    options.lod);
    read_pieces(index.taken, PieceAxes::kPly, scene, job);
    // Pieces of other levels are the scene's, too: nothing is written over them.
    for (const json& name : text.at("filenames"))
      if (name.is_string()) scene.files.push_back(file.path().parent_path() / name.get<std::string>());
  });
}

SceneLevels streamed_levels(const MappedFile& file) {
  return of_index(file, [&](const json& text) {
    SceneLevels levels;
    for (unsigned lod = 0; lod <= SceneLevels::kMost; ++lod) {
      const LodIndex index(file, text, lod);
      levels.gaussians.push_back(index.taken.gaussians());
      if (lod == 0 && !index.taken.pieces().empty())
        levels.sh_degree = degree_of_piece(file, index.taken.pieces().front());
      if (lod >= index.coarsest) break;
    }
    return levels;
  });
}

bool is_streamed_sog(const MappedFile& file) {
  const std::string_view text = file.text();
  return begins_as_json(file) && text.find("\"filenames\"") != text.npos &&
         text.find("\"tree\"") != text.npos;
}

}  // namespace

constinit const SceneFormat SceneFormat::kStreamedSog = {
    .name = "streamed sog",
    .extension = "lod-meta.json",
    .recognises = is_streamed_sog,
    .levels = streamed_levels,
    .read = read_streamed_sog,
};

}  // namespace splatcut
