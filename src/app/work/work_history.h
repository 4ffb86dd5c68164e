// The steps that can be undone and redone, in work files: so that they outlive a crash.
//
// {"cursor": n, "arrays": [runs, ...], "objects": [...], "steps": [document with its title, ...]}: arrays and
// objects that several steps share stand there once, steps name them by number. Labels that a cut computes
// again are left out.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "app/document/history.h"
#include "scene/formats/scene_file.h"

namespace splatcut {

inline constexpr std::size_t kMostSavedSteps = 200;

// Steps around the cursor that a file can hold: back to the last one that changed the scene's files, which is
// where undo without those files ends, and on to the next one.
SavedSteps saved_steps(const History& history);

// The steps next to the cursor, as many as their arrays allow: 64 MiB on reading, four million numbers in the
// text.
nlohmann::json history_json(const SavedSteps& history, const Scene& scene);

// At the cursor stands the document itself. Throws Error, or a json::exception where the form is not the
// expected one.
SavedSteps history_from(const nlohmann::json& j, const Scene& scene, const Document& document);

}  // namespace splatcut
