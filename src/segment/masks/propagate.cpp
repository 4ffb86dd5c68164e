#include "segment/masks/propagate.h"

#include <cmath>
#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>

#include "segment/masks/cv_image.h"

namespace splatcut {

namespace {

// DISOpticalFlow hands its search from row to row inside a stripe, one stripe a thread: one thread, one
// result.
class OneOpenCvThread {
 public:
  OneOpenCvThread() : before_(cv::getNumThreads()) { cv::setNumThreads(1); }
  ~OneOpenCvThread() { cv::setNumThreads(before_); }
  OneOpenCvThread(const OneOpenCvThread&) = delete;
  OneOpenCvThread& operator=(const OneOpenCvThread&) = delete;

 private:
  int before_;
};

cv::Mat grey(const Image<Rgb8>& picture) {
  cv::Mat out;
  cv::cvtColor(as_const_mat(picture), out, cv::COLOR_RGB2GRAY);
  return out;
}

}  // namespace

Mask warped_by_depth(const SeenView& from, const Camera& to, const Image<float>& to_depth, float tolerance) {
  Mask mask(to.width_px, to.height_px);
  for (int y = 0; y < mask.height(); ++y)
    for (int x = 0; x < mask.width(); ++x) {
      const float z = to_depth.at(x, y);
      if (z <= 0) continue;
      const glm::vec3 there = from.camera.camera_from_world(to.world_from_pixel(glm::vec2(x, y) + 0.5f, z));
      if (there.z <= 0) continue;
      const glm::vec2 pixel = glm::floor(from.camera.pixel_from_camera(there));
      if (!(pixel.x >= 0 && pixel.y >= 0 && pixel.x < 32768 && pixel.y < 32768)) continue;
      const int u = static_cast<int>(pixel.x), v = static_cast<int>(pixel.y);
      if (!from.mask.contains(u, v)) continue;
      if (std::abs(from.depth.at(u, v) - there.z) <= tolerance * there.z) mask.at(x, y) = from.mask.at(u, v);
    }
  return mask;
}

Mask warped_by_flow(const SeenView& from, const Image<Rgb8>& to_picture) {
  const OneOpenCvThread one_thread;
  cv::Mat flow;  // from a pixel of `to` to its place in `from`
  cv::DISOpticalFlow::create(cv::DISOpticalFlow::PRESET_MEDIUM)
      ->calc(grey(to_picture), grey(from.picture), flow);
  Mask mask(from.mask.width(), from.mask.height());
  for (int y = 0; y < mask.height(); ++y)
    for (int x = 0; x < mask.width(); ++x) {
      const auto& move = flow.at<cv::Vec2f>(y, x);
      const int u = static_cast<int>(std::lround(static_cast<float>(x) + move[0])),
                v = static_cast<int>(std::lround(static_cast<float>(y) + move[1]));
      if (from.mask.contains(u, v)) mask.at(x, y) = from.mask.at(u, v);
    }
  return mask;
}

}  // namespace splatcut
