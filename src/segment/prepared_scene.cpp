#include "segment/prepared_scene.h"

#include "segment/stage_clock.h"

namespace splatcut {

PreparedScene prepare_scene(const GaussianCloud& cloud, const Camera& reference, const glm::vec3& up_world,
                            std::span<const Camera> given, const PrepareOptions& options, const Job& job) {
  PreparedScene prepared;
  StageClock clock(&prepared.stages);
  job.progress("graph", 0);
  clock.time("graph", [&] { prepared.graph = knn_graph(cloud, options.graph, job); });
  if (!options.with_parts) return prepared;
  job.progress("parts", 0.4);
  clock.time("parts", [&] {
    const auto views = observing_views(cloud, reference, up_world, given, options.observing, job);
    prepared.parts = build_part_hierarchy(cloud, views, options.parts, job);
  });
  return prepared;
}

}  // namespace splatcut
