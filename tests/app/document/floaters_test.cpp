// What floats apart from a selection: by how far the splats lie apart, not their centres.
#include <doctest/doctest.h>

#include "app/document/scene_graph.h"
#include "app/document/selection.h"
#include "synthetic_cloud.h"

using namespace splatcut;
using namespace splatcut::testing;

TEST_CASE("floaters: large splats that reach what is selected are none, a speck apart from it is one") {
  constexpr int kSide = 30;
  constexpr float kSpacing = 0.1f;
  const std::size_t plate = kSide * kSide, large = 3, speck = 3, n = plate + large + speck;
  auto cloud = std::make_shared<GaussianCloud>(random_cloud(n, 1));
  const auto put = [&](std::size_t g, const glm::vec3& at, const glm::vec3& deviations) {
    cloud->position[g] = at;
    cloud->scale[g] = deviations;
    cloud->rotation[g] = glm::quat(1, 0, 0, 0);
  };
  for (std::size_t g = 0; g < plate; ++g)
    put(g, kSpacing * glm::vec3(g % kSide, g / kSide, 0), glm::vec3(0.5f * kSpacing));
  // Beside the plate: wide along x, and seven and a half spacings from it and from each other.
  for (std::size_t i = 0; i < large; ++i)
    put(plate + i, kSpacing * glm::vec3(kSide - 1 + 7.5f * static_cast<float>(i + 1), 15, 0),
        kSpacing * glm::vec3(3, 1, 0.1f));
  for (std::size_t i = 0; i < speck; ++i)
    put(plate + large + i, kSpacing * glm::vec3(15, 15, 20 + static_cast<float>(i)),
        glm::vec3(0.5f * kSpacing));
  SceneGraph graph(cloud);
  const Selection found = floaters(*cloud, graph.get(), Selection(n, 1));
  for (std::size_t g = 0; g < n; ++g) CHECK_MESSAGE(found[g] == (g >= plate + large), g);
}
