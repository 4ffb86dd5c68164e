// Values of a document as they stand in work files: JSON, floats in full precision. What reads throws Error,
// or a json::exception where the form is not the expected one.
#pragma once

#include <glm/glm.hpp>
#include <nlohmann/json_fwd.hpp>

#include "app/document/camera_pose.h"
#include "app/document/document.h"
#include "scene/formats/scene_file.h"

namespace splatcut {

nlohmann::json list(const glm::vec3& v);
glm::vec3 vec3_from(const nlohmann::json& j);
glm::vec3 direction_from(const nlohmann::json& j);  // not of length 0

nlohmann::json camera_json(const Camera& camera);
Camera camera_from(const nlohmann::json& j);

nlohmann::json pose_json(const CameraPose& pose);
CameraPose pose_from(const nlohmann::json& j);

nlohmann::json strokes_json(const Strokes& strokes);
Strokes strokes_from(const nlohmann::json& j);

// [value, run, value, run, ...] over the rows of the scene's file; null for no flags.
nlohmann::json runs_json(const Flags& flags, const Scene& scene);
Flags flags_from(const nlohmann::json& j, const Scene& scene, std::uint8_t most);

}  // namespace splatcut
