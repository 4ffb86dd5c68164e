#include "app/lab/benchmark_folders.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "app/console/mask_folder.h"
#include "core/error.h"
#include "core/lower_case.h"
#include "scene/camera/camera_names.h"
#include "scene/formats/scene_formats.h"

namespace splatcut {

namespace {

namespace fs = std::filesystem;

std::vector<fs::path> sorted_entries(const fs::path& folder) {
  std::error_code failure;
  std::vector<fs::path> paths;
  for (const auto& entry : fs::directory_iterator(folder, failure))
    if (!entry.path().filename().string().starts_with('.')) paths.push_back(entry.path());
  if (failure) throw Error(folder.string(), "cannot be read as a folder (" + failure.message() + ")");
  std::ranges::sort(paths);
  return paths;
}

std::vector<fs::path> folders_in(const fs::path& folder) {
  std::vector<fs::path> paths = sorted_entries(folder);
  std::erase_if(paths, [](const fs::path& p) { return !fs::is_directory(p) || p.filename() == "__MACOSX"; });
  return paths;
}

std::vector<fs::path> pngs_in(const fs::path& folder) {
  std::vector<fs::path> paths = sorted_entries(folder);
  std::erase_if(paths, [](const fs::path& p) {
    return !fs::is_regular_file(p) || lower_case(p.extension().string()) != ".png";
  });
  return paths;
}

bool is_picture(const fs::path& path) {
  return fs::is_regular_file(path) && without_picture_ending(path.filename()) != path.filename().string();
}

// The reconstruction in a folder of it, or an empty path.
fs::path scene_in(const fs::path& folder) {
  fs::path last;
  int last_iteration = -1;
  constexpr std::string_view kIteration = "iteration_";
  if (fs::is_directory(folder / "point_cloud"))
    for (const fs::path& at : folders_in(folder / "point_cloud")) {
      const std::string name = at.filename().string();
      int iteration = -1;
      if (name.starts_with(kIteration))
        std::from_chars(name.data() + kIteration.size(), name.data() + name.size(), iteration);
      if (iteration <= last_iteration || !fs::exists(at / "point_cloud.ply")) continue;
      last = at / "point_cloud.ply";
      last_iteration = iteration;
    }
  if (!last.empty()) return last;
  std::vector<fs::path> files = sorted_entries(folder);
  std::erase_if(files, [](const fs::path& p) {
    return !fs::is_regular_file(p) || p.filename() == "input.ply" || p.filename() == "points3D.ply" ||
           !has_scene_extension(p);
  });
  if (files.size() > 1)
    throw Error(folder.string(),
                fmt::format("holds {} scenes, {} and {} among them", files.size(),
                            files[0].filename().string(), files[1].filename().string()),
                "Leave one of them");
  return files.empty() ? fs::path{} : files.front();
}

fs::path cameras_in(const fs::path& folder) {
  for (const char* name : {"cameras.json", "sparse/0", "sparse", "transforms.json"})
    if (fs::exists(folder / name)) return folder / name;
  throw Error(folder.string(), "holds no cameras", "Put cameras.json, sparse/0 or transforms.json there");
}

// The names under which the reconstruction of a task is looked for.
std::vector<std::string> scene_names(const std::string& task) {
  std::vector<std::string> names = {task, task + "_undistort"};
  if (const std::size_t underscore = task.rfind('_'); underscore != std::string::npos && underscore > 0) {
    const std::string whole = task.substr(0, underscore);
    names.insert(names.end(), {whole, whole + "_undistort"});
  }
  return names;
}

void find_scene(const fs::path& scenes, bool only_task, BenchmarkTask* task) {
  fs::path folder;
  const std::vector<fs::path> there = folders_in(scenes);
  for (const std::string& name : scene_names(task->name)) {
    const auto found = std::ranges::find_if(
        there, [&](const fs::path& p) { return lower_case(p.filename().string()) == lower_case(name); });
    if (found == there.end()) continue;
    folder = *found;
    break;
  }
  if (folder.empty() && only_task) folder = scenes;
  if (!folder.empty()) task->scene = scene_in(folder);
  if (task->scene.empty())
    throw Error(scenes.string(), "holds no reconstruction of " + task->name,
                "Put a folder " + task->name + " there, with a .ply and cameras.json");
  task->cameras = cameras_in(folder);
}

const fs::path& only_one(const std::vector<fs::path>& files, const fs::path& folder,
                         const std::string& what) {
  if (files.size() != 1)
    throw Error(folder.string(), fmt::format("holds {} {}, where one is expected",
                                             files.empty() ? "no" : std::to_string(files.size()), what));
  return files.front();
}

// NAME.png where NAME ends in neither _cutout nor _pseudo.
std::vector<fs::path> base_masks_in(const fs::path& folder) {
  std::vector<fs::path> files = pngs_in(folder);
  std::erase_if(files, [](const fs::path& p) {
    const std::string stem = p.stem().string();
    return stem.ends_with("_cutout") || stem.ends_with("_pseudo");
  });
  return files;
}

// Where the masks of a SPIn-NeRF scene are: beside nothing else, or in a folder that says so.
std::vector<fs::path> masks_of_scene(const fs::path& folder) {
  const auto says_so = [](const fs::path& p) {
    const std::string name = lower_case(p.filename().string());
    return name == "label" || name == "mask" || name == "masks" || name.ends_with("_mask") ||
           name.ends_with("_masks");
  };
  std::vector<fs::path> places;
  for (const fs::path& child : folders_in(folder)) {
    if (says_so(child))
      places.push_back(child);
    else if (lower_case(child.filename().string()).starts_with("images") && fs::is_directory(child / "label"))
      places.push_back(child / "label");
  }
  if (places.size() > 1)
    throw Error(folder.string(),
                fmt::format("has masks in {} and in {}", places[0].string(), places[1].string()),
                "Leave one of them");
  return base_masks_in(places.empty() ? folder : places.front());
}

fs::path labels_folder(const fs::path& given) {
  for (const char* inner : {"", "llff", "labels/llff", "labels"})
    if (fs::is_directory(given / inner / "scribbles")) return given / inner;
  throw Error(given.string(), "holds no folder \"scribbles\"",
              "Give the folder of NVOS that holds scribbles, masks and reference_image");
}

}  // namespace

std::vector<BenchmarkTask> nvos_tasks(const fs::path& given, const fs::path& scenes) {
  const fs::path labels = labels_folder(given);
  const std::vector<fs::path> folders = folders_in(labels / "scribbles");
  std::vector<BenchmarkTask> tasks;
  for (const fs::path& scribbles : folders) {
    BenchmarkTask& task = tasks.emplace_back();
    task.name = scribbles.filename().string();
    for (const fs::path& file : pngs_in(scribbles)) {
      if (file.filename().string().starts_with("pos_")) task.positive.push_back(file);
      if (file.filename().string().starts_with("neg_")) task.negative.push_back(file);
    }
    if (task.positive.empty())
      throw Error(scribbles.string(), "holds no scribble on the object", "pos_*.png is expected");
    std::vector<fs::path> references = sorted_entries(labels / "reference_image" / task.name);
    std::erase_if(references, [](const fs::path& p) { return !is_picture(p); });
    task.reference = without_picture_ending(
        only_one(references, labels / "reference_image" / task.name, "reference pictures").filename());
    std::vector<fs::path> masks = pngs_in(labels / "masks" / task.name);
    std::erase_if(masks, [](const fs::path& p) { return !p.stem().string().ends_with("_mask"); });
    task.masks = {only_one(masks, labels / "masks" / task.name, "masks NAME_mask.png")};
    find_scene(scenes, folders.size() == 1, &task);
  }
  if (tasks.empty()) throw Error((labels / "scribbles").string(), "holds no folder of a task");
  return tasks;
}

std::vector<BenchmarkTask> spin_nerf_tasks(const fs::path& masks, const fs::path& scenes) {
  std::vector<fs::path> folders;
  for (const fs::path& folder : folders_in(masks))
    if (!masks_of_scene(folder).empty()) folders.push_back(folder);
  if (!masks_of_scene(masks).empty()) folders = {masks};  // one scene of it
  std::vector<BenchmarkTask> tasks;
  for (const fs::path& folder : folders) {
    BenchmarkTask& task = tasks.emplace_back();
    const fs::path whole = fs::absolute(folder).lexically_normal();
    task.name = (whole.has_filename() ? whole : whole.parent_path()).filename().string();
    if (const std::size_t bracket = task.name.find(" ("); bracket != std::string::npos)
      task.name.resize(bracket);
    task.masks = masks_of_scene(folder);
    if (task.masks.size() < 2)
      throw Error(folder.string(), "holds one mask",
                  "One is given, the others are scored: two are the least");
    task.reference_mask = task.masks.front();
    task.masks.erase(task.masks.begin());
    find_scene(scenes, folders.size() == 1, &task);
  }
  if (tasks.empty())
    throw Error(masks.string(), "holds no masks",
                "Put NAME.png of each scene's cameras into a folder of the scene's name");
  return tasks;
}

}  // namespace splatcut
