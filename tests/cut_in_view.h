// A cut in one go, for tests that ask once.
#pragma once

#include "segment/session/session.h"

namespace splatcut::testing {

inline CutResult cut_in_view(const GaussianCloud& cloud, const Camera& camera, const glm::vec3& up_world,
                             const Strokes& strokes, const CutSettings& settings) {
  const auto prepared = std::make_shared<const PreparedScene>(
      prepare_scene(cloud, camera, up_world, {}, prepare_options(settings)));
  Session session({{std::shared_ptr<void>(), &cloud}, prepared, up_world, {}});
  CutRequest request;
  request.strokes = {{camera, strokes}};
  return session.cut(request, settings);
}

}  // namespace splatcut::testing
