// The thread that draws the viewport: the last request is answered, with the picture that the calling thread
// draws.
#include "app/picture/frame_thread.h"

#include <doctest/doctest.h>

#include <array>
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

QUICK_CASE("frame thread",
           "frame thread: a pixel belongs to the object that most of it is of, not to what shows") {
  auto cloud = std::make_shared<GaussianCloud>(random_cloud(3, 7, 0));
  const Camera camera = front_camera(90, 70);
  const glm::vec3 ahead = camera.forward_world();
  for (std::size_t g = 0; g < 3; ++g) {
    cloud->position[g] = camera.centre_world() + (2 + static_cast<float>(g)) * ahead;
    cloud->scale[g] = glm::vec3(0.3f);
    cloud->opacity[g] = std::array{0.45f, 0.15f, 0.9f}[g];  // half of the light is gone in the second
  }
  // A reduced picture, of what stands for the scene's Gaussians, agrees with the full one.
  const auto coarse = std::make_shared<CoarseCloud>(CoarseCloud{*cloud, {0, 1, 2}});
  for (const bool full : {true, false})
    for (const std::vector<std::uint8_t>& owner : {std::vector<std::uint8_t>{0, 1, 0}, {2, 1, 2}}) {
      CAPTURE(full);
      FrameThread thread;
      FrameRequest request;
      request.scene = 1;
      request.cloud = cloud;
      request.coarse = coarse;
      request.full = full;
      request.panes = {{camera, nullptr, {}}};
      request.panes[0].style.owner = make_flags(owner);
      thread.request(request);
      std::optional<FrameResult> result;
      while (!(result = thread.take())) std::this_thread::sleep_for(std::chrono::milliseconds(1));
      REQUIRE(result->frames[0]->first_hit.at(45, 35) == 1);
      REQUIRE(result->owners[0]);
      CHECK(result->owners[0]->at(45, 35) == owner[0]);
    }
}
