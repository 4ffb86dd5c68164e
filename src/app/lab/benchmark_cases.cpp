// The tasks of benchmark_folders.h read and checked: which camera a mask belongs to, and whether it fits.
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>
#include <numeric>
#include <optional>

#include "app/console/camera_options.h"
#include "app/console/mask_folder.h"
#include "app/lab/benchmark_folders.h"
#include "app/lab/scribble_picture.h"
#include "core/error.h"
#include "core/picture_file.h"
#include "scene/camera/camera_file.h"
#include "scene/camera/camera_names.h"
#include "scene/camera/common_up.h"

namespace splatcut {

namespace {

namespace fs = std::filesystem;

// Half as bright as the brightest and more, so that masks of 0 and 1 are masks, too.
Mask read_drawing(const fs::path& file, const std::string& what) {
  Mask mask = read_png_grey(file);
  const int brightest = *std::ranges::max_element(mask.pixels());
  if (brightest == 0)
    throw Error(file.string(), what + " is empty: no pixel is brighter than black",
                "Give one that marks the object, or leave its task out");
  for (auto& m : mask.pixels()) m = 2 * m >= brightest ? kMaskObject : 0;
  return mask;
}

// The NNN of imageNNN.
std::optional<std::size_t> image_number(const std::string& name) {
  constexpr std::string_view kImage = "image";
  std::size_t number = 0;
  if (!name.starts_with(kImage) || name.size() == kImage.size()) return std::nullopt;
  const auto [end, failure] = std::from_chars(name.data() + kImage.size(), name.data() + name.size(), number);
  return failure == std::errc() && end == name.data() + name.size() ? std::optional(number) : std::nullopt;
}

const Camera& camera_of(const std::vector<Camera>& cameras, std::string name, const std::string& where) {
  if (name.ends_with("_mask")) name.resize(name.size() - 5);
  std::vector<std::size_t> found = cameras_named(cameras, name);
  if (found.empty() && (name.starts_with("0_") || name.starts_with("1_")))
    found = cameras_named(cameras, name.substr(2));
  if (const auto number = image_number(name); found.empty() && number && *number < cameras.size()) {
    std::vector<std::size_t> by_name(cameras.size());
    std::iota(by_name.begin(), by_name.end(), std::size_t{0});
    std::ranges::sort(by_name,
                      [&](std::size_t a, std::size_t b) { return cameras[a].name < cameras[b].name; });
    found = {by_name[*number]};
  }
  if (found.empty())
    throw Error(where, fmt::format("no camera is called \"{}\"", name),
                fmt::format("There are {}, the first is \"{}\"", cameras.size(),
                            cameras.empty() ? "" : cameras.front().name));
  if (found.size() > 1)
    throw Error(where, fmt::format("{} cameras are called \"{}\"", found.size(), name),
                "Give the pictures names that differ");
  return cameras[found.front()];
}

// The camera in the size of the drawing.
Camera in_size_of(const Camera& camera, const Mask& drawing, const std::string& where) {
  constexpr double kMostOff = 0.01;  // Truck: masks of 980 pixels, photographs of 979
  const double aspect = static_cast<double>(camera.width_px) / camera.height_px,
               own = static_cast<double>(drawing.width()) / drawing.height();
  if (std::abs(own / aspect - 1) > kMostOff)
    throw Error(where,
                fmt::format("is {}x{} pixels, the camera's picture {}x{}: another aspect ratio",
                            drawing.width(), drawing.height(), camera.width_px, camera.height_px),
                "Scale the picture, or give the cameras that it belongs to");
  return resized(camera, drawing.width(), drawing.height());
}

void add_scribbles(const std::vector<fs::path>& files, SeedLabel label, const std::vector<Camera>& cameras,
                   const BenchmarkTask& task, EvaluationCase* test) {
  for (const fs::path& file : files) {
    const Mask drawn = read_drawing(file, "the scribble");
    const Camera camera = in_size_of(camera_of(cameras, task.reference, file.string()), drawn, file.string());
    if (test->clicks.empty()) test->reference = camera;
    const float factor = static_cast<float>(test->reference.width_px) / static_cast<float>(camera.width_px);
    const Strokes strokes = scaled(strokes_of_picture(drawn, label), factor);
    test->clicks.insert(test->clicks.end(), strokes.begin(), strokes.end());
  }
}

void fill(const BenchmarkTask& task, const std::vector<Camera>& cameras, EvaluationCase* test) {
  test->name = task.name;
  test->scene_cameras = cameras;
  test->up_world = common_up(cameras);
  if (!task.reference_mask.empty()) {
    test->reference_truth = read_drawing(task.reference_mask, "the mask");
    test->reference =
        in_size_of(camera_of(cameras, task.reference_mask.stem().string(), task.reference_mask.string()),
                   *test->reference_truth, task.reference_mask.string());
  }
  // What is not meant first: no part that holds it can then be what the object's scribbles mean.
  add_scribbles(task.negative, SeedLabel::kRest, cameras, task, test);
  add_scribbles(task.positive, SeedLabel::kObject, cameras, task, test);
  for (const fs::path& file : task.masks) {
    test->truth_masks.push_back(read_drawing(file, "the mask"));
    test->test_views.push_back(in_size_of(camera_of(cameras, file.stem().string(), file.string()),
                                          test->truth_masks.back(), file.string()));
  }
}

}  // namespace

std::unique_ptr<LoadedCase> load_task(const BenchmarkTask& task, const PrepareOptions& prepare,
                                      const Job& job) {
  auto loaded = std::make_unique<LoadedCase>();
  // Masks first: they are read in a moment, and what is wrong with them is known before the scene is loaded.
  const std::vector<Camera> cameras = load_cameras(task.cameras, &loaded->warning);
  if (cameras.empty()) throw Error(task.cameras.string(), "holds no camera");
  EvaluationCase& test = loaded->test;
  fill(task, cameras, &test);
  const auto start = std::chrono::steady_clock::now();
  loaded->scene = load_scene(task.scene, job);
  loaded->load_ms =
      std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  test.cloud = &loaded->scene.cloud;
  test.prepare = prepare;
  return loaded;
}

}  // namespace splatcut
