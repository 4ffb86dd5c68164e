#include "app/lab/eval_suite.h"

#include <fmt/format.h>

#include <chrono>

#include "app/console/camera_options.h"
#include "app/console/seeds_file.h"
#include "core/error.h"
#include "core/json_file.h"
#include "core/mapped_file.h"
#include "core/picture_file.h"
#include "scene/camera/camera_file.h"
#include "scene/camera/camera_names.h"
#include "scene/camera/common_up.h"
#include "scene/raster/guessed_up.h"

namespace splatcut {

namespace {

glm::vec3 vec3_of(const nlohmann::json& j) {
  return {j.at(0).get<float>(), j.at(1).get<float>(), j.at(2).get<float>()};
}

Camera look_at_of(const nlohmann::json& j) {
  constexpr double kMostPixels = 1 << 14;
  const double width = j.at("size").at(0), height = j.at("size").at(1);
  const float fov_y_deg = j.at("fov_y_deg");
  if (!(width >= 1 && height >= 1 && width <= kMostPixels && height <= kMostPixels))
    throw Error("camera", fmt::format("a picture of {} x {} pixels is impossible", width, height));
  if (!(fov_y_deg > 0 && fov_y_deg < 180)) throw Error("camera", fmt::format("fov_y_deg is {}", fov_y_deg));
  return look_at(vec3_of(j.at("position")), vec3_of(j.at("target")), vec3_of(j.at("up")),
                 glm::radians(fov_y_deg), static_cast<int>(width), static_cast<int>(height));
}

std::vector<std::uint8_t> truth_labels(const std::filesystem::path& path, const Scene& scene, int wanted) {
  const std::string bytes = text_of_file(path);
  if (bytes.size() != scene.file_rows)
    throw Error(path.string(),
                fmt::format("holds {} labels, the scene {} rows", bytes.size(), scene.file_rows));
  std::vector<std::uint8_t> labels(scene.cloud.size());
  for (std::size_t g = 0; g < labels.size(); ++g)
    labels[g] = static_cast<std::uint8_t>(bytes[scene.cloud.file_row[g]]) == wanted;
  return labels;
}

void load_mask_truth(const std::filesystem::path& folder, const std::vector<Camera>& cameras,
                     EvaluationCase* test) {
  for (const Camera& camera : cameras) {
    const std::filesystem::path file = folder / (camera.name + ".png");
    if (!std::filesystem::exists(file)) continue;
    Mask mask = read_png_grey(file);
    for (auto& m : mask.pixels()) m = m >= 128 ? kMaskObject : 0;
    test->test_views.push_back(resized(camera, mask.width(), mask.height()));
    test->truth_masks.push_back(std::move(mask));
  }
  if (test->test_views.empty()) throw Error(folder.string(), "holds no mask named after a camera");
}

// "reference", then "references": one of them at least.
std::vector<nlohmann::json> references_json(const nlohmann::json& entry) {
  std::vector<nlohmann::json> all;
  if (entry.contains("reference")) all.push_back(entry.at("reference"));
  if (entry.contains("references"))
    all.insert(all.end(), entry.at("references").begin(), entry.at("references").end());
  if (all.empty()) all.push_back(entry.at("reference"));  // says what is missing
  return all;
}

// The scene without its cameras: they say where the truth is seen, and nothing else. A view where it is
// opened says which way is up; nothing else of a cut depends on where one came from.
void open_elsewhere(const nlohmann::json& opened, EvaluationCase* test) {
  if (opened.is_string() && opened != "guessed")
    throw Error(test->name, "\"opened\" is neither \"guessed\" nor a view");
  test->scene_cameras.clear();
  test->up_world = opened.is_string() ? guessed_up(*test->cloud) : vec3_of(opened.at("up"));
}

// Clicks, "robot" for the robot's, and scribbles: one of them at least.
void fill_strokes(const nlohmann::json& entry, EvaluationCase* test) {
  const nlohmann::json none = nlohmann::json::array();
  const nlohmann::json clicks = entry.value("clicks", none);
  test->scribbles = strokes_from_json({{"scribbles", entry.value("scribbles", none)}}, test->name);
  if (clicks.is_array())
    test->clicks = strokes_from_json({{"clicks", clicks}}, test->name);
  else if (clicks != "robot")
    throw Error(test->name, "its clicks are neither a list nor \"robot\"");
  else if (test->truth_labels.empty())
    throw Error(test->name, "robot clicks need truth labels");
  test->scribbles_alone = clicks.is_array() && clicks.empty();
  if (test->scribbles_alone && test->scribbles.empty())
    throw Error(test->name, "has neither clicks nor scribbles",
                "Write \"clicks\": \"robot\" for the robot's");
}

void fill_case(const nlohmann::json& entry, const std::filesystem::path& folder, LoadedCase* loaded) {
  EvaluationCase& test = loaded->test;
  test.name = entry.at("name");
  test.cloud = &loaded->scene.cloud;
  std::vector<Camera> cameras;
  if (entry.contains("cameras"))
    cameras =
        load_cameras(folder / entry.at("cameras").get<std::string>(), &loaded->warning, loaded->scene.origin);
  test.scene_cameras = cameras;
  const std::vector<nlohmann::json> references = references_json(entry);
  const auto camera_of = [&](const nlohmann::json& view) {
    return view.contains("camera") ? find_camera(cameras, view.at("camera"), test.name) : look_at_of(view);
  };
  test.reference = camera_of(references.front());
  test.up_world =
      references.front().contains("camera") ? common_up(cameras) : vec3_of(references.front().at("up"));
  for (auto more = references.begin() + 1; more != references.end(); ++more)
    test.more_references.push_back({camera_of(*more), strokes_from_json(*more, test.name)});
  const auto& truth = entry.at("truth");
  if (truth.contains("labels")) {
    for (const auto& view : entry.at("test_views")) test.test_views.push_back(camera_of(view));
    test.truth_labels =
        truth_labels(folder / truth.at("labels").get<std::string>(), loaded->scene, truth.value("label", 1));
    if (truth.contains("own")) {
      test.own_labels = truth_labels(folder / truth.at("own").get<std::string>(), loaded->scene, 1);
      for (std::size_t g = 0; g < test.own_labels.size(); ++g) test.own_labels[g] &= test.truth_labels[g];
    }
    render_truth(&test);
  } else {
    load_mask_truth(folder / truth.at("masks").get<std::string>(), cameras, &test);
  }
  fill_strokes(entry, &test);
  if (entry.contains("opened")) open_elsewhere(entry.at("opened"), &test);
}

}  // namespace

std::vector<nlohmann::json> read_suite(const std::filesystem::path& path) {
  const nlohmann::json suite = json_of_file(path);
  if (!suite.is_object() || !suite.contains("scenes") || !suite.at("scenes").is_array())
    throw Error(path.string(), "is not a suite: a JSON object with \"scenes\" is expected");
  std::vector<nlohmann::json> entries;
  for (const nlohmann::json& entry : suite.at("scenes")) {
    const std::string where = fmt::format("{}: entry {}", path.string(), entries.size());
    if (!entry.is_object()) throw Error(where, "is no object with \"name\" and \"scene\"");
    if (!entry.value("name", nlohmann::json()).is_string()) throw Error(where, "has no \"name\"");
    entries.push_back(entry);
  }
  return entries;
}

void refuse_unknown(const std::string& option, const std::vector<std::string>& asked,
                    const std::vector<std::string>& scenes) {
  for (const std::string& name : asked)
    if (std::ranges::find(scenes, name) == scenes.end())
      throw Error(option + " " + name, "no scene has that name");
}

std::unique_ptr<LoadedCase> load_case(const nlohmann::json& entry, const std::filesystem::path& folder,
                                      const PrepareOptions& prepare, const Job& job) {
  auto loaded = std::make_unique<LoadedCase>();
  const auto ms = [](auto a, auto b) { return std::chrono::duration<double, std::milli>(b - a).count(); };
  try {
    const auto start = std::chrono::steady_clock::now();
    loaded->scene = load_scene(folder / entry.at("scene").get<std::string>(), job);
    const auto loaded_at = std::chrono::steady_clock::now();
    loaded->load_ms = ms(start, loaded_at);
    if (job.cancelled()) return loaded;
    loaded->test.prepare = prepare;
    fill_case(entry, folder, loaded.get());
  } catch (const nlohmann::json::exception& error) {
    throw Error("suite", fmt::format("the entry {} lacks something ({})", entry.at("name").get<std::string>(),
                                     fault_of(error)));
  }
  return loaded;
}

}  // namespace splatcut
