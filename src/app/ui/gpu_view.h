// The viewport drawn by OpenGL: for real GPUs. Order of the splats from a sorter thread. Main thread only.
#pragma once

#include <array>
#include <functional>
#include <memory>

#include "app/studio/studio.h"
#include "render/depth_sorter.h"
#include "render/gl_splats.h"

namespace splatcut {

class GpuView {
 public:
  explicit GpuView(std::function<void()> wake) : sorter_(std::move(wake)) {}

  // Draws the studio's panes as they are now; a texture each, 0 where there is none yet.
  std::array<GLuint, 2> draw(const Studio& studio);

 private:
  struct Pane {
    GlSplats splats;
    std::uint64_t scene = 0, style = 0;
  };
  void refresh(Pane* pane, const Studio& studio, int index);

  DepthSorter sorter_;
  std::unique_ptr<Pane> panes_[2];  // the second for side by side
  std::uint64_t sorted_scene_ = 0;
  std::optional<Camera> sorted_camera_;
  std::optional<DepthOrder> order_;
  std::uint64_t order_serial_ = 0;
  std::uint64_t uploaded_order_[2] = {0, 0};
};

}  // namespace splatcut
