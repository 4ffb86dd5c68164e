// Shading: turns what the CPU rasteriser saw into the picture on the screen, with background, tint, outlines
// and heat map.
//
// In: colour, alpha and first hit per pixel, and the object that each Gaussian belongs to. Out: RGBA8. A
// change of labels or colours needs no new rasterising. Outlines and tints are smoothed over 5 x 5 pixels.
// Cost: about 3 ms a megapixel.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <vector>

#include "app/document/document.h"
#include "core/image.h"
#include "scene/camera/camera.h"

namespace splatcut {

// One rasterised view. All images have the size of the camera's picture.
struct Frame {
  Camera camera;
  Image<glm::vec3> colour;  // colour on black, premultiplied with alpha
  Image<float> alpha;
  Image<float> depth;             // median depth as camera z, scene units; 0: nothing is there
  Image<std::int32_t> first_hit;  // index of the Gaussian that shows; -1: none
  double raster_ms = 0;
};

// Shares of the picture's colour that the shading replaces, on the CPU and in OpenGL alike, [0, 1].
inline constexpr float kTintStrength = 0.6f, kHeatStrength = 0.7f, kOutlineStrength = 0.95f;

struct FrameStyle {
  glm::vec3 background{0};
  float checker_px = 0;  // side of the squares of a checker in place of the background; 0: no checker
  bool tint = true;
  bool outline = true;
  Flags owner;  // number of the object that each Gaussian belongs to, 0: none; null: all 0
  std::array<Rgb8, 256> owner_colour{};            // colour of each such number
  std::shared_ptr<const std::vector<float>> heat;  // heat of each Gaussian, [0, 1]; null: tint instead
  Flags highlight;  // flags of Gaussians to outline (hover, floaters); null: none
  Rgb8 highlight_colour{255, 255, 255};
};

// Colour of the checker at a pixel.
glm::vec3 checker_colour(int x, int y, float side_px);

// The number of the object that the Gaussian of each pixel that shows belongs to; 0: none. owner: as in
// FrameStyle.
Image<std::uint8_t> owners_of(const Frame& frame, const Flags& owner);

// owners: the numbers of the objects that most of each pixel is of; null: those of owners_of().
Image<Rgba8> shaded(const Frame& frame, const FrameStyle& style, const Image<std::uint8_t>* owners = nullptr);

// Colour of a heat value: 0 is blue, 1 is red, yellow lies between.
glm::vec3 heat_colour(float value);

}  // namespace splatcut
