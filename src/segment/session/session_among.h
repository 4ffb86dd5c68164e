// A session on some of a scene's Gaussians, for requests that are cut among these alone. Included by the
// files of Session alone.
#pragma once

#include "segment/session/kept_neighbourhood.h"

namespace splatcut {

struct SessionAmong {
  // set: one byte a Gaussian of the scene's cloud, some of them not 0.
  SessionAmong(const SessionScene& scene, const SeenGaussians& set);

  // As the session on these numbers the Gaussians, and as the scene does.
  CutRequest here(CutRequest request);
  CameraStroke here(CameraStroke stroke);
  CutResult in_scene(CutResult result) const;
  OnSnapshot in_scene(const OnSnapshot& on_snapshot) const;
  template <class T>
  std::vector<T> in_scene(std::vector<T> values) const {
    return splatcut::in_scene(part, set->size(), std::move(values));
  }

  SeenGaussians set;
  Neighbourhood part;  // its rows and cloud alone
  Session session;
  SeenSets seen;
};

}  // namespace splatcut
