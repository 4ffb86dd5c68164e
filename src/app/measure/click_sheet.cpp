#include "app/measure/click_sheet.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/png_file.h"
#include "scene/raster/rasterizer.h"
#include "segment/masks/mask_tools.h"

namespace splatcut {

namespace {

constexpr Rgb8 kRight{60, 200, 90}, kMissing{230, 60, 50}, kTooMuch{60, 110, 240}, kRim{255, 255, 255};
constexpr float kTint = 0.5f;
constexpr float kClickRadiusPx = 5, kRimPx = 2;
constexpr int kGapPx = 4;

Rgb8 blended(const Rgb8& from, const Rgb8& to) {
  Rgb8 out;
  for (std::size_t c = 0; c < out.size(); ++c)
    out[c] = static_cast<std::uint8_t>((1 - kTint) * from[c] + kTint * to[c]);
  return out;
}

// truth: null where nobody knows it. All masks of the picture's size.
void tint(const Mask& shown, const Mask* truth, Image<Rgb8>* picture) {
  for (std::size_t i = 0; i < picture->size(); ++i) {
    const bool is = shown.pixels()[i], should = truth ? truth->pixels()[i] != 0 : is;
    if (!is && !should) continue;
    Rgb8& pixel = picture->pixels()[i];
    pixel = blended(pixel, is == should ? kRight : should ? kMissing : kTooMuch);
  }
}

void mark(const glm::vec2& at_px, SeedLabel label, Image<Rgb8>* picture) {
  for (int y = 0; y < picture->height(); ++y)
    for (int x = 0; x < picture->width(); ++x) {
      const float r =
          std::hypot(static_cast<float>(x) + 0.5f - at_px.x, static_cast<float>(y) + 0.5f - at_px.y);
      if (r > kClickRadiusPx + kRimPx) continue;
      picture->at(x, y) = r > kClickRadiusPx ? kRim : label == SeedLabel::kObject ? kRight : kMissing;
    }
}

void frame(const BoxPx& box, Image<Rgb8>* picture) {
  const BoxPx inner{box.low_px + kRimPx, box.high_px - kRimPx};
  for (int y = 0; y < picture->height(); ++y)
    for (int x = 0; x < picture->width(); ++x) {
      const glm::vec2 at = glm::vec2(x, y) + 0.5f;
      if (box.contains(at) && !inner.contains(at)) picture->at(x, y) = kRim;
    }
}

void mark(const Stroke& stroke, Image<Rgb8>* picture) {
  if (stroke.is_box()) return frame(box_in_picture(stroke, picture->width(), picture->height()), picture);
  mark(stroke.points_px.front(), stroke.label, picture);
}

void paste(const Image<Rgb8>& from, int x0, int y0, Image<Rgb8>* into) {
  for (int y = 0; y < from.height(); ++y)
    std::ranges::copy(from.row(y), into->row(y0 + y).subspan(static_cast<std::size_t>(x0)).begin());
}

struct SheetView {
  const Camera& camera;  // as clicked
  Image<Rgb8> picture;   // small
  Mask truth;            // small; empty where it is not known

  SheetView(const GaussianCloud& cloud, const AnyViewWorld& world, const Camera& clicked) : camera(clicked) {
    picture = rgb8_from_linear(rasterize(cloud, limited_to_width(clicked, kSheetViewWidthPx)).colour);
    for (const TruthView& view : world.views)
      if (same_camera(view.camera, clicked))
        truth = resized_mask(view.truth, picture.width(), picture.height());
  }
  Image<Rgb8> with(const AnyViewWorld& world, const std::vector<std::uint8_t>& labels) const {
    Image<Rgb8> out = picture;
    const Mask shown = resized_mask(world.picture(camera, labels), out.width(), out.height());
    tint(shown, truth.empty() ? nullptr : &truth, &out);
    return out;
  }
};

}  // namespace

Image<Rgb8> click_sheet(const GaussianCloud& cloud, const AnyViewWorld& world, const AnyViewSession& session,
                        const Job& job) {
  std::vector<std::pair<Image<Rgb8>, Image<Rgb8>>> columns;
  std::vector<std::uint8_t> labels(cloud.size());
  int width = kGapPx, height = 0;
  for (std::size_t i = 0; i < session.clicks.size() && !job.cancelled(); ++i) {
    const ViewClick& click = session.clicks[i];
    const SheetView view(cloud, world, click.camera);
    Image<Rgb8> before = view.with(world, labels);
    const float scale = static_cast<float>(before.width()) / static_cast<float>(click.camera.width_px);
    mark(scaled({click.stroke}, scale).front(), &before);
    labels = world.cut(std::span(session.clicks).first(i + 1), session.choice, job).labels;
    if (job.cancelled()) break;
    columns.emplace_back(std::move(before), view.with(world, labels));
    width += view.picture.width() + kGapPx;
    height = std::max(height, view.picture.height());
  }
  Image<Rgb8> sheet(width, 2 * height + 3 * kGapPx);
  int x = kGapPx;
  for (const auto& [before, after] : columns) {
    paste(before, x, kGapPx, &sheet);
    paste(after, x, height + 2 * kGapPx, &sheet);
    x += before.width() + kGapPx;
  }
  return sheet;
}

}  // namespace splatcut
