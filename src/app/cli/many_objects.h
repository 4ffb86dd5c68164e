// Several objects cut out of one scene, which is prepared once for all of them.
//
// The objects share nothing: a Gaussian that two of them claim is the later one's, in the order of the file.
// So each Gaussian lies in exactly one of NAME.ply ... and rest.ply.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "app/cli/cutout_object.h"
#include "app/console/camera_options.h"
#include "app/console/output_folder.h"
#include "core/job.h"
#include "scene/formats/scene_file.h"
#include "segment/masks/seeds.h"
#include "segment/session/session.h"

namespace splatcut {

struct NamedSeeds {
  std::string name;                   // names the files
  std::optional<std::string> camera;  // of --cameras, by name or number; otherwise the reference
  Strokes strokes;
  int choice = 0;  // see CutRequest
};

// {"objects": [{"name", "camera", "clicks", "scribbles", "choice"}, ...]}, strokes_from_json() of each;
// "object" is read as "name", too (make-scene writes it). Empty where there are no "objects". Throws Error
// naming the entry.
std::vector<NamedSeeds> named_seeds_from_json(const nlohmann::json& seeds, const std::string& where);

// Throws Error for strokes outside of the camera's picture.
void check_inside(const Strokes& strokes, const Camera& camera);

struct ManyObjects {
  const Scene& scene;
  const ChosenCamera& chosen;
  const CameraOptions& camera;
  const CutSettings& settings;
  int part_step;  // of each object, see CutRequest
  const std::vector<NamedSeeds>& objects;
  const EdgeOptions& edges;
};

// Throws Error where an object's camera is not known or its strokes lie outside of the picture.
void check_objects(const ManyObjects& in);

// Of objects that pass check_objects(). Writes NAME.ply, NAME.labels.u8, NAME.png, NAME.tint.png and
// NAME.masks.png of each object, rest.ply, rest.png and labels.u8 (0 = rest, 1 = the first object, ...).
// Returns "objects", "rest" and "stages" of the report. Throws Error where an object is not found or left
// with nothing. Cancelled: the result is incomplete.
nlohmann::json cut_many_objects(const ManyObjects& in, Session* session, const OutputFolder& folder,
                                const Job& job);

}  // namespace splatcut
