#include "segment/finish/forget.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"
#include "scene/cloud/joined_clouds.h"
#include "scene/raster/rasterizer.h"
#include "segment/finish/shown_part.h"
#include "segment/graphcut/k_nearest.h"
#include "segment/masks/mask_tools.h"

namespace splatcut {

namespace {

constexpr std::size_t kNearest = 8;

// A rectangle around the object and what touches it, and the mask of the view there.
struct Surroundings {
  PixelRect rect;
  Mask inside;

  Surroundings(const OwnView& view, int margin_px)
      : rect(grown(view.rect, margin_px, view.camera.width_px, view.camera.height_px)),
        inside(rect.width(), rect.height()) {
    for (int y = 0; y < view.inside.height(); ++y)
      std::ranges::copy(view.inside.row(y),
                        inside.row(y + view.rect.y0 - rect.y0).begin() + (view.rect.x0 - rect.x0));
  }
};

// What the views say of each Gaussian of the scene, px.
struct Seen {
  std::vector<double> all, inside, agreed;
  PlaneSums sums;  // all and inside, in the rasteriser's units

  explicit Seen(std::size_t n) : all(n), inside(n), agreed(n), sums(n, 2) {}
  bool shown(std::size_t g) const {
    constexpr double kLeastPx = 0.5;
    return all[g] > kLeastPx;
  }
  bool in_masks(std::size_t g) const { return inside[g] > 0.5 * all[g]; }
  bool sure(std::size_t g) const {
    constexpr double kAgreed = 0.9;
    return shown(g) && agreed[g] > kAgreed * all[g];
  }
};

void add_view(const Drawer& scene, const OwnView& view, Seen* seen, const Job& job) {
  const Surroundings around(view, kSurroundingsPx);
  std::vector<Image<float>> planes(2, Image<float>(around.rect.width(), around.rect.height(), 1));
  for (std::size_t i = 0; i < around.inside.size(); ++i)
    planes[1].pixels()[i] = around.inside.pixels()[i] ? 1.0f : 0.0f;
  RasterOptions raster;
  raster.colour = false;
  raster.roi = around.rect;
  raster.sum_planes = planes;
  raster.plane_sums = &seen->sums;
  scene.draw(view.camera, raster, job);
  for_each_index(seen->all.size(), [&](std::size_t g) {  // sums are exact, and so are their differences
    const double all = seen->sums.at(g, 0) - seen->all[g];
    if (all == 0) return;
    const double inside = seen->sums.at(g, 1) - seen->inside[g];
    seen->all[g] += all;
    seen->inside[g] += inside;
    seen->agreed[g] += std::abs(2 * inside - all);
  });
}

// The sure Gaussians, which say whose a place is. Those of other objects that leave stand for the object.
class Neighbours {
 public:
  Neighbours(const GaussianCloud& cloud, std::span<const std::uint8_t> labels,
             const std::vector<std::uint8_t>& rest, const Seen& seen) {
    for (std::size_t g = 0; g < cloud.size(); ++g) {
      if (!seen.sure(g) || (labels[g] != 0) != seen.in_masks(g)) continue;
      position_.push_back(cloud.position[g]);
      labelled_.push_back(rest[g] == 0);
    }
  }

  // Per place, how many of the nearest are the object's; half of them where there are too few to say.
  std::vector<std::size_t> of_object(const std::vector<glm::vec3>& places, const Job& job) const {
    if (position_.size() < kNearest) return std::vector<std::size_t>(places.size(), kNearest / 2);
    const std::vector<std::uint32_t> near = k_nearest_of(position_, places, kNearest, job);
    std::vector<std::size_t> count(places.size(), 0);
    for (std::size_t i = 0; i < near.size(); ++i)
      if (near[i] != kNoNeighbour) count[i / kNearest] += labelled_[near[i]];
    return count;
  }

 private:
  std::vector<glm::vec3> position_;
  std::vector<std::uint8_t> labelled_;
};

std::vector<std::uint32_t> in_the_midst(const GaussianCloud& cloud, const std::vector<std::uint8_t>& rest,
                                        std::span<const std::uint32_t> object, const Seen& seen,
                                        const Neighbours& sure, const Job& job) {
  if (object.empty()) return {};
  glm::vec3 low = cloud.position[object.front()], high = low;
  for (const std::uint32_t g : object) {
    low = glm::min(low, cloud.position[g]);
    high = glm::max(high, cloud.position[g]);
  }
  std::vector<std::uint32_t> candidates;
  std::vector<glm::vec3> places;
  for (std::uint32_t g = 0; g < cloud.size(); ++g) {
    const glm::vec3& p = cloud.position[g];
    if (!rest[g] || glm::any(glm::lessThan(p, low)) || glm::any(glm::greaterThan(p, high))) continue;
    if (seen.shown(g) && !seen.in_masks(g)) continue;
    candidates.push_back(g);
    places.push_back(p);
  }
  const std::vector<std::size_t> of_object = sure.of_object(places, job);
  std::vector<std::uint32_t> ghosts;
  for (std::size_t i = 0; i < candidates.size(); ++i)
    if (2 * of_object[i] > kNearest) ghosts.push_back(candidates[i]);
  return ghosts;
}

enum RingPlane : std::size_t { kRingGrowth, kRingShown, kRingPlanes };

// What surrounds the object in one of its views.
class Ring {
 public:
  Ring(const Drawer& scene, const OwnView& view, const std::vector<std::uint8_t>& rest, const Job& job)
      : scene_(scene), camera_(view.camera), rest_(rest), around_(view, kRingPx) {
    raster_.roi = around_.rect;
    truth_ = scene_.draw(camera_, raster_, job).colour;
    raster_.shown = rest_;
    with_ = scene_.draw(camera_, raster_, job).colour;
    ring_ = dilated(around_.inside, kRingPx);
  }

  // Adds for each Gaussian of the rest by how much the error grows where it shows, if `without` is all that
  // is left, and what it shows.
  void add_growth(const std::vector<std::uint8_t>& without, PlaneSums* sums, const Job& job) const {
    RasterOptions raster = raster_;
    raster.shown = without;
    const Image<glm::vec3> left = scene_.draw(camera_, raster, job).colour;
    std::vector<Image<float>> growth(kRingPlanes, Image<float>(around_.rect.width(), around_.rect.height()));
    std::ranges::fill(growth[kRingShown].pixels(), 1.0f);
    if (left.size() != ring_.size()) return;  // cancelled
    for (std::size_t i = 0; i < left.size(); ++i) {
      if (around_.inside.pixels()[i] || !ring_.pixels()[i]) continue;
      const glm::vec3 &truth = truth_.pixels()[i], after = left.pixels()[i] - truth,
                      before = with_.pixels()[i] - truth;
      growth[kRingGrowth].pixels()[i] =
          std::clamp((glm::dot(after, after) - glm::dot(before, before)) / 3, -1.0f, 1.0f);
    }
    raster.shown = rest_;
    raster.colour = false;
    raster.sum_planes = growth;
    raster.plane_sums = sums;
    scene_.draw(camera_, raster, job);
  }

 private:
  static constexpr int kRingPx = 8;
  const Drawer& scene_;
  const Camera& camera_;
  const std::vector<std::uint8_t>& rest_;
  Surroundings around_;
  RasterOptions raster_;
  Image<glm::vec3> truth_, with_;
  Mask ring_;
};

void keep_what_surrounds(std::span<const Ring> rings, const std::vector<std::uint8_t>& rest,
                         std::vector<std::uint32_t>* ghosts, const Job& job) {
  constexpr double kMostGrowth = 2e-6;
  if (ghosts->empty()) return;
  std::vector<std::uint8_t> without = rest;
  for (const std::uint32_t g : *ghosts) without[g] = 0;
  PlaneSums sums(rest.size(), kRingPlanes);
  for (std::size_t v = 0; v < rings.size() && !job.cancelled(); ++v) {
    job.progress("ghosts", static_cast<double>(v) / static_cast<double>(rings.size()));
    rings[v].add_growth(without, &sums, job);
  }
  std::erase_if(*ghosts, [&](std::uint32_t g) {
    return sums.at(g, kRingGrowth) > kMostGrowth * sums.at(g, kRingShown);
  });
}

GaussianCloud given_back(const GaussianCloud& cloud, std::span<const std::uint32_t> object,
                         std::span<const CutOff> cut_off, const Neighbours& sure, const Job& job) {
  std::vector<glm::vec3> places;
  for (const CutOff& c : cut_off) places.push_back(c.part.mean);
  const std::vector<std::size_t> of_object = sure.of_object(places, job);
  std::vector<std::uint32_t> whole;
  std::vector<const SolidGaussian*> parts;
  for (std::size_t i = 0; i < cut_off.size(); ++i) {
    if (2 * of_object[i] >= kNearest) continue;
    whole.push_back(object[cut_off[i].of]);
    parts.push_back(&cut_off[i].part);
  }
  GaussianCloud back = permuted(cloud, whole);
  for (std::size_t i = 0; i < parts.size(); ++i) {
    back.position[i] = parts[i]->mean;
    back.scale[i] = parts[i]->scale;
    back.rotation[i] = parts[i]->rotation;
    back.opacity[i] = parts[i]->opacity;
  }
  return back;
}

}  // namespace

RestChanges forget(const GaussianCloud& cloud, std::span<const std::uint8_t> labels,
                   std::span<const std::uint32_t> object, std::span<const OwnView> views,
                   std::span<const CutOff> cut_off, std::span<const std::uint8_t> leaving, const Job& job) {
  KeptViews last(cloud, 0);
  const Drawer drawer(cloud, &last);
  std::vector<std::uint8_t> rest(labels.size());
  for (std::size_t g = 0; g < rest.size(); ++g) rest[g] = !labels[g] && (leaving.empty() || !leaving[g]);
  Seen seen(cloud.size());
  std::vector<Ring> rings;
  for (std::size_t v = 0; v < views.size() && !job.cancelled(); ++v) {
    job.progress("the rest", static_cast<double>(v) / static_cast<double>(views.size()));
    rings.emplace_back(drawer, views[v], rest, job);
    add_view(drawer, views[v], &seen, job);
  }
  if (job.cancelled()) return {};
  const Neighbours sure(cloud, labels, rest, seen);
  RestChanges changes{in_the_midst(cloud, rest, object, seen, sure, job),
                      given_back(cloud, object, cut_off, sure, job)};
  keep_what_surrounds(rings, rest, &changes.ghosts, job);
  return changes;
}

void add(const RestChanges& more, RestChanges* changes) {
  std::vector<std::uint32_t>& ghosts = changes->ghosts;
  const auto had = static_cast<std::ptrdiff_t>(ghosts.size());
  ghosts.insert(ghosts.end(), more.ghosts.begin(), more.ghosts.end());
  std::inplace_merge(ghosts.begin(), ghosts.begin() + had, ghosts.end());
  ghosts.erase(std::unique(ghosts.begin(), ghosts.end()), ghosts.end());
  if (!more.given_back.empty())
    changes->given_back =
        changes->given_back.empty() ? more.given_back : joined({changes->given_back, more.given_back});
}

GaussianCloud rest_of(const GaussianCloud& scene, std::span<const std::uint8_t> shown,
                      const RestChanges& changes) {
  std::vector<std::uint8_t> keep(shown.begin(), shown.end());
  for (const std::uint32_t g : changes.ghosts) keep[g] = 0;
  std::vector<std::uint32_t> order;
  for (std::uint32_t g = 0; g < keep.size(); ++g)
    if (keep[g]) order.push_back(g);
  return changes.given_back.empty() ? permuted(scene, order)
                                    : joined({permuted(scene, order), changes.given_back});
}

}  // namespace splatcut
