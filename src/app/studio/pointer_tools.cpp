#include "app/studio/pointer_tools.h"

#include <algorithm>
#include <cmath>

namespace splatcut {

namespace {

constexpr float kDragPoints = 4;        // less is a click
constexpr float kPathStepPoints = 2;    // points of a path are no closer
constexpr float kCloseClickPoints = 9;  // a click this near to the first corner closes the polygon
constexpr float kScaleLeavePoints = 12;

bool drags_navigate(Tool tool) {
  return tool == Tool::kNavigate || tool == Tool::kClick || tool == Tool::kPolygon || tool >= Tool::kColour;
}

bool is_volume(Tool tool) {
  return tool == Tool::kSphere || tool == Tool::kVolume;
}

}  // namespace

SetOperation PointerTools::operation(const ViewState& view, const Modifiers& m) const {
  if (m.alt || (m.shift && m.ctrl)) return SetOperation::kIntersect;
  if (m.shift) return SetOperation::kAdd;
  if (m.ctrl) return SetOperation::kRemove;
  return view.operation;
}

void PointerTools::start_shape(const glm::vec2& pixel) {
  drag_ = Drag::kShape;
  path_.assign(1, pixel);
}

std::vector<Command> PointerTools::press(const glm::vec2& pixel, PointerButton button,
                                         const Modifiers& modifiers, const ToolContext& context) {
  if (button_) return {};  // one drag at a time
  button_ = button;
  modifiers_ = modifiers;
  pressed_ = last_ = pixel;
  pressed_depth_ = context.depth(pixel);
  const Tool tool = context.view.tool;
  if (button == PointerButton::kMiddle) {
    drag_ = modifiers.shift ? Drag::kPan : Drag::kOrbit;
  } else if (drags_navigate(tool)) {
    drag_ = Drag::kMaybeClick;
  } else if (button == PointerButton::kLeft || tool == Tool::kScribble) {
    if (is_volume(tool) && grab_handle(pixel, context)) return {};
    start_shape(pixel);
  } else {
    drag_ = Drag::kMaybeClick;
  }
  return {};
}

std::vector<Command> PointerTools::move(const glm::vec2& pixel, const Modifiers& modifiers,
                                        const ToolContext& context) {
  const glm::vec2 delta = pixel - last_;
  last_ = pixel;
  if (glm::length(pixel - scale_at_) > kScaleLeavePoints * context.pixels_per_point) scale_armed_ = false;
  if (!button_) return {};
  modifiers_ = modifiers;
  if (drag_ == Drag::kMaybeClick && glm::length(pixel - pressed_) > kDragPoints * context.pixels_per_point)
    drag_ = button_ == PointerButton::kRight ? Drag::kPan : Drag::kOrbit;
  if (drag_ == Drag::kOrbit) context.camera.orbit(delta / context.pixels_per_point);
  if (drag_ == Drag::kPan)
    context.camera.pan(delta,
                       2 * context.pane_camera.fy_px * std::tan(0.5f * context.camera.pose().fov_y_rad),
                       pressed_depth_);
  if (drag_ != Drag::kShape) return {};
  const Tool tool = context.view.tool;
  if (tool == Tool::kBox || tool == Tool::kRectangle || is_volume(tool)) {
    path_.resize(1);
    path_.push_back(pixel);
    if (is_volume(tool)) shape_volume(context);
  } else if (glm::length(pixel - path_.back()) >= kPathStepPoints * context.pixels_per_point) {
    path_.push_back(pixel);
  }
  return {};
}

std::vector<Command> PointerTools::release(const glm::vec2& pixel, PointerButton button,
                                           const Modifiers& modifiers, const ToolContext& context) {
  if (button_ != button) return {};
  std::vector<Command> commands = move(pixel, modifiers, context);
  const Drag drag = drag_;
  drag_ = Drag::kNone;
  if (drag == Drag::kShape) commands = finish_shape(context);
  if (drag == Drag::kMaybeClick) commands = click(context);
  button_.reset();
  return commands;
}

std::vector<Command> PointerTools::click(const ToolContext& context) {
  const bool right = button_ == PointerButton::kRight;
  switch (context.view.tool) {
    case Tool::kClick:
      return click_object(context, right);
    case Tool::kPolygon:
      if (right) return confirm(context);
      if (corners_.size() >= 3 &&
          glm::length(pressed_ - corners_.front()) < kCloseClickPoints * context.pixels_per_point)
        return confirm(context);
      corners_.push_back(pressed_);
      return {};
    case Tool::kGround:
      return click_ground(context, right);
    case Tool::kMeasure:
      click_measure(context, right);
      return {};
    case Tool::kColour:
    case Tool::kFlood: {
      const auto point = right ? std::nullopt : context.pick(pressed_);
      if (!point) return {};
      const SetOperation set = operation(context.view, modifiers_);
      if (context.view.tool == Tool::kColour) return {PickColour{point->gaussian, set}};
      return {SelectFlood{point->gaussian, set}};
    }
    default:
      return {};
  }
}

std::vector<Command> PointerTools::click_object(const ToolContext& context, bool right) {
  Stroke stroke = splatcut::click(pressed_, right || modifiers_.ctrl ? SeedLabel::kRest : SeedLabel::kObject);
  stroke.radius_px *= context.pixels_per_point;
  if (modifiers_.alt) return {IntersectStroke{context.pane_camera, std::move(stroke), context.seen()}};
  scale_armed_ = stroke.label == SeedLabel::kObject;
  scale_at_ = pressed_;
  return {AddStroke{context.pane_camera, std::move(stroke), context.seen()}};
}

// The third says which way is up.
std::vector<Command> PointerTools::click_ground(const ToolContext& context, bool right) {
  if (right) {
    points_.clear();
    return {};
  }
  if (const auto point = context.pick(pressed_)) points_.push_back(point->position_world);
  if (points_.size() < 3) return {};
  glm::vec3 up = glm::cross(points_[1] - points_[0], points_[2] - points_[0]);
  // The ground is seen from above.
  if (glm::dot(up, context.pane_camera.centre_world() - points_[0]) < 0) up = -up;
  points_.clear();
  return {SetUp{up}};
}

void PointerTools::click_measure(const ToolContext& context, bool right) {
  if (right || points_.size() == 2) points_.clear();
  if (right) return;
  if (const auto point = context.pick(pressed_)) points_.push_back(point->position_world);
}

std::vector<Command> PointerTools::finish_shape(const ToolContext& context) {
  const std::vector<glm::vec2> path = std::exchange(path_, {});
  const Camera& camera = context.pane_camera;
  const float radius = context.view.brush_px * context.pixels_per_point;
  const SetOperation set = operation(context.view, modifiers_);
  const auto region = [&](Mask mask) {
    return std::vector<Command>{SelectRegion{camera, std::move(mask), set}};
  };
  switch (context.view.tool) {
    case Tool::kScribble: {
      const bool rest = button_ == PointerButton::kRight || modifiers_.ctrl;
      Stroke stroke{rest ? SeedLabel::kRest : SeedLabel::kObject, 0.5f * radius, path};
      if (modifiers_.alt) return {IntersectStroke{camera, std::move(stroke), context.seen()}};
      return {AddStroke{camera, std::move(stroke), context.seen()}};
    }
    case Tool::kBox:
      return path.size() == 2 ? std::vector<Command>{AddBox{camera, path[0], path[1], context.seen()}}
                              : std::vector<Command>{};
    case Tool::kBrush:
      return region(brush_region(path, radius, camera.width_px, camera.height_px));
    case Tool::kLasso:
      return region(polygon_region(path, camera.width_px, camera.height_px));
    case Tool::kRectangle:
      return path.size() == 2 ? region(rectangle_region(path[0], path[1], camera.width_px, camera.height_px))
                              : std::vector<Command>{};
    case Tool::kSphere:
    case Tool::kVolume:
      return finish_volume(set);
    default:
      return {};
  }
}

bool PointerTools::grab_handle(const glm::vec2& pixel, const ToolContext& context) {
  constexpr float kReachPoints = 10;
  if (!volume_ || volume_->round != (context.view.tool == Tool::kSphere)) return false;
  const std::vector<glm::vec2> handles = handles_px(*volume_, context.pane_camera);
  std::size_t nearest = 0;
  for (std::size_t h = 0; h < handles.size(); ++h)
    if (glm::distance(handles[h], pixel) < glm::distance(handles[nearest], pixel)) nearest = h;
  if (handles.empty() || glm::distance(handles[nearest], pixel) > kReachPoints * context.pixels_per_point)
    return false;
  handle_ = nearest;
  volume_before_ = volume_;
  drag_ = Drag::kShape;
  path_.assign(1, pixel);
  return true;
}

// While it is dragged: a new one around the point that was pressed, or the old one by its handle.
void PointerTools::shape_volume(const ToolContext& context) {
  if (handle_) {
    volume_ = dragged(*volume_before_, *handle_, path_[0], path_[1], context.pane_camera);
    return;
  }
  const Camera& camera = context.pane_camera;
  if (!volume_before_) {
    const auto centre = context.pick(path_.front());
    if (!centre) return;
    const glm::vec3 up = context.camera.up_world(), y(0, 1, 0);
    const float cosine = glm::dot(y, up);
    const glm::vec3 axis = glm::cross(y, up);
    volume_before_ = Volume{context.view.tool == Tool::kSphere, centre->position_world, glm::vec3(0),
                            cosine < -0.999f ? glm::quat(0, 1, 0, 0)
                                             : glm::normalize(glm::quat(1 + cosine, axis.x, axis.y, axis.z))};
  }
  volume_ = volume_before_;
  const float depth = camera.camera_from_world(volume_->centre_world).z;
  volume_->half = glm::vec3(glm::length(path_[1] - path_[0]) * depth / camera.fy_px);
}

std::vector<Command> PointerTools::finish_volume(SetOperation set) {
  const bool adjusts = handle_.has_value();
  const bool made = volume_ && volume_before_ && volume_->half.x > 0;
  handle_.reset();
  volume_before_.reset();
  if (!made) return {};
  if (!adjusts) volume_set_ = set;
  return {SelectVolume{*volume_, volume_set_, adjusts}};
}

void PointerTools::show_volume(const Camera& camera, ToolOverlay* out) const {
  if (!volume_) return;
  out->handles_px = handles_px(*volume_, camera);
  if (out->handles_px.empty()) return;
  out->points_px = {out->handles_px.front()};
  out->shape = ToolOverlay::Shape::kCircle;
  out->radius_px = volume_->round ? glm::distance(out->handles_px[0], out->handles_px[1]) : 0;
  if (!volume_->round) out->edges_px = edges_px(*volume_, camera);
}

std::vector<Command> PointerTools::confirm(const ToolContext& context) {
  const std::vector<glm::vec2> corners = std::exchange(corners_, {});
  if (corners.size() < 3) return {};
  const Camera& camera = context.pane_camera;
  return {SelectRegion{camera, polygon_region(corners, camera.width_px, camera.height_px),
                       operation(context.view, modifiers_)}};
}

bool PointerTools::abandon() {
  const bool any = at_work() || !points_.empty() || volume_;
  volume_.reset();
  volume_before_.reset();
  handle_.reset();
  path_.clear();
  corners_.clear();
  points_.clear();
  scale_armed_ = false;
  if (drag_ == Drag::kShape) drag_ = Drag::kNone;
  return any;
}

std::vector<Command> PointerTools::double_click(const glm::vec2& pixel, const ToolContext& context) {
  if (context.view.tool == Tool::kPolygon) return confirm(context);
  if (context.view.tool != Tool::kNavigate) return {};
  if (const auto point = context.pick(pixel)) context.camera.focus(point->position_world);
  return {};
}

std::vector<Command> PointerTools::wheel(float steps, const Modifiers& modifiers,
                                         const ToolContext& context) {
  constexpr float kBrushStep = 1.15f;
  if (modifiers.alt) {
    ViewState view = context.view;
    view.brush_px = std::clamp(view.brush_px * std::pow(kBrushStep, steps), kLeastBrushPx, kMostBrushPx);
    return {SetView{view}};
  }
  if ((scale_armed_ || modifiers.shift) && steps != 0) return {StepScale{steps > 0 ? 1 : -1}};
  const float depth = context.depth(last_).value_or(context.camera.pose().distance);
  context.camera.zoom(steps, context.pane_camera.world_from_pixel(last_, depth));
  return {};
}

void PointerTools::hold(const Modifiers& modifiers) {
  if (!button_) modifiers_ = modifiers;
}

ToolOverlay PointerTools::overlay(const ViewState& view, const Camera& camera, float pixels_per_point) const {
  ToolOverlay out;
  out.radius_px = view.brush_px * pixels_per_point;
  out.operation = operation(view, modifiers_);
  out.rest = button_ == PointerButton::kRight || modifiers_.ctrl;
  out.cuts = is_stroke_tool(view.tool);
  out.points_px = path_;
  switch (view.tool) {
    case Tool::kScribble:
      out.radius_px *= 0.5f;
      [[fallthrough]];
    case Tool::kBrush:
      out.shape = ToolOverlay::Shape::kPath;
      break;
    case Tool::kLasso:
      out.shape = ToolOverlay::Shape::kPolygon;
      break;
    case Tool::kBox:
    case Tool::kRectangle:
      out.shape = ToolOverlay::Shape::kRectangle;
      break;
    case Tool::kSphere:
    case Tool::kVolume:
      out.points_px.clear();
      show_volume(camera, &out);
      break;
    case Tool::kPolygon:
      out.shape = ToolOverlay::Shape::kPolygon;
      out.points_px = corners_;
      if (!corners_.empty()) out.points_px.push_back(last_);
      break;
    case Tool::kGround:
    case Tool::kMeasure:
      out.shape = ToolOverlay::Shape::kPoints;
      out.points_px.clear();
      for (const glm::vec3& point : points_) {
        const glm::vec3 seen = camera.camera_from_world(point);
        if (seen.z > 0) out.points_px.push_back(camera.pixel_from_camera(seen));
      }
      if (view.tool == Tool::kMeasure && points_.size() == 2)
        out.length = glm::distance(points_[0], points_[1]);
      break;
    default:
      break;
  }
  if (out.points_px.empty()) out.shape = ToolOverlay::Shape::kNone;
  return out;
}

}  // namespace splatcut
