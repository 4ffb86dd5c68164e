#include "app/studio/cut_pictures.h"

#include <algorithm>

#include "scene/raster/rasterizer.h"
#include "segment/masks/mask_tools.h"

namespace splatcut {

namespace {

constexpr int kViewsToLookFrom = 6;
constexpr int kThumbnailWidth = 160;

Image<Rgba8> thumbnail(const GaussianCloud& cloud, const GivenView& view, bool counts, const Rgb8& colour,
                       const Job& job) {
  const Camera camera = limited_to_width(view.camera, kThumbnailWidth);
  const RasterOutput drawn = rasterize(cloud, camera, {}, job);
  Image<Rgba8> out(camera.width_px, camera.height_px);
  const glm::vec3 hue = glm::vec3(colour[0], colour[1], colour[2]) / 255.0f;
  for (int y = 0; y < out.height(); ++y)
    for (int x = 0; x < out.width(); ++x) {
      const int u = x * view.mask.width() / out.width(), v = y * view.mask.height() / out.height();
      glm::vec3 c = drawn.colour.at(x, y);
      c = view.mask.at(u, v) ? glm::mix(c, hue, 0.55f) : 0.75f * c;
      if (!counts) c *= 0.35f;
      const glm::vec3 b = glm::clamp(c, 0.0f, 1.0f) * 255.0f;
      out.at(x, y) = {static_cast<std::uint8_t>(b.r), static_cast<std::uint8_t>(b.g),
                      static_cast<std::uint8_t>(b.b), 255};
    }
  return out;
}

ViewCard card_of(const ViewReport& view, Image<Rgba8> picture) {
  return {view.camera,
          view.used,
          view.confidence,
          view.reason,
          std::make_shared<const Image<Rgba8>>(std::move(picture)),
          false,
          0};
}

// After clicks, fast and default use no views around the object.
bool looked_around_by_none(const CutResult& result, const CutRequest& request, const CutSettings& settings) {
  return result.outcome == Outcome::kDone && settings.orbit.views <= 0 && !request.first_mask;
}

}  // namespace

ViewCard mask_card(const ViewReport& view, const Rgb8& colour) {
  const Camera camera = limited_to_width(view.camera, kThumbnailWidth);
  Image<Rgba8> out(camera.width_px, camera.height_px, Rgba8{38, 40, 44, 255});
  for (int y = 0; y < out.height(); ++y)
    for (int x = 0; x < out.width(); ++x)
      if (view.mask.at(x * view.mask.width() / out.width(), y * view.mask.height() / out.height()))
        out.at(x, y) = {colour[0], colour[1], colour[2], 255};
  return card_of(view, std::move(out));
}

std::vector<ViewCard> picture_cards(Session& session, const CutRequest& request, const CutSettings& settings,
                                    const CutResult& result, const Rgb8& colour, const Job& job) {
  const GaussianCloud& cloud = *session.scene().cloud;
  std::vector<ViewCard> cards;
  for (const ViewReport& view : result.views) {
    if (job.cancelled()) return cards;
    job.progress("pictures of the views",
                 static_cast<double>(cards.size()) / static_cast<double>(result.views.size()));
    cards.push_back(card_of(view, thumbnail(cloud, {view.camera, view.mask}, view.used, colour, job)));
  }
  if (!looked_around_by_none(result, request, settings)) return cards;
  for (const GivenView& view : session.look_around(request, result, settings, kViewsToLookFrom, job)) {
    if (job.cancelled()) return cards;
    const auto picture = std::make_shared<const Image<Rgba8>>(thumbnail(cloud, view, true, colour, job));
    cards.push_back({.camera = view.camera, .used = false, .picture = picture, .only_to_look = true});
  }
  return cards;
}

std::vector<ViewCard> in_places_of(const std::vector<ViewCard>& before, std::vector<ViewCard> cards) {
  constexpr float kSameDirection = 0.94f;  // cosine, 20 degrees: views around an object are farther apart
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

std::shared_ptr<const ClickMeanings> meanings_of(const CutRequest& request, const CutResult& result) {
  if (result.meanings.empty()) return nullptr;
  ClickMeanings out{.key = key_of_first_stroke(request),
                    .choice = request.choice,
                    .sizes = result.sizes,
                    .likeliest_size = result.likeliest_size,
                    .size = result.size,
                    .camera = {},
                    .outlines = {},
                    .size_outlines = {}};
  const auto first = std::ranges::find_if(request.strokes, marks_object);
  if (first != request.strokes.end()) out.camera = first->camera;
  const auto in_camera = [&](const Mask& mask) {
    Borders borders = outlines(mask);
    const float factor = static_cast<float>(out.camera.width_px) / static_cast<float>(mask.width());
    for (auto& border : borders)
      for (glm::vec2& point : border) point *= factor;
    return borders;
  };
  for (const Mask& mask : result.meanings) out.outlines.push_back(in_camera(mask));
  for (const Mask& mask : result.size_masks) out.size_outlines.push_back(in_camera(mask));
  return std::make_shared<const ClickMeanings>(std::move(out));
}

}  // namespace splatcut
