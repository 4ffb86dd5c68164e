#include "segment/superpoints/part_hierarchy.h"

#include <algorithm>
#include <cmath>
#include <queue>
#include <unordered_map>

#include <tbb/parallel_for.h>

#include "core/counter_rng.h"
#include "segment/graphcut/k_nearest.h"
#include "segment/superpoints/superpoints.h"

namespace splatcut {

namespace {

constexpr std::uint64_t kTreeSeed = 20241;
constexpr float kTiny = 1e-30f;  // less than any area or length of a scene

// A number of mean 0 and variance 1.
float spread(CounterRng& rng) {
  return rng.between(-1.7320508f, 1.7320508f);
}

MergingOptions jittered(MergingOptions options, float jitter, CounterRng rng) {
  for (float* weight :
       {&options.base, &options.border_colour, &options.region_colour, &options.concavity, &options.convexity,
        &options.normal, &options.gap, &options.area_power, &options.border_power})
    *weight *= std::exp(jitter * spread(rng));
  return options;
}

// Sums over the edges between two parts, each weighted with its length.
struct Link {
  float length = 0, colour = 0, concave = 0, convex = 0, normal = 0, gap = 0;

  void add(const SurfaceEdge& e, const MergingOptions& o) {
    length += e.length;
    colour += e.length * e.colour;
    concave += e.length * std::max(0.0f, e.concavity);
    convex += e.length * std::max(0.0f, -e.concavity);
    normal += e.length * e.normal;
    gap += e.length * std::min(o.gap_most, o.gap_unit * e.gap);
  }
  void add(const Link& l) {
    length += l.length;
    colour += l.colour;
    concave += l.concave;
    convex += l.convex;
    normal += l.normal;
    gap += l.gap;
  }
};

struct Part {
  float area = 0, perimeter = 0;
  glm::vec3 colour{0};  // times area
  std::unordered_map<std::uint32_t, Link> links;
  bool alive = true;
};

struct MergeStep {
  float cost;
  std::uint32_t a, b;
  // Ties go to the lower indices, so that the order does not depend on the queue.
  bool operator<(const MergeStep& o) const { return std::tie(cost, a, b) > std::tie(o.cost, o.a, o.b); }
};

class Merging {
 public:
  Merging(const SurfaceFeatures& f, std::span<const SurfaceEdge> edges, const Superpoints& leaves,
          const MergingOptions& options, float noise, std::uint64_t tree);
  PartTree run(const Job& job);

 private:
  float difference(const Part& a, const Part& b, const Link& l) const;
  float cost(std::uint32_t a, std::uint32_t b, const Link& l) const;
  float cut_of(const Part& part) const;
  std::uint32_t merge(std::uint32_t a, std::uint32_t b);

  const MergingOptions options_;
  const float noise_;
  const std::uint64_t tree_;
  std::vector<Part> parts_;
  float median_area_ = 1;
};

Merging::Merging(const SurfaceFeatures& f, std::span<const SurfaceEdge> edges, const Superpoints& leaves,
                 const MergingOptions& options, float noise, std::uint64_t tree)
    : options_(options), noise_(noise), tree_(tree), parts_(leaves.count) {
  for (std::size_t i = 0; i < f.core.size(); ++i) {
    Part& part = parts_[leaves.of[i]];
    const float area = f.spacing[i] * f.spacing[i];
    part.area += area;
    part.colour += area * f.colour[i];
  }
  for (const SurfaceEdge& e : edges) {
    const std::uint32_t a = leaves.of[e.a], b = leaves.of[e.b];
    if (a == b) continue;
    parts_[a].links[b].add(e, options_);
    parts_[b].links[a].add(e, options_);
    parts_[a].perimeter += e.length;
    parts_[b].perimeter += e.length;
  }
  std::vector<float> areas;
  for (const Part& part : parts_) areas.push_back(part.area);
  if (!areas.empty()) {
    std::ranges::nth_element(areas, areas.begin() + std::ssize(areas) / 2);
    median_area_ = std::max(areas[areas.size() / 2], kTiny);
  }
}

float Merging::difference(const Part& a, const Part& b, const Link& l) const {
  const float colour = glm::length(a.colour / std::max(a.area, kTiny) - b.colour / std::max(b.area, kTiny));
  const float length = std::max(l.length, kTiny);
  return options_.base + options_.border_colour * l.colour / length + options_.region_colour * colour +
         options_.concavity * std::max(0.0f, l.concave - options_.convexity * l.convex) / length +
         options_.normal * l.normal / length + options_.gap * l.gap / length;
}

float Merging::cost(std::uint32_t ia, std::uint32_t ib, const Link& l) const {
  const Part &a = parts_[ia], &b = parts_[ib];
  const float area = std::max(std::min(a.area, b.area) / median_area_, 1e-6f);
  const float shared =
      std::clamp(l.length / std::max(std::min(a.perimeter, b.perimeter), kTiny), 1e-6f, 1.0f);
  const float cost =
      difference(a, b, l) * std::pow(area, options_.area_power) / std::pow(shared, options_.border_power);
  if (noise_ == 0) return cost;
  CounterRng rng(kTreeSeed + tree_, (std::uint64_t{std::min(ia, ib)} << 32) + std::max(ia, ib));
  return cost * std::exp(noise_ * spread(rng));
}

// Border towards everything around, little where that is unlike.
float Merging::cut_of(const Part& part) const {
  float cut = 0;
  for (const auto& [other, link] : part.links)
    cut += link.length * std::exp(-difference(part, parts_[other], link) / options_.cut_scale);
  return cut;
}

std::uint32_t Merging::merge(std::uint32_t a, std::uint32_t b) {
  const auto c = static_cast<std::uint32_t>(parts_.size());
  parts_.emplace_back();
  if (parts_[a].links.size() < parts_[b].links.size()) std::swap(a, b);
  Part &pa = parts_[a], &pb = parts_[b], &pc = parts_[c];
  pc.area = pa.area + pb.area;
  pc.colour = pa.colour + pb.colour;
  pc.perimeter = pa.perimeter + pb.perimeter - 2 * pa.links[b].length;
  pc.links = std::move(pa.links);
  pc.links.erase(b);
  for (const auto& [other, link] : pb.links)
    if (other != a) pc.links[other].add(link);
  for (const auto& [other, link] : pc.links) {
    auto& back = parts_[other].links;
    back.erase(a);
    back.erase(b);
    back[c] = link;
  }
  pa.alive = pb.alive = false;
  pb.links.clear();
  return c;
}

PartTree Merging::run(const Job& job) {
  PartTree out;
  std::priority_queue<MergeStep> queue;
  parts_.reserve(2 * parts_.size());
  const auto offer = [&](std::uint32_t a, std::uint32_t b, const Link& l) {
    queue.push({cost(a, b, l), std::min(a, b), std::max(a, b)});
  };
  const auto leaves = static_cast<std::uint32_t>(parts_.size());
  const auto add_node = [&](std::uint32_t p, std::array<std::uint32_t, 2> children, float merge_cost) {
    out.parent.push_back(kNoPart);
    out.children.push_back(children);
    out.area.push_back(parts_[p].area);
    out.cut.push_back(cut_of(parts_[p]));
    out.merge_cost.push_back(merge_cost);
    for (const std::uint32_t child : children)
      if (child != kNoPart) out.parent[child] = p;
  };
  for (std::uint32_t p = 0; p < leaves; ++p) {
    add_node(p, {kNoPart, kNoPart}, 0);
    for (const auto& [other, link] : parts_[p].links)
      if (p < other) offer(p, other, link);
  }
  while (!queue.empty() && !job.cancelled()) {
    const MergeStep best = queue.top();
    queue.pop();
    if (!parts_[best.a].alive || !parts_[best.b].alive) continue;
    const std::uint32_t c = merge(best.a, best.b);
    add_node(c, {best.a, best.b}, best.cost);
    for (const auto& [other, link] : parts_[c].links) offer(other, c, link);
  }
  return out;
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
  tbb::parallel_for(std::size_t{0}, out.trees.size(), [&](std::size_t t) {
    if (t >= out.plain_trees) {
      const bool first = t == out.plain_trees;
      const MergingOptions merging =
          first ? options.merging : jittered(options.merging, options.jitter, CounterRng(kTreeSeed, t));
      out.trees[t] = Merging(blind, blind_edges, leaves, merging, first ? 0 : options.noise, t).run(job);
      return;
    }
    const MergingOptions merging =
        t ? jittered(options.merging, options.jitter, CounterRng(kTreeSeed, t)) : options.merging;
    out.trees[t] = Merging(features, edges, leaves, merging, t ? options.noise : 0, t).run(job);
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
