// The work file (.splatcut.json): which scene, and what was made of it. Text, written whole or not at all.
//
// Holds the path (relative to the work file where it lies below or beside it), hash and place of each file of
// the scene, and the document: strokes with their cameras in full float precision, hand marks and labels as
// run lengths over the Gaussians in file order, settings, and where the user looked from. The labels of an
// object are a function of scene, strokes, settings and marks, so that `splatcut cut --work` computes the
// same bits again; those that were cut before the scene got other files (ObjectItem::cut_kept) are kept as
// they are. What can be undone and redone stands beside it, see work_history.h. Errors: Error naming the file
// and the entry.
#pragma once

#include <filesystem>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "app/document/camera_pose.h"
#include "app/document/document.h"
#include "app/document/history.h"
#include "app/document/opened_scene.h"

namespace splatcut {

// A work file as it was read: the files of its scene, to load those, and the rest for restored().
struct WorkFile {
  std::filesystem::path path;
  std::vector<SceneSource> files;  // of its scene, one or more; paths are absolute
  std::shared_ptr<const nlohmann::json> content;
};

struct RestoredWork {
  Document document;
  std::optional<CameraPose> view;  // none in files of older programs
  std::string warning;             // a sentence about what the file could not say, or empty
  SavedSteps history;              // around the document; none in files of older programs
};

bool is_work_file(const std::filesystem::path& path);  // by its name

WorkFile read_work_file(const std::filesystem::path& path);

// scene: of those files; its cloud gives the arrays their order. Throws Error where they differ.
RestoredWork restored(const WorkFile& file, const OpenedScene& scene);

void write_work_file(const std::filesystem::path& path, const OpenedScene& scene, const Document& document,
                     const std::optional<CameraPose>& view = {}, const SavedSteps& history = {});

}  // namespace splatcut
