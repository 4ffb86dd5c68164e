// Badges on outlines: apart from each other, in the picture, beside what covers it.
#include "app/picture/badge_place.h"

#include <doctest/doctest.h>

#include <vector>

using namespace splatcut;

TEST_CASE("badges: beside the bar, within the picture, far from each other") {
  std::vector<glm::vec2> border;  // a square of 400 points at the upper left corner of the picture
  for (int i = 0; i <= 100; ++i) {
    const float t = 4.0f * static_cast<float>(i);
    border.insert(border.end(), {{t, 0}, {t, 400}, {0, t}, {400, t}});
  }
  const BadgeRoom room{{0, 0}, {600, 500}, {{{{12, 12}, {350, 54}}}}};
  std::vector<glm::vec2> apart;
  for (int badge = 0; badge < 6; ++badge) {
    const auto place = badge_place(border, apart, room);
    REQUIRE(place);
    CHECK(place->x > 16);
    CHECK(place->y > 16);
    const bool beside = place->x > 350 + 16 || place->y > 54 + 16;
    CHECK(beside);
    for (const glm::vec2& other : apart) CHECK(glm::distance(*place, other) > 50);
    apart.push_back(*place);
  }
  const std::vector<glm::vec2> under{{100, 40}, {200, 40}};
  CHECK_FALSE(badge_place(under, {}, room));
  CHECK_FALSE(badge_place(under, {}, BadgeRoom{{0, 0}, {600, 500}, {{{}, {{12, 12}, {350, 54}}}}}));
  CHECK(badge_place(under, {}, BadgeRoom{{0, 0}, {600, 500}}));
}

TEST_CASE(
    "badges: on outlines that are smaller than a badge they lie beside, apart from each other and the dot") {
  std::vector<glm::vec2> border;
  for (int i = 0; i < 8; ++i) border.emplace_back(300 + i % 3, 250 + i / 3);
  const BadgeRoom room{{0, 0}, {600, 500}};
  const glm::vec2 dot(301, 251);
  std::vector<glm::vec2> apart{dot};
  for (int badge = 0; badge < 2; ++badge) {
    const auto place = badge_place(border, apart, room);
    REQUIRE(place);
    for (const glm::vec2& other : apart) CHECK(glm::distance(*place, other) >= 23);
    CHECK(glm::distance(*place, dot) < 60);
    apart.push_back(*place);
  }
  CHECK_FALSE(badge_place(border, apart, BadgeRoom{{280, 230}, {320, 270}}));  // there is room for one alone
}
