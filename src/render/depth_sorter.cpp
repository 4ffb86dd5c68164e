#include "render/depth_sorter.h"

#include <bit>

#include "core/radix_sort.h"

namespace splatcut {

DepthOrder depth_order(std::shared_ptr<const GaussianCloud> cloud, const Camera& camera) {
  std::vector<KeyValue<std::uint32_t>> items, scratch;
  items.reserve(cloud->size());
  const glm::vec3 forward = camera.forward_world();
  const float offset = camera.camera_from_world_translation.z;
  for (std::uint32_t g = 0; g < cloud->size(); ++g) {
    const float z = glm::dot(forward, cloud->position[g]) + offset;
    if (z > 0)
      items.push_back({std::bit_cast<std::uint32_t>(z), g});  // positive floats order like their bits
  }
  scratch.resize(items.size());
  constexpr int kDigitBits = 11, kKeyBits = 32;
  radix_sort<kDigitBits>(std::span(items), std::span(scratch), 0, kKeyBits);
  DepthOrder order{std::move(cloud), std::vector<std::uint32_t>(items.size())};
  for (std::size_t i = 0; i < items.size(); ++i) order.back_to_front[i] = items[items.size() - 1 - i].value;
  return order;
}

DepthSorter::DepthSorter(std::function<void()> on_done)
    : on_done_(std::move(on_done)), thread_([this](const std::stop_token& stop) { run(stop); }) {}

void DepthSorter::request(std::shared_ptr<const GaussianCloud> cloud, const Camera& camera) {
  {
    const std::lock_guard lock(mutex_);
    wanted_ = Request{std::move(cloud), camera};
  }
  wake_.notify_one();
}

std::optional<DepthOrder> DepthSorter::take() {
  const std::lock_guard lock(mutex_);
  return std::exchange(done_, std::nullopt);
}

void DepthSorter::run(const std::stop_token& stop) {
  while (true) {
    std::optional<Request> request;
    {
      std::unique_lock lock(mutex_);
      if (!wake_.wait(lock, stop, [&] { return wanted_.has_value(); })) return;
      request = std::exchange(wanted_, std::nullopt);
    }
    try {
      DepthOrder order = depth_order(std::move(request->cloud), request->camera);
      const std::lock_guard lock(mutex_);
      done_ = std::move(order);
    } catch (const std::bad_alloc&) {  // the order before it stays, the next request tries again
      continue;
    }
    if (on_done_) on_done_();
  }
}

}  // namespace splatcut
