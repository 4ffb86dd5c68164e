// What is on the screen: styles, requests for pictures, the frame loop.
#include <algorithm>
#include <cmath>

#include "app/studio/studio.h"
#include "scene/raster/rasterizer.h"

namespace splatcut {

namespace {

constexpr double kStillAfterSeconds = 0.15;  // without a move the picture is drawn in full
constexpr double kMovingGoalMs = 32;         // a reduced picture should take no longer
constexpr float kLeastScale = 0.2f;
constexpr float kCheckerPoints = 12;

// Scales in steps of 5 %: the same size again and again costs no new textures.
float stepped(float scale) {
  return std::clamp(std::round(scale * 20) / 20, kLeastScale, 1.0f);
}

}  // namespace

void Studio::set_viewport(int width_px, int height_px, float pixels_per_point, float covered_bottom_px) {
  covered_bottom_px_ = covered_bottom_px;
  width_px_ = std::max(1, width_px);
  height_px_ = std::max(1, height_px);
  pixels_per_point_ = pixels_per_point;
}

DrawLimits Studio::draw_limits() const {
  DrawLimits limits;
  if (scene_) limits.near_plane = scene_->cloud->near_plane * (view_.near_share / kNaturalNearShare);
  if (view_.far_share > 0) limits.far_plane = view_.far_share * camera_.scene_size();
  if (view_.web_low_pass) limits.low_pass_px2 = kWebLowPassPx2;
  return limits;
}

Camera Studio::viewport_camera() const {
  Camera camera = camera_.camera(std::max(1, width_px_ / panes()), std::max(1, height_px_));
  // Half a viewport shows as much from left to right as the whole.
  camera.fx_px /= static_cast<float>(panes());
  camera.fy_px /= static_cast<float>(panes());
  return camera;
}

// A drag belongs to the pane in which it began.
int Studio::pane_at(const glm::vec2& pixel) const {
  if (panes() == 1) return 0;
  if (tools_.dragging()) return pressed_pane_;
  return pixel.x >= 0.5f * static_cast<float>(width_px_) ? 1 : 0;
}

glm::vec2 Studio::in_pane(const glm::vec2& pixel) const {
  return pixel - glm::vec2(0.5f * static_cast<float>(width_px_ * pane_at(pixel)), 0);
}

ToolContext Studio::tool_context(const glm::vec2& pixel) {
  const int pane = pane_at(pixel);
  return {camera_,
          view_,
          viewport_camera(),
          pixels_per_point_,
          [this](const glm::vec2& at) { return pick(at); },
          [this](const glm::vec2& at) { return depth_on_screen(at); },
          [this, pane] { return seen(pane); }};
}

ToolOverlay Studio::overlay() const {
  return tools_.overlay(view_, viewport_camera(), pixels_per_point_);
}

// From the last picture, of any size and camera: while the view moves it lags behind.
std::optional<float> Studio::depth_on_screen(const glm::vec2& pixel) const {
  if (!picture_ || picture_->frames.empty() || picture_->scene != scene_->serial) return {};
  const Frame& frame = *picture_->frames.front();
  const Image<float>& depth = frame.depth;
  const Camera camera = viewport_camera();
  const glm::vec2 at = pixel / glm::vec2(camera.width_px, camera.height_px);
  const auto x = static_cast<int>(at.x * static_cast<float>(depth.width())),
             y = static_cast<int>(at.y * static_cast<float>(depth.height()));
  if (at.x < 0 || at.y < 0 || !depth.contains(x, y) || !(depth.at(x, y) > 0)) return {};
  const glm::vec3 point_world =
      frame.camera.world_from_pixel(at * glm::vec2(depth.width(), depth.height()), depth.at(x, y));
  const float z = camera.camera_from_world(point_world).z;
  return z > 0 ? std::optional(z) : std::nullopt;
}

Flags Studio::seen(int pane) const {
  return within_far_plane(*scene_->cloud, viewport_camera(), shown(pane), draw_limits().far_plane);
}

std::optional<PickedPoint> Studio::pick(const glm::vec2& pixel) const {
  if (!scene_) return {};
  const Camera camera = viewport_camera();
  const auto x = static_cast<int>(std::floor(pixel.x)), y = static_cast<int>(std::floor(pixel.y));
  if (x < 0 || y < 0 || x >= camera.width_px || y >= camera.height_px) return {};
  // The picture on the screen knows, where it is this view; else one pixel is drawn.
  if (picture_ && !picture_->frames.empty() && picture_->limits == draw_limits()) {
    const Frame& frame = *picture_->frames.front();
    if (same_camera(frame.camera, camera)) {
      if (frame.first_hit.at(x, y) < 0) return {};
      return PickedPoint{camera.world_from_pixel(pixel, frame.depth.at(x, y)), frame.first_hit.at(x, y)};
    }
  }
  return hit_in(camera, pixel, shown(0));
}

std::optional<PickedPoint> Studio::hit_in(const Camera& camera, const glm::vec2& pixel,
                                          const Flags& visible_set) const {
  const glm::vec2 size(camera.width_px, camera.height_px);
  if (!(pixel.x >= 0 && pixel.y >= 0 && pixel.x < size.x && pixel.y < size.y)) return {};
  const auto x = static_cast<int>(std::floor(pixel.x)), y = static_cast<int>(std::floor(pixel.y));
  RasterOptions options;
  options.colour = false;
  options.depth = true;
  options.near_plane = draw_limits().near_plane;
  options.low_pass_px2 = draw_limits().low_pass_px2;
  options.roi = PixelRect{x, y, x + 1, y + 1};
  const Flags visible = within_far_plane(*scene_->cloud, camera, visible_set, draw_limits().far_plane);
  if (visible) options.shown = *visible;
  const RasterOutput out = rasterize(*scene_->cloud, camera, options);
  if (out.first_hit.at(0, 0) < 0) return {};
  return PickedPoint{camera.world_from_pixel(pixel, out.median_depth.at(0, 0)), out.first_hit.at(0, 0)};
}

Flags Studio::shown(int pane) const {
  return shown_[pane];
}

FrameStyle Studio::style(int pane) const {
  return style_[pane];
}

void Studio::refresh_style() {
  if (!scene_) return;
  if (style_serial_ == document_serial_ && styled_view_serial_ == view_serial_) return;
  style_serial_ = document_serial_;
  styled_view_serial_ = view_serial_;
  ++style_version_;
  hover_.reset();  // asked again
  const std::size_t n = scene_->cloud->size();
  const Document& document = this->document();
  std::vector<std::uint8_t> owner(n, 0), active(n, 0);
  FrameStyle style;
  style.background = document.background;
  style.checker_px = view_.checker ? std::round(kCheckerPoints * pixels_per_point_) : 0;
  style.tint = view_.tint;
  style.outline = view_.outline;
  bool any = false;
  for (std::size_t i = 0; i < document.objects.size(); ++i) {
    const ObjectItem& object = document.objects[i];
    const CutRun* run = cut_run(object.id);
    std::vector<std::uint8_t> own = run && run->preview ? *run->preview : labels_of(document, object, n);
    const auto number = static_cast<std::uint8_t>(i + 1);
    style.owner_colour[number] = object.colour;
    if (object.visible)
      for (std::size_t g = 0; g < n; ++g)
        if (own[g]) owner[g] = number;
    any |= object.visible;
    if (object.id == document.active) active = std::move(own);
  }
  if (any) style.owner = make_flags(std::move(owner));
  active_labels_ = make_flags(active);
  if (view_.heat)
    if (const CutRun* run = cut_run(document.active)) style.heat = run->likelihood;
  floater_count_ = 0;
  if (highlight_floaters_ && prepared_) {
    Selection found = floaters(*scene_->cloud, prepared_->graph, active);
    floater_count_ = count_flags(found);
    style.highlight = make_flags(std::move(found));
  }
  // What a pane shows: its Gaussians change the rasterised picture, so an equal set stays the same object.
  const auto visible_set = [&](DisplayMode mode) -> Flags {
    if (mode == DisplayMode::kWhole && !document.deleted) return nullptr;
    std::vector<std::uint8_t> set(n, 1);
    for (std::size_t g = 0; g < n; ++g) {
      if (mode == DisplayMode::kIsolate) set[g] = active[g];
      if (mode == DisplayMode::kHide) set[g] = !active[g];
      if (document.deleted && (*document.deleted)[g]) set[g] = 0;
    }
    return make_flags(std::move(set));
  };
  const auto keep_equal = [](Flags* old, Flags fresh) {
    const bool equal = *old && fresh ? **old == *fresh : *old == fresh;
    if (!equal) *old = std::move(fresh);
  };
  const bool two = view_.display == DisplayMode::kSideBySide;
  const bool alone = view_.display == DisplayMode::kIsolate;
  FrameStyle plain = style;
  plain.owner = nullptr;
  keep_equal(&shown_[0], visible_set(two ? DisplayMode::kWhole : view_.display));
  style_[0] = alone && !style.highlight ? plain : style;
  if (view_.heat && style.heat) style_[0].heat = style.heat;
  if (two) {
    keep_equal(&shown_[1], visible_set(DisplayMode::kIsolate));
    style_[1] = plain;
    style_[1].heat = nullptr;
  }
}

void Studio::request_picture() {
  if (!scene_ || width_px_ == 0) return;
  const Camera full_camera = viewport_camera();
  const bool still = !moving();
  if (gpu_view_ && !still) return;
  const float scale = still ? 1.0f : moving_scale_;
  const Camera camera =
      scale == 1.0f
          ? full_camera
          : resized(
                full_camera,
                std::max(1, static_cast<int>(std::lround(scale * static_cast<float>(full_camera.width_px)))),
                std::max(1,
                         static_cast<int>(std::lround(scale * static_cast<float>(full_camera.height_px)))));
  const bool same = requested_camera_ && same_camera(*requested_camera_, camera) &&
                    requested_full_ == still && requested_style_ == style_version_;
  if (same) return;
  requested_camera_ = camera;
  requested_full_ = still;
  requested_style_ = style_version_;
  FrameRequest request{scene_->serial, scene_->cloud, coarse_, {}, draw_limits(), still};
  for (int pane = 0; pane < panes(); ++pane) {
    request.panes.push_back({camera, shown_[pane], style_[pane]});
    request.panes.back().style.checker_px *= scale;  // on the screen it stays as large
  }
  frames_.request(std::move(request));
}

void Studio::take_picture() {
  auto result = frames_.take();
  if (!result || !scene_ || result->scene != scene_->serial) return;
  double raster_ms = 0;
  for (const auto& frame : result->frames) raster_ms += frame->raster_ms;
  if (result->full) {
    still_ms_ = raster_ms;
  } else {
    moving_ms_ = result->ms;
    // Half of a picture's cost goes with its pixels, the rest with the Gaussians.
    const double factor = std::clamp(kMovingGoalMs / std::max(1.0, result->ms), 0.5, 1.3);
    if (factor < 0.9 || factor > 1.15) moving_scale_ = stepped(moving_scale_ * static_cast<float>(factor));
  }
  picture_ = std::move(result);
  ++picture_serial_;
}

bool Studio::moving() const {
  return clock_s_ - last_move_s_ <= kStillAfterSeconds;
}

bool Studio::idle() const {
  return tasks_.idle() && frames_.idle() &&
         (!scene_ ||
          (picture_ && picture_->full && requested_full_ && requested_style_ == style_version_ && !moving()));
}

bool Studio::update(double seconds) {
  clock_s_ += seconds;
  tasks_.deliver();
  const CameraPose before = camera_.pose();
  const Flight flying = flight();
  const bool flies = scene_ && flying.moving();
  if (flies) camera_.fly(flying, static_cast<float>(std::min(seconds, 0.1)));
  const bool travels = camera_.advance(static_cast<float>(seconds));
  const CameraPose& after = camera_.pose();
  const bool moved = before.position_world != after.position_world ||
                     before.camera_from_world != after.camera_from_world ||
                     before.fov_y_rad != after.fov_y_rad;
  const bool camera_differs =
      requested_camera_ &&
      !same_camera(resized(*requested_camera_, viewport_camera().width_px, viewport_camera().height_px),
                   viewport_camera());
  if (flies || travels || moved || (camera_differs && tools_.moves_camera())) last_move_s_ = clock_s_;
  schedule_cut();
  request_likelihood();
  refresh_style();
  refresh_hover();
  request_picture();
  take_picture();
  autosave(seconds);
  return flies || travels || !idle() || sizes();
}

}  // namespace splatcut
