#include "core/picture_difference.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <tuple>

#include "core/error.h"

namespace splatcut {

namespace {

constexpr int kWindow = 11;
constexpr double kSigma = 1.5;
constexpr int kBandRows = 64;  // large pictures take little memory beside themselves

// Numbers of a channel for a level of 255.
constexpr int per_level(const Rgb8&) {
  return 1;
}
constexpr int per_level(const Rgba16&) {
  return 257;
}

// What the pixel lets through, 0 to 255.
double seen_through(const Rgb8&) {
  return 0;
}
double seen_through(const Rgba16& p) {
  return (65535.0 - p[3]) / 257;
}

template <class Pixel>
void require_same_size(const Image<Pixel>& a, const Image<Pixel>& b) {
  if (a.width() != b.width() || a.height() != b.height())
    throw Error("pictures", fmt::format("the first has {} x {} pixels, the second {} x {}", a.width(),
                                        a.height(), b.width(), b.height()));
}

// On a ground of so much light, 0 black to 1 white.
template <class Pixel>
Image<double> luma_of_rows(const Image<Pixel>& picture, int begin, int rows, double ground) {
  Image<double> out(picture.width(), rows);
  const auto first = static_cast<std::size_t>(begin) * static_cast<std::size_t>(picture.width());
  std::ranges::transform(
      picture.pixels().subspan(first, out.size()), out.pixels().begin(), [ground](const Pixel& p) {
        return (0.299 * p[0] + 0.587 * p[1] + 0.114 * p[2]) / per_level(p) + ground * seen_through(p);
      });
  return out;
}

// Weighted means over the windows that lie inside; smaller by the window's size minus one.
Image<double> windowed(const Image<double>& in, int window) {
  std::vector<double> weight(static_cast<std::size_t>(window));
  double sum = 0;
  for (int i = 0; i < window; ++i)
    sum += weight[static_cast<std::size_t>(i)] =
        std::exp(-0.5 * std::pow((i - 0.5 * (window - 1)) / kSigma, 2));
  for (double& w : weight) w /= sum;
  Image<double> rows(in.width() - window + 1, in.height()),
      out(in.width() - window + 1, in.height() - window + 1);
  for (int y = 0; y < rows.height(); ++y)
    for (int x = 0; x < rows.width(); ++x)
      for (int i = 0; i < window; ++i) rows.at(x, y) += weight[static_cast<std::size_t>(i)] * in.at(x + i, y);
  for (int y = 0; y < out.height(); ++y)
    for (int x = 0; x < out.width(); ++x)
      for (int i = 0; i < window; ++i)
        out.at(x, y) += weight[static_cast<std::size_t>(i)] * rows.at(x, y + i);
  return out;
}

Image<double> product(const Image<double>& a, const Image<double>& b) {
  Image<double> out(a.width(), a.height());
  std::ranges::transform(a.pixels(), b.pixels(), out.pixels().begin(), std::multiplies<>());
  return out;
}

// Of all windows that lie inside.
double sum_of_ssim(const Image<double>& a, const Image<double>& b, int window, double sum) {
  const Image<double> mean_a = windowed(a, window), mean_b = windowed(b, window);
  const Image<double> aa = windowed(product(a, a), window), bb = windowed(product(b, b), window),
                      ab = windowed(product(a, b), window);
  constexpr double kC1 = 0.01 * 255 * 0.01 * 255, kC2 = 0.03 * 255 * 0.03 * 255;
  for (std::size_t i = 0; i < aa.size(); ++i) {
    const double ma = mean_a.pixels()[i], mb = mean_b.pixels()[i];
    const double va = aa.pixels()[i] - ma * ma, vb = bb.pixels()[i] - mb * mb, cov = ab.pixels()[i] - ma * mb;
    sum += (2 * ma * mb + kC1) * (2 * cov + kC2) / ((ma * ma + mb * mb + kC1) * (va + vb + kC2));
  }
  return sum;
}

template <class Pixel>
double mean_ssim(const Image<Pixel>& a, const Image<Pixel>& b, double ground) {
  const int window = std::min({kWindow, a.width(), a.height()});
  const int columns = a.width() - window + 1, rows = a.height() - window + 1;
  double sum = 0;
  for (int y = 0; y < rows; y += kBandRows) {
    const int seen = std::min(kBandRows, rows - y) + window - 1;
    sum = sum_of_ssim(luma_of_rows(a, y, seen, ground), luma_of_rows(b, y, seen, ground), window, sum);
  }
  return sum / (static_cast<double>(columns) * rows);
}

template <class Pixel>
int channel_difference(const Pixel& a, const Pixel& b, std::size_t c) {
  return std::abs(static_cast<int>(a[c]) - static_cast<int>(b[c]));
}

template <class Pixel>
PictureDifference difference_of(const Image<Pixel>& a, const Image<Pixel>& b, int levels) {
  require_same_size(a, b);
  constexpr int kPerLevel = per_level(Pixel{});
  constexpr std::size_t kChannels = std::tuple_size_v<Pixel>;
  PictureDifference out;
  if (a.size() == 0) return {0, 0, std::numeric_limits<double>::infinity(), 1};
  std::size_t beyond = 0;
  double squares = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    int largest = 0;
    for (std::size_t c = 0; c < kChannels; ++c) {
      const int d = channel_difference(a.pixels()[i], b.pixels()[i], c);
      largest = std::max(largest, d);
      squares += static_cast<double>(d) * d / (kPerLevel * kPerLevel);
    }
    out.largest = std::max(out.largest, (largest + kPerLevel - 1) / kPerLevel);
    beyond += largest > levels * kPerLevel;
  }
  out.share_beyond = static_cast<double>(beyond) / static_cast<double>(a.size());
  out.psnr_db = squares == 0
                    ? std::numeric_limits<double>::infinity()
                    : 10 * std::log10(255.0 * 255.0 * kChannels * static_cast<double>(a.size()) / squares);
  out.ssim = mean_ssim(a, b, 0);
  if (kChannels == 4) out.ssim = std::min(out.ssim, mean_ssim(a, b, 1));
  return out;
}

template <class Pixel>
Image<Rgb8> picture_of_difference(const Image<Pixel>& a, const Image<Pixel>& b) {
  require_same_size(a, b);
  constexpr int kGain = 8, kPerLevel = per_level(Pixel{});
  Image<Rgb8> out(a.width(), a.height());
  for (std::size_t i = 0; i < a.size(); ++i) {
    const Pixel &p = a.pixels()[i], &q = b.pixels()[i];
    const int of_alpha =
        std::tuple_size_v<Pixel> == 4 ? channel_difference(p, q, std::tuple_size_v<Pixel> - 1) : 0;
    for (std::size_t c = 0; c < 3; ++c) {
      const int d = std::max(channel_difference(p, q, c), of_alpha);
      out.pixels()[i][c] = static_cast<std::uint8_t>(std::min(255, (kGain * d + kPerLevel - 1) / kPerLevel));
    }
  }
  return out;
}

}  // namespace

PictureDifference picture_difference(const Image<Rgb8>& a, const Image<Rgb8>& b, int levels) {
  return difference_of(a, b, levels);
}
PictureDifference picture_difference(const Image<Rgba16>& a, const Image<Rgba16>& b, int levels) {
  return difference_of(a, b, levels);
}

Image<Rgb8> difference_picture(const Image<Rgb8>& a, const Image<Rgb8>& b) {
  return picture_of_difference(a, b);
}
Image<Rgb8> difference_picture(const Image<Rgba16>& a, const Image<Rgba16>& b) {
  return picture_of_difference(a, b);
}

Image<Rgba16> rgba16_of(const Image<Rgb8>& picture) {
  Image<Rgba16> out(picture.width(), picture.height());
  std::ranges::transform(picture.pixels(), out.pixels().begin(), [](const Rgb8& p) {
    const auto wide = [](std::uint8_t v) { return static_cast<std::uint16_t>(257u * v); };
    return Rgba16{wide(p[0]), wide(p[1]), wide(p[2]), 65535};
  });
  return out;
}

}  // namespace splatcut
