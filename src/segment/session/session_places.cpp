// Where a session answers a request: the cells that it prepares, and what a first stroke means in each.
#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "segment/masks/mask_tools.h"
#include "segment/session/kept_neighbourhood.h"
#include "segment/session/reference_mask.h"
#include "segment/superpoints/usual_picture.h"

namespace splatcut {

namespace {

constexpr double kAlike = 0.7, kEnough = 0.9;  // IoU of labels of two places within the smaller one
constexpr double kMostOfScene = 0.7;           // a cell that holds this share of the Gaussians is the scene
constexpr int kMostHalvings = 5;               // of the first cell

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

constexpr std::uint32_t kNotThere = std::numeric_limits<std::uint32_t>::max();

// Where each of the rows stands among others; both ascending, empty: all of the scene.
std::vector<std::uint32_t> rows_among(const std::vector<std::uint32_t>& rows,
                                      const std::vector<std::uint32_t>& others) {
  if (others.empty()) return rows;
  std::vector<std::uint32_t> among;
  for (const std::uint32_t row : rows) {
    const auto at = std::ranges::lower_bound(others, row);
    among.push_back(at != others.end() && *at == row ? static_cast<std::uint32_t>(at - others.begin())
                                                     : kNotThere);
  }
  return among;
}

// IoU of labels of a small place and of a large one; among: where the rows of the small stand in the large.
double likeness(std::span<const std::uint8_t> small, std::span<const std::uint8_t> large,
                std::span<const std::uint32_t> among) {
  if (small.empty() || large.empty()) return 0;
  std::size_t both = 0, either = 0;
  for (std::size_t g = 0; g < among.size(); ++g) {
    const bool in_large = among[g] != kNotThere && large[among[g]] != 0;
    both += small[g] != 0 && in_large;
    either += small[g] != 0 || in_large;
  }
  return static_cast<double>(both) / static_cast<double>(std::max<std::size_t>(either, 1));
}

// rows: of the scene, that the labels are of.
std::shared_ptr<const std::vector<std::uint32_t>> object_rows(std::span<const std::uint8_t> labels,
                                                              std::span<const std::uint32_t> rows) {
  std::vector<std::uint32_t> object;
  for (std::size_t g = 0; g < labels.size(); ++g)
    if (labels[g]) object.push_back(rows[g]);
  return std::make_shared<const std::vector<std::uint32_t>>(std::move(object));
}

std::vector<std::uint8_t> changed(const std::vector<std::uint8_t>& before,
                                  const std::vector<std::uint8_t>& after) {
  std::vector<std::uint8_t> change(after.size());
  for (std::size_t g = 0; g < std::min(before.size(), after.size()); ++g) change[g] = before[g] != after[g];
  return change;
}

// Whether a size shows most of what was taken, so that it may be the same: looked at before its labels are.
bool covers(const Mask& mask, const CutResult& taken) {
  constexpr double kMost = 0.6;
  if (taken.size >= taken.size_masks.size()) return true;
  const Mask& wanted = taken.size_masks[taken.size];
  if (mask.width() != wanted.width() || mask.height() != wanted.height()) return true;
  std::size_t both = 0;
  for (std::size_t i = 0; i < mask.pixels().size(); ++i)
    both += mask.pixels()[i] != 0 && wanted.pixels()[i] != 0;
  return static_cast<double>(both) >= kMost * static_cast<double>(count(wanted));
}

}  // namespace

SeenGaussians labels_in(const Neighbourhood& near, const std::vector<std::uint32_t>& object_rows) {
  std::vector<std::uint8_t> labels(near.cloud->size(), 0);
  for (const std::uint32_t g : rows_among(object_rows, near.row))
    if (g != kNotThere) labels[g] = 1;
  return std::make_shared<const std::vector<std::uint8_t>>(std::move(labels));
}

CutRequest request_of(std::span<const CameraStroke> strokes, const CutRequest& like) {
  CutRequest request;
  for (const CameraStroke& s : strokes) request.strokes.push_back({s.camera, {s.stroke}, s.seen});
  request.choice = like.choice;
  request.up_world = like.up_world;
  return request;
}

CutRequest first_of(const CutRequest& request) {
  const std::vector<CameraStroke> strokes = in_replay_order(strokes_in_order(request));
  CutRequest first = request_of(std::span(strokes).first(1), request);
  first.choice = first.strokes.front().strokes.front().size_step = 0;
  return first;
}

int first_size_step(const CutRequest& request) {
  const Stroke* first = first_stroke(request.strokes);
  return first ? first->size_step : 0;
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
  // What is clicked from nearer than usual does not fit into a cell of that distance.
  const glm::vec3 at = must_hold.centre();
  const std::optional<UsualPicture> usual = usual_picture(eye, whole_.capture, at);
  if (usual) {
    place.cell = cell_around(at, std::max(place.cell.level, level_above(usual->distance)));
    if (is_close_up(usual)) place.closer = usual->distance / glm::distance(eye.centre_world(), at);
  }
  // A close-up would say of what it cuts off that nobody means it.
  place.eye = with_margins(eye, margins_of_close_up(eye, usual));
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

// The next larger cell that holds the neighbourhood's, and what is labelled.
Place Session::grown_about(const Neighbourhood& near, std::span<const std::uint8_t> labels) const {
  return grown(near.place, joined(near.place.cell.box_world(), bounds_of(*near.cloud, labels)));
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

void Session::keep_place(const std::string& key, const Answered& answered) {
  const auto& rows = answered.carried.rows;
  places_.put(key, answered,
              sizeof(answered) + answered.size_steps.size() * sizeof(int) +
                  (rows ? rows->size() * sizeof((*rows)[0]) : 0));
}

// Places are found stroke by stroke, so that one more stroke asks for no more than what it adds. That of the
// first is the likeliest meaning's, whichever is taken: the others are offered there.
std::optional<Session::Answered> Session::place_of_strokes(const CutRequest& request,
                                                           const CutSettings& settings, const Job& job) {
  const std::vector<CameraStroke> strokes = in_replay_order(strokes_in_order(request));
  if (strokes.empty() || strokes.front().stroke.label != SeedLabel::kObject) return {};
  const std::string how = fmt::format("{} {}", settings.work_width_px, settings.least_object_px);
  const auto first = [&](std::size_t count) {
    return count > 1 ? request_of(std::span(strokes).first(count), request) : first_of(request);
  };
  const auto key = [&](std::size_t count) { return key_of(first(count)) + how; };
  std::size_t known = strokes.size();
  while (known > 0 && !places_.find(key(known))) --known;
  std::optional<Answered> there;
  if (known > 0) there = *places_.find(key(known));
  std::optional<Box> must_hold;
  for (std::size_t i = 0; i < strokes.size(); ++i) {
    if (strokes[i].stroke.label == SeedLabel::kObject)
      for (const auto& hit : hits(strokes[i], job))
        if (hit) must_hold = must_hold ? joined(*must_hold, {*hit, *hit}) : Box{*hit, *hit};
    if (job.cancelled() || !must_hold) return {};
    if (!there) there = Answered{first_place(strokes[0].camera, *must_hold)};
    if (i + 1 > known) {
      if (strokes.size() > known + 1)  // of work that is opened again
        job.progress("what strokes hit",
                     static_cast<double>(i - known) / static_cast<double>(strokes.size() - known));
      // Another size is one of those where the stroke's own is answered.
      CutRequest own_size = first(i + 1);
      own_size.strokes.back().strokes.back().size_step = 0;
      const std::string own_key = key_of(own_size) + how;
      if (i > 0) there->size_steps.push_back(0);
      const Answered* own = places_.find(own_key);
      there = own ? *own : place_after(own_size, settings, *there, *must_hold, job);
      if (job.cancelled()) return {};
      keep_place(own_key, *there);
      if (i > 0 && strokes[i].stroke.size_step != 0) {
        there =
            stepped(first(i + 1), settings, *there, own_key, strokes[i].stroke.size_step, *must_hold, job);
        if (job.cancelled()) return {};
        keep_place(key(i + 1), *there);
      }
    }
    if (i == 0 && known <= 1) {
      const Answered own{there->place, request.choice, {0}};
      there = stepped(request_of(std::span(strokes).first(1), request), settings, own,
                      fmt::format("{} {}", key(1), request.choice), strokes.front().stroke.size_step,
                      *must_hold, job);
      if (job.cancelled()) return {};
    }
  }
  return there;
}

// Where the last stroke's own size was answered, so many steps on, each from where the one before is
// answered: a larger place has further sizes. Where there are none, all further steps are one. own_key: of
// the own size.
Session::Answered Session::stepped(const CutRequest& request, const CutSettings& settings, Answered answered,
                                   const std::string& own_key, int step, const Box& must_hold,
                                   const Job& job) {
  const int towards = step < 0 ? -1 : 1;
  for (int at = towards; at * towards <= step * towards && !job.cancelled(); at += towards) {
    const std::string key = fmt::format("{} step {}", own_key, at);
    if (const Answered* known = places_.find(key)) {
      answered = *known;
      continue;
    }
    if (answered.size_steps.back() != 0 && at_last_size(request, settings, answered, towards > 0, job)) {
      answered.size_steps.back() += step - at + towards;
      break;
    }
    answered.size_steps.back() += towards;
    answered = place_after(request, settings, answered, must_hold, job);
    if (!job.cancelled()) keep_place(key, answered);
  }
  return answered;
}

// False where the place lacks the request's last stroke.
bool Session::at_last_size(const CutRequest& request, const CutSettings& settings, const Answered& answered,
                           bool larger, const Job& job) {
  Local* there = local(answered.place, settings, job);
  if (!there) return false;
  const CutRequest here = in_place(request, answered, there, job);
  return strokes_in_order(here).size() == strokes_in_order(request).size() &&
         there->session.at_last_size(here, settings, larger, job);
}

Session::Answered Session::place_after(const CutRequest& request, const CutSettings& settings,
                                       Answered answered, const Box& must_hold, const Job& job) {
  if (!answered.place.whole && !holds(answered.place.cell, must_hold)) {
    const Place larger = grown(answered.place, must_hold);
    // What is clicked must be there, whatever the first stroke means then.
    answered = answered_in(larger, answered, request, settings, job)
                   .value_or(Answered{larger, answered.choice, answered.size_steps});
  }
  while (!job.cancelled()) {
    Local* there = local(answered.place, settings, job);
    if (!there) break;
    const std::vector<std::uint8_t> meant =
        there->session.meant(in_place(request, answered, there, job), settings, job);
    if (job.cancelled() || !touches_side(whole_, there->near, meant)) break;
    const std::optional<Answered> larger =
        answered_in(grown(answered.place, joined(must_hold, bounds_of(*there->near.cloud, meant))), answered,
                    request, settings, job);
    if (!larger) break;
    answered = *larger;
  }
  return answered;
}

std::optional<Session::Answered> Session::place_of(const CutRequest& request, const CutSettings& settings,
                                                   const Job& job) {
  if (request.first_mask) return Answered{place_of_masks(request, settings, job)};
  const auto reference = std::ranges::find_if(request.strokes, marks_object);
  if (reference == request.strokes.end()) return {};
  if (by_parts(settings)) return place_of_strokes(request, settings, job);
  return Answered{place_of_all(reference->camera), request.choice};
}

// What is taken here in a larger place, which has its own meanings and sizes, in its own order. What the
// strokes before the last one say was shown, and stays: where they mean something else there, it is carried
// over. None: the place has nothing like a first stroke's, or cancelled.
std::optional<Session::Answered> Session::answered_in(const Place& larger, const Answered& here,
                                                      const CutRequest& request, const CutSettings& settings,
                                                      const Job& job) {
  const auto in_their_own = [](const Answered& a) {
    return a.choice == 0 && std::ranges::all_of(a.size_steps, [](int step) { return step == 0; });
  };
  Answered there{larger, here.choice, here.size_steps};
  if (request.first_mask || !by_parts(settings)) return there;
  const std::vector<CameraStroke> strokes = in_replay_order(strokes_in_order(request));
  if (strokes.size() == 1)
    return in_their_own(here) ? there : first_answered_in(larger, here, request, settings, job);
  const CutRequest before = request_of(std::span(strokes).first(strokes.size() - 1), request);
  there.carried = here.carried;
  if (here.carried.strokes < strokes.size() - 1) {
    Local* place = local(here.place, settings, job);
    if (!place) return {};
    const std::vector<std::uint8_t> shown =
        place->session.meant(in_place(before, here, place, job), settings, job);
    const std::vector<std::uint32_t> rows = place->near.row;  // the place may be pushed out
    there.carried = {};
    place = local(larger, settings, job);
    if (!place) return {};
    const std::vector<std::uint8_t> anew =
        place->session.meant(in_place(before, there, place, job), settings, job);
    if (job.cancelled()) return {};
    if (in_their_own(here) && likeness(shown, anew, rows_among(rows, place->near.row)) > kEnough)
      return there;
    there.carried = {strokes.size() - 1, object_rows(shown, rows)};
  }
  if (there.size_steps.size() == strokes.size() && there.size_steps.back() != 0) {
    there.size_steps.back() = 0;
    there.size_steps.back() = step_in(there, here, before, request_of(strokes, request), settings, job);
  }
  return job.cancelled() ? std::nullopt : std::optional(there);
}

// How many of the steps go beyond the sizes that there were to choose from. Those continue in a larger place,
// which may have more.
int steps_beyond(int step, const CutResult& taken) {
  const int most = static_cast<int>(taken.size) - static_cast<int>(taken.likeliest_size);
  return taken.sizes == 0 ? 0 : step - most;
}

// The step of the last stroke of `after` that changes most nearly what its step changes here.
int Session::step_in(Answered there, const Answered& here, const CutRequest& before, const CutRequest& after,
                     const CutSettings& settings, const Job& job) {
  CutSettings alone = settings;
  alone.parts_only = true;
  Local* place = local(here.place, settings, job);
  if (!place) return 0;
  const CutResult taken = place->session.cut(in_place(after, here, place, job), alone, job);
  const std::vector<std::uint8_t> wanted =
      changed(place->session.meant(in_place(before, here, place, job), settings, job), taken.labels);
  const std::vector<std::uint32_t> rows = place->near.row;  // the place may be pushed out
  place = local(there.place, settings, job);
  if (!place || job.cancelled()) return 0;
  const std::vector<std::uint32_t> among = rows_among(rows, place->near.row);
  const std::vector<std::uint8_t> from =
      place->session.meant(in_place(before, there, place, job), settings, job);
  const CutResult own = place->session.cut(in_place(after, there, place, job), alone, job);
  int best = 0;
  double most = likeness(wanted, changed(from, own.labels), among);
  for (std::size_t size = 0; size < own.size_masks.size() && !job.cancelled(); ++size) {
    const int step = static_cast<int>(size) - static_cast<int>(own.likeliest_size);
    if (step == 0 || !covers(own.size_masks[size], taken)) continue;
    there.size_steps.back() = step;
    const double alike = likeness(
        wanted, changed(from, place->session.meant(in_place(after, there, place, job), settings, job)),
        among);
    if (alike <= most) continue;
    most = alike;
    best = step;
  }
  return best + steps_beyond(here.size_steps[there.size_steps.size() - 1], taken);
}

// The meaning and size of the first stroke that are most like those taken here.
std::optional<Session::Answered> Session::first_answered_in(const Place& larger, const Answered& here,
                                                            const CutRequest& request,
                                                            const CutSettings& settings, const Job& job) {
  if (here.choice == 0 && here.size_steps.front() == 0) return Answered{larger, 0, {0}};
  const CutRequest first = first_of(request);
  CutSettings alone = settings;
  alone.parts_only = true;
  Local* there = local(here.place, settings, job);
  if (!there) return {};
  const CutResult taken = there->session.cut(in_place(first, here, there, job), alone, job);
  const std::vector<std::uint32_t> rows = there->near.row;  // the place may be pushed out
  there = local(larger, settings, job);
  if (!there || job.cancelled()) return {};
  const std::vector<std::uint32_t> among = rows_among(rows, there->near.row);
  std::optional<Answered> best;
  double most = kAlike;
  const auto look_at = [&](const Answered& answered, const std::vector<std::uint8_t>& labels) {
    const double alike = likeness(taken.labels, labels, among);
    if (alike <= most) return;
    most = alike;
    best = answered;
  };
  std::size_t meanings = 1;
  for (int choice = 0; choice < static_cast<int>(meanings) && most < kEnough; ++choice) {
    const auto request_for = [&](int step) { return in_place(first, {larger, choice, {step}}, there, job); };
    const CutResult own = there->session.cut(request_for(0), alone, job);
    meanings = own.meanings.size();
    look_at({larger, choice, {0}}, own.labels);
    for (std::size_t size = 0; size < own.size_masks.size() && most < kEnough && !job.cancelled(); ++size) {
      const int step = static_cast<int>(size) - static_cast<int>(own.likeliest_size);
      if (step != 0 && covers(own.size_masks[size], taken))
        look_at({larger, choice, {step}}, there->session.meant(request_for(step), settings, job));
    }
  }
  if (best) best->size_steps.front() += steps_beyond(here.size_steps.front(), taken);
  return job.cancelled() ? std::nullopt : best;
}

}  // namespace splatcut
