#include "segment/selection/click_selection.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "segment/masks/mask_tools.h"
#include "segment/selection/click_reach.h"
#include "segment/selection/reached_leaves.h"
#include "segment/selection/region_by_colour.h"
#include "segment/selection/settled_by_colour.h"

namespace splatcut {

namespace {

constexpr int kReachPx = 4;  // a click beside the scene's edge still hits it

glm::ivec2 nearest_pixel(const Camera& camera, const glm::vec2& point) {
  return {std::clamp(static_cast<int>(point.x), 0, camera.width_px - 1),
          std::clamp(static_cast<int>(point.y), 0, camera.height_px - 1)};
}

std::size_t row_by_row(const Camera& camera, const glm::ivec2& at) {
  return static_cast<std::size_t>(at.y) * static_cast<std::size_t>(camera.width_px) +
         static_cast<std::size_t>(at.x);
}

std::vector<std::uint32_t> disc_pixels(const Camera& camera, const glm::ivec2& centre, float radius_px) {
  std::vector<std::uint32_t> pixels;
  const int cx = centre.x, cy = centre.y;
  const int reach = static_cast<int>(radius_px) + 1;
  for (int y = std::max(0, cy - reach); y <= std::min(camera.height_px - 1, cy + reach); ++y)
    for (int x = std::max(0, cx - reach); x <= std::min(camera.width_px - 1, cx + reach); ++x)
      if (static_cast<float>((x - cx) * (x - cx) + (y - cy) * (y - cy)) <= radius_px * radius_px)
        pixels.push_back(static_cast<std::uint32_t>(y * camera.width_px + x));
  return pixels;
}

// At the nearest pixel that shows a leaf for which `off` holds: the one of them that shows most.
std::uint32_t leaf_near(const LeafView& view, const glm::vec2& pixel, const auto& off) {
  const int cx = static_cast<int>(pixel.x), cy = static_cast<int>(pixel.y);
  std::uint32_t best = kNoPart;
  int nearest = std::numeric_limits<int>::max();
  for (int y = std::max(0, cy - kReachPx); y <= std::min(view.camera.height_px - 1, cy + kReachPx); ++y)
    for (int x = std::max(0, cx - kReachPx); x <= std::min(view.camera.width_px - 1, cx + kReachPx); ++x) {
      const int d2 = (x - cx) * (x - cx) + (y - cy) * (y - cy);
      if (d2 >= nearest) continue;
      for (const GroupWeight& w : view.leaves.at(static_cast<std::size_t>(y) * view.camera.width_px + x))
        if (off(w.group)) {  // heaviest first
          best = w.group;
          nearest = d2;
          break;
        }
    }
  return best;
}

}  // namespace

ClickSelection::ClickSelection(const PartHierarchy& parts, const SelectionModel& model, int choice)
    : parts_(parts),
      model_(model),
      choice_(choice),
      selected_{.object = std::vector<std::uint8_t>(parts.leaves, 0),
                .said = std::vector<std::int8_t>(parts.leaves, 0),
                .clicked = {},
                .changes = {},
                .meanings = nullptr},
      labels_(parts.leaf_of.size(), 0),
      said_(parts.leaf_of.size(), 0),
      by_colour_(parts.leaf_of.size(), 0) {}

std::vector<std::uint8_t> ClickSelection::certain_leaves(const LeafView& view,
                                                         std::span<const std::uint32_t> disc) const {
  std::vector<float> in_disc(parts_.leaves, 0);
  for (const std::uint32_t pixel : disc)
    for (const GroupWeight& w : view.leaves.at(pixel)) in_disc[w.group] += w.weight;
  const Camera& camera = view.camera;
  const auto visible_share = [&](std::uint32_t leaf) {
    const float depth = std::max(camera.camera_from_world(parts_.leaf_centre_world[leaf]).z, 1e-15f);
    const float facing_px = parts_.leaf_area[leaf] * camera.fx_px * camera.fx_px / (depth * depth);
    return view.leaf_px[leaf] / std::max(facing_px, 1e-6f);
  };
  std::vector<std::uint8_t> certain(parts_.leaves, 0);
  for (std::uint32_t leaf = 0; leaf < parts_.leaves; ++leaf)
    certain[leaf] = in_disc[leaf] > kLeastChangePx &&
                    in_disc[leaf] > model_.disc_majority * view.leaf_px[leaf] &&
                    visible_share(leaf) > model_.least_visible;
  return certain;
}

std::span<const Mask> ClickSelection::meanings() const {
  return offers_ ? std::span<const Mask>(offers_->masks) : std::span<const Mask>();
}

std::size_t ClickSelection::bytes() const {
  std::size_t bytes = labels_.size() + said_.size() + by_colour_.size() + 2 * selected_.object.size();
  for (const Mask& mask : size_masks()) bytes += mask.size();
  for (const Mask& mask : meanings()) bytes += mask.size();
  return bytes;
}

// Offers the likeliest meaning, then the next likely ones that look clearly different. Each is settled where
// the trees disagree.
void ClickSelection::note_offers(const LeafView& view, const Answers& found,
                                 std::span<const PartMeaning> meanings) {
  Offers offers;
  for (const Candidate& candidate : found.candidates) {
    if (std::ssize(offers.meant) == kMostMeanings ||
        candidate.cost > found.candidates.front().cost + model_.offered)
      break;
    std::vector<std::uint8_t> leaves = leaves_changed(found, candidate);
    const auto offered_already = [&] {
      return std::ranges::any_of(offers.meant,
                                 [&](const auto& other) { return look_alike(view, other, leaves); });
    };
    if (offered_already()) continue;
    leaves = settled_by_colour(parts_, view, meanings, leaves, offers.meant);
    if (offered_already()) continue;
    offers.masks.push_back(shown(view.leaves, view.camera, leaves));
    offers.meant.push_back(std::move(leaves));
  }
  offers_ = std::make_shared<const Offers>(std::move(offers));
}

std::vector<std::uint8_t> ClickSelection::leaves_changed(const Answers& found,
                                                         const Candidate& candidate) const {
  std::vector<std::uint8_t> leaves(parts_.leaves);
  for (std::uint32_t l = 0; l < parts_.leaves; ++l) leaves[l] = found.changes(candidate, l);
  return leaves;
}

struct ClickSelection::Asked {
  glm::ivec2 at;
  std::uint32_t leaf;  // kNoPart: nothing is on the other side there
  Mask displayed;
  float radius_px;
};

ClickSelection::Asked ClickSelection::asked(const LeafView& view, const glm::vec2& pixel, bool object) const {
  const glm::ivec2 at = nearest_pixel(view.camera, pixel);
  Asked asked{at,
              leaf_near(view, pixel, [&](std::uint32_t l) { return (selected_.object[l] != 0) != object; }),
              shown(view.gaussians, view.camera, labels_), 0};
  if (any_ && asked.leaf != kNoPart)
    asked.radius_px = displayed_radius(view, asked.displayed, at, object, asked.leaf);
  return asked;
}

std::optional<Answers> ClickSelection::considered(const LeafView& view, const glm::vec2& pixel, bool object,
                                                  const AnswerOptions& options) const {
  const Asked a = asked(view, pixel, object);
  if (a.leaf == kNoPart) return std::nullopt;
  return answers(parts_, selected_, {view, a.at, object, !any_, a.leaf, a.radius_px, a.displayed}, model_,
                 options);
}

bool ClickSelection::take(const LeafView& view, const glm::vec2& pixel, const Stroke& stroke, bool close_up) {
  const bool object = stroke.label == SeedLabel::kObject;
  const float least_radius_px = stroke.radius_px;
  const auto [at, leaf, displayed, radius_px] = asked(view, pixel, object);
  if (leaf == kNoPart) {
    if (object) take_back_colour_at(view, pixel);
    confirm(view, pixel, object, least_radius_px);
    return true;
  }
  const Click click{view, at, object, !any_, leaf, radius_px, displayed};
  const std::vector<std::uint32_t> certain_px = disc(view.camera, at, radius_px, least_radius_px);
  Answers found = answers(parts_, selected_, click, model_, {.close_up = close_up});
  if (found.candidates.empty()) return false;
  std::vector<std::uint8_t> certain(parts_.leaves, 0);
  std::vector<std::uint32_t> like_px;
  if (any_) {
    if (stroke.is_click()) like_px = pixels_by_colour(click, found, certain_px);
    certain = certain_leaves(view, certain_px);
    std::vector<std::uint8_t> meant = leaves_changed(found, found.candidates.front());
    if (stroke.is_click()) meant = within_reach(click, selected_.object, std::move(meant));
    if (!like_px.empty()) {
      const std::vector<std::uint8_t> like = certain_leaves(view, like_px);
      for (std::uint32_t l = 0; l < parts_.leaves; ++l) meant[l] |= like[l] && found.free[l];
    }
    if (stroke.is_click()) {
      meant = corrected_leaves(click, found, meant, {certain_px, like_px}, stroke.size_step);
      if (sizes_.size < sizes_.likeliest) like_px.clear();
    }
    if (object) take_back_colour(meant);
    change_leaves(meant, certain, click);
  } else {
    certain[leaf] = 1;
    change_leaves(first_leaves(view, found, stroke.size_step), certain, click);
  }
  any_ = true;
  label();
  pin(view, certain_px, object);
  if (!like_px.empty()) pin_by_colour(view, like_px);
  insist(view, row_by_row(view.camera, at), object);
  if (stroke.size_step != 0) spot_alone_ = false;  // as was asked for
  return true;
}

// The region that a click on the rest finds by colour; none where the likeliest part changes half of it.
std::vector<std::uint32_t> ClickSelection::pixels_by_colour(const Click& click, const Answers& answers,
                                                            std::span<const std::uint32_t> disc) const {
  constexpr float kScrap = 0.5f;
  const Candidate& part = answers.candidates.front();
  const float part_px =
      part.index == Candidate::kDiscAlone ? 0 : answers.chains[part.chain].changed_px[part.index];
  const Mask region = region_by_colour(click, disc, part_px / kScrap);
  std::vector<std::uint32_t> pixels;
  for (std::size_t i = 0; i < region.size(); ++i)
    if (region.pixels()[i]) pixels.push_back(static_cast<std::uint32_t>(i));
  return pixels;
}

void ClickSelection::change_leaves(const std::vector<std::uint8_t>& meant,
                                   const std::vector<std::uint8_t>& certain, const Click& click) {
  const std::int8_t sign = click.object ? 1 : -1;
  Change change{.leaves = {}, .clicked = click.leaf, .object = click.object};
  bool followed = false;
  for (std::uint32_t l = 0; l < parts_.leaves; ++l) {
    const bool follows = meant[l] && selected_.said[l] != -sign;
    if (certain[l]) selected_.said[l] = sign;
    if (!certain[l] && !follows) continue;
    if ((selected_.object[l] != 0) != click.object) {
      followed |= !certain[l];
      change.leaves.push_back(l);
    }
    selected_.object[l] = click.object;
  }
  constexpr float kSpotPx = 4;  // a click nearer to the border mends the border
  spot_alone_ = !click.first && !followed && click.radius_px > kSpotPx;
  selected_.clicked[click.object].push_back(click.leaf);
  if (!click.first) selected_.changes.push_back(std::move(change));
}

// Distance to where the wrong region may end. Where the object itself was left out of the picture there is
// none: the clicked leaf's own size stands in its place.
float ClickSelection::displayed_radius(const LeafView& view, const Mask& displayed, const glm::ivec2& at,
                                       bool object, std::uint32_t leaf) const {
  if (object && !view.whole && count(displayed) == 0)
    return std::max(std::sqrt(view.leaf_px[leaf] / std::numbers::pi_v<float>), 1.0f);
  return distance_to_end(view.depth, displayed, at, object);
}

// What is displayed as said already is held: a later click's parts do not take it back.
void ClickSelection::confirm(const LeafView& view, const glm::vec2& pixel, bool object,
                             float least_radius_px) {
  const glm::ivec2 at = nearest_pixel(view.camera, pixel);
  const float radius_px = distance_to_border(shown(view.gaussians, view.camera, labels_), at, object);
  pin(view, disc(view.camera, at, radius_px, least_radius_px), object, Pin::kSaidAlready);
  const std::uint32_t leaf =
      leaf_near(view, pixel, [&](std::uint32_t l) { return (selected_.object[l] != 0) == object; });
  if (leaf != kNoPart) selected_.clicked[object].push_back(leaf);
  insist(view, row_by_row(view.camera, at), object);
}

// What is certain around a click: radius_px to where the region may end; the stroke's own radius at least.
std::vector<std::uint32_t> ClickSelection::disc(const Camera& camera, const glm::ivec2& at, float radius_px,
                                                float least_radius_px) const {
  return disc_pixels(camera, at, std::max({model_.disc_share * radius_px, least_radius_px, 1.0f}));
}

std::vector<std::uint8_t> ClickSelection::mostly_in(const LeafView& view,
                                                    std::span<const std::uint32_t> pixels) const {
  std::vector<float> inside(labels_.size(), 0);
  for (const std::uint32_t pixel : pixels)
    for (const GroupWeight& w : view.gaussians.at(pixel)) inside[w.group] += w.weight;
  std::vector<std::uint8_t> mostly(labels_.size());
  for (std::size_t g = 0; g < mostly.size(); ++g)
    mostly[g] = inside[g] > 0 && inside[g] > model_.disc_majority * view.gaussian_px[g];
  return mostly;
}

// The Gaussians that show mostly in these pixels take the label and keep it; or those alone that have it, as
// something of the other side may shine through from behind.
void ClickSelection::pin(const LeafView& view, std::span<const std::uint32_t> pixels, bool object,
                         Pin which) {
  const std::vector<std::uint8_t> mostly = mostly_in(view, pixels);
  for (std::size_t g = 0; g < labels_.size(); ++g)
    if (mostly[g] && (which == Pin::kAll || (labels_[g] != 0) == object)) decide(g, object);
  label();
}

// The Gaussians that show mostly in these pixels become rest until a click on the object takes them back.
void ClickSelection::pin_by_colour(const LeafView& view, std::span<const std::uint32_t> pixels) {
  const std::vector<std::uint8_t> mostly = mostly_in(view, pixels);
  for (std::size_t g = 0; g < labels_.size(); ++g)
    if (mostly[g] && said_[g] == 0) {
      said_[g] = -1;
      by_colour_[g] = 1;
    }
  spot_alone_ = false;
  label();
}

// The leaf at the pixel is object, but some of its Gaussians are rest by their colour.
void ClickSelection::take_back_colour_at(const LeafView& view, const glm::vec2& pixel) {
  const std::uint32_t leaf = leaf_near(view, pixel, [](std::uint32_t) { return true; });
  if (leaf == kNoPart) return;
  std::vector<std::uint8_t> leaves(parts_.leaves, 0);
  leaves[leaf] = 1;
  take_back_colour(leaves);
  label();
}

// Gaussians of these leaves that are rest by their colour alone get the label of their leaf again.
void ClickSelection::take_back_colour(std::span<const std::uint8_t> leaves) {
  for (std::size_t g = 0; g < labels_.size(); ++g)
    if (by_colour_[g] && parts_.leaf_of[g] != kNoPart && leaves[parts_.leaf_of[g]])
      by_colour_[g] = said_[g] = 0;
}

void ClickSelection::decide(std::size_t gaussian, bool object) {
  said_[gaussian] = object ? 1 : -1;
  by_colour_[gaussian] = 0;
}

// The clicked pixel and those around it show what was said, clearly enough for pictures of another size to
// agree. The Gaussians that make the clicked pixel are held: no later stage overrules them. Those that turn
// come in the order of how much of the pixel they make for how large they are: what a wall or the sky shows
// of itself here is no reason to take the wall along.
void ClickSelection::insist(const LeafView& view, std::size_t pixel, bool object) {
  constexpr float kClearly = 0.65f,
                  kSmallest = 0.005f;  // of the picture: smaller ones harm nothing elsewhere
  const int width = view.camera.width_px, height = view.camera.height_px;
  const float smallest_px = kSmallest * static_cast<float>(width) * static_cast<float>(height);
  const int cx = static_cast<int>(pixel) % width, cy = static_cast<int>(pixel) / width;
  const auto per_size = [&](const GroupWeight& w) {
    return w.weight / std::max(smallest_px, view.alone_px.empty() ? 0 : view.alone_px[w.group]);
  };
  for (int y = std::max(0, cy - 1); y <= std::min(height - 1, cy + 1); ++y)
    for (int x = std::max(0, cx - 1); x <= std::min(width - 1, cx + 1); ++x) {
      float share = 0, all = 0;
      const auto entries = view.gaussians.at(static_cast<std::size_t>(y) * width + x);
      for (const GroupWeight& w : entries) {
        share += (labels_[w.group] != 0) == object ? w.weight : 0;
        all += w.weight;
      }
      const float enough = std::min(kClearly, all);
      const bool centre = x == cx && y == cy;
      if (share >= enough && !centre) continue;
      std::vector<GroupWeight> in_turn(entries.begin(), entries.end());
      std::ranges::stable_sort(in_turn, std::ranges::greater(), per_size);
      for (const GroupWeight& w : in_turn) {
        if (share >= enough) break;
        if ((labels_[w.group] != 0) == object) continue;
        decide(w.group, object);
        labels_[w.group] = object;
        share += w.weight;
      }
      if (!centre) continue;
      float held = 0;
      for (const GroupWeight& w : in_turn) {
        if (held >= enough) break;
        if ((labels_[w.group] != 0) != object) continue;
        decide(w.group, object);
        held += w.weight;
      }
    }
}

void ClickSelection::label() {
  for (std::size_t g = 0; g < labels_.size(); ++g) {
    const std::uint32_t leaf = parts_.leaf_of[g];
    labels_[g] = said_[g] ? said_[g] > 0 : leaf != kNoPart && selected_.object[leaf];
  }
}

void ClickSelection::carry(std::span<const std::uint8_t> labels) {
  std::vector<std::int32_t> balance(parts_.leaves, 0);  // Gaussians of the object less those of the rest
  for (std::size_t g = 0; g < labels.size(); ++g)
    if (parts_.leaf_of[g] != kNoPart) balance[parts_.leaf_of[g]] += labels[g] ? 1 : -1;
  for (std::uint32_t l = 0; l < parts_.leaves; ++l) selected_.object[l] = balance[l] > 0;
  for (std::size_t g = 0; g < labels.size(); ++g)
    if (by_colour_[g] && labels[g]) by_colour_[g] = said_[g] = 0;
  label();
}

bool ClickSelection::apply(const LeafView& view, const Stroke& stroke, const FirstStroke& first) {
  const bool object = stroke.label == SeedLabel::kObject;
  if (!any_ && !object) return false;
  sizes_ = {};
  if (stroke.is_box()) return take_box(view, stroke, first);
  const auto anything = [](std::uint32_t) { return true; };
  bool hit = false;
  spot_alone_ = false;
  for (const glm::vec2& point : stroke.points_px) {
    if (leaf_near(view, point, anything) == kNoPart) continue;
    float share = 0;
    for (const GroupWeight& w : view.gaussians.at(row_by_row(view.camera, nearest_pixel(view.camera, point))))
      share += labels_[w.group] ? w.weight : 0;
    if (!any_ || (share >= 0.5f) != object)
      hit = take(view, point, stroke, first.close_up) || hit;
    else {
      if (stroke.points_px.size() == 1) confirm(view, point, object, stroke.radius_px);
      hit = true;
    }
  }
  if (stroke.points_px.size() < 2 || !hit) return hit;
  const Image<std::uint8_t> drawn = draw_seeds({stroke}, view.camera.width_px, view.camera.height_px);
  std::vector<std::uint32_t> under;
  for (std::size_t i = 0; i < drawn.size(); ++i)
    if (drawn.pixels()[i] != kNoSeed) under.push_back(static_cast<std::uint32_t>(i));
  pin(view, under, object);
  for (const std::uint32_t pixel : under) insist(view, pixel, object);
  spot_alone_ = false;  // a scribble says itself how much is meant
  return true;
}

}  // namespace splatcut
