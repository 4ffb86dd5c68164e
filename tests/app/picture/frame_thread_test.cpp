// The thread that draws the viewport: the last request is answered, with the picture that the calling thread
// draws.
#include "app/picture/frame_thread.h"

#include <doctest/doctest.h>

#include <chrono>

#include "quick.h"
#include "synthetic_cloud.h"

using namespace splatcut;
using namespace splatcut::testing;

QUICK_CASE("frame thread", "frame thread: of many requests the last is answered, with the same picture") {
  const auto cloud = std::make_shared<const GaussianCloud>(random_cloud(2000, 7, 1));
  std::vector<std::uint8_t> every_third(cloud->size());
  for (std::size_t g = 0; g < every_third.size(); g += 3) every_third[g] = 1;
  const Flags shown = make_flags(std::move(every_third));
  FrameThread thread;
  Camera last;
  for (int i = 0; i < 40; ++i) {
    FrameRequest request;
    request.scene = 1;
    request.cloud = cloud;
    last = front_camera(90 + i, 70);
    request.panes = {{last, shown, {}}};
    request.full = i % 4 != 0;
    thread.request(request);
    if (i % 5 == 0) std::this_thread::sleep_for(std::chrono::milliseconds(3));
  }
  std::optional<FrameResult> newest;
  while (!thread.idle() || !newest) {
    if (std::optional<FrameResult> result = thread.take()) newest = std::move(result);
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  if (std::optional<FrameResult> result = thread.take()) newest = std::move(result);
  REQUIRE(newest->frames.size() == 1);
  const auto expected = raster_frame(*cloud, last, shown, {});
  CHECK(newest->full);
  CHECK(newest->frames[0]->first_hit == expected->first_hit);
  CHECK(newest->frames[0]->colour == expected->colour);
}
