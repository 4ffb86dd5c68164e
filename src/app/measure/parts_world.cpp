#include "app/measure/parts_world.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "segment/masks/mask_tools.h"
#include "segment/selection/click_selection.h"

namespace splatcut {

const LeafView& view_of(const PartsScene& scene, const Camera& camera) {
  return *std::ranges::find_if(scene.views, [&](const LeafView& v) { return same_camera(v.camera, camera); });
}

namespace {

std::vector<TruthView> evenly(std::vector<TruthView> all, std::size_t most) {
  if (all.size() <= most) return all;
  std::vector<TruthView> some;
  for (std::size_t i = 0; i < most; ++i) some.push_back(std::move(all[i * all.size() / most]));
  return some;
}

// The selection after the clicks of the last question, to go on from where it is continued.
class Selections {
 public:
  Selections(const PartsScene& scene, const SelectionModel& model) : scene_(scene), model_(model) {}

  const ClickSelection& after(std::span<const ViewClick> clicks, int choice) {
    const bool continued = clicks.size() == applied_ + 1 && applied_ > 0 && choice == choice_;
    if (!continued) {
      selection_ = std::make_unique<ClickSelection>(scene_.parts, model_, choice);
      choice_ = choice;
      applied_ = 0;
    }
    for (; applied_ < clicks.size(); ++applied_) {
      const auto& [camera, stroke] = clicks[applied_];
      selection_->apply(view_of(scene_, camera), stroke);
    }
    return *selection_;
  }

 private:
  const PartsScene& scene_;
  SelectionModel model_;
  std::unique_ptr<ClickSelection> selection_;
  std::size_t applied_ = 0;
  int choice_ = 0;
};

}  // namespace

PartsScene parts_scene(const EvaluationCase& scene, PartHierarchy parts, const PartsSceneOptions& options,
                       const Job& job) {
  PartsScene made{
      .name = scene.name, .parts = std::move(parts), .views = {}, .truths = {}, .starts = {}, .zoom = {}};
  const Drawer drawer(*scene.cloud);
  const auto small = [&](const Camera& full, const Mask* truth) {
    const Camera camera = limited_to_width(full, options.max_width_px);
    if (!truth) return camera;
    const double scale = static_cast<double>(camera.width_px) / full.width_px;
    const double side = scale * std::sqrt(static_cast<double>(count(*truth)));
    return side >= options.least_object_px
               ? camera
               : limited_to_width(
                     full, static_cast<int>(std::ceil(camera.width_px * options.least_object_px / side)));
  };
  const auto drawn = [&](const Camera& camera) -> LeafView& {
    const auto known =
        std::ranges::find_if(made.views, [&](const LeafView& v) { return same_camera(v.camera, camera); });
    return known != made.views.end() ? *known
                                     : made.views.emplace_back(leaf_view(drawer, made.parts, camera, job));
  };
  const std::vector<TruthView> truths = evenly(truth_views(scene), options.most_views);
  for (const TruthView& full : truths) {
    const Camera camera = small(full.camera, &full.truth);
    made.views.push_back(leaf_view(drawer, made.parts, camera, job));
    made.truths.push_back({camera, resized_mask(full.truth, camera.width_px, camera.height_px)});
  }
  std::vector<AnyViewStart> starts = any_view_starts(scene, truths, options.first);
  if (starts.size() > options.most_starts) starts.resize(options.most_starts);
  for (const AnyViewStart& start : starts) {
    const auto known =
        std::ranges::find_if(truths, [&](const TruthView& t) { return same_camera(t.camera, start.camera); });
    for (const float zoom : options.zooms) {
      const auto from = zoomed_click(*scene.cloud, start, zoom);
      if (!from) continue;
      const Camera camera = small(from->camera, known == truths.end() || zoom != 1 ? nullptr : &known->truth);
      const float scale = static_cast<float>(camera.width_px) / static_cast<float>(start.camera.width_px);
      const Stroke first = scaled({from->stroke}, scale).front();
      draw_colour(drawer, &drawn(camera), job);
      made.starts.push_back(
          {zoom == 1 ? start.name : fmt::format("{} x{}", start.name, zoom), camera, first});
      made.zoom.push_back(zoom);
    }
  }
  return made;
}

AnyViewWorld parts_world(const PartsScene& scene, const SelectionModel& model) {
  auto selections = std::make_shared<Selections>(scene, model);
  return {scene.truths,
          [selections](std::span<const ViewClick> clicks, int choice, const Job&) -> CutAnswer {
            const ClickSelection& selection = selections->after(clicks, choice);
            return {selection.labels(), {}, {selection.meanings().begin(), selection.meanings().end()}};
          },
          [&scene](const Camera& camera, const std::vector<std::uint8_t>& labels) {
            const LeafView& view = view_of(scene, camera);
            return shown(view.gaussians, view.camera, labels);
          }};
}

}  // namespace splatcut
