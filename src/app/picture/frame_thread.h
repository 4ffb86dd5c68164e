// Draws the viewport on a thread of its own: the window never waits for a picture.
//
// The latest request wins. A request that asks for another view while a full picture is being drawn stops it;
// one for a reduced picture lets the reduced picture before it finish, so that something moves. Requests that
// differ in style only are shaded again, not rasterised. Pictures have priority over the work of other
// threads; reduced ones use the coarse cloud if there is one.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <thread>

#include "app/picture/frame_shading.h"
#include "scene/cloud/coarse_cloud.h"
#include "scene/cloud/gaussian_cloud.h"
#include "scene/raster/splat_math.h"
#include "segment/finish/clean.h"

namespace splatcut {

// What lies nearer or farther than this along the view axis is not drawn, scene units; nor is a splat drawn
// thinner than the low-pass.
struct DrawLimits {
  float near_plane = 0.2f, far_plane = 1e30f;
  float low_pass_px2 = kLowPassPx2;
  bool operator==(const DrawLimits&) const = default;
};

// The Gaussians that are shown and not beyond the far plane. `shown` itself where there is none.
Flags within_far_plane(const GaussianCloud& cloud, const Camera& camera, const Flags& shown, float far_plane);

// One pane of the viewport: the whole, or one half of side by side.
struct PaneRequest {
  Camera camera;
  Flags shown;  // 0 leaves the Gaussian out; null: all
  FrameStyle style;
  std::shared_ptr<const CleanObject> clean;  // drawn in place of the scene's rows; may be null
};

struct FrameRequest {
  std::uint64_t scene = 0;  // changes with the cloud
  std::shared_ptr<const GaussianCloud> cloud;
  std::shared_ptr<const CloudBlocks> blocks;  // of the cloud
  std::shared_ptr<const CoarseCloud> coarse;  // may be null: what reduced pictures are drawn of
  std::vector<PaneRequest> panes;             // 1 or 2, left to right
  DrawLimits limits;
  bool full = true;  // full resolution; may be stopped by the next request
};

struct FrameResult {
  std::uint64_t scene = 0;
  std::vector<std::shared_ptr<const Frame>> frames;  // per pane
  std::vector<Image<Rgba8>> pictures;
  bool full = true;
  double ms = 0;  // rasterising and shading
  DrawLimits limits;
};

class FrameThread {
 public:
  explicit FrameThread(std::function<void()> wake = {});
  ~FrameThread();

  void request(FrameRequest request);
  std::optional<FrameResult> take();  // the newest finished picture, once
  bool idle() const;

 private:
  void run(const std::stop_token& stop);
  std::optional<FrameResult> draw(const FrameRequest& request, const std::stop_token& stop);

  std::function<void()> wake_;
  mutable std::mutex mutex_;
  std::condition_variable_any changed_;
  std::optional<FrameRequest> wanted_;
  std::optional<FrameResult> done_;
  std::optional<FrameRequest> drawing_;  // what is being drawn
  std::stop_source drawing_stop_;
  // The drawing thread's own: what it rasterised last, per pane.
  struct Kept {
    std::uint64_t scene = 0;
    Flags shown;
    std::shared_ptr<const CleanObject> clean;
    DrawLimits limits;
    bool full = true;
    std::shared_ptr<const Frame> frame;
  };
  std::vector<Kept> kept_;
  struct Arena;  // of a higher priority than other work
  std::unique_ptr<Arena> arena_;
  std::jthread thread_;  // last: ends before the rest goes
};

// The same on the calling thread, without reuse: for captures and tests.
std::shared_ptr<const Frame> raster_frame(const GaussianCloud& cloud, const Camera& camera,
                                          const Flags& shown, const DrawLimits& limits, const Job& job = {},
                                          const CloudBlocks* blocks = nullptr);
// Of a cloud drawn in place of a scene. stands_for: per Gaussian of `cloud`, the scene's that `shown` and the
// frame's hits mean.
std::shared_ptr<const Frame> stand_in_frame(const GaussianCloud& cloud,
                                            std::span<const std::uint32_t> stands_for, const Camera& camera,
                                            const Flags& shown, const DrawLimits& limits,
                                            const Job& job = {});

}  // namespace splatcut
