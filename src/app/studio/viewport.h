// The view of the scene: its size and panes, the camera, what is drawn in which style, the pictures as they
// arrive, and what lies under a pixel.
//
// Pixels are of the viewport, x right, y down; two panes are halves of it side by side. Main thread; pictures
// are made on FrameThread, styles on Workspace::quick.
#pragma once

#include <algorithm>
#include <optional>

#include "app/picture/camera_controller.h"
#include "app/picture/frame_thread.h"
#include "app/picture/styles.h"
#include "app/studio/cut_jobs.h"
#include "app/studio/workspace.h"

namespace splatcut {

class Viewport {
 public:
  Viewport(Workspace& workspace, const CutJobs& cuts);

  // covered_bottom_px: by thumbnails; framing keeps clear of it.
  void set_size(int width_px, int height_px, float pixels_per_point, float covered_bottom_px);
  // A GPU draws the splats: pictures are then made for picking only, when nothing moves.
  void set_gpu_view(bool gpu) { gpu_view_ = gpu; }
  void reset();                                       // another scene, the workspace's
  void change_scene();                                // the same with other files in it: the camera stays
  bool update(double seconds, const Flight& flight);  // once a frame; true while the view moves
  bool idle() const;  // the last picture is full, current, in the current style

  // Camera and panes.
  CameraController& camera() { return camera_; }
  const CameraController& camera() const { return camera_; }
  Camera pane_camera() const;                               // of each pane: two show the same
  int panes() const { return std::max(1, styles_.panes); }  // as they are shown
  int pane_at(const glm::vec2& pixel) const;
  // Where a drag goes on; 1: the right one.
  int drag_pane() const { return panes() == 2 && ws_.tools.dragging() ? pressed_pane_ : 0; }
  void press_in(int pane) { pressed_pane_ = pane; }
  int pressed_pane() const { return panes() == 2 ? pressed_pane_ : 0; }  // the last one: where the hand works
  glm::vec2 in_pane(const glm::vec2& pixel) const;
  float pixels_per_point() const { return pixels_per_point_; }
  void frame_object();
  bool moving() const;  // or it did a moment ago

  // What is drawn.
  DrawLimits draw_limits() const;
  const Flags& shown(int pane) const { return styles_.shown.at(static_cast<std::size_t>(pane)); }
  const FrameStyle& style(int pane) const { return styles_.style.at(static_cast<std::size_t>(pane)); }
  // Drawn there in place of the scene's rows; null: those.
  const std::shared_ptr<const CleanObject>& clean(int pane) const {
    return styles_.clean.at(static_cast<std::size_t>(pane));
  }
  std::uint64_t style_serial() const { return style_serial_; }  // changes with shown() and style()
  bool style_current() const;  // made of the document and the view as they are
  const Flags& active_labels() const { return styles_.active_labels; }  // as they are shown; null: none yet
  Flags seen(int pane) const;  // what can be seen there now; null: all
  void show_floaters(bool shown);
  bool floaters_shown() const { return floaters_shown_; }
  std::size_t floater_count() const { return styles_.floaters; }
  // Outlines Gaussians in the first pane, until the next change of style; null: none.
  void highlight(const Flags& gaussians, const Rgb8& colour);

  // Pictures.
  const FrameResult* picture() const { return picture_ ? &*picture_ : nullptr; }
  std::uint64_t picture_serial() const { return picture_serial_; }
  // Of the pane; null: the screen shows another view, or not in full.
  std::shared_ptr<const Frame> full_picture_of(const Camera& camera, int pane = 0) const;
  float moving_scale() const { return moving_scale_; }
  double moving_ms() const { return moving_ms_; }
  double still_ms() const { return still_ms_; }

  // What lies under a pixel of the pressed pane. The picture knows, where it shows this view, else that one
  // pixel is drawn.
  std::optional<PickedPoint> pick(const glm::vec2& pixel) const;
  std::optional<PickedPoint> hit_in(const Camera& camera, const glm::vec2& pixel, const Flags& visible) const;
  // Camera z, from the last picture of any size and camera: while the view moves it lags behind.
  std::optional<float> depth_on_screen(const glm::vec2& pixel) const;
  ToolContext tool_context(const glm::vec2& pixel);

 private:
  void request_styles();
  void request_picture();
  void take_picture();

  Workspace& ws_;
  const CutJobs& cuts_;
  CameraController camera_;
  int width_px_ = 0, height_px_ = 0;
  float covered_bottom_px_ = 0, pixels_per_point_ = 1;
  bool gpu_view_ = false;
  int pressed_pane_ = 0;  // of the drag

  Styles styles_;
  std::shared_ptr<LabelCache> style_labels_;  // the worker's
  std::uint64_t style_serial_ = 0;
  std::uint64_t styled_document_ = 0, styled_view_ = 0;  // serials of what was asked for last
  bool styles_on_the_way_ = false;
  bool floaters_shown_ = false, say_floaters_ = false;

  std::optional<FrameResult> picture_;
  std::uint64_t picture_serial_ = 0;
  std::optional<Camera> requested_camera_;
  bool requested_full_ = false;
  std::uint64_t requested_style_ = 0;
  double last_move_s_ = -1e9;
  float moving_scale_ = 0.5f;
  double moving_ms_ = 0, still_ms_ = 0;

  FrameThread frames_;  // last: ends before the rest goes
};

}  // namespace splatcut
