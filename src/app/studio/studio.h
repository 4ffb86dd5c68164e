// The application without its window. It is the sum of its parts: a command goes to the part that performs
// it.
//
// Only the main thread calls anything here. Commands come in by apply() or by events; the interface reads
// what it shows from the parts. Events of a test and of the window run the very same code. Files, cuts, edits
// of many Gaussians, styles and pictures are made on workers and arrive in update(). What is left for the
// main thread costs at most a few milliseconds a million Gaussians: picking where no picture shows the view
// yet, and labels of an object that changed; of each object where a stroke begins another one. Errors: every
// Error ends in apply() or update() and becomes a message.
#pragma once

#include <functional>
#include <set>
#include <string>
#include <vector>

#include "app/studio/clean_edges.h"
#include "app/studio/clicks.h"
#include "app/studio/edits.h"
#include "app/studio/exports.h"
#include "app/studio/free_sides.h"
#include "app/studio/scene_files.h"
#include "app/studio/seen_views.h"
#include "app/tools/actions.h"
#include "app/workspace/cut_jobs.h"
#include "app/workspace/viewport.h"
#include "app/workspace/workspace.h"

namespace splatcut {

// Why what moves the view is refused while a shape is drawn.
inline constexpr std::string_view kViewStays = "the view stays while a shape is drawn over it";

class Studio {
 public:
  explicit Studio(const StudioOptions& options);
  ~Studio();

  // Commands and events. Positions are viewport pixels, x right, y down.
  void apply(const Command& command);
  void run(Action action);
  std::string why_not(Action action) const;  // reason why the action is refused now; empty: it is allowed
  void set_viewport(int width_px, int height_px, float pixels_per_point);
  void pointer_pressed(const glm::vec2& pixel, PointerButton button, const Modifiers& modifiers);
  void pointer_moved(const glm::vec2& pixel, const Modifiers& modifiers);
  void pointer_released(const glm::vec2& pixel, PointerButton button, const Modifiers& modifiers);
  void pointer_double_clicked(const glm::vec2& pixel);
  void wheel(float steps, const Modifiers& modifiers);
  void key_pressed(int key, const Modifiers& modifiers, bool repeated = false);  // repeated: it is still held
  void key_released(int key);
  void release_keys();  // the window lost the focus
  void pointer_left();  // the pointer left the viewport
  // Place of the cursor that arrow keys move, viewport pixels; none: the mouse points. A move of the mouse
  // hides the cursor.
  const std::optional<glm::vec2>& cursor_px() const { return cursor_px_; }
  bool cursor_draws() const { return cursor_press_.has_value(); }  // true: arrows draw until the next Enter
  void set_gpu_view(bool gpu) { viewport_.set_gpu_view(gpu); }
  void leave_gpu_view(const std::string& reason);  // says why the CPU draws from now on
  void leave() { work_.leave(); }                  // the program ends
  void keep_unsaved() { work_.keep_unsaved(); }    // a signal ends the program

  // Takes results, moves transitions on and makes requests; called once a frame. Returns true while something
  // moves or waits.
  bool update(double seconds);

  // The parts, and what they share.
  const Viewport& viewport() const { return viewport_; }
  const CutJobs& cuts() const { return cuts_; }
  const Clicks& clicks() const { return clicks_; }
  const SavedWork& work() const { return work_; }
  const Exports& exports() const { return exports_; }
  void begin_exports_in(std::filesystem::path folder) { exports_.begin_in(std::move(folder)); }
  const SceneFiles& files() const { return files_; }
  CameraController& camera() { return viewport_.camera(); }
  const CameraController& camera() const { return viewport_.camera(); }
  const PointerTools& tools() const { return ws_.tools; }
  ToolOverlay overlay() const;
  const Document& document() const { return ws_.document(); }
  const History& history() const { return ws_.history; }
  const ViewState& view() const { return ws_.view; }
  const OpenedScene* scene() const { return ws_.scene.get(); }
  const Modifiers& held() const { return ws_.held_modifiers; }
  const std::deque<Message>& messages() const { return ws_.messages; }
  std::vector<UiRequest> take_ui_requests() { return std::exchange(ws_.ui_requests, {}); }
  double clock_s() const { return ws_.clock_s; }
  // Final labels, as long as the document stays as it is; empty: there is no such object.
  const std::vector<std::uint8_t>& labels(ObjectId object) const;
  LabelCache* label_cache() const { return &ws_.labels; }
  std::size_t gaussians_of(ObjectId object) const { return ws_.gaussians_of(object); }
  bool is_without_others(ObjectId object) const;  // looked for once for each state of the document
  const SeenViews& seen_views() const { return seen_views_; }
  const CleanEdges& finish() const { return clean_edges_; }
  std::optional<CleanReport> clean_edges(ObjectId object) const;  // none: not known yet
  std::optional<CleanReport> clean_edges() const;                 // of the active object

  // True if work is unsaved, also while it is being written.
  bool unsaved() const { return edits_.waiting() || work_.unsaved(); }
  // True if something that nobody has in a file would be missed: not where all objects were exported as they
  // are and a copy of the work, from which they can be changed further, is kept by itself.
  bool unsaved_and_not_exported() const;
  bool waiting() const { return edits_.waiting(); }  // true: commands wait for an edit, or for cuts
  bool loading() const { return tasks_.busy(TaskKind::kLoad); }
  std::string coming() const;  // what the empty view is going to show; empty: it shows its picture
  bool exporting() const { return tasks_.busy(TaskKind::kExport); }
  bool cutting() const { return tasks_.busy(TaskKind::kCut); }
  std::size_t neighbourhoods() const;  // number of places prepared for clicks; to be called while idle()
  TaskThread::Progress progress() const;
  bool idle() const;  // true: no task and no picture is on its way, and the last picture is full and current

  // For tests: runs update() in steps of 1/60 s until idle(). Returns false after `most_seconds`.
  bool settle(double most_seconds);

 private:
  // Asked for while the object's cut runs, and done when it is there; cut: its key; seen_from: the view
  // when a frame was asked for, which is not wanted any more once the user has moved that; meaning: number of
  // another one of the click.
  struct Held {
    std::string cut;
    std::optional<Action> display, frame;
    CameraPose seen_from{};
    std::optional<int> meaning;
  };
  void perform(const ShowFloaters& c);
  void perform(const ShowRange& c);
  void perform(const DrawLarger& c) { cuts_.draw_larger(c.card); }
  void perform(const ShowPlaced& c) { viewport_.show_placed(c.file); }
  void perform(const Cancel&);
  void perform(const Undo&);
  void perform(const Redo&);
  void perform(const Recompute&);
  void perform(const SetUp& c);
  void perform(const NewObject& c);
  void perform(const SetView& c);
  void refuse_while_drawing() const;
  void perform(const GoToCamera& c);
  void perform(const SetFieldOfView& c);
  void perform(const LookAlong& c);
  void perform(const NextBackdrop&);
  void perform(const SetBackdrop& c);
  void dispatch(const Command& command);
  bool cancel_task();
  void scene_opened(bool same);
  void follow_document();
  void run_all(const std::vector<Command>& commands);
  // Work of an action, see studio_actions.cpp.
  struct ActionRow;
  static const ActionRow* row_of(Action action);  // null: the action is a tool or a flight key
  void ask(UiRequest request) { ws_.ui_requests.push_back(request); }
  void close_shape();
  void turn_over(bool ViewState::*part);  // switches a setting of the view on or off
  bool hold_for_cut(Action action);
  Held& held_for(const ObjectItem& object);
  void choose_meaning(int choice);
  void run_held();
  void frame_object();
  void scale_brush(float factor);
  void step_camera(int direction);
  void hold(const Modifiers& modifiers);
  // What a press means depends on what is shown: from a change of display on, the pointer's events wait until
  // the panes follow it. What only moves the view or the pointer does not, where there is one pane all along.
  void pointer(std::function<void()> event, bool moves_alone);
  Flight flight() const;
  void press_at(const glm::vec2& pixel, PointerButton button, const Modifiers& modifiers);
  void move_to(const glm::vec2& pixel, const Modifiers& modifiers);
  void release_at(const glm::vec2& pixel, PointerButton button, const Modifiers& modifiers);
  void double_click_at(const glm::vec2& pixel);
  void move_cursor(const glm::vec2& direction);  // x right, y down; the length of the step by the held keys
  void press_cursor();                           // Enter
  bool hide_cursor();                            // drops what it draws; returns false if it is hidden already
  bool abandon_shape();
  glm::vec2 within_picture(const glm::vec2& pixel) const;  // nearest pixel that nothing covers

  Workspace ws_;
  CutJobs cuts_;
  Viewport viewport_;
  Edits edits_;
  Clicks clicks_;
  SavedWork work_;
  SceneFiles files_;
  Exports exports_;
  CleanEdges clean_edges_;
  SeenViews seen_views_;
  FreeSides free_sides_;
  std::set<int> held_keys_;
  std::vector<std::function<void()>> held_pointer_;
  Held held_actions_;
  double brush_repeated_s_ = -1e9;
  struct WithoutOthers {  // the last answer of is_without_others()
    ObjectId object = 0;
    std::uint64_t serial = 0;
    bool is_without = false;
  };
  mutable WithoutOthers without_others_;
  std::optional<glm::vec2> mouse_px_;         // place of the mouse; none: it is beside the picture
  std::optional<glm::vec2> cursor_px_;        // see cursor_px()
  std::optional<glm::vec2> cursor_click_px_;  // place of the last Enter: one more there is a double-click
  std::optional<Modifiers> cursor_press_;     // keys held with the Enter that began a shape; none: no shape
  ObjectId followed_object_ = 0;              // the active one that it saw last
  std::uint64_t followed_serial_ = 0;         // serial of the document that follow_document() saw last

  // Last members: the threads end before what they may call is destroyed.
  TaskThread tasks_, writes_, quick_;
};

}  // namespace splatcut
