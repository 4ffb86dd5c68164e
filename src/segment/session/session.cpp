#include "segment/session/session.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/byte_hash.h"
#include "segment/masks/cv_image.h"
#include "segment/masks/mask_tools.h"
#include "segment/session/reference_mask.h"
#include "segment/superpoints/orbit.h"

namespace splatcut {

namespace {

constexpr double kMostOfScene = 0.7;  // a cell that holds this share of the Gaussians is the scene
constexpr int kMostHalvings = 5;      // of the first cell
constexpr std::size_t kMostPlaces = 4096;

Box joined(const Box& a, const Box& b) {
  return {glm::min(a.min, b.min), glm::max(a.max, b.max)};
}

bool holds(const Cell& cell, const Box& box) {
  return contains(cell.box_world(), box.min) && contains(cell.box_world(), box.max);
}

// Where nearly all of what is labelled lies.
Box bounds_of(const GaussianCloud& cloud, std::span<const std::uint8_t> labels) {
  constexpr double kInside = 0.96;
  std::vector<glm::vec3> positions;
  for (std::size_t g = 0; g < labels.size(); ++g)
    if (labels[g]) positions.push_back(cloud.position[g]);
  return robust_bounds(positions, kInside);
}

CutResult nothing_found(std::size_t gaussians, const char* reason) {
  CutResult nothing;
  nothing.outcome = Outcome::kNothingFound;
  nothing.reason = reason;
  nothing.labels.assign(gaussians, 0);
  return nothing;
}

bool by_parts(const CutSettings& settings) {
  return settings.first_mask_from == FirstMaskFrom::kParts;
}

CutRequest request_of(std::span<const CameraStroke> strokes, const CutRequest& like) {
  CutRequest request;
  for (const CameraStroke& s : strokes) request.strokes.push_back({s.camera, {s.stroke}, s.seen});
  request.choice = like.choice;
  request.part_step = like.part_step;
  request.up_world = like.up_world;
  return request;
}

}  // namespace

struct Session::Local {
  Local(Neighbourhood made, const SessionScene& scene)
      : near(std::move(made)), session({near.cloud, near.prepared, scene.up_world, scene.photographs}) {}

  // Sets of Gaussians that strokes may affect, as the neighbourhood numbers them.
  SeenGaussians seen_here(const SeenGaussians& seen) {
    if (!seen || near.row.empty()) return seen;
    constexpr std::size_t kMostSets = 8;
    const auto known = std::ranges::find(sets, seen, &std::pair<SeenGaussians, SeenGaussians>::first);
    if (known != sets.end()) return known->second;
    if (sets.size() == kMostSets) sets.erase(sets.begin());
    sets.emplace_back(seen, std::make_shared<const std::vector<std::uint8_t>>(in_neighbourhood(near, *seen)));
    return sets.back().second;
  }

  Neighbourhood near;
  LocalSession session;
  std::vector<std::pair<SeenGaussians, SeenGaussians>> sets;
  bool told = false;  // its stages stand in a result
};

Session::Session(SessionScene scene)
    : scene_(std::move(scene)),
      whole_{scene_.cloud, scene_.blocks ? scene_.blocks : std::make_shared<const CloudBlocks>(*scene_.cloud),
             scene_.up_world, scene_.photographs} {
  Hasher hash;
  hash.add(whole_.blocks->blocks());
  scene_.prepare.cache.scene = hash.value();
}

Session::~Session() = default;
Session::Session(Session&& other) noexcept = default;

const StrokeHits& Session::hits(const CameraStroke& stroke, const Job& job) {
  std::string key = key_of_strokes(request_of({&stroke, 1}, {}));
  const auto known = hits_.find(key);
  if (known != hits_.end()) return known->second;
  if (hits_.size() >= kMostPlaces) hits_.clear();
  StrokeHits found = stroke_hits({*scene_.cloud, nullptr, whole_.blocks.get()}, stroke, job);
  if (job.cancelled()) key.clear();  // it may be incomplete: asked again next time
  return hits_[key] = std::move(found);
}

bool Session::is_whole(const Cell& cell) const {
  return static_cast<double>(whole_.blocks->count_in(*scene_.cloud, cell.box_world())) >=
         kMostOfScene * static_cast<double>(scene_.cloud->size());
}

std::size_t Session::gaussians_in(const Place& place) const {
  return place.whole ? scene_.cloud->size() : whole_.blocks->count_in(*scene_.cloud, place.cell.box_world());
}

Place Session::seen_from(const Camera& eye, const glm::vec3& point_world) {
  const float distance = glm::distance(eye.centre_world(), point_world);
  return {.cell = cell_around(point_world, level_above(distance)),
          .looked_at = cell_around(point_world, nearest_level(distance)),
          .eye = eye};
}

// A splat may show far from its centre: what is hit is no sign that a Gaussian lies near.
Place Session::first_place(const Camera& eye, const Box& must_hold) const {
  Place place = seen_from(eye, must_hold.centre());
  // What is clicked from nearer than it was photographed does not fit into a cell of that distance.
  if (const auto usual = photographed_from(whole_, must_hold.centre()))
    place.cell = cell_around(must_hold.centre(), std::max(place.cell.level, level_above(*usual)));
  const auto gaussians = [&](const Cell& cell) {
    return whole_.blocks->count_in(*scene_.cloud, cell.box_world());
  };
  while (gaussians(place.cell) == 0) place.cell = cell_around(must_hold.centre(), place.cell.level + 1);
  for (int i = 0; i < kMostHalvings && gaussians(place.cell) > scene_.most_gaussians; ++i) {
    const Cell half = cell_around(must_hold.centre(), place.cell.level - 1);
    if (!holds(half, must_hold) || gaussians(half) == 0) break;
    place.cell = half;
  }
  place.whole = is_whole(place.cell);
  return place;
}

// The next larger cell that holds the box.
Place Session::grown(const Place& place, const Box& must_hold) const {
  Place next = place;
  do {
    next.cell = cell_around(must_hold.centre(), next.cell.level + 1);
  } while (!holds(next.cell, must_hold));
  next.whole = is_whole(next.cell);
  return next;
}

Place Session::place_of_all(const Camera& eye) const {
  Place place = seen_from(eye, robust_bounds(scene_.cloud->position).centre());
  place.whole = true;
  return place;
}

// Of what the masks show mostly; the whole scene if that is nothing.
Place Session::place_of_masks(const CutRequest& request, const CutSettings& settings, const Job& job) const {
  constexpr float kSides = 2;  // of what is shown
  MaskedSums sums(scene_.cloud->size());
  const Drawer drawer(*scene_.cloud, nullptr, whole_.blocks.get());
  const auto add = [&](const GivenView& given) {
    const Camera camera = limited_to_width(given.camera, settings.work_width_px);
    add_masked_sums(drawer, camera, resized_mask(given.mask, camera.width_px, camera.height_px), false, job,
                    &sums);
  };
  add(*request.first_mask);
  std::ranges::for_each(request.masks, add);
  std::vector<std::uint8_t> shown(scene_.cloud->size());
  for (std::size_t g = 0; g < shown.size(); ++g) shown[g] = 2 * sums.inside[g] > sums.total[g];
  const Box box = bounds_of(*scene_.cloud, shown);
  const float extent = std::max({box.extent().x, box.extent().y, box.extent().z});
  if (!(extent > 0)) return place_of_all(request.first_mask->camera);
  Place place = seen_from(request.first_mask->camera, box.centre());
  place.cell = cell_around(box.centre(), level_above(kSides * extent));
  place.whole = is_whole(place.cell);
  return place;
}

// Places are found stroke by stroke, so that one more stroke asks for no more than what it adds. That of the
// first is the likeliest meaning's, whichever is taken: the others are offered there.
std::optional<Session::Answered> Session::place_of_strokes(const CutRequest& request,
                                                           const CutSettings& settings, const Job& job) {
  const std::vector<CameraStroke> strokes = in_replay_order(strokes_in_order(request));
  if (strokes.empty() || strokes.front().stroke.label != SeedLabel::kObject) return {};
  const std::string how = fmt::format("{} {}", settings.work_width_px, settings.least_object_px);
  const auto first = [&](std::size_t count) { return std::span(strokes).first(count); };
  CutRequest likeliest = request;
  likeliest.choice = likeliest.part_step = 0;
  const auto like = [&](std::size_t count) -> const CutRequest& { return count > 1 ? request : likeliest; };
  const auto key = [&](std::size_t count) { return key_of(request_of(first(count), like(count))) + how; };
  std::size_t known = strokes.size();
  while (known > 0 && !places_.contains(key(known))) --known;
  std::optional<Answered> there;
  if (known > 0) there = places_.at(key(known));
  std::optional<Box> must_hold;
  for (std::size_t i = 0; i < strokes.size(); ++i) {
    if (strokes[i].stroke.label == SeedLabel::kObject)
      for (const auto& hit : hits(strokes[i], job))
        if (hit) must_hold = must_hold ? joined(*must_hold, {*hit, *hit}) : Box{*hit, *hit};
    if (job.cancelled() || !must_hold) return {};
    if (!there) there = Answered{first_place(strokes[0].camera, *must_hold)};
    if (i + 1 > known) {
      there = place_after(first(i + 1), like(i + 1), settings, *there, *must_hold, job);
      if (job.cancelled()) return {};
      if (places_.size() >= kMostPlaces) places_.clear();
      places_[key(i + 1)] = *there;
    }
    if (i == 0 && known <= 1) there = Answered{there->place, request.choice, request.part_step};
  }
  return there;
}

Session::Answered Session::place_after(std::span<const CameraStroke> strokes, const CutRequest& like,
                                       const CutSettings& settings, Answered answered, const Box& must_hold,
                                       const Job& job) {
  const CutRequest request = request_of(strokes, like);
  const auto grow = [&](const Box& to_hold) {
    const std::optional<Answered> larger =
        answered_in(grown(answered.place, to_hold), answered, request, settings, job);
    if (larger) answered = *larger;
    return larger.has_value();
  };
  if (!answered.place.whole && !holds(answered.place.cell, must_hold)) grow(must_hold);
  while (!job.cancelled()) {
    Local* there = local(answered.place, settings, job);
    if (!there) break;
    const std::vector<std::uint8_t> meant =
        there->session.meant(in_place(request, answered, there, job), settings, job);
    if (job.cancelled() || !touches_side(whole_, there->near, meant) ||
        !grow(joined(must_hold, bounds_of(*there->near.cloud, meant))))
      break;
  }
  return answered;
}

std::optional<Session::Answered> Session::place_of(const CutRequest& request, const CutSettings& settings,
                                                   const Job& job) {
  if (request.first_mask) return Answered{place_of_masks(request, settings, job)};
  const auto reference = std::ranges::find_if(request.strokes, marks_object);
  if (reference == request.strokes.end()) return {};
  if (by_parts(settings)) return place_of_strokes(request, settings, job);
  return Answered{place_of_all(reference->camera), request.choice, request.part_step};
}

// The meaning and size of the first stroke in a larger place that are most like those taken here: a place has
// its own meanings and sizes, in its own order. None: it has nothing alike, or cancelled.
std::optional<Session::Answered> Session::answered_in(const Place& larger, const Answered& here,
                                                      const CutRequest& request, const CutSettings& settings,
                                                      const Job& job) {
  if ((here.choice == 0 && here.part_step == 0) || request.first_mask || !by_parts(settings))
    return Answered{larger, here.choice, here.part_step};
  constexpr double kAlike = 0.7, kEnough = 0.9;  // IoU of labels within the smaller place
  constexpr double kCovers = 0.6;                // share of what was outlined that a size must show
  const std::vector<CameraStroke> strokes = in_replay_order(strokes_in_order(request));
  const CutRequest first = request_of(std::span(strokes).first(1), request);
  const Box box = here.place.cell.box_world();
  const std::size_t n = scene_.cloud->size();
  CutSettings alone = settings;
  alone.parts_only = true;
  const auto answer = [&](const Answered& answered) {
    CutResult result;
    if (Local* there = local(answered.place, settings, job))
      result = in_scene(*there, there->session.cut(in_place(first, answered, there, job), alone, job));
    result.labels.resize(n);
    return result;
  };
  const CutResult taken = answer(here);
  const std::vector<std::uint8_t>& wanted = taken.labels;
  const Mask outlined = taken.size_masks.empty() ? Mask() : taken.size_masks[taken.size];
  const auto covers = [&](const Mask& mask) {
    if (mask.width() != outlined.width() || mask.height() != outlined.height()) return true;
    std::size_t both = 0;
    for (std::size_t i = 0; i < mask.pixels().size(); ++i) both += mask.pixels()[i] && outlined.pixels()[i];
    return static_cast<double>(both) >= kCovers * static_cast<double>(count(outlined));
  };
  const auto likeness = [&](const std::vector<std::uint8_t>& labels) {
    std::size_t both = 0, any = 0;
    for (std::size_t g = 0; g < n; ++g) {
      if (!(wanted[g] || labels[g]) || !contains(box, scene_.cloud->position[g])) continue;
      both += wanted[g] && labels[g];
      ++any;
    }
    return static_cast<double>(both) / static_cast<double>(std::max<std::size_t>(any, 1));
  };
  std::optional<Answered> best;
  double most = kAlike;
  std::size_t meanings = 1;
  const auto look_at = [&](const Answered& answered, const std::vector<std::uint8_t>& labels) {
    const double alike = likeness(labels);
    if (alike <= most) return;
    most = alike;
    best = answered;
  };
  for (int choice = 0; choice < static_cast<int>(meanings) && most < kEnough; ++choice) {
    const CutResult own = answer({larger, choice, 0});
    meanings = own.meanings.size();
    look_at({larger, choice, 0}, own.labels);
    for (std::size_t size = 0; size < own.size_masks.size() && most < kEnough && !job.cancelled(); ++size) {
      const int step = static_cast<int>(size) - static_cast<int>(own.likeliest_size);
      if (step != 0 && covers(own.size_masks[size]))
        look_at({larger, choice, step}, answer({larger, choice, step}).labels);
    }
  }
  return job.cancelled() ? std::nullopt : best;
}

// What a first stroke can mean, and the steps of its size, are shown as they were offered, also where what is
// taken needed a larger place.
void Session::keep_offer(const CutRequest& request, const Answered& answered, const CutSettings& settings,
                         const Job& job, CutResult* result) {
  if (result->meanings.empty() || request.choice == 0) return;
  const std::vector<CameraStroke> strokes = in_replay_order(strokes_in_order(request));
  CutRequest first = request_of(std::span(strokes).first(1), request);
  first.choice = first.part_step = 0;
  const std::optional<Answered> offered = place_of(first, settings, job);
  if (!offered || offered->place == answered.place) return;
  CutSettings alone = settings;
  alone.parts_only = true;
  if (Local* there = local(offered->place, settings, job))
    result->meanings = there->session.cut(in_place(first, *offered, there, job), alone, job).meanings;
  result->choice = std::min(static_cast<std::size_t>(request.choice), result->meanings.size() - 1);
  result->likeliest_size = static_cast<std::size_t>(  // as the wheel counts from there
      std::max<std::ptrdiff_t>(0, static_cast<std::ptrdiff_t>(result->size) - request.part_step));
}

// Null if cancelled.
Session::Local* Session::local(const Place& place, const CutSettings& settings, const Job& job) {
  const bool with_parts = by_parts(settings);
  const auto known = std::ranges::find_if(locals_, [&](const Local& l) {
    return l.near.place == place && (!with_parts || !l.near.prepared->parts.leaf_of.empty());
  });
  if (known != locals_.end()) {
    locals_.splice(locals_.begin(), locals_, known);
    return &locals_.front();
  }
  if (ends_if_large_ && gaussians_in(place) > scene_.most_ahead) {
    ends_if_large_->request_stop();
    return nullptr;
  }
  Neighbourhood made = prepare_neighbourhood(whole_, place, with_parts ? &scene_.prepare : nullptr, job);
  if (job.cancelled()) return nullptr;
  locals_.emplace_front(std::move(made), scene_);
  std::size_t bytes = locals_.front().near.bytes();
  for (auto l = std::next(locals_.begin()); l != locals_.end();) {
    bytes += l->near.bytes();
    l = bytes > scene_.most_bytes ? locals_.erase(l) : std::next(l);
  }
  return &locals_.front();
}

// The request as the neighbourhood sees it.
CutRequest Session::in_place(const CutRequest& request, const Answered& answered, Local* there,
                             const Job& job) {
  CutRequest local = request;
  local.choice = answered.choice;
  local.part_step = answered.part_step;
  if (there->near.row.empty()) return local;
  const Box box = there->near.place.cell.box_world();
  local.strokes.clear();
  for (const StrokedView& view : request.strokes) {
    StrokedView here{view.camera, {}, there->seen_here(view.seen)};
    for (Stroke stroke : view.strokes) {
      if (stroke.label == SeedLabel::kRest) {
        const StrokeHits& at = hits({view.camera, stroke, view.seen}, job);
        const auto lies_here = [&](const auto& hit) { return hit && contains(box, *hit); };
        std::vector<glm::vec2> inside;
        for (std::size_t i = 0; i < stroke.points_px.size(); ++i)
          if (stroke.is_box() ? std::ranges::any_of(at, lies_here) : lies_here(at[i]))
            inside.push_back(stroke.points_px[i]);
        stroke.points_px = std::move(inside);
      }
      if (!stroke.points_px.empty()) here.strokes.push_back(std::move(stroke));
    }
    local.strokes.push_back(std::move(here));
  }
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

// The neighbourhood of the cut and its result there; null: nothing is marked or hit, or cancelled.
Session::Local* Session::settled(const CutRequest& request, const CutSettings& settings, const Job& job,
                                 const OnSnapshot& on_snapshot, CutResult* result, Answered* in) {
  check(settings);
  std::optional<Answered> answered = place_of(request, settings, job);
  while (answered && !job.cancelled()) {
    Local* there = local(answered->place, settings, job);
    if (!there) return nullptr;
    OnSnapshot in_whole;
    if (on_snapshot)
      in_whole = [&](CutPhase phase, const CutResult& so_far) {
        on_snapshot(phase, in_scene(*there, so_far));
      };
    *result = there->session.cut(in_place(request, *answered, there, job), settings, job, in_whole);
    std::optional<Answered> larger;
    if (result->outcome == Outcome::kDone && touches_side(whole_, there->near, result->labels))
      larger = answered_in(grown(answered->place, joined(answered->place.cell.box_world(),
                                                         bounds_of(*there->near.cloud, result->labels))),
                           *answered, request, settings, job);
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
  const std::vector<StageTime>& prepared = there->near.prepared->stages;
  if (!std::exchange(there->told, true))
    result.stages.insert(result.stages.begin(), prepared.begin(), prepared.end());
  return result;
}

Mask Session::first_mask(const CutRequest& request, const CutSettings& settings, const Job& job) {
  check(settings);
  const std::optional<Answered> answered = place_of(request, settings, job);
  if (!answered) return {};
  Local* there = local(answered->place, settings, job);
  return there ? there->session.first_mask(in_place(request, *answered, there, job), settings, job) : Mask();
}

Session::Preview Session::preview(const CutRequest& request, const CameraStroke& stroke,
                                  const CutSettings& settings, const Job& job) {
  if (!by_parts(settings)) return {};
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
                                            const CutSettings& settings, int views, const Job& job) {
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
    Mask seen = thresholded(render_labels(drawer, camera, result.labels, job), 0.5f);
    if (count(seen) > 0) around.push_back({camera, std::move(seen)});
  }
  return around;
}

}  // namespace splatcut
