#include "app/document/scene_graph.h"

#include "core/error.h"

namespace splatcut {

const FlowGraph& SceneGraph::get(const Job& job) {
  const std::lock_guard lock(mutex_);
  if (graph_) return *graph_;
  job.progress("neighbours", 0);
  FlowGraph made = knn_graph(*cloud_, {}, job);
  if (job.cancelled()) throw Error("neighbours", "are not known: the search for them was cancelled");
  graph_ = std::move(made);
  return *graph_;
}

}  // namespace splatcut
