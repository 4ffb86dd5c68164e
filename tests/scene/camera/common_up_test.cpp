// Up from the cameras of a capture, against captures in which it is known.
#include "scene/camera/common_up.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <random>
#include <vector>

using namespace splatcut;

namespace {

struct Capture {
  int views = 40;
  float arc_deg = 360;
  float pitch_deg = 30;      // how far the cameras look down
  float turn_deg = 0;        // of the pictures about the view axis: 90, 270 for those on their side
  float roll_noise_deg = 3;  // of the hand
  float pitch_noise_deg = 10;
};

const glm::vec3 kUp = glm::normalize(glm::vec3(0.3f, -0.8f, 0.5f));

std::vector<Camera> cameras_of(const Capture& capture, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<float> noise;
  const glm::vec3 east = glm::normalize(glm::cross(kUp, glm::vec3(1, 0, 0))), north = glm::cross(kUp, east);
  std::vector<Camera> cameras;
  for (int i = 0; i < capture.views; ++i) {
    const float azimuth =
        glm::radians(capture.arc_deg) * static_cast<float>(i) / static_cast<float>(capture.views);
    const float pitch = glm::radians(capture.pitch_deg + capture.pitch_noise_deg * noise(random));
    const float roll = glm::radians(capture.turn_deg + capture.roll_noise_deg * noise(random));
    const glm::vec3 level = std::cos(azimuth) * east + std::sin(azimuth) * north;
    const glm::vec3 forward = std::cos(pitch) * level - std::sin(pitch) * kUp;
    const glm::vec3 right = glm::normalize(glm::cross(forward, kUp)), down = glm::cross(forward, right);
    Camera camera;
    const glm::vec3 x = std::cos(roll) * right + std::sin(roll) * down;
    camera.camera_from_world_rotation = glm::transpose(glm::mat3(x, glm::cross(forward, x), forward));
    cameras.push_back(camera);
  }
  return cameras;
}

float error_deg(const Capture& capture, unsigned seed) {
  return glm::degrees(
      std::acos(std::clamp(glm::dot(common_up(cameras_of(capture, seed)), kUp), -1.0f, 1.0f)));
}

}  // namespace

TEST_CASE("common up: circles and arcs of upright pictures and of pictures on their side") {
  for (const float turn_deg : {0.0f, 90.0f, 270.0f})
    for (const float arc_deg : {150.0f, 240.0f, 360.0f})
      for (const float pitch_deg : {15.0f, 30.0f, 50.0f}) {
        CAPTURE(turn_deg);
        CAPTURE(arc_deg);
        CAPTURE(pitch_deg);
        float worst = 0;
        for (unsigned seed = 1; seed <= 20; ++seed)
          worst = std::max(worst, error_deg({40, arc_deg, pitch_deg, turn_deg}, seed));
        CHECK(worst < 5);
      }
}

TEST_CASE("common up: cameras side by side, level ones, few and none") {
  for (const float pitch_deg : {0.0f, 20.0f})
    for (const float arc_deg : {0.0f, 20.0f, 60.0f, 90.0f}) {
      CAPTURE(arc_deg);
      CAPTURE(pitch_deg);
      float worst = 0, worst_side = 0;
      for (unsigned seed = 1; seed <= 20; ++seed) {
        worst = std::max(worst, error_deg({100, arc_deg, pitch_deg}, seed));
        worst_side = std::max(worst_side, error_deg({100, arc_deg, pitch_deg, 270}, seed));
      }
      // Where nothing else is known, pictures are upright, and up leans as far as the cameras look down.
      CHECK(worst < (arc_deg < 60 ? pitch_deg + 5 : 5));
      if (arc_deg >= 60) CHECK(worst_side < 5);
    }
  for (unsigned seed = 1; seed <= 20; ++seed) {
    CHECK(error_deg({100, 360, 0, 0, 6, 5}, seed) < 5);
    CHECK(error_deg({5, 120, 30}, seed) < 40);
    CHECK(error_deg({1, 0, 20, 0, 3, 3}, seed) < 35);
    CHECK(error_deg({60, 360, 88}, seed) < 8);  // from above
  }
  CHECK(common_up({}) == glm::vec3(0, -1, 0));
}
