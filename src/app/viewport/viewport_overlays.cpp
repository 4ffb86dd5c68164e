// What of the scene itself is drawn over the picture: the ground's grid, centres and rings of Gaussians.
#include <algorithm>
#include <array>
#include <cmath>

#include "app/viewport/on_screen.h"
#include "app/viewport/viewport_pane.h"
#include "scene/raster/splat_math.h"

namespace splatcut {

namespace {

// The active object's Gaussians, where it has some that the pane may show; null: all.
Flags of_object(const Studio& studio) {
  const ObjectId chosen = studio.document().active;
  return studio.gaussians_of(chosen) > 0 && !hides_chosen(studio.view(), chosen)
             ? studio.viewport().active_labels()
             : nullptr;
}

// Of a unit circle, to be stretched; larger rings have more corners.
std::span<const glm::vec2> circle_for(float radius_px) {
  constexpr float kTurn = 6.2831853f;
  const auto corners = [](std::size_t count) {
    std::vector<glm::vec2> out;
    for (std::size_t i = 0; i < count; ++i) {
      const float angle = kTurn * static_cast<float>(i) / static_cast<float>(count);
      out.emplace_back(std::cos(angle), std::sin(angle));
    }
    return out;
  };
  static const std::array<std::vector<glm::vec2>, 4> kCircles = {corners(8), corners(14), corners(24),
                                                                 corners(48)};
  return kCircles[radius_px < 6 ? 0 : radius_px < 20 ? 1 : radius_px < 80 ? 2 : 3];
}

// The splat's own colour, lighter or darker, so that it stands out from a picture of it.
ImU32 ring_ink(const GaussianCloud& cloud, std::size_t g) {
  constexpr float kBright = 0.55f, kTowards = 0.55f, kOpacity = 0.8f;
  const glm::vec3 own = glm::clamp(0.5f + kShC0 * cloud.f_dc[g], 0.0f, 1.0f);
  const bool light = glm::dot(own, glm::vec3(0.299f, 0.587f, 0.114f)) > kBright;
  const glm::vec3 c = glm::mix(own, glm::vec3(light ? 0.0f : 1.0f), kTowards);
  return ImGui::ColorConvertFloat4ToU32({c.r, c.g, c.b, kOpacity});
}

void refresh_rings(RingsShown* shown, const Studio& studio, int pane) {
  const Camera camera = studio.viewport().pane_camera();
  const std::uint64_t scene = studio.scene()->serial;
  const Flags visible = studio.viewport().shown(pane), mine = of_object(studio);
  const bool same_who = shown->scene == scene && shown->shown == visible && shown->of_object == mine;
  if (same_who && shown->picture == studio.viewport().picture_serial() &&
      shown->moving == studio.viewport().moving() && shown->camera && same_camera(*shown->camera, camera))
    return;
  if (!same_who) shown->rings.begin(studio.scene()->cloud, visible, mine);
  shown->scene = scene;
  shown->shown = visible;
  shown->of_object = mine;
  shown->picture = studio.viewport().picture_serial();
  shown->moving = studio.viewport().moving();
  shown->camera = camera;
  constexpr std::size_t kMostMoving = 1500, kMostTriedMoving = 15000;  // a frame stays short
  RingOptions options{.limits = studio.viewport().draw_limits()};
  if (shown->moving) {
    options.most = kMostMoving;
    options.most_tried = kMostTriedMoving;
  }
  shown->in_view =
      shown->rings.in_view(camera, {studio.viewport().picture(), static_cast<std::size_t>(pane)}, options);
}

}  // namespace

void draw_rings(const UiContext& ui, const UiRect& area, int pane) {
  const Studio& studio = ui.studio;
  if (!studio.view().rings) return;
  RingsShown& shown = ui.state.rings[pane];
  refresh_rings(&shown, studio, pane);
  const OnScreen place = on_screen(ui, area);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  for (const Ring& ring : shown.in_view) {
    for (const glm::vec2& p : circle_for(glm::length(ring.long_px)))
      list.PathLineTo(place(ring.centre_px + p.x * ring.long_px + p.y * ring.short_px));
    list.PathStroke(ring_ink(*studio.scene()->cloud, ring.gaussian), ImDrawFlags_Closed, 1);
  }
}

namespace {

// Every n-th alone, so that a frame stays fast.
void refresh_centres(CentresShown* centres, const Studio& studio, int pane) {
  constexpr std::size_t kMost = 12000;
  const Flags shown = studio.viewport().shown(pane), mine = of_object(studio);
  const std::uint64_t scene = studio.scene()->serial;
  if (centres->scene == scene && centres->shown == shown && centres->of_object == mine) return;
  const std::size_t all = studio.scene()->cloud->size();
  const std::size_t step = 1 + (mine ? studio.gaussians_of(studio.document().active) : all) / kMost;
  *centres = {{}, scene, shown, mine};
  for (std::size_t g = 0, counted = 0; g < all; ++g)
    if ((!shown || (*shown)[g]) && (!mine || (*mine)[g]) && counted++ % step == 0)
      centres->gaussians.push_back(static_cast<std::uint32_t>(g));
}

}  // namespace

void draw_centres(const UiContext& ui, const UiRect& area, int pane) {
  const Studio& studio = ui.studio;
  if (!studio.view().centres) return;
  CentresShown& centres = ui.state.centres[pane];
  refresh_centres(&centres, studio, pane);
  const GaussianCloud& cloud = *studio.scene()->cloud;
  const Camera camera = studio.viewport().pane_camera();
  const OnScreen place = on_screen(ui, area);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  for (const std::uint32_t g : centres.gaussians) {
    const glm::vec3 seen = camera.camera_from_world(cloud.position[g]);
    if (!(seen.z > studio.viewport().draw_limits().near_plane)) continue;
    const ImVec2 at = place(camera.pixel_from_camera(seen));
    if (!area.contains({at.x, at.y})) continue;
    list.AddRectFilled({at.x - 1, at.y - 1}, {at.x + 1, at.y + 1}, IM_COL32(255, 255, 255, 200));
  }
}

void draw_ground_grid(const UiContext& ui, const UiRect& area, int pane) {
  const Studio& studio = ui.studio;
  if (!studio.view().grid) return;
  constexpr ImU32 kPlain = IM_COL32(235, 235, 235, 255), kShade = IM_COL32(0, 0, 0, 255);
  constexpr float kLine = 0.75f, kAxis = 0.95f;  // opacity at most
  GridShown& shown = ui.state.grid;
  const OpenedScene& scene = *studio.scene();
  if (shown.scene != scene.serial || shown.up_world != studio.document().up_world)
    shown = {ground_grid(*scene.cloud, scene.bounds, studio.document().up_world), scene.serial,
             studio.document().up_world};
  const PictureDepth depth(studio.viewport().picture(), static_cast<std::size_t>(pane));
  const Camera camera = studio.viewport().pane_camera();
  const OnScreen place = on_screen(ui, area);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  for (const GridPiece& piece :
       pieces_in_view(as_seen_by(shown.grid, camera), camera, studio.viewport().draw_limits(), depth)) {
    const float opacity = piece.opacity * (piece.axis ? kAxis : kLine);
    const auto faded = [&](ImU32 ink, float share) {
      return (ink & ~IM_COL32_A_MASK) | (static_cast<ImU32>(255 * opacity * share) << IM_COL32_A_SHIFT);
    };
    const ImVec2 from = place(piece.from_px), to = place(piece.to_px);
    list.AddLine(from, to, faded(kShade, 0.35f), 3);  // for light ground
    list.AddLine(from, to, faded(piece.axis ? kAxisInks[*piece.axis] : kPlain, 1), piece.axis ? 2.0f : 1.0f);
  }
}

void draw_ground_outline(const UiContext& ui, const UiRect& area,
                         const std::vector<std::pair<glm::vec3, glm::vec3>>& outline_world) {
  constexpr ImU32 kInk = IM_COL32(255, 120, 90, 255), kShade = IM_COL32(0, 0, 0, 110);
  const Camera camera = ui.studio.viewport().pane_camera();
  const float near_plane = ui.studio.viewport().draw_limits().near_plane;
  const OnScreen place = on_screen(ui, area);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  for (const auto& [ink, width] : {std::pair(kShade, 4.0f), std::pair(kInk, 2.0f)})
    for (const auto& [from, to] : outline_world) {
      const glm::vec3 a = camera.camera_from_world(from), b = camera.camera_from_world(to);
      if (a.z > near_plane && b.z > near_plane)
        list.AddLine(place(camera.pixel_from_camera(a)), place(camera.pixel_from_camera(b)), ink, width);
    }
}

}  // namespace splatcut
