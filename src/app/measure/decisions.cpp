#include "app/measure/decisions.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "segment/masks/mask_tools.h"
#include "segment/selection/box_meanings.h"
#include "segment/selection/click_selection.h"
#include "segment/selection/part_terms.h"

namespace splatcut {

namespace {

// Per node of the chain: pixels of the truth that show object, and others that do.
struct Shown {
  std::vector<double> right, extra;
};

// Per pixel: the object's share.
std::vector<float> object_shares(const LeafView& view, std::span<const std::uint8_t> labels) {
  std::vector<float> shares;
  for (std::size_t i = 0; i + 1 < view.gaussians.first.size(); ++i) {
    float share = 0;
    for (const GroupWeight& w : view.gaussians.at(i)) share += labels[w.group] ? w.weight : 0;
    shares.push_back(share);
  }
  return shares;
}

// From the shares as they stand: what each node of the chain would make of the view. A leaf counts whole,
// though a disc may hold some of its Gaussians: that is of the order of the disc itself.
Shown shown_by_level(const LeafView& view, std::span<const float> shares, const Mask& truth,
                     const ClickSelection& selection, const Answers& answers, std::size_t chain,
                     bool object) {
  const Chain& of = answers.chains[chain];
  const std::size_t nodes = of.nodes.size();
  std::vector<double> right(nodes + 1, 0), extra(nodes + 1, 0);  // changes at each index
  double right_now = 0, extra_now = 0;
  std::vector<std::pair<std::uint32_t, float>> list;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    float share = shares[i];
    const bool now = share >= 0.5f, is_truth = truth.pixels()[i] != 0;
    (is_truth ? right_now : extra_now) += now;
    if (now == object) continue;
    list.clear();
    for (const GroupWeight& w : view.leaves.at(i)) {
      const bool changes = (selection.selected().object[w.group] != 0) != object &&
                           of.level[w.group] != kNoLevel && (answers.free[w.group] || !of.of_tree) &&
                           selection.selected().said[w.group] != (object ? -1 : 1);
      if (changes) list.emplace_back(of.level[w.group], w.weight);
    }
    std::ranges::sort(list);
    for (const auto& [level, weight] : list) {
      share += object ? weight : -weight;
      if ((share >= 0.5f) != object) continue;
      (is_truth ? right : extra)[level] += object ? 1 : -1;
      break;
    }
  }
  Shown sums;
  for (std::size_t i = 0; i < nodes; ++i) {
    sums.right.push_back(right_now += right[i]);
    sums.extra.push_back(extra_now += extra[i]);
  }
  return sums;
}

// The candidates' mean IoU over the views, on top of what the disc alone does.
std::vector<Meaning> worth(const PartsScene& scene, const ClickSelection& after_disc, const Answers& answers,
                           bool object) {
  std::vector<std::vector<double>> iou_of(answers.chains.size());
  for (std::size_t c = 0; c < answers.chains.size(); ++c) iou_of[c].assign(answers.chains[c].nodes.size(), 0);
  double disc_iou = 0;
  for (std::size_t v = 0; v < scene.truths.size(); ++v) {
    const Mask& truth = scene.truths[v].truth;
    const auto all = static_cast<double>(count(truth));
    const std::vector<float> shares = object_shares(scene.views[v], after_disc.labels());
    for (std::size_t c = 0; c < answers.chains.size(); ++c) {
      const Shown sums = shown_by_level(scene.views[v], shares, truth, after_disc, answers, c, object);
      for (std::size_t i = 0; i < sums.right.size(); ++i)
        iou_of[c][i] += sums.right[i] / (all + sums.extra[i]);
    }
    disc_iou += iou(truth, shown(scene.views[v].gaussians, scene.views[v].camera, after_disc.labels()));
  }
  const auto views = static_cast<double>(scene.truths.size());
  std::vector<Meaning> meanings;
  for (const Candidate& c : answers.candidates)
    meanings.push_back(
        {c.terms, static_cast<float>(
                      (c.index == Candidate::kDiscAlone ? disc_iou : iou_of[c.chain][c.index]) / views)});
  return meanings;
}

// The parts that a box can mean, worth the IoU of their soft pixels with the truth's, mean over the views.
std::vector<Meaning> worth_of_boxed(const PartsScene& scene, const LeafView& view, const Stroke& stroke,
                                    const SelectionModel& model) {
  const PartHierarchy& parts = scene.parts;
  const BoxPx box = box_in_picture(stroke, view.camera.width_px, view.camera.height_px);
  const std::vector<PartMeaning> found = BoxMeanings(parts, view, box, model.box).all();
  std::vector<Meaning> meanings;
  for (const PartMeaning& m : found) meanings.push_back({m.terms, 0});
  for (std::size_t v = 0; v < scene.truths.size(); ++v) {
    const Mask& truth = scene.truths[v].truth;
    std::vector<float> right(parts.leaves, 0);
    for (std::size_t i = 0; i < truth.size(); ++i)
      if (truth.pixels()[i])
        for (const GroupWeight& w : scene.views[v].leaves.at(i)) right[w.group] += w.weight;
    std::vector<std::vector<float>> right_of, all_of;
    for (const PartTree& tree : parts.trees) {
      right_of.push_back(summed(tree, right));
      all_of.push_back(summed(tree, scene.views[v].leaf_px));
    }
    const auto truth_px = static_cast<float>(count(truth)), views = static_cast<float>(scene.truths.size());
    for (std::size_t m = 0; m < found.size(); ++m) {
      const float both = right_of[found[m].tree][found[m].node];
      meanings[m].iou += both / (truth_px + all_of[found[m].tree][found[m].node] - both) / views;
    }
  }
  return meanings;
}

SelectionModel disc_alone(SelectionModel model) {
  weight(&model.later, Term::kDisc) = -1e6f;
  return model;
}

}  // namespace

std::vector<Decision> decisions_of(const PartsScene& scene, const SelectionModel& model,
                                   const AnyViewStart& start, int clicks) {
  std::vector<Decision> decisions;
  const AnyViewWorld world = parts_world(scene, model);
  const AnyViewSession played = any_view_session(world, start, clicks);
  ClickSelection selection(scene.parts, model);
  for (const ViewClick& click : played.clicks) {
    const LeafView& view = view_of(scene, click.camera);
    const glm::vec2 pixel = click.stroke.points_px.front();
    const bool object = click.stroke.label == SeedLabel::kObject, first = &click == &played.clicks.front();
    if (click.stroke.is_box()) {
      decisions.push_back({0, DecisionOf::kBox, worth_of_boxed(scene, view, click.stroke, model)});
      selection.apply(view, click.stroke);
      continue;
    }
    if (const auto answers =
            selection.considered(view, pixel, object, {.all_terms = true, .least_growth = 1.05f})) {
      ClickSelection after_disc = selection;
      if (!first) {
        after_disc.set_model(disc_alone(model));
        after_disc.apply(view, click.stroke);
      }
      decisions.push_back({0, first ? DecisionOf::kFirstClick : DecisionOf::kCorrection,
                           worth(scene, after_disc, *answers, object)});
    }
    selection.apply(view, click.stroke);
  }
  return decisions;
}

namespace {

using Vector = std::array<double, kTerms>;

// Adam's running means of slope and squared slope.
class Ascent {
 public:
  explicit Ascent(const TermFitOptions& options) : options_(options) {}

  void step(const Vector& slope, Vector* weight) {
    constexpr double kMomentum = 0.9, kSquare = 0.999, kTiny = 1e-8;
    constexpr double kCalmFrom = 0.7, kCalm = 0.3;  // the last steps are smaller
    ++steps_;
    const double rate = options_.rate * (steps_ > kCalmFrom * options_.steps ? kCalm : 1);
    for (std::size_t t = 0; t < kTerms; ++t) {
      momentum_[t] = kMomentum * momentum_[t] + (1 - kMomentum) * slope[t];
      square_[t] = kSquare * square_[t] + (1 - kSquare) * slope[t] * slope[t];
      const double mean = momentum_[t] / (1 - std::pow(kMomentum, steps_)),
                   spread = std::sqrt(square_[t] / (1 - std::pow(kSquare, steps_)));
      (*weight)[t] += rate * mean / (spread + kTiny);
    }
  }

 private:
  const TermFitOptions& options_;
  int steps_ = 0;
  Vector momentum_{}, square_{};
};

// Standard deviation of each term over all candidates.
Vector spreads(const std::vector<const Decision*>& of) {
  Vector sum{}, squares{};
  double n = 0;
  for (const Decision* d : of)
    for (const Meaning& m : d->meanings) {
      ++n;
      for (std::size_t t = 0; t < kTerms; ++t) {
        sum[t] += m.terms[t];
        squares[t] += static_cast<double>(m.terms[t]) * m.terms[t];
      }
    }
  for (std::size_t t = 0; t < kTerms; ++t) {
    const double mean = sum[t] / n;
    sum[t] = std::sqrt(std::max(0.0, squares[t] / n - mean * mean));
  }
  return sum;
}

// Adds the slope of the expected IoU of one decision.
void add_slope(const Decision& decision, const Vector& weight, const Vector& unit, double share,
               Vector* slope) {
  std::vector<double> chance;
  double most = -std::numeric_limits<double>::max(), sum = 0, expected = 0;
  for (const Meaning& m : decision.meanings) {
    double score = 0;
    for (std::size_t t = 0; t < kTerms; ++t) score -= weight[t] * unit[t] * m.terms[t];
    chance.push_back(score);
    most = std::max(most, score);
  }
  for (double& c : chance) sum += c = std::exp(c - most);
  for (std::size_t i = 0; i < chance.size(); ++i) expected += (chance[i] /= sum) * decision.meanings[i].iou;
  for (std::size_t i = 0; i < chance.size(); ++i) {
    const double pull = share * chance[i] * (decision.meanings[i].iou - expected);
    for (std::size_t t = 0; t < kTerms; ++t) (*slope)[t] -= pull * unit[t] * decision.meanings[i].terms[t];
  }
}

}  // namespace

TermValues fitted_terms(std::span<const Decision> decisions, DecisionOf which,
                        const std::vector<bool>& in_scene, const TermFitOptions& options) {
  std::vector<const Decision*> of;
  std::vector<double> of_scene(in_scene.size(), 0);
  for (const Decision& d : decisions)
    if (d.of == which && in_scene[d.scene] && !d.meanings.empty()) {
      of.push_back(&d);
      ++of_scene[d.scene];
    }
  const auto scenes = static_cast<double>(std::ranges::count_if(of_scene, [](double n) { return n > 0; }));
  Vector unit = spreads(of), weight{};  // terms are measured in their spread
  constexpr double kSame = 1e-6;        // a term that is the same for all says nothing
  for (std::size_t t = 0; t < kTerms; ++t)
    unit[t] = unit[t] > kSame && !(options.without >> t & 1) ? 1 / unit[t] : 0;
  Ascent ascent(options);
  for (int step = 0; step < options.steps; ++step) {
    Vector slope{};
    for (const Decision* d : of) add_slope(*d, weight, unit, 1 / (of_scene[d->scene] * scenes), &slope);
    for (std::size_t t = 0; t < kTerms; ++t) slope[t] -= 2 * options.shrink * weight[t];
    ascent.step(slope, &weight);
  }
  TermValues fitted{};
  for (std::size_t t = 0; t < kTerms; ++t) fitted[t] = static_cast<float>(weight[t] * unit[t]);
  return fitted;
}

}  // namespace splatcut
