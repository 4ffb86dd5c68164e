// Cache of a scene's objects with clean edges. The window and its exports share it, so that an export writes
// what the window shows.
//
// Thread-safe; two threads that ask for the same object at the same time both compute it. Memory: labels and
// Gaussians of the last few objects, and labels of those that are cleaned anyway.
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <vector>

#include "app/document/opened_scene.h"
#include "segment/finish/clean.h"
#include "segment/finish/fill.h"

namespace splatcut {

class CleanObjects {
 public:
  explicit CleanObjects(std::shared_ptr<const OpenedScene> scene) : scene_(std::move(scene)) {}

  // Returns the cached object for these labels (one per Gaussian of the scene, 1 = object) and this up
  // direction; null if it is not cached.
  std::shared_ptr<const CleanObject> known(const std::vector<std::uint8_t>& labels,
                                           const glm::vec3& up_world) const;
  // Returns the cached object, or computes it with clean_object() and keeps it; null if cancelled.
  std::shared_ptr<const CleanObject> made(const std::vector<std::uint8_t>& labels, const glm::vec3& up_world,
                                          const Job& job);
  // From now on the object with these labels is cleaned even where the guard says no (clean.h).
  void clean_anyway(const std::vector<std::uint8_t>& labels);
  bool is_cleaned_anyway(const std::vector<std::uint8_t>& labels) const;

  // Computes what the rest of the scene loses and gets back without the object; nothing is kept.
  RestChanges rest_without(const std::vector<std::uint8_t>& labels, const glm::vec3& up_world,
                           const Job& job) const;

  // The hole that the object leaves in the rest so changed; nothing is kept.
  SurfacePatch hole_of(const std::vector<std::uint8_t>& labels, const RestChanges& changes,
                       const glm::vec3& up_world, const Job& job) const;

 private:
  bool anyway(const std::vector<std::uint8_t>& labels) const;  // under mutex_
  CleanObject computed(const std::vector<std::uint8_t>& labels, const glm::vec3& up_world, bool rest,
                       bool anyway, const Job& job) const;

  struct Kept {
    std::vector<std::uint8_t> labels;
    glm::vec3 up_world;
    bool anyway;
    std::shared_ptr<const CleanObject> object;
  };

  std::shared_ptr<const OpenedScene> scene_;
  mutable std::mutex mutex_;
  std::deque<Kept> kept_;                          // cached objects, the newest last
  std::vector<std::vector<std::uint8_t>> anyway_;  // labels of those that are cleaned anyway
};

}  // namespace splatcut
