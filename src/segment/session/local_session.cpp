#include "segment/session/local_session.h"

#include <algorithm>
#include <string_view>

#include "core/error.h"
#include "core/stage_clock.h"
#include "segment/graphcut/knn_graph.h"
#include "segment/graphcut/likelihood.h"
#include "segment/masks/mask_tools.h"
#include "segment/session/correction.h"
#include "segment/session/pipeline.h"
#include "segment/session/reference_mask.h"

namespace splatcut {

namespace {

constexpr std::size_t kMostAnswers = 32;  // labels of requests and of these without their last strokes
// Cuts from a reference, one at least for each of those answers: another smoothness asks all of them again.
constexpr std::size_t kMostKept = kMostAnswers + 3;
constexpr std::size_t kMostKeptBytes = std::size_t{128} << 20;

// Times the views used: a correction must win against all that missed it.
constexpr int kCorrectionWeight = 4;

bool left_out(const CutRequest& request, const Camera& camera) {
  return std::ranges::any_of(request.left_out, [&](const Camera& c) { return same_view(c, camera); });
}

// Of the views but the reference those that the user leaves out no longer count. Returns how many.
std::size_t leave_out(const CutRequest& request, std::vector<ViewReport>* views) {
  std::size_t count = 0;
  for (std::size_t v = 1; v < views->size(); ++v) {
    ViewReport& view = (*views)[v];
    if (!left_out(request, view.camera)) continue;
    view.used = false;
    view.reason = "left out";
    ++count;
  }
  return count;
}

std::ptrdiff_t views_used(const CutResult& result) {
  return std::ranges::count_if(result.views, &ViewReport::used);
}

std::string key_of_views(const std::vector<ViewReport>& views, bool hard_counts) {
  CutRequest request;  // its key says which masks there are
  for (const ViewReport& view : views)
    if (view.used) request.masks.push_back({view.camera, view.mask});
  return key_of(request) + (hard_counts ? 'h' : 's');
}

std::size_t bytes_of(const CutResult& result) {
  std::size_t bytes = result.labels.size() + result.prior.size() + result.said.size();
  for (const std::vector<Mask>* masks : {&result.size_masks, &result.meanings})
    for (const Mask& mask : *masks) bytes += mask.size();
  for (const ViewReport& view : result.views) bytes += view.mask.size();
  return bytes;
}

CutSettings without_smoothness(CutSettings settings) {
  settings.smoothness.reset();
  return settings;
}

// Given masks of several views are made by people, and each is one more observation of its own: nothing is
// guessed from parts or taken away beside them, and the more there are the more they say against the
// neighbours. On photographs, each predicted from the masks of all others: docs/masks.md. The paper's presets
// stay as they are published.
CutSettings with_given_masks(CutSettings settings, std::size_t others) {
  if (others == 0 || settings.first_mask_from != FirstMaskFrom::kParts) return settings;
  constexpr float kFewMasks = 3;  // the energy's weights are those of so many
  const float share = std::min(1.0f, kFewMasks / static_cast<float>(others + 1));
  settings.prior_px_per_view = 0;
  settings.trim = false;
  settings.cut.energy.v0_px_per_view_at_400 *= share;
  settings.cut.energy.lambda *= share;
  if (settings.smoothness) *settings.smoothness *= share;
  return settings;
}

bool by_strokes_and_parts(const CutRequest& request, const CutSettings& settings) {
  return settings.first_mask_from == FirstMaskFrom::kParts && !settings.parts_only && !request.first_mask &&
         request.masks.empty() && !request.mask_source;
}

struct LastStroke {
  CutRequest before;  // the request without it
  bool object;
};

// The stroke that is applied last; none: it is the first, or carried labels hold it.
std::optional<LastStroke> last_correction(const CutRequest& request) {
  if (stroke_count(request) <= request.carried.strokes) return std::nullopt;
  const Stroke* first = first_stroke(request.strokes);
  for (std::size_t v = request.strokes.size(); v-- > 0;)
    for (std::size_t s = request.strokes[v].strokes.size(); s-- > 0;) {
      const Stroke& stroke = request.strokes[v].strokes[s];
      if (&stroke == first) continue;
      LastStroke last{request, stroke.label == SeedLabel::kObject};
      std::vector<StrokedView>& views = last.before.strokes;
      views[v].strokes.erase(views[v].strokes.begin() + static_cast<std::ptrdiff_t>(s));
      if (views[v].strokes.empty()) views.erase(views.begin() + static_cast<std::ptrdiff_t>(v));
      return last;
    }
  return std::nullopt;
}

}  // namespace

// A request, checked and analysed.
struct LocalSession::Asked {
  const CutRequest& request;
  CutSettings settings;
  std::vector<StrokedView> by_view;
  std::optional<ReferenceView> reference;
  CutSettings first_settings;  // of the cut from the reference
  std::string first_key;
  bool by_parts = false;  // then strokes of all views are replayed in the first cut

  // Strokes in other views than the reference.
  std::vector<const StrokedView*> corrections() const {
    std::vector<const StrokedView*> views;
    if (by_parts) return views;
    for (const StrokedView& view : by_view)
      if (!view.strokes.empty() && (request.first_mask || !same_view(view.camera, reference->camera)))
        views.push_back(&view);
    return views;
  }
  bool smoother() const { return settings.last_lambda() != settings.cut.energy.lambda; }
};

LocalSession::LocalSession(LocalScene scene)
    : scene_(std::move(scene)), views_(*scene_.cloud), strokes_(scene_.prepared->parts, scene_.capture) {}

bool LocalSession::graph_stands(const CutSettings& settings) const {
  const std::size_t most = scene_.cloud->size() > 0 ? scene_.cloud->size() - 1 : 0;
  return graph_ && graph_->listed == std::min(static_cast<std::size_t>(settings.neighbours), most);
}

const FlowGraph& LocalSession::graph(const CutSettings& settings, const Job& job) {
  if (graph_stands(settings)) return *graph_;
  solver_.reset();
  job.progress("graph", 0);
  graph_ = knn_graph(*scene_.cloud, {settings.neighbours}, job);
  return *graph_;
}

CutSolver& LocalSession::solver(const CutSettings& settings, const Job& job) {
  const FlowGraph& neighbours = graph(settings, job);
  if (solver_)
    solver_->set_options(settings.cut);
  else
    solver_.emplace(*scene_.cloud, neighbours, settings.cut);
  return *solver_;
}

CutScene LocalSession::scene_for(const CutRequest& request, const CutSettings& settings, const Job& job) {
  const PartHierarchy& parts = scene_.prepared->parts;
  if (settings.first_mask_from == FirstMaskFrom::kParts && parts.leaf_of.size() != scene_.cloud->size())
    throw Error("first mask", "the scene was prepared without parts", "Prepare it with the same settings");
  return {{*scene_.cloud, &views_},
          graph(settings, job),
          parts,
          scene_.prepared->model,
          solver(settings, job),
          strokes_,
          request.up_world.value_or(scene_.up_world),
          scene_.capture.photographs};
}

LocalSession::Asked LocalSession::asked(const CutRequest& request, const CutSettings& settings) const {
  check(settings);
  Asked asked{request, with_given_masks(settings, request.masks.size())};
  asked.by_view = strokes_by_view(request.strokes);
  asked.first_settings = without_smoothness(asked.settings);
  asked.reference = reference_of(request, asked.by_view);
  asked.by_parts = settings.first_mask_from == FirstMaskFrom::kParts && !request.first_mask;
  if (asked.reference)
    asked.first_key =
        key_of_reference(request, *asked.reference) + (asked.by_parts ? key_of_strokes(request) : "");
  return asked;
}

LocalSession::Kept* LocalSession::kept(const Asked& asked) {
  if (asked.request.mask_source) return nullptr;  // it may answer differently now
  const auto found = std::ranges::find_if(
      kept_, [&](const Kept& k) { return k.key == asked.first_key && k.settings == asked.first_settings; });
  if (found == kept_.end()) return nullptr;
  kept_.splice(kept_.begin(), kept_, found);
  return &kept_.front();
}

LocalSession::Kept& LocalSession::from_reference(const Asked& asked, const Job& job,
                                                 const OnSnapshot& on_snapshot, bool* fresh) {
  Kept* known = kept(asked);
  *fresh = known == nullptr;
  if (known) return *known;
  job.progress("first mask", 0);
  Kept made{asked.first_key, asked.first_settings, {}, {}, {}};
  made.result.outcome = Outcome::kCancelled;
  if (on_snapshot && asked.by_parts && !graph_stands(asked.first_settings)) {
    CutResult so_far;
    so_far.labels = meant(asked.request, asked.first_settings, job);
    if (!job.cancelled()) on_snapshot(CutPhase::kParts, so_far);
  }
  std::vector<StageTime> stages;
  if (!graph_stands(asked.first_settings))
    StageClock(&stages).time("graph", [&] { graph(asked.first_settings, job); });
  const CutScene scene = scene_for(asked.request, asked.first_settings, job);
  if (!job.cancelled())
    made.result =
        cut_from_reference({scene, *asked.reference, asked.request, asked.first_settings, job}, on_snapshot);
  StageClock(&stages).book(made.result.stages);
  made.result.stages = std::move(stages);
  if (made.result.outcome == Outcome::kCancelled) return cancelled_ = std::move(made);
  kept_.push_front(std::move(made));
  if (kept_.size() > kMostKept) kept_.pop_back();
  while (kept_.size() > 1 && kept_bytes() > kMostKeptBytes) kept_.pop_back();
  return kept_.front();
}

std::size_t LocalSession::bytes() const {
  std::size_t bytes = views_.bytes() + strokes_.bytes() + kept_bytes() + bytes_of(cancelled_.result);
  for (const Answer& answer : answers_) bytes += answer.labels.size() + answer.key.size();
  return bytes;
}

void LocalSession::forget_views() {
  views_.clear();
  strokes_.forget();
}

std::size_t LocalSession::kept_bytes() const {
  std::size_t bytes = 0;
  for (const Kept& k : kept_)
    bytes += bytes_of(k.result) + (k.sums ? 2 * k.sums->total.size() * sizeof(k.sums->total[0]) : 0);
  return bytes;
}

// Sums of the views that count, kept until those differ. False: cancelled.
bool LocalSession::add_up_views(const CutResult& result, const CutSettings& settings, const Job& job,
                                Kept* first) {
  std::string key = key_of_views(result.views, settings.hard_counts);
  if (first->sums && key == first->sums_key) return !job.cancelled();
  first->sums.reset();
  MaskedSums sums(scene_.cloud->size());
  for (const ViewReport& view : result.views)
    if (view.used && !job.cancelled())
      add_masked_sums({*scene_.cloud, &views_}, view.camera, view.mask, settings.hard_counts, job, &sums);
  if (job.cancelled()) return false;
  first->sums = std::move(sums);
  first->sums_key = std::move(key);
  return true;
}

// The likelihood of the last cut: the views that count, corrected by strokes in other views, with the prior
// of the parts. The result's views are those of the first cut; views of corrections are appended.
Likelihood LocalSession::evidence(const Asked& asked, const Job& job, Kept* first, CutResult* result) {
  const CutSettings& settings = asked.settings;
  StageClock clock(&result->stages);
  if (!clock.time("likelihood", [&] { return add_up_views(*result, settings, job, first); })) return {};
  const std::ptrdiff_t first_used = views_used(*result);
  const Drawer drawer(*scene_.cloud, &views_);
  MaskedSums sums = *first->sums;
  for (const StrokedView* view : asked.corrections()) {
    if (job.cancelled()) break;
    const Correction c =
        clock.time("masks", [&] { return corrected(drawer, *view, first->result.labels, settings, job); });
    clock.time("likelihood", [&] {
      add_masked_sums(drawer, c.camera, c.mask, settings.hard_counts, job, &sums);
      add_weighted(drawer, c, kCorrectionWeight * first_used, settings.hard_counts, job, &sums);
    });
    result->views.push_back(
        {.camera = c.camera, .mask = c.mask, .used = true, .confidence = 1, .reason = {}, .clicked = true});
  }
  return with_prior(likelihood(sums), first->result.prior,
                    settings.prior_px_per_view * static_cast<float>(views_used(*result)));
}

// The last cut. result: that of the first.
void LocalSession::correct(const Asked& asked, const Job& job, Kept* first, CutResult* result) {
  CutSettings settings = asked.settings;
  settings.cut.energy.lambda = asked.settings.last_lambda();
  const Likelihood weighed = evidence(asked, job, first, result);
  if (job.cancelled()) return;
  if (asked.request.first_mask && !asked.corrections().empty())
    result->said.clear();  // they correct the mask
  job.progress("cut", 0.9);
  StageClock clock(&result->stages);
  const LookedAt looked = looked_at(result->views);
  CutReport report = clock.time("cut", [&] {
    return solver(settings, job).solve(weighed, looked.views, looked.pixels_per_view(), job, result->said);
  });
  if (job.cancelled()) return;
  result->cut = report;
  result->labels = std::move(report.labels);
  keep_object(result);
  if (settings.trim)
    result->trimmed = clock.time("trim", [&] {
      return trim_to_views({*scene_.cloud, &views_}, result->views, settings, &result->labels, job);
    });
  obey_strokes(result);
}

CutResult LocalSession::solved(const CutRequest& request, const CutSettings& settings, const Job& job,
                               const OnSnapshot& on_snapshot) {
  const Asked asked = this->asked(request, settings);
  if (!asked.reference) {
    CutResult nothing;
    nothing.outcome = Outcome::kNothingFound;
    nothing.reason = "no stroke marks the object yet; click on it";
    nothing.labels.assign(scene_.cloud->size(), 0);
    return nothing;
  }
  bool fresh = false;
  Kept& first = from_reference(asked, job, on_snapshot, &fresh);
  CutResult result = first.result;
  if (!fresh) result.stages.clear();
  if (result.outcome != Outcome::kDone || settings.parts_only) return result;
  const std::size_t without = leave_out(request, &result.views);
  if (without == 0 && asked.corrections().empty() && !asked.smoother()) return result;
  correct(asked, job, &first, &result);
  if (job.cancelled()) result.outcome = Outcome::kCancelled;
  return result;
}

// Moved to the front; null: it is not kept.
LocalSession::Answer* LocalSession::kept_answer(const CutRequest& request, const CutSettings& settings) {
  const std::string key = key_of(request);
  const auto known =
      std::ranges::find_if(answers_, [&](const Answer& a) { return a.key == key && a.settings == settings; });
  if (known == answers_.end()) return nullptr;
  answers_.splice(answers_.begin(), answers_, known);
  return &answers_.front();
}

// Of an answer that is kept, or else computed; empty: nothing was found, or it was cancelled. In work that is
// opened again many are missing: those to ever more strokes are computed, and it is said how far that is.
std::vector<std::uint8_t> LocalSession::labels_of(const CutRequest& request, const CutSettings& settings,
                                                  const Job& job, std::vector<StageTime>* stages) {
  std::vector<CutRequest> missing;  // the one with the most strokes first
  for (std::optional<CutRequest> next = request; next && !kept_answer(*next, settings);) {
    missing.push_back(std::move(*next));
    const std::optional<LastStroke> last = last_correction(missing.back());
    next = last ? std::optional(last->before) : std::nullopt;
  }
  const Job counted{job.stop, {}};
  for (std::size_t i = missing.size(); i-- > 0 && !job.cancelled();) {
    job.progress("earlier strokes", 1 - static_cast<double>(i + 1) / static_cast<double>(missing.size()));
    StageClock(stages).book(cut(missing[i], settings, counted).stages);
  }
  if (const Answer* known = kept_answer(request, settings)) return known->labels;
  return {};
}

CutResult LocalSession::cut(const CutRequest& request, const CutSettings& settings, const Job& job,
                            const OnSnapshot& on_snapshot) {
  if (!by_strokes_and_parts(request, settings)) return solved(request, settings, job, on_snapshot);
  const std::optional<LastStroke> last = last_correction(request);
  std::vector<StageTime> stages;  // of earlier strokes
  const std::vector<std::uint8_t> before =
      last ? labels_of(last->before, settings, job, &stages) : std::vector<std::uint8_t>();
  CutResult result = solved(request, settings, job, on_snapshot);
  StageClock(&stages).book(result.stages);
  result.stages = std::move(stages);
  if (result.outcome == Outcome::kCancelled) return result;
  if (result.outcome == Outcome::kDone) {
    for (std::size_t g = 0; g < before.size(); ++g)
      if ((result.labels[g] != 0) != last->object) result.labels[g] = before[g];
    obey_strokes(&result);
  }
  if (!kept_answer(request, settings))
    answers_.push_front({key_of(request), settings,
                         result.outcome == Outcome::kDone ? result.labels : std::vector<std::uint8_t>()});
  if (answers_.size() > kMostAnswers) answers_.pop_back();
  return result;
}

Mask LocalSession::first_mask(const CutRequest& request, const CutSettings& settings, const Job& job) {
  const Asked asked = this->asked(request, settings);
  if (!asked.reference) return {};
  const CutScene scene = scene_for(request, asked.first_settings, job);
  return first_mask_of({scene, *asked.reference, request, asked.first_settings, job});
}

std::vector<std::uint8_t> LocalSession::meant(const CutRequest& request, const CutSettings& settings,
                                              const Job& job) {
  return strokes_
      .replay({*scene_.cloud, &views_}, strokes_in_order(request),
              replay_options(request, settings, scene_.prepared->model), job)
      .labels();
}

bool LocalSession::at_last_size(const CutRequest& request, const CutSettings& settings, bool larger,
                                const Job& job) {
  const std::vector<CameraStroke> strokes = strokes_in_order(request);
  if (strokes.empty() || in_replay_order(strokes).back().earlier) return false;  // its sizes are another's
  const ClickSelection& meant = strokes_.replay(
      {*scene_.cloud, &views_}, strokes, replay_options(request, settings, scene_.prepared->model), job);
  if (meant.sizes() == 0) return false;
  return !job.cancelled() && meant.size() == (larger ? meant.sizes() - 1 : 0);
}

std::vector<float> LocalSession::likelihood_of(const CutRequest& request, const CutSettings& settings,
                                               const Job& job) {
  const Asked asked = this->asked(request, settings);
  if (!asked.reference) return std::vector<float>(scene_.cloud->size(), 0);
  bool fresh = false;
  Kept& first = from_reference(asked, job, {}, &fresh);
  CutResult result = first.result;
  leave_out(request, &result.views);
  return evidence(asked, job, &first, &result).w;
}

}  // namespace splatcut
