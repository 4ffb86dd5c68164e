#include "app/ui/gpu_view.h"

namespace splatcut {

namespace {

SplatStyle style_of(const FrameStyle& style, std::size_t g) {
  if (style.heat) {
    const glm::vec3 c = heat_colour((*style.heat)[g]) * 255.0f;
    return {static_cast<std::uint8_t>(c.r), static_cast<std::uint8_t>(c.g), static_cast<std::uint8_t>(c.b),
            255};
  }
  if (style.highlight && (*style.highlight)[g]) return {255, 255, 255, 255};
  const std::uint8_t owner = style.owner ? (*style.owner)[g] : 0;
  if (owner == 0) return {0, 0, 0, 255};
  const Rgb8& c = style.owner_colour[owner];
  return {c[0], c[1], c[2], 255};
}

}  // namespace

void GpuView::refresh(Pane* pane, const Studio& studio, int index) {
  const GaussianCloud& cloud = *studio.scene()->cloud;
  if (pane->scene != studio.scene()->serial) {
    pane->splats.upload(cloud);
    pane->scene = studio.scene()->serial;
    pane->style = 0;
  }
  if (pane->style == studio.viewport().style_serial()) return;
  pane->style = studio.viewport().style_serial();
  const FrameStyle style = studio.viewport().style(index);
  const Flags shown = studio.viewport().shown(index);
  std::vector<SplatStyle> styles(cloud.size());
  for (std::size_t g = 0; g < styles.size(); ++g) {
    styles[g] = style_of(style, g);
    if (shown && !(*shown)[g]) styles[g][3] = 0;
  }
  pane->splats.upload_styles(styles);
}

std::array<GLuint, 2> GpuView::draw(const Studio& studio) {
  std::array<GLuint, 2> textures{};
  if (!studio.scene()) return textures;
  const Camera camera = studio.viewport().pane_camera();
  const bool other_scene = sorted_scene_ != studio.scene()->serial;
  if (other_scene) order_.reset();
  if (other_scene || !sorted_camera_ || !same_camera(*sorted_camera_, camera)) {
    sorter_.request(studio.scene()->cloud, camera);
    sorted_scene_ = studio.scene()->serial;
    sorted_camera_ = camera;
  }
  if (auto order = sorter_.take(); order && order->cloud == studio.scene()->cloud) {
    order_ = std::move(order);
    ++order_serial_;
  }
  if (!order_) return textures;
  const DrawLimits limits = studio.viewport().draw_limits();
  for (int i = 0; i < studio.viewport().panes(); ++i) {
    if (!panes_[i]) panes_[i] = std::make_unique<Pane>();
    refresh(panes_[i].get(), studio, i);
    GlSplats& splats = panes_[i]->splats;
    if (uploaded_order_[i] != order_serial_) {
      splats.upload_order(order_->back_to_front);
      uploaded_order_[i] = order_serial_;
    }
    splats.draw(camera, {limits.near_plane, limits.far_plane, limits.low_pass_px2});
    const FrameStyle style = studio.viewport().style(i);
    splats.resolve({.background = style.background,
                    .checker_px = style.checker_px,
                    .tint_strength = style.heat   ? kHeatStrength
                                     : style.tint ? kTintStrength
                                                  : 0,
                    .tint_shaded = !style.heat,
                    .outline_strength = style.outline && !style.heat ? kOutlineStrength : 0});
    textures[static_cast<std::size_t>(i)] = splats.picture_texture();
  }
  return textures;
}

}  // namespace splatcut
