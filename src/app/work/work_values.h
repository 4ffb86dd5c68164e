// Values of a document as JSON, for work files. Floats keep their full precision. Functions that read throw
// Error if a value is out of range, and json::exception if the form is not the expected one.
#pragma once

#include <glm/glm.hpp>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <vector>

#include "app/document/camera_pose.h"
#include "app/document/document.h"
#include "app/document/doubtful_side.h"
#include "scene/formats/scene_file.h"

namespace splatcut {

nlohmann::json list(const glm::vec3& v);
glm::vec3 vec3_from(const nlohmann::json& j);
glm::vec3 direction_from(const nlohmann::json& j);  // throws Error for a vector of length 0

nlohmann::json camera_json(const Camera& camera);
Camera camera_from(const nlohmann::json& j);

nlohmann::json pose_json(const CameraPose& pose);
CameraPose pose_from(const nlohmann::json& j);

nlohmann::json strokes_json(const Strokes& strokes);
Strokes strokes_from(const nlohmann::json& j);

// Flags as [value, run, value, run, ...] over the rows of the scene's files; a null pointer is null. most:
// the largest value that a flag may have.
nlohmann::json runs_json(const Flags& flags, const Scene& scene);
// gone: rows of files that the scene lacks now, ascending.
struct GoneRows {
  std::size_t first = 0, count = 0;
};
Flags flags_from(const nlohmann::json& j, const Scene& scene, std::uint8_t most,
                 std::span<const GoneRows> gone = {});

nlohmann::json sides_json(std::span<const DoubtfulSide> sides, const Scene& scene);
std::vector<DoubtfulSide> sides_from(const nlohmann::json& j, const Scene& scene);

}  // namespace splatcut
