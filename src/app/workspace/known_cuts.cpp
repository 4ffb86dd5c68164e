// What is computed of a cut that is known: its pictures and sentences once more, after its file was opened or
// a hand has changed it, and the likelihood for the heat map.
#include <algorithm>
#include <iterator>
#include <tuple>

#include "app/picture/cut_pictures.h"
#include "app/picture/cut_sentences.h"
#include "app/workspace/cut_jobs.h"
#include "segment/session/doubts.h"

namespace splatcut {

// Labels of opened work, or of a step that undo went back to, are there without what is known of their cut:
// it is made again to look at, its views and sizes. The labels stay, also where an older program made them.
void CutJobs::recall() {
  const ObjectItem* object = ws_.document().active_object();
  if (!object || !object->cut || object->views.empty() || object->cut_kept || ws_.tasks.busy(TaskKind::kCut))
    return;
  if (known_run(object->id, object->cut_key) || is_stale(*object, ws_.history.keys(*object).cut)) return;
  Order order = order_for(*object);
  note_before(&order);
  const auto know = [this, order](CutRun run, std::vector<ViewCard> cards) {
    if (order.scene != ws_.scene || known_run(order.object, order.key)) return;
    take_cards(&run, order, run.views_labels ? *run.views_labels : std::vector<std::uint8_t>(),
               std::move(cards));
    add_doubt_of_sides(&run);
    keep({order.object, std::move(run)});
    ++ws_.view_serial;
  };
  CutRun nothing;
  nothing.key = order.key;
  const auto failed = [know, nothing] { know(nothing, {}); };  // not tried again
  ws_.tasks.submit({TaskKind::kCut, failed},
                   [this, know, failed, order, labels = object->cut](const Job& job) {
                     CutRun run = cut_of(order, job, {}, CutReach::kAnywhere);
                     if (!run.result) return;
                     if (run.result->labels != *labels) return ws_.tasks.post(failed);
                     run.stages = run.result->stages;
                     run.total_ms = 0;  // nobody waited for it
                     const CutResult own = as_object_has_it(order, *run.result, job);
                     if (own.labels != run.result->labels) run.doubts.clear();
                     run.views_labels = make_flags(own.labels);
                     const std::vector<ViewCard> cards = cards_of(order, own, job);
                     if (!job.cancelled()) ws_.tasks.post([know, run, cards] { know(run, cards); });
                   });
}

// No labels where there are none, see before_last_stroke(): a step that was no stroke, as one that took a
// stroke away. What was in doubt before it still is.
void CutJobs::note_before(Order* order) const {
  const Document* before = before_last_stroke(ws_.history, order->object);
  if (!before) {
    order->key_before = order->key;
    for (std::size_t at = ws_.history.cursor(); at > 0 && order->key_before == order->key; --at) {
      const ObjectItem* item = ws_.history.entries()[at - 1].document.find(order->object);
      order->key_before = item ? item->cut_key : "";
    }
    return;
  }
  const ObjectItem& item = *before->find(order->object);
  // Every step asks for them again, also a new colour.
  if (std::exchange(labelled_before_, item.id) != item.id) labels_before_.clear();
  order->before = labels_before_.labels(*before, item, ws_.gaussians());
  order->key_before = item.cut_key;
}

bool CutJobs::changes_nothing(int size_step) const {
  const ObjectItem* object = ws_.document().active_object();
  if (!object || comes(*object)) return false;
  ObjectItem other = *object;
  last_stroke(&other.views)->size_step = size_step;
  const std::string key = cut_key(ws_.document(), other);
  const CutRun* run = known_run(object->id, key);
  for (const Known& ahead : ahead_)
    if (ahead.object == object->id && ahead.run.key == key) run = &ahead.run;
  if (!run || !run->result) return false;
  other.cut = make_flags(run->result->labels);
  return labels_of(ws_.document(), other, ws_.gaussians()) ==
         *ws_.labels.labels(ws_.document(), *object, ws_.gaussians());
}

// See KeptFromCuts.
Flags CutJobs::kept_from_cuts(const Order& order) {
  ObjectItem object = *order.document->find(order.object);
  const bool gets_all = !object.of_others && !object.hand && object.within == 0;
  if (gets_all) return nullptr;
  object.cut = make_flags(std::vector<std::uint8_t>(order.scene->cloud->size(), 1));
  std::vector<std::uint8_t> kept = labels_of(*order.document, object, object.cut->size());
  for (std::uint8_t& flag : kept) flag = !flag;
  return make_flags(std::move(kept));
}

// With what of it the object gets: others, hands and its whole keep some of a cut.
CutResult CutJobs::as_object_has_it(const Order& order, const CutResult& result, const Job& job) {
  ObjectItem object = *order.document->find(order.object);
  object.cut = make_flags(result.labels);
  const std::vector<std::uint8_t> own = labels_of(*order.document, object, result.labels.size());
  return own == result.labels ? result : with_labels(*order.session, result, own, job);
}

std::vector<ViewCard> CutJobs::cards_of(const Order& order, const CutResult& result, const Job& job) {
  if (count_flags(result.labels) == 0) return {};
  return picture_cards(*order.session, {order.request, order.settings, result, order.colour, order.before},
                       job);
}

void CutJobs::take_cards(CutRun* run, const Order& order, const std::vector<std::uint8_t>& labels,
                         std::vector<ViewCard> cards) {
  if (const std::vector<ViewCard>* before = cards_known(order.object, order.key_before))
    keep_doubts(*before, labels, &cards);
  const std::vector<ViewCard>* saved =
      known_run(order.object, order.key) ? nullptr : cards_known(order.object, order.key);
  if (saved) {  // the same sides, drawn again: what was looked at stays in doubt until the next stroke
    std::vector<ViewCard> all = *saved;
    for (ViewCard& card : all) card.looked_at = false;
    keep_doubts(all, labels, &cards);
    keep_looks(*saved, &cards);
  }
  if (run->views_drawn) {  // a hand changed it, or it shows another change: neither is a stroke
    keep_doubts(run->views, labels, &cards);
    if (run->result && labels == (run->views_labels ? *run->views_labels : run->result->labels))
      keep_looks(run->views, &cards);
  }
  run->views = in_places_of(run->views.empty() && saved ? *saved : run->views, std::move(cards));
  run->views_before = order.before;
  run->views_drawn = true;
  for (ViewCard& card : run->views) card.serial = next_card_serial_++;
}

const std::vector<ViewCard>* CutJobs::cards_known(ObjectId object, const std::string& key) const {
  if (const CutRun* run = known_run(object, key)) return &run->views;
  for (const Known& opened : opened_)
    if (opened.object == object && opened.run.key == key) return &opened.run.views;
  return nullptr;
}

std::vector<DoubtfulSide> CutJobs::doubtful_sides() const {
  std::vector<DoubtfulSide> sides;
  for (const ObjectItem& object : ws_.document().objects) {
    const CutRun* shown = run(object.id);
    const std::vector<ViewCard>* cards = shown ? &shown->views : cards_known(object.id, object.cut_key);
    if (!cards) continue;
    const bool of_before = shown && !shown->views_drawn;  // looks at those end
    for (const ViewCard& card : *cards) {
      const bool ended = of_before && card.looked_at;
      sides.push_back({object.id, card.camera, card.looked_at && !ended, ended ? OpenDoubts() : card.open});
    }
  }
  return sides;
}

void CutJobs::take_doubtful_sides(std::span<const DoubtfulSide> sides) {
  for (const DoubtfulSide& side : sides) {
    const ObjectItem* object = ws_.document().find(side.object);
    if (!object || object->cut_key.empty()) continue;
    auto own = std::ranges::find(opened_, side.object, &Known::object);
    if (own == opened_.end()) {
      opened_.push_back({side.object, {}});
      own = std::prev(opened_.end());
      own->run.key = object->cut_key;
    }
    own->run.views.push_back({.camera = side.camera, .open = side.open, .looked_at = side.looked_at});
  }
}

// Draws the views of the active object again where a hand changed what the cut gave, where they are to show
// another change, or where another cut stopped their drawing, and says anew which sides are in doubt. What
// the cut itself doubts is said of its own labels alone.
void CutJobs::renew_views() {
  const ObjectItem* object = ws_.document().active_object();
  if (!object || ws_.tasks.busy(TaskKind::kCut)) return;
  CutRun* run = known_run(object->id, object->cut_key);
  if (!run || !run->result || run->result->views.empty()) return;
  if (run->views_drawn && run->views_at == ws_.history.serial()) return;
  const Flags now = ws_.labels.labels(ws_.document(), *object, ws_.gaussians());
  const bool as_cut = *now == run->result->labels;
  Order order = order_for(*object);
  const bool is_of_strokes = std::exchange(order.key, run->key) == run->key;  // else the last was not cut
  if (is_of_strokes) note_before(&order);
  const auto same = [](const Flags& a, const Flags& b) { return a == b || (a && b && *a == *b); };
  const bool same_labels = run->views_labels ? same(run->views_labels, now) : as_cut;
  if (run->views_drawn && same_labels && same(run->views_before, order.before)) {
    run->views_at = ws_.history.serial();  // compared once
    return;
  }
  const auto show = [this, order, now, as_cut](std::vector<ViewCard> cards) {
    CutRun* shown = order.scene == ws_.scene ? known_run(order.object, order.key) : nullptr;
    if (!shown) return;
    take_cards(shown, order, *now, std::move(cards));
    shown->views_labels = now;
    shown->doubts =
        as_cut ? still_doubted(order.object, doubts_of(*shown->result)) : std::vector<std::string>();
    add_doubt_of_sides(shown);
    ++ws_.view_serial;
  };
  if (count_flags(*now) == 0) return show({});
  const auto failed = [show] { show({}); };  // not tried again
  const auto outline = [this, order](const auto& meanings, const auto& sizes) {
    CutRun* outlined = order.scene == ws_.scene ? known_run(order.object, order.key) : nullptr;
    if (outlined) std::tie(outlined->meanings, outlined->sizes) = std::tie(meanings, sizes);
  };
  const bool outlines = is_of_strokes && !same_labels;  // what others keep may have changed
  ws_.tasks.submit({TaskKind::kCut, failed}, [this, show, outline, outlines, order, now, as_cut,
                                              result = run->result](const Job& job) {
    const KeptFromCuts kept{*order.session, outlines ? kept_from_cuts(order) : nullptr};
    const auto meanings = outlines ? meanings_of(order.request, *result, kept, job) : nullptr;
    const auto sizes = outlines ? sizes_of(order.request, *result, kept, job) : nullptr;
    if (outlines && !job.cancelled()) ws_.tasks.post([=] { outline(meanings, sizes); });
    const CutResult changed = as_cut ? *result : with_labels(*order.session, *result, *now, job);
    std::vector<ViewCard> cards = cards_of(order, changed, job);
    if (!job.cancelled()) ws_.tasks.post([show, cards = std::move(cards)] { show(cards); });
  });
}

void CutJobs::draw_larger(std::uint64_t card_serial) {
  const ObjectItem* object = ws_.document().active_object();
  CutRun* run = object ? known_run(object->id, object->cut_key) : nullptr;
  if (!run || !run->result || !run->views_drawn || !ws_.tasks.idle()) return;
  const auto card = std::ranges::find(run->views, card_serial, &ViewCard::serial);
  if (card == run->views.end() || card->large) return;
  Order order = order_for(*object);
  order.key = run->key;
  order.before = run->views_before;
  const auto show = [this, scene = ws_.scene, id = object->id, key = run->key,
                     card_serial](const std::shared_ptr<const Image<Rgba8>>& picture) {
    CutRun* shown = scene == ws_.scene ? known_run(id, key) : nullptr;
    if (!shown) return;
    const auto place = std::ranges::find(shown->views, card_serial, &ViewCard::serial);
    if (place != shown->views.end()) place->large = picture;
  };
  const auto failed = [show, small = card->picture] { show(small); };  // not tried again
  ws_.tasks.submit({TaskKind::kLarger, failed}, [this, show, order, card = *card, result = run->result,
                                                 labels = run->views_labels](const Job& job) {
    CutResult shown = *result;
    if (labels) shown.labels = *labels;
    const auto picture = std::make_shared<const Image<Rgba8>>(large_picture(
        *order.session, {order.request, order.settings, shown, order.colour, order.before}, card, job));
    if (!job.cancelled()) ws_.tasks.post([show, picture] { show(picture); });
  });
}

void CutJobs::looked_from(const Camera& camera) {
  const ObjectItem* object = ws_.document().active_object();
  CutRun* run = object ? known_run(object->id, object->cut_key) : nullptr;
  const auto looks = [&](const ViewCard& card) {
    return !card.looked_at && looks_at(camera, card, *ws_.scene->cloud);
  };
  if (!run || std::ranges::none_of(run->views, looks)) return;
  for (Known& known : known_)  // other sizes and states of it, whose sides it shows as well
    if (known.object == object->id)
      for (ViewCard& card : known.run.views) card.looked_at = card.looked_at || looks(card);
}

bool CutJobs::doubts_whole() const {
  const CutRun* shown = run(ws_.document().active);
  return shown && !shown->running && std::ranges::find(shown->doubts, kRunsOut) != shown->doubts.end();
}

void CutJobs::saw_whole() {
  const ObjectItem* object = ws_.document().active_object();
  if (!object) return;
  seen_whole_[object->id] = ws_.history.keys(*object).first_click;
  for (Known& known : known_)  // other sizes and states of it
    if (known.object == object->id) known.run.doubts = still_doubted(object->id, std::move(known.run.doubts));
}

std::vector<std::string> CutJobs::still_doubted(ObjectId id, std::vector<std::string> doubts) const {
  const ObjectItem* object = ws_.document().find(id);
  const auto seen = seen_whole_.find(id);
  if (object && seen != seen_whole_.end() && seen->second == ws_.history.keys(*object).first_click)
    std::erase(doubts, kRunsOut);
  return doubts;
}

// Of the active object's labels, for the heat map: kept by the session from the last cut, or computed again.
void CutJobs::request_likelihood() {
  const ObjectItem* object = ws_.document().active_object();
  if (!ws_.view.heat || !object || object->cut_key.empty() || ws_.tasks.busy(TaskKind::kCut)) return;
  if (is_stale(*object, ws_.history.keys(*object).cut)) return;
  const CutRun* known = known_run(object->id, object->cut_key);
  if (known && (known->likelihood || known->likelihood_failed)) return;
  if (!known) {
    CutRun of_labels;
    of_labels.key = object->cut_key;
    keep({object->id, std::move(of_labels)});
  }
  const auto change = [this, scene = ws_.scene, id = object->id, key = object->cut_key](const auto& how) {
    if (CutRun* run = scene == ws_.scene ? known_run(id, key) : nullptr) how(run);
    ++ws_.view_serial;
  };
  const auto failed = [change] { change([](CutRun* run) { run->likelihood_failed = true; }); };
  ws_.tasks.submit({TaskKind::kCut, failed}, [this, change, order = order_for(*object)](const Job& job) {
    job.progress("likelihood", 0);
    const auto likelihood = std::make_shared<const std::vector<float>>(
        order.session->likelihood_of(order.request, order.settings, job));
    if (job.cancelled()) return;
    ws_.tasks.post([change, likelihood] { change([&](CutRun* run) { run->likelihood = likelihood; }); });
  });
}

}  // namespace splatcut
