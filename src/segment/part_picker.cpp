#include "segment/part_picker.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "segment/mask_tools.h"

namespace splatcut {

namespace {

std::vector<std::uint32_t> ancestors(const PartHierarchy& parts, std::uint32_t leaf) {
  std::vector<std::uint32_t> chain;
  for (std::uint32_t node = leaf; node != kNoPart; node = parts.parent[node]) chain.push_back(node);
  return chain;
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

class Picker {
 public:
  Picker(const PartHierarchy& parts, const PartView& view, const PickOptions& options)
      : parts_(parts), view_(view), options_(options), clicked_{std::vector<std::uint8_t>(parts.nodes(), 0), std::vector<std::uint8_t>(parts.nodes(), 0)} {
    pick_.leaves.assign(parts.leaves, 0);
  }

  void apply(const glm::vec2& pixel, SeedLabel label);
  Pick take() { return std::move(pick_); }

 private:
  float log_cut(std::uint32_t node) const;
  float odd_look(std::uint32_t node) const;
  float odd_size(std::uint32_t node) const;
  float odd_change(float changed_px, float radius_px, float selected_px) const;
  std::vector<float> pixels_on_side(bool selected) const;
  float selected_pixels() const;
  float distance_to_border(const glm::vec2& pixel, bool selected) const;
  void assign(std::uint32_t node, std::uint8_t value);

  const PartHierarchy& parts_;
  const PartView& view_;
  const PickOptions& options_;
  std::vector<std::uint8_t> clicked_[2];  // per sign and node: holds a click of that sign
  bool any_ = false;
  Pick pick_;
};

// The border's length over the part's size, scale free; a part that touches nothing has the least.
float Picker::log_cut(std::uint32_t node) const {
  const float size = std::sqrt(std::max(parts_.area[node], 1e-30f));
  return std::max(std::log(std::max(parts_.cut[node], 1e-30f) / size), options_.least_log_cut);
}

// Less is more like an object.
float Picker::odd_look(std::uint32_t node) const {
  const float own = log_cut(node);
  const std::uint32_t up = parts_.parent[node];
  const float rise = up == kNoPart ? 0 : std::clamp(log_cut(up) - own, 0.0f, 10.0f);
  const float jump = up == kNoPart ? 0 : std::clamp(std::log(std::max(parts_.merge_cost[up], 1e-6f) / std::max(parts_.merge_cost[node], 0.1f)), 0.0f, 2.0f);
  float look = options_.cut_weight * own - options_.rise_bonus * rise - options_.jump_bonus * jump;
  if (up == kNoPart) look += options_.root_penalty;
  return look + options_.frame_penalty * view_.frame_pixels[node] / std::sqrt(std::max(view_.pixels[node], 1.0f));
}

float Picker::odd_size(std::uint32_t node) const {
  const float share = std::max(view_.pixels[node], 1.0f) / static_cast<float>(view_.leaf.size());
  return options_.small_penalty * std::max(0.0f, std::log(options_.small_share / share)) +
         options_.large_penalty * std::max(0.0f, std::log(share / options_.large_share));
}

// How far the pixels that would change are from a disc of that radius, and from what is selected now.
float Picker::odd_change(float changed_px, float radius_px, float selected_px) const {
  const float folds = std::log(std::max(changed_px, 1.0f) / (3.14159265f * radius_px * radius_px));
  const float growth = std::log(std::max(changed_px, 1.0f) / std::max(selected_px, 1.0f));
  return options_.change_large * std::max(0.0f, folds - options_.change_slack) + options_.change_small * std::max(0.0f, -folds) +
         options_.growth_penalty * std::max(0.0f, growth - options_.growth_slack);
}

std::vector<float> Picker::pixels_on_side(bool selected) const {
  std::vector<float> pixels(parts_.nodes(), 0);
  for (std::uint32_t node = 0; node < parts_.nodes(); ++node) {
    if (node < parts_.leaves && pick_.leaves[node] == selected) pixels[node] = view_.pixels[node];
    if (parts_.parent[node] != kNoPart) pixels[parts_.parent[node]] += pixels[node];
  }
  return pixels;
}

float Picker::selected_pixels() const {
  float pixels = 0;
  for (std::uint32_t leaf = 0; leaf < parts_.leaves; ++leaf) pixels += pick_.leaves[leaf] ? view_.pixels[leaf] : 0;
  return pixels;
}

float Picker::distance_to_border(const glm::vec2& pixel, bool selected) const {
  Mask same(view_.leaf.width(), view_.leaf.height());
  for (std::size_t i = 0; i < same.size(); ++i) {
    const std::uint32_t leaf = view_.leaf.pixels()[i];
    same.pixels()[i] = (leaf != kNoPart && pick_.leaves[leaf]) == selected ? kMaskObject : 0;
  }
  const Image<float> inside = distance_inside(same);
  const int x = std::clamp(static_cast<int>(pixel.x), 0, same.width() - 1), y = std::clamp(static_cast<int>(pixel.y), 0, same.height() - 1);
  return std::max(inside.at(x, y), 1.0f);
}

void Picker::assign(std::uint32_t node, std::uint8_t value) {
  std::vector<std::uint32_t> open{node};
  while (!open.empty()) {
    const std::uint32_t at = open.back();
    open.pop_back();
    if (at < parts_.leaves) {
      pick_.leaves[at] = value;
      continue;
    }
    open.insert(open.end(), parts_.children[at].begin(), parts_.children[at].end());
  }
}

void Picker::apply(const glm::vec2& pixel, SeedLabel label) {
  constexpr int kReachPx = 4;
  const std::uint32_t leaf = leaf_near(view_, pixel, kReachPx);
  if (leaf == kNoPart) return;
  const bool object = label == SeedLabel::kObject;
  const std::vector<std::uint32_t> chain = ancestors(parts_, leaf);
  for (const std::uint32_t node : chain) clicked_[object][node] = 1;
  if (pick_.leaves[leaf] == object) return;  // already on that side
  const float radius = any_ ? distance_to_border(pixel, !object) : 0;
  const std::vector<float> changed = pixels_on_side(!object);
  const float selected_px = object && any_ ? selected_pixels() : std::numeric_limits<float>::max();
  if (any_ && changed[leaf] > options_.change_most * 3.14159265f * (radius + 1) * (radius + 1)) return;
  std::size_t best = 0;
  float least = std::numeric_limits<float>::max();
  for (std::size_t i = 0; i < chain.size(); ++i) {
    if (clicked_[!object][chain[i]]) break;
    const float odd = odd_look(chain[i]) + (any_ ? odd_change(changed[chain[i]], radius, selected_px) : odd_size(chain[i]));
    if (odd < least) {
      least = odd;
      best = i;
    }
  }
  if (!any_) {
    pick_.first_chain = chain;
    pick_.first_chosen = best;
  }
  any_ = true;
  assign(chain[best], object);
}

}  // namespace

PartView view_parts(const PartHierarchy& parts, const Image<std::int32_t>& first_hit) {
  PartView view{Image<std::uint32_t>(first_hit.width(), first_hit.height(), kNoPart), std::vector<float>(parts.nodes(), 0),
                std::vector<float>(parts.nodes(), 0)};
  for (int y = 0; y < first_hit.height(); ++y)
    for (int x = 0; x < first_hit.width(); ++x) {
      if (first_hit.at(x, y) < 0) continue;
      const std::uint32_t leaf = parts.leaf_of[static_cast<std::size_t>(first_hit.at(x, y))];
      view.leaf.at(x, y) = leaf;
      if (leaf == kNoPart) continue;
      view.pixels[leaf] += 1;
      if (x == 0 || y == 0 || x == first_hit.width() - 1 || y == first_hit.height() - 1) view.frame_pixels[leaf] += 1;
    }
  for (std::size_t node = 0; node < parts.nodes(); ++node)
    if (const std::uint32_t up = parts.parent[node]; up != kNoPart) {  // children come before their parents
      view.pixels[up] += view.pixels[node];
      view.frame_pixels[up] += view.frame_pixels[node];
    }
  return view;
}

Pick pick_parts(const PartHierarchy& parts, const PartView& view, const Strokes& strokes, const PickOptions& options) {
  Picker picker(parts, view, options);
  for (const Stroke& stroke : strokes)
    for (const glm::vec2& point : stroke.points_px) picker.apply(point, stroke.label);
  return picker.take();
}

std::vector<std::uint8_t> labels_of(const PartHierarchy& parts, const std::vector<std::uint8_t>& leaves) {
  std::vector<std::uint8_t> labels(parts.leaf_of.size(), 0);
  for (std::size_t g = 0; g < labels.size(); ++g) labels[g] = parts.leaf_of[g] != kNoPart && leaves[parts.leaf_of[g]];
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
