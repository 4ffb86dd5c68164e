#include "scene/cloud/joined_clouds.h"

#include <doctest/doctest.h>

#include "synthetic_cloud.h"

using namespace splatcut;
using namespace splatcut::testing;

TEST_CASE("joined clouds: every attribute in its place, in the order of the clouds") {
  const GaussianCloud a = random_cloud(5, 1, 2), b = random_cloud(7, 2, 2);
  const GaussianCloud whole = joined({a, b});
  REQUIRE(whole.size() == 12);
  CHECK(whole.sh_degree == 2);
  for (std::size_t g = 0; g < whole.size(); ++g) {
    const GaussianCloud& part = g < 5 ? a : b;
    const std::size_t own = g < 5 ? g : g - 5;
    CAPTURE(g);
    CHECK(whole.position[g] == part.position[own]);
    CHECK(whole.scale[g] == part.scale[own]);
    CHECK(whole.rotation[g] == part.rotation[own]);
    CHECK(whole.opacity[g] == part.opacity[own]);
    CHECK(whole.f_dc[g] == part.f_dc[own]);
    CHECK(whole.file_row[g] == own);
    for (std::size_t k = 0; k < whole.sh_stride(); ++k)
      CHECK(whole.sh_rest_of(g)[k] == part.sh_rest_of(own)[k]);
  }
}

TEST_CASE("joined clouds: a lower degree is padded with zeros at the end of each channel") {
  GaussianCloud low, high;
  low.resize(2, 1);
  for (std::size_t i = 0; i < low.sh_rest.size(); ++i) low.sh_rest[i] = static_cast<float>(i + 1);
  high.resize(1, 2);
  for (std::size_t i = 0; i < high.sh_rest.size(); ++i) high.sh_rest[i] = 100 + static_cast<float>(i);
  GaussianCloud none;
  none.resize(1, 0);
  const GaussianCloud whole = joined({low, high, none});
  const std::vector<float> expected = {
      1,   2,   3,   0,   0,   0,   0,   0,    // red
      4,   5,   6,   0,   0,   0,   0,   0,    // green
      7,   8,   9,   0,   0,   0,   0,   0,    // blue
      10,  11,  12,  0,   0,   0,   0,   0,    // of the second
      13,  14,  15,  0,   0,   0,   0,   0,    //
      16,  17,  18,  0,   0,   0,   0,   0,    //
      100, 101, 102, 103, 104, 105, 106, 107,  // of the degree of all
      108, 109, 110, 111, 112, 113, 114, 115,  //
      116, 117, 118, 119, 120, 121, 122, 123,  //
      0,   0,   0,   0,   0,   0,   0,   0,    // of degree 0
      0,   0,   0,   0,   0,   0,   0,   0,    //
      0,   0,   0,   0,   0,   0,   0,   0,    //
  };
  CHECK(whole.sh_rest == expected);
}

TEST_CASE("joined clouds: of one it is the cloud, of none it is empty") {
  const GaussianCloud a = random_cloud(4, 3, 3);
  CHECK(joined({a}).position == a.position);
  CHECK(joined({a}).sh_rest == a.sh_rest);
  CHECK(joined({}).empty());
}
