// Scenes in and out, in the formats of scene_formats.h.
// Loading orders the Gaussians along a Morton curve and keeps the file row of each.
// Errors: every unreadable or unsuitable file is an Error naming file, property, row or byte; sizes are
// checked against the file before memory is taken. A scene narrower than 1e-12 units or wider than 1e12 is
// refused; within, nothing depends on the unit.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/job.h"
#include "scene/camera/camera.h"
#include "scene/cloud/gaussian_cloud.h"
#include "scene/formats/scene_formats.h"

namespace splatcut {

// What the axes of a .spz are. Its own text says x right, y up, z back; a widely used editor stores there
// those of the .ply it converts, x right, y down, z forward. Few files say it.
enum class SpzAxes { kRub, kPly };
const char* name_of(SpzAxes axes);  // as --spz-axes takes them
std::optional<SpzAxes> spz_axes_from_name(std::string_view name);

struct Scene {
  GaussianCloud cloud;                       // Morton order
  std::filesystem::path path;                // where it came from; reopened to copy rows
  std::vector<std::filesystem::path> files;  // all that were read: path, then buffers, pictures, pieces
  SceneFormat format = SceneFormat::kPly;
  std::size_t file_rows = 0;  // Gaussians in the file, dropped ones included
  std::size_t dropped = 0;    // rows left out: NaN, zero quaternion, place or size beyond 1e15 units
  glm::dvec3 origin{
      0};  // taken off positions that 32 bits do not hold: the file's are those of the cloud + it
  // Which way is up, unit length, in the axes of the cloud; none where nothing says it.
  std::optional<glm::vec3> up;
  std::uint64_t file_bytes = 0;  // with modified_ns: to notice that the file changed since
  std::int64_t modified_ns = 0;
  bool rows_can_be_copied = false;            // to a .ply, byte for byte from path
  bool rows_can_be_changed = false;           // copied, place, size, turn and opacity set anew
  std::vector<std::string> other_properties;  // columns of a .ply that say nothing of Gaussians
  std::string left_out;                       // a sentence on what was not read of it, or empty
  std::string oddity;                         // a sentence on values that no training produces, or empty

  // Of a .spz that does not say its axes, or was overruled: those taken, and a sentence on why.
  std::optional<SpzAxes> taken_axes;
  std::string axes_note;
};

// The scene with other Gaussians in place of its own: rows are then written anew, none is copied.
Scene with_cloud(const Scene& scene, GaussianCloud cloud);

struct LoadOptions {
  std::optional<SpzAxes>
      spz_axes;  // none: as the file says, else as the cameras see more, as it stands, else kRub
  std::vector<Camera> cameras;  // of the capture, if any are known
  // Of a streamed .sog: of each part the finest level from this one on, else the coarsest. Of an .lcc: the
  // level. Of an .lcc2: of each part this level, or the finest that it has where that is coarser.
  // Of a .rad: so many steps of its tree above the deepest leaf, or a leaf where one is above.
  unsigned lod = 0;
  // Scene::origin, of another scene that this one stands beside. Without it: whole units in the middle of a
  // .ply whose positions are in double, where 32 bits would move the middle Gaussian by more than 1/100 of
  // its size, and half as much off from there; else 0.
  std::optional<glm::dvec3> origin = {};
};

// The file to read where a folder may be given: its scene of several files, else a trainer's last iteration
// (point_cloud/iteration_N/point_cloud.ply), else its only scene file. Any other path as it is. Throws Error.
std::filesystem::path scene_file_in(const std::filesystem::path& path);
// Which of a given folder's files was read, as a sentence; empty where it is clear.
std::string remark_on_folder(const std::filesystem::path& given, const Scene& scene);

// Looks at the name and the first bytes alone: throws Error for a file that load_scene() refuses for them.
void check_beginning(const std::filesystem::path& path);

// The levels of detail of a scene that has several; of others none. Throws Error.
SceneLevels levels_of(const std::filesystem::path& path);
// The finest that memory_of_scene() says to fit, else the coarsest.
unsigned finest_level(const SceneLevels& levels, std::uint64_t memory_bytes);

Scene load_scene(const std::filesystem::path& path, const LoadOptions& options, const Job& job = {});
Scene load_scene(const std::filesystem::path& path, const Job& job = {});

struct SaveOptions {
  int spz_version = 3;        // 3, which every reader of .spz knows, or 4, which is smaller
  bool may_be_empty = false;  // a .ply without Gaussians is written rather than refused
  // What the file says of up, any length but 0, in the axes of the cloud; none: Scene::up, if that is known.
  std::optional<glm::vec3> up = {};
  std::span<const std::uint8_t> object_ids = {};  // per Gaussian: a .ply says them as property object_id
  // To a .ply whose rows can be changed: written last, each as the row of its file_row with its own place,
  // size, turn, opacity and constant colour.
  const GaussianCloud* changed_rows = nullptr;
};

struct SaveReport {
  std::size_t gaussians = 0;
  std::uint64_t bytes = 0;
  std::string loss;  // empty, or a sentence: "spherical harmonics of degree 2 are dropped"
};

// Writes the Gaussians with keep[g] != 0 (empty: all), in file order; compressed .ply in Morton order,
// because neighbours must share a chunk for its bounds to be narrow. From binary .ply to .ply the rows
// are copied byte for byte from scene.path (Error if that file changed since it was loaded). Throws Error for
// a format that is only read.
SaveReport save_scene(const std::filesystem::path& path, const Scene& scene,
                      std::span<const std::uint8_t> keep, const SceneFormat& format,
                      const SaveOptions& options = {});

}  // namespace splatcut
