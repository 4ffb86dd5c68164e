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
  explicit GpuView(const std::function<void()>& wake) : scene_order_(wake), clean_order_(wake) {}

  // Draws the studio's panes as they are now; a texture each, 0 where there is none yet.
  std::array<GLuint, 2> draw(const Studio& studio);

 private:
  struct Pane {
    GlSplats splats;
    std::shared_ptr<const GaussianCloud> cloud;
    std::uint64_t style = 0, order = 0;
  };
  // Of one cloud, the latest that was asked for.
  struct Sorted {
    explicit Sorted(const std::function<void()>& wake) : sorter(wake) {}
    void follow(const std::shared_ptr<const GaussianCloud>& wanted, const Camera& seen_by);
    void forget();

    DepthSorter sorter;
    std::shared_ptr<const GaussianCloud> cloud;
    std::optional<Camera> camera;
    std::optional<DepthOrder> order;
    std::uint64_t serial = 0;  // of the order
  };
  void forget_unshown(const Studio& studio);
  void refresh(Pane* pane, const std::shared_ptr<const GaussianCloud>& cloud, const Studio& studio,
               int index);

  std::unique_ptr<Pane> panes_[2];  // of the scene, the second for side by side
  std::unique_ptr<Pane> clean_;     // the pane that shows an object with clean edges
  Sorted scene_order_, clean_order_;
};

}  // namespace splatcut
