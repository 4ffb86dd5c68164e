// A dense picture, row-major, top row first; pixel (x, y) covers [x, x+1) x [y, y+1).
#pragma once

#include <array>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace splatcut {

template <class T>
class Image {
 public:
  Image() = default;
  Image(int width, int height, const T& fill = T{})
      : width_(width), height_(height), pixels_(static_cast<std::size_t>(width) * height, fill) {
    assert(width >= 0 && height >= 0);
  }

  int width() const { return width_; }
  int height() const { return height_; }
  bool empty() const { return pixels_.empty(); }
  std::size_t size() const { return pixels_.size(); }
  bool contains(int x, int y) const { return x >= 0 && y >= 0 && x < width_ && y < height_; }

  T& at(int x, int y) {
    assert(contains(x, y));
    return pixels_[static_cast<std::size_t>(y) * width_ + x];
  }
  const T& at(int x, int y) const {
    assert(contains(x, y));
    return pixels_[static_cast<std::size_t>(y) * width_ + x];
  }
  std::span<T> row(int y) { return pixels().subspan(static_cast<std::size_t>(y) * width_, width_); }
  std::span<const T> row(int y) const {
    return pixels().subspan(static_cast<std::size_t>(y) * width_, width_);
  }
  std::span<T> pixels() { return pixels_; }
  std::span<const T> pixels() const { return pixels_; }
  T* data() { return pixels_.data(); }
  const T* data() const { return pixels_.data(); }

  bool operator==(const Image&) const = default;

 private:
  int width_ = 0;
  int height_ = 0;
  std::vector<T> pixels_;
};

using Rgb8 = std::array<std::uint8_t, 3>;
using Rgba8 = std::array<std::uint8_t, 4>;
using Rgba16 = std::array<std::uint16_t, 4>;

// A binary mask: 0 outside the object, kMaskObject inside.
using Mask = Image<std::uint8_t>;
inline constexpr std::uint8_t kMaskObject = 255;

// Half-open rectangle of pixels: x0 <= x < x1, y0 <= y < y1.
struct PixelRect {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
  int width() const { return x1 - x0; }
  int height() const { return y1 - y0; }
  bool empty() const { return x1 <= x0 || y1 <= y0; }
  bool operator==(const PixelRect&) const = default;
};

}  // namespace splatcut
