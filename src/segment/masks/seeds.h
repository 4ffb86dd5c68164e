// What the user pointed at: clicks, scribbles and boxes in pixels of one view.
#pragma once

#include <filesystem>
#include <glm/glm.hpp>
#include <memory>
#include <vector>

#include "core/image.h"

namespace splatcut {

enum class SeedLabel : std::uint8_t { kRest, kObject };

// A path is a click where it has one point, else a scribble. A box stands around what is meant, and touches
// it on all four sides more or less: two points, any two opposite corners; its radius means nothing.
enum class StrokeKind : std::uint8_t { kPath, kBox };

inline constexpr int kMostSizeSteps = 100;  // limit of Stroke::size_step, in both directions

// Pixels of the reference view, x right, y down.
struct Stroke {
  SeedLabel label = SeedLabel::kObject;
  float radius_px = 2;
  std::vector<glm::vec2> points_px;
  StrokeKind kind = StrokeKind::kPath;
  // Number of sizes above (+) or below (-) what it changes by itself: of clicks, and of an object's first
  // stroke.
  int size_step = 0;

  bool is_box() const { return kind == StrokeKind::kBox; }
  bool is_click() const { return !is_box() && points_px.size() == 1; }
};

using Strokes = std::vector<Stroke>;

// The Gaussians displayed when a stroke was made: a byte per Gaussian of the cloud, 0 if it was not; null:
// all were.
using SeenGaussians = std::shared_ptr<const std::vector<std::uint8_t>>;
bool same_set(const SeenGaussians& a, const SeenGaussians& b);

Stroke click(const glm::vec2& pixel, SeedLabel label);
Stroke box_around(const glm::vec2& corner_px, const glm::vec2& opposite_px, SeedLabel label);

// A box as far as it lies in a picture of that size; low = high where nothing of it does.
struct BoxPx {
  glm::vec2 low_px{0}, high_px{0};
  glm::vec2 size_px() const { return high_px - low_px; }
  bool contains(const glm::vec2& p) const {
    return p.x >= low_px.x && p.y >= low_px.y && p.x < high_px.x && p.y < high_px.y;
  }
};
BoxPx box_in_picture(const Stroke& box, int width_px, int height_px);
// Whether less than 6 pixels of a side lie in it: a slip of the hand.
bool box_is_too_small(const Stroke& box, int width_px, int height_px);

// The strokes in another size of the same picture.
Strokes scaled(const Strokes& strokes, float factor);

// Per pixel: 0 nothing, 1 rest (background), 2 object; later strokes over earlier ones. Pixels alone cannot
// say what fills a box: outside of a box around the object is the rest, and its middle stands for the object;
// all of a box around the rest is the rest.
enum SeedPixel : std::uint8_t { kNoSeed = 0, kRestSeed = 1, kObjectSeed = 2 };
Image<std::uint8_t> draw_seeds(const Strokes& strokes, int width, int height);

}  // namespace splatcut
