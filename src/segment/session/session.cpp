#include "segment/session/session.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/byte_hash.h"
#include "core/stage_clock.h"
#include "segment/masks/cv_image.h"
#include "segment/masks/mask_tools.h"
#include "segment/session/kept_neighbourhood.h"
#include "segment/session/reference_mask.h"
#include "segment/session/session_among.h"
#include "segment/superpoints/orbit.h"

namespace splatcut {

namespace {

CutResult nothing_found(std::size_t gaussians, const char* reason) {
  CutResult nothing;
  nothing.outcome = Outcome::kNothingFound;
  nothing.reason = reason;
  nothing.labels.assign(gaussians, 0);
  return nothing;
}

}  // namespace

Session::Session(SessionScene scene)
    : scene_(std::move(scene)),
      whole_{scene_.cloud, scene_.blocks ? scene_.blocks : std::make_shared<const CloudBlocks>(*scene_.cloud),
             scene_.up_world, capture_of(*scene_.cloud, scene_.photographs)} {
  Hasher hash;
  hash.add(whole_.blocks->blocks());
  scene_.prepare.cache.scene = hash.value();
}

Session::~Session() = default;
Session::Session(Session&& other) noexcept = default;

// Of a path on the rest those of sampled(stroke).
const StrokeHits& Session::hits(const CameraStroke& stroke, const Job& job) {
  CameraStroke any_size = stroke;
  any_size.stroke.size_step = 0;
  const std::string key = key_of_strokes(request_of({&any_size, 1}, {}));
  const auto known = hits_.find(key);
  if (known != hits_.end()) return known->second;
  constexpr std::size_t kMostHits = 4096;
  if (hits_.size() >= kMostHits) hits_.clear();
  if (stroke.stroke.label == SeedLabel::kRest) any_size.stroke = sampled(stroke);
  StrokeHits found = stroke_hits({*scene_.cloud, nullptr, whole_.blocks.get()}, any_size, job);
  if (job.cancelled())
    return cancelled_hits_ = std::move(found);  // it may be incomplete: asked again next time
  return hits_[key] = std::move(found);
}

// Null if cancelled.
Session::Local* Session::local(const Place& place, const CutSettings& settings, const Job& job) {
  const bool with_parts = by_parts(settings);
  const auto known = std::ranges::find_if(locals_, [&](const Local& l) {
    return l.near.place == place && (!with_parts || !l.near.prepared->parts.leaf_of.empty());
  });
  if (known != locals_.end()) {
    locals_.splice(locals_.begin(), locals_, known);
    keep_within_bytes();
    return &locals_.front();
  }
  if (ends_if_large_ && gaussians_in(place) > scene_.most_ahead) {
    ends_if_large_->request_stop();
    return nullptr;
  }
  Neighbourhood made = prepare_neighbourhood(whole_, place, with_parts ? &scene_.prepare : nullptr, job);
  if (job.cancelled()) return nullptr;
  locals_.emplace_front(std::move(made), whole_);
  StageClock(&prepared_).book(locals_.front().near.prepared->stages);
  keep_within_bytes();
  return &locals_.front();
}

// Of the neighbourhoods used longest ago first the views go, which are soon drawn again, then they
// themselves.
void Session::keep_within_bytes() {
  std::size_t bytes = kept_bytes();
  for (auto l = locals_.rbegin(); bytes > scene_.most_bytes && l != std::prev(locals_.rend()); ++l) {
    bytes -= l->bytes();
    l->session.forget_views();
    bytes += l->bytes();
  }
  while (bytes > scene_.most_bytes && locals_.size() > 1) {
    bytes -= locals_.back().bytes();
    locals_.pop_back();
  }
}

std::size_t Session::kept_bytes() const {
  std::size_t bytes = 0;
  for (const Local& l : locals_) bytes += l.bytes();
  return bytes;
}

// The request as the neighbourhood sees it.
CutRequest Session::in_place(const CutRequest& request, const Answered& answered, Local* there,
                             const Job& job) {
  CutRequest local = request;
  local.choice = answered.choice;
  set_size_steps(answered.size_steps, &local.strokes);
  const std::size_t carried = answered.carried.strokes;
  if (carried > 0 && carried <= stroke_count(request))
    local.carried = {carried, labels_in(there->near, *answered.carried.rows)};
  if (there->near.row.empty()) return local;
  const Box box = there->near.place.cell.box_world();
  const std::vector<StrokedView> asked = std::exchange(local.strokes, {});
  const Stroke* first = first_stroke(asked);
  std::size_t before = 1, carried_here = 0;  // strokes that come before the next one in replay order
  for (const StrokedView& view : asked) {
    StrokedView here{view.camera, {}, there->seen.in(there->near, view.seen)};
    for (const Stroke& stroke : view.strokes) {
      const bool is_carried = &stroke == first || before++ < carried;
      const std::size_t made = here.strokes.size();
      if (stroke.label != SeedLabel::kRest) {
        if (!stroke.points_px.empty()) here.strokes.push_back(stroke);
      } else {
        const CameraStroke said{view.camera, stroke, view.seen};
        for (Stroke& piece : pieces_in(box, said, hits(said, job))) here.strokes.push_back(std::move(piece));
      }
      if (is_carried) carried_here += here.strokes.size() - made;
    }
    local.strokes.push_back(std::move(here));
  }
  if (local.carried.strokes > 0) local.carried.strokes = carried_here;
  return local;
}

CutResult Session::in_scene(const Local& there, CutResult result) const {
  const std::size_t n = scene_.cloud->size();
  result.labels = splatcut::in_scene(there.near, n, std::move(result.labels));
  result.prior = splatcut::in_scene(there.near, n, std::move(result.prior));
  result.said = splatcut::in_scene(there.near, n, std::move(result.said));
  result.looked_at_gaussians = there.near.cloud->size();
  return result;
}

// What a first stroke can mean, and the steps of its size, are shown as they were offered, also where what is
// taken needed a larger place.
void Session::keep_offer(const CutRequest& request, const Answered& answered, const CutSettings& settings,
                         const Job& job, CutResult* result) {
  if (const Stroke* last = last_stroke(request.strokes); last && result->sizes > 0) {
    CutRequest here = request;
    set_size_steps(answered.size_steps, &here.strokes);
    if (last_stroke(here.strokes)->size_step != last->size_step)
      result->likeliest_size = static_cast<std::size_t>(  // as the wheel counts from there
          std::max<std::ptrdiff_t>(0, static_cast<std::ptrdiff_t>(result->size) - last->size_step));
  }
  const bool in_its_own =
      request.choice == 0 && first_size_step(request) == 0 && answered.carried.strokes == 0;
  if (result->meanings.empty() || in_its_own) return;
  const CutRequest first = first_of(request);
  const std::optional<Answered> offered = place_of(first, settings, job);
  if (!offered || offered->place == answered.place) return;
  CutSettings alone = settings;
  alone.parts_only = true;
  Local* there = local(offered->place, settings, job);
  if (!there) return;
  std::vector<Mask> meanings = there->session.cut(in_place(first, *offered, there, job), alone, job).meanings;
  if (meanings.empty()) return;
  result->meanings = std::move(meanings);
  result->choice = std::min(static_cast<std::size_t>(request.choice), result->meanings.size() - 1);
}

// The sizes are those of the last stroke that the place knows. Where the request's own hits nothing there, it
// has none.
void keep_own_sizes(const CutRequest& request, const CutRequest& in_place, CutResult* result) {
  const std::vector<CameraStroke> asked = strokes_in_order(request), known = strokes_in_order(in_place);
  if (!known.empty() && same_camera(asked.back().camera, known.back().camera) &&
      asked.back().stroke.label == known.back().stroke.label &&
      asked.back().stroke.points_px == known.back().stroke.points_px)
    return;
  result->sizes = result->size = result->likeliest_size = 0;
  result->size_masks.clear();
}

// The neighbourhood of the cut and its result there; null: nothing is marked or hit, or cancelled.
Session::Local* Session::settled(const CutRequest& request, const CutSettings& settings, const Job& job,
                                 const OnSnapshot& on_snapshot, CutResult* result, Answered* in) {
  check(settings);
  std::optional<Answered> answered = place_of(request, settings, job);
  std::vector<StageTime> stages;  // of the cuts in all places
  while (answered && !job.cancelled()) {
    Local* there = local(answered->place, settings, job);
    if (!there) return nullptr;
    const CutRequest here = in_place(request, *answered, there, job);
    OnSnapshot in_whole;
    if (on_snapshot)
      in_whole = [&](CutPhase phase, CutResult so_far) {
        keep_own_sizes(request, here, &so_far);
        on_snapshot(phase, in_scene(*there, std::move(so_far)));
      };
    *result = there->session.cut(here, settings, job, in_whole);
    keep_own_sizes(request, here, result);
    StageClock(&stages).book(result->stages);
    result->stages = stages;
    std::optional<Answered> larger;
    if (result->outcome == Outcome::kDone && touches_side(whole_, there->near, result->labels))
      larger = answered_in(grown_about(there->near, result->labels), *answered, request, settings, job);
    if (job.cancelled()) return nullptr;
    if (!larger) {
      keep_offer(request, *answered, settings, job, result);
      if (in) *in = *answered;
      return local(answered->place, settings, job);  // what was looked at may have pushed it out
    }
    answered = larger;
  }
  return nullptr;
}

CutResult Session::cut(const CutRequest& request, const CutSettings& settings, const Job& job,
                       const OnSnapshot& on_snapshot, CutReach reach) {
  if (SessionAmong* these = among(request))
    return these->in_scene(
        these->session.cut(these->here(request), settings, job, these->in_scene(on_snapshot), reach));
  if (reach == CutReach::kAnywhere) return cut_anywhere(request, settings, job, on_snapshot);
  std::stop_source ends;
  const std::stop_callback with_job(job.stop, [&ends] { ends.request_stop(); });
  struct Forgotten {  // also where the cut throws
    std::stop_source** pointer;
    ~Forgotten() { *pointer = nullptr; }
  } const afterwards{&ends_if_large_};
  ends_if_large_ = &ends;
  return cut_anywhere(request, settings, {ends.get_token(), job.on_progress}, on_snapshot);
}

CutResult Session::cut_anywhere(const CutRequest& request, const CutSettings& settings, const Job& job,
                                const OnSnapshot& on_snapshot) {
  CutResult result;
  prepared_.clear();
  Local* there = settled(request, settings, job, on_snapshot, &result);
  if (job.cancelled()) {
    result = nothing_found(scene_.cloud->size(), "");
    result.outcome = Outcome::kCancelled;
    return result;
  }
  if (!there)
    return nothing_found(scene_.cloud->size(), std::ranges::any_of(request.strokes, marks_object)
                                                   ? "the strokes mark nothing that stands out in this view; "
                                                     "click on the object itself, or scribble"
                                                   : "no stroke marks the object yet; click on it");
  result = in_scene(*there, std::move(result));
  StageClock(&prepared_).book(result.stages);
  result.stages = std::move(prepared_);
  keep_within_bytes();
  return result;
}

Mask Session::first_mask(const CutRequest& request, const CutSettings& settings, const Job& job) {
  check(settings);
  if (SessionAmong* these = among(request))
    return these->session.first_mask(these->here(request), settings, job);
  const std::optional<Answered> answered = place_of(request, settings, job);
  if (!answered) return {};
  Local* there = local(answered->place, settings, job);
  return there ? there->session.first_mask(in_place(request, *answered, there, job), settings, job) : Mask();
}

Session::Preview Session::preview(const CutRequest& request, const CameraStroke& stroke,
                                  const CutSettings& settings, const Job& job) {
  if (!by_parts(settings)) return {};
  if (SessionAmong* these = among(request)) {
    Preview there = these->session.preview(these->here(request), these->here(stroke), settings, job);
    return {these->in_scene(std::move(there.before)), these->in_scene(std::move(there.after))};
  }
  CutRequest after = request;
  after.strokes.push_back({stroke.camera, {stroke.stroke}, stroke.seen});
  const std::optional<Answered> answered = place_of_strokes(after, settings, job);
  if (!answered) return {};
  Local* there = local(answered->place, settings, job);
  if (!there) return {};
  const std::size_t n = scene_.cloud->size();
  Preview labels{there->session.meant(in_place(request, *answered, there, job), settings, job), {}};
  labels.after = there->session.meant(in_place(after, *answered, there, job), settings, job);
  if (job.cancelled()) return {};
  return {splatcut::in_scene(there->near, n, std::move(labels.before)),
          splatcut::in_scene(there->near, n, std::move(labels.after))};
}

std::vector<float> Session::likelihood_of(const CutRequest& request, const CutSettings& settings,
                                          const Job& job) {
  if (SessionAmong* these = among(request))
    return these->in_scene(these->session.likelihood_of(these->here(request), settings, job));
  CutResult result;
  Answered in;
  Local* there = settled(request, settings, job, {}, &result, &in);
  if (!there || job.cancelled()) return std::vector<float>(scene_.cloud->size(), 0);
  return splatcut::in_scene(there->near, scene_.cloud->size(),
                            there->session.likelihood_of(in_place(request, in, there, job), settings, job));
}

void Session::make_ready(const CameraStroke& click, const CutSettings& settings, const Job& job) {
  make_lab_ready();
  if (!by_parts(settings)) return;
  const std::optional<Answered> answered = place_of_strokes(request_of({&click, 1}, {}), settings, job);
  Local* there = answered ? local(answered->place, settings, job) : nullptr;
  if (there) there->session.make_ready(settings, job);
}

std::vector<GivenView> Session::look_around(const CutRequest& request, const CutResult& result,
                                            const CutSettings& settings, int views, const Job& job,
                                            std::span<const std::uint8_t> before) {
  std::vector<GivenView> around;
  const auto reference = reference_of(request, strokes_by_view(request.strokes));
  const ObjectExtent extent = object_extent(*scene_.cloud, result.labels);
  if (!reference || !(extent.radius > 0)) return around;
  OrbitOptions orbit = settings.orbit;
  orbit.views = views;
  const Drawer drawer(*scene_.cloud, nullptr, whole_.blocks.get());
  for (const Camera& camera :
       cameras_around(limited_to_width(reference->camera, settings.work_width_px),
                      request.up_world.value_or(scene_.up_world), extent, scene_.photographs, orbit)) {
    if (job.cancelled()) break;
    if (std::ranges::any_of(result.views, [&](const ViewReport& v) { return same_view(v.camera, camera); }))
      continue;
    const auto shown = [&](std::span<const std::uint8_t> labels) {
      return thresholded(render_labels(drawer, camera, labels, job), 0.5f);
    };
    Mask seen = shown(result.labels);
    if (count(seen) > 0 || (!before.empty() && count(shown(before)) > 0))
      around.push_back({camera, std::move(seen)});
  }
  return around;
}

}  // namespace splatcut
