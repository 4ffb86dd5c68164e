// Saved work: the user's work file, the autosave, what is unsaved, and what a crash left.
//
// The worker writes the files; the window goes on.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <set>
#include <string>

#include "app/document/command.h"
#include "app/work/autosaves.h"
#include "app/work/left_work.h"
#include "app/work/work_file.h"
#include "app/workspace/viewport.h"
#include "app/workspace/workspace.h"

namespace splatcut {

class SavedWork {
 public:
  SavedWork(Workspace& workspace, Viewport& viewport, const CutJobs& cuts);

  void update(double seconds);  // writes the autosave when it is due; called once a frame
  // Removes the autosave, or writes it if work is unsaved; called when the program ends.
  void leave();
  void keep_unsaved();  // writes the autosave if work is unsaved; called when a signal ends the program

  void keep_from_other_scene();  // another scene comes: offers what is unsaved, as after a crash

  const std::filesystem::path& work_path() const { return work_path_; }  // the user's file; empty: none yet
  bool unsaved() const;
  std::size_t saves() const { return saves_; }  // files that the user had written since the program began
  // Unsaved work that crashes left is offered until the user restores it, by opening its file, or drops it:
  // that of the scene that is open first, then the newest.
  const std::vector<LeftWork>& offers() const { return offers_; }
  std::size_t own_offers() const { return own_offers_; }  // number of those of the scene that is open
  const std::filesystem::path& own_autosave() const { return autosaves_.own(); }

  // Notes that the workspace has another scene and document. work, file: the work file that they come from,
  // if any.
  void opened(const std::optional<RestoredWork>& work, const std::filesystem::path& file);
  void perform(const SaveWork& c);
  void perform(const DropAutosave& c);

 private:
  TaskThread::Work autosaving();
  // Makes the picture of what the view shows, on any thread; an empty one if nothing is drawn yet.
  std::function<Image<Rgb8>()> small_picture() const;
  WorkView seen() const;                         // what the window shows
  bool differs() const;                          // the document does from the saved one
  bool is_work(const Document& document) const;  // it, or the scene's files, are more than a scene as opened
  void keep_as_saved(std::uint64_t serial, const Document& document, std::uint64_t scene);
  void look_for_more(double seconds);
  void find_offers();
  void sort_offers();
  void forget_restored(const std::filesystem::path& file);

  Workspace& ws_;
  Viewport& viewport_;
  const CutJobs& cuts_;
  std::filesystem::path work_path_;
  Autosaves autosaves_;
  // File that a crash left and that the user opened; it is removed once the work is in another file.
  std::filesystem::path restored_;
  // Files of work that is still written, see keep_from_other_scene(): none of them is offered yet.
  std::set<std::filesystem::path> keeping_;
  std::vector<LeftWork> offers_;
  std::size_t own_offers_ = 0;
  std::uint64_t next_offer_serial_ = 1;
  double looked_for_s_ = 0;
  // Serials of the documents that the autosave and the user's file hold; 0: the file holds none.
  std::uint64_t autosaved_serial_ = 0, saved_serial_ = 0;
  Document saved_document_;        // that of saved_serial_, if that is not 0
  bool saved_is_work_ = false;     // is_work() of what was saved or opened last
  std::uint64_t saved_scene_ = 0;  // OpenedScene::serial of its scene
  // Serial of the last document that was compared with it, and whether that differs.
  mutable std::uint64_t compared_serial_ = 0;
  mutable bool differs_ = false;
  std::uint64_t waiting_serial_ = 0;  // serial of the document that waits to be autosaved
  // Since the last change; since the first one that the autosave lacks; since the last writing ended.
  double quiet_s_ = 0, unkept_s_ = 0, rested_s_ = 0;
  double written_in_s_ = 0;
  std::size_t saves_ = 0;
  WorkView autosaved_view_;
};

}  // namespace splatcut
