#include "app/window/window.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <optional>
#include <utility>
#include <vector>

#include "app/console/console.h"
#include "app/console/user_folders.h"
#include "app/document/words.h"
#include "app/window/file_drag.h"
#include "app/window/frame_log.h"
#include "app/window/printed_key.h"
#include "app/window/settings.h"
#include "app/window/window_place.h"
#include "core/atomic_file.h"
#include "core/error.h"

namespace splatcut {

namespace {

std::string last_glfw_error() {
  const char* text = nullptr;
  glfwGetError(&text);
  return text ? text : "no reason given";
}

struct Glfw {
  Glfw() { start(); }
  static void start() {
    if (!glfwInit())
      throw Error("window", "cannot be opened: " + last_glfw_error(),
                  "Is there a display? Without one, use splatcut cut");
  }
  ~Glfw() { glfwTerminate(); }
  Glfw(const Glfw&) = delete;
  Glfw& operator=(const Glfw&) = delete;
};

std::vector<Screen> screens() {
  int count = 0;
  GLFWmonitor** monitors = glfwGetMonitors(&count);  // the primary one first
  std::vector<Screen> out(static_cast<std::size_t>(count));
  for (std::size_t i = 0; i < out.size(); ++i) {
    glfwGetMonitorWorkarea(monitors[i], &out[i].at.x, &out[i].at.y, &out[i].size.x, &out[i].size.y);
    glfwGetMonitorContentScale(monitors[i], &out[i].scale.x, &out[i].scale.y);
  }
  return out;
}

// As asked for, else as remembered, else as large on every screen.
WindowPlace place_of(const WindowOptions& options, const Settings& settings) {
  const glm::ivec2 size(options.width > 0 ? options.width : settings.width,
                        options.height > 0 ? options.height : settings.height);
  if (options.width > 0 || options.height > 0) return {size, {}};
  const Settings usual;
  const bool first_start =
      settings.width == usual.width && settings.height == usual.height && !settings.position;
  return fitting({size, settings.position, settings.maximized, first_start}, screens());
}

// Null where there is no OpenGL 3.3 by that interface.
GLFWwindow* hidden_window(const WindowPlace& place, int interface_to_gl) {
  glfwDefaultWindowHints();
  glfwWindowHint(GLFW_SCALE_TO_MONITOR, place.scaled);
  glfwWindowHint(GLFW_MAXIMIZED, place.maximized);
  glfwWindowHint(GLFW_VISIBLE, GLFW_FALSE);
  glfwWindowHint(GLFW_CONTEXT_CREATION_API, interface_to_gl);
  glfwWindowHint(GLFW_CONTEXT_ROBUSTNESS, GLFW_LOSE_CONTEXT_ON_RESET);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
  glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
  glfwWindowHint(GLFW_OPENGL_FORWARD_COMPAT, GLFW_TRUE);
  glfwWindowHintString(GLFW_X11_CLASS_NAME, "splatcut");
  return glfwCreateWindow(place.size.x, place.size.y, "splatcut", nullptr, nullptr);
}

// By the driver, by EGL where the display has no GLX, then by Mesa's software, which has 3.3 where an old
// card has not.
GLFWwindow* hidden_window(const WindowPlace& place) {
  std::string first_reason;
  for (const bool software : {false, true}) {
    if (software) {
      glfwTerminate();  // what is loaded for a display stays until then
      ::setenv("LIBGL_ALWAYS_SOFTWARE", "1", 1);
      ::setenv("__GLX_VENDOR_LIBRARY_NAME", "mesa", 1);
      ::unsetenv("MESA_GL_VERSION_OVERRIDE");
      Glfw::start();
    }
    for (const int interface_to_gl : {GLFW_NATIVE_CONTEXT_API, GLFW_EGL_CONTEXT_API}) {
      if (GLFWwindow* window = hidden_window(place, interface_to_gl)) {
        if (software) warn("OpenGL is Mesa's software: " + first_reason, false);
        return window;
      }
      if (first_reason.empty()) first_reason = last_glfw_error();
    }
  }
  throw Error("window", "no OpenGL 3.3: " + first_reason, "Install a driver, or Mesa's libgl1-mesa-dri");
}

struct GlfwWindow {
  explicit GlfwWindow(const WindowPlace& place) : handle(hidden_window(place)) {
    if (place.position) glfwSetWindowPos(handle, place.position->x, place.position->y);
    glfwShowWindow(handle);
    glfwMakeContextCurrent(handle);
    load_gl_functions(glfwGetProcAddress);
    glfwSwapInterval(1);
  }
  ~GlfwWindow() { glfwDestroyWindow(handle); }
  GlfwWindow(const GlfwWindow&) = delete;
  GlfwWindow& operator=(const GlfwWindow&) = delete;
  GLFWwindow* handle;
};

Modifiers modifiers_of(int mods) {
  return {(mods & GLFW_MOD_SHIFT) != 0, (mods & GLFW_MOD_CONTROL) != 0, (mods & GLFW_MOD_ALT) != 0};
}

Modifiers held_modifiers(GLFWwindow* window) {
  const auto held = [window](int a, int b) {
    return glfwGetKey(window, a) == GLFW_PRESS || glfwGetKey(window, b) == GLFW_PRESS;
  };
  return {held(GLFW_KEY_LEFT_SHIFT, GLFW_KEY_RIGHT_SHIFT),
          held(GLFW_KEY_LEFT_CONTROL, GLFW_KEY_RIGHT_CONTROL), held(GLFW_KEY_LEFT_ALT, GLFW_KEY_RIGHT_ALT)};
}

// What the callbacks reach through the window's user pointer.
struct Loop {
  GLFWwindow* window;
  Application& app;
  float asked_scale = 0;  // of the interface, for this run alone; 0: none was asked for
  double last_event_s = 0;
  double events_ms = 0;  // since the last frame

  // Window coordinates (which on some systems are no pixels) to logical points.
  glm::vec2 points(double x, double y) const {
    int width = 1, fb_width = 1, height = 1;
    glfwGetWindowSize(window, &width, &height);
    glfwGetFramebufferSize(window, &fb_width, nullptr);
    const float factor =
        static_cast<float>(fb_width) / static_cast<float>(std::max(1, width)) / pixels_per_point();
    return glm::vec2(x, y) * factor;
  }
  float pixels_per_point() const {
    float x = 1, y = 1;
    glfwGetWindowContentScale(window, &x, &y);
    return std::max(0.5f, x * app.interface().state().ui_scale);
  }
  void fit() const {
    int width = 0, height = 0;
    glfwGetFramebufferSize(window, &width, &height);
    if (width > 0 && height > 0)
      app.resize(glm::vec2(width, height) / pixels_per_point(), pixels_per_point());
  }
  void send(const UiEvent& event) {
    last_event_s = glfwGetTime();
    app.handle(event);
    events_ms += 1000 * (glfwGetTime() - last_event_s);
  }
};

Loop& loop_of(GLFWwindow* window) {
  return *static_cast<Loop*>(glfwGetWindowUserPointer(window));
}

int key_of(int code, int scancode) {
  const char* printed = glfwGetKeyName(code, scancode);
  return key_meant(code, printed ? printed : "");
}

void install_callbacks(GLFWwindow* window) {
  glfwSetCursorPosCallback(window, [](GLFWwindow* w, double x, double y) {
    loop_of(w).send(PointerMoved{loop_of(w).points(x, y), held_modifiers(w)});
  });
  glfwSetCursorEnterCallback(window, [](GLFWwindow* w, int entered) {
    if (!entered) loop_of(w).send(PointerLeft());
  });
  glfwSetMouseButtonCallback(window, [](GLFWwindow* w, int button, int action, int mods) {
    if (button > GLFW_MOUSE_BUTTON_MIDDLE) return;
    loop_of(w).send(PointerButtonChanged{static_cast<PointerButton>(button), action == GLFW_PRESS,
                                         modifiers_of(mods), glfwGetTime()});
  });
  glfwSetScrollCallback(window, [](GLFWwindow* w, double, double y) {
    loop_of(w).send(WheelTurned{static_cast<float>(y), held_modifiers(w)});
  });
  glfwSetKeyCallback(window, [](GLFWwindow* w, int code, int scancode, int action, int mods) {
    if (code == GLFW_KEY_UNKNOWN) return;
    loop_of(w).send(KeyChanged{key_of(code, scancode), action != GLFW_RELEASE, action == GLFW_REPEAT,
                               modifiers_of(mods)});
  });
  glfwSetCharCallback(window,
                      [](GLFWwindow* w, unsigned code_point) { loop_of(w).send(TextTyped{code_point}); });
  glfwSetWindowFocusCallback(
      window, [](GLFWwindow* w, int focused) { loop_of(w).send(FocusChanged{focused == GLFW_TRUE}); });
  glfwSetDropCallback(window, [](GLFWwindow* w, int count, const char** paths) {
    if (count > 0) loop_of(w).send(FileDropped{paths[0], {paths + 1, paths + count}});
  });
}

void install_clipboard(GLFWwindow* window) {
  ImGuiIO& io = ImGui::GetIO();
  io.ClipboardUserData = window;
  io.GetClipboardTextFn = [](void* w) { return glfwGetClipboardString(static_cast<GLFWwindow*>(w)); };
  io.SetClipboardTextFn = [](void* w, const char* text) {
    glfwSetClipboardString(static_cast<GLFWwindow*>(w), text);
  };
}

// Beside the folder of an installed program, or above the build folder.
std::filesystem::path sample_of_program() {
  std::error_code ignored;
  std::filesystem::path folder = std::filesystem::read_symlink("/proc/self/exe", ignored).parent_path();
  for (; folder.has_relative_path(); folder = folder.parent_path())
    for (const char* place : {"share/splatcut/sample", "assets/sample"})
      if (const auto sample = folder / place / "sample.compressed.ply"; std::filesystem::exists(sample))
        return sample;
  return {};
}

// A window over the whole screen goes back to its last place and size when it is no longer maximized.
void remember_place(GLFWwindow* window, Settings* settings) {
  settings->maximized = glfwGetWindowAttrib(window, GLFW_MAXIMIZED) == GLFW_TRUE;
  if (settings->maximized) return;
  glfwGetWindowSize(window, &settings->width, &settings->height);
  glm::ivec2 at(0);
  glfwGetError(nullptr);  // forget what went before
  glfwGetWindowPos(window, &at.x, &at.y);
  if (glfwGetError(nullptr) == GLFW_NO_ERROR) settings->position = at;
}

// What is remembered, as it is now.
Settings settings_now(const Loop& loop, Settings settings) {
  const float kept_scale = settings.ui_scale;
  remember_place(loop.window, &settings);
  settings = settings_of(loop.app, settings);
  if (settings.ui_scale == loop.asked_scale) settings.ui_scale = kept_scale;
  return settings;
}

void keep_settings(const Loop& loop, SettingsKeeper* keeper) {
  try {
    keeper->keep(settings_now(loop, keeper->kept()));
  } catch (const std::exception&) {
    // Not worth stopping for now; leaving the program reports it.
  }
}

std::string title_of(const Studio& studio) {
  if (!studio.scene()) return "splatcut";
  const std::filesystem::path& shown =
      studio.work().work_path().empty() ? studio.scene()->scene->path : studio.work().work_path();
  return fmt::format("{}{} - splatcut", studio.unsaved() ? "* " : "", scene_name(shown));
}

// For scripts that press what a user presses: a line an item, "x0 y0 x1 y1 name" in logical points of the
// window, into the file that SPLATCUT_ITEMS names, whenever they change.
class ItemsFile {
 public:
  void keep(const std::vector<ShownItem>& items) {
    if (!file_ || items == kept_) return;
    std::string text;
    for (const ShownItem& i : items)
      text += fmt::format("{:.0f} {:.0f} {:.0f} {:.0f} {}\n", i.min.x, i.min.y, i.max.x, i.max.y, i.name);
    write_text_file(file_, text, PowerCut::kMayLeaveNone);
    kept_ = items;
  }

 private:
  const char* file_ = std::getenv("SPLATCUT_ITEMS");
  std::vector<ShownItem> kept_;
};

void run_loop(Loop& loop, SettingsKeeper* keeper, const std::stop_token& stop, std::optional<FrameLog> log) {
  constexpr double kAfterEventSeconds = 0.3, kIdleSeconds = 0.5, kMovingSeconds = 0.004;
  constexpr double kWorkingSeconds = 0.05;  // software OpenGL would take the cores that the work needs
  constexpr double kKeepSeconds = 1;
  double before = glfwGetTime(), kept_s = before;
  std::string title;
  FileDrag drag;
  ItemsFile items;
  while (!loop.app.wants_to_close() && !stop.stop_requested()) {
    if (glfwWindowShouldClose(loop.window)) {
      glfwSetWindowShouldClose(loop.window, GLFW_FALSE);
      loop.app.studio().run(Action::kQuit);
    }
    loop.fit();
    const double now = glfwGetTime();
    refuse_lost_context();
    const bool busy = loop.app.frame(now - before);
    before = now;
    const FrameTimes parts = loop.app.take_longest();
    const double drawn_s = glfwGetTime();
    if (std::string wanted = title_of(loop.app.studio()); wanted != title)
      glfwSetWindowTitle(loop.window, (title = wanted).c_str());
    if (now - kept_s > kKeepSeconds) {
      keep_settings(loop, keeper);
      kept_s = now;
    }
    if (const auto file = std::exchange(loop.app.interface().state().dragged_out, {})) drag.begin(*file);
    const bool drags = drag.update();
    items.keep(loop.app.interface().state().items);
    glfwSwapBuffers(loop.window);
    if (log)
      log->add({now, std::exchange(loop.events_ms, 0), parts, 1000 * (glfwGetTime() - drawn_s),
                loop.app.studio().progress().busy});
    const bool fresh = glfwGetTime() - loop.last_event_s < kAfterEventSeconds;
    const bool moving = fresh || drags || loop.app.studio().viewport().moving();
    glfwWaitEventsTimeout(moving ? kMovingSeconds : busy ? kWorkingSeconds : kIdleSeconds);
  }
}

}  // namespace

std::string why_no_window() {
  if (!std::getenv("DISPLAY") && !std::getenv("WAYLAND_DISPLAY"))
    return "neither DISPLAY nor WAYLAND_DISPLAY is set";
  if (!glfwInit()) return last_glfw_error();
  glfwTerminate();
  return {};
}

void run_window(const WindowOptions& options) {
  SettingsKeeper keeper(config_folder() / "settings.json");
  const Settings settings = keeper.kept();
  const Glfw glfw;
  const GlfwWindow window(place_of(options, settings));
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  {
    Application app(
        {{glfwPostEmptyEvent, false, state_folder(), options.cache}, options.renderer, sample_of_program()});
    Loop loop{window.handle, app, options.ui_scale};
    UiState& state = app.interface().state();
    state.native_wanted = true;
    use_settings(settings, &app);
    if (options.ui_scale > 0) state.ui_scale = options.ui_scale;
    install_clipboard(window.handle);
    glfwSetWindowUserPointer(window.handle, &loop);
    install_callbacks(window.handle);
    if (!options.open.empty())
      app.studio().apply(OpenScene{options.open, options.spz_axes, options.added, options.lod,
                                   options.cameras, options.camera});
    run_loop(loop, &keeper, options.stop,
             options.frame_times ? std::optional<FrameLog>(options.frame_times) : std::nullopt);
    if (options.stop.stop_requested())
      app.studio().keep_unsaved();
    else
      app.studio().leave();
    keeper.keep(settings_now(loop, keeper.kept()));
  }
}

}  // namespace splatcut
