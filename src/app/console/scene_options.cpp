#include "app/console/scene_options.h"

#include "app/console/console.h"
#include "scene/camera/camera_file.h"

namespace splatcut {

void SceneOptions::add_to(CLI::App& command) {
  command
      .add_option("--spz-axes", spz_axes,
                  "Axes of a .spz: rub (x right, y up, z back, as the format's text says) or ply (as in a "
                  ".ply, as some editors store them). Without it: as the file or the cameras say, else rub")
      ->check(CLI::IsMember({"ply", "rub"}));
}

Scene SceneOptions::load(const std::filesystem::path& scene, const std::filesystem::path& cameras, bool quiet,
                         const Job& job) const {
  LoadOptions options{axes(), {}};
  if (!cameras.empty()) options.cameras = load_cameras(cameras);
  Scene loaded = load_scene(scene, options, job);
  if (!options.spz_axes && !loaded.axes_note.empty()) {
    end_progress();
    warn(loaded.axes_note + ". --spz-axes takes others", quiet);
  }
  warn(loaded.left_out, quiet);
  warn(loaded.oddity, quiet);
  return loaded;
}

}  // namespace splatcut
