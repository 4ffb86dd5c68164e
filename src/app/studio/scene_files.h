// Files that the window's scene is made of: opened, added, placed, taken out, undone as a whole, and
// prepared.
//
// Scenes are read and prepared on the worker; the window goes on.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "app/document/command.h"
#include "app/studio/cut_jobs.h"
#include "app/studio/saved_work.h"
#include "app/studio/viewport.h"
#include "app/studio/workspace.h"

namespace splatcut {

class SceneFiles {
 public:
  struct Calls {
    // The workspace has another scene and document, the view is not set up yet. same: the same scene with
    // other files in it, or placed otherwise.
    std::function<void(bool same)> opened;
    std::function<void(std::function<void()>)> in_turn;  // after the edits that were asked for before
  };
  SceneFiles(Workspace& workspace, Viewport& viewport, CutJobs& cuts, SavedWork& work, Calls calls);

  void update();          // once a frame: preparing goes on where a scene could not be opened
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

 private:
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
  SavedWork& work_;
  Calls calls_;
  bool preparing_stopped_ = false;  // for a scene that was to be opened
  std::uint64_t next_scene_serial_ = 1;
  std::uint32_t next_file_id_ = 1;
  std::vector<SceneSource> changing_to_;  // files of the scene that is being made; empty: none is

  // A scene with all that is made of it and of it alone: to go back to as a whole.
  struct Kept {
    std::uint64_t step = 0;  // before or after which it was; History::Entry::other_files
    std::shared_ptr<const OpenedScene> scene;
    std::shared_ptr<SceneGraph> graph;
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
