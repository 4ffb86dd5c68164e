#include "render/gl_objects.h"

#include <fmt/format.h>

#include <cassert>
#include <string>

#include "core/error.h"

namespace splatcut {

GLuint BufferTraits::make() {
  GLuint id = 0;
  glGenBuffers(1, &id);
  return id;
}
void BufferTraits::destroy(GLuint id) {
  glDeleteBuffers(1, &id);
}

GLuint TextureTraits::make() {
  GLuint id = 0;
  glGenTextures(1, &id);
  return id;
}
void TextureTraits::destroy(GLuint id) {
  glDeleteTextures(1, &id);
}

GLuint VertexArrayTraits::make() {
  GLuint id = 0;
  glGenVertexArrays(1, &id);
  return id;
}
void VertexArrayTraits::destroy(GLuint id) {
  glDeleteVertexArrays(1, &id);
}

GLuint FramebufferTraits::make() {
  GLuint id = 0;
  glGenFramebuffers(1, &id);
  return id;
}
void FramebufferTraits::destroy(GLuint id) {
  glDeleteFramebuffers(1, &id);
}

namespace {

GLuint compiled(const char* name, GLenum kind, const char* source) {
  const GLuint shader = glCreateShader(kind);
  glShaderSource(shader, 1, &source, nullptr);
  glCompileShader(shader);
  GLint good = 0;
  glGetShaderiv(shader, GL_COMPILE_STATUS, &good);
  if (good) return shader;
  std::string log(4096, '\0');
  GLsizei length = 0;
  glGetShaderInfoLog(shader, static_cast<GLsizei>(log.size()), &length, log.data());
  glDeleteShader(shader);
  log.resize(static_cast<std::size_t>(length));
  throw Error(fmt::format("shader {}", name), "does not compile on this driver: " + log,
              "Start with --renderer cpu");
}

}  // namespace

GlProgram::GlProgram(const char* name, const char* vertex_source, const char* fragment_source) {
  const GLuint vertex = compiled(name, GL_VERTEX_SHADER, vertex_source);
  const GLuint fragment = compiled(name, GL_FRAGMENT_SHADER, fragment_source);
  id_ = glCreateProgram();
  glAttachShader(id_, vertex);
  glAttachShader(id_, fragment);
  glLinkProgram(id_);
  glDeleteShader(vertex);
  glDeleteShader(fragment);
  GLint good = 0;
  glGetProgramiv(id_, GL_LINK_STATUS, &good);
  if (good) return;
  glDeleteProgram(id_);
  throw Error(fmt::format("shader {}", name), "does not link on this driver", "Start with --renderer cpu");
}

void TexelBuffer::upload(GLenum format, std::span<const std::byte> bytes, GLenum usage) {
  glBindBuffer(GL_TEXTURE_BUFFER, buffer_.id());
  glBufferData(GL_TEXTURE_BUFFER, static_cast<GLsizeiptr>(bytes.size()), bytes.data(), usage);
  glBindTexture(GL_TEXTURE_BUFFER, texture_.id());
  glTexBuffer(GL_TEXTURE_BUFFER, format, buffer_.id());
}

void TexelBuffer::bind(int unit) const {
  glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
  glBindTexture(GL_TEXTURE_BUFFER, texture_.id());
}

void PictureTexture::upload(std::span<const std::byte> rgba, int width, int height) {
  assert(rgba.size() == 4 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  glActiveTexture(GL_TEXTURE0);
  glBindTexture(GL_TEXTURE_2D, texture_.id());
  glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
  if (width == width_ && height == height_) {
    glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE, rgba.data());
    return;
  }
  glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, width, height, 0, GL_RGBA, GL_UNSIGNED_BYTE, rgba.data());
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  width_ = width;
  height_ = height;
}

void RenderTarget::resize(int width, int height, std::span<const GLenum> formats) {
  assert(!formats.empty() && formats.size() <= 3);
  if (width == width_ && height == height_) return;
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.id());
  glActiveTexture(GL_TEXTURE0);
  const GLenum attachments[] = {GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1, GL_COLOR_ATTACHMENT2};
  for (std::size_t i = 0; i < formats.size(); ++i) {
    glBindTexture(GL_TEXTURE_2D, textures_[i].id());
    glTexImage2D(GL_TEXTURE_2D, 0, static_cast<GLint>(formats[i]), width, height, 0, GL_RGBA, GL_FLOAT,
                 nullptr);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    glFramebufferTexture2D(GL_FRAMEBUFFER, attachments[i], GL_TEXTURE_2D, textures_[i].id(), 0);
  }
  glDrawBuffers(static_cast<GLsizei>(formats.size()), attachments);
  if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
    throw Error("OpenGL", fmt::format("refuses a {} x {} render target", width, height),
                "Start with --renderer cpu");
  width_ = width;
  height_ = height;
}

void RenderTarget::bind() const {
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.id());
  glViewport(0, 0, width_, height_);
}

}  // namespace splatcut
