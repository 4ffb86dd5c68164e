// What rounding does to positions, in units of the Gaussians that stand there.
#pragma once

#include <functional>
#include <span>
#include <string>

#include "scene/cloud/gaussian_cloud.h"

namespace splatcut {

constexpr float kVisibly = 0.5f;  // sizes: less is lost among the Gaussian's neighbours

// Clause on Gaussians that move by more than so many times their size (of their largest axis, one sigma);
// empty where none does, or where less than a thousandth does and none by ten sizes. read_back: where a
// file's reader will see the i-th of them; it is called on several threads.
std::string moved_far(const GaussianCloud& cloud, std::span<const std::uint32_t> gaussians, float sizes,
                      const std::function<glm::vec3(std::size_t i)>& read_back);

}  // namespace splatcut
