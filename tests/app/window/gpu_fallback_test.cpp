// A graphics card that cannot hold the scene, or goes on no longer.
#include <doctest/doctest.h>

#include <new>

#include "hands.h"

using namespace splatcut;
using namespace splatcut::testing;

namespace {

PFNGLGETINTEGERVPROC g_true_limits = nullptr;
void (*g_refusal)(GLint* limit) = nullptr;

void asked_for_limits(GLenum name, GLint* value) {
  if (name == GL_MAX_TEXTURE_BUFFER_SIZE)
    g_refusal(value);
  else
    g_true_limits(name, value);
}

// Until it goes, the driver refuses splats.
class RefusingDriver {
 public:
  explicit RefusingDriver(void (*refusal)(GLint* limit)) {
    g_refusal = refusal;
    g_true_limits = std::exchange(glad_glGetIntegerv, asked_for_limits);
  }
  RefusingDriver(const RefusingDriver&) = delete;
  RefusingDriver& operator=(const RefusingDriver&) = delete;
  ~RefusingDriver() { glad_glGetIntegerv = g_true_limits; }
};

PFNGLCHECKFRAMEBUFFERSTATUSPROC g_true_status = nullptr;

GLenum refused_target(GLenum) {
  return GL_FRAMEBUFFER_UNSUPPORTED;
}

HeadlessApp app_with(RendererChoice renderer) {
  ApplicationOptions options = with_kept_scenes();
  options.renderer = renderer;
  return HeadlessApp(kHandsWidth, kHandsHeight, 1, options);
}

void check_goes_on(void (*refusal)(GLint* limit), const char* reason) {
  HeadlessApp app = app_with(RendererChoice::kGl);
  REQUIRE(app.interface_state().renderer_line.starts_with("OpenGL"));
  const RefusingDriver driver(refusal);
  app.open(kSmallSample);
  REQUIRE(app.settle());
  CHECK(app.interface_state().renderer_line.starts_with("CPU renderer"));
  REQUIRE_FALSE(app.studio().messages().empty());
  CAPTURE(app.studio().messages().back().text);
  CHECK(app.studio().messages().back().text.find(reason) != std::string::npos);
  app.click(app.screen_of(kOnApple));
  REQUIRE(app.settle());
  CHECK(app.studio().gaussians_of(app.studio().document().active) > 0);
  const Image<Rgb8> shown = app.picture();
  const UiRect area = app->interface().viewport();
  const glm::ivec2 middle(0.5f * (area.min + area.max));
  CHECK(shown.at(middle.x, middle.y) != shown.at(static_cast<int>(area.min.x) + 3, middle.y));
}

}  // namespace

TEST_CASE("gpu fallback: a scene larger than the driver's buffers is drawn by the CPU, and work goes on") {
  check_goes_on([](GLint* limit) { *limit = 100; }, "Gaussians are more than");
}

TEST_CASE("gpu fallback: so is one whose copies have no room") {
  check_goes_on([](GLint*) { throw std::bad_alloc(); }, "not enough memory");
}

TEST_CASE(
    "gpu fallback: a driver that refuses its target is said to do so, not that the scene is too large") {
  HeadlessApp app = app_with(RendererChoice::kGl);
  REQUIRE(app.interface_state().renderer_line.starts_with("OpenGL"));
  g_true_status = std::exchange(glad_glCheckFramebufferStatus, refused_target);
  app.open(kSmallSample);
  const bool settled = app.settle();
  glad_glCheckFramebufferStatus = g_true_status;
  REQUIRE(settled);
  CAPTURE(app.interface_state().renderer_line);
  CHECK(app.interface_state().renderer_line.starts_with("CPU renderer (OpenGL: refuses a "));
  REQUIRE_FALSE(app.studio().messages().empty());
  CAPTURE(app.studio().messages().back().text);
  CHECK(
      app.studio().messages().back().text.starts_with("The graphics card cannot go on (OpenGL: refuses a "));
}
