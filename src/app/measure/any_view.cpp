#include "app/measure/any_view.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <utility>

#include "app/measure/robot_user.h"
#include "core/counter_rng.h"
#include "core/error.h"
#include "scene/raster/rasterizer.h"
#include "segment/masks/mask_tools.h"
#include "segment/session/doubts.h"
#include "segment/superpoints/orbit.h"

namespace splatcut {

namespace {

constexpr std::uint64_t kDrawStep = 64;  // clicks of one draw are draws of their own
constexpr float kNearPx = 2;             // a click's own pixel may be the border of something thin

std::uint64_t draw_of(std::uint64_t draw, std::size_t click) {
  return draw ? draw * kDrawStep + click : 0;
}

double mean_iou(const AnyViewWorld& world, const std::vector<Mask>& shown) {
  double sum = 0;
  for (std::size_t v = 0; v < world.views.size(); ++v) sum += iou(world.views[v].truth, shown[v]);
  return sum / static_cast<double>(world.views.size());
}

std::vector<Mask> pictures(const AnyViewWorld& world, const std::vector<std::uint8_t>& labels) {
  std::vector<Mask> shown;
  for (const TruthView& view : world.views) shown.push_back(world.picture(view.camera, labels));
  return shown;
}

// The middle of any detail that is wrong in any view.
std::optional<ViewClick> click_on_detail(const AnyViewWorld& world, const std::vector<Mask>& shown,
                                         std::uint64_t draw, float least_px) {
  constexpr std::uint64_t kSeed = 77;
  std::vector<std::pair<const TruthView*, WrongRegion>> all;
  for (std::size_t v = 0; v < world.views.size(); ++v)
    for (WrongRegion& wrong : wrong_details(world.views[v].truth, shown[v], least_px))
      all.emplace_back(&world.views[v], std::move(wrong));
  if (all.empty()) return std::nullopt;
  const auto& [view, wrong] = all[CounterRng(kSeed + draw, all.size()).below(all.size())];
  return ViewClick{view->camera, *click_in(wrong)};
}

std::optional<ViewClick> next_click(const AnyViewWorld& world, const std::vector<Mask>& shown,
                                    std::uint64_t draw, float details) {
  if (details > 0)
    if (const auto detail = click_on_detail(world, shown, draw, details)) return detail;
  WrongRegion largest;
  const TruthView* where = nullptr;
  for (std::size_t v = 0; v < world.views.size(); ++v) {
    WrongRegion wrong = wrong_region(world.views[v].truth, shown[v]);
    if (wrong.pixels <= largest.pixels) continue;
    largest = std::move(wrong);
    where = &world.views[v];
  }
  if (!where) return std::nullopt;
  return ViewClick{where->camera, *click_in(largest, draw)};
}

// Whether most of the mask lies in the box.
bool fills(const Mask& mask, const Stroke& stroke) {
  const BoxPx box = box_in_picture(stroke, mask.width(), mask.height());
  std::size_t inside = 0;
  for (int y = 0; y < mask.height(); ++y)
    for (int x = 0; x < mask.width(); ++x) inside += mask.at(x, y) && box.contains(glm::vec2(x, y) + 0.5f);
  return 2 * inside > count(mask);
}

// Whether the mask shows the stroke's label at a pixel within that distance of it.
bool shows(const Mask& mask, const Stroke& stroke, float within_px) {
  if (stroke.is_box()) return fills(mask, stroke);
  const glm::vec2 at = stroke.points_px.front();
  const int x = static_cast<int>(std::floor(at.x)), y = static_cast<int>(std::floor(at.y)),
            r = static_cast<int>(within_px);
  for (int dy = -r; dy <= r; ++dy)
    for (int dx = -r; dx <= r; ++dx)
      if (static_cast<float>(dx * dx + dy * dy) <= within_px * within_px && mask.contains(x + dx, y + dy) &&
          (mask.at(x + dx, y + dy) != 0) == (stroke.label == SeedLabel::kObject))
        return true;
  return false;
}

// The offered meaning that a person would take, seeing the clicked view alone; 0: the likeliest stays.
int better_meaning(const AnyViewWorld& world, const Camera& clicked, const std::vector<Mask>& meanings) {
  constexpr double kWorthAClick = 0.05;
  const auto view =
      std::ranges::find_if(world.views, [&](const TruthView& v) { return same_camera(v.camera, clicked); });
  if (view == world.views.end()) return 0;
  int best = 0;
  double least = 0;
  for (std::size_t i = 0; i < meanings.size(); ++i) {
    const double agrees =
        iou(resized_mask(meanings[i], view->truth.width(), view->truth.height()), view->truth);
    if (i > 0 && agrees < least) continue;
    best = static_cast<int>(i);
    least = i == 0 ? agrees + kWorthAClick : agrees;
  }
  return best;
}

// Turns the wheel after the last click as long as the clicked view gets better by it.
CutAnswer best_size(const AnyViewWorld& world, AnyViewSession* session, CutAnswer answer, const Job& job) {
  constexpr double kWorthANotch = 0.002;
  constexpr int kMostNotches = 6;
  ViewClick& last = session->clicks.back();
  const auto view = std::ranges::find_if(
      world.views, [&](const TruthView& v) { return same_camera(v.camera, last.camera); });
  if (view == world.views.end()) return answer;
  const auto agrees = [&](const CutAnswer& a) {
    return iou(world.picture(view->camera, a.labels), view->truth);
  };
  double best = agrees(answer);
  for (const int direction : {1, -1}) {
    const int before = last.stroke.size_step;
    for (int step = direction; std::abs(step) <= kMostNotches; step += direction) {
      const int kept = last.stroke.size_step;
      last.stroke.size_step = step;
      CutAnswer other = world.cut(session->clicks, session->choice, job);
      if (job.cancelled()) return answer;
      const double found = agrees(other);
      if (found < best + kWorthANotch) {
        last.stroke.size_step = kept;
        break;
      }
      best = found;
      answer = std::move(other);
    }
    if (last.stroke.size_step != before) break;
  }
  return answer;
}

template <class T>
std::shared_ptr<const T> borrowed(const T* value) {
  return {std::shared_ptr<void>(), value};
}

bool holds(std::span<const TruthView> views, const Camera& camera) {
  return std::ranges::any_of(views, [&](const TruthView& v) { return same_camera(v.camera, camera); });
}

std::vector<GivenReference> references_of(const EvaluationCase& scene) {
  std::vector<GivenReference> all = {{scene.reference, scene.clicks}};
  all.insert(all.end(), scene.more_references.begin(), scene.more_references.end());
  return all;
}

}  // namespace

double AnyViewSession::obeyed_share() const {
  return obeyed.empty()
             ? 1
             : static_cast<double>(std::ranges::count(obeyed, true)) / static_cast<double>(obeyed.size());
}

double AnyViewSession::worst_fall() const {
  double worst = 0;
  for (std::size_t i = 1; i < iou_after.size(); ++i) worst = std::max(worst, iou_after[i - 1] - iou_after[i]);
  return worst;
}

AnyViewSession any_view_session(const AnyViewWorld& world, const AnyViewStart& start, int clicks,
                                const AnyViewHand& hand, const Job& job) {
  using Clock = std::chrono::steady_clock;
  AnyViewSession session{.start = start.name, .draw = hand.draw};
  std::vector<Mask> shown, meanings;
  double ms = 0, cuts = 0;
  for (int i = 0; i < clicks && !job.cancelled(); ++i) {
    std::optional<ViewClick> next = ViewClick{start.camera, start.first};
    if (i > 0) next = next_click(world, shown, draw_of(hand.draw, static_cast<std::size_t>(i)), hand.details);
    if (i > 0 && next && hand.near != 1 && world.cloud)
      next = zoomed_click(*world.cloud, {{}, next->camera, next->stroke}, hand.near).value_or(*next);
    if (i == 1 && next && hand.choices) session.choice = better_meaning(world, start.camera, meanings);
    const bool chooses = i == 1 && session.choice > 0;
    if (chooses) session.clicks.front().stroke.size_step = 0;
    if (next) {
      if (!chooses) session.clicks.push_back(*next);
      const auto began = Clock::now();
      CutAnswer answer = world.cut(session.clicks, session.choice, job);
      ms += std::chrono::duration<double, std::milli>(Clock::now() - began).count();
      ++cuts;
      if (job.cancelled()) break;
      if (hand.sizes && !chooses) answer = best_size(world, &session, std::move(answer), job);
      if (job.cancelled()) break;
      shown = pictures(world, answer.labels);
      meanings = std::move(answer.meanings);
      if (!chooses) {
        const Mask here = world.picture(next->camera, answer.labels);
        session.obeyed.push_back(shows(here, next->stroke, kNearPx));
        session.obeyed_pixel.push_back(shows(here, next->stroke, 0));
        session.doubts.push_back(std::move(answer.doubts));
      }
    }
    session.iou_after.push_back(mean_iou(world, shown));
  }
  session.ms_per_click = ms / std::max(1.0, cuts);
  return session;
}

double iou_of_clicks(const AnyViewWorld& world, std::span<const ViewClick> clicks, const Job& job) {
  const CutAnswer answer = world.cut(clicks, 0, job);
  return job.cancelled() ? 0 : mean_iou(world, pictures(world, answer.labels));
}

std::vector<double> iou_of_meanings(const AnyViewWorld& world, const ViewClick& first, const Job& job) {
  std::vector<double> found;
  std::size_t offered = 1;
  for (int choice = 0; choice < static_cast<int>(offered); ++choice) {
    const CutAnswer answer = world.cut(std::span(&first, 1), choice, job);
    if (job.cancelled()) break;
    offered = std::max(answer.meanings.size(), offered);
    found.push_back(mean_iou(world, pictures(world, answer.labels)));
  }
  return found;
}

WindowCut::WindowCut(const EvaluationCase& scene, const std::string& preset)
    : session_({borrowed(scene.cloud), {}, scene.up_world, scene.scene_cameras, scene.prepare}),
      settings_(splatcut::preset(preset)) {}

CutAnswer WindowCut::operator()(std::span<const ViewClick> in_order, int choice, const Job& job) {
  CutRequest request;
  request.choice = choice;
  for (const ViewClick& click : in_order) request.strokes.push_back({click.camera, {click.stroke}});
  CutResult result = session_.cut(request, settings_, {job.stop, {}});
  CutAnswer answer{std::move(result.labels), doubts(result), std::move(result.meanings)};
  if (result.outcome == Outcome::kNothingFound) answer.doubts.insert(answer.doubts.begin(), result.reason);
  return answer;
}

AnyViewWorld window_world(const EvaluationCase& scene, std::vector<TruthView> views,
                          std::shared_ptr<WindowCut> cut) {
  return {std::move(views),
          [cut = std::move(cut)](std::span<const ViewClick> clicks, int choice, const Job& job) {
            return (*cut)(clicks, choice, job);
          },
          [&scene](const Camera& camera, const std::vector<std::uint8_t>& labels) {
            return labels_seen(scene, camera, labels);
          },
          scene.cloud};
}

std::vector<TruthView> truth_views(const EvaluationCase& scene) {
  std::vector<TruthView> views;
  for (std::size_t v = 0; v < scene.test_views.size(); ++v)
    if (counts(scene.truth_masks[v]) && !holds(views, scene.test_views[v]))
      views.push_back({scene.test_views[v], scene.truth_masks[v]});
  for (const GivenReference& reference : references_of(scene)) {
    if (scene.truth_labels.empty() || holds(views, reference.camera)) continue;
    Mask truth = labels_seen(scene, reference.camera, scene.truth_labels);
    if (counts(truth)) views.push_back({reference.camera, std::move(truth)});
  }
  if (views.empty()) throw Error(scene.name, "the truth shows in none of its views");
  return views;
}

std::vector<AnyViewStart> any_view_starts(const EvaluationCase& scene, std::span<const TruthView> views,
                                          const FirstStrokes& how) {
  std::vector<AnyViewStart> starts;
  const std::uint64_t draw = draw_of(how.draw, 0);
  const auto first = [&](const TruthView& view) {
    return how.box_margin ? *robot_box(view.truth, *how.box_margin, draw)
                          : *robot_click(view.truth, Mask(view.truth.width(), view.truth.height()), draw);
  };
  const std::vector<GivenReference> references = references_of(scene);
  for (const GivenReference& reference : references)
    if (!holds(views, reference.camera) && !reference.clicks.empty() && !how.box_margin)
      starts.push_back({"reference " + reference.camera.name, reference.camera, reference.clicks.front()});
  for (const TruthView& view : views) {
    const bool named = std::ranges::any_of(
        references, [&](const GivenReference& r) { return same_camera(r.camera, view.camera); });
    const std::string name =
        view.camera.name.empty() ? std::to_string(&view - views.data()) : view.camera.name;
    starts.push_back({(named ? "reference " : "view ") + name, view.camera, first(view)});
  }
  return starts;
}

std::optional<ViewClick> zoomed_click(const GaussianCloud& cloud, const AnyViewStart& start, float factor) {
  constexpr float kSameThing = 0.2f;  // of the depth
  if (factor == 1) return ViewClick{start.camera, start.first};
  const glm::vec2 pixel = start.first.points_px.front();
  const auto depth_in = [&](const Camera& camera) {
    RasterOptions options;
    options.depth = true;
    return rasterize(cloud, camera, options)
        .median_depth.at(static_cast<int>(pixel.x), static_cast<int>(pixel.y));
  };
  const float z = depth_in(start.camera);
  if (!(z > 0)) return std::nullopt;
  const Camera moved = approached(start.camera, start.camera.world_from_pixel(pixel, z), factor);
  if (std::abs(depth_in(moved) / (factor * z) - 1) > kSameThing) return std::nullopt;
  return ViewClick{moved, start.first};
}

}  // namespace splatcut
