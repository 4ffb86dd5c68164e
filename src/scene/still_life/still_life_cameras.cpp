#include "scene/still_life/still_life_cameras.h"

#include <nlohmann/json.hpp>

#include "core/atomic_file.h"
#include "core/json_file.h"

namespace splatcut {

void save_inria_cameras(const std::filesystem::path& path, const std::vector<Camera>& cameras) {
  nlohmann::json list = nlohmann::json::array();
  for (const Camera& camera : cameras) {
    const glm::mat3& r = camera.camera_from_world_rotation;  // its columns are the rows of world_from_camera
    const glm::vec3 centre = camera.centre_world();
    nlohmann::json rows = nlohmann::json::array();
    for (int i = 0; i < 3; ++i) rows.push_back({r[i].x, r[i].y, r[i].z});
    nlohmann::json entry = {{"id", list.size()},        {"img_name", camera.name},
                            {"width", camera.width_px}, {"height", camera.height_px},
                            {"fx", camera.fx_px},       {"fy", camera.fy_px},
                            {"rotation", rows},         {"position", {centre.x, centre.y, centre.z}}};
    // Inria's own files put the principal point in the middle and do not name it.
    if (camera.cx_px != 0.5f * static_cast<float>(camera.width_px)) entry["cx"] = camera.cx_px;
    if (camera.cy_px != 0.5f * static_cast<float>(camera.height_px)) entry["cy"] = camera.cy_px;
    list.push_back(entry);
  }
  write_text_file(path, json_text(list, 1) + "\n");
}

}  // namespace splatcut
