// Reads a suite of scenes with truth, as `splatcut-lab eval` takes it.
//
// {"scenes": [{"name", "scene", "cameras"?, "truth": {"labels": FILE, "label": 1} | {"masks": FOLDER},
// "reference":
// {"position","target","up","fov_y_deg","size"} | {"camera": NAME}, "clicks": "robot" | [...],
// "scribbles": [...], "test_views": [as reference]}]}, paths relative to the suite's folder. Clicks are told
// one after the other, scribbles are an answer of their own; one of both is needed.
// "own" beside "labels": a byte a row, 0 for what a perfect capture would not hold.
// "opened": "guessed" (without cameras, as the window opens a scene) or a view as "reference": where the
// scene is opened, when the clicks are made elsewhere. "references": further views in which the object may be
// clicked, each as reference and with "clicks" of its own where the truth of that view is unknown; without
// "reference" the first of them is it.
#pragma once

#include <filesystem>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "app/measure/evaluate.h"
#include "scene/formats/scene_file.h"

namespace splatcut {

// A case and what it points into.
struct LoadedCase {
  Scene scene;
  double load_ms = 0;
  std::string warning;  // a sentence about its cameras, or empty
  EvaluationCase test;
};

// The entries of the suite, checked for their form. Throws Error naming file and entry.
std::vector<nlohmann::json> read_suite(const std::filesystem::path& path);

// Throws Error for a name that option asks for and no scene of a suite has.
void refuse_unknown(const std::string& option, const std::vector<std::string>& asked,
                    const std::vector<std::string>& scenes);

// Scene, cameras and truth of one entry. prepare: of its sessions.
std::unique_ptr<LoadedCase> load_case(const nlohmann::json& entry, const std::filesystem::path& folder,
                                      const PrepareOptions& prepare, const Job& job);

}  // namespace splatcut
