#include "app/measure/evaluate_alone.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "app/measure/evaluate_picture.h"
#include "app/measure/mask_measures.h"
#include "core/error.h"
#include "core/picture_difference.h"
#include "core/png_file.h"
#include "core/stage_clock.h"
#include "scene/raster/rasterizer.h"
#include "segment/masks/mask_tools.h"

namespace splatcut {

namespace {

constexpr int kBorderPx = 2;
const glm::vec3 kBlack(0), kMagenta(1, 0, 1);

// Colours are multiplied by alpha.
struct Matte {
  Image<float> alpha;
  Image<glm::vec3> colour;
};

Matte drawn_alone(const GaussianCloud& cloud, const Camera& camera,
                  std::span<const std::uint8_t> shown = {}) {
  RasterOptions options;
  options.shown = shown;
  RasterOutput out = rasterize(cloud, camera, options);
  return {std::move(out.alpha), std::move(out.colour)};
}

Matte true_matte(const EvaluationCase& scene, std::size_t view) {
  const Camera& camera = scene.test_views[view];
  if (!scene.truth_labels.empty())
    return drawn_alone(*scene.cloud, camera,
                       scene.own_labels.empty() ? scene.truth_labels : scene.own_labels);
  Matte matte = drawn_alone(*scene.cloud, camera);
  for (std::size_t i = 0; i < matte.alpha.size(); ++i) {
    const bool inside = scene.truth_masks[view].pixels()[i] != 0;
    if (!inside) matte.colour.pixels()[i] = glm::vec3(0);
    matte.alpha.pixels()[i] = inside ? 1.0f : 0.0f;
  }
  return matte;
}

Image<Rgb8> over(const Matte& matte, const glm::vec3& background, const PixelRect& box) {
  Image<glm::vec3> picture(box.width(), box.height());
  for (int y = box.y0; y < box.y1; ++y)
    for (int x = box.x0; x < box.x1; ++x)
      picture.at(x - box.x0, y - box.y0) = matte.colour.at(x, y) + (1 - matte.alpha.at(x, y)) * background;
  return rgb8_from_linear(picture);
}

double psnr_db(const Image<Rgb8>& a, const Image<Rgb8>& b) {
  return std::min(picture_difference(a, b).psnr_db, kEqualPicturesDb);
}

Mask solid_pixels(const Image<float>& alpha) {
  return thresholded(alpha, 0.5f);
}

AloneScore score_view(const Matte& truth, const Matte& object) {
  const Mask mask = solid_pixels(truth.alpha), seen = solid_pixels(object.alpha);
  const double diagonal = std::hypot(mask.width(), mask.height());
  AloneScore score;
  score.iou = iou(mask, seen);
  score.boundary_iou_2px = boundary_iou(mask, seen, kBorderPx);
  score.boundary_iou_2pct = boundary_iou(mask, seen, 0.02 * diagonal);
  const PixelRect box = bounds(mask);
  const Image<Rgb8> on_black = over(truth, kBlack, box), object_on_black = over(object, kBlack, box);
  score.psnr_black_db = psnr_db(on_black, object_on_black);
  score.ssim = picture_difference(on_black, object_on_black).ssim;
  score.psnr_magenta_db = psnr_db(over(truth, kMagenta, box), over(object, kMagenta, box));
  const Mask near = dilated(mask, kBorderPx), deep = eroded(mask, kBorderPx);
  const double share = 1 / static_cast<double>(count(mask));
  for (std::size_t i = 0; i < mask.size(); ++i) {
    const auto excess = static_cast<double>(object.alpha.pixels()[i] - truth.alpha.pixels()[i]);
    score.alpha_error += share * std::abs(excess);
    if (!near.pixels()[i]) score.halo += share * std::max(0.0, excess);
    if (deep.pixels()[i]) score.missing += share * std::max(0.0, -excess);
  }
  return score;
}

// Of the luma, levels of 255 a pixel; by differences of neighbours on both sides.
double gradient(const Image<glm::vec3>& picture, int x, int y) {
  const auto luma = [&](int px, int py) {
    const glm::vec3& c =
        picture.at(std::clamp(px, 0, picture.width() - 1), std::clamp(py, 0, picture.height() - 1));
    return static_cast<double>(0.299f * c.r + 0.587f * c.g + 0.114f * c.b);
  };
  return 255 * 0.5 * std::hypot(luma(x + 1, y) - luma(x - 1, y), luma(x, y + 1) - luma(x, y - 1));
}

RestScore score_rest_view(const Mask& mask, const Image<glm::vec3>& scene, const Image<glm::vec3>& rest) {
  constexpr int kRingPx = 12;
  const Mask near = dilated(mask, kBorderPx), ring = dilated(mask, kRingPx), inner = eroded(mask, 1);
  double squares = 0, gradients = 0;
  std::size_t ring_px = 0, border_px = 0;
  for (int y = 0; y < mask.height(); ++y)
    for (int x = 0; x < mask.width(); ++x) {
      if (ring.at(x, y) && !near.at(x, y)) {
        const glm::vec3 d = glm::clamp(scene.at(x, y), 0.0f, 1.0f) - glm::clamp(rest.at(x, y), 0.0f, 1.0f);
        squares += static_cast<double>(glm::dot(d, d)) / 3;
        ++ring_px;
      }
      if (!mask.at(x, y) || inner.at(x, y)) continue;
      gradients += gradient(rest, x, y);
      ++border_px;
    }
  const double error = ring_px ? squares / static_cast<double>(ring_px) : 0;
  return {error > 0 ? std::min(-10 * std::log10(error), kEqualPicturesDb) : kEqualPicturesDb,
          border_px ? gradients / static_cast<double>(border_px) : 0};
}

// The mean of `of` over the test views that count.
template <class Score, class Of>
Score mean_over_views(const EvaluationCase& scene, const Of& of) {
  const auto views = std::ranges::count_if(scene.truth_masks, counts);
  if (views == 0) throw Error(scene.name, "the truth shows in none of its test views");
  Score mean;
  for (std::size_t v = 0; v < scene.test_views.size(); ++v)
    if (counts(scene.truth_masks[v])) add_share(of(v), 1 / static_cast<double>(views), &mean);
  return mean;
}

}  // namespace

AloneScore score_alone(const EvaluationCase& scene, const GaussianCloud& object) {
  return mean_over_views<AloneScore>(scene, [&](std::size_t v) {
    return score_view(true_matte(scene, v), drawn_alone(object, scene.test_views[v]));
  });
}

EvaluationCase in_ring(const EvaluationCase& scene) {
  constexpr int kCameras = 12, kWidthPx = 320;
  constexpr float kFovYDeg = 40, kElevationDeg = 22.5f, kDistance = 3.2f;  // of the latter, radii
  const ObjectExtent object = object_extent(*scene.cloud, scene.truth_labels);
  const glm::vec3 up = glm::normalize(scene.up_world),
                  axis = std::abs(up.x) < 0.6f ? glm::vec3(1, 0, 0) : glm::vec3(0, 0, 1),
                  ahead = glm::normalize(axis - glm::dot(axis, up) * up), aside = glm::cross(up, ahead);
  EvaluationCase ring = scene;
  ring.test_views.clear();
  ring.truth_masks.clear();
  for (int c = 0; c < kCameras; ++c) {
    const float turn = glm::two_pi<float>() * (static_cast<float>(c) + 0.5f) / kCameras;
    const glm::vec3 level = std::cos(turn) * ahead + std::sin(turn) * aside;
    const glm::vec3 away =
        std::cos(glm::radians(kElevationDeg)) * level + std::sin(glm::radians(kElevationDeg)) * up;
    ring.test_views.push_back(look_at(object.centre_world + kDistance * object.radius * away,
                                      object.centre_world, up, glm::radians(kFovYDeg), kWidthPx, kWidthPx));
    ring.truth_masks.push_back(solid_pixels(true_matte(ring, ring.test_views.size() - 1).alpha));
  }
  return ring;
}

RestScore score_rest(const EvaluationCase& scene, const GaussianCloud& rest) {
  return mean_over_views<RestScore>(scene, [&](std::size_t v) {
    const Camera& camera = scene.test_views[v];
    return score_rest_view(scene.truth_masks[v], rasterize(*scene.cloud, camera).colour,
                           rasterize(rest, camera).colour);
  });
}

CutoutScore score_cutout(const EvaluationCase& scene, const std::vector<std::uint8_t>& labels,
                         const Job& job) {
  CutoutScore score;
  std::vector<std::uint8_t> rest(labels.size());
  std::ranges::transform(labels, rest.begin(), [](std::uint8_t l) { return l == 0 ? 1 : 0; });
  score.kept = score_alone(scene, rest_of(*scene.cloud, labels, {}));
  score.rest = score_rest(scene, rest_of(*scene.cloud, rest, {}));
  const auto start = std::chrono::steady_clock::now();
  const CleanObject clean =
      clean_object({*scene.cloud, labels, scene.up_world, scene.scene_cameras, true}, {}, job);
  score.clean_ms = ms_since(start);
  if (job.cancelled()) return score;
  score.clean = score_alone(scene, clean.cloud);
  if (!scene.truth_labels.empty()) {
    const EvaluationCase ring = in_ring(scene);
    score.kept_ring = score_alone(ring, rest_of(*scene.cloud, labels, {}));
    score.clean_ring = score_alone(ring, clean.cloud);
  }
  score.clean_rest = score_rest(scene, rest_of(*scene.cloud, rest, clean.rest));
  score.cleaned = clean.report.cleaned ? 1 : 0;
  score.report = clean.report;
  score.ghosts = clean.rest.ghosts.size();
  score.given_back = clean.rest.given_back.size();
  return score;
}

void add_share(const AloneScore& more, double share, AloneScore* to) {
  for (const auto field : {&AloneScore::iou, &AloneScore::boundary_iou_2px, &AloneScore::boundary_iou_2pct,
                           &AloneScore::psnr_black_db, &AloneScore::psnr_magenta_db, &AloneScore::ssim,
                           &AloneScore::halo, &AloneScore::missing, &AloneScore::alpha_error})
    to->*field += share * more.*field;
}

void add_share(const RestScore& more, double share, RestScore* to) {
  for (const auto field : {&RestScore::ring_psnr_db, &RestScore::ghost_gradient})
    to->*field += share * more.*field;
}

void add_share(const CutoutScore& more, double share, CutoutScore* to) {
  add_share(more.kept, share, &to->kept);
  add_share(more.clean, share, &to->clean);
  for (const auto field : {&CutoutScore::kept_ring, &CutoutScore::clean_ring})
    if (more.*field) {
      if (!(to->*field)) (to->*field).emplace();
      add_share(*(more.*field), share, &*(to->*field));
    }
  add_share(more.rest, share, &to->rest);
  add_share(more.clean_rest, share, &to->clean_rest);
  to->cleaned += share * more.cleaned;
  to->clean_ms += share * more.clean_ms;
  to->report = more.report;
  to->ghosts = more.ghosts;
  to->given_back = more.given_back;
}

}  // namespace splatcut
