// Which Gaussians are drawn as rings, and where: the outlines of their ellipses in the picture.
//
// In: the cloud, who is wanted, a camera, the picture's depth. Out: at most `most` rings, each by the half
// axes of its ellipse at kRingSigmas standard deviations: eigenvectors v of Sigma2 (low-pass included), of
// length kRingSigmas sqrt(lambda). Left out: what is smaller than least_radius_px, beside the picture, beyond
// the near or far plane, or behind what the picture shows by more than its own thickness.
// Thinned evenly in space where there are more: Gaussians lie in Morton order, so blocks of them are small in
// space; blocks beside the picture cost nothing, and of each other block the same share is looked at, always
// the same members first. A ring that shows keeps showing as the view comes nearer.
// Cost: `most_tried` projections at most, in parallel; begin() one pass over the cloud. Not handled: a
// Gaussian beside the picture whose ring reaches into it.
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
  glm::vec2 long_px{0}, short_px{0};  // half axes
  std::uint32_t gaussian = 0;
};

struct RingOptions {
  DrawLimits limits;
  float least_radius_px = 2;  // of the long half axis: less is a dot
  std::size_t most = 4000, most_tried = 60000;
};

class SplatRings {
 public:
  // shown, of_object: who is wanted, a Gaussian in both; null: all.
  void begin(std::shared_ptr<const GaussianCloud> cloud, const Flags& shown, const Flags& of_object);
  std::vector<Ring> in_view(const Camera& camera, const PictureDepth& depth,
                            const RingOptions& options) const;

 private:
  static constexpr std::size_t kBlock = 256;  // Gaussians
  struct Block {
    Box box;                  // of the wanted ones
    std::uint32_t count = 0;  // of them
  };
  bool wanted(std::size_t g) const { return (!shown_ || (*shown_)[g]) && (!of_object_ || (*of_object_)[g]); }

  std::shared_ptr<const GaussianCloud> cloud_;
  Flags shown_, of_object_;
  std::vector<Block> blocks_;
};

}  // namespace splatcut
