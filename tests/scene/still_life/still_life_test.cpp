#include "scene/still_life/still_life.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string>

#include "core/error.h"
#include "scene/still_life/surface_sampler.h"

using namespace splatcut;

namespace {

constexpr std::size_t kSmall = 20000;

StillLifeOptions small_table() {
  return {.gaussians = kSmall};
}

template <class T>
bool same_bytes(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
}

bool same_scene(const LabelledScene& a, const LabelledScene& b) {
  return same_bytes(a.cloud.position, b.cloud.position) && same_bytes(a.cloud.scale, b.cloud.scale) &&
         same_bytes(a.cloud.rotation, b.cloud.rotation) && same_bytes(a.cloud.opacity, b.cloud.opacity) &&
         same_bytes(a.cloud.f_dc, b.cloud.f_dc) && same_bytes(a.cloud.sh_rest, b.cloud.sh_rest) &&
         same_bytes(a.label, b.label);
}

std::uint8_t label_of(const LabelledScene& scene, const std::string& name) {
  const auto found = std::find(scene.label_name.begin(), scene.label_name.end(), name);
  REQUIRE_MESSAGE(found != scene.label_name.end(), name);
  return static_cast<std::uint8_t>(found - scene.label_name.begin());
}

bool has(const LabelledScene& scene, const std::string& name) {
  return std::count(scene.label_name.begin(), scene.label_name.end(), name) == 1;
}

template <class Keep>
std::size_t count_if_row(const LabelledScene& scene, const Keep& keep) {
  std::size_t count = 0;
  for (std::size_t g = 0; g < scene.cloud.size(); ++g) count += keep(g) ? 1 : 0;
  return count;
}

glm::vec3 mean_colour(const LabelledScene& scene, std::uint8_t label) {
  glm::vec3 sum{0};
  float n = 0;
  for (std::size_t g = 0; g < scene.cloud.size(); ++g)
    if (scene.label[g] == label) sum += 0.5f + 0.28209479f * scene.cloud.f_dc[g], n += 1;
  return sum / n;
}

// Smallest distance between splats of two objects.
float gap(const LabelledScene& scene, std::uint8_t a, std::uint8_t b) {
  float best = 1e9f;
  for (std::size_t g = 0; g < scene.cloud.size(); ++g)
    for (std::size_t h = 0; scene.label[g] == a && h < scene.cloud.size(); ++h)
      if (scene.label[h] == b)
        best = std::min(best, glm::distance(scene.cloud.position[g], scene.cloud.position[h]));
  return best;
}

}  // namespace

TEST_CASE("still life: the same options give the same bytes, another seed gives others") {
  const LabelledScene a = make_still_life(small_table()), b = make_still_life(small_table());
  CHECK(same_scene(a, b));
  StillLifeOptions other = small_table();
  other.seed = 2;
  CHECK_FALSE(same_scene(a, make_still_life(other)));
}

TEST_CASE("still life: the count is exact and every label occurs") {
  for (const std::size_t n : {std::size_t{0}, std::size_t{1}, std::size_t{300}, std::size_t{20011}}) {
    StillLifeOptions options = small_table();
    options.gaussians = n;
    options.floaters = options.straddling = options.unseen_interior = options.twins = options.occluder = true;
    const LabelledScene scene = make_still_life(options);
    CHECK(scene.cloud.size() == n);
    CHECK(scene.label.size() == n);
    if (n < 300) continue;
    for (std::size_t l = 0; l < scene.label_name.size(); ++l) {
      INFO("n = " << n << ", label " << scene.label_name[l]);
      CHECK(std::count(scene.label.begin(), scene.label.end(), static_cast<std::uint8_t>(l)) > 0);
    }
  }
}

TEST_CASE("still life: values are finite, quaternions unit, rows in order") {
  for (const int degree : {0, 1, 2, 3}) {
    StillLifeOptions options = small_table();
    options.sh_degree = degree;
    options.floaters = options.straddling = options.unseen_interior = true;
    const GaussianCloud cloud = make_still_life(options).cloud;
    REQUIRE(cloud.sh_degree == degree);
    REQUIRE(cloud.sh_rest.size() == kSmall * cloud.sh_stride());
    std::size_t wrong = 0;
    for (std::size_t g = 0; g < cloud.size(); ++g) {
      const glm::vec3 p = cloud.position[g], s = cloud.scale[g], c = cloud.f_dc[g];
      const bool finite = std::isfinite(p.x + p.y + p.z + s.x + s.y + s.z + c.x + c.y + c.z);
      const bool positive = s.x > 0 && s.y > 0 && s.z > 0 && cloud.opacity[g] > 0 && cloud.opacity[g] <= 1;
      const bool unit = std::abs(glm::length(cloud.rotation[g]) - 1) < 1e-5f;
      wrong += !finite || !positive || !unit || cloud.file_row[g] != g;
    }
    CHECK(wrong == 0);
    CHECK(std::all_of(cloud.sh_rest.begin(), cloud.sh_rest.end(), [](float x) { return std::isfinite(x); }));
  }
}

TEST_CASE("still life: cameras and seeds point at the objects") {
  const LabelledScene scene = make_still_life(small_table());
  REQUIRE(scene.cameras.size() == 24);
  for (const Camera& camera : scene.cameras) {
    CHECK(camera.width_px == 1008);
    CHECK(camera.height_px == 756);
    CHECK(camera.down_world().y > 0);  // y is down
  }
  CHECK(scene.seeds.size() + 1 == scene.label_name.size());
  for (const LabelledScene::SeedClick& seed : scene.seeds) {
    const std::uint8_t label = label_of(scene, seed.object);
    const Camera& camera = scene.cameras[static_cast<std::size_t>(seed.camera)];
    float nearest = 1e9f;
    for (std::size_t g = 0; g < scene.cloud.size(); ++g) {
      if (scene.label[g] != label) continue;
      const glm::vec2 pixel = camera.pixel_from_camera(camera.camera_from_world(scene.cloud.position[g]));
      nearest = std::min(nearest, glm::distance(pixel, seed.pixel));
    }
    INFO(seed.object);
    CHECK(nearest < 16);
  }
}

TEST_CASE("still life: options change what they say") {
  const LabelledScene plain = make_still_life(small_table());
  StillLifeOptions options = small_table();

  SUBCASE("twins and occluder add their labels") {
    CHECK_FALSE(has(plain, "apple twin"));
    CHECK_FALSE(has(plain, "board"));
    options.twins = options.occluder = true;
    const LabelledScene scene = make_still_life(options);
    CHECK(has(scene, "apple twin"));
    CHECK(has(scene, "board"));
  }
  SUBCASE("floaters: faint background") {
    options.floaters = true;
    const LabelledScene scene = make_still_life(options);
    const auto faint = [](const LabelledScene& s) {
      return count_if_row(s, [&](std::size_t g) { return s.label[g] == 0 && s.cloud.opacity[g] < 0.3f; });
    };
    CHECK(faint(plain) == 0);
    CHECK(faint(scene) == kSmall * 3 / 1000);
  }
  SUBCASE("unseen interior: splats inside the mug's wall, below the coffee") {
    options.unseen_interior = true;
    const LabelledScene scene = make_still_life(options);
    const auto inside = [](const LabelledScene& s) {
      return count_if_row(s, [&](std::size_t g) {
        const glm::vec3 p = s.cloud.position[g];
        return s.label[g] == label_of(s, "mug") && std::hypot(p.x, p.z + 0.34f) < 0.12f && p.y < -0.02f &&
               p.y > -0.28f;
      });
    };
    CHECK(inside(plain) == 0);
    CHECK(inside(scene) > 10);
  }
  SUBCASE("straddling: large splats of an object on the table") {
    options.straddling = true;
    const LabelledScene scene = make_still_life(options);
    const auto large = [](const LabelledScene& s) {
      return count_if_row(
          s, [&](std::size_t g) { return s.label[g] == label_of(s, "mug") && s.cloud.scale[g].x > 0.029f; });
    };
    CHECK(large(plain) == 0);
    CHECK(large(scene) > 0);
  }
  SUBCASE("low contrast: the mug's mean colour comes near the table's tone") {
    options.low_contrast = true;
    const LabelledScene scene = make_still_life(options);
    const auto blue_over_red = [](const glm::vec3& c) { return c.b / c.r; };
    CHECK(blue_over_red(mean_colour(plain, 1)) > 0.8f);
    CHECK(blue_over_red(mean_colour(scene, 1)) < 0.6f);
  }
  SUBCASE("contact: mug, apple and orange touch") {
    options.contact = true;
    const LabelledScene scene = make_still_life(options);
    const std::uint8_t mug = 1, apple = 2, orange = 3;
    CHECK(gap(plain, mug, apple) > 0.05f);
    CHECK(gap(plain, apple, orange) > 0.05f);
    CHECK(gap(scene, mug, apple) < 0.02f);
    CHECK(gap(scene, apple, orange) < 0.03f);
  }
  SUBCASE("thin width: the cable lies half as high") {
    options.thin_width_scale = 0.5f;
    const LabelledScene scene = make_still_life(options);
    const auto cable_top = [](const LabelledScene& s) {
      float top = 0;
      for (std::size_t g = 0; g < s.cloud.size(); ++g) {
        const glm::vec3 p = s.cloud.position[g];
        if (s.label[g] == label_of(s, "lamp") && p.z < -0.2f) top = std::max(top, -p.y);
      }
      return top;
    };
    CHECK(cable_top(plain) == doctest::Approx(0.018f).epsilon(0.03));
    CHECK(cable_top(scene) == doctest::Approx(0.009f).epsilon(0.03));
  }
}

TEST_CASE("still life: options outside their range are refused") {
  CHECK_THROWS_AS(make_still_life({.gaussians = 10, .sh_degree = 4}), Error);
  CHECK_THROWS_AS(make_still_life({.gaussians = 10, .thin_width_scale = 0}), Error);
}

TEST_CASE("surface sampler: parts add up, samples are even on a sphere") {
  const std::vector<double> weights{1, 1, 1};
  const std::vector<std::size_t> expected{4, 3, 3};
  CHECK(apportioned(weights, 10) == expected);

  // Archimedes: equal slices of a sphere's height have equal area.
  const PatchShape sphere{.surface =
                              [](float u, float v) {
                                const float a = 6.2831853f * u, b = 3.1415927f * (v - 0.5f);
                                return glm::vec3(std::cos(b) * std::cos(a), std::sin(b),
                                                 std::cos(b) * std::sin(a));
                              },
                          .cells_v = 64};
  CHECK(patch_area(sphere) == doctest::Approx(4 * 3.14159265).epsilon(0.005));
  int slices[10] = {};
  for (const SurfaceSample& s : sample_patch(sphere, 10000, 1, 0))
    ++slices[std::clamp(static_cast<int>((s.position.y + 1) * 5), 0, 9)];
  for (const int count : slices) CHECK(count == doctest::Approx(1000).epsilon(0.04));
}

TEST_CASE("still life: without an object all else stands where it stood, only its shade is gone") {
  StillLifeOptions options = small_table();
  const LabelledScene whole = make_still_life(options);
  options.without = "apple";
  const LabelledScene without = make_still_life(options);
  const std::uint8_t apple = label_of(whole, "apple");
  std::size_t next = 0, lighter = 0;
  for (std::size_t g = 0; g < whole.label.size(); ++g) {
    if (whole.label[g] == apple) continue;
    REQUIRE(next < without.label.size());
    CHECK(without.cloud.position[next] == whole.cloud.position[g]);
    lighter += without.cloud.f_dc[next].r > whole.cloud.f_dc[g].r + 0.1f;
    ++next;
  }
  CHECK(next == without.label.size());
  CHECK(lighter > 20);
  options.without = "pear";
  CHECK_THROWS_AS(make_still_life(options), Error);
}

TEST_CASE("still life: what no camera sees is missing on demand, such as the table under books") {
  StillLifeOptions options = small_table();
  options.hidden_missing = true;
  const LabelledScene seen = make_still_life(options);
  const LabelledScene whole = make_still_life(small_table());
  CHECK(seen.label.size() < whole.label.size());
  CHECK(seen.label.size() > whole.label.size() / 2);
  CHECK(seen.own.size() == seen.label.size());
  glm::vec3 books(0);
  float count = 0;
  for (std::size_t g = 0; g < whole.label.size(); ++g)
    if (whole.label[g] == label_of(whole, "books")) books += whole.cloud.position[g], ++count;
  books /= count;
  const auto below = [&](const LabelledScene& scene) {
    std::size_t low = 0;
    for (std::size_t g = 0; g < scene.label.size(); ++g) {
      const glm::vec3& p = scene.cloud.position[g];
      low += scene.label[g] == 0 && p.y < 0.03f && std::hypot(p.x - books.x, p.z - books.z) < 0.1f;
    }
    return low;
  };
  CHECK(below(whole) > 5);
  CHECK(2 * below(seen) < below(whole));
}
