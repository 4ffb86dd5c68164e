// Measures and morphology of masks.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "core/image.h"
#include "core/job.h"
#include "scene/camera/camera.h"
#include "scene/cloud/gaussian_cloud.h"
#include "scene/raster/projected_view.h"

namespace splatcut {

std::size_t count(const Mask& mask);
double iou(const Mask& a, const Mask& b);  // 1 where both are empty

Mask dilated(const Mask& mask, int radius_px);
Mask eroded(const Mask& mask, int radius_px);
Mask resized_mask(const Mask& mask, int width_px, int height_px);  // the nearest pixel of the mask
PixelRect bounds(const Mask& mask);                                // empty where the mask is
PixelRect grown(const PixelRect& rect, int margin_px, int width, int height);  // clipped to the picture

// Width of a picture in which a mask that is small has at least side_px as the square root of its pixels: its
// own times a power of sqrt(2), so that masks of about one size ask for one picture, most_width_px at most;
// its own where it is large enough, or empty.
int width_to_see(const Mask& mask, int side_px, int most_width_px);

// The 4-connected region that holds the pixel, which itself is taken for a part of the mask.
Mask connected_to(const Mask& mask, const glm::ivec2& at);

// Distance of each object pixel to the nearest other pixel or to the frame, px.
Image<float> distance_inside(const Mask& mask);

// Closed outer borders of the 8-connected regions of at least that many pixels, the largest first; points in
// pixels, centres at +0.5.
std::vector<std::vector<glm::vec2>> outlines(const Mask& mask, int least_px = 12);

// A rectangle around all pixels that show labelled Gaussians; empty if none is in view.
PixelRect labelled_rectangle(const GaussianCloud& cloud, const Camera& camera,
                             std::span<const std::uint8_t> labels);

// Per pixel the blended weight of the labelled Gaussians, occluded by all others; not thresholded.
Image<float> render_labels(const Drawer& drawer, const Camera& camera, std::span<const std::uint8_t> labels,
                           const Job& job = {});
Mask thresholded(const Image<float>& image, float threshold);

}  // namespace splatcut
