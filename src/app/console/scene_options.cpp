#include "app/console/scene_options.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>

#include "app/console/console.h"
#include "core/error.h"
#include "scene/camera/camera_file.h"

namespace splatcut {

namespace {

void say(std::string_view called, const std::string& sentence, bool quiet) {
  if (!sentence.empty()) warn(called.empty() ? sentence : fmt::format("{}: {}", called, sentence), quiet);
}

}  // namespace

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
  if (!options.spz_axes && !loaded.axes_note.empty()) {
    end_progress();
    say(called, loaded.axes_note + ". --spz-axes takes others", quiet);
  }
  say(called, loaded.left_out, quiet);
  if (loaded.dropped > 0)
    say(called,
        fmt::format("{} of its {} Gaussians are left out: not a number, without a rotation, or of a place or "
                    "size beyond 1e15",
                    loaded.dropped, loaded.file_rows),
        quiet);
  say(called, loaded.oddity, quiet);
  return loaded;
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
