// Pieces that a view hides and that touch nothing but the object belong to it: the front of a thing seen from
// behind.
//
// In: k-NN graph, which Gaussians the view shows, labels. A piece is a connected set of unlabelled, hidden
// Gaussians that are not faint. It joins the object where at least least_object of its arcs that leave it
// lead to the object and it is small beside the object. What the view shows stays as the user sees it. Cost:
// linear in the hidden Gaussians near the object; pieces that get too large are given up early.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "scene/cloud/gaussian_cloud.h"
#include "segment/graphcut/flow_graph.h"

namespace splatcut {

struct EnclosedOptions {
  float least_object = 0.9f;  // share of the arcs that leave the piece
  float most_size = 0.25f;    // Gaussians of one piece, share of the object's
  float faint = 0.1f;         // opacity; fainter Gaussians neither join nor connect
  bool operator==(const EnclosedOptions&) const = default;
};

// shown: per Gaussian, 1 = the view shows its part. labels: per Gaussian, 1 = object. Returns how many
// joined.
std::size_t join_enclosed(const GaussianCloud& cloud, const FlowGraph& graph,
                          std::span<const std::uint8_t> shown, const EnclosedOptions& options,
                          std::vector<std::uint8_t>* labels);

}  // namespace splatcut
