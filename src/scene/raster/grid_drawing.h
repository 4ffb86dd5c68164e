// A grid of splats as a picture: what rasterize() and ProjectedView share.
#pragma once

#include <vector>

#include "scene/raster/tile_blend.h"
#include "scene/raster/tile_grid.h"

namespace splatcut {

// A grid that holds all of a picture, for any number of drawings.
struct KeptGrid {
  TileGrid grid;
  PixelRect picture;
  std::vector<TileLists> lists;  // per tile; the first drawing that leaves no splat of it out completes them
};

// What is asked for, with nothing drawn.
RasterOutput empty_output(const RasterOptions& options, const PixelRect& roi);

// The pixels that are drawn. Asserts that arrays and masks have the sizes that cloud and camera ask for.
PixelRect drawn_region(const GaussianCloud& cloud, const Camera& camera, const RasterOptions& options);

// Into `out`, of roi: what the grid holds and nothing else. The grid may hold a part of roi, whose other
// parts stay.
void draw_grid(const TileGrid& grid, const PixelRect& roi, const RasterOptions& options, const Job& job,
               RasterOutput* out);

// roi and options.shown choose what is drawn.
RasterOutput draw_kept_grid(KeptGrid* kept, const PixelRect& roi, const RasterOptions& options,
                            const Job& job);

}  // namespace splatcut
