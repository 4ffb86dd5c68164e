#include "segment/masks/colour_overlap.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "segment/masks/cv_image.h"

namespace splatcut {

namespace {

std::size_t colour_bin(const cv::Vec3f& lab) {
  constexpr float kMostChroma = 40;
  const auto eighth = [](float value, float low, float high) {
    return static_cast<std::size_t>(std::clamp(8 * (value - low) / (high - low), 0.0f, 7.0f));
  };
  return (eighth(lab[0], 0, 100) * 8 + eighth(lab[1], -kMostChroma, kMostChroma)) * 8 +
         eighth(lab[2], -kMostChroma, kMostChroma);
}

// Share of each colour in the mask.
std::array<float, kColourBins> shares_of(const Image<std::uint16_t>& colour, const Mask& mask) {
  std::array<float, kColourBins> shares{};
  float all = 0;
  for (std::size_t pixel = 0; pixel < mask.size(); ++pixel)
    if (mask.pixels()[pixel]) {
      shares[colour.pixels()[pixel]] += 1;
      all += 1;
    }
  for (float& share : shares) share /= std::max(all, 1.0f);
  return shares;
}

}  // namespace

Image<std::uint16_t> colour_bins(const Image<Rgb8>& picture) {
  const cv::Mat lab = lab_of(as_const_mat(picture));
  Image<std::uint16_t> bins(picture.width(), picture.height());
  for (int y = 0; y < lab.rows; ++y)
    for (int x = 0; x < lab.cols; ++x)
      bins.at(x, y) = static_cast<std::uint16_t>(colour_bin(lab.at<cv::Vec3f>(y, x)));
  return bins;
}

float overlap_of_colours(const Image<std::uint16_t>& colour, const Mask& mask, const BoxPx& around) {
  std::array<std::array<float, kColourBins>, 2> pixels{};
  std::array<float, 2> all{};
  for (int y = 0; y < mask.height(); ++y)
    for (int x = 0; x < mask.width(); ++x) {
      if (!around.contains(glm::vec2(x, y) + 0.5f)) continue;
      const std::size_t side = mask.at(x, y) != 0;
      pixels[side][colour.at(x, y)] += 1;
      all[side] += 1;
    }
  if (all[0] == 0 || all[1] == 0) return 1;
  float overlap = 0;
  for (std::size_t bin = 0; bin < kColourBins; ++bin)
    overlap += std::min(pixels[0][bin] / all[0], pixels[1][bin] / all[1]);
  return overlap;
}

float log_ratio_of_colours(const Image<Rgb8>& picture, const Mask& region, const Mask& a, const Mask& b) {
  constexpr float kEver = 1e-3f;  // of the pixels: what a mask does not show now it may still have
  const Image<std::uint16_t> colour = colour_bins(picture);
  const std::array<float, kColourBins> of_region = shares_of(colour, region), of_a = shares_of(colour, a),
                                       of_b = shares_of(colour, b);
  float mean = 0;
  for (std::size_t bin = 0; bin < kColourBins; ++bin)
    mean += of_region[bin] * std::log((of_a[bin] + kEver) / (of_b[bin] + kEver));
  return mean;
}

}  // namespace splatcut
