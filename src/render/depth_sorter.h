// Back-to-front order of a cloud for the latest camera asked for, on a thread of its own.
//
// Requests replace each other: only the newest is sorted. Order: descending camera z, later index first among
// equals, which is the CPU rasteriser's order from the back. Cost: a radix sort, about 20 ms a million.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include "scene/camera/camera.h"
#include "scene/cloud/gaussian_cloud.h"

namespace splatcut {

struct DepthOrder {
  std::shared_ptr<const GaussianCloud> cloud;  // what was sorted
  std::vector<std::uint32_t> back_to_front;    // indices of Gaussians with camera z > 0
};

// On the calling thread.
DepthOrder depth_order(std::shared_ptr<const GaussianCloud> cloud, const Camera& camera);

class DepthSorter {
 public:
  // on_done is called on the sorter's thread when a new order can be taken.
  explicit DepthSorter(std::function<void()> on_done = {});

  void request(std::shared_ptr<const GaussianCloud> cloud, const Camera& camera);
  std::optional<DepthOrder> take();  // the newest finished order, once

 private:
  struct Request {
    std::shared_ptr<const GaussianCloud> cloud;
    Camera camera;
  };
  void run(const std::stop_token& stop);

  std::function<void()> on_done_;
  std::mutex mutex_;
  std::condition_variable_any wake_;
  std::optional<Request> wanted_;
  std::optional<DepthOrder> done_;
  std::jthread thread_;  // last: stops before the rest goes
};

}  // namespace splatcut
