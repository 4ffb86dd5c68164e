// A hole in a map of a surface, filled piece by piece with what lies beside it. Used by fill.cpp, which says
// how.
#pragma once

#include <optional>
#include <vector>

#include "segment/finish/surface_map.h"

namespace splatcut {

// A part of the hole and where its surface is copied from.
struct Piece {
  Mask cells;
  glm::ivec2 moved{0};  // from the hole to there
  float squares = 0;    // of the difference along the rim, per channel, sum over so many cells
  float rim_cells = 0;
};

// The hole as far as it is filled, in colours of the map.
class Filling {
 public:
  Filling(const Ground& ground, const Mask& hole);

  const Mask& left() const { return left_; }  // not yet filled

  // The piece that fills most, or nearly so, and of those the one whose colours along the rim are most like
  // what is known there. None where nothing is left to copy, or cancelled.
  std::optional<Piece> next(const Job& job) const;

  // Returns what is added to the piece's colours, per cell of it: the difference along its rim, carried
  // inwards.
  Image<glm::vec3> fill(const Piece& piece);

 private:
  Mask rim_of(const Mask& cells) const;
  glm::vec3 difference_at(const glm::ivec2& cell, const glm::ivec2& moved) const;
  float error_along(const std::vector<glm::ivec2>& rim, Piece* piece) const;
  Image<glm::vec3> carried_inwards(const Piece& piece) const;

  Image<glm::vec3> colour_;
  Mask known_, source_, left_;
};

}  // namespace splatcut
