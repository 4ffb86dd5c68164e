// The view of the scene: its size and panes, the camera, what is drawn in which style, the pictures as they
// arrive, and what lies under a pixel.
//
// Pixels are the viewport's, x right, y down; two panes are its halves side by side. Only the main thread
// calls this class. FrameThread makes pictures, and Workspace::quick makes styles.
#pragma once

#include <algorithm>
#include <optional>

#include "app/document/stroke_hits.h"
#include "app/picture/camera_controller.h"
#include "app/picture/frame_thread.h"
#include "app/picture/styles.h"
#include "app/tools/stroke_marks.h"
#include "app/workspace/cut_jobs.h"
#include "app/workspace/workspace.h"
#include "scene/raster/rasterizer.h"

namespace splatcut {

class Viewport {
 public:
  Viewport(Workspace& workspace, const CutJobs& cuts);

  // See Studio::set_viewport().
  void set_size(int width_px, int height_px, float pixels_per_point);
  // Says whether a GPU draws the splats. If so, pictures are made for picking only, and only when nothing
  // moves.
  void set_gpu_view(bool gpu) { gpu_view_ = gpu; }
  void reset();  // starts with the workspace's new scene
  // From the present direction; the opening view of scenes opened together.
  void show_all_of_scene();
  void change_scene();  // goes on with the workspace's scene, which has other files now; the camera stays
  // Moves the camera, and requests and takes styles and pictures; called once a frame. Returns true while the
  // camera moves by itself.
  bool update(double seconds, const Flight& flight);
  bool idle() const;  // true: the last picture is full, current, and in the current style

  // Camera and panes.
  CameraController& camera() { return camera_; }
  const CameraController& camera() const { return camera_; }
  glm::vec2 size_px() const { return {width_px_, height_px_}; }
  // Points where the active object's Gaussians show; strays do not count.
  std::vector<glm::vec3> object_points() const;
  // True: the present picture shows the active object, and does not crop it.
  bool shows_all_of_object();
  Camera pane_camera() const;  // camera of each pane: two panes show the same view
  int panes() const { return std::max(1, styles_.panes); }  // number of panes that are shown
  int pane_at(const glm::vec2& pixel) const;                // pane under the pixel; during a drag, the drag's
  void press_in(int pane) { pressed_pane_ = pane; }
  // Pane in which a button was pressed last: the one that the user works in. 1 is the right one.
  int pressed_pane() const { return panes() == 2 ? pressed_pane_ : 0; }
  glm::vec2 in_pane(const glm::vec2& pixel) const;  // position within the pane that pane_at() names
  float pixels_per_point() const { return pixels_per_point_; }
  void turn_about_object();  // makes the middle of the active object what the view turns around
  bool moving() const;       // true: the view moves, or did a moment ago

  // Content of the panes.
  DrawLimits draw_limits() const;
  const Flags& shown(int pane) const { return styles_.shown.at(static_cast<std::size_t>(pane)); }
  const FrameStyle& style(int pane) const { return styles_.style.at(static_cast<std::size_t>(pane)); }
  // Object that the pane draws in place of the scene's rows; null: the rows.
  const std::shared_ptr<const CleanObject>& clean(int pane) const {
    return styles_.clean.at(static_cast<std::size_t>(pane));
  }
  // Number that changes with shown() and style().
  std::uint64_t style_serial() const { return style_serial_; }
  // What the styles of the present document and view are made from, and the last that were made.
  StyleOrder style_order() const;
  const Styles& styles() const { return styles_; }
  bool style_current() const;  // true: the styles belong to the present document and view
  // True: the panes hold what the view's display asks for, alone or whole; the picture may follow later.
  bool display_current() const {
    return !ws_.scene || styles_.panes == 0 || styles_.display == ws_.view.display;
  }
  // Labels of the active object, as they are shown; null: there are none yet.
  const Flags& active_labels() const { return styles_.active_labels; }
  Flags seen(
      int pane) const;  // Gaussians that the pane shows now; null: all. The same array for the same view
  void show_floaters(bool shown);
  bool floaters_shown() const { return floaters_shown_; }
  void show_range(const std::optional<SelectRangeOrColour>& range);  // outlines it; none: no outline
  const std::optional<SelectRangeOrColour>& range_shown() const { return range_shown_; }
  void show_placed(std::uint32_t file);  // SceneSource::id of the file whose handles show; 0: none
  std::uint32_t placed_file() const { return placed_file_; }
  // True while handles show and no object came since: it is the file that one looks at.
  bool placing() const;
  std::size_t floater_count() const { return styles_.floaters; }
  // Outlines Gaussians in the first pane until the styles change; null: outlines none.
  void highlight(const Flags& gaussians, const Rgb8& colour);

  // Pictures.
  const FrameResult* picture() const { return picture_ ? &*picture_ : nullptr; }
  std::uint64_t picture_serial() const { return picture_serial_; }
  // Frame of the pane; null: the last picture shows another view, or is not full.
  std::shared_ptr<const Frame> full_picture_of(const Camera& camera, int pane = 0) const;
  float moving_scale() const { return moving_scale_; }  // size of a reduced picture over that of a full one
  double moving_ms() const { return moving_ms_; }       // time of the last reduced picture
  double still_ms() const { return still_ms_; }         // time of the last full picture

  // Picks the surface under a pixel of the pressed pane; none: nothing is there. The last picture answers if
  // it shows this view; else the one pixel is drawn.
  std::optional<PickedPoint> pick(const glm::vec2& pixel) const;
  // The surface in the middle of the picture, but for Gaussians of the file (a SceneSource::id, 0: of none);
  // none: nothing is there.
  std::optional<glm::vec3> surface_in_middle(std::uint32_t without_file = 0) const;
  // The same; where nothing is there, the point that the view turns around.
  glm::vec3 looked_at_world() const;
  // Picks the surface under a pixel of any camera. visible: flags of the Gaussians that count; null: all.
  std::optional<PickedPoint> hit_in(const Camera& camera, const glm::vec2& pixel, const Flags& visible) const;
  // hits_of(), from the last picture where that shows this view and these Gaussians.
  std::vector<std::int32_t> hit_by(const CameraStroke& stroke) const;
  // Opacity and depth of a part of the picture that any camera shows of the visible Gaussians.
  RasterOutput drawn(const Camera& camera, const PixelRect& part, const Flags& visible) const;
  DrawnPart drawn_part() const;  // the same, for hits_of()
  // Camera z of the surface under a pixel of a pane, scene units, from the last picture; none: unknown. While
  // the view moves, the picture lags behind, and so does the answer.
  std::optional<float> depth_on_screen(const glm::vec2& pixel, int pane) const;
  ToolContext tool_context(int pane);  // for a tool that is used in that pane
  // Marks of the active object's clicks, in the pixels of the first pane. mark_at(): the one under a pixel;
  // null: none is, or there are two panes.
  const std::vector<StrokeMark>& marks() const { return marks_; }
  const StrokeMark* mark_at(const glm::vec2& pixel) const {
    return panes() == 1 ? splatcut::mark_at(marks_, pixel, pixels_per_point_) : nullptr;
  }

 private:
  void request_styles();
  void request_picture();
  void take_picture();
  void refresh_marks();
  // Of the visible Gaussians, those within the far plane of the camera.
  Flags within_limits(const Camera& camera, const Flags& visible) const;
  bool hides(const glm::vec3& point_world) const;  // the last picture shows something before it

  Workspace& ws_;
  const CutJobs& cuts_;
  CameraController camera_;
  int width_px_ = 0, height_px_ = 0;
  float pixels_per_point_ = 1;
  bool gpu_view_ = false;
  StrokeMarks stroke_marks_;
  std::vector<StrokeMark> marks_;
  DrawLimits marked_within_;
  std::optional<double> limits_changed_s_;  // time of a change that the marks do not know of yet
  struct WithinLimits {                     // the last answer of within_limits()
    std::weak_ptr<const GaussianCloud> cloud;
    Camera camera;
    float far_plane = 0;
    Flags visible, within;
  };
  mutable std::optional<WithinLimits> within_;
  int pressed_pane_ = 0;  // pane in which a button was pressed last

  Styles styles_;
  std::shared_ptr<LabelCache> style_labels_;  // cache that the worker uses
  std::uint64_t style_serial_ = 0;
  std::uint64_t styled_document_ = 0, styled_view_ = 0;  // serials for which styles were requested last
  bool styles_on_the_way_ = false;
  bool floaters_shown_ = false, say_floaters_ = false;
  std::optional<SelectRangeOrColour> range_shown_;
  std::uint32_t placed_file_ = 0;
  std::uint64_t placed_serial_ = 0;  // serial of the document when its handles came

  struct WholeShown {  // shows_all_of_object() of this picture and these labels
    std::weak_ptr<const Frame> picture;
    Flags labels;
    bool whole = false;
  } whole_shown_;
  std::optional<FrameResult> picture_;
  std::uint64_t picture_serial_ = 0;
  std::optional<Camera> requested_camera_;
  bool requested_full_ = false;
  std::uint64_t requested_style_ = 0;
  double last_move_s_ = -1e9;
  float moving_scale_ = 0.5f;
  double moving_ms_ = 0, still_ms_ = 0;

  FrameThread frames_;  // last member: its thread ends before the rest is destroyed
};

}  // namespace splatcut
