#include "app/study/study_runner.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <glm/gtc/quaternion.hpp>

#include "app/tuning_options.h"
#include "scene/counter_rng.h"
#include "scene/error.h"
#include "scene/png_file.h"
#include "scene/rasterizer.h"
#include "segment/mask_tools.h"
#include "segment/robot_user.h"

namespace splatcut {

namespace {

Camera rescaled(Camera camera, float scale) {
  camera.camera_from_world_translation *= scale;
  return camera;
}

EvaluationCase rescaled(EvaluationCase test, float scale) {
  for (Camera& camera : test.test_views) camera = rescaled(camera, scale);
  for (Camera& camera : test.scene_cameras) camera = rescaled(camera, scale);
  test.reference = rescaled(test.reference, scale);
  return test;
}

Mask seen(const EvaluationCase& test, const Camera& camera, const std::vector<std::uint8_t>& labels) {
  return thresholded(render_labels(*test.cloud, camera, labels), 0.5f);
}

// Where true masks are asked for, or the reference is moved, only labels of all Gaussians help.
bool can_run(const StudyCell& cell, const EvaluationCase& test) {
  const bool needs_labels = cell.true_masks || cell.first == "truth" || cell.step_back != 1;
  return !needs_labels || !test.truth_labels.empty();
}

void step_back(EvaluationCase* test, float factor) {
  const ObjectExtent object = object_extent(*test->cloud, test->truth_labels);
  test->reference = approached(test->reference, object.centre_world, factor);
  test->reference_truth = seen(*test, test->reference, test->truth_labels);
}

glm::vec3 tilted(const glm::vec3& up, const Camera& reference, double degrees) {
  return glm::angleAxis(glm::radians(static_cast<float>(degrees)), reference.forward_world()) * up;
}

void shake(Strokes* strokes, double most_px, std::uint64_t draw) {
  for (std::size_t i = 0; i < strokes->size(); ++i) {
    CounterRng random(draw, i);
    const float radius = static_cast<float>(most_px) * std::sqrt(random.unit()), angle = random.between(0, 6.2831853f);
    for (glm::vec2& p : (*strokes)[i].points_px) p += radius * glm::vec2(std::cos(angle), std::sin(angle));
  }
}

// Clicks become straight strokes.
void draw_out(Strokes* strokes, double length_px, std::uint64_t draw) {
  for (std::size_t i = 0; i < strokes->size(); ++i) {
    const float angle = CounterRng(draw, 100 + i).between(0, 6.2831853f);
    const glm::vec2 from = (*strokes)[i].points_px.front(), along(std::cos(angle), std::sin(angle));
    for (double at = 2; at <= length_px; at += 2) (*strokes)[i].points_px.push_back(from + static_cast<float>(at) * along);
  }
}

Mask mask_of_strokes(const Strokes& strokes, const Camera& camera) {
  const Image<std::uint8_t> seeds = draw_seeds(strokes, camera.width_px, camera.height_px);
  Mask mask(seeds.width(), seeds.height());
  std::ranges::transform(seeds.pixels(), mask.pixels().begin(), [](std::uint8_t s) { return s == kObjectSeed ? kMaskObject : std::uint8_t{0}; });
  return mask;
}

// True masks of the views in the order in which they are asked for, the stated share of them disturbed.
MaskSource true_masks(const EvaluationCase& test, const StudyCell& cell) {
  auto asked = std::make_shared<std::uint64_t>(0);
  return [&test, &cell, asked](const Camera& camera) {
    const std::uint64_t view = (*asked)++;
    const auto before = static_cast<std::uint64_t>(static_cast<double>(view) * cell.disturbed_share);
    const auto after = static_cast<std::uint64_t>(static_cast<double>(view + 1) * cell.disturbed_share);
    const Mask mask = seen(test, camera, test.truth_labels);
    return after > before ? disturbed(mask, cell.disturbance, view) : mask;
  };
}

}  // namespace

StudyRunner::StudyRunner(nlohmann::json entry, std::filesystem::path folder, PreparedCache cache)
    : entry_(std::move(entry)), folder_(std::move(folder)), cache_(std::move(cache)) {}

void StudyRunner::load(const PipelineOptions& pipeline, const Job& job) {
  if (loaded_) return;
  loaded_ = load_case(entry_, folder_, prepare_options(pipeline), job);
  loaded_neighbours_ = pipeline.neighbours;
}

const PreparedScene& StudyRunner::prepared_for(const PipelineOptions& pipeline, const Job& job) {
  if (pipeline.neighbours == loaded_neighbours_) return loaded_->prepared;
  const auto [it, added] = prepared_.try_emplace(pipeline.neighbours);
  const EvaluationCase& test = loaded_->test;
  if (added) it->second = prepare_scene(*test.cloud, test.reference, test.up_world, test.scene_cameras, prepare_options(pipeline), job);
  return it->second;
}

void StudyRunner::scale_to(double scale, const PipelineOptions& pipeline, const Job& job) {
  if (scale_ == scale) return;
  scaled_cloud_ = loaded_->scene.cloud;
  for (glm::vec3& p : scaled_cloud_.position) p *= static_cast<float>(scale);
  for (glm::vec3& s : scaled_cloud_.scale) s *= static_cast<float>(scale);
  scaled_cloud_.near_plane = natural_near_plane(scaled_cloud_.position);
  const EvaluationCase test = rescaled(loaded_->test, static_cast<float>(scale));
  scaled_prepared_ = prepare_scene(scaled_cloud_, test.reference, test.up_world, test.scene_cameras, prepare_options(pipeline), job);
  scale_ = scale;
}

void StudyRunner::choose_strokes(const StudyCell& cell, const Job& job, Setup* setup) const {
  const Strokes& given = setup->test.clicks;
  if (cell.first == "truth") {
    setup->pipeline.given_first_mask = setup->test.reference_truth;
  } else if (!given.empty()) {
    constexpr double kHandPx = 6;
    setup->strokes = Strokes(given.begin(), given.begin() + std::min<std::ptrdiff_t>(cell.clicks, std::ssize(given)));
    if (cell.draw) shake(&setup->strokes, kHandPx, cell.draw);
  } else {
    setup->strokes = robot_session(setup->test, setup->pipeline, cell.clicks, cell.draw, job).strokes;
  }
  if (cell.stroke_px > 0) draw_out(&setup->strokes, cell.stroke_px, cell.draw);
  if (cell.first == "strokes") setup->pipeline.given_first_mask = mask_of_strokes(setup->strokes, setup->test.reference);
}

StudyRunner::Setup StudyRunner::set_up(const StudyCell& cell, const Job& job) {
  Setup setup;
  setup.pipeline = preset(cell.preset);
  for (const std::string& assignment : cell.set) set_tuning_option(assignment, &setup.pipeline);
  setup.pipeline.cut_parts = !cell.parts_only;
  setup.pipeline.cache = cache_;
  PipelineOptions with_parts = setup.pipeline;  // one prepared scene for all cells
  with_parts.first_mask_from = FirstMaskFrom::kParts;
  load(with_parts, job);
  setup.test = loaded_->test;
  setup.possible = !job.cancelled() && can_run(cell, setup.test);
  if (!setup.possible) return setup;
  setup.test.prepared = &prepared_for(with_parts, job);
  if (cell.scene_scale != 1) {
    scale_to(cell.scene_scale, with_parts, job);
    setup.test = rescaled(loaded_->test, static_cast<float>(cell.scene_scale));
    setup.test.cloud = &scaled_cloud_;
    setup.test.prepared = &scaled_prepared_;
  }
  if (cell.step_back != 1) step_back(&setup.test, static_cast<float>(cell.step_back));
  setup.test.up_world = tilted(setup.test.up_world, setup.test.reference, cell.up_tilt_deg);
  setup.pipeline.scene_cameras = setup.test.scene_cameras;
  choose_strokes(cell, job, &setup);
  return setup;
}

PipelineReport StudyRunner::cut(const StudyCell& cell, Setup* setup, const Job& job) const {
  const EvaluationCase& test = setup->test;
  if (cell.true_masks) setup->pipeline.given_masks = true_masks(test, cell);
  return cut_out(*test.cloud, test.prepared, test.reference, test.up_world, setup->strokes, setup->pipeline, job);
}

nlohmann::json StudyRunner::run(const StudyCell& cell, const Job& job) {
  Setup setup = set_up(cell, job);
  if (!setup.possible || job.cancelled()) return nullptr;
  const EvaluationCase& test = setup.test;
  const auto start = std::chrono::steady_clock::now();
  const PipelineReport report = cut(cell, &setup, job);
  const double ms = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  if (job.cancelled()) return nullptr;
  const ImageScore score = score_images(test, report.labels);
  nlohmann::json result = to_json(cell);
  result["scene"] = test.name;
  result["image_iou"] = score.iou;
  result["boundary_iou"] = score.boundary;
  result["gaussian_iou"] = test.truth_labels.empty() ? nlohmann::json() : nlohmann::json(label_iou(test.truth_labels, report.labels));
  result["ms"] = ms;
  result["views"] = std::ranges::count_if(report.views, &ViewReport::used);
  result["views_left_out"] = std::ranges::count_if(report.views, [](const ViewReport& v) { return !v.used; });
  result["gaussians"] = report.cut.touched;
  result["ambiguous"] = report.ambiguous;
  result["found"] = report.outcome == Outcome::kDone;
  result["stages"] = nlohmann::json::object();
  for (const StageTime& stage : report.stages) result["stages"][stage.name] = stage.ms;
  return result;
}

Image<Rgb8> StudyRunner::picture(const StudyCell& cell, const Job& job) {
  Setup setup = set_up(cell, job);
  if (!setup.possible || job.cancelled()) return {};
  const EvaluationCase& test = setup.test;
  const PipelineReport report = cut(cell, &setup, job);
  if (job.cancelled()) return {};
  constexpr int kWidthPx = 360;
  const Camera camera = limited_to_width(test.reference, kWidthPx);
  Image<Rgb8> picture = rgb8_from_linear(rasterize(*test.cloud, camera).colour);
  const Mask mask = seen(test, camera, report.labels);
  for (std::size_t i = 0; i < mask.size(); ++i)
    for (auto& c : picture.pixels()[i]) c = static_cast<std::uint8_t>(mask.pixels()[i] ? c : c / 4);
  return picture;
}

}  // namespace splatcut
