// The nearest view's mask along the optical flow of the two pictures; kLift is measured against it.
// Source: Kroeger et al., Fast optical flow using dense inverse search, 2016 (OpenCV's DISOpticalFlow).
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>

#include "segment/masks/cv_image.h"
#include "segment/masks/propagate.h"

namespace splatcut {

namespace {

// DISOpticalFlow searches in one stripe per thread, and its result depends on the stripes: hence one thread.
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

constinit const Propagator Propagator::kFlow = {
    .name = "dis",
    .sentence = "along optical flow",
    .of_pictures = true,
    .mask = [](const OpenView& view) { return warped_by_flow(nearest(view), view.picture); },
};

}  // namespace splatcut
