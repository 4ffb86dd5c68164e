// Cache of a scene's objects with clean edges, and of what the scene is without one. The window and its
// exports share it, so that an export writes what the window shows.
//
// Thread-safe; two threads that ask for the same object at the same time both compute it. Memory: labels and
// Gaussians of the last few objects, and what the last two objects change by leaving. Each array of labels is
// compared with the kept ones once, from then on by its address: asking in every frame costs nothing.
#pragma once

#include <deque>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include "app/document/document.h"
#include "app/document/opened_scene.h"
#include "app/document/view_state.h"
#include "segment/finish/clean.h"
#include "segment/finish/fill.h"

namespace splatcut {

// Which object leaves the scene, and how.
struct Leaving {
  Flags labels;   // of the object
  Flags deleted;  // Gaussians that are no part of the scene any more; null: none
  glm::vec3 up_world{0};
  bool clean_edges = false, fill_hole = false;
  bool operator==(const Leaving&) const = default;
};

// As the view shows it, and as it is exported.
inline Leaving leaving_of(const Document& document, const Flags& labels, const ViewState& view) {
  return {labels, document.deleted, document.up_world, view.clean_edges, view.fill_hole};
}

// What a scene loses and gets with an object that leaves it.
struct SceneWithout {
  CleanReport edges;    // of the object; as made where its edges are not cleaned
  RestChanges changes;  // by clean edges
  SurfacePatch patch;   // what fills the hole, if that is asked for
};

class CleanObjects {
 public:
  explicit CleanObjects(std::shared_ptr<const OpenedScene> scene) : scene_(std::move(scene)) {}

  // Returns the cached object for these labels (one per Gaussian of the scene, 1 = object) and this up
  // direction; null if it is not cached.
  std::shared_ptr<const CleanObject> known(const Flags& labels, const glm::vec3& up_world) const;
  // Returns the cached object, or computes it with clean_object() and keeps it; null if cancelled.
  std::shared_ptr<const CleanObject> made(const Flags& labels, const glm::vec3& up_world, const Job& job);
  // The same of the scene without an object.
  std::shared_ptr<const SceneWithout> known_without(const Leaving& leaving) const;
  std::shared_ptr<const SceneWithout> made_without(const Leaving& leaving, const Job& job);

 private:
  Flags first(const Flags& labels) const;  // of equal arrays the one that stands for all; under mutex_
  SurfacePatch hole_of(const Leaving& leaving, const RestChanges& changes, const Job& job) const;
  CleanObject computed(const Flags& labels, const glm::vec3& up_world, bool rest, const Job& job) const;

  struct Kept {
    Flags labels;  // first()
    glm::vec3 up_world;
    std::shared_ptr<const CleanObject> object;
  };

  struct KeptWithout {
    Leaving leaving;  // its labels: first()
    std::shared_ptr<const SceneWithout> without;
  };

  std::shared_ptr<const OpenedScene> scene_;
  mutable std::mutex mutex_;
  std::deque<Kept> kept_;                 // cached objects, the newest last
  std::deque<KeptWithout> kept_without_;  // the same
  using Known = std::weak_ptr<Flags::element_type>;
  mutable std::deque<std::pair<Known, Known>> asked_;  // arrays asked for last, and first() of each
};

}  // namespace splatcut
