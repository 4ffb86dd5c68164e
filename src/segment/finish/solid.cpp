#include "segment/finish/solid.h"

#include <algorithm>
#include <cmath>

#include "scene/raster/projected_view.h"
#include "scene/raster/splat_math.h"
#include "segment/masks/mask_tools.h"

namespace splatcut {

namespace {

enum SolidPlane : std::size_t { kShown, kDeep, kThrough, kSolidPlanes };

void add_transmittance(const OwnView& view, const std::vector<std::uint8_t>& kept,
                       const GaussianCloud& object, PlaneSums* sums, const Job& job) {
  constexpr int kDeepPx = 2;
  RasterOptions raster;
  raster.colour = false;
  raster.roi = view.rect;
  raster.shown = kept;
  KeptViews last(object, 0);  // drawn twice, projected once
  const Drawer drawer(object, &last);
  const Image<float> alpha = drawer.draw(view.camera, raster, job).alpha;
  const Mask deep = eroded(view.inside, kDeepPx);
  std::vector<Image<float>> planes(kSolidPlanes, Image<float>(alpha.width(), alpha.height()));
  for (std::size_t i = 0; i < alpha.size(); ++i) {
    planes[kShown].pixels()[i] = view.valid.pixels()[i] ? 1.0f : 0.0f;
    planes[kDeep].pixels()[i] = deep.pixels()[i] ? 1.0f : 0.0f;
    planes[kThrough].pixels()[i] = deep.pixels()[i] ? 1 - alpha.pixels()[i] : 0.0f;
  }
  raster.sum_planes = planes;
  raster.plane_sums = sums;
  drawer.draw(view.camera, raster, job);
}

}  // namespace

std::size_t make_solid(std::span<const OwnView> views, const std::vector<std::uint8_t>& kept,
                       GaussianCloud* object, const Job& job) {
  constexpr double kThroughLeast = 0.03, kThroughGoal = 0.02, kDeepShare = 0.9, kMostPower = 6;
  PlaneSums sums(object->size(), kSolidPlanes);
  for (const OwnView& view : views) add_transmittance(view, kept, *object, &sums, job);
  if (job.cancelled()) return 0;
  std::size_t made_solid = 0;
  for (std::size_t g = 0; g < object->size(); ++g) {
    const double deep = sums.at(g, kDeep);
    if (!kept[g] || !(deep > kDeepShare * sums.at(g, kShown))) continue;
    const double through = sums.at(g, kThrough) / deep;
    if (!(through > kThroughLeast)) continue;
    const double power =
        through < 1 ? std::clamp(std::log(kThroughGoal) / std::log(through), 1.0, kMostPower) : kMostPower;
    object->opacity[g] = std::min(
        kAlphaMax, static_cast<float>(1 - std::pow(1 - static_cast<double>(object->opacity[g]), power)));
    ++made_solid;
  }
  return made_solid;
}

}  // namespace splatcut
