#include "segment/session/pipeline.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "core/stage_clock.h"
#include "segment/graphcut/likelihood.h"
#include "segment/masks/mask_tools.h"
#include "segment/masks/trim.h"
#include "segment/session/reference_mask.h"
#include "segment/session/view_mask.h"
#include "segment/superpoints/orbit.h"

namespace splatcut {

namespace {

// Labels that differ, as a share of the object.
double changed_share(const std::vector<std::uint8_t>& before, const std::vector<std::uint8_t>& after) {
  std::size_t changed = 0, object = 0;
  for (std::size_t g = 0; g < after.size(); ++g) {
    changed += before[g] != after[g];
    object += after[g];
  }
  return static_cast<double>(changed) / static_cast<double>(std::max<std::size_t>(1, object));
}

std::size_t trim_by(const Drawer& drawer, const std::vector<ViewReport>& views,
                    std::span<const Image<float>> scene_depths, const CutSettings& settings,
                    std::vector<std::uint8_t>* labels, const Job& job) {
  std::vector<TrimView> seen;
  for (std::size_t i = 0; i < views.size(); ++i) {
    if (!views[i].used) continue;
    const bool drawn = i < scene_depths.size() && !scene_depths[i].empty();
    seen.push_back({views[i].camera, &views[i].mask, drawn ? &scene_depths[i] : nullptr});
  }
  return trim(drawer, seen, settings.trim_options, labels, job);
}

// One cut on its way: what its stages share.
class Run {
 public:
  Run(const CutTask& task, const OnSnapshot& on_snapshot)
      : drawer_(task.scene.drawer),
        cloud_(task.scene.drawer.cloud()),
        task_(task),
        request_(task.request),
        settings_(task.settings),
        job_(task.job),
        on_snapshot_(on_snapshot),
        clock_(&result_.stages),
        sums_(cloud_.size()),
        work_width_px_(settings_.work_width_px) {}

  const CutResult& result() const { return result_; }
  CutResult take() { return std::move(result_); }
  bool answered_by_parts() const { return !prior().empty() && settings_.parts_only; }
  void reference_view();
  void other_views();
  void settle();
  void trim_labels();

 private:
  const std::vector<std::uint8_t>& prior() const { return result_.prior; }
  float prior_px() const { return settings_.prior_px_per_view * static_cast<float>(used_views_); }
  void snapshot(CutPhase phase) const {
    if (on_snapshot_ && !job_.cancelled()) on_snapshot_(phase, result_);
  }
  void solve(CutPhase phase = CutPhase::kViews);
  void use(ViewReport view, ViewPicture picture = {});
  bool too_small(const Mask& mask);
  std::vector<Camera> cameras_to_look_from(const ObjectExtent& extent) const;
  void add_given_views();
  void add_view(const Camera& camera, const glm::vec3& object_centre_world);
  void add_stroked_views(const glm::vec3& object_centre_world);
  void measure_agreement();

  const Drawer drawer_;
  const GaussianCloud& cloud_;
  const CutTask task_;
  const CutRequest& request_;
  const CutSettings& settings_;
  const Job& job_;
  const OnSnapshot& on_snapshot_;
  CutResult result_;
  StageClock clock_;
  MaskedSums sums_;
  std::vector<SeenView> seen_;              // empty unless the propagator is of pictures
  std::vector<Image<float>> scene_depths_;  // median, of result_.views; empty where a view was not drawn
  int work_width_px_;
  int used_views_ = 0;
  bool solved_all_ = false;  // the labels are those of all views that are used
};

void Run::solve(CutPhase phase) {
  clock_.time("cut", [&] {
    CutReport report =
        task_.scene.solver.solve(with_prior(likelihood(sums_), prior(), prior_px()), used_views_,
                                 looked_at(result_.views).pixels_per_view(), job_, result_.said);
    result_.cut = report;
    result_.labels = std::move(report.labels);
    keep_object(&result_);
  });
  solved_all_ = true;
  snapshot(phase);
}

// The view's mask is evidence from now on.
void Run::use(ViewReport view, ViewPicture picture) {
  view.used = true;
  if (settings_.propagate.of_pictures) {
    if (picture.rgb.empty())
      picture = clock_.time("view", [&] { return view_picture(drawer_, view.camera, job_); });
    seen_.push_back({view.camera, std::move(picture.rgb), std::move(picture.depth), view.mask});
  }
  clock_.time("likelihood",
              [&] { add_masked_sums(drawer_, view.camera, view.mask, settings_.hard_counts, job_, &sums_); });
  ++used_views_;
  solved_all_ = false;
  scene_depths_.resize(result_.views.size());
  scene_depths_.push_back(std::move(picture.median_depth));
  result_.views.push_back(std::move(view));
}

// If so, sets the width to look at the view again with more pixels; done at most once.
bool Run::too_small(const Mask& mask) {
  const int width_px = width_to_see(mask, settings_.least_object_px, task_.reference.camera.width_px);
  return std::exchange(work_width_px_, std::max(work_width_px_, width_px)) < width_px;
}

void Run::reference_view() {
  Camera camera = limited_to_width(task_.reference.camera, work_width_px_);
  std::optional<ReferenceMask> found = reference_mask(task_, camera, &result_);
  if (found && too_small(found->mask)) {
    camera = limited_to_width(task_.reference.camera, work_width_px_);
    found = reference_mask(task_, camera, &result_);
  }
  if (!found) return;
  const bool anything = count(found->mask) > 0;
  use({camera, std::move(found->mask), true, 0, {}},
      {.rgb = {}, .depth = {}, .median_depth = std::move(found->median_depth)});
  snapshot(CutPhase::kFirstMask);
  if (anything && !settings_.parts_only) solve();
}

void Run::add_given_views() {
  for (const GivenView& given : request_.masks) {
    if (job_.cancelled()) return;
    const Camera camera = limited_to_width(given.camera, work_width_px_);
    use({camera, resized_mask(given.mask, camera.width_px, camera.height_px), true, 0, {}});
    solve();
  }
}

void Run::add_view(const Camera& camera, const glm::vec3& object_centre_world) {
  if (request_.mask_source) return use({camera, request_.mask_source(camera), true, 0, {}});
  std::optional<FoundView> found = find_in_view(task_, camera, object_centre_world, seen_, &result_);
  if (!found) return;
  if (!found->report.used) return result_.views.push_back(std::move(found->report));
  use(std::move(found->report), std::move(found->picture));
  solve();
}

// Views that the user clicked in come before all others.
void Run::add_stroked_views(const glm::vec3& object_centre_world) {
  if (settings_.first_mask_from != FirstMaskFrom::kParts || request_.mask_source) return;
  for (const StrokedView& view : strokes_by_view(request_.strokes)) {
    if (view.strokes.empty() || same_view(view.camera, task_.reference.camera) || job_.cancelled()) continue;
    const std::size_t before = result_.views.size();
    add_view(limited_to_width(view.camera, settings_.work_width_px), object_centre_world);
    if (result_.views.size() > before) result_.views.back().clicked = true;
  }
}

std::vector<Camera> Run::cameras_to_look_from(const ObjectExtent& extent) const {
  if (!request_.views.empty()) return request_.views;
  const bool clicks_suffice =
      settings_.first_mask_from == FirstMaskFrom::kParts && !request_.first_mask && !request_.mask_source;
  OrbitOptions orbit = settings_.orbit;
  if (orbit.views == kViewsAsNeeded) orbit.views = clicks_suffice ? 0 : kViewsAround;
  return cameras_around(task_.reference.camera, task_.scene.up_world, extent, task_.scene.photographs, orbit);
}

void Run::other_views() {
  if (!request_.masks.empty()) {
    add_given_views();
    result_.why_enough = fmt::format("all {} given masks", request_.masks.size() + 1);
    return;
  }
  const ObjectExtent extent = object_extent(cloud_, result_.labels);
  if (!(extent.radius > 0)) {
    result_.why_enough = "the object is too small to look around it";
    return;
  }
  const std::vector<Camera> cameras = cameras_to_look_from(extent);
  // On a circle the object is large, however small it is in the first view. Flow compares pictures of one
  // size.
  const bool one_size = !request_.views.empty() || settings_.propagate.of_pictures;
  const int width_px = one_size ? work_width_px_ : settings_.work_width_px;
  add_stroked_views(extent.centre_world);
  int steady = 0;
  for (std::size_t i = 0; i < cameras.size() && !job_.cancelled(); ++i) {
    job_.progress("views", static_cast<double>(i) / static_cast<double>(cameras.size()));
    const std::vector<std::uint8_t> before = result_.labels;
    const int used_before = used_views_;
    add_view(limited_to_width(cameras[i], width_px), extent.centre_world);
    if (request_.mask_source || used_views_ == used_before) continue;
    steady = changed_share(before, result_.labels) < settings_.settled_change ? steady + 1 : 0;
    if (steady < settings_.settled_views) continue;
    result_.why_enough = fmt::format("labels changed by less than {:.1f} % in {} views running",
                                     100 * settings_.settled_change, steady);
    return;
  }
  result_.why_enough = cameras.empty() ? "no view around the object was asked for"
                                       : fmt::format("all {} views were looked at", cameras.size() + 1);
}

void Run::measure_agreement() {
  for (ViewReport& view : result_.views)
    if (view.used)
      view.confidence = clock_.time("labels in views", [&] {
        return iou(view.mask, labels_in_view(drawer_, view.camera, result_.labels, job_));
      });
}

// Solves with all views, then once more without those that disagree, unless most do.
void Run::settle() {
  if (solved_all_)
    snapshot(CutPhase::kSettled);
  else
    solve(CutPhase::kSettled);
  measure_agreement();
  const auto disagrees = [&](const ViewReport& v) {
    return v.used && v.confidence < settings_.view_agreement;
  };
  const auto bad = std::ranges::count_if(result_.views, disagrees);
  if (bad == 0 || 2 * bad >= used_views_) return;
  sums_ = MaskedSums(cloud_.size());
  used_views_ = 0;
  for (ViewReport& view : result_.views) {
    if (disagrees(view)) {
      view.used = false;
      view.disagreed = true;
      view.reason = "its mask disagrees with the others";
    }
    if (!view.used) continue;
    clock_.time("likelihood", [&] {
      add_masked_sums(drawer_, view.camera, view.mask, settings_.hard_counts, job_, &sums_);
    });
    ++used_views_;
  }
  solve(CutPhase::kSettled);
  measure_agreement();
}

void Run::trim_labels() {
  clock_.time("trim", [&] {
    result_.trimmed = trim_by(drawer_, result_.views, scene_depths_, settings_, &result_.labels, job_);
    obey_strokes(&result_);
  });
}

}  // namespace

std::size_t trim_to_views(const Drawer& drawer, const std::vector<ViewReport>& views,
                          const CutSettings& settings, std::vector<std::uint8_t>* labels, const Job& job) {
  return trim_by(drawer, views, {}, settings, labels, job);
}

CutResult cut_from_reference(const CutTask& task, const OnSnapshot& on_snapshot) {
  const Job& job = task.job;
  Run run(task, on_snapshot);
  const auto taken = [&] {
    CutResult result = run.take();
    if (job.cancelled()) result.outcome = Outcome::kCancelled;
    return result;
  };
  if (job.cancelled()) return taken();
  run.reference_view();
  if (job.cancelled()) return taken();
  if (std::ranges::none_of(run.result().labels, [](std::uint8_t l) { return l != 0; })) {
    CutResult nothing = taken();
    nothing.outcome = Outcome::kNothingFound;
    nothing.reason = task.request.first_mask
                         ? "the mask covers nothing of the scene"
                         : "the strokes mark nothing that stands out in this view; click on "
                           "the object itself, or scribble";
    nothing.labels.assign(task.scene.drawer.cloud().size(), 0);
    return nothing;
  }
  if (run.answered_by_parts()) return taken();
  run.other_views();
  if (job.cancelled()) return taken();
  run.settle();
  if (task.settings.trim && !job.cancelled()) run.trim_labels();
  return taken();
}

Mask first_mask_of(const CutTask& task) {
  CutSettings mask_alone = task.settings;
  mask_alone.parts_only = true;
  const OnSnapshot nobody;
  Run run({task.scene, task.reference, task.request, mask_alone, task.job}, nobody);
  if (!task.job.cancelled()) run.reference_view();
  if (!run.result().views.empty()) return run.result().views.front().mask;
  const Camera camera = limited_to_width(task.reference.camera, task.settings.work_width_px);
  return Mask(camera.width_px, camera.height_px);
}

}  // namespace splatcut
