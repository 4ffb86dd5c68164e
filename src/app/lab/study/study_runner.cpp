#include "app/lab/study/study_runner.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <ctime>
#include <numeric>
#include <utility>

#include "app/lab/study/study_variants.h"
#include "app/measure/robot_user.h"
#include "core/byte_hash.h"
#include "core/counter_rng.h"
#include "core/error.h"
#include "core/png_file.h"
#include "scene/raster/rasterizer.h"
#include "segment/masks/mask_tools.h"
#include "segment/session/doubts.h"
#include "segment/session/settings_table.h"

namespace splatcut {

namespace {

// Where true masks are asked for, or the first view is changed, only labels of all Gaussians help.
bool can_run(const StudyCell& cell, const EvaluationCase& test) {
  const bool needs_labels = cell.true_masks || cell.first == "truth" || cell.step_back != 1 ||
                            cell.hidden > 0 || cell.object_share > 0;
  return !needs_labels || !test.truth_labels.empty();
}

void shake(Strokes* strokes, double most_px, std::uint64_t draw) {
  for (std::size_t i = 0; i < strokes->size(); ++i) {
    CounterRng random(draw, i);
    const float radius = static_cast<float>(most_px) * std::sqrt(random.unit()),
                angle = random.between(0, 6.2831853f);
    for (glm::vec2& p : (*strokes)[i].points_px) p += radius * glm::vec2(std::cos(angle), std::sin(angle));
  }
}

// Clicks become straight strokes.
void draw_out(Strokes* strokes, double length_px, std::uint64_t draw) {
  for (std::size_t i = 0; i < strokes->size(); ++i) {
    const float angle = CounterRng(draw, 100 + i).between(0, 6.2831853f);
    const glm::vec2 from = (*strokes)[i].points_px.front(), along(std::cos(angle), std::sin(angle));
    for (double at = 2; at <= length_px; at += 2)
      (*strokes)[i].points_px.push_back(from + static_cast<float>(at) * along);
  }
}

Mask mask_of_strokes(const Strokes& strokes, const Camera& camera) {
  const Image<std::uint8_t> seeds = draw_seeds(strokes, camera.width_px, camera.height_px);
  Mask mask(seeds.width(), seeds.height());
  std::ranges::transform(seeds.pixels(), mask.pixels().begin(),
                         [](std::uint8_t s) { return s == kObjectSeed ? kMaskObject : std::uint8_t{0}; });
  return mask;
}

void shuffle(Strokes* strokes, std::uint64_t order) {
  CounterRng random(order, 0x5467);
  for (std::size_t i = strokes->size(); i > 1; --i) std::swap((*strokes)[i - 1], (*strokes)[random.below(i)]);
}

// Which of so many views get a wrong mask: the stated share, spread evenly, or by chance where there is a
// draw.
std::vector<bool> wrong_views(const StudyCell& cell, std::size_t views) {
  std::vector<bool> wrong(views, false);
  std::vector<std::size_t> order(views);
  std::iota(order.begin(), order.end(), std::size_t{0});
  if (cell.draw)
    std::ranges::sort(order, {}, [&](std::size_t v) { return CounterRng(cell.draw, 500 + v).bits(); });
  const auto upto = [&](std::size_t v) {
    return static_cast<std::size_t>(static_cast<double>(v) * cell.disturbed_share);
  };
  for (std::size_t v = 0; v < views; ++v)
    wrong[order[v]] = cell.draw ? v < upto(views) : upto(v + 1) > upto(v);
  return wrong;
}

// True masks of the views in the order in which they are asked for, the stated share of them disturbed.
MaskSource true_masks(const EvaluationCase& test, const StudyCell& cell, int views) {
  auto asked = std::make_shared<std::size_t>(0);
  return [&test, &cell, asked,
          wrong = wrong_views(cell, static_cast<std::size_t>(views))](const Camera& camera) {
    const std::size_t view = (*asked)++;
    const Mask mask = labels_seen(test, camera, test.truth_labels);
    return view < wrong.size() && wrong[view] ? disturbed(mask, cell.disturbance, 1000 * cell.draw + view)
                                              : mask;
  };
}

// What `splatcut cut` says of such a run.
std::string warning_of(const CutResult& report) {
  std::vector<std::string> sentences = doubts(report);
  if (!report.reason.empty()) sentences.insert(sentences.begin(), report.reason);
  return fmt::format("{}", fmt::join(sentences, "; "));
}

void paint(bool is, bool said, Rgb8* pixel) {
  constexpr std::array<int, 3> kMissing = {220, 30, 30}, kTooMuch = {40, 90, 255};
  for (std::size_t c = 0; c < 3; ++c) {
    const int own = (*pixel)[c];
    (*pixel)[c] = static_cast<std::uint8_t>(is && said ? own
                                            : is       ? (own + 2 * kMissing[c]) / 3
                                            : said     ? (own + 2 * kTooMuch[c]) / 3
                                                       : own / 4);
  }
}

// What the first view and the others cost to look at, whatever the machine.
double looked_at_megapixels(const CutResult& report) {
  double pixels = 0;
  for (const ViewReport& v : report.views)
    pixels += static_cast<double>(v.camera.width_px) * v.camera.height_px;
  return pixels / 1e6;
}

}  // namespace

StudyRunner::StudyRunner(nlohmann::json entry, std::filesystem::path folder, PreparedCache cache)
    : entry_(std::move(entry)), folder_(std::move(folder)), cache_(std::move(cache)) {}

void StudyRunner::load(const Job& job) {
  if (loaded_) return;
  loaded_ = load_case(entry_, folder_, {.observing = {}, .model = {}, .cache = cache_}, job);
  constexpr std::size_t kMostBytes = std::size_t{768} << 20;  // the test views of a scene, at their own size
  measured_views_.emplace(*loaded_->test.cloud, kMostBytes);
  loaded_->test.kept_views = &*measured_views_;
}

void StudyRunner::change_scene(const StudyCell& cell, EvaluationCase* test) {
  if (cell.scene_scale == 1 && cell.hidden == 0) return;
  if (variant_.scale != cell.scene_scale || variant_.hidden != cell.hidden) {
    variant_ = {cell.scene_scale, cell.hidden, with_board(loaded_->test, cell.hidden),
                loaded_->test.truth_labels};
    variant_.truth.resize(test->truth_labels.empty() ? 0 : variant_.cloud.size(), 0);
    variant_.cloud = rescaled(variant_.cloud, static_cast<float>(cell.scene_scale));
  }
  *test = rescaled(*test, static_cast<float>(cell.scene_scale));
  test->cloud = &variant_.cloud;
  test->kept_views = nullptr;
  test->prepare.cache = {};  // nobody opens it again
  test->truth_labels = variant_.truth;
  if (cell.hidden > 0) render_truth(test);
}

void StudyRunner::say(const StudyCell& cell, const Job& job, Setup* setup) const {
  const EvaluationCase& test = setup->test;
  if (cell.true_masks) {
    const int views = setup->settings.orbit.views;
    setup->request.mask_source = true_masks(test, cell, views == kViewsAsNeeded ? kViewsAround : views);
  }
  if (cell.first == "truth") {
    setup->request.first_mask = {test.reference, test.reference_truth.value()};
    return;
  }
  Strokes strokes;
  const Strokes& given = test.scribbles_alone ? test.scribbles : test.clicks;
  if (!given.empty()) {
    constexpr double kHandPx = 6;
    const auto told = test.scribbles_alone ? std::ssize(given)  // one answer: all of them
                                           : std::min<std::ptrdiff_t>(cell.clicks, std::ssize(given));
    strokes = Strokes(given.begin(), given.begin() + told);
    if (cell.draw) shake(&strokes, kHandPx, cell.draw);
  } else {
    Session session = session_of(test);
    strokes = robot_session(test, &session, setup->settings, cell.clicks, cell.draw, job).strokes;
  }
  if (cell.order) shuffle(&strokes, cell.order);
  if (cell.stroke_px > 0) draw_out(&strokes, cell.stroke_px, cell.draw);
  if (cell.first == "strokes")
    setup->request.first_mask = {test.reference, mask_of_strokes(strokes, test.reference)};
  else
    setup->request.strokes = {{test.reference, std::move(strokes)}};
}

std::unique_ptr<StudyRunner::Setup> StudyRunner::set_up(const StudyCell& cell, const Job& job) {
  auto setup = std::make_unique<Setup>();
  setup->settings = preset(cell.preset);
  for (const std::string& assignment : cell.set) set_setting(assignment, &setup->settings);
  setup->settings.parts_only = cell.parts_only;
  load(job);
  EvaluationCase& test = setup->test = loaded_->test;
  if (job.cancelled() || !can_run(cell, test)) return nullptr;
  change_scene(cell, &test);
  if (cell.step_back != 1) step_back(&test, static_cast<float>(cell.step_back));
  if (cell.object_share > 0) fill_picture(&test, cell.object_share);
  if (cell.score_scale != 1) resize_tests(&test, cell.score_scale);
  test.up_world = tilted(test.up_world, test.reference, cell.up_tilt_deg);
  if (!job.cancelled()) say(cell, job, setup.get());
  return job.cancelled() ? nullptr : std::move(setup);
}

StudyRunner::Timed StudyRunner::cut(const Setup& setup, const Job& job) const {
  Session session = session_of(setup.test);
  const std::clock_t start = std::clock();
  CutResult result = session.cut(setup.request, setup.settings, job);
  return {std::move(result), 1000.0 * static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC};
}

// Many draws end in the same labels: they are drawn and measured once.
ImageScore StudyRunner::score_of(const StudyCell& cell, const EvaluationCase& test,
                                 const std::vector<std::uint8_t>& labels) {
  Hasher key;
  for (const double changed :
       {cell.scene_scale, cell.hidden, cell.step_back, cell.object_share, cell.score_scale})
    key.number(changed);
  key.add(std::span(labels));
  const auto found = scores_.find(key.value());
  if (found != scores_.end()) return found->second;
  return scores_.emplace(key.value(), score_images(test, labels)).first->second;
}

nlohmann::json StudyRunner::run(const StudyCell& cell, const Job& job) {
  auto setup = set_up(cell, job);
  if (!setup) return nullptr;
  if (std::exchange(first_, false)) {  // what a scene's first cut prepares is no setting's cost
    cut(*setup, job);
    setup = set_up(cell, job);  // its masks are asked for anew
    if (!setup) return nullptr;
  }
  const EvaluationCase& test = setup->test;
  const auto [report, cpu_ms] = cut(*setup, job);
  if (job.cancelled()) return nullptr;
  const ImageScore score = score_of(cell, test, report.labels);
  nlohmann::json result = to_json(cell);
  result["scene"] = test.name;
  result["image_iou"] = score.iou;
  result["boundary_iou"] = score.boundary;
  result["gaussian_iou"] = test.truth_labels.empty()
                               ? nlohmann::json()
                               : nlohmann::json(label_iou(test.truth_labels, report.labels));
  result["cpu_ms"] = cpu_ms;
  result["views"] = std::ranges::count_if(report.views, &ViewReport::used);
  result["views_left_out"] = std::ranges::count_if(report.views, [](const ViewReport& v) { return !v.used; });
  result["gaussians"] = report.cut.touched;
  result["looked_at_mpx"] = looked_at_megapixels(report);
  result["ambiguous"] = report.ambiguous;
  result["warned"] = warning_of(report);
  result["found"] = report.outcome == Outcome::kDone;
  result["stages"] = nlohmann::json::object();
  for (const StageTime& stage : report.stages) result["stages"][stage.name] = stage.ms;
  return result;
}

Image<Rgb8> StudyRunner::picture(const StudyCell& cell, const Job& job) {
  const auto setup = set_up(cell, job);
  if (!setup) return {};
  const EvaluationCase& test = setup->test;
  const CutResult report = cut(*setup, job).result;
  if (job.cancelled()) return {};
  constexpr int kWidthPx = 360;
  const bool labelled = !test.truth_labels.empty();
  const auto view =
      static_cast<std::size_t>(std::ranges::find_if(test.truth_masks, counts) - test.truth_masks.begin());
  const Camera camera = limited_to_width(labelled ? test.reference : test.test_views.at(view), kWidthPx);
  const Mask truth = labelled ? labels_seen(test, camera, test.truth_labels)
                              : resized_mask(test.truth_masks[view], camera.width_px, camera.height_px);
  Image<Rgb8> picture = rgb8_from_linear(rasterize(*test.cloud, camera).colour);
  const Mask mask = labels_seen(test, camera, report.labels);
  for (std::size_t i = 0; i < mask.size(); ++i)
    paint(truth.pixels()[i] != 0, mask.pixels()[i] != 0, &picture.pixels()[i]);
  return picture;
}

}  // namespace splatcut
