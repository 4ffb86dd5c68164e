// Exports: which Gaussians go into which files. The plan of a format in scene_formats.h says what the format
// keeps and loses.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "app/document/clean_objects.h"
#include "app/document/document.h"
#include "app/placing/export_placement.h"
#include "scene/formats/scene_file.h"

namespace splatcut {

// kRest: all but the object. kScene: all that was not deleted. kAllObjects: one file per object, named after
// it. kOneFile: all objects in one file, their rows as they are, as `cut --write objects` has it: a .ply says
// whose a Gaussian is as object_id, the object's place in the list, and a .json beside it says the names.
enum class ExportWhat { kObject, kRest, kScene, kAllObjects, kOneFile };

// Form of a turntable: a folder of PNGs, an animated WebP, or a .mp4 that ffmpeg makes.
enum class TurntableAs { kPictures, kWebp, kVideo };

struct ExportRequest {
  ExportWhat what = ExportWhat::kObject;
  SceneFormat format = SceneFormat::kPly;
  std::filesystem::path path;  // a file; for kAllObjects a folder
  bool overwrite = false;
  ExportPlacement placement = {};
  bool clean_edges = false;  // objects are written with clean edges, kRest as forget.h has it
  bool fill_hole = false;    // kRest: as fill.h has it
  bool operator==(const ExportRequest&) const = default;
};

struct ExportReport {
  std::size_t gaussians = 0, files = 0;
  std::uint64_t bytes = 0;
  std::string loss;           // sentence about what the format lost; empty: nothing
  std::size_t clean = 0;      // number of files whose object has clean edges, or that are its rest
  std::string edges_kept;     // reason why the first object without them has none, if they were asked for
  std::string edges_kept_of;  // its name; empty: there is one object
  std::size_t kept = 0;       // number of objects without
  std::string hole_kept;      // reason why a hole is not filled, if that was asked for
  std::size_t invented = 0;   // Gaussians that fill a hole; `gaussians` counts them, too
  std::size_t not_given_back = 0;  // Gaussians, see spare_copy()
};

// Of one more file. name: the object's, where there are several.
void count_edges(const CleanReport& clean, ExportReport* report, const std::string& name = {});
// What the user reads: of the edges alone, to stand behind a sentence without a full stop, and of all.
std::string edges_text(const ExportReport& report);
std::string text_of(const ExportReport& report, const std::filesystem::path& path);

// Flags per Gaussian of the scene: not 0 if the export writes it, for kAllObjects into any of its
// files; for kOneFile the number of its object.
// gaussians: size of the cloud. known: as of document.h.
std::vector<std::uint8_t> exported(const Document& document, ObjectId object, ExportWhat what,
                                   std::size_t gaussians, LabelCache* known = nullptr);

// Where Gaussians are moved to, and whether the scene's origin (scene_file.h) is added to that.
struct MovedTo {
  Similarity by;
  bool adds_origin = true;
};

// Writes Gaussians of a scene, rows unchanged where the format allows it: those with a flag in `keep` (one
// per Gaussian, empty: all), or the cloud `instead` (an object with clean edges; null: none) in their place.
// to: where they are moved to, and with them what scene and options say of up. Throws Error as save_scene()
// does.
SaveReport save_gaussians(const std::filesystem::path& path, const Scene& scene,
                          const std::vector<std::uint8_t>& keep, const GaussianCloud* instead,
                          const SceneFormat& format, const std::optional<MovedTo>& to = {},
                          const SaveOptions& options = {});

// Whether the rest of a scene, so changed, is written from a copy of its Gaussians. Moved, it always is. What
// is added goes beside rows that are copied as they are only into a .ply, and where the scene's rows can be
// changed; else it takes a copy of all of them.
bool rest_is_copy(const Scene& scene, const SceneFormat& format, bool moved, const RestChanges& changes);

// In a scene of more Gaussians, what is given back to the rest is left out where it alone would take that
// copy.
inline constexpr std::size_t kMostToCopy = 2'000'000;

// Leaves that out of the changes. filled: what else is added. Returns how many Gaussians it was.
std::size_t spare_copy(const Scene& scene, const SceneFormat& format, bool moved, const RestChanges& filled,
                       RestChanges* changes);

// The same for the rest of a scene, of which ghosts are left out, and with what was given back.
SaveReport save_rest(const std::filesystem::path& path, const Scene& scene, std::vector<std::uint8_t> keep,
                     const RestChanges& changes, const SceneFormat& format,
                     const std::optional<MovedTo>& to = {}, SaveOptions options = {});

// Calls back for each object that has Gaussians, in the document's order.
struct ObjectToSave {
  const std::string& name;
  const std::string& file;                  // free_file_name(), without an extension
  const std::vector<std::uint8_t>& labels;  // per Gaussian of the scene, 1 = object
};
void visit_objects(const Document& document, std::size_t gaussians,
                   const std::function<void(const ObjectToSave&)>& visit, LabelCache* known = nullptr);

// Writes the files of an export. clean: cache of the same scene; may be null if the request wants neither
// clean edges nor a hole filled. Throws Error if there is nothing to export, if a number of the placement is
// unusable, if the path lacks the format's extension, if a file is one that the scene was read from, if a
// file exists and the request does not overwrite, or if the disk is full. If cancelled, files that are not
// yet written stay unwritten.
ExportReport run_export(const Scene& scene, const Document& document, ObjectId object,
                        const ExportRequest& request, CleanObjects* clean = nullptr, const Job& job = {});

// File name for an object, of letters, digits, - and _ only.
std::string file_name_of(const std::string& object_name);

// file_name_of() with a number behind it if `taken` has that name already. The call adds the name to `taken`.
std::string free_file_name(const std::string& object_name, std::set<std::string>* taken);

// Returns the path itself, or the path with a number before its extension if a file of that name exists.
std::filesystem::path free_path(const std::filesystem::path& path, const std::string& extension);

std::string human_bytes(std::uint64_t bytes);  // "4.4 MB"

}  // namespace splatcut
