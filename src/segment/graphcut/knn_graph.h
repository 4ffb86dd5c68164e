// The k-nearest-neighbour graph of the Gaussians' centres, symmetrised, as a flow graph.
// Edge {g, h} exists if g or h is among the k nearest of the other; each edge once. Depends on the cloud
// alone: built once per scene. k-d tree by nanoflann, queries on all cores, same graph on any number of
// threads. Cost: about n log n; fast in Morton order, as neighbouring queries share nodes of the tree.
#pragma once

#include "core/job.h"
#include "scene/cloud/gaussian_cloud.h"
#include "segment/graphcut/max_flow.h"

namespace splatcut {

struct KnnOptions {
  int neighbours = 10;  // k < 255, without the point itself
};

FlowGraph knn_graph(const GaussianCloud& cloud, const KnnOptions& options = {}, const Job& job = {});

}  // namespace splatcut
