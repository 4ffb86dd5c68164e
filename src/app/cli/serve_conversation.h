// What `splatcut serve` holds between requests: a scene, a camera, settings, and the steps of one object.
//
// The object is that of `cut` with the same options, and of its steps alone: the same bits, whatever was
// asked before. One call at a time.
#pragma once

#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "app/cli/cut_run.h"
#include "app/cli/serve_requests.h"

namespace splatcut {

class Conversation {
 public:
  explicit Conversation(PreparedCache cache = {}) : cache_(std::move(cache)) {}

  // The fields of the reply. Throws Error where the request cannot be done, is none or was cancelled; all is
  // then as before it, but that no scene is open after an `open` that failed.
  nlohmann::json answer(const nlohmann::json& request, const Job& job);

  bool ended() const { return ended_; }  // by quit

 private:
  struct Opened {
    nlohmann::json said;  // options of cut, by name
    CutArguments args;    // read of them
    SharedScene scene;
    ChosenCamera chosen;
    CutSettings settings;
    Drawer drawer();
  };
  // One step: a stroke, another choice of the first one, or another size of the last one.
  struct Step {
    std::optional<StrokedView> stroke{};
    std::optional<int> choice{}, size{};
  };

  nlohmann::json open(const nlohmann::json& request, const Job& job);
  nlohmann::json look(const RequestKind& kind, const nlohmann::json& request);
  nlohmann::json set(const RequestKind& kind, const nlohmann::json& request, const Job& job);
  nlohmann::json stroke(const Strokes& strokes, const Job& job);
  nlohmann::json step(Step step, const Job& job);
  nlohmann::json undo(const Job& job);
  nlohmann::json preview(const nlohmann::json& request, const Job& job);
  nlohmann::json labels(const nlohmann::json& request);
  nlohmann::json save(const nlohmann::json& request, const Job& job);

  Opened& opened();
  const CutResult& object() const;
  CutRequest request_of(const std::vector<Step>& steps) const;
  void cut(std::vector<Step> steps, const CutSettings& settings, const Job& job);
  nlohmann::json object_json() const;
  nlohmann::json camera_json();
  void check_output(const std::filesystem::path& path, const nlohmann::json& request);

  PreparedCache cache_;
  std::unique_ptr<Opened> opened_;
  std::vector<Step> steps_;
  std::optional<CutResult> result_;  // of the steps
  bool ended_ = false;
};

}  // namespace splatcut
