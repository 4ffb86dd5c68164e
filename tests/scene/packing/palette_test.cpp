#include "scene/packing/palette.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <set>

using namespace splatcut;

namespace {

double rms_of(const Codebook& codebook, const std::vector<float>& values) {
  double sum = 0;
  for (const float v : values) sum += std::pow(codebook[nearest_in(codebook, v)] - v, 2.0);
  return std::sqrt(sum / static_cast<double>(values.size()));
}

}  // namespace

TEST_CASE("codebook: up to 256 different values are kept, the nearest entry is the nearest") {
  std::vector<float> values;
  for (int i = 0; i < 256; ++i)
    for (int repeat = 0; repeat < 3; ++repeat)
      values.push_back(std::sin(0.1f * static_cast<float>(i * 7 % 256)));
  const Codebook codebook = codebook_of(values);
  for (const float v : values) CHECK(codebook[nearest_in(codebook, v)] == v);
  CHECK(codebook_of({})[0] == 0);
  CHECK(codebook_of({2.5f})[200] == 2.5f);
  const Codebook tens = codebook_of({0, 10, 20});
  CHECK(tens[nearest_in(tens, 14.9f)] == 10);
  CHECK(tens[nearest_in(tens, 15.1f)] == 20);
  CHECK(tens[nearest_in(tens, -5)] == 0);
  CHECK(tens[nearest_in(tens, 1000)] == 20);
}

TEST_CASE("codebook: never worse than equal steps over the range, for three densities") {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(-3, 1);
  std::normal_distribution<double> bell(0, 1);
  std::vector<float> flat, bells, far;
  for (int i = 0; i < 30000; ++i) {
    flat.push_back(static_cast<float>(uniform(random)));
    bells.push_back(static_cast<float>(bell(random)));
    far.push_back(static_cast<float>(bell(random)));
  }
  far[7] = 1e4f;  // one that is far from all others
  for (const auto* values : {&flat, &bells, &far}) {
    const auto [least, most] = std::ranges::minmax(*values);
    const double equal_steps = (most - least) / 256.0 / std::sqrt(12.0);
    CHECK(rms_of(codebook_of(*values), *values) <= 1.01 * equal_steps);
  }
  // The bound of Panter and Dite for a bell: sqrt(sqrt(3) pi / 2) sigma / 256.
  CHECK(rms_of(codebook_of(bells), bells) < 1.1 * std::sqrt(std::sqrt(3.0) * 3.14159265 / 2) / 256);
  const Codebook outlier = codebook_of(far);
  CHECK(outlier[nearest_in(outlier, 1e4f)] == 1e4f);
}

TEST_CASE("palette: different rows up to the most are kept, beyond it rows share means") {
  std::mt19937 random(11);
  std::vector<float> rows;
  for (int i = 0; i < 3000; ++i)
    for (int k = 0; k < 3; ++k) rows.push_back(static_cast<float>(random() % 4) / 3.0f - 0.1f);
  const RowPalette exact = palette_of(rows, 3, 64);
  CHECK(exact.size(3) == 64);
  for (std::size_t i = 0; i < 3000; ++i)
    for (std::size_t k = 0; k < 3; ++k) REQUIRE(exact.entries[3 * exact.entry_of[i] + k] == rows[3 * i + k]);

  const RowPalette few = palette_of(rows, 3, 8);
  REQUIRE(few.size(3) == 8);
  double error = 0;
  for (std::size_t i = 0; i < 3000; ++i)
    for (std::size_t k = 0; k < 3; ++k)
      error += std::pow(few.entries[3 * few.entry_of[i] + k] - rows[3 * i + k], 2.0);
  // Four levels a third apart, halved once on each axis: 1/6 from the mean of a pair, all the same.
  CHECK(error / 9000 == doctest::Approx(1.0 / 36).epsilon(0.01));
  CHECK(palette_of({}, 3, 8).size(3) == 0);
  CHECK(palette_of(std::vector<float>{1, 2, 3}, 3, 8).entries == std::vector<float>{1, 2, 3});
  CHECK(palette_of(std::vector<float>(300, 0.3f), 3, 8).entries == std::vector<float>(3, 0.3f));
}
