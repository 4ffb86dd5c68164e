#include "segment/pipeline.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scene/error.h"
#include "scene/png_file.h"
#include "scene/rasterizer.h"
#include "segment/cv_image.h"
#include "segment/knn_graph.h"
#include "segment/likelihood.h"
#include "segment/mask_tools.h"
#include "segment/stage_clock.h"
#include "segment/trim.h"

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
                    std::span<const Image<float>> scene_depths, const PipelineOptions& options,
                    std::vector<std::uint8_t>* labels, const Job& job) {
  std::vector<TrimView> seen;
  for (std::size_t i = 0; i < views.size(); ++i) {
    if (!views[i].used) continue;
    const bool drawn = i < scene_depths.size() && !scene_depths[i].empty();
    seen.push_back({views[i].camera, &views[i].mask, drawn ? &scene_depths[i] : nullptr});
  }
  return trim(drawer, seen, options.trim_options, labels, job);
}

// One run: what the stages share.
class Run {
 public:
  Run(const Drawer& drawer, const PreparedScene& prepared, const PipelineOptions& options, const Job& job,
      PipelineReport* report, CutSolver& solver)
      : drawer_(drawer),
        cloud_(drawer.cloud()),
        graph_(prepared.graph),
        parts_(prepared.parts),
        options_(options),
        job_(job),
        report_(*report),
        clock_(&report->stages),
        sums_(cloud_.size()),
        solver_(solver),
        work_width_px_(options.work_width_px) {}

  bool answered_by_parts() const { return !prior().empty() && !options_.cut_parts; }
  void reference_view(const Camera& full, const Strokes& strokes);
  void other_views(const Camera& reference, const glm::vec3& up_world);
  void settle();
  void trim_labels();

 private:
  const std::vector<std::uint8_t>& prior() const { return report_.prior; }
  float prior_px() const { return options_.prior_px_per_view * static_cast<float>(used_views_); }
  void snapshot() const {
    if (options_.on_snapshot && !job_.cancelled()) options_.on_snapshot(report_);
  }
  void solve();
  bool find_object(const Camera& camera, const Strokes& strokes);
  bool too_small(const Mask& mask, const Camera& camera, const Camera& full);
  void add_given(const GivenView& given);
  void add_view(const Camera& camera, const glm::vec3& object_centre_world);
  bool needs_pictures() const {
    return options_.propagate != Propagator::kLift || options_.refine.solver != MaskSolver::kNone;
  }
  Mask labels_in(const Camera& camera);
  Mask propagated(const Camera& camera, const Picture& picture);
  bool hidden(const Camera& camera, const Mask& seen, double share);
  PartView parts_in(const Camera& camera);
  void pick(const Camera& camera, const Strokes& strokes);
  void complete(const Camera& camera, const Mask& mask);
  void join_enclosed_by(const PartView& view);
  Mask mask_from_pixels(const Camera& camera, const Strokes& strokes);
  Mask with_feedback(const Camera& camera, const Picture& picture, const Mask& mask, const Strokes& strokes);
  void use(ViewReport view, Picture picture = {});
  void measure_agreement();

  const Drawer drawer_;
  const GaussianCloud& cloud_;
  const FlowGraph& graph_;
  const PartHierarchy& parts_;
  const PipelineOptions& options_;
  const Job& job_;
  PipelineReport& report_;
  StageClock clock_;
  MaskedSums sums_;
  CutSolver& solver_;
  std::vector<SeenView> seen_;    // in two dimensions; empty for kLift
  Image<float> reference_depth_;  // median, of the whole scene in the view that find_object() looked at last
  std::vector<Image<float>> scene_depths_;  // the same of report_.views; empty where a view was not drawn
  int work_width_px_;
  int used_views_ = 0;
};

void Run::solve() {
  clock_.time("cut", [&] {
    report_.cut = solver_.solve(with_prior(likelihood(sums_), prior(), prior_px()), used_views_,
                                looked_at(report_.views).pixels_per_view(), job_);
    report_.labels = report_.cut.labels;
  });
  snapshot();
}

Mask Run::labels_in(const Camera& camera) {
  return clock_.time("labels in views",
                     [&] { return thresholded(render_labels(drawer_, camera, report_.labels, job_), 0.5f); });
}

void Run::use(ViewReport view, Picture picture) {
  view.used = true;
  if (options_.propagate != Propagator::kLift) {
    if (picture.rgb.empty())
      picture = clock_.time("view", [&] { return render(drawer_, view.camera, job_); });
    seen_.push_back({view.camera, std::move(picture.rgb), std::move(picture.depth), view.mask});
  }
  clock_.time("likelihood",
              [&] { add_masked_sums(drawer_, view.camera, view.mask, options_.hard_counts, job_, &sums_); });
  ++used_views_;
  scene_depths_.resize(report_.views.size());
  scene_depths_.push_back(std::move(picture.median_depth));
  report_.views.push_back(std::move(view));
}

Mask Run::with_feedback(const Camera& camera, const Picture& picture, const Mask& mask,
                        const Strokes& strokes) {
  ViewReport view{camera, mask, true, 0, {}};
  use(view);
  solve();
  const Mask seen = labels_in(camera);
  report_.views.clear();
  seen_.clear();
  sums_ = MaskedSums(cloud_.size());
  used_views_ = 0;
  constexpr double kSaneChange = 0.5;  // a cut that keeps less than this of the mask is no correction
  if (iou(seen, mask) < kSaneChange) return mask;
  const Image<std::uint8_t> seeds = draw_seeds(strokes, camera.width_px, camera.height_px);
  return clock_.time("first mask", [&] {
    return refine_mask(picture.rgb, picture.depth, seen, options_.first_mask.refine, seeds);
  });
}

PartView Run::parts_in(const Camera& camera) {
  RasterOptions raster;
  raster.colour = false;
  raster.depth = true;
  RasterOutput out = drawer_.draw(camera, raster, job_);
  reference_depth_ = std::move(out.median_depth);
  return view_parts(parts_, out.first_hit);
}

// What the strokes mean as parts becomes the labels.
void Run::pick(const Camera& camera, const Strokes& strokes) {
  clock_.time("first mask", [&] {
    const PartView view = parts_in(camera);
    if (job_.cancelled()) return;
    const Pick picked = pick_parts(parts_, view, strokes, options_.pick);
    report_.labels = labels_of(parts_, picked.leaves);
    report_.first_sizes = picked.first_chain.size();
    report_.first_size = picked.first_chosen;
    report_.ambiguous = picked.ambiguous;
    join_enclosed_by(view);
  });
}

void Run::join_enclosed_by(const PartView& view) {
  if (!options_.join_enclosed || view.trees.empty()) return;
  std::vector<std::uint8_t> shown(cloud_.size(), 0);
  for (std::size_t g = 0; g < shown.size(); ++g)
    shown[g] = parts_.leaf_of[g] != kNoPart && view.trees.front().pixels[parts_.leaf_of[g]] > 0;
  join_enclosed(cloud_, graph_, shown, options_.enclosed, &report_.labels);
}

// What the mask means as parts becomes the labels.
void Run::complete(const Camera& camera, const Mask& mask) {
  clock_.time("first mask", [&] {
    const PartView view = parts_in(camera);
    if (job_.cancelled()) return;
    report_.labels = labels_of(parts_, parts_of_mask(parts_, view, mask));
    join_enclosed_by(view);
  });
}

Mask Run::mask_from_pixels(const Camera& camera, const Strokes& strokes) {
  const Picture picture = clock_.time("view", [&] { return render(drawer_, camera, job_); });
  reference_depth_ = picture.median_depth;
  Mask mask = clock_.time("first mask", [&] {
    return first_mask(picture.rgb, picture.depth, strokes, options_.first_mask, job_);
  });
  if (options_.feedback && count(mask) > 0 && !job_.cancelled())
    mask = with_feedback(camera, picture, mask, strokes);
  return mask;
}

// Whether a mask was found; false: cancelled.
bool Run::find_object(const Camera& camera, const Strokes& strokes) {
  Mask mask;
  if (options_.given_first_mask) {
    mask = resized_mask(*options_.given_first_mask, camera.width_px, camera.height_px);
    if (options_.first_mask_from == FirstMaskFrom::kParts && count(mask) > 0) {
      complete(camera, mask);
      report_.prior = report_.labels;
    }
  } else if (options_.first_mask_from == FirstMaskFrom::kParts) {
    pick(camera, strokes);
    if (job_.cancelled()) return false;
    report_.prior = report_.labels;
    mask = labels_in(camera);
  } else {
    mask = mask_from_pixels(camera, strokes);
  }
  if (job_.cancelled()) return false;
  report_.views.assign(1, {camera, std::move(mask), true, 0, {}});
  return true;
}

// Then the view is looked at again with more pixels, at most once.
bool Run::too_small(const Mask& mask, const Camera& camera, const Camera& full) {
  const double side = std::sqrt(static_cast<double>(count(mask)));
  if (side == 0 || side >= options_.least_object_px || camera.width_px >= full.width_px) return false;
  work_width_px_ =
      std::min(full.width_px, static_cast<int>(std::ceil(camera.width_px * options_.least_object_px / side)));
  return true;
}

void Run::reference_view(const Camera& full, const Strokes& strokes) {
  const auto look = [&] {
    const Camera camera = limited_to_width(full, work_width_px_);
    return find_object(
        camera, scaled(strokes, static_cast<float>(camera.width_px) / static_cast<float>(full.width_px)));
  };
  if (!look()) return report_.views.clear();
  if (too_small(report_.views.front().mask, report_.views.front().camera, full) && !look())
    return report_.views.clear();
  ViewReport view = std::move(report_.views.front());
  report_.views.clear();
  const bool anything = count(view.mask) > 0;
  use(std::move(view), {.rgb = {}, .depth = {}, .median_depth = std::move(reference_depth_)});
  snapshot();
  if (anything && options_.cut_parts) solve();
}

// Whether the scene leaves less than `share` visible of the pixels that the object would show alone.
bool Run::hidden(const Camera& camera, const Mask& seen, double share) {
  return clock_.time("labels in views", [&] {
    const PixelRect rect = labelled_rectangle(cloud_, camera, report_.labels);
    if (rect.empty()) return true;
    const auto shown = static_cast<double>(count(seen));
    if (shown / (rect.width() * rect.height()) >= share)
      return false;  // alone it has no more pixels than these: no need to draw
    RasterOptions options;
    options.colour = false;
    options.shown = report_.labels;
    options.roi = rect;
    const std::size_t alone = count(thresholded(drawer_.draw(camera, options, job_).alpha, 0.5f));
    return alone == 0 || shown / static_cast<double>(alone) < share;
  });
}

// What is object in this view, before the picture has its say.
Mask Run::propagated(const Camera& camera, const Picture& picture) {
  if (options_.propagate == Propagator::kLift) return labels_in(camera);
  const SeenView& nearest = *std::ranges::min_element(seen_, {}, [&](const SeenView& v) {
    return glm::distance(v.camera.centre_world(), camera.centre_world());
  });
  return clock_.time("masks", [&] {
    return options_.propagate == Propagator::kWarp ? warped_by_depth(nearest, camera, picture.depth)
                                                   : warped_by_flow(nearest, picture.rgb);
  });
}

void Run::add_given(const GivenView& given) {
  const Camera camera = limited_to_width(given.camera, work_width_px_);
  use({camera, resized_mask(given.mask, camera.width_px, camera.height_px), true, 0, {}});
  solve();
}

void Run::add_view(const Camera& camera, const glm::vec3& object_centre_world) {
  ViewReport view{camera, {}, false, 0, {}};
  if (options_.given_masks) {
    view.mask = options_.given_masks(view.camera);
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
    if (options_.hidden_test && hidden(view.camera, seen, kHidden)) continue;
    view.mask =
        clock_.time("masks", [&] { return refine_mask(picture.rgb, picture.depth, seen, options_.refine); });
    use(std::move(view), std::move(picture));
    return solve();
  }
  view.camera = camera;
  view.mask = Mask(view.camera.width_px, view.camera.height_px);
  view.reason = "the object is hidden here";
  report_.views.push_back(std::move(view));
}

void Run::other_views(const Camera& reference, const glm::vec3& up_world) {
  if (!options_.given_views.empty()) {
    for (const GivenView& given : options_.given_views)
      if (!job_.cancelled()) add_given(given);
    report_.enough = fmt::format("all {} given masks", options_.given_views.size() + 1);
    return;
  }
  const ObjectExtent extent = object_extent(cloud_, report_.labels);
  const bool given = !options_.view_cameras.empty();
  const std::vector<Camera> cameras =
      given ? options_.view_cameras
            : cameras_around(reference, up_world, extent, options_.scene_cameras, options_.orbit);
  // On a circle the object is large, however small it is in the first view. Flow compares pictures of one
  // size.
  const int width_px =
      given || options_.propagate != Propagator::kLift ? work_width_px_ : options_.work_width_px;
  int steady = 0;
  for (std::size_t i = 0; i < cameras.size() && !job_.cancelled(); ++i) {
    job_.progress("views", static_cast<double>(i) / static_cast<double>(cameras.size()));
    const std::vector<std::uint8_t> before = report_.labels;
    const int used_before = used_views_;
    add_view(limited_to_width(cameras[i], width_px), extent.centre_world);
    if (options_.given_masks || used_views_ == used_before) continue;
    steady = changed_share(before, report_.labels) < options_.settled_change ? steady + 1 : 0;
    if (steady < options_.settled_views) continue;
    report_.enough = fmt::format("labels changed by less than {:.1f} % in {} views running",
                                 100 * options_.settled_change, steady);
    return;
  }
  report_.enough = cameras.empty() ? "no view beside the first was asked for"
                                   : fmt::format("all {} views were looked at", cameras.size() + 1);
}

void Run::measure_agreement() {
  for (ViewReport& view : report_.views)
    if (view.used) view.confidence = iou(view.mask, labels_in(view.camera));
}

// Solves with all views, then once more without those that disagree, unless most do.
void Run::settle() {
  solve();
  measure_agreement();
  const auto disagrees = [&](const ViewReport& v) {
    return v.used && v.confidence < options_.view_agreement;
  };
  const auto bad = std::ranges::count_if(report_.views, disagrees);
  if (bad == 0 || 2 * bad >= used_views_) return;
  sums_ = MaskedSums(cloud_.size());
  used_views_ = 0;
  for (ViewReport& view : report_.views) {
    if (disagrees(view)) {
      view.used = false;
      view.disagreed = true;
      view.reason = "its mask disagrees with the others";
    }
    if (!view.used) continue;
    clock_.time("likelihood", [&] {
      add_masked_sums(drawer_, view.camera, view.mask, options_.hard_counts, job_, &sums_);
    });
    ++used_views_;
  }
  solve();
  measure_agreement();
}

void Run::trim_labels() {
  clock_.time("trim", [&] {
    report_.trimmed = trim_by(drawer_, report_.views, scene_depths_, options_, &report_.labels, job_);
  });
}

}  // namespace

LookedAt looked_at(const std::vector<ViewReport>& views) {
  LookedAt sum;
  for (const ViewReport& view : views)
    if (view.used) {
      ++sum.views;
      sum.pixels += view.mask.size();
    }
  return sum;
}

std::size_t trim_to_views(const Drawer& drawer, const std::vector<ViewReport>& views,
                          const PipelineOptions& options, std::vector<std::uint8_t>* labels, const Job& job) {
  return trim_by(drawer, views, {}, options, labels, job);
}

PipelineReport cut_out(const GaussianCloud& cloud, const PreparedScene* prepared, const Camera& reference,
                       const glm::vec3& up_world, const Strokes& strokes, const PipelineOptions& options,
                       const Job& job, CutSolver* solver, KeptViews* kept) {
  if (!options.cut_parts && options.first_mask_from != FirstMaskFrom::kParts)
    throw Error("settings", "the parts cannot be the answer where the first mask comes from pixels",
                "Leave one of the two out");
  PipelineReport report;
  PreparedScene made;
  if (!prepared) {
    made = prepare_scene(cloud, reference, up_world, options.scene_cameras, prepare_options(options), job);
    report.stages = made.stages;
    prepared = &made;
  }
  std::optional<CutSolver> fresh;
  if (!solver) solver = &fresh.emplace(cloud, prepared->graph, options.cut);
  std::optional<KeptViews> own;
  if (!kept) kept = &own.emplace(cloud);
  Run run({cloud, kept}, *prepared, options, job, &report, *solver);
  const auto cancelled = [&] {
    if (job.cancelled()) report.outcome = Outcome::kCancelled;
    return job.cancelled();
  };
  if (cancelled()) return report;
  run.reference_view(reference, strokes);
  if (cancelled()) return report;
  if (report.labels.empty() || std::ranges::none_of(report.labels, [](std::uint8_t l) { return l != 0; })) {
    report.outcome = Outcome::kNothingFound;
    report.reason =
        "the strokes mark nothing that stands out in this view; click on the object itself, or scribble";
    report.labels.assign(cloud.size(), 0);
    return report;
  }
  if (run.answered_by_parts()) return report;
  run.other_views(reference, up_world);
  if (cancelled()) return report;
  run.settle();
  if (options.trim && !job.cancelled()) run.trim_labels();
  cancelled();
  return report;
}

CutSolver ready_solver(const GaussianCloud& cloud, const PreparedScene& prepared,
                       const PipelineOptions& options) {
  CutSolver solver(cloud, prepared.graph, options.cut);
  solver.make_ready();
  make_lab_ready();
  return solver;
}

Mask first_mask_of(const GaussianCloud& cloud, const PreparedScene& prepared, const Camera& reference,
                   const Strokes& strokes, const PipelineOptions& options, const Job& job, KeptViews* kept) {
  PipelineReport report;
  CutSolver solver(cloud, prepared.graph, options.cut);
  std::optional<KeptViews> own;
  if (!kept) kept = &own.emplace(cloud);
  PipelineOptions mask_alone = options;
  mask_alone.cut_parts = false;
  Run run({cloud, kept}, prepared, mask_alone, job, &report, solver);
  run.reference_view(reference, strokes);
  if (report.views.empty()) {  // cancelled
    const Camera camera = limited_to_width(reference, options.work_width_px);
    return Mask(camera.width_px, camera.height_px);
  }
  return report.views.front().mask;
}

}  // namespace splatcut
