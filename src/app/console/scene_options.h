// The scene part of the command line: how a file is read that does not say all of itself.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "scene/formats/scene_file.h"

namespace CLI {
class App;
}

namespace splatcut {

struct SceneOptions {
  std::string spz_axes;         // ply, rub, or empty
  std::optional<unsigned> lod;  // of LoadOptions

  void add_to(CLI::App& command);
  std::optional<SpzAxes> axes() const { return spz_axes_from_name(spz_axes); }

  // cameras: file or folder of --cameras, which helps to tell the axes of a .spz, or empty. Where they had to
  // be guessed, and where something is left out, a sentence on stderr says so. called: what it begins with
  // where the scene is one of several, which have the origin of the first.
  Scene load(const std::filesystem::path& scene, const std::filesystem::path& cameras, bool quiet,
             const Job& job, std::string_view called = {},
             const std::optional<glm::dvec3>& origin = {}) const;
};

// Of SaveOptions, for commands that write a scene.
void add_spz_version(CLI::App& command, int* version);

}  // namespace splatcut
