#include "segment/session/pipeline.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/png_file.h"
#include "core/stage_clock.h"
#include "scene/raster/rasterizer.h"
#include "segment/graphcut/knn_graph.h"
#include "segment/graphcut/likelihood.h"
#include "segment/masks/cv_image.h"
#include "segment/masks/mask_tools.h"
#include "segment/masks/trim.h"
#include "segment/superpoints/part_view.h"

namespace splatcut {

namespace {

struct Picture {
  Image<Rgb8> rgb;
  Image<float> depth;  // expected
  Image<float> median_depth;
};

// Labels that differ, as a share of the object.
double changed_share(const std::vector<std::uint8_t>& before, const std::vector<std::uint8_t>& after) {
  std::size_t changed = 0, object = 0;
  for (std::size_t g = 0; g < after.size(); ++g) {
    changed += before[g] != after[g];
    object += after[g];
  }
  return static_cast<double>(changed) / static_cast<double>(std::max<std::size_t>(1, object));
}

Picture render(const Drawer& drawer, const Camera& camera, const Job& job) {
  RasterOptions options;
  options.depth = true;
  RasterOutput out = drawer.draw(camera, options, job);
  return {rgb8_from_linear(out.colour), std::move(out.expected_depth), std::move(out.median_depth)};
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

// One run: what the stages share.
class Run {
 public:
  Run(const CutScene& scene, const ReferenceView& reference, const CutRequest& request,
      const CutSettings& settings, const Job& job, const OnSnapshot& on_snapshot)
      : scene_(scene),
        drawer_(scene.drawer),
        cloud_(scene.drawer.cloud()),
        reference_(reference),
        request_(request),
        settings_(settings),
        job_(job),
        on_snapshot_(on_snapshot),
        clock_(&result_.stages),
        sums_(cloud_.size()),
        work_width_px_(settings.work_width_px) {}

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
  std::optional<Mask> find_object(const Camera& camera);
  bool too_small(const Mask& mask, const Camera& camera);
  void add_given(const GivenView& given);
  void add_view(const Camera& camera, const glm::vec3& object_centre_world);
  void add_stroked_views(const glm::vec3& object_centre_world);
  bool clicks_say_it() const {
    return settings_.first_mask_from == FirstMaskFrom::kParts && !request_.first_mask &&
           !request_.mask_source;
  }
  bool needs_pictures() const {
    return settings_.propagate.of_pictures || settings_.refine.solver != MaskSolver::kNone;
  }
  Mask drawn_labels(const Camera& camera) const;
  Mask labels_in(const Camera& camera);
  Mask propagated(const Camera& camera, const Picture& picture);
  bool hidden(const Camera& camera, const Mask& seen, double share);
  PartView parts_in(const Camera& camera);
  void pick(const Camera& camera);
  void obey();
  void complete(const Camera& camera, const Mask& mask);
  void join_enclosed_by(const PartView& view);
  Mask mask_from_pixels(const Camera& camera, const Strokes& strokes);
  void use(ViewReport view, Picture picture = {});
  void measure_agreement();

  const CutScene& scene_;
  const Drawer drawer_;
  const GaussianCloud& cloud_;
  const ReferenceView& reference_;
  const CutRequest& request_;
  const CutSettings& settings_;
  const Job& job_;
  const OnSnapshot& on_snapshot_;
  CutResult result_;
  StageClock clock_;
  MaskedSums sums_;
  std::vector<SeenView> seen_;    // empty unless the propagator is of pictures
  Image<float> reference_depth_;  // median, of the whole scene in the view that find_object() looked at last
  std::vector<Image<float>> scene_depths_;  // the same of result_.views; empty where a view was not drawn
  int work_width_px_;
  int used_views_ = 0;
};

void Run::solve(CutPhase phase) {
  clock_.time("cut", [&] {
    CutReport report = scene_.solver.solve(with_prior(likelihood(sums_), prior(), prior_px()), used_views_,
                                           looked_at(result_.views).pixels_per_view(), job_, result_.said);
    result_.cut = report;
    result_.labels = std::move(report.labels);
    keep_object(&result_);
  });
  snapshot(phase);
}

Mask Run::drawn_labels(const Camera& camera) const {
  return thresholded(render_labels(drawer_, camera, result_.labels, job_), 0.5f);
}

Mask Run::labels_in(const Camera& camera) {
  return clock_.time("labels in views", [&] { return drawn_labels(camera); });
}

void Run::use(ViewReport view, Picture picture) {
  view.used = true;
  if (settings_.propagate.of_pictures) {
    if (picture.rgb.empty())
      picture = clock_.time("view", [&] { return render(drawer_, view.camera, job_); });
    seen_.push_back({view.camera, std::move(picture.rgb), std::move(picture.depth), view.mask});
  }
  clock_.time("likelihood",
              [&] { add_masked_sums(drawer_, view.camera, view.mask, settings_.hard_counts, job_, &sums_); });
  ++used_views_;
  scene_depths_.resize(result_.views.size());
  scene_depths_.push_back(std::move(picture.median_depth));
  result_.views.push_back(std::move(view));
}

PartView Run::parts_in(const Camera& camera) {
  RasterOptions raster;
  raster.colour = false;
  raster.depth = true;
  RasterOutput out = drawer_.draw(camera, raster, job_);
  reference_depth_ = std::move(out.median_depth);
  return view_parts(scene_.parts, out.first_hit);
}

// What all strokes mean as parts becomes the labels.
void Run::pick(const Camera& camera) {
  clock_.time("first mask", [&] {
    const ClickSelection& picked = scene_.strokes.replay(
        drawer_, strokes_in_order(request_), replay_options(request_, settings_, scene_.model), job_);
    if (job_.cancelled()) return;
    result_.labels = picked.labels();
    result_.sizes = picked.sizes();
    result_.size = picked.size();
    result_.likeliest_size = picked.likeliest_size();
    result_.meanings.assign(picked.meanings().begin(), picked.meanings().end());
    result_.choice = picked.choice();
    result_.spot_alone = picked.spot_alone();
    result_.ambiguous = picked.ambiguous();
    result_.said = picked.said();
    join_enclosed_by(parts_in(camera));
    obey();
  });
}

// What strokes say of a Gaussian holds, whatever the views made of it.
void Run::obey() {
  obey_strokes(&result_);
}

void Run::join_enclosed_by(const PartView& view) {
  if (!settings_.join_enclosed || view.trees.empty()) return;
  std::vector<std::uint8_t> shown(cloud_.size(), 0);
  for (std::size_t g = 0; g < shown.size(); ++g)
    shown[g] = scene_.parts.leaf_of[g] != kNoPart && view.trees.front().pixels[scene_.parts.leaf_of[g]] > 0;
  join_enclosed(cloud_, scene_.graph, shown, settings_.enclosed, &result_.labels);
}

// What the mask means as parts becomes the labels.
void Run::complete(const Camera& camera, const Mask& mask) {
  clock_.time("first mask", [&] {
    const PartView view = parts_in(camera);
    if (job_.cancelled()) return;
    result_.labels = labels_of(scene_.parts, parts_of_mask(scene_.parts, view, mask, scene_.model.of_mask));
    join_enclosed_by(view);
  });
}

Mask Run::mask_from_pixels(const Camera& camera, const Strokes& strokes) {
  const Picture picture = clock_.time("view", [&] { return render(drawer_, camera, job_); });
  reference_depth_ = picture.median_depth;
  return clock_.time("first mask", [&] {
    return first_mask(picture.rgb, picture.depth, strokes, settings_.first_mask, job_);
  });
}

// The object's mask in this view, and what parts say of it as prior; nothing: cancelled.
std::optional<Mask> Run::find_object(const Camera& camera) {
  const bool by_parts = settings_.first_mask_from == FirstMaskFrom::kParts;
  const float scale = static_cast<float>(camera.width_px) / static_cast<float>(reference_.camera.width_px);
  Mask mask;
  if (request_.first_mask) {
    mask = resized_mask(request_.first_mask->mask, camera.width_px, camera.height_px);
    if (by_parts && count(mask) > 0) {
      complete(camera, mask);
      result_.prior = result_.labels;
    }
  } else if (by_parts) {
    pick(camera);
    if (job_.cancelled()) return std::nullopt;
    result_.prior = result_.labels;
    mask = labels_in(camera);
  } else {
    mask = mask_from_pixels(camera, scaled(reference_.strokes, scale));
  }
  if (job_.cancelled()) return std::nullopt;
  return mask;
}

// Then the view is looked at again with more pixels, at most once.
bool Run::too_small(const Mask& mask, const Camera& camera) {
  const int full_px = reference_.camera.width_px;
  const double side = std::sqrt(static_cast<double>(count(mask)));
  if (side == 0 || side >= settings_.least_object_px || camera.width_px >= full_px) return false;
  work_width_px_ =
      std::min(full_px, static_cast<int>(std::ceil(camera.width_px * settings_.least_object_px / side)));
  return true;
}

void Run::reference_view() {
  Camera camera = limited_to_width(reference_.camera, work_width_px_);
  std::optional<Mask> mask = find_object(camera);
  if (mask && too_small(*mask, camera)) {
    camera = limited_to_width(reference_.camera, work_width_px_);
    mask = find_object(camera);
  }
  if (!mask) return;
  const bool anything = count(*mask) > 0;
  use({camera, std::move(*mask), true, 0, {}},
      {.rgb = {}, .depth = {}, .median_depth = std::move(reference_depth_)});
  snapshot(CutPhase::kFirstMask);
  if (anything && !settings_.parts_only) solve();
}

// Whether the scene leaves less than `share` visible of the pixels that the object would show alone.
bool Run::hidden(const Camera& camera, const Mask& seen, double share) {
  return clock_.time("labels in views", [&] {
    const PixelRect rect = labelled_rectangle(cloud_, camera, result_.labels);
    if (rect.empty()) return true;
    const auto shown = static_cast<double>(count(seen));
    if (shown / (rect.width() * rect.height()) >= share)
      return false;  // alone it has no more pixels than these: no need to draw
    RasterOptions options;
    options.colour = false;
    options.shown = result_.labels;
    options.roi = rect;
    const std::size_t alone = count(thresholded(drawer_.draw(camera, options, job_).alpha, 0.5f));
    return alone == 0 || shown / static_cast<double>(alone) < share;
  });
}

// What is object in this view, before the picture has its say.
Mask Run::propagated(const Camera& camera, const Picture& picture) {
  const OpenView view{camera, picture.rgb, picture.depth, seen_, [&] { return drawn_labels(camera); }};
  return clock_.time(settings_.propagate.stage, [&] { return settings_.propagate.mask(view); });
}

void Run::add_given(const GivenView& given) {
  const Camera camera = limited_to_width(given.camera, work_width_px_);
  use({camera, resized_mask(given.mask, camera.width_px, camera.height_px), true, 0, {}});
  solve();
}

void Run::add_view(const Camera& camera, const glm::vec3& object_centre_world) {
  ViewReport view{camera, {}, false, 0, {}};
  if (request_.mask_source) {
    view.mask = request_.mask_source(view.camera);
    return use(std::move(view));
  }
  constexpr double kHidden = 0.2;
  // Where a wall or another thing stands before the object, from nearer.
  for (const float share : {1.0f, 0.7f, 0.5f}) {
    view.camera = approached(camera, object_centre_world, share);
    Picture picture;
    if (needs_pictures()) picture = clock_.time("view", [&] { return render(drawer_, view.camera, job_); });
    const Mask seen = propagated(view.camera, picture);
    if (job_.cancelled()) return;
    if (settings_.hidden_test && hidden(view.camera, seen, kHidden)) continue;
    view.mask =
        clock_.time("masks", [&] { return refine_mask(picture.rgb, picture.depth, seen, settings_.refine); });
    use(std::move(view), std::move(picture));
    return solve();
  }
  view.camera = camera;
  view.mask = Mask(view.camera.width_px, view.camera.height_px);
  view.reason = "the object is hidden here";
  result_.views.push_back(std::move(view));
}

// Where the user clicked is worth a look: those views come before all others.
void Run::add_stroked_views(const glm::vec3& object_centre_world) {
  if (settings_.first_mask_from != FirstMaskFrom::kParts || request_.mask_source) return;
  for (const StrokedView& view : strokes_by_view(request_.strokes))
    if (!view.strokes.empty() && !same_view(view.camera, reference_.camera) && !job_.cancelled())
      add_view(limited_to_width(view.camera, settings_.work_width_px), object_centre_world);
}

void Run::other_views() {
  if (!request_.masks.empty()) {
    for (const GivenView& given : request_.masks)
      if (!job_.cancelled()) add_given(given);
    result_.why_enough = fmt::format("all {} given masks", request_.masks.size() + 1);
    return;
  }
  const ObjectExtent extent = object_extent(cloud_, result_.labels);
  if (!(extent.radius > 0)) {
    result_.why_enough = "the object is too small to look around it";
    return;
  }
  const bool given = !request_.views.empty();
  OrbitOptions orbit = settings_.orbit;
  if (orbit.views == kViewsAsNeeded) orbit.views = clicks_say_it() ? 0 : kViewsAround;
  const std::vector<Camera> cameras =
      given ? request_.views
            : cameras_around(reference_.camera, scene_.up_world, extent, scene_.photographs, orbit);
  // On a circle the object is large, however small it is in the first view. Flow compares pictures of one
  // size.
  const int width_px = given || settings_.propagate.of_pictures ? work_width_px_ : settings_.work_width_px;
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
    if (view.used) view.confidence = iou(view.mask, labels_in(view.camera));
}

// Solves with all views, then once more without those that disagree, unless most do.
void Run::settle() {
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
    obey();
  });
}

}  // namespace

ReplayOptions replay_options(const CutRequest& request, const CutSettings& settings, const PartModel& model) {
  ReplayOptions options{.model = model.selection};
  options.part_step = request.part_step;
  options.choice = request.choice;
  options.work_width_px = settings.work_width_px;
  options.least_object_px = settings.least_object_px;
  return options;
}

std::vector<CameraStroke> strokes_in_order(const CutRequest& request) {
  std::vector<CameraStroke> strokes;
  for (const StrokedView& view : request.strokes)
    for (const Stroke& stroke : view.strokes) strokes.push_back({view.camera, stroke, view.seen});
  return strokes;
}

std::size_t trim_to_views(const Drawer& drawer, const std::vector<ViewReport>& views,
                          const CutSettings& settings, std::vector<std::uint8_t>* labels, const Job& job) {
  return trim_by(drawer, views, {}, settings, labels, job);
}

CutResult cut_from_reference(const CutScene& scene, const ReferenceView& reference, const CutRequest& request,
                             const CutSettings& settings, const Job& job, const OnSnapshot& on_snapshot) {
  Run run(scene, reference, request, settings, job, on_snapshot);
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
    nothing.reason = request.first_mask ? "the mask covers nothing of the scene"
                                        : "the strokes mark nothing that stands out in this view; click on "
                                          "the object itself, or scribble";
    nothing.labels.assign(scene.drawer.cloud().size(), 0);
    return nothing;
  }
  if (run.answered_by_parts()) return taken();
  run.other_views();
  if (job.cancelled()) return taken();
  run.settle();
  if (settings.trim && !job.cancelled()) run.trim_labels();
  return taken();
}

Mask first_mask_of(const CutScene& scene, const ReferenceView& reference, const CutRequest& request,
                   const CutSettings& settings, const Job& job) {
  CutSettings mask_alone = settings;
  mask_alone.parts_only = true;
  const OnSnapshot nobody;
  Run run(scene, reference, request, mask_alone, job, nobody);
  if (!job.cancelled()) run.reference_view();
  if (!run.result().views.empty()) return run.result().views.front().mask;
  const Camera camera = limited_to_width(reference.camera, settings.work_width_px);
  return Mask(camera.width_px, camera.height_px);
}

}  // namespace splatcut
