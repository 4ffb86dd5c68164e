// The objects of one `splatcut cut`, one or several, cut out of a scene that is prepared once for all of
// them.
//
// The objects share nothing: a Gaussian that two of them claim is the later one's, in the order of the list.
// So each Gaussian lies in exactly one of them or in the rest.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "app/console/camera_options.h"
#include "core/job.h"
#include "segment/masks/seeds.h"
#include "segment/session/session.h"

namespace splatcut {

struct NamedSeeds {
  std::string name;                   // names the files
  std::optional<std::string> camera;  // of --cameras, by name or number; otherwise the reference
  Strokes strokes;
  int choice = 0;  // see CutRequest
};

// {"objects": [{"name", "camera", "clicks", "boxes", "scribbles", "choice"}, ...]}, strokes_from_json() of
// each;
// "object" is read as "name", too (make-scene writes it). A "camera" beside "objects" is that of each without
// one. Empty where there are no "objects". Throws Error naming the entry.
std::vector<NamedSeeds> named_seeds_from_json(const nlohmann::json& seeds, const std::string& where);

// "camera" of seeds, a name or a number; none where they have none. Throws Error for anything else.
std::optional<std::string> camera_from_json(const nlohmann::json& seeds, const std::string& where);
// That camera of --cameras, with a picture as large as the reference's where --size is given. whose: what
// the seeds are, for an Error.
Camera camera_of_seeds(const std::string& camera, const std::string& whose, const ChosenCamera& chosen,
                       const CameraOptions& options);

struct CutObject {
  std::string name;  // empty: the only object of a cut, which was given no name
  CutRequest request;
  Camera camera;  // view of its pictures
  CutResult result;
  std::size_t found = 0;        // number of Gaussians before later objects took theirs
  std::string doubt_of_mask{};  // see RequestRemarks::doubt; or empty

  // What should be checked before the result is trusted, sentences.
  std::vector<std::string> doubts() const;
};

// Throws Error if the camera of an object is not known.
std::vector<CutObject> objects_of(const std::vector<NamedSeeds>& seeds, const ChosenCamera& chosen,
                                  const CameraOptions& camera);

// Sentence where what was said first has fewer meanings than the one asked for (CutRequest::choice); or
// empty.
std::string fewer_meanings(const CutResult& result, int asked);

// Throws Error for strokes outside of their camera's picture.
void check_inside(const CutRequest& request);

// Cuts each object and settles what several of them claim. Returns the owner of each Gaussian: 0 for the
// rest, 1 for the first object, and so on. Throws Error if an object is not found or left with nothing.
// Cancelled: the results are incomplete.
std::vector<std::uint8_t> cut_objects(std::vector<CutObject>* objects, Session* session,
                                      const CutSettings& settings, const Job& job);

}  // namespace splatcut
