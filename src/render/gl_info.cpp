#include <glad/gl.h>

#include <array>
#include <string_view>

#include "render/context.h"
#include "scene/error.h"

namespace splatcut {

void load_gl_functions(GlGetProc get_proc) {
  // GLADloadfunc has the same shape under another name.
  const int version = gladLoadGL(reinterpret_cast<GLADloadfunc>(get_proc));
  if (version < GLAD_MAKE_VERSION(3, 3))
    throw Error("OpenGL", "is older than 3.3 here", "Update the graphics driver");
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
