// A grid of splats as a picture: what rasterize() and ProjectedView share.
#pragma once

#include "scene/tile_grid.h"

namespace splatcut {

// What is asked for, with nothing drawn.
RasterOutput empty_output(const RasterOptions& options, const PixelRect& roi);

// The pixels that are drawn. Asserts that arrays and masks have the sizes that cloud and camera ask for.
PixelRect drawn_region(const GaussianCloud& cloud, const Camera& camera, const RasterOptions& options);

// whole: the grid holds all of the picture, and roi and options.shown choose from it; else it holds what is drawn.
RasterOutput draw_grid(const TileGrid& grid, const PixelRect& roi, bool whole, const RasterOptions& options, const Job& job);

}  // namespace splatcut
