// What is computed of a cut that is known: its pictures and sentences once more, after its file was opened or
// a hand has changed it, and the likelihood for the heat map.
#include "app/picture/cut_pictures.h"
#include "app/studio/cut_jobs.h"
#include "app/studio/cut_sentences.h"
#include "segment/session/doubts.h"

namespace splatcut {

// Labels of opened work, or of a step that undo went back to, are there without what is known of their cut:
// it is made again to look at, its views and sizes. The labels stay, also where an older program made them.
void CutJobs::recall() {
  const ObjectItem* object = ws_.document().active_object();
  if (!object || !object->cut || object->views.empty() || object->cut_kept || ws_.tasks.busy(TaskKind::kCut))
    return;
  if (known_run(object->id, object->cut_key) || is_stale(*object, ws_.history.keys(*object).cut)) return;
  const auto know = [this, scene = ws_.scene, id = object->id](CutRun run) {
    if (scene != ws_.scene || known_run(id, run.key)) return;
    for (ViewCard& card : run.views) card.serial = next_card_serial_++;
    keep({id, std::move(run)});
    ++ws_.view_serial;
  };
  CutRun nothing;
  nothing.key = object->cut_key;
  const auto failed = [know, nothing] { know(nothing); };  // not tried again
  ws_.tasks.submit(
      {TaskKind::kCut, failed}, [this, know, run = nothing, session = ws_.session, labels = object->cut,
                                 colour = object->colour, request = cut_request(ws_.document(), *object),
                                 settings = cut_settings(ws_.document(), *object)](const Job& job) mutable {
        const auto result = std::make_shared<const CutResult>(session->cut(request, settings, job));
        if (job.cancelled()) return;
        if (result->labels == *labels) {
          run.result = result;
          run.stages = result->stages;
          run.meanings = meanings_of(request, *result);
          run.sizes = sizes_of(request, *result);
          run.doubts = doubts_of(*result);
          run.views = picture_cards(*session, request, settings, *result, colour, job);
          run.views_drawn = true;
          add_doubt_of_sides(&run);
        }
        if (!job.cancelled()) ws_.tasks.post([know, run] { know(run); });
      });
}

void CutJobs::take_cards(CutRun* run, std::vector<ViewCard> cards) {
  run->views = in_places_of(run->views, std::move(cards));
  run->views_drawn = true;
  for (ViewCard& card : run->views) card.serial = next_card_serial_++;
}

// Draws the views of the active object again where a hand changed what the cut gave, or where another cut
// stopped their drawing, and says anew which sides are in doubt. What the cut itself doubts is said of its
// own labels alone.
void CutJobs::renew_views() {
  const ObjectItem* object = ws_.document().active_object();
  if (!object || ws_.tasks.busy(TaskKind::kCut)) return;
  CutRun* run = known_run(object->id, object->cut_key);
  if (!run || !run->result || run->result->views.empty()) return;
  const Flags now = ws_.labels.labels(ws_.document(), *object, ws_.gaussians());
  if (run->views_drawn && now == run->views_labels) return;
  const bool as_cut = *now == run->result->labels;
  if (run->views_drawn && (run->views_labels ? *run->views_labels == *now : as_cut)) {
    run->views_labels = now;  // compared once
    return;
  }
  const auto show = [this, scene = ws_.scene, id = object->id, key = run->key, now,
                     as_cut](std::vector<ViewCard> cards) {
    CutRun* shown = scene == ws_.scene ? known_run(id, key) : nullptr;
    if (!shown) return;
    take_cards(shown, std::move(cards));
    shown->views_labels = now;
    shown->doubts = as_cut ? doubts_of(*shown->result) : std::vector<std::string>();
    add_doubt_of_sides(shown);
    ++ws_.view_serial;
  };
  if (count_flags(*now) == 0) return show({});
  const auto failed = [show] { show({}); };  // not tried again
  ws_.tasks.submit(
      {TaskKind::kCut, failed}, [this, show, now, as_cut, result = run->result, session = ws_.session,
                                 colour = object->colour, request = cut_request(ws_.document(), *object),
                                 settings = cut_settings(ws_.document(), *object)](const Job& job) {
        const CutResult changed = as_cut ? *result : with_labels(*session, *result, *now, job);
        std::vector<ViewCard> cards = picture_cards(*session, request, settings, changed, colour, job);
        if (!job.cancelled()) ws_.tasks.post([show, cards = std::move(cards)] { show(cards); });
      });
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
  ws_.tasks.submit(
      {TaskKind::kCut, failed},
      [this, change, session = ws_.session, request = cut_request(ws_.document(), *object),
       settings = cut_settings(ws_.document(), *object)](const Job& job) {
        job.progress("likelihood", 0);
        const auto likelihood =
            std::make_shared<const std::vector<float>>(session->likelihood_of(request, settings, job));
        if (job.cancelled()) return;
        ws_.tasks.post([change, likelihood] { change([&](CutRun* run) { run->likelihood = likelihood; }); });
      });
}

}  // namespace splatcut
