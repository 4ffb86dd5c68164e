#include "segment/finish/filling.h"

#include <algorithm>
#include <array>
#include <limits>

#include "segment/masks/mask_tools.h"

namespace splatcut {

namespace {

constexpr int kRimPx = 4;
constexpr int kBorderPx = 1;  // of the surface: its splats would stick out of what they are copied to

struct Candidate {
  glm::ivec2 moved;
  std::size_t fills;
};

// Each of the cells becomes the mean of those beside it, again and again.
void relax(const Mask& within, const std::vector<glm::ivec2>& cells, Image<glm::vec3>* values) {
  constexpr int kSweeps = 400;
  constexpr std::array<glm::ivec2, 4> kBeside = {{{1, 0}, {-1, 0}, {0, 1}, {0, -1}}};
  for (int sweep = 0; sweep < kSweeps; ++sweep)
    for (const glm::ivec2& c : cells) {
      glm::vec3 sum{0};
      float beside = 0;
      for (const glm::ivec2& step : kBeside)
        if (is_set(within, c + step)) {
          sum += values->at(c.x + step.x, c.y + step.y);
          ++beside;
        }
      if (beside > 0) values->at(c.x, c.y) = sum / beside;
    }
}

}  // namespace

Filling::Filling(const Ground& ground, const Mask& hole)
    : colour_(ground.colour),
      known_(mask_of([&](auto c) {
        return is_set(ground.well_covered, c) && is_set(ground.clear, c) && !is_set(hole, c);
      })),
      source_(eroded(known_, kBorderPx)),
      left_(dilated(hole, 1)) {}

std::optional<Piece> Filling::next(const Job& job) const {
  const std::vector<glm::ivec2> cells = cells_of(left_);
  const PixelRect from = bounds(source_), to = bounds(left_);
  if (cells.empty() || from.empty()) return {};
  std::vector<Candidate> candidates;
  std::size_t most = 0;
  constexpr int kStep = 2;
  for (int dy = from.y0 - to.y1; dy < from.y1 - to.y0 && !job.cancelled(); dy += kStep)
    for (int dx = from.x0 - to.x1; dx < from.x1 - to.x0; dx += kStep) {
      const glm::ivec2 moved(dx, dy);
      const auto fills = static_cast<std::size_t>(
          std::ranges::count_if(cells, [&](const glm::ivec2& c) { return is_set(source_, c + moved); }));
      if (fills > 0) candidates.push_back({moved, fills});
      most = std::max(most, fills);
    }
  constexpr double kNearlyMost = 0.9;
  std::optional<Piece> best;
  float least = std::numeric_limits<float>::infinity();
  const std::vector<glm::ivec2> rim = cells_of(rim_of(left_));
  for (const Candidate& candidate : candidates) {
    if (static_cast<double>(candidate.fills) < kNearlyMost * static_cast<double>(most)) continue;
    Piece piece{.cells = {}, .moved = candidate.moved};
    const float error = error_along(rim, &piece);
    if (best && error >= least) continue;
    least = error;
    best = std::move(piece);
  }
  if (best)
    best->cells = mask_of([&](auto c) { return is_set(left_, c) && is_set(source_, c + best->moved); });
  return best;
}

Image<glm::vec3> Filling::fill(const Piece& piece) {
  Image<glm::vec3> difference = carried_inwards(piece);
  for (const glm::ivec2& c : cells_of(piece.cells)) {
    const glm::ivec2 there = c + piece.moved;
    colour_.at(c.x, c.y) = colour_.at(there.x, there.y) + difference.at(c.x, c.y);
    known_.at(c.x, c.y) = kMaskObject;
    left_.at(c.x, c.y) = 0;
  }
  return difference;
}

Mask Filling::rim_of(const Mask& cells) const {
  const Mask around = dilated(cells, kRimPx);
  return mask_of([&](auto c) { return is_set(around, c) && !is_set(cells, c) && is_set(known_, c); });
}
glm::vec3 Filling::difference_at(const glm::ivec2& c, const glm::ivec2& moved) const {
  return colour_.at(c.x, c.y) - colour_.at(c.x + moved.x, c.y + moved.y);
}

// Mean squared difference, three quarters of that of the mean taken off; a rim that is not there is the
// worst.
float Filling::error_along(const std::vector<glm::ivec2>& rim, Piece* piece) const {
  glm::vec3 sum{0};
  for (const glm::ivec2& c : rim) {
    if (!is_set(source_, c + piece->moved)) continue;
    const glm::vec3 d = difference_at(c, piece->moved);
    sum += d;
    piece->squares += glm::dot(d, d) / 3;
    ++piece->rim_cells;
  }
  constexpr float kLeastCells = 8, kFitted = 0.75f;
  if (piece->rim_cells < kLeastCells) return std::numeric_limits<float>::max();
  const glm::vec3 mean = sum / piece->rim_cells;
  return piece->squares / piece->rim_cells - kFitted * glm::dot(mean, mean) / 3;
}

Image<glm::vec3> Filling::carried_inwards(const Piece& piece) const {
  const Mask around = dilated(piece.cells, kRimPx), rim = rim_of(piece.cells);
  const auto known = [&](const glm::ivec2& c) { return is_set(rim, c) && is_set(source_, c + piece.moved); };
  Image<glm::vec3> difference(SurfaceMap::kSidePx, SurfaceMap::kSidePx);
  std::vector<glm::ivec2> unknown;
  glm::vec3 mean{0};
  float count = 0;
  for (const glm::ivec2& c : cells_of(around)) {
    if (!known(c)) {
      unknown.push_back(c);
      continue;
    }
    glm::vec3 sum{0};  // of the rim within two cells: single splats do not count
    float weight = 0;
    for (int y = -2; y <= 2; ++y)
      for (int x = -2; x <= 2; ++x)
        if (const glm::ivec2 near = c + glm::ivec2(x, y); known(near)) {
          sum += difference_at(near, piece.moved);
          ++weight;
        }
    difference.at(c.x, c.y) = sum / weight;
    mean += sum / weight;
    ++count;
  }
  for (const glm::ivec2& c : unknown) difference.at(c.x, c.y) = count > 0 ? mean / count : mean;
  if (count > 0) relax(around, unknown, &difference);
  return difference;
}

}  // namespace splatcut
