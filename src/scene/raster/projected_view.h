// A cloud in one view, projected, listed per tile and sorted once, then drawn any number of times: for stages
// that look at the same view again and again, each time with other labels.
//
// In: cloud, camera. Out: what rasterize() gives, bit for bit. Cost: making one is the first half of
// rasterize() for the whole picture, drawing the second half; where all splats have been drawn once, drawing
// all of them again costs half of that. Memory: 40 bytes a Gaussian, 20 a pair of splat and tile, and from
// that first drawing on 2 to 5 a pair.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "scene/raster/rasterizer.h"

namespace splatcut {

struct KeptGrid;

// The cloud must outlive it and stay as it is. One drawing at a time.
class ProjectedView {
 public:
  // coloured: whether drawings may ask for colour. Cancelled: drawings are empty.
  // Beyond most_pairs nothing is kept, and each drawing projects again.
  ProjectedView(const GaussianCloud& cloud, const Camera& camera, bool coloured, const Job& job = {},
                std::size_t most_pairs = RasterOptions{}.most_pairs);
  ~ProjectedView();

  // options without near_plane, low_pass_px2 and colour_override.
  RasterOutput draw(const RasterOptions& options, const Job& job = {}) const;

  const Camera& camera() const { return camera_; }
  bool coloured() const { return coloured_; }
  bool complete() const { return grid_ || too_large_; }  // false: cancelled
  std::size_t bytes() const;

 private:
  const GaussianCloud& cloud_;
  Camera camera_;
  bool coloured_;
  bool too_large_ = false;
  std::unique_ptr<KeptGrid> grid_;
};

// A cache of the views drawn last, as many as fit.
class KeptViews {
 public:
  static constexpr std::size_t kMostBytes = std::size_t{256}
                                            << 20;  // ten views of 300,000 Gaussians at 320 pixels

  explicit KeptViews(const GaussianCloud& cloud, std::size_t most_bytes = kMostBytes)
      : cloud_(cloud), most_bytes_(most_bytes) {}

  const ProjectedView& view(const Camera& camera, bool coloured, const Job& job);  // until the next call
  std::size_t size() const { return views_.size(); }
  std::size_t bytes() const;
  void clear() { views_.clear(); }

 private:
  const GaussianCloud& cloud_;
  std::size_t most_bytes_;
  std::vector<std::unique_ptr<ProjectedView>> views_;  // the newest last
};

// Rasterises a cloud, through a cache of projected views if it has one, or past the blocks that a view does
// not show if it has those. Cheap to copy. A cloud converts to a drawer without either.
class Drawer {
 public:
  Drawer(const GaussianCloud& cloud, KeptViews* kept = nullptr, const CloudBlocks* blocks = nullptr)
      : cloud_(&cloud), kept_(kept), blocks_(blocks) {}  // NOLINT: a cloud is a drawer

  const GaussianCloud& cloud() const { return *cloud_; }
  RasterOutput draw(const Camera& camera, const RasterOptions& options, const Job& job = {}) const;

 private:
  const GaussianCloud* cloud_;
  KeptViews* kept_;
  const CloudBlocks* blocks_;
};

}  // namespace splatcut
