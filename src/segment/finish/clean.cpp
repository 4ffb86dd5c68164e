#include "segment/finish/clean.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <numeric>

#include "segment/finish/carve.h"
#include "segment/finish/recolour.h"
#include "segment/finish/shown_part.h"
#include "segment/finish/solid.h"

namespace splatcut {

namespace {

constexpr double kAgrees = 0.95;
constexpr double kMostLost = 1.26;  // 1 dB
constexpr int kLeastViews = 6;      // taken, where so many show the object
constexpr std::size_t kLeastShownPx = 64;

// Those that show the object; the report says how many there are, and how many of them agree.
std::vector<OwnView> views_that_show(const CleanInput& input, const GaussianCloud& object,
                                     std::span<const Camera> cameras, CleanReport* report, const Job& job) {
  std::vector<OwnView> views;
  KeptViews last(input.scene.cloud(), 0);
  const Drawer drawer(input.scene.cloud(), &last);
  for (std::size_t v = 0; v < cameras.size() && !job.cancelled(); ++v) {
    job.progress("own views", static_cast<double>(v) / static_cast<double>(cameras.size()));
    OwnView view = own_view(drawer, object, input.labels, cameras[v], job);
    if (view.shown_px < kLeastShownPx) continue;
    ++report->views;
    report->agreed += view.agreement >= kAgrees;
    views.push_back(std::move(view));
  }
  return views;
}

// Leaves those that agree, and of the others the best, up to as many as it takes.
void keep_best(std::vector<OwnView>* views) {
  std::vector<std::size_t> best(views->size());
  std::iota(best.begin(), best.end(), 0);
  std::ranges::stable_sort(best, std::greater(), [&](std::size_t v) { return (*views)[v].agreement; });
  std::size_t count = 0;
  while (count < best.size() && (count < kLeastViews || (*views)[best[count]].agreement >= kAgrees)) ++count;
  best.resize(count);
  std::ranges::sort(best);
  std::vector<OwnView> kept;
  for (const std::size_t v : best) kept.push_back(std::move((*views)[v]));
  *views = std::move(kept);
}

// Steps 1 to 3; `kept` says what left. Returns what was cut off.
std::vector<CutOff> finish(std::span<const OwnView> views, std::vector<std::uint8_t>* kept,
                           CleanObject* object, const Job& job) {
  CleanReport& report = object->report;
  CarveReport carved = carve(views, &object->cloud, kept, job);
  report.left = carved.left;
  report.split = carved.split;
  report.made_solid = make_solid(views, *kept, &object->cloud, job);
  report.recoloured = recolour(views, *kept, &object->cloud, job);
  return std::move(carved.cut_off);
}

void drop_gone(const std::vector<std::uint8_t>& kept, CleanObject* object) {
  std::vector<std::uint32_t> stays;
  for (std::uint32_t i = 0; i < kept.size(); ++i)
    if (kept[i]) stays.push_back(i);
  for (std::size_t i = 0; i < stays.size(); ++i) object->gaussian[i] = object->gaussian[stays[i]];
  object->gaussian.resize(stays.size());
  object->cloud = permuted(object->cloud, stays);
}

CleanObject as_labelled(const CleanInput& input) {
  CleanObject object;
  object.gaussian = labelled_rows(input.labels);
  object.cloud = permuted(input.scene.cloud(), object.gaussian);
  return object;
}

// Cleans the labelled of a scene that holds what the cameras show.
CleanObject cleaned(const CleanInput& input, std::span<const Camera> cameras, const Job& job) {
  CleanObject object = as_labelled(input);
  CleanReport& report = object.report;
  std::vector<OwnView> views = views_that_show(input, object.cloud, cameras, &report, job);
  if (views.empty()) {
    report.why_not = "from no side it can be told what belongs to it";
    return object;
  }
  keep_best(&views);
  report.used = static_cast<int>(views.size());
  std::vector<std::uint8_t> kept(object.cloud.size(), 1);
  PictureError as_it_is;
  for (const OwnView& view : views) {
    as_it_is.squares += view.error.squares;
    as_it_is.inside_px += view.error.inside_px;
  }
  const std::vector<CutOff> cut_off = finish(views, &kept, &object, job);
  if (std::ranges::count(kept, 1) == 0 ||
      own_picture_error(views, object.cloud, kept, job).mean() > kMostLost * as_it_is.mean()) {
    CleanObject same = as_labelled(input);
    same.report.views = report.views;
    same.report.agreed = report.agreed;
    same.report.why_not = "what they would take off is seen in the scene, too";
    return same;
  }
  if (input.rest)
    object.rest =
        forget(input.scene.cloud(), input.labels, object.gaussian, views, cut_off, input.leaving, job);
  report.cleaned = !job.cancelled();
  drop_gone(kept, &object);
  return object;
}

}  // namespace

CleanObject clean_object(const CleanInput& input, const OwnViewOptions& options, const Job& job) {
  constexpr int kLeastGaussians = 8;
  if (std::ranges::count_if(input.labels, std::identity()) < kLeastGaussians) {
    CleanObject few = as_labelled(input);
    few.report.why_not = fmt::format("it has too few Gaussians ({})", few.gaussian.size());
    return few;
  }
  const std::vector<Camera> cameras =
      own_cameras(input.scene.cloud(), input.labels, input.up_world, input.cameras, options);
  const ShownPart part = shown_part(input.scene, input.labels, cameras, job);
  CleanInput within = input;  // rows of `part`, until the end
  within.scene = part.cloud;
  within.labels = part.labels;
  std::vector<std::uint8_t> leaving;
  if (!input.leaving.empty())
    for (const std::uint32_t row : part.row) leaving.push_back(input.leaving[row]);
  within.leaving = leaving;
  CleanObject object = cleaned(within, cameras, job);
  for (std::uint32_t& g : object.gaussian) g = part.row[g];
  for (std::uint32_t& g : object.rest.ghosts) g = part.row[g];
  return object;
}

}  // namespace splatcut
