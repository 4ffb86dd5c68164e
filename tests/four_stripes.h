// Four leaves seen as four stripes, and clicks on them.
#pragma once

#include <vector>

#include "four_leaves.h"
#include "segment/selection/click_selection.h"

namespace splatcut::testing {

using Labels = std::vector<std::uint8_t>;

// Columns of 10 x 10 pixels, at 10 pixels a unit as leaves of area 1 want it. columns: of leaf -1 show
// nothing.
inline LeafView stripes(const PartHierarchy& parts, const std::vector<int>& leaf_of_column = {0, 1, 2, 3}) {
  Camera camera = look_at({0, 0, -10}, {0, 0, 0}, {0, -1, 0}, 1, 40, 10);
  camera.fx_px = camera.fy_px = 100;
  Image<std::int32_t> hit(40, 10, -1);
  for (int y = 0; y < 10; ++y)
    for (int x = 0; x < 40; ++x) hit.at(x, y) = leaf_of_column[static_cast<std::size_t>(x / 10)];
  return leaf_view_of_hits(parts, camera, hit);
}

// A model that looks at borders alone.
inline SelectionModel borders_alone() {
  SelectionModel model;
  const float opposed = weight(&model.later, Term::kOpposed), disc = weight(&model.later, Term::kDisc);
  model.first = model.later = {};
  weight(&model.first, Term::kCut) = weight(&model.later, Term::kCut) = 1;
  weight(&model.later, Term::kOpposed) = opposed;
  weight(&model.later, Term::kDisc) = disc;
  return model;
}

inline Stroke object(float x) {
  return click({x, 5}, SeedLabel::kObject);
}

inline Stroke rest(float x) {
  return click({x, 5}, SeedLabel::kRest);
}

// The stroke in another size than its own.
inline Stroke sized(Stroke stroke, int step) {
  stroke.size_step = step;
  return stroke;
}

inline Labels selected(const Strokes& strokes, const SelectionModel& model = borders_alone()) {
  const PartHierarchy parts = four_leaves();
  const LeafView view = stripes(parts);
  ClickSelection selection(parts, model);
  for (const Stroke& stroke : strokes) selection.apply(view, stroke);
  return selection.labels();
}

}  // namespace splatcut::testing
