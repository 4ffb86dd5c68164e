// The published benchmarks as their authors release them, as cases to evaluate.
//
// NVOS (Ren et al., Neural Volumetric Object Selection, CVPR 2022). LABELS is its labels/llff, or labels, or
// what holds labels:
//   reference_image/TASK/NAME.JPG               only its name counts: the camera in which the scribbles are
//   drawn scribbles/TASK/pos_*.png and neg_*.png      half as bright as the brightest and more is drawn;
//   other files not looked at masks/TASK/NAME_mask.png                    the truth in the camera NAME, which
//   is scored
// SPIn-NeRF (Mirzaei et al., CVPR 2023). MASKS is its Multiview-Segmentation-Data, or one scene of it:
//   SCENE/NAME.png                              or in SCENE/label, mask, masks, X_mask, X_masks, or
//   SCENE/images_N/label;
//                                               NAME_cutout.png and NAME_pseudo.png are not looked at;
//                                               NAME_mask.png is NAME.
//   The first by name is given, the others are scored. "SCENE (data set)" is SCENE. Masks with 1 for the
//   object are taken. NAME is a camera, 0_CAMERA or 1_CAMERA (Lego, Truck), or imageNNN: the NNN-th camera by
//   name (orchids, fern, ...).
// The reconstructions: SCENES/TASK, TASK_undistort, or for "horns_left" also horns: a folder with
// point_cloud/ iteration_N/point_cloud.ply (the last N) or one scene file, and cameras.json, sparse/0, sparse
// or transforms.json. Where there is one task, SCENES may be that folder itself. Names in either case. Masks
// and scribbles may have any size of their camera's aspect ratio (to 1 %). Throws Error naming the file.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "app/lab/eval_suite.h"

namespace splatcut {

struct BenchmarkTask {
  std::string name;
  std::filesystem::path scene, cameras;
  std::string reference;                                  // a picture's name without ending
  std::vector<std::filesystem::path> positive, negative;  // scribbles in the reference, or none ...
  std::filesystem::path reference_mask;                   // ... where this is given
  std::vector<std::filesystem::path> masks;               // truth, scored
};

std::vector<BenchmarkTask> nvos_tasks(const std::filesystem::path& labels,
                                      const std::filesystem::path& scenes);
std::vector<BenchmarkTask> spin_nerf_tasks(const std::filesystem::path& masks,
                                           const std::filesystem::path& scenes);

// With strokes in test.clicks (NVOS) or test.reference_truth (SPIn-NeRF).
std::unique_ptr<LoadedCase> load_task(const BenchmarkTask& task, const PrepareOptions& prepare,
                                      const Job& job);

}  // namespace splatcut
