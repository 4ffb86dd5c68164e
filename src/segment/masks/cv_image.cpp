#include "segment/masks/cv_image.h"

#include <opencv2/imgproc.hpp>

namespace splatcut {

cv::Mat lab_of(const cv::Mat& rgb) {
  cv::Mat scaled_rgb, lab;
  rgb.convertTo(scaled_rgb, CV_32FC3, 1.0 / 255);
  cv::cvtColor(scaled_rgb, lab, cv::COLOR_RGB2Lab);
  return lab;
}

void make_lab_ready() {
  lab_of(cv::Mat(1, 1, CV_8UC3, cv::Scalar::all(0)));
}

}  // namespace splatcut
