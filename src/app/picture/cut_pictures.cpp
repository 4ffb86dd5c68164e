#include "app/picture/cut_pictures.h"

#include <algorithm>
#include <optional>

#include "app/picture/stroke_change.h"
#include "scene/raster/depth_jump.h"
#include "segment/finish/seen_from.h"
#include "segment/masks/mask_tools.h"

namespace splatcut {

namespace {

constexpr int kViewsToLookFrom = 6;
constexpr int kThumbnailWidth = 160, kLargeWidth = 3 * kThumbnailWidth;
constexpr int kFewestShownPx = 40;       // of a thumbnail's 15,000: fewer of the object are not made out
constexpr float kSameDirection = 0.94f;  // cosine, 20 degrees: views around an object are farther apart
constexpr const char* kThroughSurface = "here the border runs through a surface";
constexpr double kMuchThroughSurface =
    0.2;  // see share_through_surface(); whole things of the sample have .13 at most

RasterOutput drawn_small(const GaussianCloud& cloud, const Camera& camera, const Job& job) {
  RasterOptions options;
  options.depth = true;
  return rasterize(cloud, limited_to_width(camera, kThumbnailWidth), options, job);
}

// change: of the drawing's size; without masks where there is none.
Image<Rgba8> thumbnail(const RasterOutput& drawn, const Mask& mask, bool counts, const Rgb8& colour,
                       const ChangeSeen& change) {
  constexpr glm::vec3 kLeft{0.96f, 0.12f, 0.12f}, kCame{0.35f, 0.86f, 0.47f};
  Image<Rgba8> out(drawn.colour.width(), drawn.colour.height());
  const glm::vec3 hue = glm::vec3(colour[0], colour[1], colour[2]) / 255.0f;
  for (int y = 0; y < out.height(); ++y)
    for (int x = 0; x < out.width(); ++x) {
      const int u = x * mask.width() / out.width(), v = y * mask.height() / out.height();
      glm::vec3 c = drawn.colour.at(x, y);
      if (!change.left.empty() && change.left.at(x, y))
        c = glm::mix(c, kLeft, 0.7f);
      else if (!change.came.empty() && change.came.at(x, y))
        c = glm::mix(c, kCame, 0.7f);
      else
        c = mask.at(u, v) ? glm::mix(c, hue, 0.55f) : 0.75f * c;
      if (!counts) c *= 0.35f;
      const glm::vec3 b = glm::clamp(c, 0.0f, 1.0f) * 255.0f;
      out.at(x, y) = {static_cast<std::uint8_t>(b.r), static_cast<std::uint8_t>(b.g),
                      static_cast<std::uint8_t>(b.b), 255};
    }
  return out;
}

// Pairs of neighbouring pixels about a mask's border, from one pixel before it to one behind it, as splats on
// it are blended.
struct Border {
  int pairs = 0;
  std::vector<glm::ivec2> inside, outside;  // of the pairs that lie on one surface
  double share() const {
    constexpr int kFewest = 24;  // a smaller border says nothing
    return pairs < kFewest ? 0 : static_cast<double>(inside.size()) / pairs;
  }
};

Border border_of(const RasterOutput& drawn, const Mask& mask) {
  constexpr float kOneColour = 0.08f;  // largest difference in a channel
  const Mask small = resized_mask(mask, drawn.colour.width(), drawn.colour.height());
  const Image<float>& depth = drawn.median_depth;
  Border border;
  const auto look = [&](const glm::ivec2& p, const glm::ivec2& step) {
    const glm::ivec2 q = p + step, inside = p - step, outside = q + step;
    if (!small.at(p.x, p.y) || !small.contains(q.x, q.y) || small.at(q.x, q.y)) return;
    if (!small.contains(inside.x, inside.y) || !small.contains(outside.x, outside.y)) return;
    ++border.pairs;
    const glm::vec3 change =
        glm::abs(drawn.colour.at(inside.x, inside.y) - drawn.colour.at(outside.x, outside.y));
    if (std::max({change.r, change.g, change.b}) >= kOneColour ||
        depth_jumps(depth, inside, outside, kJumpAtBorderOfPart))
      return;
    border.inside.push_back(inside);
    border.outside.push_back(outside);
  };
  for (int y = 0; y < small.height(); ++y)
    for (int x = 0; x < small.width(); ++x)
      for (const glm::ivec2& step : {glm::ivec2(1, 0), {-1, 0}, {0, 1}, {0, -1}}) look({x, y}, step);
  return border;
}

// Whether it runs through a surface; then the card is in doubt, of the Gaussians on both sides of it.
bool doubts_border(const RasterOutput& drawn, const Mask& mask, ViewCard* card) {
  const Border border = border_of(drawn, mask);
  if (border.share() <= kMuchThroughSurface) return false;
  const auto shown_at = [&](const std::vector<glm::ivec2>& pixels) {
    std::vector<std::uint32_t> gaussians;
    for (const glm::ivec2& p : pixels)
      if (const std::int32_t g = drawn.first_hit.at(p.x, p.y); g >= 0)
        gaussians.push_back(static_cast<std::uint32_t>(g));
    return gaussians;
  };
  card->doubt = kThroughSurface;
  card->open.push_back(
      std::make_shared<const OpenDoubt>(OpenDoubt{shown_at(border.outside), shown_at(border.inside), true}));
  return true;
}

ViewCard card_of(const ViewReport& view, Image<Rgba8> picture) {
  return {.camera = view.camera,
          .used = view.used,
          .confidence = view.confidence,
          .reason = view.reason,
          .picture = std::make_shared<const Image<Rgba8>>(std::move(picture))};
}

// Whether anybody saw the side that a view around the object shows; why not, or empty.
class DoubtsOfSides {
 public:
  DoubtsOfSides(const Session& session, const CutRequest& request, const CutResult& result)
      : capture_(session.scene().photographs),
        seen_({*session.scene().cloud, nullptr, &session.blocks()}, result.labels,
              request.up_world.value_or(session.scene().up_world),
              -result.views.front().camera.forward_world(), capture_) {}

  std::string of(const Camera& camera, const Job& job) const {
    const glm::vec3 away = camera.centre_world() - seen_.extent().centre_world;
    if (!(glm::length(away) > 0) ||
        seen_.share(glm::normalize(away), kLeastSeenShare, job) >= kLeastSeenShare)
      return {};
    return capture_.empty() ? "the scene hides this side: what is there is a guess"
                            : "no picture of the capture shows this side: what is there is a guess";
  }

 private:
  std::span<const Camera> capture_;
  SeenSides seen_;
};

// The view that holds the stroke; null: none is given.
const StrokedView* view_of(const CutRequest& request, const Stroke* stroke) {
  for (const StrokedView& view : request.strokes)
    for (const Stroke& own : view.strokes)
      if (&own == stroke) return &view;
  return nullptr;
}

// None: there is nothing to show beside the result.
std::optional<StrokeChange> change_of(const Session& session, const CutShown& cut, const Job& job) {
  const std::vector<std::uint8_t>& now = cut.result.labels;
  const StrokedView* made_in = view_of(cut.request, last_stroke(cut.request.strokes));
  if (!made_in || !cut.before || cut.before->size() != now.size() || *cut.before == now ||
      count_flags(*cut.before) == 0 || count_flags(now) == 0)
    return {};
  const Drawer drawer(*session.scene().cloud, nullptr, &session.blocks());
  return StrokeChange(drawer, *made_in, *cut.before, now, job);
}

// Whether a thumbnail shows something of the object, or of what it was before.
bool shows_any(const Image<Rgba8>& picture, const Mask& mask, const ChangeSeen& changed) {
  return count(resized_mask(mask, picture.width(), picture.height())) + count(changed.left) >= kFewestShownPx;
}

void tell(const ChangeSeen& changed, ViewCard* card) {
  card->doubt = changed.doubt;
  card->doubt_of_stroke = !changed.doubt.empty();
  if (card->doubt_of_stroke) card->open.push_back(std::make_shared<const OpenDoubt>(changed.open));
  if (count(changed.left) + count(changed.came) > 0)
    card->legend = "\nRed left with the last stroke, green came with it.";
}

// After clicks the default uses no views around the object.
bool looked_around_by_none(const CutResult& result, const CutRequest& request, const CutSettings& settings) {
  return result.outcome == Outcome::kDone && settings.orbit.views <= 0 && !request.first_mask;
}

}  // namespace

double share_through_surface(const RasterOutput& drawn, const Mask& mask) {
  return border_of(drawn, mask).share();
}

ViewCard mask_card(const ViewReport& view, const Rgb8& colour) {
  const Camera camera = limited_to_width(view.camera, kThumbnailWidth);
  Image<Rgba8> out(camera.width_px, camera.height_px, Rgba8{38, 40, 44, 255});
  for (int y = 0; y < out.height(); ++y)
    for (int x = 0; x < out.width(); ++x)
      if (view.mask.at(x * view.mask.width() / out.width(), y * view.mask.height() / out.height()))
        out.at(x, y) = {colour[0], colour[1], colour[2], 255};
  return card_of(view, std::move(out));
}

std::vector<ViewCard> picture_cards(Session& session, const CutShown& cut, const Job& job) {
  const GaussianCloud& cloud = *session.scene().cloud;
  const CutResult& result = cut.result;
  const std::optional<StrokeChange> change = change_of(session, cut, job);
  const auto changed_in = [&](const Camera& camera) {
    return change ? change->seen_from(limited_to_width(camera, kThumbnailWidth), job) : ChangeSeen();
  };
  std::vector<ViewCard> cards;
  for (const ViewReport& view : result.views) {
    job.progress("pictures of the views",
                 static_cast<double>(cards.size()) / static_cast<double>(result.views.size()));
    const RasterOutput drawn = drawn_small(cloud, view.camera, job);
    const ChangeSeen changed = changed_in(view.camera);
    if (job.cancelled()) return cards;
    ViewCard card = card_of(view, thumbnail(drawn, view.mask, view.used, cut.colour, changed));
    if (!cards.empty() && view.used && !shows_any(*card.picture, view.mask, changed)) continue;
    cards.push_back(std::move(card));
    tell(changed, &cards.back());
    if (cards.back().doubt.empty() && view.used) doubts_border(drawn, view.mask, &cards.back());
  }
  if (!looked_around_by_none(result, cut.request, cut.settings) || result.views.empty()) return cards;
  const DoubtsOfSides doubts(session, cut.request, result);
  std::span<const std::uint8_t> before;
  if (change) before = *cut.before;
  for (const GivenView& view :
       session.look_around(cut.request, result, cut.settings, kViewsToLookFrom, job, before)) {
    const RasterOutput drawn = drawn_small(cloud, view.camera, job);
    const ChangeSeen changed = changed_in(view.camera);
    if (job.cancelled()) return cards;
    const Mask& mask = change ? changed.object : view.mask;
    const auto picture =
        std::make_shared<const Image<Rgba8>>(thumbnail(drawn, mask, true, cut.colour, changed));
    if (!shows_any(*picture, mask, changed)) continue;
    cards.push_back({.camera = view.camera, .used = false, .picture = picture, .only_to_look = true});
    tell(changed, &cards.back());
    if (cards.back().doubt.empty() && !doubts_border(drawn, mask, &cards.back()))
      cards.back().doubt = doubts.of(view.camera, job);
  }
  return cards;
}

Image<Rgba8> large_picture(const Session& session, const CutShown& cut, const ViewCard& card,
                           const Job& job) {
  const Camera& c = card.camera;
  const Camera camera = resized(c, kLargeWidth, std::max(1, kLargeWidth * c.height_px / c.width_px));
  const RasterOutput drawn = rasterize(*session.scene().cloud, camera, {}, job);
  const std::optional<StrokeChange> change = change_of(session, cut, job);
  if (job.cancelled()) return {};
  const ChangeSeen changed = change ? change->seen_from(camera, job) : ChangeSeen();
  const Drawer drawer(*session.scene().cloud, nullptr, &session.blocks());
  const Mask mask =
      change ? changed.object : thresholded(render_labels(drawer, camera, cut.result.labels, job), 0.5f);
  return thumbnail(drawn, mask, card.used || card.only_to_look, cut.colour, changed);
}

CutResult with_labels(const Session& session, CutResult result, const std::vector<std::uint8_t>& labels,
                      const Job& job) {
  const Drawer drawer(*session.scene().cloud, nullptr, &session.blocks());
  result.labels = labels;
  for (ViewReport& view : result.views)
    view.mask = thresholded(render_labels(drawer, view.camera, labels, job), 0.5f);
  return result;
}

std::vector<ViewCard> in_places_of(const std::vector<ViewCard>& before, std::vector<ViewCard> cards) {
  std::vector<ViewCard> out, left;
  for (ViewCard& card : cards)
    (out.empty() ? out : left).push_back(std::move(card));  // the user's own is first
  for (std::size_t i = 1; i < before.size(); ++i) {
    const Camera& old = before[i].camera;
    const auto near = std::ranges::min_element(left, {}, [&](const ViewCard& card) {
      return glm::length(card.camera.centre_world() - old.centre_world());
    });
    if (near == left.end() || glm::dot(near->camera.forward_world(), old.forward_world()) < kSameDirection)
      continue;
    out.push_back(std::move(*near));
    left.erase(near);
  }
  std::ranges::move(left, std::back_inserter(out));
  return out;
}

namespace {

// Those that are still labelled so; none once more than half changed.
std::vector<std::uint32_t> still(const std::vector<std::uint32_t>& gaussians,
                                 const std::vector<std::uint8_t>& labels, bool in) {
  std::vector<std::uint32_t> out;
  std::ranges::copy_if(gaussians, std::back_inserter(out),
                       [&](std::uint32_t g) { return (labels[g] != 0) == in; });
  if (2 * out.size() < gaussians.size()) out.clear();
  return out;
}

std::vector<std::uint32_t> either_of(std::vector<std::uint32_t> some,
                                     const std::vector<std::uint32_t>& others) {
  some.insert(some.end(), others.begin(), others.end());
  std::ranges::sort(some);
  some.erase(std::unique(some.begin(), some.end()), some.end());
  return some;
}

void keep_doubt(const OpenDoubt& doubt, ViewCard* card) {
  if (card->doubt.empty())
    card->doubt = doubt.is_border
                      ? std::string(kThroughSurface)
                      : std::string("something here was ") + (doubt.out.empty() ? "added" : "taken away") +
                            " before, unseen from where you clicked or drew";
  const auto own =
      std::ranges::find_if(card->open, [&](const auto& open) { return open->is_border == doubt.is_border; });
  if (own == card->open.end())
    card->open.push_back(std::make_shared<const OpenDoubt>(doubt));
  else if (!doubt.is_border)
    *own = std::make_shared<const OpenDoubt>(
        OpenDoubt{either_of(doubt.out, (*own)->out), either_of(doubt.in, (*own)->in), false});
}

}  // namespace

void keep_doubts(const std::vector<ViewCard>& before, const std::vector<std::uint8_t>& labels,
                 std::vector<ViewCard>* cards) {
  for (const ViewCard& old : before) {
    if (old.looked_at || cards->empty()) continue;
    ViewCard& nearest = *std::ranges::max_element(*cards, {}, [&](const ViewCard& c) {
      return glm::dot(c.camera.forward_world(), old.camera.forward_world());
    });
    for (const auto& doubt : old.open) {
      const OpenDoubt open{still(doubt->out, labels, false), still(doubt->in, labels, true),
                           doubt->is_border};
      if (open.is_border ? !open.out.empty() && !open.in.empty() : !open.out.empty() || !open.in.empty())
        keep_doubt(open, &nearest);
    }
  }
}

void keep_looks(const std::vector<ViewCard>& before, std::vector<ViewCard>* cards) {
  for (ViewCard& card : *cards)
    card.looked_at |= std::ranges::any_of(before, [&](const ViewCard& old) {
      return old.looked_at &&
             glm::dot(old.camera.forward_world(), card.camera.forward_world()) >= kSameDirection;
    });
}

bool looks_at(const Camera& camera, const ViewCard& card, const GaussianCloud& cloud) {
  if (card.open.empty() || glm::dot(camera.forward_world(), card.camera.forward_world()) < kSameDirection)
    return false;
  std::size_t inside = 0, all = 0;
  for (const auto& open : card.open)
    for (const std::vector<std::uint32_t>* gaussians : {&open->out, &open->in}) {
      all += gaussians->size();
      for (const std::uint32_t g : *gaussians) {
        const glm::vec3 at = camera.camera_from_world(cloud.position[g]);
        const glm::vec2 pixel = camera.pixel_from_camera(at), most(camera.width_px, camera.height_px);
        inside += at.z > 0 && glm::all(glm::lessThan(glm::abs(2.0f * pixel - most), most));
      }
    }
  return 2 * inside > all;
}

namespace {

// Where the stroke's view shows those Gaussians; empty: nowhere.
Mask kept_in_view(const StrokedView& view, const KeptFromCuts& kept, int width_px, int height_px,
                  const Job& job) {
  if (!kept.gaussians) return {};
  RasterOptions options;
  options.colour = false;
  options.labels = *kept.gaussians;
  if (view.seen) options.shown = *view.seen;
  const Drawer drawer(*kept.session.scene().cloud, nullptr, &kept.session.blocks());
  const RasterOutput drawn = drawer.draw(resized(view.camera, width_px, height_px), options, job);
  return thresholded(drawn.label_share, 0.5f);
}

// masks: of one size.
std::vector<Borders> borders_in(const StrokedView& view, const std::vector<Mask>& masks,
                                const KeptFromCuts& kept, const Job& job) {
  const int width_px = masks.front().width(), height_px = masks.front().height();
  const Mask without = kept_in_view(view, kept, width_px, height_px, job);
  const float factor = static_cast<float>(view.camera.width_px) / static_cast<float>(width_px);
  std::vector<Borders> all;
  for (Mask mask : masks) {
    for (std::size_t i = 0; i < without.size(); ++i)
      if (without.pixels()[i]) mask.pixels()[i] = 0;
    all.push_back(outlines(mask));
    for (auto& border : all.back())
      for (glm::vec2& point : border) point *= factor;
  }
  return all;
}

}  // namespace

std::shared_ptr<const ClickMeanings> meanings_of(const CutRequest& request, const CutResult& result,
                                                 const KeptFromCuts& kept, const Job& job) {
  const StrokedView* first = view_of(request, first_stroke(request.strokes));
  if (result.meanings.empty() || !first) return nullptr;
  return std::make_shared<const ClickMeanings>(ClickMeanings{key_of_first_stroke(request), first->camera,
                                                             borders_in(*first, result.meanings, kept, job)});
}

std::shared_ptr<const StrokeSizes> sizes_of(const CutRequest& request, const CutResult& result,
                                            const KeptFromCuts& kept, const Job& job) {
  const StrokedView* last = view_of(request, last_stroke(request.strokes));
  if (result.size_masks.empty() || !last) return nullptr;
  return std::make_shared<const StrokeSizes>(StrokeSizes{key_of_last_stroke(request), result.size,
                                                         result.likeliest_size, last->camera,
                                                         borders_in(*last, result.size_masks, kept, job)});
}

}  // namespace splatcut
