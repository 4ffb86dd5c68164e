// Draws textured, coloured, clipped triangles: what a user interface is made of. Knows no interface library.
// Main thread only, context current.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>

#include "render/gl_objects.h"

namespace splatcut {

struct TriangleVertex {
  glm::vec2 position_points;  // logical points from the top left
  glm::vec2 uv;
  std::array<std::uint8_t, 4> colour;  // straight alpha
};
static_assert(sizeof(TriangleVertex) == 20);

struct TriangleBatch {
  glm::vec4 clip_points{0};  // x0, y0, x1, y1
  GLuint texture = 0;
  std::uint32_t first_index = 0, indices = 0, first_vertex = 0;
};

struct TriangleList {
  std::span<const TriangleVertex> vertices;
  std::span<const std::uint16_t> indices;
  std::span<const TriangleBatch> batches;
};

class TriangleRenderer {
 public:
  TriangleRenderer();

  // Sets the state for lists over the bound framebuffer. size_points: of the whole interface;
  // pixels_per_point: 1, or more on HiDPI screens.
  void begin(const glm::vec2& size_points, const glm::vec2& pixels_per_point);
  void draw(const TriangleList& list);

 private:
  GlProgram program_;
  GlVertexArray vertex_array_;
  GlBuffer vertices_, indices_;
  glm::vec2 size_points_{1}, pixels_per_point_{1};
};

}  // namespace splatcut
