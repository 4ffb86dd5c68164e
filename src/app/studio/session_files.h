// Files of a session: those of the opened scene and its work file, the autosave, what is exported.
//
// Scenes and work are read and written on the worker; the window goes on.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "app/studio/autosaves.h"
#include "app/studio/command.h"
#include "app/studio/cut_jobs.h"
#include "app/studio/viewport.h"
#include "app/studio/work_file.h"
#include "app/studio/workspace.h"

namespace splatcut {

class SessionFiles {
 public:
  struct Calls {
    // The workspace has another scene and document, the view is not set up yet. same: the same scene with
    // other files in it, or placed otherwise.
    std::function<void(bool same)> opened;
    std::function<void(std::function<void()>)> in_turn;  // after the edits that were asked for before
  };
  SessionFiles(Workspace& workspace, Viewport& viewport, CutJobs& cuts, Calls calls);

  void update(double seconds);  // once a frame: the autosave
  void leave();                 // the program ends: an autosave that is not needed goes

  const std::filesystem::path& work_path() const { return work_path_; }
  bool unsaved() const;
  // Unsaved work that a crash left: offered until it is restored or dropped.
  bool autosave_found() const { return !offered().empty(); }
  std::filesystem::path offered() const;  // the work file of that; empty: none
  const std::filesystem::path& own_autosave() const { return autosaves_.own(); }
  // "garden/point_cloud.ply, 2026-03-01 18:40": of which scene, and when it was written.
  const std::string& autosave_says() const { return restorable_says_; }

  void cancel_loading();  // the scene stays as it is, its files where they are
  // The last change of the files is taken back, or made again, where that is the next step. False where it is
  // not, or no longer kept.
  bool undo_files();
  bool redo_files();
  bool can_redo_files() const;

  void perform(const OpenScene& c);
  void perform(const AddScene& c);
  void perform(const PlaceScene& c);
  void perform(const RemoveScene& c);
  void perform(const SaveWork& c);
  void perform(const RestoreAutosave&);
  void perform(const DropAutosave&);
  void perform(const Export& c);
  void perform(const SaveSnapshot& c);
  void perform(const SaveTurntable& c);

 private:
  void describe_offered();
  void forget_restored(const std::filesystem::path& file);
  void opened(const std::shared_ptr<OpenedScene>& scene, const std::optional<RestoredWork>& work,
              const std::filesystem::path& work_path);
  void start_preparing();
  void stop_for_loading();
  void take(const std::shared_ptr<const OpenedScene>& scene);
  // Files of the scene as they are to be, those under way included.
  std::vector<SceneSource> wanted_files() const;
  SceneSource& added_file(std::vector<SceneSource>* files, std::uint32_t id) const;
  void change_files(std::vector<SceneSource> files, const std::string& doing, const std::string& done);
  void carry_document(const std::shared_ptr<OpenedScene>& scene, const std::string& done);
  void files_changed(const std::shared_ptr<OpenedScene>& scene, History history, const std::string& done);

  Workspace& ws_;
  Viewport& viewport_;
  CutJobs& cuts_;
  Calls calls_;
  std::filesystem::path work_path_;
  Autosaves autosaves_;
  std::filesystem::path restored_;  // left behind by a crash, in this work now: goes once that is saved
  std::string restorable_says_;
  bool preparing_stopped_ = false;  // for a scene that was to be opened
  // Serials of the document that is in the files; 0: in none.
  std::uint64_t autosaved_serial_ = 0, saved_serial_ = 0;
  std::uint64_t waiting_serial_ = 0;  // of the document that waits to be autosaved
  double waited_s_ = 0;
  CameraPose autosaved_pose_;
  std::uint64_t next_scene_serial_ = 1;
  std::uint32_t next_file_id_ = 1;
  std::vector<SceneSource> changing_to_;  // files of the scene that is being made; empty: none is

  // A scene with all that is made of it and of it alone: to go back to as a whole.
  struct Kept {
    std::uint64_t step = 0;  // before or after which it was; History::Entry::other_files
    std::shared_ptr<const OpenedScene> scene;
    std::shared_ptr<const PreparedScene> prepared;
    std::shared_ptr<Session> session;
    std::shared_ptr<const CoarseCloud> coarse;
    History history;
  };
  Kept kept_now(std::uint64_t step) const;
  void go_back_to(Kept kept);
  std::vector<Kept> before_files_;  // the newest last
  std::vector<Kept> undone_files_;
  std::uint64_t redo_serial_ = 0;  // of the document after which the last of these may be made again
  std::uint64_t next_step_ = 1;
};

}  // namespace splatcut
