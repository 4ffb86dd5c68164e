// The search: growth, augmentation, adoption. The state around it is in max_flow_state.cpp.
#include "segment/graphcut/max_flow.h"

#include <algorithm>
#include <cassert>
#include <limits>

#include "segment/graphcut/max_flow_flags.h"

namespace splatcut {

namespace {

// Sinks hang on each other no deeper than this: a shallow forest is cheap to mend, and where it ends the
// source forest takes over. 5 to 10 were the best of 2 to 1000 on captured scenes.
constexpr std::int32_t kDeepestSink = 8;

constexpr std::size_t kScansBetweenLooks = 4096;  // at the stop token

// A warm solve starts again cold once it has done this many times the work of the last cold one.
constexpr std::size_t kWarmBudget = 2, kWarmBudgetLeast = 20000;

constexpr std::int32_t kNoLabel = std::numeric_limits<std::int32_t>::max();

}  // namespace

void MaxFlow::activate(std::uint32_t node) {
  if (flags_[node] & kActive) return;
  touch(node);
  flags_[node] |= kActive;
  const auto label = static_cast<std::size_t>(node_[node].label);
  if (label >= active_.size()) active_.resize(2 * label + 2);
  active_[label].push_back(node);
  lowest_active_ = std::min(lowest_active_, label);
}

bool MaxFlow::next_active(std::uint32_t* node) {
  while (lowest_active_ < active_.size()) {
    if (active_[lowest_active_].empty()) {
      ++lowest_active_;
      continue;
    }
    *node = active_[lowest_active_].back();
    active_[lowest_active_].pop_back();
    flags_[*node] &= static_cast<std::uint8_t>(~kActive);
    const std::int32_t label = node_[*node].label;
    if (label == static_cast<std::int32_t>(lowest_active_)) return true;
    if (label > 0) activate(*node);  // it has another label since it was put here
  }
  return false;
}

// Takes free neighbours into the source forest and sends flow across every arc that meets the sink forest.
void MaxFlow::scan(std::uint32_t node) {
  const std::int32_t label = node_[node].label;
  highest_label_ = label;
  for (std::uint32_t arc = graph_.first_arc[node]; arc < graph_.first_arc[node + 1];) {
    const std::uint32_t other = graph_.head[arc];
    if (residual_[arc] == 0 || node_[other].label > 0) {
      ++arc;
    } else if (node_[other].label == 0) {
      node_[other].label = label + 1;
      node_[other].parent = graph_.reverse_arc[arc];
      activate(other);
      ++arc;
    } else {
      augment(node, arc);
      adopt_orphans();
      if (node_[node].label == label) continue;  // the same arc again
      if (node_[node].label > 0) activate(node);
      return;
    }
  }
}

std::int32_t MaxFlow::bottleneck(std::uint32_t node, std::uint32_t bridge) const {
  std::int32_t amount = residual_[bridge];
  std::uint32_t v = node;
  for (; node_[v].parent != kRoot; v = graph_.head[node_[v].parent])
    amount = std::min(amount, residual_[graph_.reverse_arc[node_[v].parent]]);
  amount = std::min(amount, node_[v].excess);
  for (v = graph_.head[bridge]; node_[v].parent != kRoot; v = graph_.head[node_[v].parent])
    amount = std::min(amount, residual_[node_[v].parent]);
  return std::min(amount, -node_[v].excess);
}

void MaxFlow::augment(std::uint32_t node, std::uint32_t bridge) {
  const std::int32_t amount = bottleneck(node, bridge);
  assert(amount > 0);
  residual_[bridge] -= amount;
  residual_[graph_.reverse_arc[bridge]] += amount;
  positive_excess_ -= amount;
  push_from_source(node, amount);
  push_to_sink(graph_.head[bridge], amount);
}

void MaxFlow::push_from_source(std::uint32_t node, std::int32_t amount) {
  const std::size_t before = source_orphans_.size();
  for (std::uint32_t up; (up = node_[node].parent) != kRoot;) {
    const std::uint32_t down = graph_.reverse_arc[up], next = graph_.head[up];
    residual_[up] += amount;
    residual_[down] -= amount;
    if (residual_[down] == 0) orphan_source(node);
    node = next;
  }
  node_[node].excess -= amount;
  if (node_[node].excess == 0) orphan_source(node);
  // Lowest labels first: what they find serves those above them.
  std::reverse(source_orphans_.begin() + static_cast<std::ptrdiff_t>(before), source_orphans_.end());
}

void MaxFlow::push_to_sink(std::uint32_t node, std::int32_t amount) {
  const std::size_t before = sink_orphans_.size();
  for (std::uint32_t up; (up = node_[node].parent) != kRoot;) {
    const std::uint32_t next = graph_.head[up];
    residual_[graph_.reverse_arc[up]] += amount;
    residual_[up] -= amount;
    if (residual_[up] == 0) orphan_sink(node);
    node = next;
  }
  touch(node);
  node_[node].excess += amount;
  if (node_[node].excess == 0) orphan_sink(node);
  std::reverse(sink_orphans_.begin() + static_cast<std::ptrdiff_t>(before), sink_orphans_.end());
}

void MaxFlow::orphan_source(std::uint32_t node) {
  node_[node].parent = kOrphan;
  source_orphans_.push_back(node);
}

void MaxFlow::orphan_sink(std::uint32_t node) {
  touch(node);
  node_[node].parent = kOrphan;
  sink_orphans_.push_back(node);
}

void MaxFlow::adopt_orphans() {
  for (std::size_t i = 0; i < sink_orphans_.size(); ++i) adopt_sink(sink_orphans_[i]);
  for (std::size_t i = 0; i < source_orphans_.size(); ++i) adopt_source(source_orphans_[i]);
  work_ += sink_orphans_.size() + source_orphans_.size();
  sink_orphans_.clear();
  source_orphans_.clear();
}

void MaxFlow::adopt_source(std::uint32_t node) {
  if (node_[node].parent != kOrphan || node_[node].label <= 0) return;  // changed since it was orphaned
  const std::int32_t old_label = node_[node].label;
  std::int32_t lowest = kNoLabel;
  std::uint32_t parent = kOrphan;
  for (std::uint32_t arc = graph_.first_arc[node]; arc < graph_.first_arc[node + 1]; ++arc) {
    const std::int32_t label = node_[graph_.head[arc]].label;
    if (label <= 0 || label >= lowest || residual_[graph_.reverse_arc[arc]] == 0) continue;
    lowest = label;
    parent = arc;
    if (lowest < old_label) break;
  }
  // Above the label being scanned growth comes by soon and gives the right one at once, where adoption might
  // have to raise it step by step.
  if (lowest >= highest_label_) {
    leave_source_forest(node);
    node_[node].label = 0;
    return;
  }
  node_[node].parent = parent;
  if (lowest < old_label) return;
  const std::int32_t new_label = lowest + 1;
  node_[node].label = new_label;
  for (std::uint32_t arc = graph_.first_arc[node]; arc < graph_.first_arc[node + 1]; ++arc) {
    const std::uint32_t child = graph_.head[arc];
    const bool too_low = node_[child].label > 0 && node_[child].label <= new_label;
    if (too_low && node_[child].parent == graph_.reverse_arc[arc]) orphan_source(child);
  }
}

void MaxFlow::adopt_sink(std::uint32_t node) {
  if (node_[node].parent != kOrphan || node_[node].label >= 0) return;
  const std::int32_t old_label = -node_[node].label;
  std::int32_t lowest = kNoLabel;
  std::uint32_t parent = kOrphan;
  for (std::uint32_t arc = graph_.first_arc[node]; arc < graph_.first_arc[node + 1]; ++arc) {
    const std::int32_t label = -node_[graph_.head[arc]].label;
    if (label <= 0 || label >= lowest || residual_[arc] == 0) continue;
    lowest = label;
    parent = arc;
    if (lowest < old_label) break;
  }
  if (lowest >= kDeepestSink) {
    leave_sink_forest(node);
    node_[node].label = 0;
    return;
  }
  node_[node].parent = parent;
  if (lowest < old_label) return;
  const std::int32_t new_label = lowest + 1;
  node_[node].label = -new_label;
  for (std::uint32_t arc = graph_.first_arc[node]; arc < graph_.first_arc[node + 1]; ++arc) {
    const std::uint32_t child = graph_.head[arc];
    const bool too_low = node_[child].label < 0 && -node_[child].label <= new_label;
    if (too_low && node_[child].parent == graph_.reverse_arc[arc]) orphan_sink(child);
  }
}

// Its children lose their parent; source nodes that may now find it free, or in the other forest, look again.
void MaxFlow::leave_source_forest(std::uint32_t node) {
  for (std::uint32_t arc = graph_.first_arc[node]; arc < graph_.first_arc[node + 1]; ++arc) {
    const std::uint32_t other = graph_.head[arc], back = graph_.reverse_arc[arc];
    if (node_[other].label <= 0) continue;
    if (node_[other].parent == back) orphan_source(other);
    if (residual_[back] > 0) activate(other);
  }
}

void MaxFlow::leave_sink_forest(std::uint32_t node) {
  for (std::uint32_t arc = graph_.first_arc[node]; arc < graph_.first_arc[node + 1]; ++arc) {
    const std::uint32_t other = graph_.head[arc];
    if (node_[other].label < 0 && node_[other].parent == graph_.reverse_arc[arc]) orphan_sink(other);
  }
}

bool MaxFlow::over_budget() const {
  return warm_ && work_ > kWarmBudget * work_when_cold_ + kWarmBudgetLeast;
}

bool MaxFlow::solve(const Job& job) {
  if (!warm_) ++cold_starts_;
  highest_label_ = 1;
  work_ = 0;
  adopt_orphans();
  std::size_t scans = 0;
  for (std::uint32_t node; next_active(&node);) {
    scan(node);
    ++work_;
    if (++scans % kScansBetweenLooks != 0) continue;
    if (job.cancelled()) return false;
    if (over_budget()) {
      restart();
      ++cold_starts_;
      work_ = 0;
    }
  }
  if (!warm_) work_when_cold_ = work_;
  warm_ = true;
  return true;
}

}  // namespace splatcut
