// Move-only owners of OpenGL objects. All need the context that made them to be current, destruction
// included.
#pragma once

#include <glad/gl.h>

#include <cstddef>
#include <glm/glm.hpp>
#include <span>
#include <utility>

namespace splatcut {

// Traits: `static GLuint make()` and `static void destroy(GLuint)`.
template <class Traits>
class GlHandle {
 public:
  GlHandle() : id_(Traits::make()) {}
  GlHandle(GlHandle&& other) noexcept : id_(std::exchange(other.id_, 0)) {}
  GlHandle& operator=(GlHandle&& other) noexcept {
    std::swap(id_, other.id_);
    return *this;
  }
  ~GlHandle() {
    if (id_) Traits::destroy(id_);
  }
  GLuint id() const { return id_; }

 private:
  GLuint id_;
};

struct BufferTraits {
  static GLuint make();
  static void destroy(GLuint id);
};
struct TextureTraits {
  static GLuint make();
  static void destroy(GLuint id);
};
struct VertexArrayTraits {
  static GLuint make();
  static void destroy(GLuint id);
};
struct FramebufferTraits {
  static GLuint make();
  static void destroy(GLuint id);
};
using GlBuffer = GlHandle<BufferTraits>;
using GlTexture = GlHandle<TextureTraits>;
using GlVertexArray = GlHandle<VertexArrayTraits>;
using GlFramebuffer = GlHandle<FramebufferTraits>;

// A linked program. Throws Error with the driver's own words where a shader does not compile.
class GlProgram {
 public:
  GlProgram(const char* name, const char* vertex_source, const char* fragment_source);
  GlProgram(const GlProgram&) = delete;
  GlProgram& operator=(const GlProgram&) = delete;
  ~GlProgram() { glDeleteProgram(id_); }

  void use() const { glUseProgram(id_); }
  void set(const char* uniform, int value) const { glUniform1i(location(uniform), value); }
  void set(const char* uniform, float value) const { glUniform1f(location(uniform), value); }
  void set(const char* uniform, const glm::vec2& value) const {
    glUniform2f(location(uniform), value.x, value.y);
  }
  void set(const char* uniform, const glm::vec3& value) const {
    glUniform3f(location(uniform), value.x, value.y, value.z);
  }
  void set(const char* uniform, const glm::mat3& value) const {
    glUniformMatrix3fv(location(uniform), 1, GL_FALSE, &value[0][0]);
  }

 private:
  GLint location(const char* uniform) const { return glGetUniformLocation(id_, uniform); }
  GLuint id_;
};

// A buffer that shaders read as texels.
class TexelBuffer {
 public:
  // format: sized internal format of the texels, such as GL_RGBA32F.
  void upload(GLenum format, std::span<const std::byte> bytes, GLenum usage);
  void bind(int unit) const;

 private:
  GlBuffer buffer_;
  GlTexture texture_;
};

// An RGBA8 picture that the interface can show. Filtered linearly, clamped at the border.
class PictureTexture {
 public:
  // rgba: width * height pixels, top row first.
  void upload(std::span<const std::byte> rgba, int width, int height);
  GLuint id() const { return texture_.id(); }

 private:
  GlTexture texture_;
  int width_ = 0, height_ = 0;
};

// Colour attachments of one size.
class RenderTarget {
 public:
  // formats: one sized internal format for each attachment, at most 3. Throws Error where the driver refuses.
  void resize(int width, int height, std::span<const GLenum> formats);
  void bind() const;  // and sets the viewport
  GLuint texture(int attachment) const { return textures_[attachment].id(); }
  int width() const { return width_; }
  int height() const { return height_; }

 private:
  GlFramebuffer framebuffer_;
  GlTexture textures_[3];
  int width_ = 0, height_ = 0;
};

}  // namespace splatcut
