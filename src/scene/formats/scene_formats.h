// The table of scene formats. Readers, writers, file dialogs, help texts and lists of formats follow from it.
// A format is one file in src/scene/formats that defines its row, and one line here.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "scene/formats/axis_signs.h"

// In the order of lists and dialogs.
// clang-format off
#define SPLATCUT_SCENE_FORMATS(row) \
  row(kPly)                         \
  row(kCompressedPly)               \
  row(kSplat)                       \
  row(kSpz)                         \
  row(kSog)                         \
  row(kStreamedSog)                 \
  row(kLcc)                         \
  row(kLcc2)                        \
  row(kRad)                         \
  row(kGlb)                         \
  row(kUsda)                        \
  row(kKsplat)
// clang-format on

namespace splatcut {

class AtomicFile;
class MappedFile;
struct Job;
struct LoadOptions;
struct SaveOptions;
struct Scene;

// What a file of a format would hold, before it is written.
struct FormatPlan {
  std::uint64_t bytes = 0;
  bool about = false;      // compressed: the size is an estimate
  std::string kept, lost;  // sentences; lost is empty where nothing is
};

// What a file says of its levels of detail.
struct SceneLevels {
  static constexpr unsigned kMost = 64;
  std::vector<std::uint64_t>
      gaussians;      // number of each level, 0 the finest; 0 where the file does not say it
  int sh_degree = 0;  // degree of spherical harmonics
};

// Sentence for Scene::left_out: which of several levels of detail was read.
std::string level_read(std::size_t levels, std::size_t level);

// One row. A value that is copied freely; rows are equal where their names are.
struct SceneFormat {
  const char* name = "";       // in reports and on the command line: "compressed.ply"
  const char* extension = "";  // what file names end with, small letters: ".compressed.ply", "lod-meta.json"
  const char* also = "";       // another ending that is read: "meta.json"; empty for none

  // Of what is written, against ours.
  AxisSigns axes = {};

  // By the first bytes. Null: nothing marks such files but their name.
  bool (*recognises)(const MappedFile& file) = nullptr;

  // Levels of detail, of which LoadOptions says one. Reads the index alone. Throws Error. Null: there is one.
  SceneLevels (*levels)(const MappedFile& file) = nullptr;

  // Fills cloud (Morton order), file_rows, dropped and what else a Scene says of its file. Throws Error for
  // bad content. Null: the format is only written.
  void (*read)(const MappedFile& file, const LoadOptions& options, Scene& scene, const Job& job) = nullptr;

  // Writes the Gaussians, given as indices into scene.cloud in file order, and up as the options have it.
  // Returns the sentence on what is lost, or nothing. Null: the format is only read.
  std::string (*write)(AtomicFile& out, const Scene& scene, std::span<const std::uint32_t> gaussians,
                       const SaveOptions& options) = nullptr;

  // Of these Gaussians, indices into scene.cloud. moved: none is where its row says, so that no row is
  // copied. Null where write is.
  FormatPlan (*plan)(const Scene& scene, std::span<const std::uint32_t> gaussians, bool moved) = nullptr;

  friend bool operator==(const SceneFormat& a, const SceneFormat& b) {
    return std::string_view(a.name) == b.name;
  }

#define SPLATCUT_DECLARE_ROW(row) static const SceneFormat row;
  SPLATCUT_SCENE_FORMATS(SPLATCUT_DECLARE_ROW)
#undef SPLATCUT_DECLARE_ROW
};

std::vector<SceneFormat> scene_formats();
std::vector<SceneFormat> read_formats();
std::vector<SceneFormat> written_formats();

// The format whose extension the name ends with (the longest such), whatever the case; null for none.
const SceneFormat* find_format(const std::filesystem::path& path);
bool has_scene_extension(const std::filesystem::path& path);

// The same, of a file to be read. Throws Error for a name of no format that is read.
SceneFormat input_format_from_name(const std::filesystem::path& path);

// Of a file to be written: by a format's own extension alone, as what `also` names is not what would be
// written. Throws Error, which lists what can be, for any other name.
SceneFormat output_format_from_name(const std::filesystem::path& path);

// Extensions of the formats as a file dialog filters by them: none that another one covers.
std::vector<std::string> extensions_of(std::span<const SceneFormat> formats);
// Endings of the formats as one tells them to a person: second ones, too, without names of whole files
// (meta.json). ".glb, .gltf or .spz"
std::string spoken_endings(std::span<const SceneFormat> formats, std::string_view conjunction);
// ".ply, .splat or .spz"
std::string spoken_extensions(std::span<const SceneFormat> formats, std::string_view conjunction);
std::vector<std::string> names_of(std::span<const SceneFormat> formats);

// The name with the format's extension in place of any other scene extension.
std::filesystem::path with_extension(const std::filesystem::path& path, const SceneFormat& format);

}  // namespace splatcut
