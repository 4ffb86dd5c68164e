#include "app/workspace/cut_jobs.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>

#include "app/document/words.h"
#include "app/picture/cut_pictures.h"
#include "app/picture/cut_sentences.h"
#include "app/tools/actions.h"
#include "core/error.h"
#include "core/stage_clock.h"
#include "segment/session/doubts.h"

namespace splatcut {

const CutRun* CutJobs::known_run(ObjectId object, const std::string& key) const {
  const auto found = std::ranges::find_if(
      known_, [&](const Known& known) { return known.object == object && known.run.key == key; });
  return found == known_.end() ? nullptr : &found->run;
}

CutRun* CutJobs::known_run(ObjectId object, const std::string& key) {
  return const_cast<CutRun*>(std::as_const(*this).known_run(object, key));
}

bool CutJobs::runs(const Order& order) const {
  return running_ && order.scene == ws_.scene && order.number == started_;
}

const CutRun* CutJobs::run(ObjectId object) const {
  if (running_ && running_->object == object) return &running_->run;
  const ObjectItem* item = ws_.document().find(object);
  return item ? known_run(object, item->cut_key) : nullptr;
}

bool CutJobs::comes(const ObjectItem& object) const {
  if (object.locked && object.cut) return false;  // another method changes it no more than a click does
  const std::string& key = ws_.history.keys(object).cut;
  return is_stale(object, key) && !given_up_.contains(key);
}

bool CutJobs::given_up(const ObjectItem& object) const {
  const std::string& key = ws_.history.keys(object).cut;
  return is_stale(object, key) && given_up_.contains(key);
}

ObjectId CutJobs::next() const {
  for (const ObjectItem& object : ws_.document().objects)
    if (comes(object)) return object.id;
  return 0;
}

// Cuts that no object shows now are kept for undo and redo, the last few: one that is forgotten has no
// pictures of its views then, as in opened work.
void CutJobs::keep(Known fresh) {
  fresh.run.doubts = still_doubted(fresh.object, std::move(fresh.run.doubts));
  constexpr std::ptrdiff_t kMostHidden = 24;
  std::erase_if(known_,
                [&](const Known& k) { return k.object == fresh.object && k.run.key == fresh.run.key; });
  known_.push_back(std::move(fresh));
  const auto hidden = [this](const Known& k) {
    const ObjectItem* item = ws_.document().find(k.object);
    return !item || item->cut_key != k.run.key;
  };
  for (auto left = std::ranges::count_if(known_, hidden) - kMostHidden; left > 0; --left)
    known_.erase(std::ranges::find_if(known_, hidden));
}

void CutJobs::reset() {
  ws_.tasks.cancel(TaskKind::kCut);
  running_.reset();
  known_.clear();
  opened_.clear();
  ahead_.clear();
  ahead_serial_ = 0;
  given_up_.clear();
  doubts_said_.clear();
  seen_whole_.clear();
  sides_said_.clear();
  labels_before_.clear();
}

void CutJobs::update() {
  if (!ws_.session || ws_.tasks.busy(TaskKind::kLoad)) return;
  const Document& document = ws_.document();
  if (running_) {
    const ObjectItem* object = document.find(running_->object);
    if (object && ws_.history.keys(*object).cut == running_->run.key) return;
    ws_.tasks.cancel(TaskKind::kCut);
    end({});
  }
  if (const ObjectId object = next()) return start(*document.find(object));
  recall();
  renew_views();
  request_likelihood();
}

void CutJobs::recompute() {
  const ObjectItem* object = ws_.document().active_object();
  if (!object || object->views.empty()) throw Error("", "The object has no strokes", "Click on it first");
  if (object->locked) throw Error(object->name, "is locked", "Unlock it in the objects panel");
  want_again(*object);
  ws_.session = std::make_shared<Session>(ws_.session->scene());  // with empty caches
  ahead_.clear();
  ahead_serial_ = 0;
  start(*object, true);
}

bool CutJobs::cancel() {
  if (!running_) return false;
  ws_.tasks.cancel(TaskKind::kCut);
  end(std::string(running_->run.key));
  return true;
}

bool CutJobs::cancel_likelihood() {
  const ObjectItem* object = ws_.document().active_object();
  CutRun* run = object && ws_.view.heat ? known_run(object->id, object->cut_key) : nullptr;
  if (!run || run->likelihood || run->likelihood_failed || !ws_.tasks.busy(TaskKind::kCut)) return false;
  run->likelihood_failed = true;
  ws_.tasks.cancel(TaskKind::kCut);
  return true;
}

void CutJobs::pause() {
  ws_.tasks.cancel(TaskKind::kCut);
  if (running_) end({});
}

// Forgets what runs; what the object had before is shown again. given_up: its key, not tried again by itself.
void CutJobs::end(const std::string& given_up) {
  if (!given_up.empty()) given_up_.insert(given_up);
  running_.reset();
  ++ws_.view_serial;
}

CutJobs::Order CutJobs::order_for(const ObjectItem& object) const {
  return {ws_.scene,
          ws_.session,
          cut_request(ws_.document(), object),
          cut_settings(ws_.document(), object),
          object.id,
          cut_key(ws_.document(), object),
          object.colour,
          std::make_shared<const Document>(ws_.document()),
          ws_.view.heat};
}

// anew: whatever is known of such a cut.
void CutJobs::start(const ObjectItem& object, bool anew) {
  const CutRun* before = run(object.id);
  CutRun run;
  run.running = true;
  Order order = order_for(object);
  note_before(&order);
  order.number = ++started_;
  run.key = order.key;
  if (before) {  // shown until there is something newer
    run.views = before->views;
    run.views_of_before = !run.views.empty();
    run.meanings = before->meanings;
    run.sizes = before->sizes;
  }
  running_ = Known{object.id, std::move(run)};
  // If the labels have arrived already, only pictures or the heat map failed: the cut stands.
  const auto failed = [this, order] {
    if (!runs(order)) return;
    end(order.key);
    ++failed_;
  };
  for (const TaskKind kind : {TaskKind::kHover, TaskKind::kClean, TaskKind::kSeen}) ws_.tasks.cancel(kind);
  if (anew || !take_known(order))
    ws_.tasks.submit({TaskKind::kCut, failed}, [this, order](const Job& job) { work(order, job); });
}

// Ends the cut at once where its result is there, cut ahead or seen before: the same, as a session's cuts
// depend on nothing but request and settings.
bool CutJobs::take_known(const Order& order) {
  const auto is_it = [&](const Known& k) {
    return k.object == order.object && k.run.key == order.key && k.run.result;
  };
  const auto ahead = std::ranges::find_if(ahead_, is_it);
  const auto before = std::ranges::find_if(known_, is_it);
  if (ahead == ahead_.end() && before == known_.end()) return false;
  CutRun run = before != known_.end() ? before->run : ahead->run;
  run.first_mask_ms = run.total_ms = 0;  // what was there cost nothing
  run.changed_nothing = false;
  const std::shared_ptr<const CutResult> result = run.result;
  const bool drawn = run.views_drawn && !run.views.empty();
  finish(order, std::move(run), make_flags(result->labels));
  if (drawn) return true;  // renew_views() draws them again where they are to show another change
  ws_.tasks.submit(TaskKind::kCut,
                   [this, order, result](const Job& job) { look_around(order, *result, job); });
  return true;
}

void CutJobs::cut_ahead(std::span<const int> size_steps) {
  const ObjectItem* object = ws_.document().active_object();
  if (!object || running_ || ahead_serial_ == ws_.history.serial() || !ws_.tasks.idle()) return;
  std::vector<Order> wanted;
  for (const int step : size_steps) {
    ObjectItem other = *object;
    last_stroke(&other.views)->size_step = step;
    wanted.push_back(order_for(other));
  }
  const auto is_of = [](const Known& k, const Order& o) {
    return k.object == o.object && k.run.key == o.key;
  };
  std::erase_if(ahead_, [&](const Known& k) {
    return std::ranges::none_of(wanted, [&](const Order& o) { return is_of(k, o); });
  });
  const auto next = std::ranges::find_if_not(wanted, [&](const Order& o) {
    const CutRun* before = known_run(o.object, o.key);
    return (before && before->result) ||
           std::ranges::any_of(ahead_, [&](const Known& k) { return is_of(k, o); });
  });
  if (next == wanted.end()) {
    ahead_serial_ = ws_.history.serial();
    return;
  }
  const auto keep_ahead = [this, order = *next](CutRun run) {
    if (order.scene == ws_.scene && order.session == ws_.session)
      ahead_.push_back({order.object, std::move(run)});
  };
  CutRun nothing;
  nothing.key = next->key;
  ws_.tasks.submit(TaskKind::kAhead,
                   [this, keep_ahead, order = *next, run = nothing](const Job& job) mutable {
                     try {
                       run = cut_of(order, job, {}, CutReach::kSmall);
                     } catch (const std::exception&) {  // it is said where it is asked for
                     }
                     if (!job.cancelled()) ws_.tasks.post([keep_ahead, run] { keep_ahead(run); });
                   });
}

// A cut with what is said of it; without a result if cancelled.
CutRun CutJobs::cut_of(const Order& order, const Job& job, const OnSnapshot& on_snapshot, CutReach reach) {
  const auto start = std::chrono::steady_clock::now();
  CutRun done;
  done.key = order.key;
  const auto result = std::make_shared<const CutResult>(
      order.session->cut(order.request, order.settings, job, on_snapshot, reach));
  if (result->outcome == Outcome::kCancelled || job.cancelled()) return done;
  done.result = result;
  done.total_ms = ms_since(start);
  const KeptFromCuts kept{*order.session, kept_from_cuts(order)};
  done.meanings = meanings_of(order.request, *result, kept, job);
  done.sizes = sizes_of(order.request, *result, kept, job);
  done.doubts = doubts_of(*result);
  return done;
}

// On the worker.
void CutJobs::work(const Order& order, const Job& job) {
  const auto start = std::chrono::steady_clock::now();
  std::size_t shown = 0;  // views of this cut
  const auto snapshot = [&](CutPhase, const CutResult& result) {
    if (result.labels.empty()) return;
    const double first_mask_ms = shown == 0 ? ms_since(start) : 0;
    CutRun so_far;
    if (shown == 0) {
      const KeptFromCuts kept{*order.session, kept_from_cuts(order)};
      so_far.meanings = meanings_of(order.request, result, kept, job);
      so_far.sizes = sizes_of(order.request, result, kept, job);
    }
    for (; shown < result.views.size(); ++shown)
      so_far.views.push_back(mask_card(result.views[shown], order.colour));
    so_far.stages = result.stages;
    so_far.preview = make_flags(result.labels);
    ws_.tasks.post([this, order, so_far, first_mask_ms] { show_snapshot(order, so_far, first_mask_ms); });
  };
  const CutRun done = cut_of(order, job, snapshot, CutReach::kAnywhere);
  if (!done.result) return;
  ws_.tasks.post([this, order, done, cut = make_flags(done.result->labels)] { finish(order, done, cut); });
  look_around(order, *done.result, job);
}

// The cutout is on the screen; the rest is for looking at.
void CutJobs::look_around(const Order& order, const CutResult& result, const Job& job) {
  if (order.heat) {
    const auto likelihood = std::make_shared<const std::vector<float>>(
        order.session->likelihood_of(order.request, order.settings, job));
    if (job.cancelled()) return;
    ws_.tasks.post([this, order, likelihood] {
      CutRun* run = order.scene == ws_.scene ? known_run(order.object, order.key) : nullptr;
      if (run) run->likelihood = likelihood;
      ++ws_.view_serial;
    });
  }
  const CutResult own = as_object_has_it(order, result, job);
  std::vector<ViewCard> cards = cards_of(order, own, job);
  if (job.cancelled()) return;
  ws_.tasks.post([this, order, labels = make_flags(own.labels), cards = std::move(cards)] {
    show_views(order, labels, cards);
  });
}

void CutJobs::show_snapshot(const Order& order, CutRun so_far, double first_mask_ms) {
  if (!runs(order)) return;
  CutRun& now = running_->run;
  if (first_mask_ms > 0) {
    now.first_mask_ms = first_mask_ms;
    now.meanings = std::move(so_far.meanings);
    now.sizes = std::move(so_far.sizes);
  }
  for (ViewCard& card : so_far.views) {
    if (now.views_of_before) break;  // else one would see little but thumbnails come and go
    card.serial = next_card_serial_++;
    now.views.push_back(std::move(card));
  }
  now.stages = std::move(so_far.stages);
  now.preview = std::move(so_far.preview);
  ++ws_.view_serial;
}

// What the cut is compared with. A cut may be made twice: after a stroke what counts is what was before it.
// After undo it is what was left; where that was not computed, as in restored work, nothing.
Flags CutJobs::labels_before(const Order& order, const Flags& shown) const {
  const History& history = ws_.history;
  const Document* left = history.left();
  const Document* last = left                    ? left
                         : is_of_stroke(history) ? &history.entries()[history.cursor() - 1].document
                                                 : nullptr;
  const ObjectItem* item = last ? last->find(order.object) : nullptr;
  if (!last || (item && cut_key(*last, *item) == order.key)) return shown;  // the step was another object's
  const bool known = item && !(left && is_stale(*left, *item));
  return make_flags(known ? labels_of(*last, *item, ws_.gaussians())
                          : std::vector<std::uint8_t>(ws_.gaussians(), 0));
}

// The size step of the object's last stroke before the last step, which changed it; none: that was another
// step, or what was before it was not computed.
std::optional<int> CutJobs::size_before(ObjectId object) const {
  const History& history = ws_.history;
  if (history.left() || !history.can_undo()) return {};
  const Document& last = history.entries()[history.cursor() - 1].document;
  const ObjectItem *was = last.find(object), *is = history.now().find(object);
  if (!was || !was->cut || is_stale(last, *was)) return {};
  const Stroke *stroke_then = last_stroke(was->views), *stroke = last_stroke(is->views);
  const bool same_strokes = stroke_count(*was) == stroke_count(*is) && was->choice == is->choice;
  if (!same_strokes || !stroke_then || stroke->size_step == stroke_then->size_step) return {};
  return stroke_then->size_step;
}

// What is said where the last step, one to the next size, took quite another extent. Not where the step
// before was not computed: there may be sizes between.
std::string CutJobs::leap_to(ObjectId object, const CutResult& result) const {
  const std::optional<int> before = size_before(object);
  const ObjectItem& now = *ws_.document().find(object);
  if (!before || std::abs(last_stroke(now.views)->size_step - *before) != 1) return {};
  const Document& last = ws_.history.entries()[ws_.history.cursor() - 1].document;
  return leap_of_size(count_flags(*last.find(object)->cut), count_flags(result.labels));
}

void CutJobs::finish(const Order& order, CutRun run, const Flags& labels) {
  if (!runs(order)) return;
  const CutRun& now = running_->run;
  if (!run.views_drawn) run.views = now.views;
  for (ViewCard& card : run.views)
    if (!run.views_drawn) card.doubt.clear();  // it was about another cut
  run.stages = run.result->stages.empty() ? now.stages : run.result->stages;
  run.first_mask_ms = now.first_mask_ms == 0 ? run.total_ms : now.first_mask_ms;
  const std::shared_ptr<const CutResult> result = run.result;
  run.doubts = still_doubted(order.object, std::move(run.doubts));
  const std::string doubt = doubt_to_say(order.object, run);
  const double seconds = run.total_ms / 1000;
  running_.reset();
  ++done_;
  const auto labels_of_item = [&](const ObjectItem& item) {
    return ws_.labels.labels(ws_.document(), item, ws_.gaussians());
  };
  const auto labels_now = [&] {
    const ObjectItem* item = ws_.document().find(order.object);
    return item ? labels_of_item(*item) : nullptr;
  };
  const Flags shown = labels_now();
  const std::string leap = shown ? leap_to(order.object, *result) : "";
  const bool cut_already = shown && !is_stale(*ws_.document().find(order.object), order.key);
  ws_.history.set_cut(order.object, order.key, labels);
  keep({order.object, std::move(run)});
  if (!shown) return;  // the object is gone; undo may bring it back
  const std::string& name = ws_.document().find(order.object)->name;
  if (result->outcome == Outcome::kNothingFound)
    return ws_.say(Message::Kind::kRefused, name + ": " + result->reason);
  const bool stroked = is_of_stroke(ws_.history);
  const Flags before = cut_already && !stroked ? shown : labels_before(order, shown);
  const bool so_already = so_already_ == order.key;
  if (stroked && *before == *labels_now() && count_flags(*before) > 0) {
    if (CutRun* kept = known_run(order.object, order.key)) kept->changed_nothing = true;
    return ws_.say(Message::Kind::kRefused,
                   fmt::format("{}: {}, as before: {}", name, gaussians_text(count_flags(*before)),
                               so_already ? why_so_already(order.request, *result)
                                          : "that changed nothing. Click nearer to what is wrong, come "
                                            "nearer, or draw over it"));
  }
  if (!cut_already && size_before(order.object) && *before == *labels_now())
    return ws_.say(Message::Kind::kInfo, fmt::format("{}: {}, as before: this size changes nothing here",
                                                     name, gaussians_text(count_flags(*before))));
  const std::string changed = what_changed(*before, *labels_now(), seconds);
  const std::string box =
      *before == *labels_now() ? "" : added_by_box(ws_.history, order.object, ws_.context());
  const std::string shared = box + shared_with(ws_.document(), order.object, labels_of_item);
  const bool little = so_already && changed_little(*before, *labels_now());
  // What left is no part of the place that was clicked, which shows something else: hovering agrees.
  const bool beside =
      last_stroke(order.request.strokes)->label == SeedLabel::kRest && *before != *labels_now();
  // At the second such click alone: at the third it has been said.
  const bool piecemeal = beside && small_removals(ws_.history, order.object, ws_.gaussians()) == 2;
  const std::string but = piecemeal ? fmt::format(
                                          "clicks there take little each: with Scribble ({}) hold the "
                                          "right button and drag across all that does not belong",
                                          keys_of(Action::kToolScribble))
                          : !doubt.empty() ? doubt
                          : little && beside
                              ? "that lay beside the clicked place. To remove more, right-click where the "
                                "outline is red"
                          : little ? why_so_already(order.request, *result, *before != *labels_now())
                                   : "";
  const std::string hint =
      ws_.tools.scale_armed() ? wheel_hint(order.request, *result, *before, *labels_now()) : "";
  ws_.say(but.empty() ? Message::Kind::kDone : Message::Kind::kInfo,
          fmt::format("{}: {}{}{}{}{}", name, changed, leap, shared, but.empty() ? "" : ". But " + but,
                      but.empty() || result->spot_alone ? hint : ""));
}

// The first doubt that was not said after the cut before. What is doubted of a click is said each time.
std::string CutJobs::doubt_to_say(ObjectId object, const CutRun& run) {
  std::vector<std::string>& said = doubts_said_[object];
  const auto first = std::ranges::find_if(run.doubts, [&](const std::string& doubt) {
    return run.result->spot_alone || std::ranges::find(said, doubt) == said.end();
  });
  std::string doubt = first == run.doubts.end() ? std::string() : *first;
  said = run.doubts;
  return doubt;
}

void CutJobs::show_views(const Order& order, const Flags& labels, std::vector<ViewCard> cards) {
  CutRun* run = order.scene == ws_.scene ? known_run(order.object, order.key) : nullptr;
  if (!run) return;
  take_cards(run, order, *labels, std::move(cards));
  if (*labels != run->result->labels) {
    run->views_labels = labels;
    run->doubts.clear();  // they are about all that was cut
  }
  const ObjectItem* object = ws_.document().find(order.object);
  std::string& said = sides_said_[order.object];
  if (!add_doubt_of_sides(run)) return said.clear();
  const std::string& doubt = run->doubts.back();
  if (doubt == said && std::ranges::none_of(run->views, &ViewCard::doubt_of_stroke)) return;
  if (!object || object->cut_key != order.key || run->changed_nothing) return;
  const Flags now = ws_.labels.labels(ws_.document(), *object, ws_.gaussians());
  if (*now != *labels) return;  // they are drawn again, see renew_views()
  said = doubt;
  ws_.say_also(Message::Kind::kInfo, object->name + ": " + doubt);
}

}  // namespace splatcut
