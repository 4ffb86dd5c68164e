#include <glad/gl.h>

#include <array>
#include <string_view>
#include <utility>

#include "core/error.h"
#include "render/context.h"

namespace splatcut {

namespace {

using GetResetStatus = GLenum (*)();
GetResetStatus g_reset_status = nullptr;

bool has_extension(std::string_view name) {
  GLint count = 0;
  glGetIntegerv(GL_NUM_EXTENSIONS, &count);
  for (GLint i = 0; i < count; ++i)
    if (name == reinterpret_cast<const char*>(glGetStringi(GL_EXTENSIONS, static_cast<GLuint>(i))))
      return true;
  return false;
}

// By extension and not by address alone: some platforms give an address for any name.
GetResetStatus reset_status_of(GlGetProc get_proc) {
  for (const auto& [extension, name] : {std::pair("GL_KHR_robustness", "glGetGraphicsResetStatus"),
                                        std::pair("GL_ARB_robustness", "glGetGraphicsResetStatusARB")})
    if (has_extension(extension))
      if (const GlProc proc = get_proc(name)) return reinterpret_cast<GetResetStatus>(proc);
  return nullptr;
}

}  // namespace

void load_gl_functions(GlGetProc get_proc) {
  // GLADloadfunc has the same shape under another name.
  const int version = gladLoadGL(reinterpret_cast<GLADloadfunc>(get_proc));
  if (version < GLAD_MAKE_VERSION(3, 3))
    throw Error("OpenGL", "is older than 3.3 here", "Update the graphics driver");
  g_reset_status = reset_status_of(get_proc);
}

void refuse_lost_context() {
  if (g_reset_status && g_reset_status() != GL_NO_ERROR)
    throw Error(
        "OpenGL", "the graphics driver was reset, and the window with it",
        "Start again: your work is offered as it was saved last. --renderer cpu asks less of the driver");
}

GlInfo current_gl_info() {
  const auto text = [](GLenum name) {
    const GLubyte* value = glGetString(name);
    return std::string(value ? reinterpret_cast<const char*>(value) : "unknown");
  };
  GlInfo info{text(GL_RENDERER), text(GL_VERSION), false};
  constexpr std::array<std::string_view, 4> kSoftware = {"llvmpipe", "softpipe", "swrast", "SwiftShader"};
  for (const std::string_view name : kSoftware)
    info.software |= info.renderer.find(name) != std::string::npos;
  return info;
}

}  // namespace splatcut
