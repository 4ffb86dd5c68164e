// Image<T> seen as cv::Mat without a copy, and in Lab. For .cpp files of this layer only.
#pragma once

#include <opencv2/core.hpp>

#include "core/image.h"

namespace splatcut {

inline cv::Mat as_mat(Image<std::uint8_t>& image) {
  return {image.height(), image.width(), CV_8UC1, image.data()};
}
inline cv::Mat as_mat(Image<float>& image) {
  return {image.height(), image.width(), CV_32FC1, image.data()};
}
inline cv::Mat as_mat(Image<Rgb8>& image) {
  return {image.height(), image.width(), CV_8UC3, image.data()};
}

// OpenCV takes no const data; it is not written to.
template <class T>
cv::Mat as_const_mat(const Image<T>& image) {
  return as_mat(const_cast<Image<T>&>(image));
}

inline cv::Rect as_rect(const PixelRect& r) {
  return {r.x0, r.y0, r.width(), r.height()};
}

// CIE Lab of 8 bits a channel of sRGB, of their size, three floats: L 0 to 100, a and b about -128 to 128.
cv::Mat lab_of(const cv::Mat& rgb);

// Has OpenCV build its tables, a tenth of a second once per program, which the first lab_of() would wait for
// otherwise.
void make_lab_ready();

}  // namespace splatcut
