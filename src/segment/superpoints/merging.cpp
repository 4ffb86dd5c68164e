#include "segment/superpoints/merging.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

namespace splatcut {

namespace {

// What two parts share: sums over the edges between them, each weighted with its length.
struct Border {
  float length = 0, colour = 0, concave = 0, convex = 0, normal = 0, gap = 0;
  std::array<std::uint32_t, 2> part{};   // on its two sides
  std::array<std::uint32_t, 2> place{};  // where it stands in their lists

  void add(const SurfaceEdge& e, const MergingOptions& o) {
    length += e.length;
    colour += e.length * e.colour;
    concave += e.length * std::max(0.0f, e.concavity);
    convex += e.length * std::max(0.0f, -e.concavity);
    normal += e.length * e.normal;
    gap += e.length * std::min(o.gap_most, o.gap_unit * e.gap);
  }
  void add(const Border& b) {
    length += b.length;
    colour += b.colour;
    concave += b.concave;
    convex += b.convex;
    normal += b.normal;
    gap += b.gap;
  }
  std::size_t side_of(std::uint32_t p) const { return part[0] == p ? 0 : 1; }
  std::uint32_t beyond(std::uint32_t p) const { return part[0] == p ? part[1] : part[0]; }
};

struct Part {
  float area = 0, perimeter = 0;
  glm::vec3 colour{0};                 // times area
  std::vector<std::uint32_t> borders;  // indices, in an order that follows from the input
  bool alive = true;
};

struct MergeStep {
  float cost;
  std::uint32_t a, b;
  // Ties go to the lower indices, so that the order does not depend on the heap.
  bool operator<(const MergeStep& o) const { return std::tie(cost, a, b) > std::tie(o.cost, o.a, o.b); }
};

class Merging {
 public:
  Merging(const MergingInput& in, const MergingOptions& options, float noise, std::uint64_t tree);
  PartTree run(const Job& job);

 private:
  float difference(const Part& a, const Part& b, const Border& border) const;
  float cost(std::uint32_t a, std::uint32_t b, const Border& border, float difference) const;
  void list(std::uint32_t border, std::uint32_t part, std::size_t side);
  void unlist(std::uint32_t border, std::uint32_t part);
  std::uint32_t merge(std::uint32_t a, std::uint32_t b);
  void add_node(std::uint32_t part, std::array<std::uint32_t, 2> children, float merge_cost);

  const MergingOptions options_;
  const float noise_;
  const std::uint64_t tree_;
  std::vector<Part> parts_;
  std::vector<Border> borders_;
  std::vector<std::uint32_t> shared_;  // per part, its border with the part that merges; kNone in between
  std::vector<MergeStep> heap_;        // with steps of parts that are merged by now
  float median_area_ = 1;
  PartTree out_;
};

Merging::Merging(const MergingInput& in, const MergingOptions& options, float noise, std::uint64_t tree)
    : options_(options), noise_(noise), tree_(tree), borders_(in.borders.leaves.size()) {
  parts_.reserve(2 * in.leaves.count);
  parts_.resize(in.leaves.count);
  shared_.assign(2 * in.leaves.count, LeafBorders::kNone);
  const SurfaceFeatures& f = in.features;
  for (std::size_t i = 0; i < f.core.size(); ++i) {
    Part& part = parts_[in.leaves.of[i]];
    const float area = f.spacing[i] * f.spacing[i];
    part.area += area;
    part.colour += area * f.colour[i];
  }
  for (std::size_t i = 0; i < in.edges.size(); ++i) {
    const SurfaceEdge& e = in.edges[i];
    if (in.borders.of_edge[i] == LeafBorders::kNone) continue;
    borders_[in.borders.of_edge[i]].add(e, options_);
    parts_[in.leaves.of[e.a]].perimeter += e.length;
    parts_[in.leaves.of[e.b]].perimeter += e.length;
  }
  for (std::uint32_t b = 0; b < borders_.size(); ++b)
    for (std::size_t side = 0; side < 2; ++side) list(b, in.borders.leaves[b][side], side);
  std::vector<float> areas;
  for (const Part& part : parts_) areas.push_back(part.area);
  if (!areas.empty()) {
    std::ranges::nth_element(areas, areas.begin() + std::ssize(areas) / 2);
    median_area_ = std::max(areas[areas.size() / 2], kTiny);
  }
}

float Merging::difference(const Part& a, const Part& b, const Border& border) const {
  const float colour = glm::length(a.colour / std::max(a.area, kTiny) - b.colour / std::max(b.area, kTiny));
  const float length = std::max(border.length, kTiny);
  return options_.base + options_.border_colour * border.colour / length + options_.region_colour * colour +
         options_.concavity * std::max(0.0f, border.concave - options_.convexity * border.convex) / length +
         options_.normal * border.normal / length + options_.gap * border.gap / length;
}

float Merging::cost(std::uint32_t ia, std::uint32_t ib, const Border& border, float difference) const {
  const Part &a = parts_[ia], &b = parts_[ib];
  const float area = std::max(std::min(a.area, b.area) / median_area_, 1e-6f);
  const float shared =
      std::clamp(border.length / std::max(std::min(a.perimeter, b.perimeter), kTiny), 1e-6f, 1.0f);
  const float cost =
      difference * std::pow(area, options_.area_power) / std::pow(shared, options_.border_power);
  if (noise_ == 0) return cost;
  CounterRng rng(kTreeSeed + tree_, (std::uint64_t{std::min(ia, ib)} << 32) + std::max(ia, ib));
  return cost * std::exp(noise_ * spread(rng));
}

void Merging::list(std::uint32_t border, std::uint32_t part, std::size_t side) {
  borders_[border].part[side] = part;
  borders_[border].place[side] = static_cast<std::uint32_t>(parts_[part].borders.size());
  parts_[part].borders.push_back(border);
}

void Merging::unlist(std::uint32_t border, std::uint32_t part) {
  std::vector<std::uint32_t>& listed = parts_[part].borders;
  const std::uint32_t place = borders_[border].place[borders_[border].side_of(part)];
  Border& last = borders_[listed.back()];
  last.place[last.side_of(part)] = place;
  listed[place] = listed.back();
  listed.pop_back();
}

// The new part takes over the longer list of borders.
std::uint32_t Merging::merge(std::uint32_t a, std::uint32_t b) {
  const auto c = static_cast<std::uint32_t>(parts_.size());
  parts_.emplace_back();
  if (parts_[a].borders.size() < parts_[b].borders.size()) std::swap(a, b);
  Part &pa = parts_[a], &pb = parts_[b], &pc = parts_[c];
  for (const std::uint32_t i : pa.borders) shared_[borders_[i].beyond(a)] = i;
  const std::uint32_t between = shared_[b];
  pc.area = pa.area + pb.area;
  pc.colour = pa.colour + pb.colour;
  pc.perimeter = pa.perimeter + pb.perimeter - 2 * borders_[between].length;
  unlist(between, a);
  unlist(between, b);
  pc.borders = std::move(pa.borders);
  for (const std::uint32_t i : pc.borders) borders_[i].part[borders_[i].side_of(a)] = c;
  for (const std::uint32_t i : pb.borders) {
    const std::uint32_t other = borders_[i].beyond(b), both = shared_[other];
    if (both == LeafBorders::kNone) {
      list(i, c, borders_[i].side_of(b));
      continue;
    }
    borders_[both].add(borders_[i]);
    unlist(i, other);
  }
  for (const std::uint32_t i : pc.borders) shared_[borders_[i].beyond(c)] = LeafBorders::kNone;
  shared_[b] = LeafBorders::kNone;
  pb.borders = {};
  pa.alive = pb.alive = false;
  return c;
}

// Its cut is the border towards everything around, little where that is unlike. Offers it to the parts before
// it; a merged part comes after all others.
void Merging::add_node(std::uint32_t p, std::array<std::uint32_t, 2> children, float merge_cost) {
  const Part& part = parts_[p];
  float cut = 0;
  for (const std::uint32_t i : part.borders) {
    const Border& border = borders_[i];
    const std::uint32_t other = border.beyond(p);
    const float unlike = difference(part, parts_[other], border);
    cut += border.length * std::exp(-unlike / options_.cut_scale);
    if (other > p) continue;
    heap_.push_back({cost(other, p, border, unlike), other, p});
    std::push_heap(heap_.begin(), heap_.end());
  }
  out_.parent.push_back(kNoPart);
  out_.children.push_back(children);
  out_.area.push_back(part.area);
  out_.cut.push_back(cut);
  out_.merge_cost.push_back(merge_cost);
  for (const std::uint32_t child : children)
    if (child != kNoPart) out_.parent[child] = p;
}

PartTree Merging::run(const Job& job) {
  const auto leaves = static_cast<std::uint32_t>(parts_.size());
  for (std::uint32_t p = 0; p < leaves; ++p) add_node(p, {kNoPart, kNoPart}, 0);
  while (!heap_.empty() && !job.cancelled()) {
    std::pop_heap(heap_.begin(), heap_.end());
    const MergeStep best = heap_.back();
    heap_.pop_back();
    if (!parts_[best.a].alive || !parts_[best.b].alive) continue;
    add_node(merge(best.a, best.b), {best.a, best.b}, best.cost);
  }
  return std::move(out_);
}

}  // namespace

LeafBorders leaf_borders(const Superpoints& leaves, std::span<const SurfaceEdge> edges) {
  LeafBorders out;
  out.of_edge.assign(edges.size(), LeafBorders::kNone);
  // Edges by their lower leaf, each list in the order of the edges.
  std::vector<std::uint32_t> first(leaves.count + 1, 0), listed(edges.size());
  const auto sides = [&](const SurfaceEdge& e) { return std::minmax(leaves.of[e.a], leaves.of[e.b]); };
  for (const SurfaceEdge& e : edges) ++first[sides(e).first + 1];
  std::partial_sum(first.begin(), first.end(), first.begin());
  std::vector<std::uint32_t> next(first.begin(), first.end() - 1);
  for (std::uint32_t i = 0; i < edges.size(); ++i) listed[next[sides(edges[i]).first]++] = i;
  std::vector<std::uint32_t> known(leaves.count, LeafBorders::kNone);  // the border with each leaf beyond
  for (std::uint32_t a = 0; a < leaves.count; ++a) {
    const auto begin = static_cast<std::uint32_t>(out.leaves.size());
    for (std::uint32_t l = first[a]; l < first[a + 1]; ++l) {
      const std::uint32_t b = sides(edges[listed[l]]).second;
      if (a == b) continue;
      if (known[b] == LeafBorders::kNone || known[b] < begin) {
        known[b] = static_cast<std::uint32_t>(out.leaves.size());
        out.leaves.push_back({a, b});
      }
      out.of_edge[listed[l]] = known[b];
    }
  }
  return out;
}

PartTree merged_tree(const MergingInput& in, const MergingOptions& options, float noise, std::uint64_t tree,
                     const Job& job) {
  return Merging(in, options, noise, tree).run(job);
}

}  // namespace splatcut
