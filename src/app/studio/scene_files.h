// Changes of the files that the window's scene is made of: opening, adding, placing, taking out, and undoing
// these.
//
// The worker reads scenes and prepares them; the window goes on.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "app/document/command.h"
#include "app/studio/saved_work.h"
#include "app/workspace/cut_jobs.h"
#include "app/workspace/viewport.h"
#include "app/workspace/workspace.h"

namespace splatcut {

class SceneFiles {
 public:
  struct Calls {
    // Called when the workspace has another scene and document, before the view is set up. same: it is the
    // same scene with other files in it, or with files placed otherwise.
    std::function<void(bool same)> opened;
    // Runs a function after all commands that wait: another scene would drop them.
    std::function<void(std::function<void()>)> at_last;
    // Returns the scene without the active object, its hole filled; null: that is not known.
    std::function<std::shared_ptr<const SceneWithout>()> without;
  };
  SceneFiles(Workspace& workspace, Viewport& viewport, CutJobs& cuts, SavedWork& work, Calls calls);

  void update();  // resumes preparing if a scene could not be opened; called once a frame
  // Stops opening another scene, else changing files; the scene stays as it is. A change of files that was
  // stopped for the other scene goes on, as it does if that cannot be opened.
  void cancel_loading();
  bool changing() const { return !changing_to_.empty(); }  // true: a change of files is under way
  bool stop_changing();                                    // cancels it; returns false if there is none
  // undo_files() and redo_files() undo or redo a change of files, if that is the next step to undo or redo.
  // They return false if it is not. Only the last changes can be undone: the files stay as they are now where
  // the scene before the change is no longer kept, which is said.
  bool undo_files();
  bool redo_files();
  // Number of scenes that undo and redo can go back to.
  std::size_t scenes_kept() const { return before_files_.size() + undone_files_.size(); }
  bool stays(const History::Entry& step) const;  // true: it changed files and cannot be undone any more
  bool can_redo_files() const { return !ws_.history.can_redo() && !redo_titles().empty(); }
  // Titles, as row_title() has them, of the steps that lie behind the end of the history, the next to redo
  // first: the changes of files that were undone, each with what was done after it.
  std::vector<std::string> redo_titles() const;

  // What is said while another scene is opened, until it is there; empty: none is.
  const std::string& opening() const { return opening_; }

  // True if the hole of that object is filled by a file that was kept (KeepFill).
  bool fills_hole_of(ObjectId object) const;

  // Place of one of the scene's files once the changes under way are done.
  ScenePlace place_to_be(std::uint32_t file) const;

  void perform(const OpenScene& c);
  void perform(const AddScene& c);
  void perform(const KeepFill& c);
  void perform(const PlaceScene& c);
  void perform(const BringHere& c);
  void perform(const RemoveScene& c);
  // Undoes or redoes the changes of files that lie between. Steps behind the end are those of redo_titles().
  void perform(const JumpHistory& c);

 private:
  void opened(const std::shared_ptr<OpenedScene>& scene, const std::optional<RestoredWork>& work,
              const std::filesystem::path& work_path);
  void start_preparing();
  void stop_for_loading();
  void add_all(const std::vector<std::filesystem::path>& added, std::optional<SpzAxes> axes,
               std::vector<std::string> refused);
  // Where files that are opened with the scene stand: a thing that stands alone has them beside it.
  StandsOn row_of_added() const;
  void take(const std::shared_ptr<const OpenedScene>& scene);
  // Files of the scene after the changes that are under way.
  std::vector<SceneSource> wanted_files() const;
  SceneSource& added_file(std::vector<SceneSource>* files, std::uint32_t id) const;
  // What is said once files have changed.
  struct Said {
    std::string done;                  // title of the step up to a semicolon; empty: which files were added
    std::vector<std::string> refused;  // a sentence for each file that could not be opened
    // View that is then to show the whole scene, unless the user has left it; none: it stays.
    std::optional<CameraPose> seen_from = {};
    std::optional<glm::vec3> put_on_world = {};  // where an added file may have come to stand in that view
  };
  void change_files(std::vector<SceneSource> files, const std::string& doing, Said said);
  void stop_loading();
  void go_on_changing();  // with `interrupted_`
  void say_refused(const std::vector<std::string>& refused);
  bool is_last(const OpenedScene& scene) const;
  void carry_document(const std::shared_ptr<OpenedScene>& scene, const Said& said);
  // replaced: what leaves with the file that fills a hole; null: none came.
  void files_changed(const std::shared_ptr<OpenedScene>& scene, History history, const Said& said,
                     const Flags& replaced);

  void fill_came(const OpenedScene& scene, const Flags& replaced);

  Workspace& ws_;
  Viewport& viewport_;
  CutJobs& cuts_;
  SavedWork& work_;
  Calls calls_;
  std::string opening_;
  std::uint32_t put_before_view_ = 0;  // file that was added to what one looks at, until it is there; 0: none
  bool preparing_stopped_ = false;     // true: preparing was stopped for a scene that was to be opened
  std::uint64_t next_scene_serial_ = 1;
  std::uint32_t next_file_id_ = 1;
  std::vector<SceneSource> changing_to_;  // files of the scene that is being made; empty: none is made
  struct Change {
    std::vector<SceneSource> files;
    std::string doing;
    Said said;
  };
  Change last_change_;                 // it is under way where changing()
  std::optional<Change> interrupted_;  // change that was under way when another scene was to be opened

  struct Fill {
    std::uint32_t file = 0;
    Flags replaced;  // Gaussians of the present scene that it stands in place of
  };
  std::optional<Fill> filling_;  // of the file that is on its way, or was when the last change failed

  // A scene with everything that was made from it, kept to go back to as a whole.
  struct Kept {
    std::uint64_t step = 0;  // step that left the scene: History::Entry::other_files
    std::shared_ptr<const OpenedScene> scene;
    std::shared_ptr<SceneGraph> graph;
    std::shared_ptr<Session> session;
    std::shared_ptr<CleanObjects> clean;
    std::shared_ptr<const CoarseCloud> coarse;
    History history;
  };
  Kept kept_now(std::uint64_t step) const;
  void keep_before(Kept kept);
  void go_back_to(Kept kept);
  std::vector<Kept> before_files_;  // scenes before changes of files, the newest last
  std::vector<Kept> undone_files_;  // scenes after changes that were undone, the next to redo last
  std::uint64_t redo_steps_ = 0;    // History::steps_serial() for which the last of these may be redone
  std::uint64_t next_step_ = 1;
};

}  // namespace splatcut
