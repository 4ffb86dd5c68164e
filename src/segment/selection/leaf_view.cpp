#include "segment/selection/leaf_view.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/parallel.h"
#include "core/png_file.h"
#include "segment/masks/colour_overlap.h"
#include "segment/selection/click_reach.h"

namespace splatcut {

namespace {

// Smaller weights are not listed: even twenty of them do not turn the label of a pixel.
constexpr float kLeastGaussianWeight = 0.004f, kLeastLeafWeight = 0.02f;
// With this share of a pixel one side has it: the other's is below a half, whatever is rounded.
constexpr float kDecides = 0.501f;

PixelWeights flat(const Image<std::span<GroupWeight>>& lists) {
  PixelWeights out;
  out.first.reserve(lists.size() + 1);
  out.first.push_back(0);
  for (const std::span<GroupWeight> list : lists.pixels())
    out.first.push_back(out.first.back() + static_cast<std::uint32_t>(list.size()));
  out.entry.resize(out.first.back());
  for_each_index(lists.size(), [&](std::size_t i) {
    std::ranges::copy(lists.pixels()[i], out.entry.begin() + out.first[i]);
  });
  return out;
}

void add_to(std::vector<GroupWeight>* sums, std::uint32_t group, float weight) {
  const auto known = std::ranges::find(*sums, group, &GroupWeight::group);
  if (known != sums->end())
    known->weight += weight;
  else
    sums->push_back({group, weight});
}

// Replaces each pixel's Gaussians by their leaves.
void sum_by_leaf(const PartHierarchy& parts, Image<std::span<GroupWeight>>* lists) {
  for_chunks(lists->size(), [&](std::size_t begin, std::size_t end) {
    std::vector<GroupWeight> sums;
    for (std::size_t i = begin; i < end; ++i) {
      std::span<GroupWeight>& list = lists->pixels()[i];
      sums.clear();
      for (const GroupWeight& w : list)
        if (parts.leaf_of[w.group] != kNoPart) add_to(&sums, parts.leaf_of[w.group], w.weight);
      std::erase_if(sums, [](const GroupWeight& w) { return w.weight < kLeastLeafWeight; });
      std::ranges::sort(sums, std::ranges::greater(), &GroupWeight::weight);
      list = list.first(sums.size());  // no longer than it was
      std::ranges::copy(sums, list.begin());
    }
  });
}

void count_leaves(const PartHierarchy& parts, LeafView* of) {
  LeafView& view = *of;
  view.leaf_px.assign(parts.leaves, 0);
  view.leaf_frame_px.assign(parts.leaves, 0);
  const int width = view.camera.width_px, height = view.camera.height_px;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const bool frame = x == 0 || y == 0 || x == width - 1 || y == height - 1;
      for (const GroupWeight& w : view.leaves.at(static_cast<std::size_t>(y) * width + x)) {
        view.leaf_px[w.group] += w.weight;
        if (frame) view.leaf_frame_px[w.group] += w.weight;
      }
    }
}

// 2 pi opacity sqrt(det) of the covariance as seen along the line of sight, the sum of alpha over an endless
// picture.
std::vector<float> alone_px(const GaussianCloud& cloud, const Camera& camera) {
  std::vector<float> px(cloud.size(), 0);
  const glm::vec3 eye = camera.centre_world();
  for_each_index(cloud.size(), [&](std::size_t g) {
    const float depth = camera.camera_from_world(cloud.position[g]).z;
    if (!(depth > near_plane_for(cloud, camera))) return;
    const glm::vec3 along = glm::conjugate(cloud.rotation[g]) * glm::normalize(cloud.position[g] - eye);
    const glm::vec3 s = cloud.scale[g];
    const float shadow = glm::length(glm::vec3(s.y * s.z, s.x * s.z, s.x * s.y) * along);
    px[g] = 2 * std::numbers::pi_v<float> * cloud.opacity[g] * shadow * camera.fx_px * camera.fy_px /
            (depth * depth);
  });
  return px;
}

}  // namespace

LeafView leaf_view_of(const PartHierarchy& parts, const Camera& camera, ListedWeights gaussians,
                      Image<float> depth) {
  LeafView view{.camera = camera,
                .gaussians = flat(gaussians.of),
                .leaves = {},
                .depth = std::move(depth),
                .steps = {},
                .leaf = {},
                .colour = {},
                .colour_bins = {},
                .gaussian_px = std::vector<float>(parts.leaf_of.size(), 0),
                .leaf_px = {},
                .leaf_frame_px = {}};
  for (const GroupWeight& w : view.gaussians.entry) view.gaussian_px[w.group] += w.weight;
  sum_by_leaf(parts, &gaussians.of);
  view.leaves = flat(gaussians.of);
  count_leaves(parts, &view);
  view.leaf = Image<std::uint32_t>(camera.width_px, camera.height_px, kNoPart);
  for (std::size_t i = 0; i < view.leaf.size(); ++i)
    view.leaf.pixels()[i] = group_of_pixel(view.leaves.at(i));
  view.steps = steps_without_jump(view.depth);
  return view;
}

std::size_t LeafView::bytes() const {
  std::size_t bytes = 0;
  const auto add = [&](const auto&... array) { bytes += (... + std::span(array).size_bytes()); };
  add(gaussians.first, gaussians.entry, leaves.first, leaves.entry, depth.pixels(), steps.pixels(),
      leaf.pixels(), colour.pixels(), colour_bins.pixels(), alone_px, gaussian_px, leaf_px, leaf_frame_px);
  return bytes;
}

LeafView leaf_view(const Drawer& drawer, const PartHierarchy& parts, const Camera& camera, const Job& job,
                   const SeenGaussians& seen) {
  RasterOptions raster;
  raster.colour = false;
  raster.depth = true;
  raster.list_gaussians = true;
  if (seen) raster.shown = *seen;
  raster.least_listed_weight = kLeastGaussianWeight;
  RasterOutput drawn = drawer.draw(camera, raster, job);
  LeafView view = leaf_view_of(parts, camera, std::move(drawn.gaussians), std::move(drawn.expected_depth));
  view.whole = seen == nullptr;
  view.alone_px = alone_px(drawer.cloud(), camera);
  return view;
}

void draw_colour(const Drawer& drawer, LeafView* view, const Job& job, const SeenGaussians& seen) {
  RasterOptions raster;
  if (seen) raster.shown = *seen;
  view->colour = rgb8_from_linear(drawer.draw(view->camera, raster, job).colour);
  view->colour_bins = colour_bins(view->colour);
}

LeafPicture picture_of(const LeafView& view) {
  return {view.leaf, view.depth};
}

Image<std::uint32_t> shown_from(const LeafView& view, std::span<const std::uint32_t> level) {
  Image<std::uint32_t> from(view.camera.width_px, view.camera.height_px, kNoLevel);
  for_chunks(from.size(), [&](std::size_t begin, std::size_t end) {
    std::vector<std::pair<std::uint32_t, float>> joining;  // level, share
    for (std::size_t i = begin; i < end; ++i) {
      const std::span<const GroupWeight> shares = view.leaves.at(i);
      if (shares.empty()) continue;
      if (shares.front().weight >= kDecides) {
        from.pixels()[i] = level[shares.front().group];
        continue;
      }
      joining.clear();
      for (const GroupWeight& w : shares)
        if (level[w.group] != kNoLevel) joining.emplace_back(level[w.group], w.weight);
      std::ranges::sort(joining);
      float sum = 0;
      for (const auto& [joins, share] : joining)
        if ((sum += share) >= 0.5f) {
          from.pixels()[i] = joins;
          break;
        }
    }
  });
  return from;
}

float iou(std::span<const float> leaf_px, std::span<const std::uint8_t> a, std::span<const std::uint8_t> b) {
  float both = 0, either = 0;  // pixels
  for (std::size_t l = 0; l < leaf_px.size(); ++l) {
    both += a[l] && b[l] ? leaf_px[l] : 0;
    either += a[l] || b[l] ? leaf_px[l] : 0;
  }
  return either > 0 ? both / either : 1;
}

bool look_alike(const LeafView& view, std::span<const std::uint8_t> a, std::span<const std::uint8_t> b) {
  constexpr float kClearly = 0.8f;  // IoU below which a person sees two things
  return iou(view.leaf_px, a, b) >= kClearly;
}

Mask shown(const PixelWeights& weights, const Camera& camera, std::span<const std::uint8_t> labels) {
  Mask mask(camera.width_px, camera.height_px);
  for_each_index(mask.size(), [&](std::size_t i) {
    std::array<float, 2> sum{};  // rest, object
    for (const GroupWeight& w : weights.at(i)) {
      sum[labels[w.group] != 0] += w.weight;
      if (sum[0] >= kDecides || sum[1] >= kDecides) break;
    }
    mask.pixels()[i] = sum[1] >= 0.5f ? kMaskObject : 0;
  });
  return mask;
}

}  // namespace splatcut
