#include "app/window/gpu_view.h"

#include <tbb/parallel_for.h>

#include <algorithm>

#include "core/error.h"

namespace splatcut {

namespace {

SplatStyle style_of(const FrameStyle& style, std::size_t g) {
  const auto bits =
      static_cast<std::uint8_t>(kShownBit | (style.highlight && (*style.highlight)[g] ? kHighlightedBit : 0));
  if (style.heat) {
    const glm::vec3 c = heat_colour((*style.heat)[g]) * 255.0f;
    return {static_cast<std::uint8_t>(c.r), static_cast<std::uint8_t>(c.g), static_cast<std::uint8_t>(c.b),
            static_cast<std::uint8_t>(bits | selection_bits(1))};
  }
  const std::uint8_t owner = style.owner ? (*style.owner)[g] : 0;
  if (owner == 0) return {0, 0, 0, bits};
  const Rgb8& c = style.owner_colour[owner];
  return {c[0], c[1], c[2], static_cast<std::uint8_t>(bits | selection_bits(owner))};
}

// OpenGL says only when asked that a copy had no room.
void refuse_full_memory() {
  constexpr int kMostFlags = 8;  // a context without a driver behind it has errors without end
  for (int i = 0; i < kMostFlags; ++i) {
    const GLenum error = glGetError();
    if (error == GL_OUT_OF_MEMORY) throw Error("OpenGL", "the graphics card's memory is full");
    if (error == GL_NO_ERROR) return;
  }
}

}  // namespace

void GpuView::Sorted::follow(const std::shared_ptr<const GaussianCloud>& wanted, const Camera& seen_by) {
  if (cloud != wanted) order.reset();
  if (cloud != wanted || !camera || !same_camera(*camera, seen_by)) {
    sorter.request(wanted, seen_by);
    cloud = wanted;
    camera = seen_by;
  }
  if (auto fresh = sorter.take(); fresh && fresh->cloud == wanted) {
    order = std::move(fresh);
    ++serial;
  }
}

void GpuView::Sorted::forget() {
  sorter.take();
  cloud.reset();
  order.reset();
}

// Each pane holds its cloud, which is as large as the scene, or is that of a scene before.
void GpuView::forget_unshown(const Studio& studio) {
  const int panes = studio.scene() ? studio.viewport().panes() : 0;
  const auto stands_in = [&](int i) { return studio.viewport().clean(i) != nullptr; };
  if (panes == 0 || (!stands_in(0) && !stands_in(1))) {
    clean_.reset();
    clean_order_.forget();
  }
  const auto of_scene = [&](const std::shared_ptr<const GaussianCloud>& cloud) {
    return panes > 0 && cloud == studio.scene()->cloud;
  };
  for (int i = 0; i < 2; ++i)
    if (panes_[i] && (i >= panes || (i == 1 && stands_in(i)) || !of_scene(panes_[i]->cloud)))
      panes_[i].reset();
  if (!of_scene(scene_order_.cloud)) scene_order_.forget();
}

void GpuView::refresh(Pane* pane, const std::shared_ptr<const GaussianCloud>& cloud, const Studio& studio,
                      int index) {
  if (pane->cloud != cloud) {
    const auto same = std::ranges::find_if(panes_, [&](const auto& p) { return p && p->cloud == cloud; });
    if (same != std::end(panes_)) {
      pane->splats.share((*same)->splats);
    } else {
      pane->splats.upload(*cloud);
      refuse_full_memory();
    }
    pane->cloud = cloud;
    pane->style = pane->order = 0;
  }
  if (pane->style == studio.viewport().style_serial()) return;
  pane->style = studio.viewport().style_serial();
  const FrameStyle style = studio.viewport().style(index);
  const Flags shown = studio.viewport().shown(index);
  const auto clean = studio.viewport().clean(index);
  std::vector<SplatStyle> styles(cloud->size());
  tbb::parallel_for(std::size_t{0}, styles.size(), [&](std::size_t i) {
    const std::size_t g = clean ? clean->gaussian[i] : i;
    if (g == kNoGaussian) {
      styles[i] = {0, 0, 0, kShownBit};
      return;
    }
    styles[i] = style_of(style, g);
    if (shown && !(*shown)[g]) styles[i][3] = 0;
  });
  pane->splats.upload_styles(styles);
}

std::array<GLuint, 2> GpuView::draw(const Studio& studio) {
  std::array<GLuint, 2> textures{};
  forget_unshown(studio);
  if (!studio.scene()) return textures;
  const Camera camera = studio.viewport().pane_camera();
  const DrawLimits limits = studio.viewport().draw_limits();
  for (int i = 0; i < studio.viewport().panes(); ++i) {
    const auto& clean = studio.viewport().clean(i);
    const std::shared_ptr<const GaussianCloud> cloud =
        clean ? std::shared_ptr<const GaussianCloud>(clean, &clean->cloud) : studio.scene()->cloud;
    Sorted& sorted = clean ? clean_order_ : scene_order_;
    sorted.follow(cloud, camera);
    if (!sorted.order) continue;
    std::unique_ptr<Pane>& pane = clean ? clean_ : panes_[i];
    if (!pane) pane = std::make_unique<Pane>();
    refresh(pane.get(), cloud, studio, i);
    GlSplats& splats = pane->splats;
    if (pane->order != sorted.serial) {
      splats.upload_order(sorted.order->back_to_front);
      pane->order = sorted.serial;
    }
    splats.draw(camera, {limits.near_plane, limits.far_plane, limits.low_pass_px2});
    const FrameStyle style = studio.viewport().style(i);
    splats.resolve({.background = style.background,
                    .checker_px = style.checker_px,
                    .tint_strength = style.heat   ? kHeatStrength
                                     : style.tint ? kTintStrength
                                                  : 0,
                    .tint_shaded = !style.heat,
                    .outline_strength = style.outline && !style.heat ? kOutlineStrength : 0,
                    .highlighted = style.highlight != nullptr,
                    .highlight_colour = glm::vec3(style.highlight_colour[0], style.highlight_colour[1],
                                                  style.highlight_colour[2]) /
                                        255.0f});
    textures[static_cast<std::size_t>(i)] = splats.picture_texture();
  }
  return textures;
}

}  // namespace splatcut
