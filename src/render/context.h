// OpenGL 3.3 core contexts without a window, for tests and captures, and the function table over any context.
//
// A context is current on the thread that made it. Errors: Error saying which part of the platform refused.
// This header names no GL type: it may be included beside osmesa.h, EGL or GLFW.
#pragma once

#include <memory>
#include <string>

namespace splatcut {

class OffscreenContext {
 public:
  virtual ~OffscreenContext() = default;
  virtual void make_current() = 0;  // and loads the function table
};

// Mesa's software rasteriser in memory; works everywhere.
std::unique_ptr<OffscreenContext> make_osmesa_context();

// EGL without a surface: a GPU where there is one, else Mesa's software rasteriser. There is no default
// framebuffer: draw into one of your own.
std::unique_ptr<OffscreenContext> make_egl_context();

using GlProc = void (*)();
using GlGetProc = GlProc (*)(const char* name);

// Fills the function table for the current context. Throws Error where it is older than 3.3.
void load_gl_functions(GlGetProc get_proc);

// Throws Error where the driver was reset, or the device taken away, so that nothing is drawn any more.
// Contexts that cannot say it are taken for whole. After load_gl_functions().
void refuse_lost_context();

struct GlInfo {
  std::string renderer, version;
  bool software =
      false;  // llvmpipe, softpipe, swrast: drawing splats on it is slower than our CPU rasteriser
};
GlInfo current_gl_info();

}  // namespace splatcut
