#include "app/console/scene_options.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>

#include "app/console/console.h"
#include "core/error.h"
#include "scene/camera/camera_file.h"

namespace splatcut {

void SceneOptions::add_to(CLI::App& command) {
  command
      .add_option("--lod", lod,
                  "Level of detail of a streamed .sog, .lcc, .lcc2 or .rad, 0 the finest: less memory, fewer "
                  "Gaussians")
      ->check(CLI::Range(0, 100));
  command
      .add_option(
          "--spz-axes", spz_axes,
          "Axes of a .spz: rub (x right, y up, z back, as the format's text says) or ply (as in a "
          ".ply, as some editors store them). Without it: as the file or the cameras say, or as the scene "
          "stands, else rub")
      ->check(CLI::IsMember({"ply", "rub"}));
}

Scene SceneOptions::load(const std::filesystem::path& scene, const std::filesystem::path& cameras, bool quiet,
                         const Job& job, std::string_view called,
                         const std::optional<glm::dvec3>& origin) const {
  LoadOptions options{axes(), {}, lod.value_or(0), origin};
  if (!cameras.empty()) options.cameras = load_cameras(cameras);
  Scene loaded = load_scene(scene, options, job);
  if (called.empty()) check_axes({&loaded, 1});
  std::vector<std::string> said = remarks(loaded);
  if (const std::string of_folder = remark_on_folder(scene, loaded); !of_folder.empty())
    said.insert(said.begin(), of_folder);
  for (const std::string& remark : said)
    warn(called.empty() ? remark : fmt::format("{}: {}", called, remark), quiet);
  return loaded;
}

std::vector<std::string> SceneOptions::remarks(const Scene& loaded) const {
  std::vector<std::string> remarks;
  if (!axes() && !loaded.axes_note.empty()) remarks.push_back(loaded.axes_note + ". --spz-axes takes others");
  if (!loaded.left_out.empty()) remarks.push_back(loaded.left_out);
  if (loaded.dropped > 0)
    remarks.push_back(
        fmt::format("{} of its {} Gaussians are left out: not a number, without a rotation, or of a place or "
                    "size beyond 1e15",
                    loaded.dropped, loaded.file_rows));
  if (!loaded.oddity.empty()) remarks.push_back(loaded.oddity);
  return remarks;
}

void SceneOptions::check_axes(std::span<const Scene> scenes) const {
  const auto is_spz = [](const Scene& scene) { return scene.format == SceneFormat::kSpz; };
  if (axes() && std::ranges::none_of(scenes, is_spz))
    throw Error(scenes.front().path.string(), "is no .spz, whose axes alone can be chosen",
                "Leave --spz-axes out");
}

int spz_version_for(const std::filesystem::path& output, const std::optional<int>& asked) {
  if (asked && output_format_from_name(output) != SceneFormat::kSpz)
    throw Error(output.string(), "is no .spz, whose version alone can be chosen", "Leave --spz-version out");
  return asked.value_or(SaveOptions{}.spz_version);
}

void add_spz_version(CLI::App& command, std::optional<int>* version) {
  command
      .add_option("--spz-version", *version,
                  "Version of a .spz to write: 3, which all programs read, or 4, which is smaller")
      ->check(CLI::IsMember({3, 4}));
}

}  // namespace splatcut
