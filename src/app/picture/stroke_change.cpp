#include "app/picture/stroke_change.h"

#include <algorithm>
#include <array>
#include <functional>

#include "segment/finish/shown_part.h"
#include "segment/masks/mask_tools.h"

namespace splatcut {

namespace {

enum Part : std::uint32_t { kOther, kStayed, kLeft, kLeftUnseen, kCame, kCameUnseen, kParts };

constexpr int kSightWidthPx = 320;   // as cuts look at views
constexpr double kLeastShare = 0.1;  // what is left of a surface that is seen 6 degrees from edge-on

}  // namespace

// By each Gaussian of the object, before or now; others: 0.
std::vector<double> StrokeChange::covered_from(const Camera& camera, std::span<const std::uint8_t> displayed,
                                               const Job& job) const {
  const GaussianCloud& cloud = scene_.cloud();
  PlaneSums shown(cloud.size(), 1);
  const PixelRect rect = labelled_rectangle(cloud, camera, either_);
  if (!rect.empty()) add_shown_px(scene_, camera, rect, displayed, &shown, job);
  std::vector<double> covered(cloud.size(), 0);
  for (std::size_t g = 0; g < covered.size(); ++g)
    if (either_[g]) {
      const double side = camera.camera_from_world(cloud.position[g]).z / camera.fy_px;
      covered[g] = shown.at(g, 0) * side * side;
    }
  return covered;
}

StrokeChange::StrokeChange(const Drawer& scene, const StrokedView& made_in,
                           std::span<const std::uint8_t> before, std::span<const std::uint8_t> after,
                           const Job& job)
    : scene_(scene), before_(before), after_(after), either_(before.size()) {
  std::ranges::transform(before, after, either_.begin(), std::bit_or<>());
  std::span<const std::uint8_t> displayed;
  if (made_in.seen) displayed = *made_in.seen;
  covered_ = covered_from(limited_to_width(made_in.camera, kSightWidthPx), displayed, job);
}

ChangeSeen StrokeChange::seen_from(const Camera& camera, const Job& job) const {
  // Of what the object showed here before, and of what it shows now. A foot or a third of a can's back are
  // more, a border that moves by a pixel is less. What is added does less harm: too much shows beside it.
  constexpr double kMuchLeft = 0.04, kMuchCame = 0.08, kFewestPx = 24;  // fewer are not made out
  const std::vector<double> here = covered_from(camera, {}, job);
  std::vector<std::uint32_t> part_of(here.size(), kOther);
  for (std::size_t g = 0; g < here.size(); ++g) {
    const bool in_sight = covered_[g] >= kLeastShare * here[g];
    if (either_[g])
      part_of[g] = before_[g] && after_[g] ? kStayed
                   : before_[g]            ? (in_sight ? kLeft : kLeftUnseen)
                                           : (in_sight ? kCame : kCameUnseen);
  }
  RasterOptions options;
  options.colour = false;
  options.groups = part_of;
  const Image<std::uint32_t> part = scene_.draw(camera, options, job).group;
  const Mask none(part.width(), part.height());
  ChangeSeen seen{none, none, none, {}, {}};
  std::array<double, kParts> px{};
  for (std::size_t i = 0; i < part.size(); ++i) {
    const std::uint32_t p = part.pixels()[i] == kNoGroup ? kOther : part.pixels()[i];
    px.at(p) += 1;
    const bool left = p == kLeft || p == kLeftUnseen, came = p == kCame || p == kCameUnseen;
    seen.object.pixels()[i] = came || p == kStayed ? kMaskObject : 0;
    seen.left.pixels()[i] = left ? kMaskObject : 0;
    seen.came.pixels()[i] = came ? kMaskObject : 0;
  }
  const auto is_much = [&](Part unseen, Part in_sight, double share) {
    return px[unseen] >= kFewestPx && px[unseen] >= share * (px[kStayed] + px[in_sight] + px[unseen]);
  };
  const auto note = [&](Part unseen, std::vector<std::uint32_t>* noted, const char* doubt) {
    for (std::uint32_t g = 0; g < part_of.size(); ++g)
      if (part_of[g] == unseen && here[g] > 0) noted->push_back(g);
    if (seen.doubt.empty()) seen.doubt = doubt;
  };
  if (is_much(kLeftUnseen, kLeft, kMuchLeft))
    note(kLeftUnseen, &seen.open.out,
         "what is red here was taken away, unseen from where you clicked or drew");
  if (is_much(kCameUnseen, kCame, kMuchCame))
    note(kCameUnseen, &seen.open.in, "what is green here was added, unseen from where you clicked or drew");
  return seen;
}

}  // namespace splatcut
