// A pair of hands in the window with a scene open, as an artist has them.
#pragma once

#include <doctest/doctest.h>

#include "headless_app.h"

namespace splatcut::testing {

inline constexpr int kHandsWidth = 900, kHandsHeight = 520;

class Hands {
 public:
  explicit Hands(bool cut = true, ApplicationOptions options = with_kept_scenes(),
                 const std::filesystem::path& scene = kSmallSample)
      : app(kHandsWidth, kHandsHeight, 1, std::move(options)) {
    app.interface_state().hint_wanted = false;
    app.open(scene);
    REQUIRE(app.settle());
    if (!cut) return;
    app.click(app.screen_of(kOnApple));
    REQUIRE(app.settle());
  }
  Studio& studio() { return app.studio(); }
  std::string said() { return studio().messages().empty() ? "" : studio().messages().back().text; }
  std::size_t steps() {
    REQUIRE(app.settle());
    return studio().history().cursor();
  }
  std::size_t selected() {
    REQUIRE(app.settle());
    return studio().gaussians_of(studio().document().active);
  }
  glm::vec2 in_viewport(const glm::vec2& screen) { return screen - app->interface().viewport().min; }
  glm::vec3 under(const glm::vec2& screen) {
    const auto hit = studio().viewport().pick(in_viewport(screen));
    REQUIRE(hit);
    return hit->position_world;
  }
  glm::vec2 seen_at(const glm::vec3& world) {
    const Camera camera = studio().viewport().pane_camera();
    return app->interface().viewport().min + camera.pixel_from_camera(camera.camera_from_world(world));
  }
  HeadlessApp app;
};

// For what is told by which Gaussians are taken: the sample as it is shipped.
inline Hands hands_on_sample(bool cut = true) {
  return Hands(cut, with_kept_scenes(), kSample);
}

}  // namespace splatcut::testing
