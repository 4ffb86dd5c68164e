#include "segment/selection/stroke_replay.h"

#include <algorithm>

#include "segment/masks/mask_tools.h"
#include "segment/selection/wide_view.h"

namespace splatcut {

namespace {

constexpr std::size_t kMostKept = 6;  // selections, for undo: 3 bytes a Gaussian each, and masks

bool same_stroke(const CameraStroke& a, const CameraStroke& b) {
  return same_camera(a.camera, b.camera) && same_set(a.seen, b.seen) && a.stroke.kind == b.stroke.kind &&
         a.stroke.label == b.stroke.label && a.stroke.radius_px == b.stroke.radius_px &&
         a.stroke.points_px == b.stroke.points_px && a.stroke.size_step == b.stroke.size_step &&
         a.earlier == b.earlier;
}

// The stroke in a view that shows so much more.
CameraStroke with_margins(const CameraStroke& said, const Margins& margins) {
  CameraStroke wide = said;
  wide.camera = with_margins(said.camera, margins);
  for (glm::vec2& point : wide.stroke.points_px) point += glm::vec2(margins.left_px, margins.top_px);
  return wide;
}

// Greatest width of the rasterised view: details of the picture itself shall not get lost.
int work_width(int work_width_px, const Camera& picture, const Camera& wide) {
  constexpr float kMostFiner = 2;
  const float wider = std::max(static_cast<float>(wide.width_px) / static_cast<float>(picture.width_px),
                               static_cast<float>(wide.height_px) / static_cast<float>(picture.height_px));
  return static_cast<int>(std::min(kMostFiner, wider) * static_cast<float>(work_width_px));
}

// Where the picture lies in a mask of the wider view.
PixelRect picture_in(const Mask& mask, const Camera& picture, const Camera& wide, const Margins& margins) {
  const auto x = [&](int px) { return px * mask.width() / wide.width_px; };
  const auto y = [&](int px) { return px * mask.height() / wide.height_px; };
  const int x0 = x(margins.left_px), y0 = y(margins.top_px);
  return {x0, y0, x0 + std::max(1, x(picture.width_px)), y0 + std::max(1, y(picture.height_px))};
}

}  // namespace

std::vector<CameraStroke> in_replay_order(std::span<const CameraStroke> strokes) {
  std::vector<CameraStroke> order(strokes.begin(), strokes.end());
  const auto first =
      std::ranges::find(order, SeedLabel::kObject, [](const CameraStroke& s) { return s.stroke.label; });
  if (first == order.end()) return order;
  for (auto s = order.begin(); s != first; ++s) s->earlier = true;
  std::rotate(order.begin(), first, first + 1);
  return order;
}

std::size_t StrokeReplay::view_bytes() const {
  std::size_t bytes = 0;
  for (const KnownView& known : views_) bytes += known.view.bytes() + known.box.leaves.size();
  return bytes;
}

std::size_t StrokeReplay::bytes() const {
  std::size_t bytes = view_bytes();
  for (const auto& selection : after_) bytes += selection ? selection->bytes() : 0;
  return bytes;
}

void StrokeReplay::forget() {
  views_.clear();
  done_.clear();
  after_.clear();
  last_.reset();
}

StrokeReplay::KnownView* StrokeReplay::view(const Drawer& drawer, const CameraStroke& said, int width_px,
                                            const Job& job) {
  const Camera camera = limited_to_width(said.camera, width_px);
  const auto known = std::ranges::find_if(views_, [&](const KnownView& v) {
    return same_picture(v.view.camera, camera) && same_set(v.seen, said.seen);
  });
  if (known != views_.end()) {
    views_.splice(views_.begin(), views_, known);
    return &views_.front();
  }
  LeafView made = leaf_view(drawer, parts_, camera, job, said.seen);
  if (job.cancelled()) return nullptr;  // it may be incomplete
  views_.push_front({std::move(made), said.seen});
  while (views_.size() > 1 && view_bytes() > most_bytes_) views_.pop_back();
  return &views_.front();
}

bool StrokeReplay::close_up(const LeafView& view, const glm::vec2& pixel) const {
  const glm::ivec2 at = glm::clamp(glm::ivec2(pixel), glm::ivec2(0),
                                   glm::ivec2(view.camera.width_px - 1, view.camera.height_px - 1));
  const float depth = view.depth.at(at.x, at.y);
  return depth > 0 && is_close_up(usual_picture(view.camera, capture_,
                                                view.camera.world_from_pixel(glm::vec2(at) + 0.5f, depth)));
}

// What is small in the view is looked at with more pixels: by what is selected already, else by what the
// stroke selects. By its likeliest meaning in its own size, also where others are taken: other pixels would
// offer other meanings and sizes.
std::shared_ptr<ClickSelection> StrokeReplay::after_in_view(const Drawer& drawer,
                                                            const ClickSelection& before,
                                                            const CameraStroke& said, int work_width_px,
                                                            const Job& job) {
  const auto width_to_see_it = [&](const Mask& mask) {
    return width_to_see(mask, options_.least_object_px, said.camera.width_px);
  };
  const Camera camera = limited_to_width(said.camera, work_width_px);
  const Mask shown_before = before.any()
                                ? thresholded(render_labels(drawer, camera, before.labels(), job), 0.5f)
                                : Mask(camera.width_px, camera.height_px);
  int width_px = width_to_see_it(shown_before);
  const bool settled = count(shown_before) > 0;
  while (!job.cancelled()) {
    KnownView* known = view(drawer, said, width_px, job);
    if (!known) return nullptr;
    LeafView* seen = &known->view;
    const bool by_colour = !before.any() || (said.stroke.is_click() && said.stroke.label == SeedLabel::kRest);
    if (by_colour && seen->colour.empty()) {
      draw_colour(drawer, seen, job, said.seen);
      if (job.cancelled()) {
        seen->colour = {};  // it may be incomplete
        return nullptr;
      }
    }
    auto next = std::make_shared<ClickSelection>(before);
    const float factor = static_cast<float>(width_px) / static_cast<float>(said.camera.width_px);
    const Stroke stroke = scaled({said.stroke}, factor).front();
    FirstStroke first;
    if (!before.any() && stroke.is_box()) first.by_colour = known->box.of(parts_, *seen, stroke);
    if (!before.any()) first.close_up = close_up(*seen, stroke.points_px.front());
    next->apply(*seen, stroke, first);
    if (said.earlier) next->keep_sizes_of(before);
    if (settled || width_px > camera.width_px) return next;
    width_px = width_to_see_it(!before.any() && options_.choice != 0 && !next->meanings().empty()
                                   ? next->meanings().front()
                               : said.stroke.size_step != 0 && !next->size_masks().empty()
                                   ? next->size_masks()[next->likeliest_size()]
                                   : shown(seen->gaussians, seen->camera, next->labels()));
    if (width_px == camera.width_px) return next;
  }
  return nullptr;
}

std::shared_ptr<const ClickSelection> StrokeReplay::after(const Drawer& drawer, const ClickSelection& before,
                                                          const CameraStroke& said, const Job& job) {
  const int work_width_px = options_.work_width_px;
  const Margins margins = before.any() && said.stroke.is_click()
                              ? margins_of_correction(said.camera, drawer.cloud(), before.labels(), capture_)
                              : Margins{};
  if (!margins.any()) return after_in_view(drawer, before, said, work_width_px, job);
  const CameraStroke wide = with_margins(said, margins);
  auto next = after_in_view(drawer, before, wide, work_width(work_width_px, said.camera, wide.camera), job);
  if (next && !said.earlier && !next->size_masks().empty())
    next->crop_sizes(picture_in(next->size_masks().front(), said.camera, wide.camera, margins));
  return next;
}

const ClickSelection& StrokeReplay::replay(const Drawer& drawer, std::span<const CameraStroke> strokes,
                                           const ReplayOptions& options, const Job& job) {
  const std::vector<CameraStroke> order = in_replay_order(strokes);
  if (options != options_) {
    done_.clear();
    after_.clear();
    options_ = options;
  }
  std::size_t same = 0;
  while (same < std::min(order.size(), done_.size()) && same_stroke(order[same], done_[same])) ++same;
  if (same > 0 && !after_[same - 1]) same = 0;
  last_ =
      same > 0 ? after_[same - 1] : std::make_shared<ClickSelection>(parts_, options.model, options.choice);
  if (same == order.size()) return *last_;  // what was replayed after that stays known
  done_.resize(same);
  after_.resize(same);
  for (std::size_t i = same; i < order.size(); ++i) {
    auto next = after(drawer, *last_, order[i], job);
    if (!next) break;  // cancelled
    if (i + 1 == options.carried.strokes) {
      auto carried = std::make_shared<ClickSelection>(*next);
      carried->carry(*options.carried.labels);
      next = std::move(carried);
    }
    last_ = next;
    done_.push_back(order[i]);
    after_.push_back(std::move(next));
    if (after_.size() > kMostKept) after_[after_.size() - 1 - kMostKept].reset();
  }
  return *last_;
}

}  // namespace splatcut
