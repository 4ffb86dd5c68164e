// Image<T> seen as cv::Mat without a copy. For .cpp files of this layer only.
#pragma once

#include <opencv2/core.hpp>

#include "scene/image.h"

namespace splatcut {

inline cv::Mat as_mat(Image<std::uint8_t>& image) { return {image.height(), image.width(), CV_8UC1, image.data()}; }
inline cv::Mat as_mat(Image<float>& image) { return {image.height(), image.width(), CV_32FC1, image.data()}; }
inline cv::Mat as_mat(Image<Rgb8>& image) { return {image.height(), image.width(), CV_8UC3, image.data()}; }

// OpenCV takes no const data; it is not written to.
template <class T>
cv::Mat as_const_mat(const Image<T>& image) {
  return as_mat(const_cast<Image<T>&>(image));
}

inline cv::Rect as_rect(const PixelRect& r) { return {r.x0, r.y0, r.width(), r.height()}; }

}  // namespace splatcut
