#include "app/document/opened_scene.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cassert>

#include "app/document/camera_pose.h"
#include "app/document/words.h"
#include "core/byte_hash.h"
#include "core/error.h"
#include "scene/camera/camera_file.h"
#include "scene/camera/camera_names.h"
#include "scene/camera/common_up.h"
#include "scene/cloud/scene_memory.h"
#include "scene/cloud/strays.h"
#include "scene/formats/merged_scene.h"
#include "scene/raster/first_view.h"
#include "scene/raster/guessed_up.h"

namespace splatcut {

namespace {

Camera view_of_all(const Box& bounds, const glm::vec3& up_world) {
  constexpr int kWidth = 640, kHeight = 480;
  return view_of_all(bounds, up_world, CameraPose{}.fov_y_rad, kWidth, kHeight);
}

// Of the capture: as asked for, else those beside the file. remark: a sentence about what was read, or empty.
std::vector<Camera> cameras_of(const SceneSource& file, const glm::dvec3& origin, std::string* remark) {
  if (file.cameras.empty()) return cameras_near(file.path, origin, remark);
  std::vector<Camera> cameras = load_cameras(file.cameras, remark, origin);
  if (cameras.empty()) throw Error(file.cameras.string(), "holds no camera");
  return cameras;
}

// Whether cameras that lie beside a file stand otherwise than the file says, as where it was turned when it
// was written: they are not its own.
bool stand_otherwise(const std::vector<Camera>& cameras, const std::optional<glm::vec3>& up) {
  constexpr float kAlike = 0.87f;  // 30 degrees
  return up && !cameras.empty() && glm::dot(glm::normalize(common_up(cameras)), *up) < kAlike;
}

// The one to begin with.
Camera chosen_of(const SceneSource& file, const std::vector<Camera>& cameras) {
  if (file.camera.empty()) return cameras.front();
  if (cameras.empty())
    throw Error("--camera " + file.camera, "names a camera, but the scene has none",
                "Give them with --cameras");
  return find_camera(cameras, file.camera, (file.cameras.empty() ? file.path : file.cameras).string());
}

// Without cameras the first view is guessed from the splats, and up where the file does not say it.
FileViews views_of(const SceneSource& file, const Scene& scene, std::vector<Camera> cameras, const Job& job) {
  const Box& bounds = file.bounds;
  FileViews views;
  views.cameras = std::move(cameras);
  if (!views.cameras.empty() || !file.camera.empty()) {
    views.reference = chosen_of(file, views.cameras);
    views.up_world = scene.up ? *scene.up : common_up(views.cameras);
    return views;
  }
  views.up_is_guess = !scene.up;
  const UpGuess guess = scene.up ? UpGuess{*scene.up, true} : up_guess(scene.cloud);
  views.up_world = guess.up_world;
  views.up_is_unsure = !guess.sure;
  views.reference = view_of_all(bounds, views.up_world);
  job.progress("choosing the first view", 1);
  views.first_view = better_first_view(scene.cloud, bounds, views.up_world, views.reference, job);
  if (views.first_view) views.reference = *views.first_view;
  return views;
}

// The level of detail to read, where none is asked for: the finest that the free memory holds.
void choose_level(SceneSource* file, std::vector<std::string>* remarks) {
  file->levels = levels_of(file->path);
  const std::vector<std::uint64_t>& counts = file->levels.gaussians;
  if (counts.size() < 2 || file->lod) return;
  const std::optional<std::uint64_t> available = available_memory();
  file->lod = available ? finest_level(file->levels, *available) : 0;
  remarks->push_back(remark_on_level(file->levels, *file->lod, available));
}

Scene load(SceneSource* file, const OpenedScene* before, const Job& job, std::vector<std::string>* remarks) {
  std::string of_cameras;
  const SceneSource* known = before ? before->file(file->id) : nullptr;
  std::vector<Camera> cameras = known ? known->views->cameras : cameras_of(*file, glm::dvec3(0), &of_cameras);
  choose_level(file, remarks);
  Scene scene = load_scene(file->path, {file->spz_axes, cameras, file->lod.value_or(0), file->origin}, job);
  if (job.cancelled()) return scene;
  if (scene.origin != glm::dvec3(0) && !known) cameras = cameras_of(*file, scene.origin, nullptr);
  if (file->cameras.empty() && !known && stand_otherwise(cameras, scene.up)) {
    cameras.clear();
    file->cameras_are_others = true;
  }
  const std::uint64_t hash = hash_of_file(scene.path);
  if (known && known->hash != hash)
    throw Error(scene.path.string(), "was changed by another program since it was opened", "Open it again");
  const bool asked = file->spz_axes.has_value();
  const bool said = file->levels.gaussians.size() > 1;  // that levels are left out
  for (const std::string& remark :
       {remark_on_folder(file->path, scene), said ? std::string() : scene.left_out, of_cameras, scene.oddity,
        asked ? std::string() : scene.axes_note})
    if (!known && !remark.empty()) remarks->push_back(remark);
  file->path = scene.path;
  file->spz_axes = scene.taken_axes;
  file->origin = scene.origin;
  file->hash = hash;
  file->file_rows = scene.file_rows;
  file->gaussians = scene.cloud.size();
  file->bounds = framed_bounds(scene.cloud);
  file->views = known ? known->views
                      : std::make_shared<const FileViews>(views_of(*file, scene, std::move(cameras), job));
  return scene;
}

Scene one_of(std::vector<Scene> scenes, const Job& job) {
  return scenes.size() == 1 ? std::move(scenes.front()) : merged(std::move(scenes), job).scene;
}

}  // namespace

const SceneSource* OpenedScene::file(std::uint32_t id) const {
  const auto found = std::ranges::find(files, id, &SceneSource::id);
  return found == files.end() ? nullptr : &*found;
}

std::vector<std::uint8_t> gaussians_of(const OpenedScene& scene, std::uint32_t file) {
  std::vector<std::uint8_t> own(scene.cloud->size(), 0);
  std::size_t first = 0;
  for (const SceneSource& source : scene.files) {
    if (source.id != file) {
      first += source.file_rows;
      continue;
    }
    for (std::size_t g = 0; g < own.size(); ++g) {
      const std::size_t row = scene.cloud->file_row[g];
      own[g] = row >= first && row < first + source.file_rows;
    }
    break;
  }
  return own;
}

std::string remark_on_level(const SceneLevels& levels, unsigned level,
                            const std::optional<std::uint64_t>& free_bytes) {
  const auto gb = [](std::uint64_t bytes) {
    return fmt::format("{:.1f} GB", 1e-9 * static_cast<double>(bytes));
  };
  const std::uint64_t needed = memory_of_scene(levels.gaussians[level], levels.sh_degree);
  std::string why;
  if (free_bytes && needed <= *free_bytes)
    why = fmt::format(": the finest that the free memory holds ({} of {})", gb(needed), gb(*free_bytes));
  else if (free_bytes)
    why = fmt::format(", the coarsest: it takes {} where {} are free", gb(needed), gb(*free_bytes));
  return fmt::format("Level of detail {} of {} is read, 0 the finest{}. View has the others", level,
                     levels.gaussians.size(), why);
}

std::vector<Camera> cameras_near(const std::filesystem::path& scene, const glm::dvec3& origin,
                                 std::string* why_none) {
  std::filesystem::path folder = std::filesystem::absolute(scene_file_in(scene)).parent_path();
  for (int level = 0; level < 3; ++level) {
    for (const char* name : {"cameras.json", "transforms.json", "sparse/0"}) {
      std::error_code hidden;  // another user's folder, a link to itself
      if (!std::filesystem::exists(folder / name, hidden)) continue;
      try {
        std::vector<Camera> cameras = load_cameras(folder / name, nullptr, origin);
        if (why_none) why_none->clear();
        return cameras;
      } catch (const Error& error) {
        // A file of that name with other content must not keep the scene from opening.
        if (why_none && why_none->empty())
          *why_none = fmt::format("No cameras were read from {}: {}", name, error.what());
      }
    }
    if (!folder.has_parent_path() || folder == folder.parent_path()) break;
    folder = folder.parent_path();
  }
  return {};
}

std::shared_ptr<OpenedScene> open_scene(std::vector<SceneSource> files, const Job& job,
                                        const OpenedScene* before, std::vector<std::string>* refused) {
  assert(!files.empty());
  auto opened = std::make_shared<OpenedScene>();
  std::vector<Scene> scenes;
  for (auto file = files.begin(); file != files.end();) {
    if (!file->origin) file->origin = files.front().origin;
    const bool may_go = refused && file != files.begin() && !(before && before->file(file->id));
    try {
      scenes.push_back(load(&*file, before, job, &opened->remarks));
    } catch (const Error& error) {
      if (!may_go) throw;
      refused->push_back(error.what());
      file = files.erase(file);
      continue;
    }
    if (job.cancelled()) return opened;
    if (file != files.begin() && glm::length(file->solid.extent()) == 0)
      file->solid = solid_bounds(scenes.back().cloud);
    ++file;
  }
  stand(&files);
  for (std::size_t i = 0; i < files.size(); ++i)
    if (files[i].place != ScenePlace{})
      scenes[i].cloud = placed(scenes[i].cloud, {}, similarity_of(files[i]));
  auto scene = std::make_shared<Scene>(one_of(std::move(scenes), job));
  if (job.cancelled()) return opened;
  opened->cloud = std::shared_ptr<const GaussianCloud>(scene, &scene->cloud);
  opened->bounds = framed_bounds(scene->cloud);
  opened->blocks = std::make_shared<const CloudBlocks>(scene->cloud);
  opened->files = std::move(files);
  opened->scene = std::move(scene);
  return opened;
}

std::shared_ptr<OpenedScene> open_scene(const std::filesystem::path& file, const Job& job) {
  return open_scene(std::vector{SceneSource{.path = file}}, job);
}

std::shared_ptr<OpenedScene> open_first(std::vector<SceneSource> files,
                                        std::vector<std::filesystem::path>* added,
                                        std::vector<std::string>* refused, const Job& job) {
  const SceneSource& first = files.front();
  if (!first.cameras.empty() || !first.camera.empty()) {  // a wrong one is no fault of the scenes
    const std::vector<Camera> cameras = cameras_of(first, glm::dvec3(0), nullptr);
    if (!first.cameras.empty() || !cameras.empty()) chosen_of(first, cameras);
  }
  while (true) try {
      return open_scene(files, job);
    } catch (const Error& error) {
      if (added->empty() && refused->empty()) throw;
      refused->push_back(error.what());
      if (added->empty()) {
        const std::string all = fmt::format("{}", fmt::join(*refused, "\n"));
        throw Error("", "None of the files is a scene", all.substr(0, all.find_last_not_of('.') + 1));
      }
      files.front().path = added->front();
      added->erase(added->begin());
    }
}

std::string described(const OpenedScene& opened) {
  const Scene& scene = *opened.scene;
  const std::size_t more = opened.files.size() - 1;
  std::string text =
      fmt::format("{}{}: {}", scene_name(scene.path), more ? fmt::format(" and {} more", more) : "",
                  gaussians_text(scene.cloud.size()));
  if (scene.dropped) text += fmt::format(", {} unusable rows left out", grouped(scene.dropped));
  if (!opened.views().cameras.empty())
    text += fmt::format(", {} cameras (N, P)", opened.views().cameras.size());
  return text + (opened.views().up_is_unsure
                     ? ". Which way is up is guessed. Does it lean? Set what is up under View"
                     : "");
}

std::string added_text(const OpenedScene& scene, const OpenedScene& before) {
  std::string names;
  std::size_t count = 0;
  bool moved = false;
  for (const SceneSource& file : scene.files) {
    if (before.file(file.id)) continue;
    names += (count++ == 0 ? "" : ", ") + scene_name(file.path);
    moved |= file.place != ScenePlace{};
  }
  const bool one = count == 1;
  return fmt::format("{} added. Files moves, turns and scales {}{}", names, one ? "it" : "them",
                     !moved ? ""
                     : one  ? ", or puts it where its file says"
                            : ", or puts them where their files say");
}

Session session_on(const OpenedScene& scene, const PreparedCache& cache) {
  const FileViews& views = scene.views();
  return Session({.cloud = scene.cloud,
                  .blocks = scene.blocks,
                  .up_world = views.up_world,
                  .photographs = views.cameras,
                  .prepare = {.observing = {}, .model = {}, .cache = cache}});
}

}  // namespace splatcut
