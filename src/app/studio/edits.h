// Commands that change the document, one after the other in the order in which they were asked for.
//
// What passes over the scene's Gaussians (selections, growing, merging) is done on the worker from a snapshot
// of the document; commands that come meanwhile wait their turn. If the document became another one all the
// same, by a cut that ended, the edit is done again on that.
#pragma once

#include <deque>
#include <functional>

#include "app/document/command.h"
#include "app/studio/cut_jobs.h"
#include "app/studio/viewport.h"
#include "app/studio/workspace.h"

namespace splatcut {

class Edits {
 public:
  Edits(Workspace& workspace, const Viewport& viewport, CutJobs& cuts)
      : ws_(workspace), viewport_(viewport), cuts_(cuts) {}

  // Runs it now, or after the edits that were asked for before. kStays: also where these are cancelled.
  enum class OnCancel { kDropped, kStays };
  void in_turn(std::function<void()> command, OnCancel on_cancel = OnCancel::kDropped);
  bool waiting() const { return under_way_; }
  bool cancel();  // what is under way and the edits that wait; false where nothing does
  void reset();   // another scene

  // `after` becomes the document. message: shown when it does.
  void push(std::string title, Document after, std::string merge_key, const std::string& message);
  // The same with an edit that passes over the Gaussians. It returns the message; what it throws is shown as
  // a refusal.
  using Change = std::function<std::string(Document* document, const EditContext& context, const Job& job)>;
  struct Step {
    std::string title, merge_key;
    Change change;
    bool replaces = false;  // the last step, where that has the same merge key: done from the state before it
  };
  void push_later(const Step& step);
  void select_later(Selection region, SetOperation operation, std::string title);

  void perform(const SelectRegion& c);
  void perform(const SelectVolume& c);
  void perform(const SelectColour& c);
  void perform(const SelectRange& c);
  void perform(const PickColour& c);
  void perform(const SelectFlood& c);
  void perform(const SelectScene& c);
  void undo();
  void redo();
  void perform(const JumpHistory& c);
  // Any command that edit() in document_edits.h has; others do nothing.
  template <class C>
  static constexpr bool kKnows = requires(Document* document, const C& c, const EditContext& context) {
    edit(document, c, context);
  };
  void perform_plain(const Command& command);

 private:
  void start(const Step& step);
  void finish();
  template <class C>
  void change_all(const C& c);
  void require_gaussian(std::int32_t gaussian) const;

  Workspace& ws_;
  const Viewport& viewport_;
  CutJobs& cuts_;
  bool under_way_ = false;
  std::uint64_t number_ = 0;  // of the edit that is under way
  struct Waiting {
    std::function<void()> command;
    OnCancel on_cancel;
  };
  std::deque<Waiting> waiting_;
  std::string volume_key_;   // merge key of the last volume's step
  Flags volume_seen_;        // what was shown when it first selected
  std::size_t volumes_ = 0;  // so far
};

}  // namespace splatcut
