// The pixel cut with a known unary, against the least of all labellings.
#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "core/counter_rng.h"
#include "segment/masks/refine_mask.h"

using namespace splatcut;

namespace {

constexpr int kGridWidth = 4, kGridHeight = 3, kGridPixels = kGridWidth * kGridHeight;
constexpr float kGridLambda = 1.5f;

// Pairs of the 8-grid. In a picture of two colours each pair differs by 0 or by D, whose mean is D times the
// share of pairs that differ: exp(-D / (2 mean)) depends on that share alone, whatever the colours are.
struct Pair {
  int a, b;
  double weight;
};

std::vector<Pair> pairs_of(const std::array<bool, kGridPixels>& dark) {
  std::vector<Pair> pairs;
  double differ = 0;
  for (int y = 0; y < kGridHeight; ++y)
    for (int x = 0; x < kGridWidth; ++x)
      for (const auto& [dx, dy] : {std::pair{1, 0}, {0, 1}, {1, 1}, {-1, 1}}) {
        if (x + dx < 0 || x + dx >= kGridWidth || y + dy >= kGridHeight) continue;
        const int a = y * kGridWidth + x, b = (y + dy) * kGridWidth + x + dx;
        pairs.push_back({a, b, kGridLambda / std::hypot(dx, dy)});
        differ += dark[a] != dark[b];
      }
  const double share = differ / static_cast<double>(pairs.size());
  for (Pair& pair : pairs)
    if (dark[pair.a] != dark[pair.b]) pair.weight *= std::exp(-1 / (2 * share));
  return pairs;
}

double energy(unsigned object, const std::vector<Pair>& pairs, const Image<float>& odds) {
  double sum = 0;
  for (int p = 0; p < kGridPixels; ++p)
    if (!(object >> p & 1u)) sum += odds.pixels()[p];
  for (const Pair& pair : pairs)
    if ((object >> pair.a & 1u) != (object >> pair.b & 1u)) sum += pair.weight;
  return sum;
}

}  // namespace

TEST_CASE("cut by odds: no labelling of all pixels costs less") {
  const Image<float> flat(kGridWidth, kGridHeight, 1);
  for (std::uint64_t draw = 0; draw < 20; ++draw) {
    CAPTURE(draw);
    CounterRng random(draw, 0);
    std::array<bool, kGridPixels> dark{};
    Image<Rgb8> picture(kGridWidth, kGridHeight);
    Image<float> odds(kGridWidth, kGridHeight);
    for (int p = 0; p < kGridPixels; ++p) {
      dark[p] = random.unit() < 0.5f;
      picture.pixels()[p] = dark[p] ? Rgb8{40, 60, 20} : Rgb8{200, 180, 90};
      odds.pixels()[p] = random.between(-3, 3);
    }
    Mask prior(kGridWidth, kGridHeight);
    prior.at(1, 1) = kMaskObject;
    const Mask found = cut_by_odds(picture, flat, prior, odds, {.band_px = 9, .lambda = kGridLambda});
    unsigned object = 0;
    for (int p = 0; p < kGridPixels; ++p) object |= found.pixels()[p] ? 1u << p : 0u;
    const std::vector<Pair> pairs = pairs_of(dark);
    double least = std::numeric_limits<double>::max();
    for (unsigned all = 0; all < 1u << kGridPixels; ++all) least = std::min(least, energy(all, pairs, odds));
    CHECK(energy(object, pairs, odds) == doctest::Approx(least).epsilon(1e-3));
  }
}

TEST_CASE("cut by odds: what is far from the border of the prior stays") {
  Image<Rgb8> picture(30, 3, Rgb8{90, 90, 90});
  const Image<float> flat(30, 3, 1), rest(30, 3, -9);
  Mask prior(30, 3);
  for (int y = 0; y < 3; ++y)
    for (int x = 0; x < 15; ++x) prior.at(x, y) = kMaskObject;
  const Mask found = cut_by_odds(picture, flat, prior, rest, {.band_px = 5, .lambda = 0.1f});
  for (int x = 0; x < 30; ++x) CHECK((found.at(x, 1) != 0) == (x < 11));  // 15 is the nearest of the rest
  CHECK(cut_by_odds(picture, flat, Mask(30, 3), rest, {}) == Mask(30, 3));
}
