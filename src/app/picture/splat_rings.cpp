#include "app/picture/splat_rings.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "scene/raster/splat_math.h"

namespace splatcut {

namespace {

struct Ranked {
  Ring ring;
  std::uint32_t rank;  // lower ones show first
};

// The members of a block in an order that is spread over it: 97 has no factor in common with 256.
constexpr std::uint32_t member_at(std::uint32_t rank) {
  return (97 * rank) % 256;
}

// False only where no point of the box shows: its corners are all beyond one side of the picture.
bool may_show(const Box& box, const Camera& camera, const DrawLimits& limits) {
  const glm::vec2 size(camera.width_px, camera.height_px);
  unsigned beyond_all = ~0u;
  for (int corner = 0; corner < 8; ++corner) {
    const glm::vec3 at{corner & 1 ? box.max.x : box.min.x, corner & 2 ? box.max.y : box.min.y,
                       corner & 4 ? box.max.z : box.min.z};
    const glm::vec3 p = camera.camera_from_world(at);
    // Half spaces, so that what lies behind the camera is told apart, too.
    const float u = camera.fx_px * p.x + camera.cx_px * p.z, v = camera.fy_px * p.y + camera.cy_px * p.z;
    beyond_all &= (u < 0 ? 1u : 0u) | (v < 0 ? 2u : 0u) | (u > size.x * p.z ? 4u : 0u) |
                  (v > size.y * p.z ? 8u : 0u) | (p.z < limits.near_plane ? 16u : 0u) |
                  (p.z > limits.far_plane ? 32u : 0u);
  }
  return beyond_all == 0;
}

Ring ring_of(const Splat& splat, std::size_t g) {
  const Symmetric2& s = splat.covariance_px2;
  const float mean = 0.5f * (s.a + s.c), half = 0.5f * (s.a - s.c);
  const float spread = std::sqrt(half * half + s.b * s.b);
  const float angle = 0.5f * std::atan2(s.b, half);
  const glm::vec2 along(std::cos(angle), std::sin(angle));
  const float longest = kRingSigmas * std::sqrt(mean + spread);
  const float shortest = kRingSigmas * std::sqrt(std::max(0.0f, mean - spread));
  return {splat.mean_px, longest * along, shortest * glm::vec2(-along.y, along.x),
          static_cast<std::uint32_t>(g)};
}

}  // namespace

void SplatRings::begin(std::shared_ptr<const GaussianCloud> cloud, const Flags& shown,
                       const Flags& of_object) {
  cloud_ = std::move(cloud);
  shown_ = shown;
  of_object_ = of_object;
  blocks_.assign((cloud_->size() + kBlock - 1) / kBlock, {});
  tbb::parallel_for(std::size_t{0}, blocks_.size(), [&](std::size_t b) {
    Block& block = blocks_[b];
    for (std::size_t g = b * kBlock; g < std::min(cloud_->size(), (b + 1) * kBlock); ++g) {
      if (!wanted(g)) continue;
      const glm::vec3& at = cloud_->position[g];
      block.box =
          block.count == 0 ? Box{at, at} : Box{glm::min(block.box.min, at), glm::max(block.box.max, at)};
      ++block.count;
    }
  });
}

std::vector<Ring> SplatRings::in_view(const Camera& camera, const PictureDepth& depth,
                                      const RingOptions& options) const {
  std::vector<std::size_t> in_view;
  std::size_t members = 0;
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    if (blocks_[b].count == 0 || !may_show(blocks_[b].box, camera, options.limits)) continue;
    in_view.push_back(b);
    members += blocks_[b].count;
  }
  const double share = std::min(
      1.0, static_cast<double>(options.most_tried) / static_cast<double>(std::max<std::size_t>(1, members)));
  const glm::vec2 size(camera.width_px, camera.height_px);
  const float least_px2 = options.least_radius_px * options.least_radius_px;

  std::vector<std::vector<Ranked>> found(in_view.size());
  tbb::parallel_for(std::size_t{0}, in_view.size(), [&](std::size_t i) {
    const std::size_t first = in_view[i] * kBlock;
    // Shares of a member add up over the blocks: each begins at another fraction.
    const double fraction = static_cast<double>((in_view[i] * 0x9e3779b1u) & 0xffffu) / 0x10000;
    const auto tries = static_cast<std::uint32_t>(std::min<double>(kBlock, share * kBlock + fraction));
    for (std::uint32_t rank = 0; rank < tries; ++rank) {
      const std::size_t g = first + member_at(rank);
      if (g >= cloud_->size() || !wanted(g)) continue;
      const glm::vec3 at_camera = camera.camera_from_world(cloud_->position[g]);
      if (!(at_camera.z >= options.limits.near_plane) || at_camera.z > options.limits.far_plane) continue;
      const glm::vec2 at_px = camera.pixel_from_camera(at_camera);
      if (!(at_px.x >= 0 && at_px.y >= 0 && at_px.x < size.x && at_px.y < size.y)) continue;
      Splat splat;
      if (!project(*cloud_, g, camera, options.limits.near_plane, &splat, options.limits.low_pass_px2))
        continue;
      const Ring ring = ring_of(splat, g);
      if (glm::dot(ring.long_px, ring.long_px) < least_px2) continue;
      // A splat on the surface is part of it: its centre may lie behind by its own thickness.
      const glm::vec3& s = cloud_->scale[g];
      if (depth.before(cloud_->position[g], kRingSigmas * std::max({s.x, s.y, s.z}))) continue;
      found[i].push_back({ring, rank});
    }
  });

  std::vector<Ranked> all;
  for (const std::vector<Ranked>& of_block : found) all.insert(all.end(), of_block.begin(), of_block.end());
  // The same members of each block leave first.
  const auto ahead = [](const Ranked& a, const Ranked& b) {
    const std::uint32_t ga = a.ring.gaussian * 0x9e3779b1u, gb = b.ring.gaussian * 0x9e3779b1u;
    return a.rank != b.rank ? a.rank < b.rank : ga < gb;
  };
  if (all.size() > options.most) {
    std::ranges::nth_element(all, all.begin() + static_cast<std::ptrdiff_t>(options.most), ahead);
    all.resize(options.most);
  }
  std::ranges::sort(all, {}, [](const Ranked& r) { return r.ring.gaussian; });
  std::vector<Ring> rings;
  for (const Ranked& r : all) rings.push_back(r.ring);
  return rings;
}

}  // namespace splatcut
