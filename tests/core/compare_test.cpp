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
