// A path on the rest that leads over a neighbourhood and beyond it says something of what it crosses alone.
#include <doctest/doctest.h>

#include <algorithm>
#include <memory>
#include <vector>

#include "segment/session/session.h"
#include "segment/session/stroke_hits.h"

using namespace splatcut;

namespace {

const Box kCell{glm::vec3(-1), glm::vec3(1)};

Camera picture_of_paths() {
  return look_at({0, 0, -3}, {0, 0, 0}, {0, -1, 0}, 0.9f, 320, 240);
}

// Hits of a wall that lies in the cell where `inside` says so of the pixel, else far behind it.
StrokeHits hits_where(const CameraStroke& stroke, const auto& inside) {
  StrokeHits hits;
  for (const glm::vec2& px : sampled(stroke).points_px)
    hits.emplace_back(inside(px) ? glm::vec3(0) : glm::vec3(0, 0, 50));
  return hits;
}

Strokes pieces(const std::vector<glm::vec2>& path, const auto& inside, float radius_px = 2) {
  const CameraStroke said{picture_of_paths(), {SeedLabel::kRest, radius_px, path}};
  return pieces_in(kCell, said, hits_where(said, inside));
}

}  // namespace

TEST_CASE("pieces of a path: what lies outside parts it, and is crossed by no line") {
  const auto low = [](const glm::vec2& px) { return px.y > 100; };
  const std::vector<glm::vec2> arc{{50, 200}, {50, 40}, {250, 40}, {250, 200}};
  const Strokes found = pieces(arc, low);
  REQUIRE(found.size() == 2);
  CHECK(found[0].points_px.front() == arc.front());
  CHECK(found[1].points_px.back() == arc.back());
  for (const Stroke& piece : found) {
    REQUIRE(piece.points_px.size() == 2);
    CHECK(piece.points_px[0].x == piece.points_px[1].x);
    CHECK(std::min(piece.points_px[0].y, piece.points_px[1].y) == doctest::Approx(101).epsilon(0.01));
  }
}

TEST_CASE("pieces of a path: a line between points that lie outside counts where it crosses the cell") {
  const auto middle = [](const glm::vec2& px) { return px.x > 140 && px.x < 180; };
  const Strokes found = pieces({{20, 120}, {300, 120}}, middle);
  REQUIRE(found.size() == 1);
  REQUIRE(found[0].points_px.size() == 2);
  CHECK(found[0].points_px[0].x == doctest::Approx(141).epsilon(0.01));
  CHECK(found[0].points_px[1].x == doctest::Approx(179).epsilon(0.01));
}

TEST_CASE("pieces of a path: one that lies inside is as it was, one that lies outside is none") {
  const std::vector<glm::vec2> path{{20, 120}, {21, 120}, {300, 40}, {300, 40}, {90, 200}};
  const Strokes found = pieces(path, [](const glm::vec2&) { return true; });
  REQUIRE(found.size() == 1);
  CHECK(found[0].points_px == path);
  CHECK(pieces(path, [](const glm::vec2&) { return false; }).empty());
}

TEST_CASE("pieces of a path: one pixel of it is no click, a gap that its width covers is none") {
  const auto spot = [](const glm::vec2& px) { return glm::distance(px, glm::vec2(100, 120)) < 0.4f; };
  const Strokes found = pieces({{20, 120}, {180, 120}}, spot);
  REQUIRE(found.size() == 1);
  CHECK_FALSE(found[0].is_click());
  const auto but_a_gap = [](const glm::vec2& px) { return px.x < 95 || px.x > 105; };
  CHECK(pieces({{20, 120}, {180, 120}}, but_a_gap, 2).size() == 2);
  CHECK(pieces({{20, 120}, {180, 120}}, but_a_gap, 8).size() == 1);
}

TEST_CASE("pieces of a path: a path far out of the picture is sampled within bounds") {
  const CameraStroke said{picture_of_paths(), {SeedLabel::kRest, 2, {{0, 0}, {1e30f, 1e30f}, {-1e38f, 3}}}};
  CHECK(sampled(said).points_px.size() < 20000);
}
