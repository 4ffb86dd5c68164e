// A synthetic still life with the true label of every Gaussian: the first scene a new user sees, and the
// known answer the segmentation is tested against.
//
// World: scene units, y DOWN as in most captures (COLMAP style), so up is (0, -1, 0); the table top is the
// plane y = 0, centred on the origin; x to the right and z away from the first camera. Gaussians are flat
// discs on the surfaces with baked soft light; degree 1 and above of the SH carries a slight highlight.
// Cameras: 24 on a circle, 1008 x 756, alternating between two elevations, all looking at the table centre.
//
// Deterministic: the same options give the same bytes. Cost: linear in the Gaussians.
// Throws Error for sh_degree outside 0..3, thin_width_scale not in (0, 10], or an object that it does not
// have.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "core/job.h"
#include "scene/camera/camera.h"
#include "scene/cloud/gaussian_cloud.h"

namespace splatcut {

struct StillLifeOptions {
  std::size_t gaussians = 200000;  // exact count, everything included, but for what the last two leave out
  std::uint64_t seed = 1;          // sampling, variation and row order
  bool straddling = false;         // adds large splats across the lines where objects meet
  bool skirts = false;             // adds splats of each object just under what it stands on, hidden by it
  bool floaters = false;           // adds faint blobs in the air, labelled background
  bool unseen_interior = false;    // adds splats of arbitrary colour inside mug, fruit, pot and books
  bool twins = false;              // adds an identical apple with a label of its own, "apple twin"
  bool occluder = false;           // adds a standing picture board in front of the mug, label "board"
  bool low_contrast = false;       // mug, apple and pot take the colour of the table
  bool contact = false;            // the apple touches the mug and the orange touches the apple
  float thin_width_scale = 1;      // width of leaves, handle, stems and cable
  int sh_degree = 1;               // 0..3
  bool hidden_missing = false;     // leaves out what no camera sees, as training does
  std::string without;  // a label_name: leaves out that object and its shade, all else in its place
};

struct LabelledScene {
  GaussianCloud cloud;
  std::vector<std::uint8_t> label;  // per Gaussian, index into label_name; 0 is table, wall and floor
  std::vector<std::uint8_t> own;    // per Gaussian, 1 = on a surface of its object; 0 = one of the additions
  std::vector<std::string> label_name;  // background, mug, apple, orange, plant, pot, books, lamp, ...
  std::vector<Camera> cameras;
  struct SeedClick {
    std::string object;  // a label_name
    int camera;          // index into cameras
    glm::vec2 pixel;     // where a user would click, in that camera
  };
  std::vector<SeedClick> seeds;  // one per object that some camera sees; none for the background
};

// Cancelled: unspecified.
LabelledScene make_still_life(const StillLifeOptions& options, const Job& job = {});

}  // namespace splatcut
