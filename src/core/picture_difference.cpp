#include "core/picture_difference.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>

#include "core/error.h"

namespace splatcut {

namespace {

constexpr int kWindow = 11;
constexpr double kSigma = 1.5;
constexpr int kBandRows = 64;  // large pictures take little memory beside themselves

void require_same_size(const Image<Rgb8>& a, const Image<Rgb8>& b) {
  if (a.width() != b.width() || a.height() != b.height())
    throw Error("pictures", fmt::format("one has {}x{} pixels, the other {}x{}", a.width(), a.height(),
                                        b.width(), b.height()));
}

Image<double> luma_of_rows(const Image<Rgb8>& picture, int begin, int rows) {
  Image<double> out(picture.width(), rows);
  const auto first = static_cast<std::size_t>(begin) * static_cast<std::size_t>(picture.width());
  std::ranges::transform(picture.pixels().subspan(first, out.size()), out.pixels().begin(),
                         [](const Rgb8& p) { return 0.299 * p[0] + 0.587 * p[1] + 0.114 * p[2]; });
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

double mean_ssim(const Image<Rgb8>& a, const Image<Rgb8>& b) {
  const int window = std::min({kWindow, a.width(), a.height()});
  const int columns = a.width() - window + 1, rows = a.height() - window + 1;
  double sum = 0;
  for (int y = 0; y < rows; y += kBandRows) {
    const int seen = std::min(kBandRows, rows - y) + window - 1;
    sum = sum_of_ssim(luma_of_rows(a, y, seen), luma_of_rows(b, y, seen), window, sum);
  }
  return sum / (static_cast<double>(columns) * rows);
}

int channel_difference(const Rgb8& a, const Rgb8& b, std::size_t c) {
  return std::abs(static_cast<int>(a[c]) - static_cast<int>(b[c]));
}

}  // namespace

PictureDifference picture_difference(const Image<Rgb8>& a, const Image<Rgb8>& b, int levels) {
  require_same_size(a, b);
  PictureDifference out;
  if (a.size() == 0) return {0, 0, std::numeric_limits<double>::infinity(), 1};
  std::size_t beyond = 0;
  double squares = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    int largest = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      const int d = channel_difference(a.pixels()[i], b.pixels()[i], c);
      largest = std::max(largest, d);
      squares += static_cast<double>(d) * d;
    }
    out.largest = std::max(out.largest, largest);
    beyond += largest > levels;
  }
  out.share_beyond = static_cast<double>(beyond) / static_cast<double>(a.size());
  out.psnr_db = squares == 0 ? std::numeric_limits<double>::infinity()
                             : 10 * std::log10(255.0 * 255.0 * 3 * static_cast<double>(a.size()) / squares);
  out.ssim = mean_ssim(a, b);
  return out;
}

Image<Rgb8> difference_picture(const Image<Rgb8>& a, const Image<Rgb8>& b) {
  require_same_size(a, b);
  constexpr int kGain = 8;
  Image<Rgb8> out(a.width(), a.height());
  for (std::size_t i = 0; i < a.size(); ++i)
    for (std::size_t c = 0; c < 3; ++c)
      out.pixels()[i][c] = static_cast<std::uint8_t>(
          std::min(255, kGain * channel_difference(a.pixels()[i], b.pixels()[i], c)));
  return out;
}

}  // namespace splatcut
