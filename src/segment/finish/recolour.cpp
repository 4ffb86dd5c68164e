#include "segment/finish/recolour.h"

#include <algorithm>
#include <array>

#include "core/parallel.h"
#include "scene/raster/projected_view.h"
#include "scene/raster/splat_math.h"
#include "segment/masks/mask_tools.h"

namespace splatcut {

namespace {

enum ColourPlane : std::size_t { kWeight = 3, kColourPlanes };  // red, green, blue before it

PlaneSums residual_sums(const OwnView& view, const std::vector<std::uint8_t>& kept,
                        const GaussianCloud& object, const Job& job) {
  constexpr int kInsidePx = 1;
  constexpr float kLeastAlpha = 0.05f;
  RasterOptions raster;
  raster.roi = view.rect;
  raster.shown = kept;
  KeptViews last(object, 0);  // drawn twice, projected once
  const Drawer drawer(object, &last);
  const RasterOutput alone = drawer.draw(view.camera, raster, job);
  const Mask inside = eroded(view.inside, kInsidePx);
  std::vector<Image<float>> planes(kColourPlanes, Image<float>(view.rect.width(), view.rect.height()));
  for (std::size_t i = 0; i < inside.size(); ++i) {
    if (!inside.pixels()[i]) continue;
    const glm::vec3 residual =
        glm::clamp(view.colour.pixels()[i] - alone.colour.pixels()[i], glm::vec3(-1), glm::vec3(1));
    for (int c = 0; c < 3; ++c) planes[static_cast<std::size_t>(c)].pixels()[i] = residual[c];
    planes[kWeight].pixels()[i] = std::max(alone.alpha.pixels()[i], kLeastAlpha);
  }
  PlaneSums sums(object.size(), kColourPlanes);
  raster.colour = false;
  raster.sum_planes = planes;
  raster.plane_sums = &sums;
  drawer.draw(view.camera, raster, job);
  return sums;
}

// N and D of one channel, view by view, summed up as the step needs them.
struct Evidence {
  double n = 0, d = 0, d2 = 0, n2_over_d = 0;

  void add(double view_n, double view_d) {
    if (!(view_d > 0)) return;
    n += view_n;
    d += view_d;
    d2 += view_d * view_d;
    n2_over_d += view_n * view_n / view_d;
  }

  double step() const {
    constexpr double kDamping = 4, kMostStep = 0.15;  // px; of a colour from 0 to 1
    if (!(d > 0)) return 0;
    const double mean = n / d, views = d * d / d2;
    const double variance = std::max(0.0, n2_over_d / d - mean * mean);
    if (!(views > 1) || mean == 0) return 0;
    const double trust = std::clamp(1 - variance / ((views - 1) * mean * mean), 0.0, 1.0);
    return std::clamp(n / (d + kDamping) * trust, -kMostStep, kMostStep);
  }
};

}  // namespace

std::size_t recolour(std::span<const OwnView> views, const std::vector<std::uint8_t>& kept,
                     GaussianCloud* object, const Job& job) {
  constexpr int kRounds = 2;
  constexpr float kVisible = 0.5f / 255;
  const std::vector<glm::vec3> before = object->f_dc;
  for (int round = 0; round < kRounds; ++round) {
    std::vector<std::array<Evidence, 3>> evidence(object->size());
    for (const OwnView& view : views) {
      const PlaneSums sums = residual_sums(view, kept, *object, job);
      if (job.cancelled()) return 0;
      for_each_index(object->size(), [&](std::size_t g) {
        for (std::size_t c = 0; c < 3; ++c) evidence[g][c].add(sums.at(g, c), sums.at(g, kWeight));
      });
    }
    for (std::size_t g = 0; g < object->size(); ++g)
      for (std::size_t c = 0; c < 3; ++c)
        object->f_dc[g][static_cast<int>(c)] += static_cast<float>(evidence[g][c].step()) / kShC0;
  }
  std::size_t changed = 0;
  for (std::size_t g = 0; g < object->size(); ++g) {
    const glm::vec3 by = glm::abs(object->f_dc[g] - before[g]) * kShC0;
    changed += kept[g] && std::max({by.r, by.g, by.b}) > kVisible;
  }
  return changed;
}

}  // namespace splatcut
