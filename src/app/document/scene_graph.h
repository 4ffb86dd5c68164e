// The nearest neighbours of all Gaussians of a scene, made when an edit first asks for them.
//
// Cutting needs no such graph, only growing, flooding and the search for floaters do. Any thread may ask; the
// others wait for the one that builds it. Cost: some 2 us a Gaussian, once.
#pragma once

#include <memory>
#include <mutex>
#include <optional>

#include "core/job.h"
#include "segment/graphcut/knn_graph.h"

namespace splatcut {

class SceneGraph {
 public:
  explicit SceneGraph(std::shared_ptr<const GaussianCloud> cloud) : cloud_(std::move(cloud)) {}

  // Throws Error if cancelled.
  const FlowGraph& get(const Job& job = {});

 private:
  std::shared_ptr<const GaussianCloud> cloud_;
  std::mutex mutex_;
  std::optional<FlowGraph> graph_;
};

}  // namespace splatcut
