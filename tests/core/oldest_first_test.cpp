// What is kept to be found again goes oldest first.
#include "core/oldest_first.h"

#include <doctest/doctest.h>

using namespace splatcut;

TEST_CASE("oldest first: values go once they are too many or too large, and the last one stays") {
  constexpr std::size_t kMost = 3, kMostBytes = 100;
  OldestFirst<int> kept(kMost, kMostBytes);
  for (int i = 0; i < 5; ++i) kept.put(std::to_string(i), i, 10);
  CHECK(kept.size() == kMost);
  CHECK(kept.bytes() == kMost * (10 + 2));
  CHECK_FALSE(kept.find("1"));
  REQUIRE(kept.find("2"));
  CHECK(*kept.find("2") == 2);
  kept.put("2", 7, 20);  // is the newest now
  CHECK(kept.bytes() == 10 + 10 + 20 + 3 * 2);
  kept.put("large", 8, 70);
  CHECK_FALSE(kept.find("3"));
  CHECK_FALSE(kept.find("4"));
  CHECK_FALSE(kept.find("2"));  // 22 and 80 bytes are too many
  CHECK(kept.bytes() == 80);
  kept.put("larger", 9, 1000);
  CHECK(kept.size() == 1);
  CHECK(*kept.find("larger") == 9);
}
