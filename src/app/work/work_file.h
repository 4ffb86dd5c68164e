// The work file (.splatcut.json): a scene and the document that was made of it. It is text, and is written
// whole or not at all.
//
// The file holds path, hash, number of rows, cameras that were asked for and place of each file of the scene;
// a path is relative if the file lies beside or below the work file. It holds the document: strokes with
// their cameras in full float precision, hand marks and labels as run lengths over the rows of the scene, and
// settings. It also holds the user's camera, whether the object is shown alone, and the steps that can be
// undone and redone, see work_history.h. The labels of an object are a function of scene, strokes, settings
// and marks, so that `splatcut cut --work` computes the same bits again. Labels that are older than the
// scene's present files (ObjectItem::cut_kept) are kept as they are. Errors: Error names the file and the
// entry.
#pragma once

#include <filesystem>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "app/document/camera_pose.h"
#include "app/document/document.h"
#include "app/document/doubtful_side.h"
#include "app/document/history.h"
#include "app/document/opened_scene.h"
#include "app/document/view_state.h"

namespace splatcut {

// A work file after reading: the files of its scene, which the caller opens, and the content for restored().
struct WorkFile {
  std::filesystem::path path;
  std::vector<SceneSource> files;  // files of its scene, one or more, with absolute paths
  std::shared_ptr<const nlohmann::json> content;
  bool holds_nothing() const;  // the scene as it was opened, and no step that could be redone
};

// Where the user's camera stands, what is shown, and what the thumbnails are in doubt of.
struct WorkView {
  CameraPose pose;
  DisplayMode display = DisplayMode::kWhole;
  std::vector<ObjectId> hidden{};  // see ViewState::hidden
  std::vector<DoubtfulSide> sides{};
  bool operator==(const WorkView&) const = default;
};

struct RestoredWork {
  Document document;
  std::optional<WorkView> view;    // none: the file holds none
  std::string warning;             // what could not be read, or is not known; empty: nothing
  SavedSteps history;              // steps around the document; none: the file holds none
  std::filesystem::path saved_as;  // of an autosave: the user's own file, where there was one
};

bool is_work_file(const std::filesystem::path& path);  // true if the name ends like one

// Reads a work file. Throws Error for a file that is none, or is of a version that this program does not
// read.
WorkFile read_work_file(const std::filesystem::path& path);

// Reads the document of a work file. scene: the opened scene of WorkFile::files; its cloud gives the
// arrays their order. Files that were added may be missing from it, the others have the ids of
// WorkFile::files: what was labelled in them is left out, labels stay as they are until the next stroke, and
// there is no history. Throws Error if the scene has other files, or if a file's hash is another.
RestoredWork restored(const WorkFile& file, const OpenedScene& scene);

void write_work_file(const std::filesystem::path& path, const OpenedScene& scene, const Document& document,
                     const std::optional<WorkView>& view = {}, const SavedSteps& history = {},
                     const std::filesystem::path& saved_as = {});

}  // namespace splatcut
