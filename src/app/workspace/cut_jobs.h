// Cuts on the worker, started as the document asks for them, and what is known of each cut.
//
// The document decides. Cuts of stale objects start by themselves; a cut that is no longer needed is stopped;
// a cut that was cancelled or failed is not tried again by itself. Labels go to the history. The rest is kept
// beside them, so that the window shows it wherever the history stands.
#pragma once

#include <deque>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>

#include "app/picture/cut_run.h"
#include "app/workspace/workspace.h"

namespace splatcut {

class CutJobs {
 public:
  explicit CutJobs(Workspace& workspace) : ws_(workspace) {}

  // The cut that runs for the object, else the cut whose labels the object has; null: neither is known.
  const CutRun* run(ObjectId object) const;
  ObjectId cutting() const { return running_ ? running_->object : 0; }  // object whose cut runs; 0: none
  std::uint64_t done() const { return done_; }                          // number of cuts finished so far
  std::uint64_t failed() const { return failed_; }  // number of cuts that ended in an error

  // True if the object's labels are on their way: its cut runs, or will. A locked object keeps the cut it
  // has.
  bool comes(const ObjectItem& object) const;
  ObjectId next() const;  // first object of the document whose labels are on their way; 0: none

  void reset();   // stops and forgets everything of the last scene
  void update();  // starts and stops cuts as the document asks; called once a frame
  // Cuts the active object again without anything that is cached. Throws Error if it has no strokes or is
  // locked.
  void recompute();
  // cancel() and cancel_likelihood() stop the running cut, or the likelihood of the active object, and give
  // it up: update() does not start it again. They return false if it does not run.
  bool cancel();
  bool cancel_likelihood();
  // Cuts the active object at other sizes of its last stroke (Stroke::size_step), where they are not known
  // yet and no large part of the scene has to be prepared for them: one at a time while the worker has
  // nothing else to do. What was asked for last is kept until the document asks for it, which then waits for
  // no cut. Called once a frame at most.
  void cut_ahead(std::span<const int> size_steps);
  // True if it is known that the active object's last stroke takes the same at that size as at its own.
  bool changes_nothing(int size_step) const;
  // Draws the active object's thumbnail of that number larger, if the worker has nothing else to do.
  void draw_larger(std::uint64_t card_serial);
  void looked_from(const Camera& camera);  // the person has: sides that it shows are looked at
  // True if the active object's cut is in doubt as the view of its first click crops it. Once the person has
  // seen all of it, from this click on it is not.
  bool doubts_whole() const;
  void saw_whole();
  // The thumbnails of all objects in their order, with what they are in doubt of, to be kept; and what they
  // were when the work that was opened now was saved, for when they are drawn.
  std::vector<DoubtfulSide> doubtful_sides() const;
  void take_doubtful_sides(std::span<const DoubtfulSide> sides);
  // The cut of that key is of a click that asks for what is so already: said if it changes nothing.
  void note_so_already(std::string key) { so_already_ = std::move(key); }
  void pause();  // stops the running cut; update() starts it again once no scene is being opened
  bool given_up(const ObjectItem& object) const;  // its cut was cancelled or failed: no labels come
  // Lets update() start a cut again that was given up.
  void want_again(const ObjectItem& object) { given_up_.erase(ws_.history.keys(object).cut); }

 private:
  struct Known {
    ObjectId object = 0;
    CutRun run;
  };
  // What the worker needs.
  struct Order {
    std::shared_ptr<const OpenedScene> scene;
    std::shared_ptr<Session> session;
    CutRequest request;
    CutSettings settings;
    ObjectId object = 0;
    std::string key;
    Rgb8 colour{};
    std::shared_ptr<const Document> document;  // that asks: what of the cut the object gets
    bool heat = false;                         // the likelihood is shown
    Flags before{};                            // labels before the last stroke, see CutRun::views_before
    std::string key_before{};                  // key of the cut that gave them
    std::uint64_t number = 0;                  // the same key may be cut again
  };

  const std::vector<ViewCard>* cards_known(ObjectId object, const std::string& key) const;
  const CutRun* known_run(ObjectId object, const std::string& key) const;
  CutRun* known_run(ObjectId object, const std::string& key);
  bool runs(const Order& order) const;
  void keep(Known known);
  std::vector<std::string> still_doubted(ObjectId object, std::vector<std::string> doubts) const;
  Order order_for(const ObjectItem& object) const;
  void start(const ObjectItem& object, bool anew = false);
  bool take_known(const Order& order);
  static CutRun cut_of(const Order& order, const Job& job, const OnSnapshot& on_snapshot, CutReach reach);
  void work(const Order& order, const Job& job);
  void look_around(const Order& order, const CutResult& result, const Job& job);
  void show_snapshot(const Order& order, CutRun so_far, double first_mask_ms);
  Flags labels_before(const Order& order, const Flags& shown) const;
  void finish(const Order& order, CutRun run, const Flags& labels);
  void show_views(const Order& order, const Flags& labels, std::vector<ViewCard> cards);
  void end(const std::string& given_up);
  std::optional<int> size_before(ObjectId object) const;
  std::string leap_to(ObjectId object, const CutResult& result) const;
  std::string doubt_to_say(ObjectId object, const CutRun& run);
  void request_likelihood();
  void recall();
  void renew_views();
  void note_before(Order* order) const;
  static Flags kept_from_cuts(const Order& order);
  static CutResult as_object_has_it(const Order& order, const CutResult& result, const Job& job);
  static std::vector<ViewCard> cards_of(const Order& order, const CutResult& result, const Job& job);
  void take_cards(CutRun* run, const Order& order, const std::vector<std::uint8_t>& labels,
                  std::vector<ViewCard> cards);

  Workspace& ws_;
  std::optional<Known> running_;
  std::deque<Known> known_;         // finished cuts, the newest last
  std::deque<Known> opened_;        // cuts of opened work: cards with what they were in doubt of alone
  std::vector<Known> ahead_;        // cuts that were not asked for yet; without a result: one that failed
  std::uint64_t ahead_serial_ = 0;  // History::serial() for which no cut ahead is missing
  std::set<std::string> given_up_;  // keys of cuts that were cancelled or failed
  std::map<ObjectId, std::string> seen_whole_;  // key of the first click of objects of which all was seen
  std::string so_already_;                      // key, see note_so_already()
  std::map<ObjectId, std::vector<std::string>> doubts_said_;  // after the last cut
  std::map<ObjectId, std::string> sides_said_;                // the same, of the pictures of its sides
  mutable LabelCache labels_before_;  // of note_before(), of the object that it was last asked for
  mutable ObjectId labelled_before_ = 0;
  std::uint64_t next_card_serial_ = 1, started_ = 0, done_ = 0, failed_ = 0;
};

}  // namespace splatcut
