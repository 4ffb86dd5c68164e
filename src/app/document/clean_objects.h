// A scene's objects with clean edges, each made once and kept until its labels change: what the window shows
// alone is what its exports write.
//
// Thread-safe; two threads that ask for the same object at the same time both make it. Memory: the Gaussians
// of the last few objects.
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <vector>

#include "app/document/opened_scene.h"
#include "segment/finish/clean.h"

namespace splatcut {

class CleanObjects {
 public:
  explicit CleanObjects(std::shared_ptr<const OpenedScene> scene) : scene_(std::move(scene)) {}

  // labels: per Gaussian of the scene, 1 = object. Null where it was not made yet.
  std::shared_ptr<const CleanObject> known(const std::vector<std::uint8_t>& labels,
                                           const glm::vec3& up_world) const;
  // Makes it where it is not known, as clean_object() has it. Null where it was cancelled.
  std::shared_ptr<const CleanObject> made(const std::vector<std::uint8_t>& labels, const glm::vec3& up_world,
                                          const Job& job);

 private:
  struct Kept {
    std::vector<std::uint8_t> labels;
    glm::vec3 up_world;
    std::shared_ptr<const CleanObject> object;
  };

  std::shared_ptr<const OpenedScene> scene_;
  mutable std::mutex mutex_;
  std::deque<Kept> kept_;  // the newest last
};

}  // namespace splatcut
