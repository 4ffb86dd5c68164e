// The application without its window: document, history, camera, tools, worker threads, pictures.
//
// One thread (the main one) calls everything here. Commands come in by apply() or by events; what the
// interface shows is read through the const members. Events of a test and of the window run the very same
// code. Files, cuts and pictures are made on threads and arrive in update(). What costs a pass over the
// scene's Gaussians still runs here: labels and floaters when something changed (refresh_style), selections
// by colour or range, one pixel under the pointer where no picture shows it yet (pick). Errors: every Error
// ends in apply() or update() and becomes a message.
#pragma once

#include <deque>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "app/studio/actions.h"
#include "app/studio/camera_controller.h"
#include "app/studio/command.h"
#include "app/studio/frame_thread.h"
#include "app/studio/history.h"
#include "app/studio/opened_scene.h"
#include "app/studio/pointer_tools.h"
#include "app/studio/task_thread.h"

namespace splatcut {

struct EditContext;
struct RestoredWork;

// Files in the state folder: the autosave of now, and the one that a crashed program left.
inline constexpr const char* kAutosave = "autosave.splatcut.json";
inline constexpr const char* kAutosaveBefore = "autosave.before.splatcut.json";

struct StudioOptions {
  std::function<void()> wake;          // called from any thread when update() has something to do
  bool inline_tasks = false;           // for tests: tasks run inside apply()
  std::filesystem::path state_folder;  // for the autosave; empty: none is written
  PreparedCache cache;                 // of scenes once prepared
};

struct Message {
  enum class Kind { kInfo, kDone, kRefused, kError };
  Kind kind = Kind::kInfo;
  std::string text;
  double time_s = 0;  // Studio's clock
};

// A view that the cut used, as the thumbnail strip shows it.
struct ViewCard {
  Camera camera;
  bool used = true;
  double confidence = 0;
  std::string reason;  // why it does not count
  std::shared_ptr<const Image<Rgba8>> picture;
  bool only_to_look = false;  // it had no influence on the cut
  std::uint64_t serial = 0;   // changes with the picture
};

// The meanings of an object's first click, once a cut has found them.
struct ClickMeanings {
  std::string key;                            // of that click, see key_of_first_stroke()
  int choice = 0;                             // whose sizes these are:
  std::size_t sizes = 0, likeliest_size = 0;  // how many, and the one that a click takes
  std::size_t size = 0;                       // the one taken
  Camera camera;                              // of the click
  // Per meaning its borders in the camera's pixels.
  std::vector<std::vector<std::vector<glm::vec2>>> outlines;
  std::vector<std::vector<glm::vec2>> smaller, larger;  // of the next sizes; empty: there is none
};

// The last cut of an object, or the one that runs.
struct CutRun {
  bool running = false;
  std::string key;                          // cut_key() of what it cuts
  std::shared_ptr<const CutResult> result;  // null until it is done
  std::vector<StageTime> stages;            // so far
  std::vector<ViewCard> views;
  Flags preview;  // labels so far
  double started_s = 0, first_mask_ms = 0, total_ms = 0;
  std::shared_ptr<const ClickMeanings> meanings;         // of the first click, as far as it is known
  std::vector<std::string> doubts;                       // a sentence each
  std::shared_ptr<const std::vector<float>> likelihood;  // of `key`; null until asked for
  bool likelihood_failed = false;                        // for `key`: not asked for again
};

// Requests that only the interface can fulfil.
enum class UiRequest {
  kOpenDialog,
  kSaveDialog,
  kExportDialog,
  kHelp,
  kTheme,
  kHistory,
  kQuit,
  kSnapshotDialog,
  kExportFailed  // the dialog comes back as it was
};

class Studio {
 public:
  explicit Studio(StudioOptions options);
  ~Studio();

  // Commands and events. Positions are viewport pixels.
  void apply(const Command& command);
  void run(Action action);
  std::string why_not(Action action) const;  // empty where it is allowed
  // covered_bottom_px: of the viewport, by thumbnails; framing keeps clear of it.
  void set_viewport(int width_px, int height_px, float pixels_per_point, float covered_bottom_px = 0);
  void pointer_pressed(const glm::vec2& pixel, PointerButton button, const Modifiers& modifiers);
  void pointer_moved(const glm::vec2& pixel, const Modifiers& modifiers);
  void pointer_released(const glm::vec2& pixel, PointerButton button, const Modifiers& modifiers);
  void pointer_double_clicked(const glm::vec2& pixel);
  void wheel(float steps, const Modifiers& modifiers);
  void key_pressed(int key, const Modifiers& modifiers, bool repeated = false);  // repeated: still held
  void key_released(int key);
  void release_keys();  // the window lost the focus
  void pointer_left();  // the viewport

  // Once a frame: results, transitions, requests. True while something moves or waits.
  bool update(double seconds);

  // What the interface shows.
  const Document& document() const { return history_.now(); }
  const History& history() const { return history_; }
  const ViewState& view() const { return view_; }
  const OpenedScene* scene() const { return scene_.get(); }
  const PreparedScene* prepared() const { return prepared_.get(); }
  const CutRun* cut_run(ObjectId object) const;
  bool loading() const { return tasks_.busy(TaskKind::kLoad); }
  bool cutting() const { return tasks_.busy(TaskKind::kCut); }
  TaskThread::Progress progress() const { return tasks_.progress(); }
  bool moving() const;  // the view does, or did a moment ago
  bool idle() const;    // no task, no picture on its way, the last picture is full and current
  const std::deque<Message>& messages() const { return messages_; }
  double clock_s() const { return clock_s_; }
  const FrameResult* picture() const { return picture_ ? &*picture_ : nullptr; }
  std::uint64_t picture_serial() const { return picture_serial_; }
  ToolOverlay overlay() const;
  const PointerTools& tools() const { return tools_; }
  CameraController& camera() { return camera_; }
  const CameraController& camera() const { return camera_; }
  Camera viewport_camera() const;  // of the first pane
  // Other meanings of the active object's first click, offered until it gets another stroke; null: none.
  const ClickMeanings* offer() const;
  // The sizes beside the one that the wheel is at, for a while after the click or the last step; and how
  // clearly they show, from 1 to 0.
  const ClickMeanings* sizes() const;
  float sizes_opacity() const;
  // True if the active object's clicks found nothing, mostly for being made from too far away.
  bool found_nothing() const;
  // Where a drag goes on; 1: the right one.
  int drag_pane() const { return panes() == 2 && tools_.dragging() ? pressed_pane_ : 0; }
  int panes() const { return view_.display == DisplayMode::kSideBySide && scene_ ? 2 : 1; }
  std::vector<std::uint8_t> labels(ObjectId object) const;
  std::size_t gaussians_of(ObjectId object) const;  // cached: free to ask every frame
  bool floaters_shown() const { return highlight_floaters_; }
  std::size_t floater_count() const { return floater_count_; }
  float moving_scale() const { return moving_scale_; }
  double moving_ms() const { return moving_ms_; }
  double still_ms() const { return still_ms_; }
  // Unsaved work of the last run: offered until it is restored or dropped.
  bool autosave_found() const { return !restorable_.empty(); }
  // "garden.ply, 2026-03-01 18:40": of which scene, and when it was written.
  const std::string& autosave_says() const { return restorable_says_; }
  std::vector<UiRequest> take_ui_requests() { return std::exchange(ui_requests_, {}); }
  std::optional<PickedPoint> pick(const glm::vec2& pixel) const;
  const Flags& active_labels() const { return active_labels_; }  // as they are shown; null: none yet
  const Modifiers& held() const { return held_modifiers_; }
  DrawLimits draw_limits() const;
  std::uint64_t document_serial() const { return document_serial_; }
  const std::filesystem::path& work_path() const { return work_path_; }
  // Also while the file is being written.
  bool unsaved() const { return !document().objects.empty() && saved_serial_ != document_serial_; }
  std::uint64_t style_serial() const { return style_version_; }  // changes with what style() and shown() say
  void leave();  // the program ends: an autosave that is not needed goes

  // A GPU draws the splats: pictures are then made for picking only, when nothing moves.
  void set_gpu_view(bool gpu) { gpu_view_ = gpu; }
  // Per Gaussian, what the display mode of a pane shows and whose it is.
  Flags shown(int pane) const;
  FrameStyle style(int pane) const;

  // For tests: waits until idle(); runs update() with steps of 1/60 s. False after `most_seconds`.
  bool settle(double most_seconds);

 private:
  // studio_click.cpp
  void perform(const AddStroke& c);
  void perform(const ComeNearer&);
  void perform(const StepScale& c);
  bool hits_anything(const AddStroke& c) const;
  std::string already_so(const AddStroke& c) const;
  const ClickMeanings* meanings(const ObjectItem& object) const;
  std::string why_not_step(int steps) const;
  struct HoverAsk;
  std::optional<HoverAsk> hover_wanted() const;
  void refresh_hover();
  void show_hover(const Flags& change, bool rest);
  void note_sizes();  // studio_sizes.cpp

  // studio_strokes_alone.cpp
  void perform(const IntersectStroke& c);
  void perform(const AddBox& c);
  void combine_with(const StrokedView& strokes, SetOperation operation, const std::string& title);

  // studio_edit.cpp
  void perform(const SelectRegion& c);
  void perform(const SelectVolume& c);
  void perform(const SelectColour& c);
  void perform(const SelectRange& c);
  void perform(const PickColour& c);
  void perform(const SelectFlood& c);
  void select_or_refuse(const Selection& region, SetOperation operation, const std::string& title);
  void perform(const ShowFloaters& c);
  void perform(const Undo&);
  void perform(const Redo&);
  void perform(const JumpHistory& c);
  void perform(const Cancel&);
  void perform(const Recompute&);
  void perform(const SetUp& c);
  void perform(const SetView& c);
  void perform(const GoToCamera& c);
  void perform(const SetFieldOfView& c);
  void perform(const LookAlong& c);
  void perform(const NextBackdrop&);
  void perform(const SetBackdrop& c);
  // studio_files.cpp
  void find_autosave();
  void perform(const OpenScene& c);
  void perform(const SaveWork& c);
  void perform(const RestoreAutosave&);
  void perform(const DropAutosave&);
  void perform(const Export& c);
  void perform(const SaveSnapshot& c);
  void perform(const SaveTurntable& c);
  template <class DocumentCommand>
  void perform(const DocumentCommand& c);

  EditContext context() const;
  void require_scene() const;
  void require_gaussian(std::int32_t gaussian) const;
  void push(std::string title, Document after, std::string merge_key, const std::string& message);
  void apply_selection(const Selection& region, SetOperation operation, const std::string& title);
  void document_changed();
  void say(Message::Kind kind, std::string text);
  void run_all(const std::vector<Command>& commands);
  void scale_brush(float factor);
  void hold(const Modifiers& modifiers);

  // studio_jobs.cpp
  void opened(const std::shared_ptr<OpenedScene>& scene, const std::optional<RestoredWork>& work,
              const std::filesystem::path& work_path);
  void schedule_cut();
  void start_cut(const ObjectItem& object);
  void forget_runs();
  void show_runs_of_now();
  void keep_run(ObjectId object, CutRun run);
  CutRun* run_of(ObjectId object, const std::string& key);
  void end_running_cut();
  void give_up_cut(ObjectId id, const std::string& key);
  void request_likelihood();
  const std::string& wanted_key(const ObjectItem& object);
  void autosave(double seconds);

  // studio_view.cpp
  void refresh_style();
  void request_picture();
  void take_picture();
  Flight flight() const;
  ToolContext tool_context(const glm::vec2& pixel);
  std::optional<float> depth_on_screen(const glm::vec2& pixel) const;
  // Draws that one pixel. visible: null for all.
  std::optional<PickedPoint> hit_in(const Camera& camera, const glm::vec2& pixel, const Flags& visible) const;
  Flags seen(int pane) const;  // what is drawn there now; null: all
  int pane_at(const glm::vec2& pixel) const;
  glm::vec2 in_pane(const glm::vec2& pixel) const;

  StudioOptions options_;
  History history_;
  ViewState view_;
  CameraController camera_;
  PointerTools tools_;
  std::shared_ptr<const OpenedScene> scene_;
  std::shared_ptr<const PreparedScene> prepared_;
  std::shared_ptr<Session> session_;           // for the worker
  std::shared_ptr<const CoarseCloud> coarse_;  // of large scenes, for pictures while the view moves
  std::map<ObjectId, CutRun> runs_;
  std::deque<std::pair<ObjectId, CutRun>> runs_before_;  // of other states of the history, the newest last
  std::map<ObjectId, std::string> wanted_keys_;          // cut_key() of the document with wanted_serial_
  std::uint64_t wanted_serial_ = 0;
  ObjectId cutting_object_ = 0;
  std::string cutting_key_;
  std::set<std::string> given_up_;  // keys that were cancelled or failed: not tried again by themselves
  std::deque<Message> messages_;
  std::vector<UiRequest> ui_requests_;
  std::set<int> held_keys_;
  Modifiers held_modifiers_;
  double brush_repeated_s_ = -1e9;
  double clock_s_ = 0;

  int width_px_ = 0, height_px_ = 0;
  float covered_bottom_px_ = 0;
  float pixels_per_point_ = 1;
  bool gpu_view_ = false;
  std::uint64_t document_serial_ = 1, style_serial_ = 0, view_serial_ = 1, styled_view_serial_ = 0;
  Flags shown_[2];
  FrameStyle style_[2];
  std::uint64_t style_version_ = 0, requested_style_ = 0;
  mutable std::map<ObjectId, std::size_t> counts_;
  bool highlight_floaters_ = false;
  std::string volume_key_;   // merge key of the last volume's step
  Flags volume_seen_;        // what was shown when it first selected
  std::size_t volumes_ = 0;  // so far
  int pressed_pane_ = 0;     // of the drag
  // Asked of the worker, or shown already.
  struct HoverAsk {
    std::uint64_t document = 0, view = 0;  // serials
    Camera camera;
    glm::vec2 pixel{0};
    bool rest = false;
    bool same_but_pixel(const HoverAsk& other) const {
      return document == other.document && view == other.view && rest == other.rest &&
             same_camera(camera, other.camera);
    }
  };
  std::optional<HoverAsk> hover_;
  Flags active_labels_;         // of the active object, as they are shown
  std::string declined_offer_;  // its key
  double stepped_s_ = -1e9;     // when a size was chosen last, or a click found some
  bool pointer_inside_ = false;
  std::size_t floater_count_ = 0;
  std::optional<FrameResult> picture_;
  std::uint64_t picture_serial_ = 0, picture_style_ = 0;
  std::optional<Camera> requested_camera_;
  bool requested_full_ = false;
  double last_move_s_ = -1e9;
  float moving_scale_ = 0.5f;
  double moving_ms_ = 0, still_ms_ = 0;

  std::filesystem::path work_path_;
  std::filesystem::path restorable_;  // empty: none
  std::string restorable_says_;
  std::uint64_t autosaved_serial_ = 1, saved_serial_ = 1;
  CameraPose autosaved_pose_;
  double autosave_wait_s_ = 0;
  std::uint64_t next_scene_serial_ = 1, next_card_serial_ = 1;

  // Last, in this order: threads end before what they may wake.
  FrameThread frames_;
  TaskThread tasks_;
};

}  // namespace splatcut
