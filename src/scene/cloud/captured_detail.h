// How finely the parts of a scene were captured: splats are small where cameras were near. Tells the subject
// of a scene that comes without its cameras.
//
// A function of the cloud alone. Cost: some 20 ms, as at most 2^16 Gaussians are looked at.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "scene/cloud/gaussian_cloud.h"

namespace splatcut {

struct CapturedDetail {
  std::vector<glm::vec3> position_world;
  std::vector<double> weight;  // 1 / the middle one of the three standard deviations
  std::size_t size() const { return weight.size(); }
  double total() const;
  void add(const glm::vec3& at_world, double w);
};

struct Ball {
  glm::vec3 centre_world{0};
  float radius = 0;  // scene units; 0: nothing
};

float middle_sigma(const glm::vec3& scale);

// Of an even sample of the Gaussians, without those that are nearly transparent.
CapturedDetail captured_detail(const GaussianCloud& cloud);

// Its centre is the detail's median in each axis, and it holds half of the detail.
Ball middle_half(const CapturedDetail& detail);

}  // namespace splatcut
