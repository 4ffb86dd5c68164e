#include "segment/masks/enclosed.h"

#include <algorithm>
#include <cassert>

namespace splatcut {

namespace {

enum class Visit : std::uint8_t { kNot, kThisPiece, kOpen };

// Collects one piece after the other. Pieces that turn out open stay marked, so that each Gaussian is visited
// once.
class Pieces {
 public:
  Pieces(const GaussianCloud& cloud, const FlowGraph& graph, std::span<const std::uint8_t> shown,
         const EnclosedOptions& options, std::span<const std::uint8_t> labels)
      : cloud_(cloud),
        graph_(graph),
        shown_(shown),
        options_(options),
        labels_(labels),
        visit_(cloud.size(), Visit::kNot) {
    const auto object = static_cast<float>(std::ranges::count(labels, 1));
    most_ = static_cast<std::size_t>(options.most_size * object);
  }

  bool starts_at(std::uint32_t g) const { return may_join(g) && visit_[g] == Visit::kNot; }
  bool enclosed(std::uint32_t start);  // then piece() belongs to the object
  const std::vector<std::uint32_t>& piece() const { return piece_; }

 private:
  bool may_join(std::uint32_t g) const {
    return !labels_[g] && !shown_[g] && cloud_.opacity[g] > options_.faint;
  }

  const GaussianCloud& cloud_;
  const FlowGraph& graph_;
  std::span<const std::uint8_t> shown_;
  const EnclosedOptions& options_;
  std::span<const std::uint8_t> labels_;
  std::size_t most_ = 0;
  std::vector<Visit> visit_;
  std::vector<std::uint32_t> piece_;
};

bool Pieces::enclosed(std::uint32_t start) {
  piece_.assign(1, start);
  visit_[start] = Visit::kThisPiece;
  std::size_t to_object = 0, to_rest = 0;
  bool open = false;
  for (std::size_t i = 0; i < piece_.size() && !open; ++i) {
    for (std::uint32_t arc = graph_.first_arc[piece_[i]]; arc < graph_.first_arc[piece_[i] + 1]; ++arc) {
      const std::uint32_t g = graph_.head[arc];
      to_object += labels_[g];
      to_rest += !labels_[g] && shown_[g];
      if (!may_join(g) || visit_[g] == Visit::kThisPiece) continue;
      open |= visit_[g] == Visit::kOpen;
      if (visit_[g] == Visit::kNot) {
        visit_[g] = Visit::kThisPiece;
        piece_.push_back(g);
      }
    }
    open |= piece_.size() > most_;
  }
  open |= static_cast<float>(to_object) < options_.least_object * static_cast<float>(to_object + to_rest);
  if (open)
    for (const std::uint32_t g : piece_) visit_[g] = Visit::kOpen;
  return !open;
}

}  // namespace

std::size_t join_enclosed(const GaussianCloud& cloud, const FlowGraph& graph,
                          std::span<const std::uint8_t> shown, const EnclosedOptions& options,
                          std::vector<std::uint8_t>* labels) {
  assert(shown.size() == cloud.size() && labels->size() == cloud.size() && graph.nodes() == cloud.size());
  const std::vector<std::uint8_t> before = *labels;
  Pieces pieces(cloud, graph, shown, options, before);
  std::size_t joined = 0;
  for (std::uint32_t g = 0; g < before.size(); ++g) {
    if (!before[g]) continue;
    for (std::uint32_t arc = graph.first_arc[g]; arc < graph.first_arc[g + 1]; ++arc) {
      if (!pieces.starts_at(graph.head[arc]) || !pieces.enclosed(graph.head[arc])) continue;
      joined += pieces.piece().size();
      for (const std::uint32_t of : pieces.piece()) (*labels)[of] = 1;
    }
  }
  return joined;
}

}  // namespace splatcut
