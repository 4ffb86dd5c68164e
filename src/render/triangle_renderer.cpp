#include "render/triangle_renderer.h"

#include <algorithm>
#include <cstddef>

#include "render/shader_sources.h"

namespace splatcut {

TriangleRenderer::TriangleRenderer() : program_("triangles", kTrianglesVert, kTrianglesFrag) {
  glBindVertexArray(vertex_array_.id());
  glBindBuffer(GL_ARRAY_BUFFER, vertices_.id());
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, indices_.id());
  const auto at = [](std::size_t offset) { return reinterpret_cast<const void*>(offset); };
  constexpr GLsizei kStride = sizeof(TriangleVertex);
  for (GLuint attribute = 0; attribute < 3; ++attribute) glEnableVertexAttribArray(attribute);
  glVertexAttribPointer(0, 2, GL_FLOAT, GL_FALSE, kStride, at(offsetof(TriangleVertex, position_points)));
  glVertexAttribPointer(1, 2, GL_FLOAT, GL_FALSE, kStride, at(offsetof(TriangleVertex, uv)));
  glVertexAttribPointer(2, 4, GL_UNSIGNED_BYTE, GL_TRUE, kStride, at(offsetof(TriangleVertex, colour)));
}

void TriangleRenderer::begin(const glm::vec2& size_points, const glm::vec2& pixels_per_point) {
  size_points_ = size_points;
  pixels_per_point_ = pixels_per_point;
  glViewport(0, 0, static_cast<GLsizei>(size_points.x * pixels_per_point.x),
             static_cast<GLsizei>(size_points.y * pixels_per_point.y));
  glEnable(GL_BLEND);
  glBlendEquation(GL_FUNC_ADD);
  glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
  glDisable(GL_CULL_FACE);
  glDisable(GL_DEPTH_TEST);
  glEnable(GL_SCISSOR_TEST);
  program_.use();
  program_.set("size_points", size_points);
  program_.set("image", 0);
  glActiveTexture(GL_TEXTURE0);
  glBindVertexArray(vertex_array_.id());
}

void TriangleRenderer::draw(const TriangleList& list) {
  glBindBuffer(GL_ARRAY_BUFFER, vertices_.id());
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(list.vertices.size_bytes()), list.vertices.data(),
               GL_STREAM_DRAW);
  glBufferData(GL_ELEMENT_ARRAY_BUFFER, static_cast<GLsizeiptr>(list.indices.size_bytes()),
               list.indices.data(), GL_STREAM_DRAW);
  for (const TriangleBatch& batch : list.batches) {
    const glm::vec4& c = batch.clip_points;
    const auto x0 = static_cast<GLint>(std::max(0.0f, c.x) * pixels_per_point_.x);
    const auto y1 = static_cast<GLint>((size_points_.y - c.w) * pixels_per_point_.y);
    const auto width = static_cast<GLsizei>((c.z - std::max(0.0f, c.x)) * pixels_per_point_.x);
    const auto height = static_cast<GLsizei>((c.w - c.y) * pixels_per_point_.y);
    if (width <= 0 || height <= 0) continue;
    glScissor(x0, y1, width, height);
    glBindTexture(GL_TEXTURE_2D, batch.texture);
    glDrawElementsBaseVertex(GL_TRIANGLES, static_cast<GLsizei>(batch.indices), GL_UNSIGNED_SHORT,
                             reinterpret_cast<const void*>(batch.first_index * sizeof(std::uint16_t)),
                             static_cast<GLint>(batch.first_vertex));
  }
}

}  // namespace splatcut
