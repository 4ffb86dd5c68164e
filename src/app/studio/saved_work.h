// The work file of a session, and the autosave: what is written when, what of it is unsaved, what a crash
// left.
//
// Written on the worker; the window goes on.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "app/document/command.h"
#include "app/studio/viewport.h"
#include "app/studio/workspace.h"
#include "app/work/autosaves.h"
#include "app/work/work_file.h"

namespace splatcut {

class SavedWork {
 public:
  SavedWork(Workspace& workspace, Viewport& viewport);

  void update(double seconds);  // once a frame: the autosave
  void leave();                 // the program ends: an autosave that is not needed goes
  void keep_unsaved();          // it is ended from outside: offered at the next start

  const std::filesystem::path& work_path() const { return work_path_; }
  bool unsaved() const;
  // Unsaved work that a crash left: offered until it is restored, by opening it, or dropped.
  bool autosave_found() const { return !offered().empty(); }
  std::filesystem::path offered() const;  // the work file of that; empty: none
  const std::filesystem::path& own_autosave() const { return autosaves_.own(); }
  // "garden/point_cloud.ply, 2026-03-01 18:40": of which scene, and when it was written.
  const std::string& autosave_says() const { return restorable_says_; }

  // The workspace has another scene and document: those of the file, where there is one.
  void opened(const std::optional<RestoredWork>& work, const std::filesystem::path& file);
  void perform(const SaveWork& c);
  void perform(const DropAutosave&);

 private:
  TaskThread::Work autosaving();
  void look_for_more(double seconds);
  void describe_offered();
  void forget_restored(const std::filesystem::path& file);

  Workspace& ws_;
  Viewport& viewport_;
  std::filesystem::path work_path_;
  Autosaves autosaves_;
  std::filesystem::path restored_;  // left behind by a crash, in this work now: goes once that is saved
  std::string restorable_says_;
  double looked_for_s_ = 0;
  // Serials of the document that is in the files; 0: in none.
  std::uint64_t autosaved_serial_ = 0, saved_serial_ = 0;
  std::uint64_t waiting_serial_ = 0;  // of the document that waits to be autosaved
  double waited_s_ = 0;
  CameraPose autosaved_pose_;
};

}  // namespace splatcut
