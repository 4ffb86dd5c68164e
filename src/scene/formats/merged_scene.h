// Several scenes as one, each where its own coordinates put it.
#pragma once

#include <string>
#include <vector>

#include "core/job.h"
#include "scene/formats/scene_file.h"

namespace splatcut {

struct MergedScene {
  // File order: the rows of the first scene, then those of the second, and so on. Its path and format are the
  // first one's; no row is copied from there.
  Scene scene;
  std::string loss;  // empty, or what a file of it cannot say, whatever its format
};

// One scene or more. Spherical harmonics: of the highest degree among them. The mark of antialiased training
// stays where all have it, up is that of the first. Throws Error for more rows together than a row number can
// count. Cancelled: the result is unspecified. Memory: about twice the Gaussians of all.
MergedScene merged(std::vector<Scene> scenes, const Job& job = {});

}  // namespace splatcut
