// Commands that change the document, performed one after the other in the order in which they were asked for.
//
// Edits that pass over the scene's Gaussians (selections, growing, merging) run on the worker from a snapshot
// of the document; commands that come meanwhile wait their turn. If the document changes all the same,
// because a cut ends, the edit runs again on the new document. What takes from an object's Gaussians or works
// on all of them waits for the cut that is to find them; what only adds some does not.
#pragma once

#include <deque>
#include <functional>

#include "app/document/command.h"
#include "app/workspace/cut_jobs.h"
#include "app/workspace/viewport.h"
#include "app/workspace/workspace.h"

namespace splatcut {

class Edits {
 public:
  Edits(Workspace& workspace, const Viewport& viewport, CutJobs& cuts)
      : ws_(workspace), viewport_(viewport), cuts_(cuts) {}

  // Fate of a waiting command if the edits before it are cancelled. kWithFile: another scene, which is opened
  // once a file is written; it is dropped with a file that waits for a cut, and stays with all others.
  enum class OnCancel { kDropped, kStays, kWithFile };
  // Runs the command now, or after the edits that were asked for before it. writes: name of a command that
  // writes a file; empty: it writes none.
  void in_turn(std::function<void()> command, OnCancel on_cancel = OnCancel::kDropped,
               std::string writes = {});
  // Runs the command now, or when no command waits any more that another scene would drop.
  void at_last(std::function<void()> command);
  // Runs the command once no cut is on its way; commands that come meanwhile wait their turn. If a cut fails,
  // the command is dropped, and that is said. No edit may be under way. title: name of the command, for
  // messages; writes_file: as the command's trait.
  void after_cuts(const std::string& title, std::function<void()> command, bool writes_file = false);
  // Runs the command now if it adds to an object, else as after_cuts() does.
  void once_cut(SetOperation operation, const std::string& title, std::function<void()> command);
  void update();                               // runs what waits for cuts; called once a frame
  bool waiting() const { return under_way_; }  // true: an edit is under way, or waits for cuts
  bool waits_for_cuts() const { return for_cuts_ != nullptr; }
  bool file_waits() const { return !files_waiting().empty(); }  // true: a file is yet to be written
  // Cancels that edit and the waiting commands that do not stay. Returns false if no edit is under way.
  bool cancel();
  // What is to be said of files that cancel() would drop: a file that waits for a cut is not written, and
  // another scene that waits for it is not opened. Begins with ". "; empty: it drops none.
  std::string dropped_by_cancel() const;
  // Cancels and forgets everything of the last scene; same: of its last files, and what stays waits on.
  void reset(bool same);

  // Makes `after` the document and shows the message.
  void push(std::string title, Document after, std::string merge_key, const std::string& message);
  // An edit that passes over the Gaussians. It changes the document and returns the message; an Error that it
  // throws is shown as a refusal.
  using Change = std::function<std::string(Document* document, const EditContext& context, const Job& job)>;
  struct Step {
    std::string title, merge_key;
    Change change;
    // True: starts from the state before the last step, if that step has the same merge key.
    bool replaces = false;
  };
  void push_later(const Step& step);  // runs the step on the worker, then makes its result the document
  void push_once_cut(SetOperation operation, const Step& step);  // push_later() as once_cut() does
  // Combines the active object with a selection, as a step on the worker.
  void select_later(Selection region, SetOperation operation, std::string title);
  // An edit is under way from now on whose step is yet to be found out on Workspace::tasks. Returns its
  // number.
  std::uint64_t begin();
  // Ends it: runs `last`, which may go on with push_later(). Nothing if the edit was cancelled.
  void end(std::uint64_t number, const std::function<void()>& last = {});

  void perform(const SelectRegion& c);
  void perform(const SelectVolume& c);
  void perform(const SelectColour& c);
  void perform(const SelectRange& c);
  void perform(const PickColour& c);
  void perform(const SelectFlood& c);
  void perform(const SelectScene& c);
  void undo();
  void redo();
  // True for commands that have an edit(), see command.h. perform_plain() performs these and ignores others.
  template <class C>
  static constexpr bool kKnows = requires(Document* document, const C& c, const EditContext& context) {
    edit(document, c, context);
  };
  void perform_plain(const Command& command);

 private:
  void start(const Step& step);
  void finish();
  bool scene_waits_for_cuts() const;               // another scene waits for a file that waits for a cut
  std::vector<std::string> files_waiting() const;  // names of the commands that are to write them
  template <class C>
  void change_all(const C& c);
  void require_gaussian(std::int32_t gaussian) const;
  TakenBy taken_by() const;  // what the view says

  Workspace& ws_;
  const Viewport& viewport_;
  CutJobs& cuts_;
  bool under_way_ = false;
  std::uint64_t number_ = 0;        // number of the edit that is under way
  std::function<void()> for_cuts_;  // command that waits for cuts; null: none does
  std::string for_cuts_title_;
  bool for_cuts_writes_ = false;
  std::uint64_t cuts_failed_ = 0;  // CutJobs::failed() when it began to wait
  std::vector<std::string> lost_;  // names of files_waiting() that another scene dropped; not said yet
  struct Waiting {
    std::function<void()> command;
    OnCancel on_cancel;
    std::string writes;  // as in in_turn()
  };
  std::deque<Waiting> waiting_;
  std::string volume_key_;   // merge key of the last volume's step
  Flags volume_seen_;        // Gaussians that were shown when that volume first selected
  std::size_t volumes_ = 0;  // number of volumes so far
};

}  // namespace splatcut
