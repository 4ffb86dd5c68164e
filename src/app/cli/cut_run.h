// One cut, from options to a folder of files. `splatcut cut` does one in a scene of its own, `splatcut batch`
// many, of which those of one scene share what is loaded and prepared.
//
// The files depend on the options and on the files that these name, whatever was cut in the scene before. In
// report.json time, memory and the Gaussians that a cut passed over differ; `times` leaves them out.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "app/cli/cutout_files.h"
#include "app/cli/object_options.h"
#include "app/console/mask_options.h"
#include "app/console/scene_options.h"
#include "segment/session/session.h"

namespace splatcut {

// The options that say what is cut, how, and which files are written: the one list of them. Jobs of a batch
// have the same names.
struct CutArguments {
  std::filesystem::path scene;
  ObjectOptions object;
  CutoutOptions cutout;
  std::vector<std::string> set;
  std::string preset = "default";
  SceneOptions how;
  CameraOptions camera;
  MaskOptions masks;
  int scale = 0;
  std::optional<int> choice;  // 1: the likeliest meaning
  std::optional<float> smoothness;
  bool coarse = false;

  void add_to(CLI::App& command);  // which must not outlive this
  CutSettings settings() const;    // throws Error for a value that is none
  std::vector<std::filesystem::path> inputs() const;
  // Equal for options that ask for the same scene, seen by the same cameras: they may share a SharedScene.
  std::string scene_key() const;
};

// A loaded scene, and the session in it.
class SharedScene {
 public:
  // Throws Error for what is no scene. Cancelled: it must not be used.
  SharedScene(const CutArguments& args, PreparedCache cache, bool quiet, const Job& job);

  const std::string& key() const { return key_; }
  const Scene& scene() const { return *scene_; }
  double load_ms() const { return load_ms_; }
  // chosen: a camera by options of this key.
  Session& session(const ChosenCamera& chosen);

 private:
  std::string key_;
  std::shared_ptr<const Scene> scene_;
  PreparedCache cache_;
  std::optional<Session> session_;
  double load_ms_ = 0;
};

struct CutRunOptions {
  bool quiet = false;  // progress is not interrupted by what a folder of masks was understood as
  bool times = true;   // the report says what depends on earlier cuts, too
  std::function<void(const std::string& sentence)> warn;  // of all but doubts about the results
};

struct FinishedCut {
  nlohmann::json report;
  std::string summary;             // lines for the terminal
  std::vector<CutObject> objects;  // with their results
};

// Writes the files of a cut into `folder`, report.json among them; commit() is left to the caller. input: of
// args.object. Throws Error where nothing is found, or where it is cancelled.
FinishedCut run_cut_in(SharedScene* scene, const CutArguments& args, const ObjectInput& input,
                       const OutputFolder& folder, const CutRunOptions& options, const Job& job);

}  // namespace splatcut
