// The scenes that the benchmarks measure on; each is made once and kept.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <vector>

#include "scene/camera/camera.h"
#include "scene/cloud/gaussian_cloud.h"

namespace splatcut::bench {

struct BenchScene {
  GaussianCloud cloud;            // Morton order
  Camera view;                    // 1280x720
  std::vector<Camera> cameras;    // around the scene, 400x300; none for a volume
  std::vector<std::uint8_t> mug;  // per Gaussian of the still life: 1 = the mug
};

// Surfaces as in a trained scene: the still life, SH degree 1.
const BenchScene& still_life(std::size_t gaussians);

// Splats spread through a cube, half of them faint: more overlap per pixel than any trained scene has.
const BenchScene& volume(std::size_t gaussians);

// A scene file, seen from where its middle fills the picture, up = -y.
const BenchScene& scene_from_file(const std::filesystem::path& path);

}  // namespace splatcut::bench
