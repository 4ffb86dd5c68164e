// What an export writes. What a format keeps and loses is its plan in scene_formats.h.
#pragma once

#include <cstdint>
#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "app/document/clean_objects.h"
#include "app/document/document.h"
#include "app/document/export_placement.h"
#include "scene/formats/scene_file.h"

namespace splatcut {

// kAllObjects: one file each, named after the object. kScene: all that was not deleted.
enum class ExportWhat { kObject, kRest, kScene, kAllObjects };

enum class TurntableAs { kPictures, kWebp, kVideo };  // a folder of PNGs, an animation, a .mp4 made by ffmpeg

struct ExportRequest {
  ExportWhat what = ExportWhat::kObject;
  SceneFormat format = SceneFormat::kPly;
  std::filesystem::path path;  // a file; for kAllObjects a folder
  bool overwrite = false;
  ExportPlacement placement = {};
  bool clean_edges = false;  // of objects
};

struct ExportReport {
  std::size_t gaussians = 0, files = 0;
  std::uint64_t bytes = 0;
  std::string loss;
  std::size_t clean = 0;   // files whose object has clean edges
  std::string edges_kept;  // why an object has not, where that was asked for
};

// 1 for each of the scene's Gaussians that is written, of kAllObjects into any of the files.
std::vector<std::uint8_t> exported(const Document& document, ObjectId object, ExportWhat what,
                                   std::size_t gaussians);

// Throws Error: nothing to export, the file is one that the scene was read from, or exists and overwriting
// was not asked for, the disk is full. clean: of the same scene; null where no clean edges are asked for.
// Cancelled: what is not yet written stays unwritten.
ExportReport run_export(const Scene& scene, const Document& document, ObjectId object,
                        const ExportRequest& request, CleanObjects* clean = nullptr, const Job& job = {});

std::string file_name_of(const std::string& object_name);  // letters, digits, - and _

// The same with a number behind it where `taken` has it; then it is taken, too.
std::string free_file_name(const std::string& object_name, std::set<std::string>* taken);

// The same with a number before its extension where a file of that name is there already.
std::filesystem::path free_path(const std::filesystem::path& path, const std::string& extension);

std::string human_bytes(std::uint64_t bytes);  // "4.4 MB"

}  // namespace splatcut
