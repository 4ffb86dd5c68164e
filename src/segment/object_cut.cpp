#include "segment/object_cut.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "scene/png_file.h"
#include "scene/rasterizer.h"
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

Correction corrected(const GaussianCloud& cloud, const StrokedView& view,
                     const std::vector<std::uint8_t>& labels, const PipelineOptions& options,
                     const Job& job) {
  Correction out;
  out.camera = limited_to_width(view.camera, options.work_width_px);
  const int width = out.camera.width_px, height = out.camera.height_px;
  const Strokes here =
      scaled(view.strokes, static_cast<float>(width) / static_cast<float>(view.camera.width_px));
  RasterOptions raster;
  raster.depth = true;
  const RasterOutput drawn = rasterize(cloud, out.camera, raster, job);
  const Image<Rgb8> picture = rgb8_from_linear(drawn.colour);
  const Mask prior = thresholded(render_labels(cloud, out.camera, labels, job), 0.5f);
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

void add_weighted(const GaussianCloud& cloud, const Correction& correction, std::int64_t weight,
                  bool whole_pixels, const Job& job, MaskedSums* sums) {
  MaskedSums added(cloud.size()), removed(cloud.size());
  add_masked_sums(cloud, correction.camera, correction.added, whole_pixels, job, &added);
  add_masked_sums(cloud, correction.camera, correction.removed, whole_pixels, job, &removed);
  for (std::size_t g = 0; g < cloud.size(); ++g) {
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

ObjectCutter::ObjectCutter(std::shared_ptr<const GaussianCloud> cloud,
                           std::shared_ptr<const PreparedScene> prepared)
    : cloud_(std::move(cloud)), prepared_(std::move(prepared)) {}

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
  PipelineReport report =
      cut_out(*cloud_, prepared_.get(), reference.camera, input.up_world, reference.strokes, options, job);
  first_key_ = report.outcome == Outcome::kCancelled ? std::string() : std::move(key);
  first_ = std::move(report);
  return *first_;
}

MaskedSums ObjectCutter::sums_of(const std::vector<ViewReport>& views, bool whole_pixels,
                                 const Job& job) const {
  MaskedSums sums(cloud_->size());
  for (const ViewReport& view : views)
    if (view.used && !job.cancelled())
      add_masked_sums(*cloud_, view.camera, view.mask, whole_pixels, job, &sums);
  return sums;
}

std::vector<float> ObjectCutter::likelihood_of(const ObjectCutReport& report, const Job& job) const {
  return likelihood(sums_of(report.views, false, job)).w;
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
  const auto settings = preset(input.preset);
  const float smoothness = input.smoothness.value_or(settings.cut.energy.lambda);
  const bool as_it_is =
      input.views.size() == 1 && input.left_out.empty() && smoothness == settings.cut.energy.lambda;
  if (first.outcome != Outcome::kDone || as_it_is) return out;

  StageClock clock(&out.stages);
  for (const int view : input.left_out)
    if (view > 0 && view < static_cast<int>(out.views.size())) {
      out.views[static_cast<std::size_t>(view)].used = false;
      out.views[static_cast<std::size_t>(view)].reason = "left out";
    }
  std::string sums_key = key_of_views(out.views);
  append(&sums_key, settings.hard_counts);
  if (!sums_ || sums_key != sums_key_) {
    sums_.reset();
    MaskedSums sums = clock.time("likelihood", [&] { return sums_of(out.views, settings.hard_counts, job); });
    if (!job.cancelled()) {
      sums_ = std::move(sums);
      sums_key_ = std::move(sums_key);
    }
  }
  if (job.cancelled()) {
    out.outcome = Outcome::kCancelled;
    return out;
  }
  job.progress("cut", 0.9);
  MaskedSums sums = *sums_;
  auto used = std::ranges::count_if(out.views, [](const ViewReport& v) { return v.used; });
  const auto first_used = used;
  for (const StrokedView& view : input.views) {
    if (&view == &*reference || view.strokes.empty() || job.cancelled()) continue;
    const Correction c =
        clock.time("masks", [&] { return corrected(*cloud_, view, out.labels, settings, job); });
    clock.time("likelihood", [&] {
      add_masked_sums(*cloud_, c.camera, c.mask, settings.hard_counts, job, &sums);
      add_weighted(*cloud_, c, kCorrectionWeight * first_used, settings.hard_counts, job, &sums);
    });
    out.views.push_back({c.camera, c.mask, true, 1, {}});
    ++used;
  }
  CutOptions options = settings.cut;
  options.energy.lambda = smoothness;
  const Camera& view = out.views.front().camera;
  const double pixels = static_cast<double>(view.width_px) * view.height_px;
  const auto report = clock.time("cut", [&] {
    const float prior_px = settings.prior_px_per_view * static_cast<float>(used);
    return CutSolver(*cloud_, prepared_->graph, options)
        .solve(with_prior(likelihood(sums), first.prior, prior_px), static_cast<int>(used), pixels, job);
  });
  if (job.cancelled())
    out.outcome = Outcome::kCancelled;
  else
    out.labels = report.labels;
  if (settings.trim && out.outcome == Outcome::kDone)
    clock.time("trim", [&] { trim_to_views(*cloud_, out.views, settings, &out.labels, job); });
  if (job.cancelled()) out.outcome = Outcome::kCancelled;
  return out;
}

}  // namespace splatcut
