#include "app/studio/opened_scene.h"

#include "app/console/camera_options.h"
#include "app/studio/camera_controller.h"
#include "app/studio/work_file.h"
#include "core/error.h"
#include "scene/camera/camera_file.h"
#include "scene/raster/first_view.h"
#include "scene/raster/guessed_up.h"

namespace splatcut {

namespace {

Camera view_of_all(const OpenedScene& scene) {
  constexpr int kWidth = 640, kHeight = 480;
  return view_of_all(scene.bounds, scene.up_world, CameraPose{}.fov_y_rad, kWidth, kHeight);
}

// Without cameras, up and first view are guessed from the splats.
void look_around(OpenedScene* scene, const Job& job) {
  scene->up_world = guessed_up(*scene->cloud);
  scene->first_view =
      better_first_view(*scene->cloud, scene->bounds, scene->up_world, view_of_all(*scene), job);
}

}  // namespace

std::vector<Camera> cameras_near(const std::filesystem::path& scene) {
  std::filesystem::path folder = std::filesystem::absolute(scene).parent_path();
  for (int level = 0; level < 3; ++level) {
    for (const char* name : {"cameras.json", "transforms.json", "sparse/0"}) {
      if (!std::filesystem::exists(folder / name)) continue;
      try {
        return load_cameras(folder / name);
      } catch (const Error&) {
        // A file of that name with other content must not keep the scene from opening.
      }
    }
    if (!folder.has_parent_path() || folder == folder.parent_path()) break;
    folder = folder.parent_path();
  }
  return {};
}

std::shared_ptr<OpenedScene> open_scene(const std::filesystem::path& file, const Job& job,
                                        std::optional<SpzAxes> spz_axes) {
  auto opened = std::make_shared<OpenedScene>();
  opened->cameras = cameras_near(file);
  auto scene = std::make_shared<Scene>(load_scene(file, {spz_axes, opened->cameras}, job));
  if (job.cancelled()) return opened;
  opened->cloud = std::shared_ptr<const GaussianCloud>(scene, &scene->cloud);
  opened->bounds = framed_bounds(scene->cloud);
  opened->hash = hash_of_file(scene->path);
  if (opened->cameras.empty())
    look_around(opened.get(), job);
  else
    opened->up_world = common_up(opened->cameras);
  opened->scene = std::move(scene);
  return opened;
}

std::shared_ptr<const PreparedScene> prepare(const OpenedScene& scene, const Job& job,
                                             const PreparedCache& cache) {
  const Camera reference = !scene.cameras.empty() ? scene.cameras.front()
                           : scene.first_view     ? *scene.first_view
                                                  : view_of_all(scene);
  PrepareOptions options;
  options.cache = cache;
  return std::make_shared<const PreparedScene>(
      prepare_scene(*scene.cloud, reference, scene.up_world, scene.cameras, options, job));
}

SessionScene session_scene(const OpenedScene& scene, std::shared_ptr<const PreparedScene> prepared) {
  return {scene.cloud, std::move(prepared), scene.up_world, {}};
}

}  // namespace splatcut
