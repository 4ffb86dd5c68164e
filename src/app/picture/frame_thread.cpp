#include "app/picture/frame_thread.h"

#include <tbb/task_arena.h>

#include <algorithm>
#include <chrono>

#include "core/stage_clock.h"
#include "scene/raster/rasterizer.h"

namespace splatcut {

namespace {

bool same_views(const FrameRequest& a, const FrameRequest& b) {
  if (a.scene != b.scene || a.panes.size() != b.panes.size() || a.limits != b.limits) return false;
  for (std::size_t i = 0; i < a.panes.size(); ++i)
    if (!same_camera(a.panes[i].camera, b.panes[i].camera) || a.panes[i].shown != b.panes[i].shown ||
        a.panes[i].clean != b.panes[i].clean)
      return false;
  return true;
}

}  // namespace

Flags within_far_plane(const GaussianCloud& cloud, const Camera& camera, const Flags& shown,
                       float far_plane) {
  if (far_plane >= DrawLimits{}.far_plane) return shown;
  std::vector<std::uint8_t> set(cloud.size());
  for (std::size_t g = 0; g < set.size(); ++g)
    set[g] = (!shown || (*shown)[g]) && camera.camera_from_world(cloud.position[g]).z <= far_plane;
  return make_flags(std::move(set));
}

namespace {

// Of Gaussians that stand for others, those that are shown or stand for none.
Flags own_flags(const Flags& shown, std::span<const std::uint32_t> stands_for) {
  if (!shown) return nullptr;
  std::vector<std::uint8_t> set;
  for (const std::uint32_t g : stands_for) set.push_back(g == kNoGaussian || (*shown)[g]);
  return make_flags(std::move(set));
}

std::shared_ptr<Frame> frame_of(const GaussianCloud& cloud, const Camera& camera, const Flags& visible,
                                const DrawLimits& limits, const Job& job,
                                const CloudBlocks* blocks = nullptr) {
  const auto start = std::chrono::steady_clock::now();
  RasterOptions options;
  options.depth = true;
  options.blocks = blocks;
  options.near_plane = limits.near_plane;
  options.low_pass_px2 = limits.low_pass_px2;
  const Flags shown = within_far_plane(cloud, camera, visible, limits.far_plane);
  if (shown) options.shown = *shown;
  RasterOutput out = rasterize(cloud, camera, options, job);
  auto frame = std::make_shared<Frame>();
  frame->camera = camera;
  frame->colour = std::move(out.colour);
  frame->alpha = std::move(out.alpha);
  frame->depth = std::move(out.median_depth);
  frame->first_hit = std::move(out.first_hit);
  frame->raster_ms = ms_since(start);
  return frame;
}

}  // namespace

std::shared_ptr<const Frame> raster_frame(const GaussianCloud& cloud, const Camera& camera,
                                          const Flags& shown, const DrawLimits& limits, const Job& job,
                                          const CloudBlocks* blocks) {
  return frame_of(cloud, camera, shown, limits, job, blocks);
}

std::shared_ptr<const Frame> stand_in_frame(const GaussianCloud& cloud,
                                            std::span<const std::uint32_t> stands_for, const Camera& camera,
                                            const Flags& shown, const DrawLimits& limits, const Job& job) {
  auto frame = frame_of(cloud, camera, own_flags(shown, stands_for), limits, job);
  for (std::int32_t& hit : frame->first_hit.pixels())
    if (hit >= 0) hit = static_cast<std::int32_t>(stands_for[static_cast<std::size_t>(hit)]);  // none: -1
  return frame;
}

namespace {

std::shared_ptr<const Frame> rastered(const FrameRequest& request, const PaneRequest& pane, const Job& job) {
  const auto stand_in = [&](const GaussianCloud& cloud, const std::vector<std::uint32_t>& stands_for) {
    return stand_in_frame(cloud, stands_for, pane.camera, pane.shown, request.limits, job);
  };
  if (pane.clean) return stand_in(pane.clean->cloud, pane.clean->gaussian);
  if (request.coarse && !request.full) return stand_in(request.coarse->cloud, request.coarse->stands_for);
  return raster_frame(*request.cloud, pane.camera, pane.shown, request.limits, job, request.blocks.get());
}

// Where any pixel has a number, and as far around as the shading looks.
PixelRect box_of(const Image<std::uint8_t>& owners) {
  PixelRect box{owners.width(), owners.height(), 0, 0};
  for (int y = 0; y < owners.height(); ++y)
    for (int x = 0; x < owners.width(); ++x)
      if (owners.at(x, y) != 0)
        box = {std::min(box.x0, x), std::min(box.y0, y), std::max(box.x1, x + 1), std::max(box.y1, y + 1)};
  constexpr int kAround = 2;
  return {std::max(0, box.x0 - kAround), std::max(0, box.y0 - kAround),
          std::min(owners.width(), box.x1 + kAround), std::min(owners.height(), box.y1 + kAround)};
}

// The object that most of each pixel is of, as masks have it: what shows is one Gaussian of a pixel, which
// may be a faint one of an object far away.
std::shared_ptr<const Image<std::uint8_t>> owners_in(const FrameRequest& request, const PaneRequest& pane,
                                                     const Frame& frame, const Job& job) {
  const std::vector<std::uint8_t>& owner = *pane.style.owner;
  auto owners = std::make_shared<Image<std::uint8_t>>(owners_of(frame, pane.style.owner));
  const PixelRect box = box_of(*owners);
  if (box.x0 >= box.x1) return owners;
  const GaussianCloud& cloud = pane.clean ? pane.clean->cloud : *request.cloud;
  std::vector<std::uint32_t> groups(cloud.size(), 0);
  for (std::size_t i = 0; i < groups.size(); ++i)
    if (const std::size_t g = pane.clean ? pane.clean->gaussian[i] : i; g != kNoGaussian)
      groups[i] = owner[g];
  const Flags shown = within_far_plane(cloud, pane.camera,
                                       pane.clean ? own_flags(pane.shown, pane.clean->gaussian) : pane.shown,
                                       request.limits.far_plane);
  RasterOptions options;
  options.colour = false;
  options.groups = groups;
  options.roi = box;
  options.near_plane = request.limits.near_plane;
  options.low_pass_px2 = request.limits.low_pass_px2;
  if (!pane.clean) options.blocks = request.blocks.get();
  if (shown) options.shown = *shown;
  const RasterOutput out = rasterize(cloud, pane.camera, options, job);
  if (job.cancelled()) return nullptr;
  for (int y = box.y0; y < box.y1; ++y)
    for (int x = box.x0; x < box.x1; ++x) {
      const std::uint32_t group = out.group.at(x - box.x0, y - box.y0);
      owners->at(x, y) = group == kNoGroup ? std::uint8_t{0} : static_cast<std::uint8_t>(group);
    }
  return owners;
}

}  // namespace

struct FrameThread::Arena {
  tbb::task_arena tasks{tbb::task_arena::automatic, 1, tbb::task_arena::priority::high};
};

FrameThread::FrameThread(std::function<void()> wake)
    : wake_(std::move(wake)),
      arena_(std::make_unique<Arena>()),
      thread_([this](const std::stop_token& stop) { run(stop); }) {}

FrameThread::~FrameThread() {
  {
    const std::lock_guard lock(mutex_);
    wanted_.reset();
    drawing_stop_.request_stop();
  }
  thread_.request_stop();
  thread_.join();
}

void FrameThread::request(FrameRequest request) {
  {
    const std::lock_guard lock(mutex_);
    const bool superseded = drawing_ && drawing_->full && !same_views(*drawing_, request);
    if (superseded) drawing_stop_.request_stop();
    wanted_ = std::move(request);
  }
  changed_.notify_one();
}

std::optional<FrameResult> FrameThread::take() {
  const std::lock_guard lock(mutex_);
  return std::exchange(done_, std::nullopt);
}

bool FrameThread::idle() const {
  const std::lock_guard lock(mutex_);
  return !wanted_ && !drawing_ && !done_;
}

std::optional<FrameResult> FrameThread::draw(const FrameRequest& request, const std::stop_token& stop) {
  const auto start = std::chrono::steady_clock::now();
  Job job;
  job.stop = stop;
  kept_.resize(request.panes.size());
  FrameResult result{request.scene, {}, {}, {}, {}, request.full, 0, request.limits};
  for (std::size_t i = 0; i < request.panes.size(); ++i) {
    const PaneRequest& pane = request.panes[i];
    Kept& kept = kept_[i];
    const bool reusable = kept.frame && (kept.full || !request.full) && kept.scene == request.scene &&
                          kept.shown == pane.shown && kept.clean == pane.clean &&
                          kept.limits == request.limits && same_camera(kept.frame->camera, pane.camera);
    if (!reusable) {
      auto frame = rastered(request, pane, job);
      if (job.cancelled()) return std::nullopt;
      kept = {request.scene, pane.shown,       pane.clean, request.limits,
              request.full,  std::move(frame), nullptr,    nullptr};
    }
    if (kept.full && pane.style.owner && (!kept.owners || !same_set(kept.owner, pane.style.owner))) {
      kept.owners = owners_in(request, pane, *kept.frame, job);
      if (job.cancelled()) return std::nullopt;
      kept.owner = pane.style.owner;
    }
    result.frames.push_back(kept.frame);
    result.owners.push_back(pane.style.owner ? kept.owners : nullptr);
    result.pictures.push_back(shaded(*kept.frame, pane.style, result.owners.back().get()));
    result.shown.push_back(pane.shown);
  }
  result.ms = ms_since(start);
  return result;
}

void FrameThread::run(const std::stop_token& stop) {
  while (true) {
    std::unique_lock lock(mutex_);
    if (!changed_.wait(lock, stop, [&] { return wanted_.has_value(); })) return;
    const FrameRequest request = *std::exchange(wanted_, std::nullopt);
    drawing_ = request;
    drawing_stop_ = std::stop_source();
    const std::stop_token token = drawing_stop_.get_token();
    lock.unlock();
    std::optional<FrameResult> result;
    try {
      result = arena_->tasks.execute([&] { return draw(request, token); });
    } catch (const std::exception&) {
      kept_.clear();  // out of memory: the picture before it stays, the next request tries again
    }
    lock.lock();
    drawing_.reset();
    if (result) done_ = std::move(result);
    lock.unlock();
    if (wake_) wake_();
  }
}

}  // namespace splatcut
