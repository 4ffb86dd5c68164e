#include "app/measure/still_life_files.h"

#include <algorithm>
#include <span>
#include <vector>

#include "core/atomic_file.h"
#include "core/json_file.h"
#include "scene/cloud/morton.h"
#include "scene/formats/scene_file.h"
#include "scene/still_life/still_life_cameras.h"

namespace splatcut {

namespace {

void write_bytes(const std::filesystem::path& path, const std::vector<std::uint8_t>& bytes) {
  AtomicFile file(path);
  file.write(std::as_bytes(std::span(bytes)));
  file.commit();
}

nlohmann::json seeds_json(const LabelledScene& made) {
  nlohmann::json objects = nlohmann::json::array();
  for (const auto& seed : made.seeds)
    objects.push_back({{"object", seed.object},
                       {"camera", seed.camera},
                       {"clicks", {{{"x", seed.pixel.x}, {"y", seed.pixel.y}, {"label", "object"}}}}});
  return {{"labels", made.label_name}, {"objects", objects}};
}

// One entry per object, as `splatcut-lab eval` takes them: clicks by the robot, every camera a test view.
nlohmann::json suite_json(const LabelledScene& made, const std::string& file, const std::string& labels_file,
                          const std::string& own_file) {
  nlohmann::json views = nlohmann::json::array(), scenes = nlohmann::json::array();
  for (const Camera& camera : made.cameras) views.push_back({{"camera", camera.name}});
  for (const auto& seed : made.seeds) {
    const auto label = std::ranges::find(made.label_name, seed.object) - made.label_name.begin();
    scenes.push_back({{"name", seed.object},
                      {"scene", file},
                      {"cameras", "cameras.json"},
                      {"truth", {{"labels", labels_file}, {"label", label}, {"own", own_file}}},
                      {"reference", {{"camera", made.cameras[static_cast<std::size_t>(seed.camera)].name}}},
                      {"clicks", "robot"},
                      {"test_views", views}});
  }
  return {{"scenes", scenes}};
}

}  // namespace

void write_still_life(const OutputFolder& folder, const LabelledScene& made, const std::string& name,
                      const std::string& format) {
  Scene scene;
  scene.file_rows = made.cloud.size();
  scene.format = SceneFormat::kSplat;  // no file behind it: every row is written from the cloud
  // Rows along a Morton curve: compressed .ply wants neighbours together, and the labels follow.
  const std::vector<std::uint32_t> order = morton_order(made.cloud.position);
  scene.cloud = permuted(made.cloud, order);
  std::vector<std::uint8_t> label(order.size()), own(order.size());
  for (std::uint32_t row = 0; row < order.size(); ++row) {
    scene.cloud.file_row[row] = row;
    label[row] = made.label[order[row]];
    own[row] = made.own[order[row]];
  }
  const std::string file = name + "." + format;
  save_scene(folder.file(file), scene, {}, output_format_from_name(file));
  const std::string labels_file = name + ".labels.u8", own_file = name + ".own.u8";
  write_bytes(folder.file(labels_file), label);
  write_bytes(folder.file(own_file), own);
  save_inria_cameras(folder.file("cameras.json"), made.cameras);
  write_text_file(folder.file("seeds.json"), json_text(seeds_json(made), 1) + "\n");
  write_text_file(folder.file("suite.json"),
                  json_text(suite_json(made, file, labels_file, own_file), 1) + "\n");
}

}  // namespace splatcut
