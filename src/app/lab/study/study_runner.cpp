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
#include "core/json_file.h"
#include "core/png_file.h"
#include "scene/raster/rasterizer.h"
#include "segment/masks/mask_tools.h"
#include "segment/session/doubts.h"
#include "segment/session/settings_table.h"
#include "segment/superpoints/orbit.h"

namespace splatcut {

namespace {

// Where masks are given, or the object is hidden, only labels of all Gaussians help.
bool can_run(const StudyCell& cell, const EvaluationCase& test) {
  return (cell.masks == 0 && cell.hidden == 0) || !test.truth_labels.empty();
}

// A click becomes a straight stroke.
void draw_out(double length_px, std::uint64_t draw, Stroke* stroke) {
  const float angle = CounterRng(draw, 100).between(0, 6.2831853f);
  const glm::vec2 from = stroke->points_px.front(), along(std::cos(angle), std::sin(angle));
  for (double at = 2; at <= length_px; at += 2)
    stroke->points_px.push_back(from + static_cast<float>(at) * along);
}

// Another click comes first, the others after it as before.
void reorder(std::uint64_t draw, ViewClicks* clicks) {
  if (clicks->size() < 2) return;
  const auto first = 1 + static_cast<std::ptrdiff_t>(draw % (clicks->size() - 1));
  std::rotate(clicks->begin(), clicks->begin() + first, clicks->begin() + first + 1);
}

// The click as it is made where the cell changes how; none where it cannot be. object: what the first of all
// clicks hit.
std::optional<ViewClick> as_made(const StudyCell& cell, const EvaluationCase& test,
                                 std::span<const TruthView> views, const glm::vec3& object, ViewClick click,
                                 std::uint64_t draw) {
  std::optional<ViewClick> made = click;
  if (cell.step_back != 1)
    made = clicked_from(approached(click.camera, object, static_cast<float>(cell.step_back)), *test.cloud,
                        click);
  if (cell.object_share > 0) {
    const auto view =
        std::ranges::find_if(views, [&](const TruthView& v) { return same_camera(v.camera, click.camera); });
    made = clicked_from(framed(click.camera, object, view->truth, cell.object_share), *test.cloud, click);
  }
  if (made && cell.stroke_px > 0) draw_out(cell.stroke_px, draw, &made->stroke);
  return made;
}

CutRequest request_of_clicks(std::span<const ViewClick> clicks) {
  CutRequest request;
  for (const ViewClick& click : clicks) request.strokes.push_back({click.camera, {click.stroke}});
  return request;
}

TimedCut timed_cut(Session* session, const CutRequest& request, const CutSettings& settings, const Job& job) {
  const std::clock_t start = std::clock();
  CutResult result = session->cut(request, settings, job);
  return {std::move(result), 1000.0 * static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC};
}

// What cells of one hand have in common.
std::string hand_of(StudyCell cell) {
  cell.experiment = cell.series = "";
  cell.x = cell.clicks = 0;
  cell.reordered = false;
  return json_text(to_json(cell));
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

// The reference's true mask, and those of views around the object, the stated share of them disturbed.
CutRequest request_of_masks(const EvaluationCase& test, const StudyCell& cell) {
  CutRequest request;
  request.first_mask = {test.reference, test.reference_truth.value()};
  const std::vector<Camera> around =
      orbit_cameras(test.reference, test.up_world, object_extent(*test.cloud, test.truth_labels),
                    {.views = cell.masks - 1});
  const std::vector<bool> wrong = wrong_views(cell, around.size());
  for (std::size_t v = 0; v < around.size(); ++v) {
    const Mask mask = labels_seen(test, around[v], test.truth_labels);
    request.masks.push_back({around[v], wrong[v] ? disturbed(mask, cell.disturbance) : mask});
  }
  return request;
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
  Strokes strokes = test.scribbles_alone ? test.scribbles : test.clicks;
  if (strokes.empty()) {
    Session session = session_of(test);
    strokes = robot_session(test, &session, setup->settings, cell.clicks, 0, job).strokes;
  } else if (!test.scribbles_alone && std::ssize(strokes) > cell.clicks) {
    strokes.resize(static_cast<std::size_t>(cell.clicks));
  }
  setup->request.strokes = {{test.reference, std::move(strokes)}};
}

// Every draw begins in another view; where the first one matters, in the reference. A reference without truth
// comes before them: nobody knows where the object is in it.
void StudyRunner::watch_hand(const StudyCell& cell, const Setup& setup, Session* session, const Job& job) {
  constexpr int kClicks = 3;
  const EvaluationCase& test = setup.test;
  const std::vector<TruthView> views = truth_views(test);
  const std::vector<AnyViewStart> starts =
      any_view_starts(test, views, {.box_margin = {}, .draw = cell.draw});
  auto start = starts.end() - 1 - static_cast<std::ptrdiff_t>((cell.draw - 1) % views.size());
  if (cell.hidden > 0 || !cell.still_life.empty())
    start = std::ranges::find_if(
        starts, [&](const AnyViewStart& s) { return same_camera(s.camera, test.reference); });
  if (start == starts.end()) return;  // the object does not show there
  const auto object = clicked_point(*test.cloud, {start->camera, start->first});
  if (!object || !as_made(cell, test, views, *object, {start->camera, start->first}, 1)) return;
  const auto answer = [&](std::span<const ViewClick> told, int, const Job& within) {
    const std::uint64_t draw = 16 * cell.draw + told.size();
    hand_.clicks.push_back(as_made(cell, test, views, *object, told.back(), draw).value_or(told.back()));
    hand_.after.push_back(timed_cut(session, request_of_clicks(hand_.clicks), setup.settings, within));
    return CutAnswer{hand_.after.back().result.labels, {}};
  };
  const auto picture = [&](const Camera& camera, const std::vector<std::uint8_t>& labels) {
    return labels_seen(test, camera, labels);
  };
  any_view_session({views, answer, picture}, *start, kClicks, {.draw = cell.draw}, job);
}

void StudyRunner::say_by_hand(const StudyCell& cell, const Job& job, Setup* setup) {
  const std::string scene = fmt::format("{} {} {}", cell.scene_scale, cell.hidden, cell.up_tilt_deg);
  if (std::exchange(session_key_, scene) != scene) session_.emplace(session_of(setup->test));
  if (const std::string key = hand_of(cell); hand_.key != key) {
    hand_ = {key, {}, {}};
    watch_hand(cell, *setup, &*session_, job);
  }
  if (job.cancelled() || hand_.after.empty()) return;
  const std::size_t told = std::min(static_cast<std::size_t>(cell.clicks), hand_.after.size());
  ViewClicks clicks(hand_.clicks.begin(), hand_.clicks.begin() + static_cast<std::ptrdiff_t>(told));
  if (cell.reordered) reorder(cell.draw, &clicks);
  setup->answer = cell.reordered ? timed_cut(&*session_, request_of_clicks(clicks), setup->settings, job)
                                 : hand_.after[told - 1];
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
  const bool by_hand = cell.draw > 0 && cell.masks == 0;
  if (by_hand) resize_tests(&test, cell.picture_scale);
  test.up_world = tilted(test.up_world, test.reference, cell.up_tilt_deg);
  if (job.cancelled()) return nullptr;
  if (by_hand) {
    say_by_hand(cell, job, setup.get());
    if (!setup->answer) return nullptr;
  } else if (cell.masks > 0) {
    setup->request = request_of_masks(test, cell);
  } else {
    say(cell, job, setup.get());
  }
  return job.cancelled() ? nullptr : std::move(setup);
}

TimedCut StudyRunner::cut(const Setup& setup, const Job& job) const {
  if (setup.answer) return *setup.answer;
  Session session = session_of(setup.test);
  return timed_cut(&session, setup.request, setup.settings, job);
}

// Many draws end in the same labels: they are drawn and measured once.
ImageScore StudyRunner::score_of(const StudyCell& cell, const EvaluationCase& test,
                                 const std::vector<std::uint8_t>& labels) {
  Hasher key;
  for (const double changed :
       {cell.scene_scale, cell.hidden, static_cast<double>(test.test_views[0].width_px)})
    key.number(changed);
  key.add(std::span(labels));
  const auto found = scores_.find(key.value());
  if (found != scores_.end()) return found->second;
  return scores_.emplace(key.value(), score_images(test, labels)).first->second;
}

nlohmann::json StudyRunner::run(const StudyCell& cell, const Job& job) {
  const auto setup = set_up(cell, job);
  if (!setup) return nullptr;
  if (std::exchange(first_, false)) {  // what a scene's first cut prepares is no setting's cost
    cut(*setup, job);
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
  result["certainty"] = report.certainty;
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
