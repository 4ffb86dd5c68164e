// Steps that can be undone and redone, as work files hold them, so that they outlive a crash.
//
// {"cursor": n, "arrays": [runs, ...], "objects": [...], "steps": [document with its title, ...]}: arrays and
// objects that several steps share stand in the file once, and steps name them by number. Labels that a cut
// can compute again are left out.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "app/document/history.h"
#include "scene/formats/scene_file.h"

namespace splatcut {

inline constexpr std::size_t kMostSavedSteps = 200;

// The steps around the cursor that a work file can hold, at most kMostSavedSteps: back to the state after the
// last change of the scene's files, and on to the next such change. Undoing a change of files would need the
// files before it.
SavedSteps saved_steps(const History& history);

// The steps next to the cursor as JSON, as many as fit: their arrays may take 64 MiB when read, and four
// million numbers in the text.
nlohmann::json history_json(const SavedSteps& history, const Scene& scene);

// Reads steps. document: the state at the cursor, taken in place of what the JSON says there. Throws Error if
// a value is out of range, and json::exception if the form is not the expected one.
SavedSteps history_from(const nlohmann::json& j, const Scene& scene, const Document& document);

}  // namespace splatcut
