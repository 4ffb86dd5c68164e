// A cut in one go, for tests that ask once.
#pragma once

#include "segment/session/session.h"

namespace splatcut::testing {

inline CutResult cut_in_view(const GaussianCloud& cloud, const Camera& camera, const glm::vec3& up_world,
                             const Strokes& strokes, const CutSettings& settings) {
  Session session({.cloud = {std::shared_ptr<void>(), &cloud}, .up_world = up_world});
  CutRequest request;
  request.strokes = {{camera, strokes}};
  return session.cut(request, settings);
}

}  // namespace splatcut::testing
