// The part of the command line that says which object is meant: clicks, boxes, a file of them, masks of other
// tools, words.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/cli/cut_objects.h"
#include "app/cli/segmenter.h"
#include "app/console/camera_options.h"
#include "segment/masks/seeds.h"
#include "segment/session/cut_request.h"

namespace CLI {
class App;
}

namespace splatcut {

// The request of the command line, parsed and checked as far as possible without the scene.
struct ObjectInput {
  Strokes strokes;
  int choice = 0;                     // of the first click's meanings
  std::optional<std::string> camera;  // of --seeds: the reference
  std::vector<NamedSeeds> objects;    // several, each with strokes of its own
  std::filesystem::path mask, masks_folder;
  std::optional<Segmenter> segmenter;
};

struct ObjectOptions {
  std::filesystem::path seeds, mask, masks_folder;
  std::vector<std::string> clicks, boxes;
  std::string text, segmenter;
  bool by_text = false;

  // Clicks, boxes and a file of them add up, the others stand alone. The command must not outlive this.
  void add_to(CLI::App& command);
  // Throws Error if the request names no object or is incomplete.
  ObjectInput read(const CameraOptions& camera) const;
};

// Sentences on a request.
struct RequestRemarks {
  std::string understood;             // how the masks of a folder were, or empty
  std::vector<std::string> warnings;  // on what was left out or contradicts itself
  std::string doubt;                  // of the result, for what was given; or empty
};

// The request for one object. With a folder of masks the reference may become another camera. Throws Error
// for masks that cannot be used. Cancelled: incomplete.
CutRequest request_of(const ObjectInput& input, const CameraOptions& camera, const GaussianCloud& cloud,
                      const Job& job, ChosenCamera* chosen, RequestRemarks* remarks);

}  // namespace splatcut
