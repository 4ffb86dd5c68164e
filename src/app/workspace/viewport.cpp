#include "app/workspace/viewport.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/document/words.h"
#include "scene/cloud/strays.h"
#include "segment/session/doubts.h"

namespace splatcut {

namespace {

constexpr double kStillAfterSeconds = 0.15;  // without a move the picture is drawn in full
constexpr double kMovingGoalMs = 32;         // a reduced picture should take no longer
constexpr float kLeastScale = 0.2f;

// Scales in steps of 5 %: the same size again and again costs no new textures.
float stepped(float scale) {
  return std::clamp(std::round(scale * 20) / 20, kLeastScale, 1.0f);
}

int scaled(int pixels, float scale) {
  return std::max(1, static_cast<int>(std::lround(scale * static_cast<float>(pixels))));
}

}  // namespace

Viewport::Viewport(Workspace& workspace, const CutJobs& cuts)
    : ws_(workspace),
      cuts_(cuts),
      style_labels_(std::make_shared<LabelCache>()),
      frames_(workspace.options.wake) {}

void Viewport::set_size(int width_px, int height_px, float pixels_per_point) {
  width_px_ = std::max(1, width_px);
  height_px_ = std::max(1, height_px);
  pixels_per_point_ = pixels_per_point;
}

void Viewport::change_scene() {
  ws_.quick.cancel(TaskKind::kStyle);
  style_labels_ = std::make_shared<LabelCache>();
  styles_ = {};
  styled_document_ = 0;
  styles_on_the_way_ = floaters_shown_ = false;
  range_shown_.reset();
  picture_.reset();
  stroke_marks_.forget();
  within_.reset();
  limits_changed_s_.reset();
  camera_.change_scene(ws_.scene->bounds);
}

void Viewport::reset() {
  change_scene();
  camera_.reset(ws_.scene->bounds, ws_.document().up_world);
  const FileViews& views = ws_.scene->views();
  if (!views.cameras.empty() || views.first_view) camera_.go_to_standing(views.reference);
  camera_.finish_transition();
  camera_.keep_opening(ws_.scene->views().up_world);
}

void Viewport::show_all_of_scene() {
  camera_.frame_scene();
  camera_.finish_transition();
  camera_.keep_opening(ws_.scene->views().up_world);
}

bool Viewport::moving() const {
  return ws_.clock_s - last_move_s_ <= kStillAfterSeconds;
}

bool Viewport::idle() const {
  return frames_.idle() && !limits_changed_s_ &&
         (!ws_.scene || (style_current() && picture_ && picture_->full && requested_full_ &&
                         requested_style_ == style_serial_ && !moving()));
}

bool Viewport::update(double seconds, const Flight& flight) {
  camera_.set_near_plane(draw_limits().near_plane);
  const CameraPose before = camera_.pose();
  const bool flies = ws_.scene && flight.moving();
  constexpr double kLongestStep = 0.1;
  if (flies) camera_.fly(flight, static_cast<float>(std::min(seconds, kLongestStep)));
  const bool travels = camera_.advance(static_cast<float>(seconds));
  const CameraPose& after = camera_.pose();
  const bool moved = before.position_world != after.position_world ||
                     before.camera_from_world != after.camera_from_world ||
                     before.fov_y_rad != after.fov_y_rad;
  const Camera camera = pane_camera();
  const bool differs = requested_camera_ &&
                       !same_camera(resized(*requested_camera_, camera.width_px, camera.height_px), camera);
  if (moved) ws_.tools.leave_last_click();
  if (flies || travels || moved || (differs && ws_.tools.moves_camera())) last_move_s_ = ws_.clock_s;
  request_styles();
  take_picture();  // first: no picture is shown in the frame that asked for it
  request_picture();
  refresh_marks();
  return flies || travels;
}

Camera Viewport::pane_camera() const {
  Camera camera = camera_.camera(std::max(1, width_px_ / panes()), std::max(1, height_px_));
  // Half a viewport shows as much from left to right as the whole.
  camera.fx_px /= static_cast<float>(panes());
  camera.fy_px /= static_cast<float>(panes());
  return camera;
}

// A drag belongs to the pane in which it began.
int Viewport::pane_at(const glm::vec2& pixel) const {
  if (panes() == 1) return 0;
  if (ws_.tools.dragging()) return pressed_pane_;
  return pixel.x >= 0.5f * static_cast<float>(width_px_) ? 1 : 0;
}

glm::vec2 Viewport::in_pane(const glm::vec2& pixel) const {
  return pixel - glm::vec2(0.5f * static_cast<float>(width_px_ * pane_at(pixel)), 0);
}

std::vector<glm::vec3> Viewport::object_points() const {
  const ObjectItem* object = ws_.document().active_object();
  if (!object) return {};
  return shown_points(*ws_.scene->cloud, *ws_.labels.labels(ws_.document(), *object, ws_.gaussians()));
}

void Viewport::turn_about_object() {
  if (const std::vector<glm::vec3> points = object_points(); !points.empty())
    camera_.set_orbit_centre(robust_bounds(points).centre());
}

bool Viewport::shows_all_of_object() {
  if (!style_current() || !active_labels() || hides_chosen(ws_.view, ws_.document().active)) return false;
  const std::shared_ptr<const Frame> frame = full_picture_of(pane_camera());
  if (!frame) return false;
  if (whole_shown_.picture.lock() == frame && whole_shown_.labels == active_labels())
    return whole_shown_.whole;
  Mask mask(frame->first_hit.width(), frame->first_hit.height());
  std::ranges::transform(frame->first_hit.pixels(), mask.pixels().begin(), [&](std::int32_t g) {
    return g >= 0 && (*active_labels())[static_cast<std::size_t>(g)] ? kMaskObject : std::uint8_t{0};
  });
  whole_shown_ = {frame, active_labels(), shows_whole(mask)};
  return whole_shown_.whole;
}

DrawLimits Viewport::draw_limits() const {
  DrawLimits limits;
  if (ws_.scene) limits.near_plane = ws_.scene->cloud->near_plane * (ws_.view.near_share / kNaturalNearShare);
  if (ws_.view.far_share > 0) limits.far_plane = ws_.view.far_share * camera_.scene_size();
  if (ws_.view.web_low_pass) limits.low_pass_px2 = kWebLowPassPx2;
  return limits;
}

Flags Viewport::seen(int pane) const {
  return within_limits(pane_camera(), shown(pane));
}

// The dots of an object's clicks ask for the same camera one after another, and each pass is over all
// Gaussians.
Flags Viewport::within_limits(const Camera& camera, const Flags& visible) const {
  const std::shared_ptr<const GaussianCloud>& cloud = ws_.scene->cloud;
  const float far_plane = draw_limits().far_plane;
  const bool known = within_ && within_->cloud.lock() == cloud && within_->visible == visible &&
                     within_->far_plane == far_plane && same_camera(within_->camera, camera);
  if (!known)
    within_ =
        WithinLimits{cloud, camera, far_plane, visible, within_far_plane(*cloud, camera, visible, far_plane)};
  return within_->within;
}

void Viewport::show_floaters(bool shown) {
  floaters_shown_ = say_floaters_ = shown;
  ++ws_.view_serial;
}

void Viewport::show_range(const std::optional<SelectRangeOrColour>& range) {
  range_shown_ = range;
  ++ws_.view_serial;
}

void Viewport::show_placed(std::uint32_t file) {
  placed_file_ = file;
  placed_serial_ = ws_.history.serial();
}

bool Viewport::placing() const {
  if (!ws_.scene || !ws_.scene->file(placed_file_)) return false;
  const History& history = ws_.history;
  return placed_serial_ == history.serial() || history.entries()[history.cursor()].other_files != 0 ||
         ws_.gaussians_of(ws_.document().active) == 0;
}

void Viewport::highlight(const Flags& gaussians, const Rgb8& colour) {
  FrameStyle& style = styles_.style[0];
  const bool same =
      style.highlight && gaussians ? *style.highlight == *gaussians : style.highlight == gaussians;
  if (same && style.highlight_colour == colour) return;
  style.highlight = gaussians;
  style.highlight_colour = colour;
  ++style_serial_;
}

bool Viewport::style_current() const {
  return !styles_on_the_way_ && styled_document_ == ws_.history.serial() && styled_view_ == ws_.view_serial;
}

StyleOrder Viewport::style_order() const {
  StyleOrder order{ws_.scene->cloud, ws_.graph,    ws_.document(), {},
                   nullptr,          ws_.clean,    ws_.view,       pixels_per_point_,
                   floaters_shown_,  range_shown_, pane_camera(),  ws_.seen};
  for (const ObjectItem& object : order.document.objects)
    if (const CutRun* run = cuts_.run(object.id)) {
      if (run->preview) order.previews[object.id] = run->preview;
      if (object.id == order.document.active) order.likelihood = run->likelihood;
    }
  return order;
}

// The next order waits for the one before: were it to replace it, a document that changes with every frame
// would never be shown.
void Viewport::request_styles() {
  if (!ws_.scene || style_current() || styles_on_the_way_) return;
  styled_document_ = ws_.history.serial();
  styled_view_ = ws_.view_serial;
  styles_on_the_way_ = true;
  const auto failed = [this] { styles_on_the_way_ = false; };
  ws_.quick.submit({TaskKind::kStyle, failed}, [this, order = style_order(), before = styles_,
                                                labels = style_labels_, scene = ws_.scene](const Job& job) {
    ws_.quick.post([this, scene, sought = order.floaters, styles = styled(order, before, labels.get(), job)] {
      if (scene != ws_.scene) return;
      styles_on_the_way_ = false;
      styles_ = styles;
      ++style_serial_;
      if (!floaters_shown_ || !sought) return;
      if (std::exchange(say_floaters_, false))
        ws_.say(Message::Kind::kInfo,
                styles.floaters ? fmt::format("{} Gaussians float apart from the object, shown in white",
                                              grouped(styles.floaters))
                                : "Nothing floats apart from the object");
      if (styles.floaters == 0) show_floaters(false);
    });
  });
}

void Viewport::request_picture() {
  if (!ws_.scene || width_px_ == 0 || styles_.panes == 0) return;
  const Camera full_camera = pane_camera();
  const bool still = !moving();
  if (gpu_view_ && !still) return;
  const float scale = still ? 1.0f : moving_scale_;
  const Camera camera = scale == 1.0f ? full_camera
                                      : resized(full_camera, scaled(full_camera.width_px, scale),
                                                scaled(full_camera.height_px, scale));
  const bool same = requested_camera_ && same_camera(*requested_camera_, camera) &&
                    requested_full_ == still && requested_style_ == style_serial_;
  if (same) return;
  requested_camera_ = camera;
  requested_full_ = still;
  requested_style_ = style_serial_;
  FrameRequest request{
      ws_.scene->serial, ws_.scene->cloud, ws_.scene->blocks, ws_.coarse, {}, draw_limits(), still};
  for (int pane = 0; pane < panes(); ++pane) {
    request.panes.push_back({camera, shown(pane), style(pane), clean(pane)});
    request.panes.back().style.checker_px *= scale;  // on the screen it stays as large
  }
  frames_.request(std::move(request));
}

void Viewport::take_picture() {
  auto result = frames_.take();
  if (!result || !ws_.scene || result->scene != ws_.scene->serial) return;
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

std::shared_ptr<const Frame> Viewport::full_picture_of(const Camera& camera, int pane) const {
  if (!picture_ || !picture_->full || picture_->limits != draw_limits()) return nullptr;
  const auto index = static_cast<std::size_t>(pane);
  if (index >= picture_->frames.size() || picture_->shown[index] != shown(pane)) return nullptr;
  const std::shared_ptr<const Frame>& frame = picture_->frames[index];
  return same_camera(frame->camera, camera) ? frame : nullptr;
}

std::optional<PickedPoint> Viewport::pick(const glm::vec2& pixel) const {
  if (!ws_.scene) return {};
  const Camera camera = pane_camera();
  const auto x = static_cast<int>(std::floor(pixel.x)), y = static_cast<int>(std::floor(pixel.y));
  if (x < 0 || y < 0 || x >= camera.width_px || y >= camera.height_px) return {};
  const std::shared_ptr<const Frame> frame = full_picture_of(camera, pressed_pane());
  if (!frame) return hit_in(camera, pixel, shown(pressed_pane()));
  if (frame->first_hit.at(x, y) < 0) {
    const bool invented = ws_.view.display == DisplayMode::kHide && clean(pressed_pane());
    return invented ? hit_in(camera, pixel, shown(pressed_pane())) : std::nullopt;  // what lies below it
  }
  return PickedPoint{camera.world_from_pixel(pixel, frame->depth.at(x, y)), frame->first_hit.at(x, y)};
}

std::optional<glm::vec3> Viewport::surface_in_middle(std::uint32_t without_file) const {
  if (!ws_.scene) return {};
  const Camera camera = pane_camera();
  Flags visible = shown(pressed_pane());
  if (without_file != 0) {
    std::vector<std::uint8_t> others(ws_.gaussians(), 1);
    if (visible) others = *visible;
    const std::vector<std::uint8_t> own = gaussians_of(*ws_.scene, without_file);
    for (std::size_t g = 0; g < others.size(); ++g) others[g] = others[g] && !own[g];
    visible = make_flags(std::move(others));
  }
  const auto hit = hit_in(camera, 0.5f * glm::vec2(camera.width_px, camera.height_px), visible);
  return hit ? std::optional(hit->position_world) : std::nullopt;
}

glm::vec3 Viewport::looked_at_world() const {
  return surface_in_middle().value_or(camera_.pivot_world());
}

std::optional<PickedPoint> Viewport::hit_in(const Camera& camera, const glm::vec2& pixel,
                                            const Flags& visible) const {
  const glm::vec2 size(camera.width_px, camera.height_px);
  if (!(pixel.x >= 0 && pixel.y >= 0 && pixel.x < size.x && pixel.y < size.y)) return {};
  const auto x = static_cast<int>(std::floor(pixel.x)), y = static_cast<int>(std::floor(pixel.y));
  const RasterOutput out = drawn(camera, {x, y, x + 1, y + 1}, visible);
  if (out.first_hit.at(0, 0) < 0) return {};
  return PickedPoint{camera.world_from_pixel(pixel, out.median_depth.at(0, 0)), out.first_hit.at(0, 0)};
}

std::vector<std::int32_t> Viewport::hit_by(const CameraStroke& s) const {
  const bool is_dot = !s.stroke.points_px.empty() && !s.stroke.is_box();
  if (!is_dot || !same_camera(s.camera, pane_camera()) || !same_set(s.seen, seen(pressed_pane())))
    return hits_of(s, drawn_part());
  const auto hit = pick(s.stroke.points_px.front());
  return hit ? std::vector{hit->gaussian} : std::vector<std::int32_t>();
}

DrawnPart Viewport::drawn_part() const {
  return [this](const Camera& camera, const PixelRect& part, const Flags& visible) {
    return drawn(camera, part, visible);
  };
}

RasterOutput Viewport::drawn(const Camera& camera, const PixelRect& part, const Flags& visible_set) const {
  const DrawLimits limits = draw_limits();
  RasterOptions options;
  options.colour = false;
  options.depth = true;
  options.near_plane = limits.near_plane;
  options.low_pass_px2 = limits.low_pass_px2;
  options.roi = part;
  options.blocks = ws_.scene->blocks.get();
  const Flags visible = within_limits(camera, visible_set);
  if (visible) options.shown = *visible;
  return rasterize(*ws_.scene->cloud, camera, options);
}

std::optional<float> Viewport::depth_on_screen(const glm::vec2& pixel, int pane) const {
  if (!picture_ || picture_->frames.empty() || picture_->scene != ws_.scene->serial) return {};
  const Frame& frame =
      *picture_->frames[std::min(static_cast<std::size_t>(pane), picture_->frames.size() - 1)];
  const Image<float>& depth = frame.depth;
  const Camera camera = pane_camera();
  const glm::vec2 at = pixel / glm::vec2(camera.width_px, camera.height_px);
  const auto x = static_cast<int>(at.x * static_cast<float>(depth.width())),
             y = static_cast<int>(at.y * static_cast<float>(depth.height()));
  if (at.x < 0 || at.y < 0 || !depth.contains(x, y) || !(depth.at(x, y) > 0)) return {};
  const glm::vec3 point_world =
      frame.camera.world_from_pixel(at * glm::vec2(depth.width(), depth.height()), depth.at(x, y));
  const float z = camera.camera_from_world(point_world).z;
  return z > 0 ? std::optional(z) : std::nullopt;
}

ToolContext Viewport::tool_context(int pane) {
  return {camera_,
          ws_.view,
          pane_camera(),
          pixels_per_point_,
          [this](const glm::vec2& at) { return pick(at); },
          [this, pane](const glm::vec2& at) { return depth_on_screen(at, pane); },
          [this, pane] { return seen(pane); },
          [this](const glm::vec2& at, SeedLabel label) -> std::optional<RemoveStroke> {
            const StrokeMark* mark = mark_at(at);
            if (!mark || mark->object == (label == SeedLabel::kObject)) return {};
            return RemoveStroke{mark->view, mark->stroke, mark->made_px};
          }};
}

void Viewport::refresh_marks() {
  marks_.clear();
  const ObjectItem* object = ws_.scene ? ws_.document().active_object() : nullptr;
  if (!object || hides_chosen(ws_.view, object->id)) {  // dots stand on its surface
    if (std::exchange(limits_changed_s_, std::nullopt)) stroke_marks_.forget();
    return;
  }
  const auto hit = [this](const Camera& camera, const glm::vec2& pixel, const Flags& visible) {
    return hit_in(camera, pixel, visible);
  };
  // While the far limit is dragged the dots stay where they are known to be.
  if (std::exchange(marked_within_, draw_limits()) != draw_limits()) limits_changed_s_ = ws_.clock_s;
  if (limits_changed_s_ && ws_.clock_s - *limits_changed_s_ > kStillAfterSeconds) {
    stroke_marks_.forget();
    limits_changed_s_.reset();
  }
  marks_ = stroke_marks_.in(*object, pane_camera(), {hit, [this](const glm::vec3& at) { return hides(at); }});
}

bool Viewport::hides(const glm::vec3& point_world) const {
  constexpr float kBefore = 0.985f;  // of its depth: what is nearer hides it, the noise of depth does not
  if (!picture_ || picture_->frames.empty() || picture_->scene != ws_.scene->serial) return false;
  const Frame& frame = *picture_->frames.front();
  const glm::vec3 there = frame.camera.camera_from_world(point_world);
  if (!(there.z > 0)) return false;
  const glm::vec2 at = glm::floor(frame.camera.pixel_from_camera(there));
  const glm::vec2 size(frame.depth.width(), frame.depth.height());
  if (!(at.x >= 0 && at.y >= 0 && at.x < size.x && at.y < size.y)) return false;
  const float depth = frame.depth.at(static_cast<int>(at.x), static_cast<int>(at.y));
  return depth > 0 && depth < kBefore * there.z;
}

}  // namespace splatcut
