// The work file (.splatcut.json): which scene, and what was made of it. Text, written whole or not at all.
//
// Holds the scene's path (relative to the work file where it lies below or beside it) and hash, and the
// document: strokes with their cameras in full float precision, hand marks and labels as run lengths over the
// Gaussians in file order, settings, and where the user looked from. The labels of an object are a function
// of scene, strokes, settings and marks, so that `splatcut cut --work` computes the same bits again. Errors:
// Error naming the file and the entry.
#pragma once

#include <filesystem>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "app/studio/camera_controller.h"
#include "app/studio/document.h"
#include "scene/formats/scene_file.h"

namespace splatcut {

// A work file as it was read: the scene it belongs to, to load that, and the rest for restored().
struct WorkFile {
  std::filesystem::path path;
  std::filesystem::path scene;  // absolute
  std::uint64_t scene_hash = 0;
  std::optional<SpzAxes> spz_axes;  // of a scene whose file does not say them: those of the labels
  std::shared_ptr<const nlohmann::json> content;
};

struct RestoredWork {
  Document document;
  std::optional<CameraPose> view;  // none in files of older programs
  std::string warning;             // a sentence about what the file could not say, or empty
};

bool is_work_file(const std::filesystem::path& path);  // by its name

WorkFile read_work_file(const std::filesystem::path& path);

// scene: the loaded scene of the file; its cloud gives the arrays their order. Throws Error where they
// differ.
RestoredWork restored(const WorkFile& file, const Scene& scene, std::uint64_t scene_hash);

void write_work_file(const std::filesystem::path& path, const Scene& scene, std::uint64_t scene_hash,
                     const Document& document, const std::optional<CameraPose>& view = {});

// FNV-1a over the 64-bit words of the file.
std::uint64_t hash_of_file(const std::filesystem::path& path);

}  // namespace splatcut
