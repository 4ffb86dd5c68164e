#include "segment/selection/candidates.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "segment/selection/click_reach.h"
#include "segment/selection/first_meanings.h"
#include "segment/selection/levels_in_view.h"
#include "segment/selection/part_terms.h"
#include "segment/selection/part_votes.h"

namespace splatcut {

namespace {

constexpr float kPi = std::numbers::pi_v<float>;
// Where each term begins to cost: logarithms of ratios, or shares.
constexpr float kCentral = 0.7f;
constexpr float kScrapFolds = -0.3f, kFoldSlack = 1, kGiantFolds = 3.25f, kHiddenFolds = 2,
                kTakesFolds = 0.4f, kGrowsFolds = 0.7f;
constexpr float kBorderPx = 2;
constexpr float kLeastCut = -16;  // of a part that touches nothing

float& term(Candidate* candidate, Term which) {
  return weight(&candidate->terms, which);
}

float at_least_0(float value) {
  return std::max(0.0f, value);
}

std::vector<float> at_nodes(const std::vector<float>& all, std::span<const std::uint32_t> nodes) {
  std::vector<float> some;
  for (const std::uint32_t node : nodes) some.push_back(all[node]);
  return some;
}

std::vector<std::uint32_t> levels(const PartTree& tree, std::size_t leaves,
                                  std::span<const std::uint32_t> chain) {
  std::vector<std::uint32_t> level(tree.nodes(), kNoLevel);
  for (std::size_t i = 0; i < chain.size(); ++i) level[chain[i]] = static_cast<std::uint32_t>(i);
  for (std::size_t node = tree.nodes(); node-- > 0;)  // parents before their children
    if (level[node] == kNoLevel && tree.parent[node] != kNoPart) level[node] = level[tree.parent[node]];
  level.resize(leaves);
  return level;
}

float jump(const PartTree& tree, std::uint32_t node) {
  const std::uint32_t up = tree.parent[node];
  if (up == kNoPart) return 0;
  const float folds = std::max(tree.merge_cost[up], 1e-6f) / std::max(tree.merge_cost[node], 0.1f);
  return std::clamp(std::log(folds), 0.0f, 2.0f);
}

// One click: its inputs and what is computed of it.
class Asking {
 public:
  Asking(const PartHierarchy& parts, const SelectedParts& selected, const Click& click,
         const SelectionModel& model)
      : parts_(parts),
        selected_(selected),
        click_(click),
        model_(model),
        weights_(click.first ? model.first : model.later),
        camera_(click.view.camera) {}

  Answers take(const AnswerOptions& options) {
    make_chains();
    if (click_.first) sum_looks(options.close_up);
    find_free();
    measure_stability();
    for (std::size_t c = 0; c < out_.chains.size(); ++c) add_candidates(c, options);
    if (!click_.first) {
      add_back_terms();
      add_apart_terms();
      add_other_meaning();
      add_disc();
    }
    sort();
    measure_off_centre(options.all_terms);
    return std::move(out_);
  }

 private:
  bool wrong_side(std::uint32_t leaf) const { return (selected_.object[leaf] != 0) != click_.object; }
  void make_chains();
  void sum_looks(bool close_up);
  void find_free();
  std::vector<float> compared_areas() const;
  void measure_stability();
  void add_candidates(std::size_t chain, const AnswerOptions& options);
  bool holds_correction_before(const Chain& chain, std::size_t index) const;
  void add_size_terms(const Chain& chain, Candidate* candidate) const;
  float folds(float px) const {
    return std::log(std::max(px, 1.0f) / (kPi * click_.radius_px * click_.radius_px));
  }
  void add_back_terms();
  void add_other_meaning();
  Chain changed_to(const std::vector<std::uint8_t>& meant) const;
  void add_first_meaning(Chain chain, const TermValues& terms);
  void add_disc();
  void add_apart_terms();
  void measure_off_centre(bool all);
  const LevelsInView& levels_of(std::size_t chain);
  void sort();

  const PartHierarchy& parts_;
  const SelectedParts& selected_;
  const Click& click_;
  const SelectionModel& model_;
  const TermValues& weights_;
  const Camera& camera_;
  float object_px_ = 0;               // selected so far
  std::vector<float> wrong_px_;       // per leaf: its pixels if a candidate may change it
  std::vector<LevelsInView> levels_;  // per chain
  Answers out_;
};

void Asking::sort() {
  for (Candidate& c : out_.candidates) c.cost = cost_of(c.terms, weights_);
  constexpr float kMostOtherMeaning = 0.4f;
  std::erase_if(out_.candidates, [](const Candidate& c) {
    return weight(c.terms, Term::kAgreed) != 0 && c.cost > kMostOtherMeaning;
  });
  std::ranges::stable_sort(out_.candidates, {}, &Candidate::cost);
}

void Asking::make_chains() {
  std::vector<float> opposed(parts_.leaves, 0);
  for (const std::uint32_t leaf : selected_.clicked[!click_.object])
    if (leaf != click_.leaf) opposed[leaf] += 1;
  for (std::size_t t = 0; t < parts_.trees.size(); ++t) {
    const PartTree& tree = parts_.trees[t];
    Chain chain;
    chain.shade_blind = t >= parts_.plain_trees;
    for (std::uint32_t node = click_.leaf; node != kNoPart; node = tree.parent[node])
      chain.nodes.push_back(node);
    chain.view_px = at_nodes(summed(tree, click_.view.leaf_px), chain.nodes);
    chain.frame_px = at_nodes(summed(tree, click_.view.leaf_frame_px), chain.nodes);
    chain.opposed = at_nodes(summed(tree, opposed), chain.nodes);
    chain.level = levels(tree, parts_.leaves, chain.nodes);
    out_.chains.push_back(std::move(chain));
  }
}

// The observing views', and the click's own view as one more of them, but for a close-up: it may crop what is
// meant, and so speak against it.
void Asking::sum_looks(bool close_up) {
  const std::vector<std::vector<PartLooks>> here = looks_in(parts_, picture_of(click_.view));
  for (std::size_t t = 0; t < parts_.trees.size(); ++t) {
    const std::vector<PartLooks>& elsewhere = parts_.trees[t].looks;
    const bool own = !close_up || elsewhere.empty() || !(elsewhere[click_.leaf].area > 0);
    for (const std::uint32_t node : out_.chains[t].nodes) {
      PartLooks& looks = out_.chains[t].looks.emplace_back(own ? here[t][node] : PartLooks{});
      if (!elsewhere.empty()) looks += elsewhere[node];
    }
  }
}

// A leaf follows where, in nearer_majority of the trees, it meets no click of the other sign below its common
// ancestor with this click.
void Asking::find_free() {
  std::vector<float> votes(parts_.leaves, 0);
  for (const Chain& chain : out_.chains) {
    const auto reach = static_cast<std::uint32_t>(
        std::ranges::find_if(chain.opposed, [](float n) { return n > 0; }) - chain.opposed.begin());
    for (std::uint32_t leaf = 0; leaf < parts_.leaves; ++leaf) votes[leaf] += chain.level[leaf] < reach;
  }
  const float enough = model_.nearer_majority * static_cast<float>(out_.chains.size());
  out_.free.resize(parts_.leaves);
  wrong_px_.assign(parts_.leaves, 0);
  for (std::uint32_t leaf = 0; leaf < parts_.leaves; ++leaf) {
    out_.free[leaf] = votes[leaf] >= enough;
    if (out_.free[leaf] && wrong_side(leaf)) wrong_px_[leaf] = click_.view.leaf_px[leaf];
    if (selected_.object[leaf]) object_px_ += click_.view.leaf_px[leaf];
  }
}

// Per leaf, what of it counts where two parts are compared: what would change of the picture; of a first
// click what all views show of it.
std::vector<float> Asking::compared_areas() const {
  std::vector<float> areas = wrong_px_;
  const float picture_px = static_cast<float>(camera_.width_px) * static_cast<float>(camera_.height_px);
  for (float& area : areas) area /= picture_px;
  const std::vector<PartLooks>& looks = parts_.trees.front().looks;
  if (click_.first && !looks.empty())
    for (std::uint32_t leaf = 0; leaf < parts_.leaves; ++leaf) areas[leaf] += looks[leaf].area;
  return areas;
}

// IoU of every two candidates of every two trees of a kind by one histogram of levels.
void Asking::measure_stability() {
  std::vector<float> wrong_area(parts_.leaves, 0);
  for (std::uint32_t leaf = 0; leaf < parts_.leaves; ++leaf)
    if (out_.free[leaf] && wrong_side(leaf)) wrong_area[leaf] = parts_.leaf_area[leaf];
  const std::vector<float> compared = compared_areas();
  const float least = 1 / (static_cast<float>(camera_.width_px) * static_cast<float>(camera_.height_px));
  std::vector<std::vector<float>> all;  // per chain and node
  for (std::size_t t = 0; t < out_.chains.size(); ++t) {
    Chain& chain = out_.chains[t];
    chain.changed_px = at_nodes(summed(parts_.trees[t], wrong_px_), chain.nodes);
    if (!click_.first) chain.changed_area = at_nodes(summed(parts_.trees[t], wrong_area), chain.nodes);
    all.push_back(at_nodes(summed(parts_.trees[t], compared), chain.nodes));
    chain.stability.assign(chain.nodes.size(), 0);
  }
  for (std::size_t t = 0; t < out_.chains.size(); ++t) {
    Chain& a = out_.chains[t];
    std::size_t others = 0;
    for (std::size_t u = 0; u < out_.chains.size(); ++u) {
      const Chain& b = out_.chains[u];
      if (t == u || a.shade_blind != b.shade_blind) continue;
      ++others;
      const std::size_t rows = a.nodes.size(), columns = b.nodes.size();
      std::vector<float> both(rows * columns, 0);
      for (std::uint32_t leaf = 0; leaf < parts_.leaves; ++leaf)
        if (compared[leaf] > 0 && a.level[leaf] != kNoLevel && b.level[leaf] != kNoLevel)
          both[a.level[leaf] * columns + b.level[leaf]] += compared[leaf];
      for (std::size_t i = 0; i < rows; ++i) {
        float row = 0, best = 0;
        for (std::size_t j = 0; j < columns; ++j) {
          row += both[i * columns + j];
          both[i * columns + j] = row + (i ? both[(i - 1) * columns + j] : 0);
          const float either = all[t][i] + all[u][j] - both[i * columns + j];
          best = std::max(best, both[i * columns + j] / std::max(either, least));
        }
        a.stability[i] += best;
      }
    }
    for (float& s : a.stability) s = others ? s / static_cast<float>(others) : 1;
  }
}

const LevelsInView& Asking::levels_of(std::size_t c) {
  levels_.resize(out_.chains.size());
  if (!levels_[c].of_pixel.empty()) return levels_[c];
  const Chain& chain = out_.chains[c];
  std::vector<std::uint32_t> joins = chain.level;
  for (std::uint32_t leaf = 0; leaf < parts_.leaves; ++leaf)
    if (chain.of_tree && !(wrong_px_[leaf] > 0)) joins[leaf] = kNoLevel;
  return levels_[c] = levels_in_view(click_.view, joins, chain.nodes.size());
}

void Asking::add_size_terms(const Chain& chain, Candidate* candidate) const {
  const float changed_px = chain.changed_px[candidate->index];
  const float f = folds(changed_px);
  term(candidate, Term::kScrap) = at_least_0(kScrapFolds - f);
  term(candidate, Term::kFold) = at_least_0(f - kFoldSlack);
  term(candidate, Term::kGiant) = at_least_0(f - kGiantFolds);
  term(candidate, Term::kBorder) = click_.radius_px < kBorderPx ? at_least_0(f - kFoldSlack) : 0;
  if (weight(candidate->terms, Term::kRepick) > 0) return;  // small, whatever share of the object it is
  if (!click_.object) {
    constexpr float kLeastLeft = 0.02f;
    const float left = std::max(1 - changed_px / std::max(object_px_, 1.0f), kLeastLeft);
    term(candidate, Term::kTakes) = at_least_0(-std::log(left) - kTakesFolds);
  } else if (!selected_.changes.empty() && object_px_ >= 1) {
    term(candidate, Term::kTakes) = at_least_0(std::log1p(changed_px / object_px_) - kGrowsFolds);
  }
  if (!chain.of_tree) return;  // another meaning of the first click: most of it is out of sight by nature
  const float px_per_unit =
      camera_.fx_px / std::max(camera_.camera_from_world(parts_.leaf_centre_world[click_.leaf]).z, 1e-15f);
  const float area_px = chain.changed_area[candidate->index] * px_per_unit * px_per_unit;
  const float shown_px = std::max(changed_px, kPi * click_.radius_px * click_.radius_px);
  term(candidate, Term::kHidden) = at_least_0(std::log(std::max(area_px, 1.0f) / shown_px) - kHiddenFolds);
}

bool Asking::holds_correction_before(const Chain& chain, std::size_t index) const {
  constexpr std::size_t kFirstCorrections = 5;  // those after them mend details
  if (selected_.boxed || selected_.changes.empty() || selected_.changes.size() >= kFirstCorrections)
    return false;
  const Change& before = selected_.changes.back();
  return before.object == click_.object && before.clicked != kNoPart && chain.level[before.clicked] <= index;
}

void Asking::add_candidates(std::size_t c, const AnswerOptions& options) {
  const Chain& chain = out_.chains[c];
  const PartTree& tree = parts_.trees[c];
  float last_px = 0;
  for (std::size_t i = 0; i < chain.nodes.size(); ++i) {
    if (chain.changed_px[i] < std::max(kLeastChangePx, options.least_growth * last_px)) continue;
    last_px = chain.changed_px[i];
    Candidate candidate{.chain = c, .index = i};
    term(&candidate, Term::kCut) = log_cut(tree, chain.nodes[i], click_.first ? kLeastFirstCut : kLeastCut);
    term(&candidate, Term::kJump) = jump(tree, chain.nodes[i]);
    term(&candidate, Term::kRare) = -std::log(std::max(chain.stability[i], 0.01f));
    term(&candidate, Term::kShadeBlind) = chain.shade_blind;
    term(&candidate, Term::kOpposed) = chain.opposed[i];
    if (click_.first) {
      set_look_terms(chain.looks[i], &candidate.terms);
    } else {
      term(&candidate, Term::kFrame) = chain.frame_px[i] / std::sqrt(std::max(chain.view_px[i], 1.0f));
      add_size_terms(chain, &candidate);
      term(&candidate, Term::kAgain) = holds_correction_before(chain, i);
    }
    out_.candidates.push_back(candidate);
  }
}

void Asking::add_back_terms() {
  for (const Change& change : selected_.changes) {
    if (change.object == click_.object) continue;
    std::vector<std::vector<float>> both(out_.chains.size()), all(out_.chains.size());
    for (std::size_t c = 0; c < out_.chains.size(); ++c) {
      const Chain& chain = out_.chains[c];
      both[c].assign(chain.nodes.size(), 0);
      all[c].assign(chain.nodes.size(), 0);
      for (const std::uint32_t leaf : change.leaves)
        if (chain.level[leaf] != kNoLevel && wrong_side(leaf))
          both[c][chain.level[leaf]] += parts_.leaf_area[leaf];
      for (std::uint32_t leaf = 0; leaf < parts_.leaves; ++leaf)
        if (chain.level[leaf] != kNoLevel && wrong_side(leaf))
          all[c][chain.level[leaf]] += parts_.leaf_area[leaf];
      for (std::size_t i = 1; i < all[c].size(); ++i) {
        both[c][i] += both[c][i - 1];
        all[c][i] += all[c][i - 1];
      }
    }
    float change_area = 0;
    for (const std::uint32_t leaf : change.leaves) change_area += parts_.leaf_area[leaf];
    for (Candidate& c : out_.candidates) {
      const float common = both[c.chain][c.index], either = all[c.chain][c.index] + change_area - common;
      float& back = term(&c, Term::kBack);
      back = std::max(back, common / std::max(either, 1e-30f));
    }
  }
}

// A correction may also say that what was said first meant another part. The part that the trees agree on is
// one more candidate, or the likeliest part, if a click on the rest corrects a click and changes little by
// it.
void Asking::add_other_meaning() {
  if (!selected_.meanings) return;
  const std::vector<PartMeaning> left = meanings_left(parts_, selected_, click_.leaf, click_.object);
  if (left.empty()) return;
  const AgreedMeaning agreed = agreed_meaning(parts_, left, click_.view.leaf_px);
  TermValues terms{};
  weight(&terms, Term::kDoubtful) = agreed.doubt;
  if (selected_.boxed || click_.object) {
    weight(&terms, Term::kDearer) = left.front().cost - selected_.meanings->front().cost;
  } else {
    Chain likeliest = changed_to(leaves_of(parts_, left.front().tree, left.front().node));
    const float px = likeliest.changed_px.front();
    if (selected_.clicked[1].size() == 1 && px >= kLeastChangePx && folds(px) <= kFoldSlack) {
      weight(&terms, Term::kRepick) = 1;
      add_first_meaning(std::move(likeliest), terms);
      return;
    }
  }
  weight(&terms, Term::kAgreed) = 1;
  add_first_meaning(changed_to(agreed.leaves), terms);
}

// The leaves that take the click's side if `meant` is the object. Leaves that a disc has decided stay.
Chain Asking::changed_to(const std::vector<std::uint8_t>& meant) const {
  Chain chain;
  chain.of_tree = false;
  chain.nodes = {click_.leaf};
  chain.level.assign(parts_.leaves, kNoLevel);
  const std::int8_t against = click_.object ? -1 : 1;
  float px = 0;
  for (std::uint32_t leaf = 0; leaf < parts_.leaves; ++leaf)
    if (wrong_side(leaf) && (meant[leaf] != 0) == click_.object && selected_.said[leaf] != against) {
      chain.level[leaf] = 0;
      px += click_.view.leaf_px[leaf];
    }
  chain.changed_px = {px};
  return chain;
}

void Asking::add_first_meaning(Chain chain, const TermValues& terms) {
  if (chain.changed_px.front() < kLeastChangePx) return;
  Candidate candidate{.chain = out_.chains.size(), .index = 0, .terms = terms};
  add_size_terms(chain, &candidate);
  out_.chains.push_back(std::move(chain));
  out_.candidates.push_back(candidate);
}

// kApart: how much of what changes the click does not reach. What it mostly does not reach was hardly meant
// twice.
void Asking::add_apart_terms() {
  std::vector<std::vector<float>> shares(out_.chains.size());
  for (Candidate& candidate : out_.candidates) {
    const Chain& chain = out_.chains[candidate.chain];
    std::vector<float>& of_chain = shares[candidate.chain];
    if (of_chain.empty())
      of_chain = shares_out_of_reach(levels_of(candidate.chain).of_pixel, chain.nodes.size(),
                                     click_.view.steps, click_.at);
    const float apart = of_chain[candidate.index];
    term(&candidate, Term::kApart) = apart;
    term(&candidate, Term::kAgain) *= std::min(1.0f, 2 * (1 - apart));
  }
}

void Asking::add_disc() {
  Candidate disc{.chain = 0, .index = Candidate::kDiscAlone};
  term(&disc, Term::kDisc) = 1;
  out_.candidates.push_back(disc);
}

// kOffCentre, of the likeliest candidates first, until none that is left can win, as it only adds; drops
// those unless all are wanted. A first click keeps more of them: a later click on the background may choose
// another.
void Asking::measure_off_centre(bool all) {
  constexpr float kUnlikely = 5;  // 150 times less likely than the likeliest
  const float margin = click_.first ? kUnlikely : 0;
  const float dear = weight(weights_, Term::kOffCentre);
  float best = std::numeric_limits<float>::max();
  std::size_t looked_at = 0;
  for (Candidate& candidate : out_.candidates) {
    if (!all && candidate.cost > best + margin) break;
    ++looked_at;
    const bool of_tree = candidate.index != Candidate::kDiscAlone && out_.chains[candidate.chain].of_tree;
    if (of_tree) {
      const float central = centrality(levels_of(candidate.chain), candidate.index, click_.at);
      const float off = at_least_0(std::log(kCentral / central));
      term(&candidate, Term::kOffCentre) = off;
      candidate.cost += dear * off;
    }
    best = std::min(best, candidate.cost);
  }
  out_.unlikely.assign(out_.candidates.begin() + static_cast<std::ptrdiff_t>(looked_at),
                       out_.candidates.end());
  out_.candidates.resize(looked_at);
  std::ranges::stable_sort(out_.candidates, {}, &Candidate::cost);
}

}  // namespace

Answers answers(const PartHierarchy& parts, const SelectedParts& selected, const Click& click,
                const SelectionModel& model, const AnswerOptions& options) {
  return Asking(parts, selected, click, model).take(options);
}

}  // namespace splatcut
