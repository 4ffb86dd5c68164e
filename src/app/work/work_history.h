// Steps that can be undone and redone, as work files hold them, so that they outlive a crash.
//
// {"cursor": n, "arrays": [runs, ...], "objects": [...], "steps": [document with its title, ...]}: arrays and
// objects that several steps share stand in the file once, and steps name them by number. Labels that a cut
// can compute again are left out, but for the step before the cursor, the one after it and those that the
// thumbnails compare with, where all steps leave room for them. A step that changed the files of the scene
// has "other_files": true.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "app/document/history.h"
#include "scene/formats/scene_file.h"

namespace splatcut {

inline constexpr std::size_t kMostSavedSteps = 200;

// The steps around the cursor, at most kMostSavedSteps. All are of the Gaussians that the scene has now, also
// those before a change of its files. The change itself cannot be undone any more: that would need the files
// before it.
SavedSteps saved_steps(const History& history);

// The steps next to the cursor as JSON, as many as fit: their arrays may take 64 MiB when read, and four
// million numbers in the text.
nlohmann::json history_json(const SavedSteps& history, const Scene& scene);

// Reads steps. document: the state at the cursor, taken in place of what the JSON says there. Throws Error if
// a value is out of range, and json::exception if the form is not the expected one.
SavedSteps history_from(const nlohmann::json& j, const Scene& scene, const Document& document);

}  // namespace splatcut
