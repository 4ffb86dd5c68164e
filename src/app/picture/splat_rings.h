// Rings: outlines of the Gaussians' ellipses in the picture, and the choice of Gaussians that get one.
//
// In: the cloud, the wanted Gaussians, a camera, the picture's depth. Out: at most `most` rings. A ring is
// given by the half axes of its ellipse at kRingSigmas standard deviations: eigenvectors of the picture
// covariance Sigma2 (low-pass included), of length kRingSigmas sqrt(lambda). Left out: Gaussians smaller than
// least_radius_px, beside the picture, beyond the near or far plane, or behind the picture's surface by more
// than their own thickness. If there are more, the choice is even in space. Gaussians lie in Morton order, so
// blocks of them are small in space. Blocks beside the picture are skipped; of every other block the same
// share of members is tried, always the same members first, so that a ring which shows keeps showing as the
// view comes nearer. Cost: at most `most_tried` projections, in parallel; begin() passes over the cloud once.
// Not handled: a Gaussian beside the picture whose ring reaches into it.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "app/picture/picture_depth.h"
#include "scene/cloud/gaussian_cloud.h"

namespace splatcut {

inline constexpr float kRingSigmas = 2;

struct Ring {
  glm::vec2 centre_px{0};
  glm::vec2 long_px{0}, short_px{0};  // half axes of the ellipse
  std::uint32_t gaussian = 0;         // index in the cloud
};

struct RingOptions {
  DrawLimits limits;
  float least_radius_px = 2;  // least length of the long half axis: a smaller ring would be a dot
  std::size_t most = 4000, most_tried = 60000;  // limits of rings, and of Gaussians that are projected
};

class SplatRings {
 public:
  // Sets the cloud and the wanted Gaussians: those that both shown and of_object flag; null: all.
  void begin(std::shared_ptr<const GaussianCloud> cloud, const Flags& shown, const Flags& of_object);
  // Rings that the camera shows, in the order of their Gaussians.
  std::vector<Ring> in_view(const Camera& camera, const PictureDepth& depth,
                            const RingOptions& options) const;

 private:
  static constexpr std::size_t kBlock = 256;  // number of Gaussians in a block
  struct Block {
    Box box;                  // bounds of the centres of its wanted Gaussians
    std::uint32_t count = 0;  // number of its wanted Gaussians
  };
  bool wanted(std::size_t g) const { return (!shown_ || (*shown_)[g]) && (!of_object_ || (*of_object_)[g]); }

  std::shared_ptr<const GaussianCloud> cloud_;
  Flags shown_, of_object_;
  std::vector<Block> blocks_;
};

}  // namespace splatcut
