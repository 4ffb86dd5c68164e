// Graph of the nearest neighbours of all Gaussians of a scene, built when an edit first asks for it.
//
// Growing, shrinking, flooding, parts and floaters need the graph; cutting does not. Any thread may ask;
// other threads wait for the one that builds it. Cost: some 2 us a Gaussian, once.
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

  // Returns the graph, which the first call builds. Throws Error if cancelled.
  const FlowGraph& get(const Job& job = {});

 private:
  std::shared_ptr<const GaussianCloud> cloud_;
  std::mutex mutex_;
  std::optional<FlowGraph> graph_;
};

}  // namespace splatcut
