#include <GL/osmesa.h>

#include <vector>

#include "core/error.h"
#include "render/context.h"

namespace splatcut {

namespace {

GlProc get_proc(const char* name) {
  return reinterpret_cast<GlProc>(OSMesaGetProcAddress(name));
}

class OsmesaContext final : public OffscreenContext {
 public:
  OsmesaContext() {
    const int attributes[] = {OSMESA_FORMAT,
                              OSMESA_RGBA,
                              OSMESA_DEPTH_BITS,
                              0,
                              OSMESA_PROFILE,
                              OSMESA_CORE_PROFILE,
                              OSMESA_CONTEXT_MAJOR_VERSION,
                              3,
                              OSMESA_CONTEXT_MINOR_VERSION,
                              3,
                              0};
    context_ = OSMesaCreateContextAttribs(attributes, nullptr);
    if (!context_) throw Error("OSMesa", "cannot make an OpenGL 3.3 core context", "Install libosmesa6");
    OsmesaContext::make_current();
  }
  ~OsmesaContext() override { OSMesaDestroyContext(context_); }
  OsmesaContext(const OsmesaContext&) = delete;
  OsmesaContext& operator=(const OsmesaContext&) = delete;

  void make_current() override {
    if (!OSMesaMakeCurrent(context_, pixels_.data(), GL_UNSIGNED_BYTE, kSide, kSide))
      throw Error("OSMesa", "cannot make its context current");
    load_gl_functions(get_proc);
  }

 private:
  static constexpr int kSide = 16;  // nobody draws into it: frames have framebuffers of their own
  std::vector<unsigned char> pixels_ = std::vector<unsigned char>(4 * kSide * kSide);
  OSMesaContext context_ = nullptr;
};

}  // namespace

std::unique_ptr<OffscreenContext> make_osmesa_context() {
  return std::make_unique<OsmesaContext>();
}

}  // namespace splatcut
