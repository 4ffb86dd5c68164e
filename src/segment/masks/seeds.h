// What the user pointed at: clicks and scribbles in pixels of one view.
#pragma once

#include <filesystem>
#include <glm/glm.hpp>
#include <memory>
#include <vector>

#include "core/image.h"

namespace splatcut {

enum class SeedLabel : std::uint8_t { kRest, kObject };

// A click is a scribble of one point. Pixels of the reference view, x right, y down.
struct Stroke {
  SeedLabel label = SeedLabel::kObject;
  float radius_px = 2;
  std::vector<glm::vec2> points_px;
};

using Strokes = std::vector<Stroke>;

// The Gaussians displayed when a stroke was made: a byte per Gaussian of the cloud, 0 if it was not; null:
// all were.
using SeenGaussians = std::shared_ptr<const std::vector<std::uint8_t>>;
bool same_set(const SeenGaussians& a, const SeenGaussians& b);

Stroke click(const glm::vec2& pixel, SeedLabel label);

// The strokes in another size of the same picture.
Strokes scaled(const Strokes& strokes, float factor);

// Per pixel: 0 nothing, 1 rest (background), 2 object; later strokes over earlier ones.
enum SeedPixel : std::uint8_t { kNoSeed = 0, kRestSeed = 1, kObjectSeed = 2 };
Image<std::uint8_t> draw_seeds(const Strokes& strokes, int width, int height);

}  // namespace splatcut
