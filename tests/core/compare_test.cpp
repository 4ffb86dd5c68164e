#include <doctest/doctest.h>

#include <cmath>
#include <random>

#include "core/error.h"
#include "core/picture_difference.h"

using namespace splatcut;

TEST_CASE("picture difference: by hand") {
  const Image<Rgb8> a(20, 10, Rgb8{100, 100, 100});
  Image<Rgb8> b = a;
  const PictureDifference same = picture_difference(a, b);
  CHECK(same.largest == 0);
  CHECK(same.share_beyond == 0);
  CHECK(std::isinf(same.psnr_db));
  CHECK(same.ssim == doctest::Approx(1));

  b.at(3, 4) = {110, 100, 95};
  const PictureDifference one = picture_difference(a, b);
  CHECK(one.largest == 10);
  CHECK(one.share_beyond == doctest::Approx(1.0 / 200));
  CHECK(picture_difference(a, b, 10).share_beyond == 0);
  // 10 log10(255^2 * 600 / (10^2 + 5^2))
  CHECK(one.psnr_db == doctest::Approx(54.943).epsilon(1e-4));
  CHECK(one.ssim < 1);
  CHECK(difference_picture(a, b).at(3, 4) == Rgb8{80, 0, 40});
  CHECK_THROWS_AS(picture_difference(a, Image<Rgb8>(19, 10)), Error);
}

TEST_CASE("SSIM: two constants give the luminance term alone, noise its variance") {
  const Image<Rgb8> a(32, 32, Rgb8{100, 100, 100}), b(32, 32, Rgb8{150, 150, 150});
  const double c1 = 0.01 * 255 * 0.01 * 255;
  CHECK(picture_difference(a, b).ssim ==
        doctest::Approx((2 * 100 * 150 + c1) / (100 * 100 + 150 * 150 + c1)));
  std::mt19937 random(3);
  Image<Rgb8> noisy = a;
  for (Rgb8& p : noisy.pixels()) p.fill(static_cast<std::uint8_t>(80 + random() % 41));
  // Of a constant and noise of 80..120: covariance 0, so C2 / (variance + C2).
  const double c2 = 0.03 * 255 * 0.03 * 255, variance = (41.0 * 41 - 1) / 12;
  CHECK(picture_difference(a, noisy).ssim == doctest::Approx(c2 / (variance + c2)).epsilon(0.05));
  CHECK(picture_difference(noisy, noisy).ssim == doctest::Approx(1));
}

TEST_CASE("SSIM: the mean over all rows of windows, however tall the picture") {
  // Rows of noise and rows alike, far from each other: each half's windows alone, and those across, add up.
  const auto noisy_rows = [](int height, int noisy_from, unsigned seed) {
    Image<Rgb8> out(16, height, Rgb8{100, 100, 100});
    std::mt19937 random(seed);
    for (int y = noisy_from; y < height; ++y)
      for (int x = 0; x < 16; ++x) out.at(x, y).fill(static_cast<std::uint8_t>(80 + random() % 41));
    return out;
  };
  constexpr int kHeight = 300, kWindowRows = 11;
  const Image<Rgb8> a = noisy_rows(kHeight, 150, 1), b = noisy_rows(kHeight, 150, 2);
  double sum = 0;
  for (int y = 0; y + kWindowRows <= kHeight; ++y) {
    Image<Rgb8> row_a(16, kWindowRows), row_b(16, kWindowRows);
    for (int i = 0; i < kWindowRows; ++i)
      for (int x = 0; x < 16; ++x) {
        row_a.at(x, i) = a.at(x, y + i);
        row_b.at(x, i) = b.at(x, y + i);
      }
    sum += picture_difference(row_a, row_b).ssim;
  }
  CHECK(picture_difference(a, b).ssim == doctest::Approx(sum / (kHeight - kWindowRows + 1)).epsilon(1e-12));
}

TEST_CASE("compare: alpha and 16 bits count, and colours that nobody sees do not") {
  Image<Rgba16> a(20, 12, {0, 0, 0, 0}), b = a;
  CHECK(picture_difference(a, b).largest == 0);
  b.at(3, 4)[3] = 65535;  // opaque black
  const PictureDifference alpha = picture_difference(a, b);
  CHECK(alpha.largest == 255);
  CHECK(alpha.share_beyond == doctest::Approx(1.0 / 240));
  CHECK(alpha.psnr_db == doctest::Approx(10 * std::log10(4.0 * 240)));
  CHECK(alpha.ssim < 0.99);
  CHECK(difference_picture(a, b).at(3, 4) == Rgb8{255, 255, 255});
  b = a;
  b.at(3, 4)[0] = 40;  // of 257 to a level
  CHECK(picture_difference(a, b).largest == 1);
  CHECK(picture_difference(a, b, 0).share_beyond > 0);
  CHECK(picture_difference(a, b, 1).share_beyond == 0);
  const Image<Rgb8> one(20, 12, {10, 20, 30}), other(20, 12, {10, 21, 30});
  const PictureDifference narrow = picture_difference(one, other),
                          wide = picture_difference(rgba16_of(one), rgba16_of(other));
  CHECK(narrow.largest == wide.largest);
  CHECK(narrow.ssim == doctest::Approx(wide.ssim));
}
