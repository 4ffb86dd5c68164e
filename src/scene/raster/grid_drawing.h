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

// Output pictures for what the options ask for, all background.
RasterOutput empty_output(const RasterOptions& options, const PixelRect& roi);

// The pixels that are drawn. Asserts that arrays and masks have the sizes that cloud and camera ask for.
PixelRect drawn_region(const GaussianCloud& cloud, const Camera& camera, const RasterOptions& options);

// Draws the grid into `out`, whose pictures are of roi. Pixels of roi that the grid does not hold stay as
// they are.
void draw_grid(const TileGrid& grid, const PixelRect& roi, const RasterOptions& options, const Job& job,
               RasterOutput* out);

// roi and options.shown choose what is drawn.
RasterOutput draw_kept_grid(KeptGrid* kept, const PixelRect& roi, const RasterOptions& options,
                            const Job& job);

}  // namespace splatcut
