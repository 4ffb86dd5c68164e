// Which pixels a click reaches: by hand, and against a search that starts anew at every index.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>

#include "scene/raster/depth_jump.h"
#include "segment/selection/click_reach.h"
#include "segment/selection/leaf_view.h"
#include "segment/superpoints/part_looks.h"

using namespace splatcut;

namespace {

// Rows of digits: from which index on the pixel changes; a blank never does.
Image<std::uint32_t> levels(const std::vector<std::string>& rows) {
  Image<std::uint32_t> level(static_cast<int>(rows[0].size()), static_cast<int>(rows.size()), kNoLevel);
  for (int y = 0; y < level.height(); ++y)
    for (int x = 0; x < level.width(); ++x) {
      const char c = rows[static_cast<std::size_t>(y)][static_cast<std::size_t>(x)];
      if (c != ' ') level.at(x, y) = static_cast<std::uint32_t>(c - '0');
    }
  return level;
}

Image<float> flat(const Image<std::uint32_t>& level) {
  return {level.width(), level.height(), 5.0f};
}

using Shares = std::vector<float>;

Shares shares_by(const Image<float>& depth, const Image<std::uint32_t>& level, std::size_t indices,
                 const glm::ivec2& at) {
  return shares_out_of_reach(level, indices, steps_without_jump(depth), at);
}

// Pixels reached when everything up to the index changes at once.
std::size_t reached_at(const Image<std::uint32_t>& level, const Image<float>& depth, const glm::ivec2& at,
                       std::uint32_t index) {
  Image<std::uint8_t> in(level.width(), level.height());
  const auto changes = [&](int x, int y) { return level.contains(x, y) && level.at(x, y) <= index; };
  for (int y = at.y - 1; y <= at.y + 1; ++y)
    for (int x = at.x - 1; x <= at.x + 1; ++x)
      if (changes(x, y)) in.at(x, y) = 1;
  for (bool more = true; more;) {
    more = false;
    for (int y = 0; y < in.height(); ++y)
      for (int x = 0; x < in.width(); ++x)
        for (const glm::ivec2 step :
             {glm::ivec2(1, 0), glm::ivec2(-1, 0), glm::ivec2(0, 1), glm::ivec2(0, -1)}) {
          const glm::ivec2 p(x, y), q = p + step;
          if (!in.at(x, y) || !changes(q.x, q.y) || in.at(q.x, q.y) ||
              depth_jumps(depth, p, q, kJumpInOneStep))
            continue;
          in.at(q.x, q.y) = 1;
          more = true;
        }
  }
  return static_cast<std::size_t>(std::ranges::count(in.pixels(), 1));
}

}  // namespace

TEST_CASE("click reach: steps stay in the picture, and lead over no jump in depth either way") {
  Image<float> depth(3, 2, 5.0f);
  depth.at(2, 0) = 7;  // farther than what is beside and below it
  depth.at(0, 1) = 0;  // nothing is there
  constexpr std::uint8_t kRight = 1, kLeft = 2, kDown = 4, kUp = 8;  // bits in the order of kFourSteps
  const std::vector<std::uint8_t> expected = {kRight, kLeft | kDown, 0, 0, kRight | kUp, kLeft};
  CHECK(std::ranges::equal(steps_without_jump(depth).pixels(), expected));
}

TEST_CASE("click reach: a gap and a bridge that comes later") {
  const Image<std::uint32_t> level = levels({"0  0", "0  0", "0110"});
  CHECK(shares_by(flat(level), level, 2, {0, 0}) == Shares{0.5f, 0});
  const Image<std::uint32_t> apart = levels({"0 10", "0 10", "0  0"});
  CHECK(shares_by(flat(apart), apart, 3, {0, 1}) == Shares{0.5f, 5.0f / 8, 5.0f / 8});
}

TEST_CASE("click reach: a jump in depth is a gap, a slope is none") {
  const Image<std::uint32_t> level = levels({"000000"});
  Image<float> depth = flat(level);
  for (int x = 3; x < 6; ++x) depth.at(x, 0) = 7;
  CHECK(shares_by(depth, level, 1, {0, 0}) == Shares{0.5f});
  CHECK(shares_by(depth, level, 1, {3, 0}) == Shares{0});  // beside the edge both sides are near
  for (int x = 0; x < 6; ++x) depth.at(x, 0) = 5 * std::exp(0.15f * static_cast<float>(x));
  CHECK(shares_by(depth, level, 1, {0, 0}) == Shares{0});
}

TEST_CASE("click reach: a click where nothing changes reaches nothing, and nothing has no share") {
  const Image<std::uint32_t> level = levels({"    1"});
  CHECK(shares_by(flat(level), level, 2, {0, 0}) == Shares{0, 1});
  CHECK(shares_by(flat(level), level, 2, {4, 0}) == Shares{0, 0});
}

TEST_CASE("click reach: random pictures as searched anew at every index") {
  std::mt19937 random(5);
  for (int round = 0; round < 50; ++round) {
    Image<std::uint32_t> level(9, 8, kNoLevel);
    Image<float> depth(9, 8);
    for (std::size_t i = 0; i < level.size(); ++i) {
      if (random() % 4) level.pixels()[i] = static_cast<std::uint32_t>(random() % 5);
      depth.pixels()[i] = random() % 5 ? 1.0f : 1.5f;
    }
    const glm::ivec2 at(random() % 9, random() % 8);
    const Shares shares = shares_by(depth, level, 5, at);
    for (std::uint32_t i = 0; i < 5; ++i) {
      const auto all = std::ranges::count_if(level.pixels(), [&](std::uint32_t l) { return l <= i; });
      const double reached = static_cast<double>(reached_at(level, depth, at, i));
      CHECK(shares[i] == doctest::Approx(all ? 1 - reached / static_cast<double>(all) : 0));
    }
  }
}

TEST_CASE("click reach: the distance to a border is that of the nearest pixel of the other side or outside") {
  std::mt19937 random(7);
  for (int round = 0; round < 200; ++round) {
    Mask mask(11, 7);
    for (auto& pixel : mask.pixels()) pixel = random() % 20 ? 0 : kMaskObject;
    const glm::ivec2 at(random() % 11, random() % 7);
    int nearest2 = 1000;
    for (int y = -1; y <= 7; ++y)
      for (int x = -1; x <= 11; ++x)
        if (glm::ivec2(x, y) != at && (!mask.contains(x, y) || mask.at(x, y)))
          nearest2 = std::min(nearest2, (x - at.x) * (x - at.x) + (y - at.y) * (y - at.y));
    CHECK(distance_to_border(mask, at, false) == std::sqrt(static_cast<float>(nearest2)));
  }
}

TEST_CASE("click reach: what is missing may end at a depth edge, at a share of the way at most") {
  const Mask nothing(41, 41);
  Image<float> depth(41, 41, 5.0f);
  const glm::ivec2 at(20, 20);
  CHECK(distance_to_end(depth, nothing, at, true) == 21);
  for (int y = 0; y < 41; ++y)
    for (int x = 30; x < 41; ++x) depth.at(x, y) = 7;
  CHECK(distance_to_end(depth, nothing, at, true) == 10.5f);  // 29 is the first pixel between the two
  for (int y = 0; y < 41; ++y)
    for (int x = 22; x < 41; ++x) depth.at(x, y) = 7;
  CHECK(distance_to_end(depth, nothing, at, true) == doctest::Approx(0.3f * 21));
  Mask all(41, 41, kMaskObject);
  CHECK(distance_to_end(depth, all, at, false) == 21);
}
