// Ground that an object hid from every view: a tin on a table, by geometry.
#include "segment/finish/unseen_ground.h"

#include <doctest/doctest.h>
#include <tbb/task_arena.h>

#include <cmath>
#include <glm/gtc/constants.hpp>

#include "scene/raster/splat_math.h"
#include "segment/superpoints/orbit.h"

using namespace splatcut;

namespace {

constexpr float kRadius = 0.5f, kHeight = 0.6f;

// A tin on a table.
struct Tin {
  GaussianCloud cloud;
  std::vector<std::uint8_t> labels;
  std::vector<Camera> cameras;

  // 24 cameras at that elevation, over so many degrees around.
  explicit Tin(float elevation_deg, float around_deg = 360) {
    constexpr int kOnTin = 4000, kSide = 120, kCameras = 24;
    constexpr float kGolden = 2.399963f, kTable = 5;
    for (int i = 0; i < kOnTin; ++i) {  // the wall and the lid
      const float share = (static_cast<float>(i) + 0.5f) / kOnTin, turn = kGolden * static_cast<float>(i);
      const glm::vec3 rim(kRadius * std::cos(turn), 0, kRadius * std::sin(turn));
      add(rim - glm::vec3(0, kHeight * share, 0), {0.8f, 0.2f, 0.1f}, 1);
      add(std::sqrt(share) * rim - glm::vec3(0, kHeight, 0), {0.7f, 0.7f, 0.1f}, 1);
    }
    for (int i = 0; i < kSide; ++i)
      for (int j = 0; j < kSide; ++j) {
        const auto at = [&](int k) { return kTable * ((static_cast<float>(k) + 0.5f) / kSide - 0.5f); };
        add({at(i), 0, at(j)}, {0.3f, 0.4f, (i + j) % 2 == 0 ? 0.5f : 0.6f}, 0);
      }
    for (int c = 0; c < kCameras; ++c) {
      const float turn = glm::radians(around_deg) * static_cast<float>(c) / kCameras,
                  e = glm::radians(elevation_deg);
      const glm::vec3 away(std::cos(e) * std::cos(turn), -std::sin(e), std::cos(e) * std::sin(turn));
      cameras.push_back(look_at(20.0f * away, {0, 0, 0}, {0, -1, 0}, glm::radians(10.0f), 640, 640));
    }
  }

  UnseenGround ground() const { return unseen_ground(cloud, labels, {0, -1, 0}, cameras, {}); }

 private:
  void add(const glm::vec3& position, const glm::vec3& colour, std::uint8_t label) {
    cloud.file_row.push_back(static_cast<std::uint32_t>(cloud.position.size()));
    cloud.position.push_back(position);
    cloud.scale.emplace_back(label ? 0.015f : 0.025f);
    cloud.rotation.emplace_back(1, 0, 0, 0);
    cloud.opacity.push_back(0.99f);
    cloud.f_dc.push_back((colour - 0.5f) / kShC0);
    labels.push_back(label);
  }
};

}  // namespace

TEST_CASE(
    "ground that nobody saw: of a tin seen from all around its own footprint, from one side its shadow, "
    "too") {
  constexpr double kFootprint = M_PI * static_cast<double>(kRadius * kRadius);
  for (const float elevation : {35.0f, 50.0f}) {
    CAPTURE(elevation);
    const UnseenGround around = Tin(elevation).ground(), one_side = Tin(elevation, 1).ground();
    REQUIRE(around.why_not.empty());
    REQUIRE(one_side.why_not.empty());
    const double shadow =
        kFootprint + static_cast<double>(2 * kRadius * kHeight / std::tan(glm::radians(elevation)));
    MESSAGE(around.area, " of ", kFootprint, ", ", one_side.area, " of ", shadow);
    CHECK(around.area == doctest::Approx(kFootprint).epsilon(0.15));
    CHECK(one_side.area == doctest::Approx(shadow).epsilon(0.15));
    for (const auto& [from, to] : around.outline_world) {
      CHECK(std::abs(from.y) < 0.05f);
      CHECK(glm::length(from) == doctest::Approx(kRadius).epsilon(0.25));
      CHECK(glm::length(to - from) < 0.1f);
    }
  }
}

TEST_CASE("ground that nobody saw: a camera below the table shows none of it") {
  Tin tin(45);
  const double from_above = tin.ground().area;
  REQUIRE(from_above > 0);
  for (const float aside : {0.0f, 0.4f}) {  // the table's lower side, and through it as a single layer
    Tin with_one_below = tin;
    with_one_below.cameras[0] = look_at({aside, 20, 4}, {0, 0, 0}, {0, 0, -1}, glm::radians(10.0f), 640, 640);
    CHECK(with_one_below.ground().area == doctest::Approx(from_above).epsilon(0.1));
  }
}

TEST_CASE("ground that nobody saw: none where nothing flat touches the object") {
  Tin tin(45);
  for (std::size_t g = 0; g < tin.labels.size(); ++g)
    if (tin.labels[g]) tin.cloud.position[g].y -= 2;
  const UnseenGround ground = tin.ground();
  CHECK_FALSE(ground.why_not.empty());
  CHECK(ground.area == 0);
  CHECK(ground.outline_world.empty());
}

TEST_CASE(
    "ground that nobody saw: what a view sees through is not hidden, and none is known where all around is") {
  const auto on_plinth = [](float share) {  // of the tin's radius
    Tin tin(45);
    for (std::size_t g = 0; g < tin.labels.size(); ++g) {
      glm::vec3& at = tin.cloud.position[g];
      if (!tin.labels[g] && std::hypot(at.x, at.z) > share * kRadius) at.y += 0.3f;
    }
    return tin.ground();
  };
  const UnseenGround wide = on_plinth(1.22f), narrow = on_plinth(1.12f);
  REQUIRE(wide.why_not.empty());
  CHECK(wide.area == doctest::Approx(M_PI * static_cast<double>(kRadius * kRadius)).epsilon(0.15));
  CHECK(narrow.why_not == "what it stands on is not flat around it");
  CHECK(narrow.area == 0);
  CHECK(narrow.outline_world.empty());
}

TEST_CASE("ground that nobody saw: the same on one thread and on four") {
  const Tin tin(45);
  UnseenGround one, four;
  tbb::task_arena(1).execute([&] { one = tin.ground(); });
  tbb::task_arena(4).execute([&] { four = tin.ground(); });
  CHECK(one.area > 0);
  CHECK(one.outline_world == four.outline_world);
}
