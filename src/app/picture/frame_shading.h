// From what the CPU rasteriser saw to the picture on the screen: background, tint, outlines, heat map.
//
// In: colour, alpha and first hit per pixel, the object each Gaussian belongs to. Out: RGBA8. A change of
// labels or colours needs no new rasterising. Outlines and tints are smoothed over 5 x 5 pixels. Cost: about
// 3 ms a megapixel.
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

// One rasterised view.
struct Frame {
  Camera camera;
  Image<glm::vec3> colour;  // on black, premultiplied
  Image<float> alpha;
  Image<float> depth;             // median, camera z; 0 where nothing is
  Image<std::int32_t> first_hit;  // Gaussian, or -1
  double raster_ms = 0;
};

// How much of the picture's colour the shading replaces, by the CPU and in OpenGL alike, [0, 1].
inline constexpr float kTintStrength = 0.6f, kHeatStrength = 0.7f, kOutlineStrength = 0.95f;

struct FrameStyle {
  glm::vec3 background{0};
  float checker_px = 0;  // side of its squares, in place of the background; 0: none
  bool tint = true;
  bool outline = true;
  Flags owner;  // per Gaussian: number of the object it belongs to, 0 none; null: none
  std::array<Rgb8, 256> owner_colour{};            // by that number
  std::shared_ptr<const std::vector<float>> heat;  // per Gaussian, [0, 1]: shown instead of tint where given
  Flags highlight;                                 // per Gaussian: outlined in white (hover, floaters)
  Rgb8 highlight_colour{255, 255, 255};
};

// Of the checker at a pixel.
glm::vec3 checker_colour(int x, int y, float side_px);

Image<Rgba8> shaded(const Frame& frame, const FrameStyle& style);

// 0 blue over yellow to 1 red.
glm::vec3 heat_colour(float value);

}  // namespace splatcut
