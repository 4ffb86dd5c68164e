// The scene part of the command line: how a file is read that does not say all of itself.
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

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

  // Those sentences, without a full stop.
  std::vector<std::string> remarks(const Scene& loaded) const;

  // Throws Error where axes of a .spz are given and none of the scenes is one. load() does it of one scene.
  void check_axes(std::span<const Scene> scenes) const;
};

// Of SaveOptions, for commands that write a scene.
void add_spz_version(CLI::App& command, std::optional<int>* version);
// Throws Error where it was asked for and the output is no .spz.
int spz_version_for(const std::filesystem::path& output, const std::optional<int>& asked);

}  // namespace splatcut
