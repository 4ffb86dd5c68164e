// What is made of Gaussians before the first click on them: the hierarchy of parts.
#pragma once

#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <span>
#include <string>
#include <vector>

#include "core/job.h"
#include "core/stage_clock.h"
#include "scene/camera/camera.h"
#include "scene/cloud/gaussian_cloud.h"
#include "segment/superpoints/observing_views.h"
#include "segment/superpoints/part_hierarchy.h"

namespace splatcut {

// Where scenes once prepared are kept, see prepared_cache.h. The result is the same bits.
struct PreparedCache {
  std::filesystem::path folder;  // empty: nowhere
  std::uintmax_t most_bytes = 2'000'000'000;
  std::uintmax_t most_bytes_of_scene = 1'000'000'000;  // so that no scene pushes all others out
  std::uint64_t scene = 0;  // which one its neighbourhoods belong to, for that limit
};

struct PrepareOptions {
  ObservingOptions observing;
  PartModel model;
  PreparedCache cache;
};

struct PreparedScene {
  PartHierarchy parts;
  PartModel model;  // that parts were made by, and that says what clicks mean
  std::vector<StageTime> stages;
  bool from_cache = false;
};

// observing: small views of the scene, see observing_views.h. Cancelled: the result is incomplete and must
// not be used.
PreparedScene prepare_scene(const GaussianCloud& cloud, std::span<const Camera> observing,
                            const PrepareOptions& options = {}, const Job& job = {});

}  // namespace splatcut
