#include "app/picture/frame_thread.h"

#include <tbb/task_arena.h>

#include <algorithm>
#include <chrono>

#include "core/parallel.h"
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

// A frame, and the heaviest of the groups in each of its pixels where groups are given.
struct Drawn {
  std::shared_ptr<Frame> frame;
  Image<std::uint32_t> group{};
};

Drawn drawn(const GaussianCloud& cloud, const Camera& camera, const Flags& visible, const DrawLimits& limits,
            const Job& job, const CloudBlocks* blocks, std::span<const std::uint32_t> groups) {
  const auto start = std::chrono::steady_clock::now();
  RasterOptions options;
  options.depth = true;
  options.groups = groups;
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
  return {std::move(frame), std::move(out.group)};
}

Drawn drawn_stand_in(const GaussianCloud& cloud, std::span<const std::uint32_t> stands_for,
                     const Camera& camera, const Flags& shown, const DrawLimits& limits, const Job& job,
                     std::span<const std::uint32_t> groups) {
  Drawn made = drawn(cloud, camera, own_flags(shown, stands_for), limits, job, nullptr, groups);
  for (std::int32_t& hit : made.frame->first_hit.pixels())
    if (hit >= 0) hit = static_cast<std::int32_t>(stands_for[static_cast<std::size_t>(hit)]);  // none: -1
  return made;
}

}  // namespace

std::shared_ptr<const Frame> raster_frame(const GaussianCloud& cloud, const Camera& camera,
                                          const Flags& shown, const DrawLimits& limits, const Job& job,
                                          const CloudBlocks* blocks) {
  return drawn(cloud, camera, shown, limits, job, blocks, {}).frame;
}

std::shared_ptr<const Frame> stand_in_frame(const GaussianCloud& cloud,
                                            std::span<const std::uint32_t> stands_for, const Camera& camera,
                                            const Flags& shown, const DrawLimits& limits, const Job& job) {
  return drawn_stand_in(cloud, stands_for, camera, shown, limits, job, {}).frame;
}

namespace {

// What a pane is drawn from.
struct Source {
  const GaussianCloud& cloud;
  std::span<const std::uint32_t> stands_for;  // empty: the scene's own rows
  const CloudBlocks* blocks;
  std::shared_ptr<const void> held;  // what holds it, by which it is known
};

Source source_of(const FrameRequest& request, const PaneRequest& pane, bool full) {
  if (pane.clean) return {pane.clean->cloud, pane.clean->gaussian, nullptr, pane.clean};
  if (request.coarse && !full)
    return {request.coarse->cloud, request.coarse->stands_for, nullptr, request.coarse};
  return {*request.cloud, {}, request.blocks.get(), request.cloud};
}

Drawn rastered(const Source& from, const FrameRequest& request, const PaneRequest& pane,
               std::span<const std::uint32_t> groups, const Job& job) {
  return from.stands_for.empty()
             ? drawn(from.cloud, pane.camera, pane.shown, request.limits, job, from.blocks, groups)
             : drawn_stand_in(from.cloud, from.stands_for, pane.camera, pane.shown, request.limits, job,
                              groups);
}

std::vector<std::uint32_t> groups_of(const Source& from, const std::vector<std::uint8_t>& owner) {
  std::vector<std::uint32_t> groups(from.cloud.size());
  for_each_index(groups.size(), [&](std::size_t i) {
    const std::size_t g = from.stands_for.empty() ? i : from.stands_for[i];
    groups[i] = g == kNoGaussian ? 0 : owner[g];
  });
  return groups;
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

// Of a frame that was drawn without them.
Image<std::uint32_t> groups_in(const PixelRect& box, const Source& from, const FrameRequest& request,
                               const PaneRequest& pane, std::span<const std::uint32_t> groups,
                               const Job& job) {
  const Flags shown = within_far_plane(
      from.cloud, pane.camera, from.stands_for.empty() ? pane.shown : own_flags(pane.shown, from.stands_for),
      request.limits.far_plane);
  RasterOptions options;
  options.colour = false;
  options.groups = groups;
  options.roi = box;
  options.near_plane = request.limits.near_plane;
  options.low_pass_px2 = request.limits.low_pass_px2;
  options.blocks = from.blocks;
  if (shown) options.shown = *shown;
  return rasterize(from.cloud, pane.camera, options, job).group;
}

// The object that most of each pixel is of, as masks have it: what shows is one Gaussian of a pixel, which
// may be a faint one of an object far away. drawn: the frame's groups; empty: they are drawn where objects
// show. Null: cancelled.
std::shared_ptr<const Image<std::uint8_t>> owners_in(const Frame& frame, Image<std::uint32_t> drawn,
                                                     const Source& from, const FrameRequest& request,
                                                     const PaneRequest& pane,
                                                     std::span<const std::uint32_t> groups, const Job& job) {
  auto owners = std::make_shared<Image<std::uint8_t>>(owners_of(frame, pane.style.owner));
  const PixelRect box = box_of(*owners);
  if (box.x0 >= box.x1) return owners;
  const bool whole = drawn.size() > 0;
  const glm::ivec2 corner = whole ? glm::ivec2(0) : glm::ivec2(box.x0, box.y0);
  if (!whole) drawn = groups_in(box, from, request, pane, groups, job);
  if (job.cancelled()) return nullptr;
  for (int y = box.y0; y < box.y1; ++y)
    for (int x = box.x0; x < box.x1; ++x) {
      const std::uint32_t group = drawn.at(x - corner.x, y - corner.y);
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
  const auto groups_for = [this](const Source& from, const Flags& owner) -> std::shared_ptr<const Groups> {
    for (const Kept& k : kept_)
      if (k.groups && k.groups->from == from.held && same_set(k.groups->owner, owner)) return k.groups;
    return std::make_shared<const Groups>(Groups{groups_of(from, *owner), owner, from.held});
  };
  FrameResult result{request.scene, {}, {}, {}, {}, request.full, 0, request.limits};
  for (std::size_t i = 0; i < request.panes.size(); ++i) {
    const PaneRequest& pane = request.panes[i];
    Kept& kept = kept_[i];
    const bool reusable = kept.frame && (kept.full || !request.full) && kept.scene == request.scene &&
                          kept.shown == pane.shown && kept.clean == pane.clean &&
                          kept.limits == request.limits && same_camera(kept.frame->camera, pane.camera);
    const Source from = source_of(request, pane, reusable ? kept.full : request.full);
    const Flags& owner = pane.style.owner;
    kept.groups = owner ? groups_for(from, owner) : nullptr;
    const std::span<const std::uint32_t> groups =
        kept.groups ? std::span(kept.groups->of) : std::span<const std::uint32_t>();
    Image<std::uint32_t> group;
    if (!reusable) {
      Drawn made = rastered(from, request, pane, groups, job);
      if (job.cancelled()) return std::nullopt;
      kept.scene = request.scene;
      kept.shown = pane.shown;
      kept.clean = pane.clean;
      kept.limits = request.limits;
      kept.full = request.full;
      kept.frame = std::move(made.frame);
      kept.owners = nullptr;
      group = std::move(made.group);
    }
    if (owner && (!kept.owners || !same_set(kept.owner, owner))) {
      kept.owners = owners_in(*kept.frame, std::move(group), from, request, pane, groups, job);
      if (job.cancelled()) return std::nullopt;
      kept.owner = owner;
    }
    result.frames.push_back(kept.frame);
    result.owners.push_back(owner ? kept.owners : nullptr);
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
