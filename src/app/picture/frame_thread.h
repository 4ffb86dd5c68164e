// Thread that draws the viewport, so that the window never waits for a picture.
//
// The latest request wins. A request for another view stops a full picture that is being drawn, but lets a
// reduced picture finish, so that something moves. A request that differs in style only is shaded again, not
// rasterised. Pictures have priority over the work of other threads. Reduced pictures use the coarse cloud if
// there is one.
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

// Limits of what is drawn.
struct DrawLimits {
  float near_plane = 0.2f, far_plane = 1e30f;  // range of camera z, scene units
  float low_pass_px2 = kLowPassPx2;            // variance that is added to every splat, square pixels
  bool operator==(const DrawLimits&) const = default;
};

// Flags of the Gaussians that are shown and not beyond the far plane; `shown` itself if there is no far
// plane.
Flags within_far_plane(const GaussianCloud& cloud, const Camera& camera, const Flags& shown, float far_plane);

// One pane of the viewport: the whole viewport, or one half of a side by side view.
struct PaneRequest {
  Camera camera;
  Flags shown;  // flags of the Gaussians to draw; null: all
  FrameStyle style;
  std::shared_ptr<const CleanObject> clean;  // to draw in place of the scene's rows; null: the rows
};

struct FrameRequest {
  std::uint64_t scene = 0;  // number that changes with the cloud
  std::shared_ptr<const GaussianCloud> cloud;
  std::shared_ptr<const CloudBlocks> blocks;  // blocks of the cloud
  std::shared_ptr<const CoarseCloud> coarse;  // cloud for reduced pictures; null: the cloud itself
  std::vector<PaneRequest> panes;             // one or two panes, left to right
  DrawLimits limits;
  bool full = true;  // true: full resolution, and another request may stop it; false: a reduced picture
};

struct FrameResult {
  std::uint64_t scene = 0;                           // FrameRequest::scene
  std::vector<std::shared_ptr<const Frame>> frames;  // one frame per pane
  // Per pane, of each pixel the number of the object that most of it is of; null: there are no objects.
  std::vector<std::shared_ptr<const Image<std::uint8_t>>> owners;
  std::vector<Image<Rgba8>> pictures;  // one picture per pane
  std::vector<Flags> shown;            // PaneRequest::shown of each pane
  bool full = true;
  double ms = 0;  // time of rasterising and shading
  DrawLimits limits;
};

class FrameThread {
 public:
  // wake: is called on the thread whenever a request is done or was stopped.
  explicit FrameThread(std::function<void()> wake = {});
  ~FrameThread();

  void request(FrameRequest request);
  std::optional<FrameResult> take();  // returns the newest finished picture once; none: there is no new one
  bool idle() const;                  // true: no request waits or runs, and the last picture was taken

 private:
  void run(const std::stop_token& stop);
  std::optional<FrameResult> draw(const FrameRequest& request, const std::stop_token& stop);

  std::function<void()> wake_;
  mutable std::mutex mutex_;
  std::condition_variable_any changed_;
  std::optional<FrameRequest> wanted_;
  std::optional<FrameResult> done_;
  std::optional<FrameRequest> drawing_;  // request that is being drawn
  std::stop_source drawing_stop_;
  // Number of the object of each Gaussian of what is drawn: of `owner`, and of what holds those Gaussians.
  struct Groups {
    std::vector<std::uint32_t> of;
    Flags owner;
    std::shared_ptr<const void> from;
  };
  // Frame that the drawing thread rasterised last for a pane. Only that thread uses it.
  struct Kept {
    std::uint64_t scene = 0;
    Flags shown;
    std::shared_ptr<const CleanObject> clean;
    DrawLimits limits;
    bool full = true;
    std::shared_ptr<const Frame> frame;
    Flags owner;  // what `owners` are of, FrameResult::owners
    std::shared_ptr<const Image<std::uint8_t>> owners;
    std::shared_ptr<const Groups> groups;  // shared by panes of the same; null: no objects are tinted
  };
  std::vector<Kept> kept_;
  struct Arena;  // TBB arena with a higher priority than other work
  std::unique_ptr<Arena> arena_;
  std::jthread thread_;  // last member: the thread ends before what it uses is destroyed
};

// Draws a frame on the calling thread and keeps nothing, for captures and tests. blocks: blocks of the cloud,
// or null. If cancelled, the frame is incomplete.
std::shared_ptr<const Frame> raster_frame(const GaussianCloud& cloud, const Camera& camera,
                                          const Flags& shown, const DrawLimits& limits, const Job& job = {},
                                          const CloudBlocks* blocks = nullptr);
// Draws a frame of a cloud that stands in for a scene. stands_for: per Gaussian of `cloud`, the index of
// the scene's Gaussian. `shown` and the frame's hits are of the scene's Gaussians.
std::shared_ptr<const Frame> stand_in_frame(const GaussianCloud& cloud,
                                            std::span<const std::uint32_t> stands_for, const Camera& camera,
                                            const Flags& shown, const DrawLimits& limits,
                                            const Job& job = {});

}  // namespace splatcut
