// An object as `splatcut cut` writes it: with clean edges where --edges asks for them and they can be had,
// else its rows as they are.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/job.h"
#include "scene/formats/scene_file.h"
#include "segment/finish/clean.h"

namespace CLI {
class App;
}

namespace splatcut {

struct EdgeOptions {
  std::string edges = "clean";

  void add_to(CLI::App& command);  // which must not outlive this
  bool clean() const { return edges == "clean"; }
};

// What is around the object: where it is looked at from while its edges are made clean.
struct Surroundings {
  glm::vec3 up_world{0, -1, 0};
  std::vector<Camera> cameras;  // of the capture
  const CloudBlocks& blocks;    // of the scene, which outlive the object
};

class CutoutObject {
 public:
  // scene and labels (per Gaussian, 1 = object) must outlive it. Cancelled: unspecified.
  CutoutObject(const Scene& scene, const std::vector<std::uint8_t>& labels, const EdgeOptions& options,
               const Surroundings& around, const Job& job);

  // .ply; rows are copied where edges are kept. Throws Error as save_scene() does.
  void save(const std::filesystem::path& path) const;
  void draw(const std::filesystem::path& path, const Camera& camera) const;

  // {"edges": "clean" or "keep", ...}: what was done, or why nothing.
  nlohmann::json report() const;
  std::size_t gaussians() const;  // written
  double ms() const { return ms_; }

 private:
  bool is_clean() const { return clean_ && clean_->report.cleaned; }

  const Scene& scene_;
  Drawer drawer_;  // of the scene
  const std::vector<std::uint8_t>& labels_;
  std::optional<CleanObject> clean_;
  double ms_ = 0;
};

}  // namespace splatcut
