// Scenes far from 0, 0, 0, as positions on a map are: what is taken off them so that 32 bits hold the rest.
// Internal to src/scene/formats.
#pragma once

#include <glm/glm.hpp>
#include <string>

#include "scene/formats/scene_file.h"

namespace splatcut {

// Scene::origin, whole scene units, for a cloud whose positions were in double and are rounded: see
// LoadOptions. 0 where nothing is to be taken off.
glm::dvec3 far_origin(const GaussianCloud& cloud);

// Takes the origin of another scene off positions in 32 bits.
void take_off(const glm::dvec3& origin, Scene* scene);

// A sentence where 32 bits round positions by more than a tenth of the middle Gaussian's size; else empty.
std::string rounded_positions(const GaussianCloud& cloud);

std::string spoken(const glm::dvec3& origin);  // "500000, 0, 4500000"

}  // namespace splatcut
