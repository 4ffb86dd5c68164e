// Several clouds as one: the Gaussians of the first, then those of the second, and so on.
#pragma once

#include <vector>

#include "scene/cloud/gaussian_cloud.h"

namespace splatcut {

// All attributes as they are, file_row included. The degree of the spherical harmonics is the highest among
// the clouds; coefficients that a cloud lacks are zero, which is the same colour in every direction. The near
// plane is the first one's. A cloud is freed once it was copied. No cloud: an empty one.
GaussianCloud joined(std::vector<GaussianCloud> clouds);

}  // namespace splatcut
