// The grid on the ground: where it lies, how wide its cells are, what hides it.
#include "app/picture/ground_grid.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <glm/gtc/quaternion.hpp>

using namespace splatcut;

namespace {

constexpr glm::vec3 kUp(0, -1, 0);
constexpr float kFloorY = 1.5f, kHalfRoom = 4;

void add(GaussianCloud* cloud, const glm::vec3& at, const glm::vec3& scale) {
  cloud->position.push_back(at);
  cloud->scale.push_back(scale);
  cloud->rotation.emplace_back(1, 0, 0, 0);
  cloud->opacity.push_back(0.95f);
  cloud->f_dc.emplace_back(0);
  cloud->file_row.push_back(static_cast<std::uint32_t>(cloud->file_row.size()));
}

// A floor of flat splats, a block of 1 x 1 x 1 in the middle of it, a few floaters far below.
GaussianCloud room() {
  GaussianCloud cloud;
  for (int x = -40; x <= 40; ++x)
    for (int z = -40; z <= 40; ++z)
      add(&cloud, {0.1f * static_cast<float>(x), kFloorY, 0.1f * static_cast<float>(z)},
          {0.06f, 0.001f, 0.06f});
  for (int i = 0; i < 60; ++i) add(&cloud, {0.1f * static_cast<float>(i % 7), 2.5f, 0}, glm::vec3(0.02f));
  for (int x = -10; x <= 10; ++x)
    for (int y = 0; y <= 20; ++y)
      for (int z = -10; z <= 10; ++z)
        if (std::abs(x) == 10 || std::abs(z) == 10 || y == 20)
          add(&cloud,
              {0.05f * static_cast<float>(x), kFloorY - 0.05f * static_cast<float>(y),
               0.05f * static_cast<float>(z)},
              glm::vec3(0.03f));
  return cloud;
}

Box bounds_of_room() {
  return {{-kHalfRoom, 0.5f, -kHalfRoom}, {kHalfRoom, 3, kHalfRoom}};
}

}  // namespace

TEST_CASE("grid: cells are 1, 2 or 5 times a power of ten") {
  CHECK(round_length_below(1) == doctest::Approx(1));
  CHECK(round_length_below(1.99f) == doctest::Approx(1));
  CHECK(round_length_below(2) == doctest::Approx(2));
  CHECK(round_length_below(4.9f) == doctest::Approx(2));
  CHECK(round_length_below(5) == doctest::Approx(5));
  CHECK(round_length_below(99) == doctest::Approx(50));
  CHECK(round_length_below(0.07f) == doctest::Approx(0.05));
  CHECK(round_length_below(3e-9f) == doctest::Approx(2e-9));
}

TEST_CASE("grid: it lies on the floor, whatever floats below, along the world's axes") {
  const GaussianCloud cloud = room();
  CHECK(ground_height(cloud, bounds_of_room(), kUp) == doctest::Approx(-kFloorY));
  const GroundGrid grid = ground_grid(cloud, bounds_of_room(), kUp);
  CHECK(grid.axis[0] == 0);
  CHECK(grid.axis[1] == 2);
  for (int i = 0; i < 2; ++i) {
    CHECK(glm::dot(grid.along_world[i], kUp) == doctest::Approx(0));
    CHECK(grid.first[i] <= -std::lround(kHalfRoom / grid.cell));
    CHECK(grid.last[i] >= std::lround(kHalfRoom / grid.cell));
    CHECK(grid.last[i] - grid.first[i] >= 10);
    CHECK(grid.last[i] - grid.first[i] <= 24);
  }
}

TEST_CASE("grid: for scenes of every size and any up, ten to some twenty cells, square to up") {
  const GaussianCloud cloud = room();
  for (const float scale : {1e-4f, 0.3f, 1.0f, 1.7f, 4.0f, 9.0f, 1e5f})
    for (const glm::vec3& up : {kUp, glm::vec3(0, 0, 1), glm::normalize(glm::vec3(0.3f, -1, 0.2f))}) {
      CAPTURE(scale);
      GaussianCloud scaled = cloud;
      for (glm::vec3& p : scaled.position) p *= scale;
      for (glm::vec3& s : scaled.scale) s *= scale;
      const Box box{scale * bounds_of_room().min, scale * bounds_of_room().max};
      const GroundGrid grid = ground_grid(scaled, box, up);
      CHECK(glm::dot(grid.along_world[0], grid.along_world[1]) == doctest::Approx(0).epsilon(1e-4));
      CHECK(std::abs(glm::dot(grid.along_world[1], up)) < 1e-5f);
      CHECK(grid.last.x - grid.first.x >= 10);
      CHECK(grid.last.x - grid.first.x <= 24);
    }
}

TEST_CASE("grid: a block hides what lies behind it and under it, the axes run through the origin") {
  const auto cloud = std::make_shared<const GaussianCloud>(room());
  const GroundGrid grid = ground_grid(*cloud, bounds_of_room(), kUp);
  const Camera camera = look_at({0, -2.5f, -5}, {0, kFloorY, 0}, kUp, 0.9f, 320, 240);
  const DrawLimits limits{.near_plane = 0.05f};
  const std::vector<GridPiece> all = pieces_in_view(grid, camera, limits, {nullptr, 0});
  FrameResult picture;
  picture.frames.push_back(raster_frame(*cloud, camera, nullptr, limits));
  const std::vector<GridPiece> seen = pieces_in_view(grid, camera, limits, {&picture, 0});
  const auto length_within = [](const std::vector<GridPiece>& pieces, const glm::vec2& low,
                                const glm::vec2& high) {
    float length = 0;
    for (const GridPiece& piece : pieces) {
      const glm::vec2 middle = 0.5f * (piece.from_px + piece.to_px);
      if (glm::all(glm::greaterThan(middle, low)) && glm::all(glm::lessThan(middle, high)))
        length += glm::distance(piece.from_px, piece.to_px);
    }
    return length;
  };
  const auto pixel_of = [&](const glm::vec3& p) {
    return camera.pixel_from_camera(camera.camera_from_world(p));
  };
  // Well inside of the block's front.
  const glm::vec2 low = pixel_of({-0.35f, kFloorY - 0.85f, -0.5f}),
                  high = pixel_of({0.35f, kFloorY - 0.2f, -0.5f});
  CHECK(length_within(all, low, high) > 20);
  CHECK(length_within(seen, low, high) == 0);
  // Before the block the floor hides nothing of it.
  const glm::vec2 left = pixel_of({-1.5f, kFloorY, -0.8f}), right = pixel_of({1.5f, kFloorY, -2});
  const glm::vec2 low_floor = glm::min(left, right), high_floor = glm::max(left, right);
  CHECK(length_within(all, low_floor, high_floor) > 100);
  CHECK(length_within(seen, low_floor, high_floor) == length_within(all, low_floor, high_floor));

  const glm::vec2 origin = pixel_of({0, kFloorY, 0});
  std::size_t axes[3] = {0, 0, 0};
  for (const GridPiece& piece : all) {
    CHECK(piece.opacity > 0);
    CHECK(piece.opacity <= 1);
    if (!piece.axis) continue;
    ++axes[*piece.axis];
    const glm::vec2 along = glm::normalize(piece.to_px - piece.from_px), to_origin = origin - piece.from_px;
    CHECK(std::abs(along.x * to_origin.y - along.y * to_origin.x) < 0.5f);
  }
  CHECK(axes[0] > 0);
  CHECK(axes[1] == 0);
  CHECK(axes[2] > 0);
}

TEST_CASE("grid: nothing of it lies before the near plane, and it fades to its border") {
  const GaussianCloud cloud = room();
  const GroundGrid grid = ground_grid(cloud, bounds_of_room(), kUp);
  // From within the plane of the ground's middle, low above it: lines run behind the eye.
  const Camera camera = look_at({0.1f, kFloorY - 0.8f, 0.1f}, {2, kFloorY, 1.5f}, kUp, 0.9f, 320, 240);
  for (const GridPiece& piece :
       pieces_in_view(as_seen_by(grid, camera), camera, {.near_plane = 0.3f}, {nullptr, 0}))
    for (const glm::vec2& p : {piece.from_px, piece.to_px}) {
      CHECK(p.x >= -0.5f);
      CHECK(p.x <= 320.5f);
      CHECK(p.y >= -0.5f);
      CHECK(p.y <= 240.5f);
    }
  const Camera above = look_at({0, -20, 0.01f}, {0, kFloorY, 0}, kUp, 0.9f, 640, 640);
  float in_middle = 0, at_border = 0;
  for (const GridPiece& piece : pieces_in_view(grid, above, {}, {nullptr, 0})) {
    const float away = glm::distance(0.5f * (piece.from_px + piece.to_px), glm::vec2(320));
    if (away < 60) in_middle = std::max(in_middle, piece.opacity);
    if (away > 140) at_border = std::max(at_border, piece.opacity);
  }
  CHECK(in_middle > 0.9f);
  CHECK(at_border < 0.75f);
}

TEST_CASE("grid: near the ground the cells are smaller, before the eye") {
  const GaussianCloud cloud = room();
  const GroundGrid grid = ground_grid(cloud, bounds_of_room(), kUp);
  const Camera far = look_at({0, -20, -8}, {0, kFloorY, 0}, kUp, 0.9f, 320, 240);
  CHECK(as_seen_by(grid, far).cell == grid.cell);
  const Camera near = look_at({0, kFloorY - 0.5f, -2}, {0, kFloorY, 0}, kUp, 0.9f, 320, 240);
  const GroundGrid finer = as_seen_by(grid, near);
  CHECK(finer.cell == doctest::Approx(0.2));
  const glm::vec2 middle = 0.5f * glm::vec2(finer.first + finer.last) * finer.cell;
  CHECK(middle.y > -2);  // z of the world: ahead of the eye
  CHECK(std::abs(middle.x) < 0.3f);
}

TEST_CASE("grid: around a thing that stands alone it shows on the height of the foot") {
  GaussianCloud cloud;  // a column of 1 x 3 x 1 on two feet
  for (int x = -20; x <= 20; ++x)
    for (int z = -20; z <= 20; ++z)
      for (int y = 0; y <= 60; ++y) {
        const bool side = std::abs(x) == 20 || std::abs(z) == 20 || y == 60, foot = y < 6;
        if (!side || (foot && std::abs(x) < 12)) continue;
        add(&cloud,
            {0.025f * static_cast<float>(x), kFloorY - 0.05f * static_cast<float>(y),
             0.025f * static_cast<float>(z)},
            glm::vec3(0.02f));
      }
  const Box bounds = framed_bounds(cloud);
  CHECK(ground_height(cloud, bounds, kUp) == doctest::Approx(-kFloorY).epsilon(0.03));
  const GroundGrid grid = ground_grid(cloud, bounds, kUp);
  const Camera camera = look_at({1, -1.5f, -6}, {0, 0, 0}, kUp, 0.9f, 320, 240);
  const DrawLimits limits{.near_plane = 0.05f};
  FrameResult picture;
  picture.frames.push_back(raster_frame(cloud, camera, nullptr, limits));
  const Image<float>& depth = picture.frames[0]->depth;
  float beside = 0;
  for (const GridPiece& piece : pieces_in_view(as_seen_by(grid, camera), camera, limits, {&picture, 0})) {
    const glm::ivec2 at(0.5f * (piece.from_px + piece.to_px));
    if (depth.contains(at.x, at.y) && !(depth.at(at.x, at.y) > 0))
      beside += piece.opacity * glm::distance(piece.from_px, piece.to_px);
  }
  CAPTURE(beside);
  CHECK(beside > 1000);
}
