#include "segment/superpoints/part_hierarchy.h"

#include <algorithm>
#include <cmath>

#include <tbb/parallel_for.h>

#include "core/counter_rng.h"
#include "segment/graphcut/k_nearest.h"
#include "segment/superpoints/merging.h"
#include "segment/superpoints/superpoints.h"

namespace splatcut {

namespace {

MergingOptions jittered(MergingOptions options, float jitter, CounterRng rng) {
  for (float* weight :
       {&options.base, &options.border_colour, &options.region_colour, &options.concavity, &options.convexity,
        &options.normal, &options.gap, &options.area_power, &options.border_power})
    *weight *= std::exp(jitter * spread(rng));
  return options;
}

std::vector<glm::vec3> shade_blind(std::vector<glm::vec3> colour, float lightness) {
  for (glm::vec3& c : colour) {
    const float grey = (c.x + c.y + c.z) / 3;
    c += glm::vec3((lightness - 1) * grey);
  }
  return colour;
}

void describe_leaves(const SurfaceFeatures& f, const Superpoints& leaves, PartHierarchy* out) {
  out->leaf_centre_world.assign(leaves.count, glm::vec3(0));
  out->leaf_area.assign(leaves.count, 0);
  // Areas in a unit, a power of two, in which area times position stays in range.
  const float widest = f.spacing.empty() ? 0 : std::ranges::max(f.spacing);
  const float unit = widest > 0 ? std::exp2(-static_cast<float>(std::ilogb(widest))) : 1.0f;
  for (std::size_t i = 0; i < f.core.size(); ++i) {
    const float area = (unit * f.spacing[i]) * (unit * f.spacing[i]);
    out->leaf_area[leaves.of[i]] += area;
    out->leaf_centre_world[leaves.of[i]] += area * f.position_world[i];
  }
  for (std::uint32_t l = 0; l < leaves.count; ++l) {
    out->leaf_centre_world[l] /= std::max(out->leaf_area[l], kTiny);
    out->leaf_area[l] /= unit * unit;
  }
}

// A Gaussian outside of the core joins the leaf of most of its nearest core Gaussians; ties go to the
// nearest.
void attach_others(const GaussianCloud& cloud, const SurfaceFeatures& f, const Superpoints& leaves, int votes,
                   const Job& job, PartHierarchy* out) {
  out->leaf_of.assign(cloud.size(), kNoPart);
  for (std::size_t i = 0; i < f.core.size(); ++i) out->leaf_of[f.core[i]] = leaves.of[i];
  if (f.core.empty()) return;
  std::vector<glm::vec3> others;
  std::vector<std::uint32_t> index;
  for (std::uint32_t g = 0; g < cloud.size(); ++g)
    if (out->leaf_of[g] == kNoPart) {
      others.push_back(cloud.position[g]);
      index.push_back(g);
    }
  const auto k = std::min<std::size_t>(static_cast<std::size_t>(votes), f.core.size());
  const std::vector<std::uint32_t> nearest = k_nearest_of(f.position_world, others, k, job);
  if (job.cancelled()) return;
  for (std::size_t i = 0; i < others.size(); ++i) {
    std::uint32_t best = kNoPart;
    std::ptrdiff_t most = 0;
    const auto list = std::span(nearest).subspan(i * k, k);
    const auto leaf = [&](std::uint32_t core) { return leaves.of[core]; };
    for (const std::uint32_t core : list) {
      const auto count = std::ranges::count(list, leaf(core), leaf);
      if (count > most) {
        most = count;
        best = leaf(core);
      }
    }
    out->leaf_of[index[i]] = best;
  }
}

}  // namespace

PartHierarchy build_part_hierarchy(const GaussianCloud& cloud, const SurfaceFeatures& features,
                                   const PartOptions& options, const Job& job) {
  PartHierarchy out;
  if (job.cancelled()) return out;
  const std::vector<SurfaceEdge> edges = surface_edges(cloud, features);
  const Superpoints leaves = superpoints(features, edges, options.superpoints);
  job.progress("parts", 0.5);
  out.leaves = leaves.count;
  out.trees.resize(static_cast<std::size_t>(std::max(1, options.trees)));
  describe_leaves(features, leaves, &out);
  SurfaceFeatures blind;
  std::vector<SurfaceEdge> blind_edges;
  if (options.shade_blind_trees > 0) {
    blind.core = features.core;
    blind.spacing = features.spacing;
    blind.colour = shade_blind(features.colour, options.lightness);
    blind_edges = edges;
    for (SurfaceEdge& e : blind_edges) e.colour = glm::length(blind.colour[e.a] - blind.colour[e.b]);
    out.trees.resize(out.trees.size() + static_cast<std::size_t>(options.shade_blind_trees));
  }
  out.plain_trees = static_cast<std::size_t>(std::max(1, options.trees));
  const LeafBorders borders = leaf_borders(leaves, edges);
  tbb::parallel_for(std::size_t{0}, out.trees.size(), [&](std::size_t t) {
    const bool shaded = t < out.plain_trees, first = t == 0 || t == out.plain_trees;
    const MergingOptions merging =
        first ? options.merging : jittered(options.merging, options.jitter, CounterRng(kTreeSeed, t));
    out.trees[t] = merged_tree({shaded ? features : blind, shaded ? edges : blind_edges, leaves, borders},
                               merging, first ? 0 : options.noise, t, job);
  });
  job.progress("parts", 0.7);
  attach_others(cloud, features, leaves, options.votes, job, &out);
  return out;
}

PartHierarchy build_part_hierarchy(const GaussianCloud& cloud, std::span<const Camera> observing,
                                   const PartOptions& options, const Job& job) {
  job.progress("parts", 0);
  // Each view is drawn twice, and projected once while all of them fit.
  constexpr std::size_t kMostBytes = std::size_t{512} << 20, kBytesAGaussian = 100;
  KeptViews kept(cloud, kMostBytes);
  const bool fit = cloud.size() * observing.size() * kBytesAGaussian <= kMostBytes;
  const Drawer drawer(cloud, fit ? &kept : nullptr);
  const SurfaceFeatures features = surface_features(drawer, observing, options.surface, job);
  job.progress("parts", 0.3);
  PartHierarchy parts = build_part_hierarchy(cloud, features, options, job);
  job.progress("parts", 0.8);
  look_at_parts(drawer, observing, &parts, job);
  job.progress("parts", 1);
  return parts;
}

}  // namespace splatcut
