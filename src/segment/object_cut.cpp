#include "segment/object_cut.h"

#include <algorithm>
#include <cmath>
#include <limits>

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

constexpr int kCorrectionWeight =
    4;  // times the views used: a correction must win against all that missed it

template <class Value>
void append(std::string* key, const Value& value) {
  static_assert(std::is_trivially_copyable_v<Value>);
  key->append(reinterpret_cast<const char*>(&value), sizeof(value));
}

void append_camera(std::string* key, const Camera& c) {
  for (const int v : {c.width_px, c.height_px}) append(key, v);
  for (const float v : {c.fx_px, c.fy_px, c.cx_px, c.cy_px}) append(key, v);
  append(key, c.camera_from_world_rotation);
  append(key, c.camera_from_world_translation);
}

void append_view(std::string* key, const StrokedView& view) {
  append_camera(key, view.camera);
  append(key, view.strokes.size());
  for (const Stroke& stroke : view.strokes) {
    append(key, stroke.label);
    append(key, stroke.radius_px);
    append(key, stroke.points_px.size());
    for (const glm::vec2& p : stroke.points_px) append(key, p);
  }
}

bool marks_object(const StrokedView& view) {
  return std::ranges::any_of(view.strokes, [](const Stroke& s) { return s.label == SeedLabel::kObject; });
}

std::string key_of_first(const ObjectCutInput& input, const StrokedView& reference) {
  std::string key = input.preset + '\0';
  append(&key, input.up_world);
  append(&key, input.part_step);
  append_view(&key, reference);
  return key;
}

std::string key_of_views(const std::vector<ViewReport>& views) {
  std::string key;
  for (const ViewReport& view : views) {
    if (!view.used) continue;
    append_camera(&key, view.camera);
    key.append(reinterpret_cast<const char*>(view.mask.data()), view.mask.size());
  }
  return key;
}

Strokes swapped(const Strokes& strokes) {
  Strokes out = strokes;
  for (Stroke& s : out) s.label = s.label == SeedLabel::kObject ? SeedLabel::kRest : SeedLabel::kObject;
  return out;
}

// A stroked view other than the reference: what the labels show there, and what the strokes say instead.
struct Correction {
  Camera camera;
  Mask mask, added, removed;
};

Correction corrected(const Drawer& drawer, const StrokedView& view, const std::vector<std::uint8_t>& labels,
                     const PipelineOptions& options, const Job& job) {
  Correction out;
  out.camera = limited_to_width(view.camera, options.work_width_px);
  const int width = out.camera.width_px, height = out.camera.height_px;
  const Strokes here =
      scaled(view.strokes, static_cast<float>(width) / static_cast<float>(view.camera.width_px));
  RasterOptions raster;
  raster.depth = true;
  const RasterOutput drawn = drawer.draw(out.camera, raster, job);
  const Image<Rgb8> picture = rgb8_from_linear(drawn.colour);
  const Mask prior = thresholded(render_labels(drawer, out.camera, labels, job), 0.5f);
  const auto grown_from = [&](const Strokes& strokes, SeedLabel wanted) {
    const bool any = std::ranges::any_of(strokes, [&](const Stroke& s) { return s.label == wanted; });
    if (!any || job.cancelled()) return Mask(width, height);
    return first_mask(picture, drawn.expected_depth,
                      wanted == SeedLabel::kObject ? strokes : swapped(strokes), options.first_mask, job);
  };
  const Mask plus = grown_from(here, SeedLabel::kObject), minus = grown_from(here, SeedLabel::kRest);
  const Image<std::uint8_t> seeds = draw_seeds(here, width, height);
  out.mask = out.added = out.removed = Mask(width, height);
  for (std::size_t i = 0; i < prior.size(); ++i) {
    bool object = (prior.pixels()[i] || plus.pixels()[i]) && !minus.pixels()[i];
    if (seeds.pixels()[i] != kNoSeed) object = seeds.pixels()[i] == kObjectSeed;
    out.mask.pixels()[i] = object ? kMaskObject : 0;
    // Strokes count as changes where they confirm, too: later views must not undo them.
    if (object && (!prior.pixels()[i] || seeds.pixels()[i] == kObjectSeed))
      out.added.pixels()[i] = kMaskObject;
    if (!object && (prior.pixels()[i] || seeds.pixels()[i] == kRestSeed))
      out.removed.pixels()[i] = kMaskObject;
  }
  return out;
}

void add_weighted(const Drawer& drawer, const Correction& correction, std::int64_t weight, bool whole_pixels,
                  const Job& job, MaskedSums* sums) {
  const std::size_t n = drawer.cloud().size();
  MaskedSums added(n), removed(n);
  add_masked_sums(drawer, correction.camera, correction.added, whole_pixels, job, &added);
  add_masked_sums(drawer, correction.camera, correction.removed, whole_pixels, job, &removed);
  for (std::size_t g = 0; g < n; ++g) {
    sums->total[g] += weight * (added.inside[g] + removed.inside[g]);
    sums->inside[g] += weight * added.inside[g];
  }
}

}  // namespace

std::string key_of(const ObjectCutInput& input) {
  std::string key = input.preset + '\0';
  append(&key, input.up_world);
  append(&key, input.smoothness.value_or(-1.0f));
  append(&key, input.part_step);
  for (const int view : input.left_out) append(&key, view);
  for (const StrokedView& view : input.views) append_view(&key, view);
  return key;
}

SceneSolvers::SceneSolvers(std::shared_ptr<const GaussianCloud> cloud,
                           std::shared_ptr<const PreparedScene> prepared)
    : cloud_(std::move(cloud)), prepared_(std::move(prepared)), views_(*cloud_) {}

const PreparedScene& SceneSolvers::prepared(const PipelineOptions& options, const Job& job) {
  const auto as_prepared = static_cast<int>(prepared_->graph.listed);
  // A cloud of fewer Gaussians than neighbours asked for, or parts wanted: what is there.
  if (options.neighbours >= as_prepared || options.first_mask_from == FirstMaskFrom::kParts)
    return *prepared_;
  if (other_ && static_cast<int>(other_->graph.listed) == options.neighbours) return *other_;
  other_solver_.reset();
  other_.emplace().graph = knn_graph(*cloud_, prepare_options(options).graph, job);
  return *other_;
}

CutSolver& SceneSolvers::solver(const PipelineOptions& options, const Job& job) {
  const PreparedScene& scene = prepared(options, job);
  std::optional<CutSolver>& solver = &scene == prepared_.get() ? solver_ : other_solver_;
  if (solver)
    solver->set_options(options.cut);
  else
    solver.emplace(*cloud_, scene.graph, options.cut);
  return *solver;
}

void SceneSolvers::make_ready(const Job& job) {
  if (job.cancelled()) return;
  solver(preset("default"), job).make_ready();
  make_lab_ready();
}

ObjectCutter::ObjectCutter(std::shared_ptr<const GaussianCloud> cloud, std::shared_ptr<SceneSolvers> solvers)
    : cloud_(std::move(cloud)), solvers_(std::move(solvers)) {}

const PipelineReport& ObjectCutter::first_cut(const ObjectCutInput& input, const StrokedView& reference,
                                              const Snapshot& on_snapshot, const Job& job, bool* fresh) {
  std::string key = key_of_first(input, reference);
  *fresh = !first_ || key != first_key_;
  if (!*fresh) return *first_;
  first_.reset();
  job.progress("first mask", 0);
  PipelineOptions options = preset(input.preset);
  options.on_snapshot = on_snapshot;
  options.pick.scale_steps = input.part_step;
  CutSolver& solver = solvers_->solver(options, job);
  PipelineReport report;
  report.outcome = Outcome::kCancelled;
  if (!job.cancelled())
    report = cut_out(*cloud_, &solvers_->prepared(options, job), reference.camera, input.up_world,
                     reference.strokes, options, job, &solver, &solvers_->views());
  first_key_ = report.outcome == Outcome::kCancelled ? std::string() : std::move(key);
  first_ = std::move(report);
  return *first_;
}

// Sums of the views that count, kept until those differ. False: cancelled.
bool ObjectCutter::add_up_views(const ObjectCutReport& out, const PipelineOptions& settings,
                                StageClock* clock, const Job& job) {
  std::string key = key_of_views(out.views);
  append(&key, settings.hard_counts);
  if (sums_ && key == sums_key_) return !job.cancelled();
  sums_.reset();
  const Drawer drawer(*cloud_, &solvers_->views());
  MaskedSums sums(cloud_->size());
  clock->time("likelihood", [&] {
    for (const ViewReport& view : out.views)
      if (view.used && !job.cancelled())
        add_masked_sums(drawer, view.camera, view.mask, settings.hard_counts, job, &sums);
  });
  if (job.cancelled()) return false;
  sums_ = std::move(sums);
  sums_key_ = std::move(key);
  return true;
}

// What the last cut weighs: the views that count, corrected by strokes in other views, and what the parts
// say. `out` holds the first cut's views and labels; those left out are marked, those of the corrections
// appended.
Likelihood ObjectCutter::evidence(const ObjectCutInput& input, const PipelineReport& first,
                                  const PipelineOptions& settings, StageClock* clock, const Job& job,
                                  ObjectCutReport* out) {
  for (const int view : input.left_out)
    if (view > 0 && view < static_cast<int>(out->views.size())) {
      out->views[static_cast<std::size_t>(view)].used = false;
      out->views[static_cast<std::size_t>(view)].reason = "left out";
    }
  if (!add_up_views(*out, settings, clock, job)) return {};
  const auto first_used = std::ranges::count_if(out->views, [](const ViewReport& v) { return v.used; });
  const auto reference = std::ranges::find_if(input.views, marks_object);
  std::optional<MaskedSums> sums;  // where there are corrections
  const Drawer drawer(*cloud_, &solvers_->views());
  for (const StrokedView& view : input.views) {
    if (&view == &*reference || view.strokes.empty() || job.cancelled()) continue;
    if (!sums) sums = sums_;
    const Correction c =
        clock->time("masks", [&] { return corrected(drawer, view, first.labels, settings, job); });
    clock->time("likelihood", [&] {
      add_masked_sums(drawer, c.camera, c.mask, settings.hard_counts, job, &*sums);
      add_weighted(drawer, c, kCorrectionWeight * first_used, settings.hard_counts, job, &*sums);
    });
    out->views.push_back({.camera = c.camera, .mask = c.mask, .used = true, .confidence = 1, .reason = {}});
  }
  const auto used = std::ranges::count_if(out->views, [](const ViewReport& v) { return v.used; });
  return with_prior(likelihood(sums ? *sums : *sums_), first.prior,
                    settings.prior_px_per_view * static_cast<float>(used));
}

std::vector<float> ObjectCutter::likelihood_of(const ObjectCutInput& input, const Job& job) {
  const auto reference = std::ranges::find_if(input.views, marks_object);
  if (reference == input.views.end()) return std::vector<float>(cloud_->size(), 0);
  bool fresh = false;
  const PipelineReport& first = first_cut(input, *reference, {}, job, &fresh);
  ObjectCutReport scratch;
  scratch.views = first.views;
  StageClock clock(&scratch.stages);
  return evidence(input, first, preset(input.preset), &clock, job, &scratch).w;
}

ObjectCutReport ObjectCutter::cut(const ObjectCutInput& input, const Snapshot& on_snapshot, const Job& job) {
  ObjectCutReport out;
  const auto reference = std::ranges::find_if(input.views, marks_object);
  if (reference == input.views.end()) {
    out.outcome = Outcome::kNothingFound;
    out.reason = "no stroke marks the object yet; click on it";
    out.labels.assign(cloud_->size(), 0);
    return out;
  }
  bool fresh = false;
  const PipelineReport& first = first_cut(input, *reference, on_snapshot, job, &fresh);
  out.outcome = first.outcome;
  out.reason = first.reason;
  out.labels = first.labels;
  out.views = first.views;
  out.sizes = first.first_sizes;
  out.size = first.first_size;
  out.ambiguous = first.ambiguous;
  if (fresh) out.stages = first.stages;
  PipelineOptions settings = preset(input.preset);
  const float smoothness = input.smoothness.value_or(settings.cut.energy.lambda);
  const bool as_it_is =
      input.views.size() == 1 && input.left_out.empty() && smoothness == settings.cut.energy.lambda;
  if (first.outcome != Outcome::kDone || as_it_is) return out;

  StageClock clock(&out.stages);
  const Likelihood weighed = evidence(input, first, settings, &clock, job, &out);
  if (job.cancelled()) {
    out.outcome = Outcome::kCancelled;
    return out;
  }
  job.progress("cut", 0.9);
  settings.cut.energy.lambda = smoothness;
  const LookedAt looked = looked_at(out.views);
  const auto report = clock.time("cut", [&] {
    return solvers_->solver(settings, job).solve(weighed, looked.views, looked.pixels_per_view(), job);
  });
  if (job.cancelled())
    out.outcome = Outcome::kCancelled;
  else
    out.labels = report.labels;
  if (settings.trim && out.outcome == Outcome::kDone)
    clock.time("trim", [&] {
      trim_to_views({*cloud_, &solvers_->views()}, out.views, settings, &out.labels, job);
    });
  if (job.cancelled()) out.outcome = Outcome::kCancelled;
  return out;
}

}  // namespace splatcut
