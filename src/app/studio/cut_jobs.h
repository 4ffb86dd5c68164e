// Cuts what the document asks for, on the worker, and keeps what is known of each cut.
//
// The document decides: the cut of a stale object is started, one that is no longer needed is stopped, one
// that was cancelled or failed is not tried again by itself. Labels go to the history, the rest is shown with
// them wherever the history stands.
#pragma once

#include <deque>
#include <optional>
#include <set>
#include <string>

#include "app/studio/cut_run.h"
#include "app/studio/workspace.h"

namespace splatcut {

class CutJobs {
 public:
  explicit CutJobs(Workspace& workspace) : ws_(workspace) {}

  // The cut that runs for the object, else the one whose labels it has; null: none is known.
  const CutRun* run(ObjectId object) const;
  ObjectId cutting() const { return running_ ? running_->object : 0; }
  std::uint64_t done() const { return done_; }  // cuts so far

  void reset();   // another scene
  void update();  // once a frame
  // Throws Error where there is nothing to cut yet.
  void recompute();
  // What runs, or the likelihood of the active object, is not tried again by itself. False where neither
  // does.
  bool cancel();
  bool cancel_likelihood();
  void pause();  // what runs stops and starts anew once no scene is being opened
  void want_again(const ObjectItem& object) { given_up_.erase(ws_.history.keys(object).cut); }

 private:
  struct Known {
    ObjectId object = 0;
    CutRun run;
  };
  struct Order;

  const CutRun* known_run(ObjectId object, const std::string& key) const;
  CutRun* known_run(ObjectId object, const std::string& key);
  bool runs(const Order& order) const;
  void keep(Known known);
  void start(const ObjectItem& object);
  void work(const Order& order, const Job& job);
  void show_snapshot(const Order& order, CutRun so_far, double first_mask_ms);
  void finish(const Order& order, CutRun run, const Flags& labels);
  void show_views(const Order& order, std::vector<ViewCard> cards);
  void end(const std::string& given_up);
  void request_likelihood();
  void recall();

  Workspace& ws_;
  std::optional<Known> running_;
  std::deque<Known> known_;         // the newest last
  std::set<std::string> given_up_;  // keys that were cancelled or failed
  std::uint64_t next_card_serial_ = 1, started_ = 0, done_ = 0;
};

}  // namespace splatcut
