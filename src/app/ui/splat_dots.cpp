#include "app/ui/splat_dots.h"

#include <algorithm>

#include "scene/raster/splat_math.h"

namespace splatcut {

std::vector<std::uint32_t> some_of(std::span<const std::uint8_t> flags, std::size_t most) {
  const auto count =
      static_cast<std::size_t>(std::ranges::count_if(flags, [](std::uint8_t f) { return f != 0; }));
  const std::size_t step = 1 + count / most;
  std::vector<std::uint32_t> some;
  for (std::size_t g = 0, counted = 0; g < flags.size(); ++g)
    if (flags[g] && counted++ % step == 0) some.push_back(static_cast<std::uint32_t>(g));
  return some;
}

void draw_dots(const GaussianCloud& cloud, std::span<const std::uint32_t> which, const Similarity& to,
               const Camera& camera, const UiRect& area) {
  constexpr float kLeast = 1.3f, kMost = 4, kFaint = 0.15f;
  struct Dot {
    glm::vec2 at;
    float depth, radius;
    ImU32 ink;
  };
  std::vector<Dot> dots;
  const float near_plane = to.scale * cloud.near_plane;
  for (const std::uint32_t g : which) {
    if (cloud.opacity[g] < kFaint) continue;
    const glm::vec3 seen = camera.camera_from_world(moved(cloud.position[g], to));
    if (!(seen.z > near_plane)) continue;
    const glm::vec2 at = camera.pixel_from_camera(seen);
    if (!area.contains(at)) continue;
    const glm::vec3& s = cloud.scale[g];
    const float radius = to.scale * std::max({s.x, s.y, s.z}) * camera.fx_px / seen.z;
    const glm::vec3 c = glm::clamp(0.5f + kShC0 * cloud.f_dc[g], 0.0f, 1.0f);
    dots.push_back(
        {at, seen.z, std::clamp(radius, kLeast, kMost), ImGui::ColorConvertFloat4ToU32({c.r, c.g, c.b, 1})});
  }
  std::ranges::stable_sort(dots, [](const Dot& a, const Dot& b) { return a.depth > b.depth; });
  ImDrawList& list = *ImGui::GetWindowDrawList();
  for (const Dot& dot : dots) {
    const ImVec2 from = {dot.at.x - dot.radius, dot.at.y - dot.radius},
                 end = {dot.at.x + dot.radius, dot.at.y + dot.radius};
    list.AddRectFilled(from, end, dot.ink, dot.radius);
  }
}

}  // namespace splatcut
