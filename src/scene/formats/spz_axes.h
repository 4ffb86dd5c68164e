// Which axes a .spz has that does not say them. Internal to src/scene/formats.
#pragma once

#include <optional>
#include <vector>

#include "scene/formats/scene_file.h"

namespace splatcut {

// The axes in which the cameras see clearly more of a cloud that was read as right, up, back: a quarter more,
// over a sample of both. None where they see about as much either way, as a circle of cameras around the
// origin does.
std::optional<SpzAxes> axes_by_cameras(const GaussianCloud& cloud, const std::vector<Camera>& cameras);

}  // namespace splatcut
