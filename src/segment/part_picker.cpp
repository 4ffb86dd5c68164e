#include "segment/part_picker.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "segment/mask_tools.h"

namespace splatcut {

namespace {

std::vector<std::uint32_t> ancestors(const PartTree& tree, std::uint32_t leaf) {
  std::vector<std::uint32_t> chain;
  for (std::uint32_t node = leaf; node != kNoPart; node = tree.parent[node]) chain.push_back(node);
  return chain;
}

constexpr std::uint32_t kNoLevel = 0xffffffffu;

// Per leaf: the index in `chain` from which on the chain's nodes hold it; kNoLevel for none.
std::vector<std::uint32_t> levels(const PartTree& tree, std::size_t leaves,
                                  std::span<const std::uint32_t> chain) {
  std::vector<std::uint32_t> level(tree.nodes(), kNoLevel);
  for (std::size_t i = 0; i < chain.size(); ++i) level[chain[i]] = static_cast<std::uint32_t>(i);
  for (std::size_t node = tree.nodes(); node-- > 0;)  // parents before their children
    if (level[node] == kNoLevel && tree.parent[node] != kNoPart) level[node] = level[tree.parent[node]];
  level.resize(leaves);
  return level;
}

std::uint32_t leaf_near(const PartView& view, const glm::vec2& pixel, int radius_px) {
  const int cx = static_cast<int>(pixel.x), cy = static_cast<int>(pixel.y);
  std::uint32_t best = kNoPart;
  int nearest = std::numeric_limits<int>::max();
  for (int y = cy - radius_px; y <= cy + radius_px; ++y)
    for (int x = cx - radius_px; x <= cx + radius_px; ++x) {
      if (!view.leaf.contains(x, y) || view.leaf.at(x, y) == kNoPart) continue;
      const int d2 = (x - cx) * (x - cx) + (y - cy) * (y - cy);
      if (d2 < nearest) {
        nearest = d2;
        best = view.leaf.at(x, y);
      }
    }
  return best;
}

// One tree's answers to a click.
struct Proposals {
  std::vector<std::uint32_t> chain;  // candidates, from small to large
  std::vector<std::uint32_t> level;  // per leaf
  std::vector<float> changed_px;     // per candidate
  std::vector<float> changed_area;   // per candidate, what the view hides included; scene units squared
  std::vector<float> stability;      // per candidate: mean over the other trees of the best IoU there
};

struct Candidate {
  std::size_t tree = 0, index = 0;  // into that tree's chain
  float odd = 0;                    // less is more likely meant
};

class Picker {
 public:
  Picker(const PartHierarchy& parts, const PartView& view, const PickOptions& options)
      : parts_(parts), view_(view), options_(options) {
    pick_.leaves.assign(parts.leaves, 0);
    for (auto& clicked : clicked_) clicked.resize(parts.trees.size());
    for (std::size_t t = 0; t < parts.trees.size(); ++t)
      for (auto& clicked : clicked_) clicked[t].assign(parts.trees[t].nodes(), 0);
  }

  void apply(const glm::vec2& pixel, SeedLabel label);
  Pick take() { return std::move(pick_); }

 private:
  std::vector<Proposals> proposals(std::uint32_t leaf, bool object) const;
  std::size_t note_first(const std::vector<Proposals>& all, std::span<const Candidate> candidates,
                         const Candidate& best);
  void measure_stability(bool object, std::vector<Proposals>* all) const;
  float log_cut(const PartTree& tree, std::uint32_t node) const;
  float odd_look(std::size_t tree, std::uint32_t node) const;
  float odd_size(float pixels) const;
  float odd_change(float changed_px, float radius_px, float selected_px) const;
  float largest_change(float radius_px, bool object) const;
  float odd_hidden(float changed_px, float changed_area, float selected_area_per_px) const;
  std::vector<float> on_side(std::size_t tree, const std::vector<float>& of_leaves, bool selected) const;
  float selected_sum(const std::vector<float>& of_leaves) const;
  float distance_to_border(const glm::vec2& pixel, bool selected) const;

  const PartHierarchy& parts_;
  const PartView& view_;
  const PickOptions& options_;
  std::vector<std::vector<std::uint32_t>>
      clicked_[2];                    // per sign, tree and node: clicks of that sign that it holds
  std::uint32_t clicks_[2] = {0, 0};  // of that sign
  bool any_ = false;
  Pick pick_;
};

// The border's length over the part's size, scale free; a part that touches nothing has the least.
float Picker::log_cut(const PartTree& tree, std::uint32_t node) const {
  const float size = std::sqrt(std::max(tree.area[node], 1e-30f));
  return std::max(std::log(std::max(tree.cut[node], 1e-30f) / size), options_.least_log_cut);
}

// Less is more like an object.
float Picker::odd_look(std::size_t t, std::uint32_t node) const {
  const PartTree& tree = parts_.trees[t];
  const float own = log_cut(tree, node);
  const std::uint32_t up = tree.parent[node];
  const float rise = up == kNoPart ? 0 : std::clamp(log_cut(tree, up) - own, 0.0f, 10.0f);
  const float jump =
      up == kNoPart
          ? 0
          : std::clamp(std::log(std::max(tree.merge_cost[up], 1e-6f) / std::max(tree.merge_cost[node], 0.1f)),
                       0.0f, 2.0f);
  float look = options_.cut_weight * own - options_.rise_bonus * rise - options_.jump_bonus * jump;
  if (up == kNoPart) look += options_.root_penalty;
  return look + options_.frame_penalty * view_.trees[t].frame_pixels[node] /
                    std::sqrt(std::max(view_.trees[t].pixels[node], 1.0f));
}

float Picker::odd_size(float pixels) const {
  const float share = std::max(pixels, 1.0f) / static_cast<float>(view_.leaf.size());
  return options_.small_penalty * std::max(0.0f, std::log(options_.small_share / share)) +
         options_.large_penalty * std::max(0.0f, std::log(share / options_.large_share));
}

// How far the pixels that would change are from a disc of that radius, and from what is selected now.
float Picker::odd_change(float changed_px, float radius_px, float selected_px) const {
  const float folds = std::log(std::max(changed_px, 1.0f) / (3.14159265f * radius_px * radius_px));
  const float growth = std::log(std::max(changed_px, 1.0f) / std::max(selected_px, 1.0f));
  // The second click may find that the first took a crumb; what two clicks have made is not outgrown lightly.
  const float late =
      clicks_[1] > 2 ? options_.late_growth_penalty * std::max(0.0f, growth - options_.late_growth_slack) : 0;
  return options_.change_small * std::max(0.0f, -folds) +
         options_.change_large * std::max(0.0f, folds - options_.change_slack) +
         options_.growth_penalty * std::max(0.0f, growth - options_.growth_slack) + late;
}

// More pixels than that are not meant by a click so near to the border, unless they are few beside what is
// selected.
float Picker::largest_change(float radius_px, bool object) const {
  const float disc = options_.change_most * 3.14159265f * (radius_px + 1) * (radius_px + 1);
  if (radius_px < options_.border_px) return disc;
  const float share = object ? options_.change_most_of_selected : options_.rest_most_of_selected;
  return std::max(disc, share * selected_sum(view_.trees[0].pixels));
}

// A correction that brings along much more of what the view hides than the selection has, per pixel, is not
// meant.
float Picker::odd_hidden(float changed_px, float changed_area, float selected_area_per_px) const {
  if (selected_area_per_px <= 0) return 0;
  const float folds = changed_area / std::max(changed_px, 1.0f) / selected_area_per_px;
  return options_.hidden_penalty * std::max(0.0f, std::log(std::max(folds, 1e-6f)) - options_.hidden_slack);
}

// Sums over each node's leaves on that side.
std::vector<float> Picker::on_side(std::size_t t, const std::vector<float>& of_leaves, bool selected) const {
  const PartTree& tree = parts_.trees[t];
  std::vector<float> sum(tree.nodes(), 0);
  for (std::uint32_t node = 0; node < tree.nodes(); ++node) {
    if (node < parts_.leaves && pick_.leaves[node] == selected) sum[node] = of_leaves[node];
    if (tree.parent[node] != kNoPart) sum[tree.parent[node]] += sum[node];
  }
  return sum;
}

float Picker::selected_sum(const std::vector<float>& of_leaves) const {
  float sum = 0;
  for (std::uint32_t leaf = 0; leaf < parts_.leaves; ++leaf) sum += pick_.leaves[leaf] ? of_leaves[leaf] : 0;
  return sum;
}

float Picker::distance_to_border(const glm::vec2& pixel, bool selected) const {
  Mask same(view_.leaf.width(), view_.leaf.height());
  for (std::size_t i = 0; i < same.size(); ++i) {
    const std::uint32_t leaf = view_.leaf.pixels()[i];
    same.pixels()[i] = (leaf != kNoPart && pick_.leaves[leaf]) == selected ? kMaskObject : 0;
  }
  const Image<float> inside = distance_inside(same);
  const int x = std::clamp(static_cast<int>(pixel.x), 0, same.width() - 1),
            y = std::clamp(static_cast<int>(pixel.y), 0, same.height() - 1);
  return std::max(inside.at(x, y), 1.0f);
}

std::vector<Proposals> Picker::proposals(std::uint32_t leaf, bool object) const {
  std::vector<Proposals> all(parts_.trees.size());
  for (std::size_t t = 0; t < all.size(); ++t) {
    const PartTree& tree = parts_.trees[t];
    const std::vector<float> changed = on_side(t, view_.trees[t].pixels, !object),
                             area = on_side(t, tree.area, !object);
    for (const std::uint32_t node : ancestors(tree, leaf)) {
      if (node != leaf && clicked_[!object][t][node]) break;
      all[t].chain.push_back(node);
      all[t].changed_px.push_back(changed[node]);
      all[t].changed_area.push_back(area[node]);
    }
    all[t].level = levels(tree, parts_.leaves, all[t].chain);
  }
  measure_stability(object, &all);
  return all;
}

// IoU in pixels that would change, of every two candidates of every two trees by one histogram of levels.
void Picker::measure_stability(bool object, std::vector<Proposals>* all) const {
  for (Proposals& p : *all) p.stability.assign(p.chain.size(), all->size() > 1 ? 0.0f : 1.0f);
  const std::vector<float>& pixels = view_.trees[0].pixels;  // leaves are the same in all trees
  for (std::size_t t = 0; t < all->size(); ++t)
    for (std::size_t u = 0; u < all->size(); ++u) {
      if (u == t) continue;
      Proposals& a = (*all)[t];
      const Proposals& b = (*all)[u];
      const std::size_t rows = a.chain.size(), columns = b.chain.size();
      std::vector<float> both(rows * columns, 0);
      for (std::uint32_t leaf = 0; leaf < parts_.leaves; ++leaf)
        if (pick_.leaves[leaf] != object && pixels[leaf] > 0 && a.level[leaf] != kNoLevel &&
            b.level[leaf] != kNoLevel)
          both[a.level[leaf] * columns + b.level[leaf]] += pixels[leaf];
      for (std::size_t i = 0; i < rows; ++i) {
        float row = 0, best = 0;
        for (std::size_t j = 0; j < columns; ++j) {
          row += both[i * columns + j];
          both[i * columns + j] = row + (i ? both[(i - 1) * columns + j] : 0);
          best =
              std::max(best, both[i * columns + j] /
                                 std::max(a.changed_px[i] + b.changed_px[j] - both[i * columns + j], 1.0f));
        }
        a.stability[i] += best / static_cast<float>(all->size() - 1);
      }
    }
}

void Picker::apply(const glm::vec2& pixel, SeedLabel label) {
  constexpr int kReachPx = 4;
  const std::uint32_t leaf = leaf_near(view_, pixel, kReachPx);
  if (leaf == kNoPart) return;
  const bool object = label == SeedLabel::kObject;
  for (std::size_t t = 0; t < parts_.trees.size(); ++t)
    for (const std::uint32_t node : ancestors(parts_.trees[t], leaf)) ++clicked_[object][t][node];
  ++clicks_[object];
  if (pick_.leaves[leaf] == object) return;  // already on that side
  const float radius = any_ ? distance_to_border(pixel, !object) : 0;
  const float selected_px =
      object && any_ ? selected_sum(view_.trees[0].pixels) : std::numeric_limits<float>::max();
  if (any_ && view_.trees[0].pixels[leaf] > largest_change(radius, object)) return;
  const std::vector<Proposals> all = proposals(leaf, object);
  const float area_per_px =
      selected_sum(parts_.trees[0].area) / std::max(selected_sum(view_.trees[0].pixels), 1.0f);
  std::vector<Candidate> candidates;
  for (std::size_t t = 0; t < all.size(); ++t)
    for (std::size_t i = 0; i < all[t].chain.size(); ++i) {
      const float px = all[t].changed_px[i];
      const float size =
          any_ ? odd_change(px, radius, selected_px) + odd_hidden(px, all[t].changed_area[i], area_per_px)
               : odd_size(px);
      const float rare = -std::log(std::max(all[t].stability[i], 0.01f));
      const std::uint32_t node = all[t].chain[i];
      const float joint = any_ && object && clicked_[1][t][node] == clicks_[1] ? options_.joint_bonus : 0;
      candidates.push_back({t, i, odd_look(t, node) + size + options_.stability_weight * rare - joint});
    }
  Candidate best = *std::ranges::min_element(candidates, {}, &Candidate::odd);
  if (!any_) best.index = note_first(all, candidates, best);
  any_ = true;
  for (std::uint32_t l = 0; l < parts_.leaves; ++l)
    if (all[best.tree].level[l] != kNoLevel && all[best.tree].level[l] <= best.index)
      pick_.leaves[l] = object;
}

// Keeps the sizes that the first click could mean; returns the index of the one that is wanted.
std::size_t Picker::note_first(const std::vector<Proposals>& all, std::span<const Candidate> candidates,
                               const Candidate& best) {
  constexpr float kNextSize = 1.15f;  // in pixels; less is not told apart
  const Proposals& own = all[best.tree];
  const float chosen_px = own.changed_px[best.index];
  std::vector<std::size_t> distinct{best.index};
  for (std::size_t i = best.index; i-- > 0;)
    if (own.changed_px[i] * kNextSize <= own.changed_px[distinct.front()])
      distinct.insert(distinct.begin(), i);
  const std::size_t chosen = distinct.size() - 1;
  for (std::size_t i = best.index + 1; i < own.chain.size(); ++i)
    if (own.changed_px[i] >= kNextSize * own.changed_px[distinct.back()]) distinct.push_back(i);
  for (const std::size_t i : distinct) pick_.first_chain.push_back({best.tree, own.chain[i]});
  const auto wanted = static_cast<std::ptrdiff_t>(chosen) + options_.scale_steps;
  pick_.first_chosen =
      static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(wanted, 0, std::ssize(distinct) - 1));
  constexpr float kAlike = 1.5f;
  pick_.ambiguous = std::ranges::any_of(candidates, [&](const Candidate& c) {
    const float folds = std::max(all[c.tree].changed_px[c.index], 1.0f) / std::max(chosen_px, 1.0f);
    return c.odd < best.odd + options_.doubt && (folds > kAlike || folds < 1 / kAlike);
  });
  return distinct[pick_.first_chosen];
}

}  // namespace

PartView view_parts(const PartHierarchy& parts, const Image<std::int32_t>& first_hit) {
  PartView view{Image<std::uint32_t>(first_hit.width(), first_hit.height(), kNoPart), {}};
  PartView::Tree leaves{std::vector<float>(parts.leaves, 0), std::vector<float>(parts.leaves, 0)};
  for (int y = 0; y < first_hit.height(); ++y)
    for (int x = 0; x < first_hit.width(); ++x) {
      if (first_hit.at(x, y) < 0) continue;
      const std::uint32_t leaf = parts.leaf_of[static_cast<std::size_t>(first_hit.at(x, y))];
      view.leaf.at(x, y) = leaf;
      if (leaf == kNoPart) continue;
      leaves.pixels[leaf] += 1;
      if (x == 0 || y == 0 || x == first_hit.width() - 1 || y == first_hit.height() - 1)
        leaves.frame_pixels[leaf] += 1;
    }
  for (const PartTree& tree : parts.trees) {
    PartView::Tree& of = view.trees.emplace_back(leaves);
    of.pixels.resize(tree.nodes(), 0);
    of.frame_pixels.resize(tree.nodes(), 0);
    for (std::size_t node = 0; node < tree.nodes(); ++node)
      if (const std::uint32_t up = tree.parent[node]; up != kNoPart) {  // children come before their parents
        of.pixels[up] += of.pixels[node];
        of.frame_pixels[up] += of.frame_pixels[node];
      }
  }
  return view;
}

Pick pick_parts(const PartHierarchy& parts, const PartView& view, const Strokes& strokes,
                const PickOptions& options) {
  Picker picker(parts, view, options);
  const auto apply = [&](const Stroke& stroke) {
    for (const glm::vec2& point : stroke.points_px) picker.apply(point, stroke.label);
  };
  // A rest click corrects an object. One told before there is any would keep every part out that holds its
  // leaf.
  const auto first = std::ranges::find(strokes, SeedLabel::kObject, &Stroke::label);
  if (first != strokes.end()) apply(*first);
  for (auto stroke = strokes.begin(); stroke != strokes.end(); ++stroke)
    if (stroke != first) apply(*stroke);
  return picker.take();
}

std::vector<std::uint8_t> labels_of(const PartHierarchy& parts, const std::vector<std::uint8_t>& leaves) {
  std::vector<std::uint8_t> labels(parts.leaf_of.size(), 0);
  for (std::size_t g = 0; g < labels.size(); ++g)
    labels[g] = parts.leaf_of[g] != kNoPart && leaves[parts.leaf_of[g]];
  return labels;
}

Mask mask_of(const PartView& view, const std::vector<std::uint8_t>& leaves) {
  Mask mask(view.leaf.width(), view.leaf.height());
  for (std::size_t i = 0; i < mask.size(); ++i) {
    const std::uint32_t leaf = view.leaf.pixels()[i];
    mask.pixels()[i] = leaf != kNoPart && leaves[leaf] ? kMaskObject : 0;
  }
  return mask;
}

}  // namespace splatcut
