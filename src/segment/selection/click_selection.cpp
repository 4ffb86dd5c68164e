#include "segment/selection/click_selection.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "segment/mask_tools.h"

namespace splatcut {

namespace {

constexpr std::uint32_t kNoLevel = 0xffffffffu;
constexpr float kPi = std::numbers::pi_v<float>;
constexpr int kReachPx = 4;             // a click beside the scene's edge still hits it
constexpr float kLeastChangePx = 0.3f;  // candidates that change less change nothing
constexpr float kOffered = 0.7f;        // ln 2: what is at least half as likely is offered

// Sums over each node's leaves.
std::vector<float> summed(const PartTree& tree, std::span<const float> of_leaves) {
  std::vector<float> sum(tree.nodes(), 0);
  std::ranges::copy(of_leaves, sum.begin());
  for (std::size_t node = 0; node < tree.nodes(); ++node)  // children come before their parents
    if (tree.parent[node] != kNoPart) sum[tree.parent[node]] += sum[node];
  return sum;
}

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

// Per node of a chain: the pixels that would show it. level: per leaf, from which node on it belongs to them.
std::vector<float> displayed_px(const PixelWeights& leaves, std::span<const std::uint32_t> level,
                                std::size_t nodes) {
  std::vector<float> px(nodes, 0);
  std::vector<std::pair<std::uint32_t, float>> list;
  for (std::size_t i = 0; i + 1 < leaves.first.size(); ++i) {
    list.clear();
    for (const GroupWeight& w : leaves.at(i))
      if (level[w.group] != kNoLevel) list.emplace_back(level[w.group], w.weight);
    std::ranges::sort(list);
    float sum = 0;
    for (const auto& [from, share] : list)
      if ((sum += share) >= 0.5f) {
        px[from] += 1;
        break;
      }
  }
  for (std::size_t n = 1; n < nodes; ++n) px[n] += px[n - 1];
  return px;
}

// The border's length over the part's size, scale free.
float log_cut(const PartTree& tree, std::uint32_t node) {
  constexpr float kLeast = -16;  // of a part that touches nothing
  const float size = std::sqrt(std::max(tree.area[node], 1e-30f));
  return std::max(std::log(std::max(tree.cut[node], 1e-30f) / size), kLeast);
}

// How much dearer the merge that ends this part is than the one that made it.
float jump(const PartTree& tree, std::uint32_t node) {
  const std::uint32_t up = tree.parent[node];
  if (up == kNoPart) return 0;
  const float folds = std::max(tree.merge_cost[up], 1e-6f) / std::max(tree.merge_cost[node], 0.1f);
  return std::clamp(std::log(folds), 0.0f, 2.0f);
}

std::vector<std::uint32_t> disc_pixels(const Camera& camera, const glm::vec2& centre, float radius_px) {
  std::vector<std::uint32_t> pixels;
  const int cx = static_cast<int>(centre.x), cy = static_cast<int>(centre.y);
  const int reach = static_cast<int>(radius_px) + 1;
  for (int y = std::max(0, cy - reach); y <= std::min(camera.height_px - 1, cy + reach); ++y)
    for (int x = std::max(0, cx - reach); x <= std::min(camera.width_px - 1, cx + reach); ++x)
      if (static_cast<float>((x - cx) * (x - cx) + (y - cy) * (y - cy)) <= radius_px * radius_px)
        pixels.push_back(static_cast<std::uint32_t>(y * camera.width_px + x));
  return pixels;
}

// The heaviest leaf near the pixel, the nearest pixel that has one; of those that are not on that side yet,
// if `off` says which are.
std::uint32_t leaf_near(const LeafView& view, const glm::vec2& pixel, const auto& off) {
  const int cx = static_cast<int>(pixel.x), cy = static_cast<int>(pixel.y);
  std::uint32_t best = kNoPart;
  int nearest = std::numeric_limits<int>::max();
  for (int y = std::max(0, cy - kReachPx); y <= std::min(view.camera.height_px - 1, cy + kReachPx); ++y)
    for (int x = std::max(0, cx - kReachPx); x <= std::min(view.camera.width_px - 1, cx + kReachPx); ++x) {
      const int d2 = (x - cx) * (x - cx) + (y - cy) * (y - cy);
      if (d2 >= nearest) continue;
      for (const GroupWeight& w : view.leaves.at(static_cast<std::size_t>(y) * view.camera.width_px + x))
        if (off(w.group)) {  // heaviest first
          best = w.group;
          nearest = d2;
          break;
        }
    }
  return best;
}

// Distance of the pixel to the border of the region of that side that it lies in.
float distance_to_border(const Mask& mask, const glm::ivec2& at, bool side) {
  Mask same(mask.width(), mask.height());
  for (std::size_t i = 0; i < mask.size(); ++i)
    same.pixels()[i] = (mask.pixels()[i] != 0) == side ? kMaskObject : 0;
  same.at(at.x, at.y) = kMaskObject;
  return std::max(distance_inside(same).at(at.x, at.y), 1.0f);
}

// The pixel's distance to the border over the largest of its connected region, in (0, 1].
float centrality(const Mask& region, const glm::ivec2& at) {
  const Image<float> distance = distance_inside(region);
  const float own = std::max(distance.at(at.x, at.y), 1.0f);
  float most = own;
  std::vector<std::uint8_t> visited(region.size(), 0);
  std::vector<glm::ivec2> open{at};
  visited[static_cast<std::size_t>(at.y) * region.width() + at.x] = 1;
  while (!open.empty()) {
    const glm::ivec2 p = open.back();
    open.pop_back();
    most = std::max(most, distance.at(p.x, p.y));
    for (const glm::ivec2 step : {glm::ivec2(1, 0), glm::ivec2(-1, 0), glm::ivec2(0, 1), glm::ivec2(0, -1)}) {
      const glm::ivec2 q = p + step;
      if (!region.contains(q.x, q.y) || !region.at(q.x, q.y)) continue;
      std::uint8_t& been = visited[static_cast<std::size_t>(q.y) * region.width() + q.x];
      if (!been) open.push_back(q);
      been = 1;
    }
  }
  return own / most;
}

}  // namespace

struct ClickSelection::Click {
  const LeafView& view;
  glm::ivec2 at;
  bool object;
  bool first;
  std::uint32_t leaf;
  float radius_px;                  // to the displayed border; 0 for the first
  std::vector<std::uint32_t> disc;  // pixels that are certainly wrong
  std::vector<float> wrong_px;      // per leaf: its pixels, where it is not on that side yet
  std::size_t pixel() const { return static_cast<std::size_t>(at.y) * view.camera.width_px + at.x; }
};

// One tree's answers to a click.
struct ClickSelection::Chain {
  std::vector<std::uint32_t> nodes;  // the leaf and its ancestors
  std::vector<std::uint32_t> level;  // per leaf of the hierarchy
  std::vector<float> view_px, frame_px, opposed;
  std::vector<float> changed_px, stability;
  bool shade_blind = false;
  bool of_tree = true;  // false: no tree's, one set of leaves
};

struct ClickSelection::Candidate {
  static constexpr std::size_t kDisc = ~std::size_t{0};
  std::size_t tree = 0, index = 0;  // into that tree's chain; kDisc: no part, the disc alone
  float cost = 0;
};

struct ClickSelection::FirstPick {
  std::vector<Chain> chains;
  std::vector<Candidate> candidates;  // with all their costs, likeliest first
  std::vector<Candidate> meant;       // of these, what is offered
  std::vector<Mask> masks;            // of each, in the click's view
};

ClickSelection::ClickSelection(const PartHierarchy& parts, const SelectionModel& model, int part_step,
                               int choice)
    : parts_(parts),
      model_(model),
      part_step_(part_step),
      choice_(choice),
      leaf_object_(parts.leaves, 0),
      leaf_said_(parts.leaves, 0),
      labels_(parts.leaf_of.size(), 0),
      said_(parts.leaf_of.size(), 0) {}

std::vector<std::uint8_t> ClickSelection::certain_leaves(const Click& click) const {
  std::vector<float> in_disc(parts_.leaves, 0);
  for (const std::uint32_t pixel : click.disc)
    for (const GroupWeight& w : click.view.leaves.at(pixel)) in_disc[w.group] += w.weight;
  const Camera& camera = click.view.camera;
  const auto visible_share = [&](std::uint32_t leaf) {
    const float depth = std::max(camera.camera_from_world(parts_.leaf_centre_world[leaf]).z, 1e-6f);
    const float facing_px = parts_.leaf_area[leaf] * camera.fx_px * camera.fx_px / (depth * depth);
    return click.view.leaf_px[leaf] / std::max(facing_px, 1e-6f);
  };
  std::vector<std::uint8_t> certain(parts_.leaves, 0);
  for (std::uint32_t leaf = 0; leaf < parts_.leaves; ++leaf)
    certain[leaf] = in_disc[leaf] > kLeastChangePx &&
                    in_disc[leaf] > model_.disc_majority * click.view.leaf_px[leaf] &&
                    visible_share(leaf) > model_.least_visible;
  return certain;
}

std::vector<ClickSelection::Chain> ClickSelection::chains(const Click& click) const {
  std::vector<float> opposed(parts_.leaves, 0);
  for (const std::uint32_t leaf : clicked_[!click.object])
    if (leaf != click.leaf) opposed[leaf] += 1;
  std::vector<Chain> all(parts_.trees.size());
  for (std::size_t t = 0; t < all.size(); ++t) {
    const PartTree& tree = parts_.trees[t];
    Chain& chain = all[t];
    chain.shade_blind = t >= parts_.plain_trees;
    const std::vector<float> px = summed(tree, click.view.leaf_px),
                             frame = summed(tree, click.view.leaf_frame_px), held = summed(tree, opposed);
    for (std::uint32_t node = click.leaf; node != kNoPart; node = tree.parent[node]) {
      chain.nodes.push_back(node);
      chain.view_px.push_back(px[node]);
      chain.frame_px.push_back(frame[node]);
      chain.opposed.push_back(held[node]);
    }
    chain.level = levels(tree, parts_.leaves, chain.nodes);
  }
  return all;
}

// Per leaf: whether it meets none of the other sign's clicks below its common ancestor with this click, in
// most trees.
std::vector<std::uint8_t> ClickSelection::nearer_leaves(const std::vector<Chain>& chains) const {
  std::vector<float> votes(parts_.leaves, 0);
  for (const Chain& chain : chains) {
    const auto held =
        std::ranges::find_if(chain.opposed, [](float n) { return n > 0; }) - chain.opposed.begin();
    const auto reach = static_cast<std::uint32_t>(std::max<std::ptrdiff_t>(held, 1));
    for (std::uint32_t leaf = 0; leaf < parts_.leaves; ++leaf) votes[leaf] += chain.level[leaf] < reach;
  }
  std::vector<std::uint8_t> nearer(parts_.leaves);
  for (std::uint32_t leaf = 0; leaf < parts_.leaves; ++leaf)
    nearer[leaf] = votes[leaf] >= model_.nearer_majority * static_cast<float>(chains.size());
  return nearer;
}

// IoU in pixels that would change, of every two candidates of every two trees of a kind by one histogram of
// levels.
void ClickSelection::measure_stability(const Click& click, std::vector<Chain>* chains) const {
  const std::vector<float>& px = click.wrong_px;
  for (std::size_t t = 0; t < chains->size(); ++t) {
    Chain& chain = (*chains)[t];
    const std::vector<float> changed = summed(parts_.trees[t], px);
    chain.changed_px.clear();
    for (const std::uint32_t node : chain.nodes) chain.changed_px.push_back(changed[node]);
    chain.stability.assign(chain.nodes.size(), 0);
  }
  for (std::size_t t = 0; t < chains->size(); ++t) {
    Chain& a = (*chains)[t];
    std::size_t others = 0;
    for (std::size_t u = 0; u < chains->size(); ++u) {
      const Chain& b = (*chains)[u];
      if (u == t || a.shade_blind != b.shade_blind) continue;
      ++others;
      const std::size_t rows = a.nodes.size(), columns = b.nodes.size();
      std::vector<float> both(rows * columns, 0);
      for (std::uint32_t leaf = 0; leaf < parts_.leaves; ++leaf)
        if (px[leaf] > 0 && a.level[leaf] != kNoLevel && b.level[leaf] != kNoLevel)
          both[a.level[leaf] * columns + b.level[leaf]] += px[leaf];
      for (std::size_t i = 0; i < rows; ++i) {
        float row = 0, best = 0;
        for (std::size_t j = 0; j < columns; ++j) {
          row += both[i * columns + j];
          both[i * columns + j] = row + (i ? both[(i - 1) * columns + j] : 0);
          const float either = a.changed_px[i] + b.changed_px[j] - both[i * columns + j];
          best = std::max(best, both[i * columns + j] / std::max(either, 1.0f));
        }
        a.stability[i] += best;
      }
    }
    for (float& s : a.stability) s = others ? s / static_cast<float>(others) : 1;
  }
}

std::vector<ClickSelection::Candidate> ClickSelection::scored(const Click& click,
                                                              const std::vector<Chain>& chains) const {
  const SelectionModel& m = model_;
  const float picture_px =
      static_cast<float>(click.view.camera.width_px) * static_cast<float>(click.view.camera.height_px);
  const auto size_cost = [&](float view_px, float changed_px) {
    if (click.first) {
      const float share = std::max(view_px, 1.0f) / picture_px;
      return m.small_weight * std::max(0.0f, std::log(m.small_share / share)) +
             m.large_weight * std::max(0.0f, std::log(share / m.large_share));
    }
    const float folds = std::log(std::max(changed_px, 1.0f) / (kPi * click.radius_px * click.radius_px));
    return m.scrap_weight * std::max(0.0f, m.scrap_folds - folds) +
           m.fold_weight * std::max(0.0f, folds - m.fold_slack) +
           m.giant_weight *
               std::max(0.0f, folds - (click.radius_px < m.border_px ? m.border_folds : m.giant_folds));
  };
  std::vector<Candidate> all;
  for (std::size_t t = 0; t < chains.size(); ++t) {
    const PartTree& tree = parts_.trees[t];
    const Chain& chain = chains[t];
    for (std::size_t i = 0; i < chain.nodes.size(); ++i) {
      if (chain.changed_px[i] < kLeastChangePx) continue;
      const float look =
          m.cut_weight * log_cut(tree, chain.nodes[i]) - m.jump_weight * jump(tree, chain.nodes[i]);
      const float rare = -std::log(std::max(chain.stability[i], 0.01f));
      const float frame = chain.frame_px[i] / std::sqrt(std::max(chain.view_px[i], 1.0f));
      all.push_back(
          {t, i,
           look + (click.first ? m.first_stability_weight : m.stability_weight) * rare +
               (click.first ? m.first_frame_weight : m.frame_weight) * frame +
               (chain.shade_blind ? click.first ? m.first_shade_blind_cost : m.shade_blind_cost : 0) +
               size_cost(chain.view_px[i], chain.changed_px[i]) + m.opposed_cost * chain.opposed[i]});
    }
  }
  std::ranges::stable_sort(all, {}, &Candidate::cost);
  return all;
}

// A correction that takes back just what another one did is not meant: people undo in that case.
void ClickSelection::add_change_costs(const Click& click, const std::vector<Chain>& chains,
                                      std::vector<Candidate>* candidates) const {
  for (const Change& change : changes_) {
    if (change.object == click.object) continue;
    std::vector<std::vector<float>> both(chains.size()), all(chains.size());
    for (std::size_t t = 0; t < chains.size(); ++t) {
      both[t].assign(chains[t].nodes.size(), 0);
      all[t].assign(chains[t].nodes.size(), 0);
      for (const std::uint32_t leaf : change.leaves)
        if (chains[t].level[leaf] != kNoLevel && (leaf_object_[leaf] != 0) != click.object)
          both[t][chains[t].level[leaf]] += parts_.leaf_area[leaf];
      for (std::uint32_t leaf = 0; leaf < parts_.leaves; ++leaf)
        if (chains[t].level[leaf] != kNoLevel && (leaf_object_[leaf] != 0) != click.object)
          all[t][chains[t].level[leaf]] += parts_.leaf_area[leaf];
      for (std::size_t i = 1; i < all[t].size(); ++i) {
        both[t][i] += both[t][i - 1];
        all[t][i] += all[t][i - 1];
      }
    }
    float change_area = 0;
    for (const std::uint32_t leaf : change.leaves) change_area += parts_.leaf_area[leaf];
    for (Candidate& c : *candidates) {
      const float common = both[c.tree][c.index], either = all[c.tree][c.index] + change_area - common;
      c.cost += model_.back_weight * common / std::max(either, 1e-30f);
    }
  }
  std::ranges::stable_sort(*candidates, {}, &Candidate::cost);
}

// The rest click as: of what the first click could mean, a part without it was meant. What that gives up is
// one more set of leaves to change. False: the first click is not the only one on the object, or nothing else
// is left.
bool ClickSelection::add_repick(const Click& click, std::vector<Chain>* chains,
                                std::vector<Candidate>* candidates) const {
  if (click.object || click.first || clicked_[1].size() != 1 || !first_) return false;
  const auto allowed = [&](const Candidate& c) {
    const Chain& chain = first_->chains[c.tree];
    const auto outside = [&](std::uint32_t leaf) { return chain.level[leaf] > c.index; };
    return outside(click.leaf) && std::ranges::all_of(clicked_[0], outside);
  };
  const auto other = std::ranges::find_if(first_->candidates, allowed);
  if (other == first_->candidates.end()) return false;
  Chain chain;
  chain.of_tree = false;
  chain.nodes = {click.leaf};
  chain.level.assign(parts_.leaves, kNoLevel);
  float px = 0;
  for (std::uint32_t leaf = 0; leaf < parts_.leaves; ++leaf)
    if (leaf_object_[leaf] && first_->chains[other->tree].level[leaf] > other->index &&
        leaf_said_[leaf] <= 0) {
      chain.level[leaf] = 0;
      px += click.view.leaf_px[leaf];
    }
  if (px < kLeastChangePx) return false;
  chain.changed_px = {px};
  const float folds = std::log(std::max(px, 1.0f) / (kPi * click.radius_px * click.radius_px));
  const float cost = model_.repick_cost + other->cost - first_->candidates.front().cost +
                     model_.scrap_weight * std::max(0.0f, model_.scrap_folds - folds);
  chains->push_back(std::move(chain));
  candidates->push_back({chains->size() - 1, 0, cost});
  std::ranges::stable_sort(*candidates, {}, &Candidate::cost);
  return true;
}

// Adds the cost of being off the centre, likeliest candidates first, until none that is left can win; drops
// the rest.
ClickSelection::Candidate ClickSelection::best_of(const Click& click, const std::vector<Chain>& chains,
                                                  std::vector<Candidate>* candidates) const {
  constexpr std::size_t kMost = 24;  // looked at
  const float weight = click.first ? model_.first_centre_weight : model_.centre_weight;
  const float slack = click.first ? model_.first_centre_slack : model_.centre_slack;
  const float doubt = click.first ? std::max(model_.doubt, kOffered) : model_.doubt;
  const Camera& camera = click.view.camera;
  std::vector<Image<std::uint32_t>> level_of(chains.size());  // per pixel: from which candidate on it changes
  const auto level_image = [&](std::size_t t) -> const Image<std::uint32_t>& {
    if (!level_of[t].empty()) return level_of[t];
    level_of[t] = Image<std::uint32_t>(camera.width_px, camera.height_px, kNoLevel);
    std::vector<std::pair<std::uint32_t, float>> list;
    for (std::size_t i = 0; i < level_of[t].size(); ++i) {
      list.clear();
      for (const GroupWeight& w : click.view.leaves.at(i))
        if ((click.wrong_px[w.group] > 0 || !chains[t].of_tree) && chains[t].level[w.group] != kNoLevel)
          list.emplace_back(chains[t].level[w.group], w.weight);
      std::ranges::sort(list);
      float sum = 0;
      for (const auto& [level, share] : list)
        if ((sum += share) >= 0.5f) {
          level_of[t].pixels()[i] = level;
          break;
        }
    }
    return level_of[t];
  };
  Candidate best{0, Candidate::kDisc, click.first ? std::numeric_limits<float>::max() : model_.disc_cost};
  std::size_t looked_at = 0;
  for (Candidate& candidate : *candidates) {
    if (looked_at == kMost || candidate.cost > best.cost + doubt) break;
    ++looked_at;
    const Image<std::uint32_t>& level = level_image(candidate.tree);
    Mask region(camera.width_px, camera.height_px);
    for (std::size_t i = 0; i < region.size(); ++i)
      region.pixels()[i] = level.pixels()[i] <= candidate.index ? kMaskObject : 0;
    region.at(click.at.x, click.at.y) = kMaskObject;
    candidate.cost += weight * std::max(0.0f, std::log(slack / centrality(region, click.at)));
    if (candidate.cost < best.cost) best = candidate;
  }
  candidates->resize(looked_at);
  std::ranges::stable_sort(*candidates, {}, &Candidate::cost);
  return best;
}

std::span<const Mask> ClickSelection::meanings() const {
  return first_ ? std::span<const Mask>(first_->masks) : std::span<const Mask>();
}

// What the first click could mean. Offered: the likeliest, then what is nearly as likely and shows something
// clearly different.
std::shared_ptr<const ClickSelection::FirstPick> ClickSelection::first_pick(
    const Click& click, const std::vector<Chain>& chains, const std::vector<Candidate>& candidates) const {
  constexpr std::size_t kMostMeanings = 3;
  constexpr float kClearly = 0.8f;  // IoU below which a person sees two things
  FirstPick pick{chains, candidates, {}, {}};
  std::vector<std::vector<std::uint8_t>> taken;  // leaves of each
  const auto alike = [&](const std::vector<std::uint8_t>& a, const std::vector<std::uint8_t>& b) {
    float both = 0, either = 0;  // pixels
    for (std::uint32_t l = 0; l < parts_.leaves; ++l) {
      both += a[l] && b[l] ? click.view.leaf_px[l] : 0;
      either += a[l] || b[l] ? click.view.leaf_px[l] : 0;
    }
    return both >= kClearly * either;
  };
  for (const Candidate& candidate : candidates) {
    if (pick.meant.size() == kMostMeanings || candidate.cost > candidates.front().cost + kOffered) break;
    std::vector<std::uint8_t> leaves(parts_.leaves);
    for (std::uint32_t l = 0; l < parts_.leaves; ++l)
      leaves[l] = chains[candidate.tree].level[l] <= candidate.index;
    if (std::ranges::any_of(taken, [&](const auto& other) { return alike(other, leaves); })) continue;
    pick.meant.push_back(candidate);
    pick.masks.push_back(shown(click.view.leaves, click.view.camera, leaves));
    taken.push_back(std::move(leaves));
  }
  return std::make_shared<const FirstPick>(std::move(pick));
}

// Keeps the sizes that the first click could mean; moves `best` to the one that is wanted.
void ClickSelection::note_first(const Click& click, const std::vector<Chain>& chains,
                                std::span<const Candidate> candidates, Candidate* best) {
  constexpr float kNextSize = 1.15f;  // in pixels that show it; less is not told apart
  const std::vector<float> px =
      displayed_px(click.view.leaves, chains[best->tree].level, chains[best->tree].nodes.size());
  std::vector<std::size_t> distinct{best->index};
  for (std::size_t i = best->index; i-- > 0;)
    if (px[i] >= kLeastChangePx && px[i] * kNextSize <= px[distinct.front()])
      distinct.insert(distinct.begin(), i);
  const std::size_t likeliest = distinct.size() - 1;
  for (std::size_t i = best->index + 1; i < px.size(); ++i)
    if (px[i] >= kNextSize * px[distinct.back()]) distinct.push_back(i);
  constexpr float kAlike = 1.5f;
  ambiguous_ = std::ranges::any_of(candidates, [&](const Candidate& c) {
    const float folds = chains[c.tree].changed_px[c.index] / chains[best->tree].changed_px[best->index];
    return c.cost < best->cost + model_.doubt && (folds > kAlike || folds < 1 / kAlike);
  });
  const auto wanted = static_cast<std::ptrdiff_t>(likeliest) + part_step_;
  likeliest_size_ = likeliest;
  sizes_ = distinct.size();
  size_ = static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(wanted, 0, std::ssize(distinct) - 1));
  best->index = distinct[size_];
}

bool ClickSelection::take(const LeafView& view, const glm::vec2& pixel, bool object, float least_radius_px) {
  const glm::ivec2 at(std::clamp(static_cast<int>(pixel.x), 0, view.camera.width_px - 1),
                      std::clamp(static_cast<int>(pixel.y), 0, view.camera.height_px - 1));
  const std::uint32_t leaf =
      leaf_near(view, pixel, [&](std::uint32_t l) { return (leaf_object_[l] != 0) != object; });
  if (leaf == kNoPart) {
    confirm(view, pixel, object, least_radius_px);
    return true;
  }
  Click click{.view = view,
              .at = at,
              .object = object,
              .first = !any_,
              .leaf = leaf,
              .radius_px = 0,
              .disc = {},
              .wrong_px = view.leaf_px};
  if (any_) click.radius_px = displayed_radius(view, at, object, leaf);
  click.disc = disc_pixels(view.camera, glm::vec2(at),
                           std::max({model_.disc_share * click.radius_px, least_radius_px, 1.0f}));
  for (std::uint32_t l = 0; l < parts_.leaves; ++l)
    if ((leaf_object_[l] != 0) == object) click.wrong_px[l] = 0;
  std::vector<std::uint8_t> certain = certain_leaves(click);
  std::vector<Chain> all = chains(click);
  const std::vector<std::uint8_t> nearer = nearer_leaves(all);
  for (std::uint32_t l = 0; l < parts_.leaves; ++l)
    if (!nearer[l]) click.wrong_px[l] = 0;
  measure_stability(click, &all);
  std::vector<Candidate> candidates = scored(click, all);
  if (any_) {
    add_change_costs(click, all, &candidates);
    add_repick(click, &all, &candidates);
  }
  Candidate best = best_of(click, all, &candidates);
  if (!any_) {
    if (candidates.empty()) return false;
    first_ = first_pick(click, all, candidates);
    choice_taken_ = std::min(static_cast<std::size_t>(std::max(choice_, 0)), first_->meant.size() - 1);
    if (choice_taken_ > 0) best = first_->meant[choice_taken_];
    note_first(click, all, candidates, &best);
    certain.assign(parts_.leaves, 0);
    certain[leaf] = 1;
  }
  clicked_[object].push_back(leaf);
  const std::int8_t sign = object ? 1 : -1;
  const bool part = best.index != Candidate::kDisc;
  Change change{.leaves = {}, .object = object};
  bool followed = false;
  for (std::uint32_t l = 0; l < parts_.leaves; ++l) {
    const bool follows = part && all[best.tree].level[l] <= best.index && leaf_said_[l] != -sign &&
                         (nearer[l] || !all[best.tree].of_tree);
    if (certain[l]) leaf_said_[l] = sign;
    if (!certain[l] && !follows) continue;
    if ((leaf_object_[l] != 0) != object) {
      change.leaves.push_back(l);
      followed |= !certain[l];
    }
    leaf_object_[l] = object;
  }
  constexpr float kSpotPx = 4;  // a click nearer to the border mends the border
  spot_alone_ = any_ && !followed && click.radius_px > kSpotPx;
  if (any_ || !part) changes_.push_back(std::move(change));
  any_ = true;
  label();
  pin(view, click.disc, object);
  insist(view, click.pixel(), object);
  return true;
}

// Distance to the displayed border. Where the object itself was left out of the picture there is none: the
// clicked leaf's own size stands in its place.
float ClickSelection::displayed_radius(const LeafView& view, const glm::ivec2& at, bool object,
                                       std::uint32_t leaf) const {
  const Mask mask = shown(view.gaussians, view.camera, labels_);
  if (object && !view.whole && count(mask) == 0) return std::max(std::sqrt(view.leaf_px[leaf] / kPi), 1.0f);
  return distance_to_border(mask, at, !object);
}

// What is displayed as said already is held: a later click's parts do not take it back.
void ClickSelection::confirm(const LeafView& view, const glm::vec2& pixel, bool object,
                             float least_radius_px) {
  const glm::ivec2 at(std::clamp(static_cast<int>(pixel.x), 0, view.camera.width_px - 1),
                      std::clamp(static_cast<int>(pixel.y), 0, view.camera.height_px - 1));
  const float radius_px = distance_to_border(shown(view.gaussians, view.camera, labels_), at, object);
  pin(view,
      disc_pixels(view.camera, glm::vec2(at),
                  std::max({model_.disc_share * radius_px, least_radius_px, 1.0f})),
      object, Pin::kSaidAlready);
  const std::uint32_t leaf =
      leaf_near(view, pixel, [&](std::uint32_t l) { return (leaf_object_[l] != 0) == object; });
  if (leaf != kNoPart) clicked_[object].push_back(leaf);
  insist(view, static_cast<std::size_t>(at.y) * view.camera.width_px + at.x, object);
}

// The Gaussians that show mostly in these pixels take the label and keep it; or those alone that have it, as
// something of the other side may shine through from behind.
void ClickSelection::pin(const LeafView& view, std::span<const std::uint32_t> pixels, bool object,
                         Pin which) {
  std::vector<float> inside(labels_.size(), 0), all(labels_.size(), 0);
  for (const std::uint32_t pixel : pixels)
    for (const GroupWeight& w : view.gaussians.at(pixel)) inside[w.group] += w.weight;
  for (const GroupWeight& w : view.gaussians.entry) all[w.group] += w.weight;
  const std::int8_t sign = object ? 1 : -1;
  for (std::size_t g = 0; g < labels_.size(); ++g) {
    const bool mostly = inside[g] > 0 && inside[g] > model_.disc_majority * all[g];
    if (mostly && (which == Pin::kAll || (labels_[g] != 0) == object)) said_[g] = sign;
  }
  label();
}

// The clicked pixel and those around it show what was said, clearly enough for pictures of another size to
// agree. The Gaussians that make the clicked pixel are held: no later stage overrules them.
void ClickSelection::insist(const LeafView& view, std::size_t pixel, bool object) {
  constexpr float kClearly = 0.65f;
  const int width = view.camera.width_px, height = view.camera.height_px;
  const int cx = static_cast<int>(pixel) % width, cy = static_cast<int>(pixel) / width;
  for (int y = std::max(0, cy - 1); y <= std::min(height - 1, cy + 1); ++y)
    for (int x = std::max(0, cx - 1); x <= std::min(width - 1, cx + 1); ++x) {
      float share = 0, all = 0;
      const auto entries = view.gaussians.at(static_cast<std::size_t>(y) * width + x);
      for (const GroupWeight& w : entries) {
        share += (labels_[w.group] != 0) == object ? w.weight : 0;
        all += w.weight;
      }
      const float enough = std::min(kClearly, all);
      for (const GroupWeight& w : entries) {  // heaviest first
        if (share >= enough) break;
        if ((labels_[w.group] != 0) == object) continue;
        said_[w.group] = object ? 1 : -1;
        labels_[w.group] = object;
        share += w.weight;
      }
      if (x != cx || y != cy) continue;
      float held = 0;
      for (const GroupWeight& w : entries) {
        if (held >= enough) break;
        if ((labels_[w.group] != 0) != object) continue;
        said_[w.group] = object ? 1 : -1;
        held += w.weight;
      }
    }
}

void ClickSelection::label() {
  for (std::size_t g = 0; g < labels_.size(); ++g) {
    const std::uint32_t leaf = parts_.leaf_of[g];
    labels_[g] = said_[g] ? said_[g] > 0 : leaf != kNoPart && leaf_object_[leaf];
  }
}

bool ClickSelection::apply(const LeafView& view, const Stroke& stroke) {
  const bool object = stroke.label == SeedLabel::kObject;
  if (!any_ && !object) return false;
  const auto anything = [](std::uint32_t) { return true; };
  bool hit = false;
  spot_alone_ = false;
  for (const glm::vec2& point : stroke.points_px) {
    if (leaf_near(view, point, anything) == kNoPart) continue;
    const int x = std::clamp(static_cast<int>(point.x), 0, view.camera.width_px - 1),
              y = std::clamp(static_cast<int>(point.y), 0, view.camera.height_px - 1);
    float share = 0;
    for (const GroupWeight& w : view.gaussians.at(static_cast<std::size_t>(y) * view.camera.width_px + x))
      share += labels_[w.group] ? w.weight : 0;
    if (!any_ || (share >= 0.5f) != object)
      hit = take(view, point, object, stroke.radius_px) || hit;
    else {
      if (stroke.points_px.size() == 1) confirm(view, point, object, stroke.radius_px);
      hit = true;
    }
  }
  if (stroke.points_px.size() < 2 || !hit) return hit;
  const Image<std::uint8_t> drawn = draw_seeds({stroke}, view.camera.width_px, view.camera.height_px);
  std::vector<std::uint32_t> under;
  for (std::size_t i = 0; i < drawn.size(); ++i)
    if (drawn.pixels()[i] != kNoSeed) under.push_back(static_cast<std::uint32_t>(i));
  pin(view, under, object);
  for (const std::uint32_t pixel : under) insist(view, pixel, object);
  spot_alone_ = false;  // a scribble says itself how much is meant
  return true;
}

}  // namespace splatcut
