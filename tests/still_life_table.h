// A still life with its parts and the truth of its objects, made once.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "scene/cloud/morton.h"
#include "scene/raster/rasterizer.h"
#include "scene/still_life/still_life.h"
#include "segment/masks/mask_tools.h"
#include "segment/selection/leaf_view.h"
#include "segment/superpoints/observing_views.h"
#include "segment/superpoints/part_view.h"
#include "segment/superpoints/prepared_scene.h"

namespace splatcut::testing {

// A still life in Morton order and the truth of its objects.
struct Table {
  LabelledScene scene;
  GaussianCloud cloud;
  std::vector<std::uint8_t> label;
  PreparedScene prepared;
};

inline const Table& table() {
  static const Table made = [] {
    Table t;
    StillLifeOptions options;
    options.gaussians = 60000;
    t.scene = make_still_life(options);
    const std::vector<std::uint32_t> order = morton_order(t.scene.cloud.position);
    t.cloud = permuted(t.scene.cloud, order);
    for (const std::uint32_t g : order) t.label.push_back(t.scene.label[g]);
    t.prepared =
        prepare_scene(t.cloud, observing_views(t.cloud, t.scene.cameras.front(), {0, 1, 0}, t.scene.cameras));
    return t;
  }();
  return made;
}

struct Target {
  Camera camera;
  PartView view;
  Mask truth;
  LeafView leaves;
};

inline Target target(const Table& t, const std::string& object) {
  const auto seed = std::ranges::find(t.scene.seeds, object, &LabelledScene::SeedClick::object);
  const auto index = std::ranges::find(t.scene.label_name, object) - t.scene.label_name.begin();
  std::vector<std::uint8_t> labels(t.cloud.size());
  for (std::size_t g = 0; g < labels.size(); ++g) labels[g] = t.label[g] == index;
  Target out{limited_to_width(t.scene.cameras[static_cast<std::size_t>(seed->camera)], 400), {}, {}, {}};
  RasterOptions raster;
  raster.depth = true;
  out.view = view_parts(t.prepared.parts, rasterize(t.cloud, out.camera, raster).first_hit);
  out.truth = thresholded(render_labels(t.cloud, out.camera, labels), 0.5f);
  out.leaves = leaf_view(t.cloud, t.prepared.parts, out.camera);
  return out;
}

}  // namespace splatcut::testing
