// What is made of a scene once, before the first click: the graph of neighbours and the hierarchy of parts.
// Cost: about 2 s for 300,000 Gaussians on two cores; in the window it runs in the background.
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
#include "segment/graphcut/knn_graph.h"
#include "segment/superpoints/observing_views.h"
#include "segment/superpoints/part_hierarchy.h"

namespace splatcut {

// Where scenes once prepared are kept, see prepared_cache.h. The result is the same bits.
struct PreparedCache {
  std::filesystem::path folder;  // empty: nowhere
  std::uintmax_t most_bytes = 2'000'000'000;
};

struct PrepareOptions {
  KnnOptions graph;
  ObservingOptions observing;
  PartModel model;
  bool with_parts = true;  // they are not needed where masks come from pixels
  PreparedCache cache;
};

struct PreparedScene {
  FlowGraph graph;
  PartHierarchy parts;
  PartModel model;  // that parts were made by, and that says what clicks mean
  std::vector<StageTime> stages;
  bool from_cache = false;
};

// reference: a view from where the scene is looked at; given: cameras of its photographs, may be empty.
// Cancelled: the result is incomplete and must not be used.
PreparedScene prepare_scene(const GaussianCloud& cloud, const Camera& reference, const glm::vec3& up_world,
                            std::span<const Camera> given, const PrepareOptions& options = {},
                            const Job& job = {});

}  // namespace splatcut
