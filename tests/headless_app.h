// The whole program over Mesa's software rasteriser in memory (or another context), driven by the events a
// window would send.
#pragma once

#include <unistd.h>
#include <array>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>
#include <string_view>
#include <thread>

#include <imgui_internal.h>  // items by their names

#include "app/window/application.h"
#include "places.h"
#include "render/context.h"
#include "render/gl_objects.h"
#include "render/read_back.h"
#include "scene/camera/camera_file.h"

namespace splatcut::testing {

inline const std::filesystem::path kSampleFolder = project_folder() + "/assets/sample";
inline const std::filesystem::path kSample = kSampleFolder / "sample.compressed.ply";
// The same table in 3,000 Gaussians, with the sample's cameras (a link): for tests of what hands do, not of
// what is cut. Made by `splatcut-lab make-scene small_sample --gaussians 3000 --format compressed.ply`.
inline const std::filesystem::path kSmallSample =
    project_folder() + "/tests/data/small_sample/small_sample.compressed.ply";

// Scenes are prepared once for all tests and kept where ctest says; run by hand, and with other options,
// anew. Nothing is made before it is asked for: most tests would only wait for it.
inline ApplicationOptions with_kept_scenes(ApplicationOptions options = {}) {
  options.studio.works_ahead = false;
  if (const char* folder = std::getenv("SPLATCUT_TEST_CACHE")) options.studio.cache.folder = folder;
  return options;
}

// As the program works when it is shipped.
inline ApplicationOptions working_ahead() {
  ApplicationOptions options = with_kept_scenes();
  options.studio.works_ahead = true;
  return options;
}

// Goes with everything in it.
class ScratchFolder {
 public:
  explicit ScratchFolder(const std::string& name)
      : path_(std::filesystem::temp_directory_path() /
              ("splatcut_" + name + "_" + std::to_string(::getpid()))) {
    std::filesystem::create_directories(path_);
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  ~ScratchFolder() { std::filesystem::remove_all(path_); }
  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }

 private:
  std::filesystem::path path_;
};

// A program that saves by itself in this folder, and offers what was left there.
inline ApplicationOptions with_state(const ScratchFolder& folder) {
  ApplicationOptions options = with_kept_scenes();
  options.studio.state_folder = folder.path();
  return options;
}

class HeadlessApp {
 public:
  explicit HeadlessApp(int width = 1040, int height = 600, float pixels_per_point = 1,
                       ApplicationOptions options = with_kept_scenes(),
                       std::unique_ptr<OffscreenContext> context = make_osmesa_context())
      : context_(std::move(context)), app_(with_target(width, height, std::move(options))) {
    app_.resize(glm::vec2(width, height) / pixels_per_point, pixels_per_point);
    app_.interface().state().steady = true;
  }

  Application& operator*() { return app_; }
  Application* operator->() { return &app_; }
  Studio& studio() { return app_.studio(); }
  UiState& interface_state() { return app_.interface().state(); }

  void open(const std::filesystem::path& scene) { app_.handle(FileDropped{scene}); }
  // Nothing moves or runs afterwards.
  bool settle(double most_seconds = 300) { return app_.settle(most_seconds); }
  void frames(int count) {
    for (int i = 0; i < count; ++i) app_.advance(1.0 / 60);
  }
  // Until a thing holds that the worker or time brings about. False after a minute.
  template <typename Condition>
  bool frames_until(const Condition& holds) {
    const auto start = std::chrono::steady_clock::now();
    while (!holds()) {
      if (std::chrono::steady_clock::now() - start > std::chrono::minutes(1)) return false;
      frames(1);
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return true;
  }
  // The message on the screen goes; what is made while nothing is done (clean edges) is made.
  void wait_for_message_to_go() {
    app_.advance(10);
    settle();
    frames(2);
  }

  void move(const glm::vec2& point, const Modifiers& modifiers = {}) {
    app_.handle(PointerMoved{point, modifiers});
  }
  void press(PointerButton button, const Modifiers& modifiers = {}) {
    app_.handle(PointerButtonChanged{button, true, modifiers});
  }
  void release(PointerButton button, const Modifiers& modifiers = {}) {
    app_.handle(PointerButtonChanged{button, false, modifiers});
  }
  void click(const glm::vec2& point, PointerButton button = PointerButton::kLeft,
             const Modifiers& modifiers = {}) {
    move(point, modifiers);
    press(button, modifiers);
    release(button, modifiers);
    app_.advance(0.5);  // no double-click with the next
  }
  void drag(std::initializer_list<glm::vec2> path, PointerButton button = PointerButton::kLeft) {
    move(*path.begin());
    press(button);
    for (const glm::vec2& p : path) {
      move(p);
      app_.advance(1.0 / 60);
    }
    release(button);
    app_.advance(0.5);
  }
  void key(int code, const Modifiers& modifiers = {}) {
    app_.handle(KeyChanged{code, true, false, modifiers});
    app_.advance(1.0 / 60);
    app_.handle(KeyChanged{code, false, false, modifiers});
    if (modifiers.shift) app_.handle(KeyChanged{key::kLeftShift, false, false, modifiers});
    if (modifiers.ctrl) app_.handle(KeyChanged{key::kLeftControl, false, false, modifiers});
    if (modifiers.alt) app_.handle(KeyChanged{key::kLeftAlt, false, false, modifiers});
    app_.advance(1.0 / 60);
  }

  // A button, checkbox or section by what is written on it, or by its id behind ##; outer ids first. window:
  // any part of its window's name.
  void press_item(std::string_view window, std::initializer_list<const char*> names) {
    app_.interface().make_current();
    GImGui->NavNextActivateId = item(window, names);
    GImGui->NavNextActivateFlags = ImGuiActivateFlags_None;
    frames(3);
  }
  // A number or text is opened for typing, as Ctrl+click does, and replaced; no key ends it yet.
  void type_into(std::string_view window, std::initializer_list<const char*> names, std::string_view text) {
    app_.interface().make_current();
    GImGui->NavNextActivateId = item(window, names);
    GImGui->NavNextActivateFlags = ImGuiActivateFlags_PreferInput;
    frames(3);
    type(text);
  }
  // Letters for what has the keyboard, a frame each.
  void type(std::string_view text) {
    for (const char c : text) {
      app_.handle(TextTyped{static_cast<unsigned>(c)});
      frames(1);
    }
  }

  // Where a window of the interface lies, by any part of its name.
  UiRect window(std::string_view name) {
    app_.interface().make_current();
    const ImGuiWindow* found = find_window(name);
    if (!found) return {};
    const ImRect rect = found->Rect();
    return {{rect.Min.x, rect.Min.y}, {rect.Max.x, rect.Max.y}};
  }

  // Where a button of the interface lies, by what stands on it.
  UiRect button(std::string_view name) {
    for (const ShownItem& i : interface_state().items)
      if (i.name.find(name) != std::string::npos) return {i.min, i.max};
    return {};
  }

  // Where a pixel of the sample's camera 0 is on the screen while the view stands there.
  glm::vec2 screen_of(const glm::vec2& pixel) {
    const Camera given = load_cameras(kSampleFolder / "cameras.json").front();
    const Camera shown = studio().viewport().pane_camera();
    const float factor = shown.fy_px / given.fy_px;
    const glm::vec2 at =
        (pixel - glm::vec2(given.cx_px, given.cy_px)) * factor + glm::vec2(shown.cx_px, shown.cy_px);
    return app_.interface().viewport().min + at;
  }

  // What the last frame shows: only what is looked at is drawn.
  Image<Rgb8> picture() {
    target_.bind();
    app_.draw();
    return read_back_rgb8(target_.width(), target_.height(), true);
  }

 private:
  static const ImGuiWindow* find_window(std::string_view name) {
    const ImGuiWindow* found = nullptr;
    for (const ImGuiWindow* w : GImGui->Windows)
      if (w->WasActive && std::string_view(w->Name).find(name) != std::string_view::npos) found = w;
    return found;
  }
  static ImGuiID item(std::string_view window, std::initializer_list<const char*> names) {
    const ImGuiWindow* found = find_window(window);
    ImGuiID id = found ? found->ID : 0;
    for (const char* name : names) id = ImHashStr(name, 0, id);
    return id;
  }
  ApplicationOptions with_target(int width, int height, ApplicationOptions options) {
    const GLenum formats[] = {GL_RGBA8};
    target_.resize(width, height, formats);
    target_.bind();
    return options;
  }

  std::unique_ptr<OffscreenContext> context_;
  RenderTarget target_;
  Application app_;
};

// True object numbers of the sample, per Gaussian of the cloud.
inline std::vector<std::uint8_t> sample_truth(const Scene& scene, std::uint8_t object) {
  std::ifstream in(kSampleFolder / "sample.labels.u8", std::ios::binary);
  const std::vector<char> rows{std::istreambuf_iterator<char>(in), {}};
  std::vector<std::uint8_t> truth(scene.cloud.size());
  for (std::size_t g = 0; g < truth.size(); ++g)
    truth[g] = static_cast<std::uint8_t>(rows.at(scene.cloud.file_row[g])) == object;
  return truth;
}

inline double iou_of(const std::vector<std::uint8_t>& a, const std::vector<std::uint8_t>& b) {
  std::size_t both = 0, any = 0;
  for (std::size_t g = 0; g < a.size(); ++g) {
    both += a[g] && b[g];
    any += a[g] || b[g];
  }
  return any ? static_cast<double>(both) / static_cast<double>(any) : 1.0;
}

inline constexpr std::uint8_t kMug = 1, kApple = 2, kOrange = 3;  // of sample.labels.u8
inline constexpr glm::vec2 kOnApple{670, 490}, kOnOrange{786, 460}, kOnMug{498, 450};

// The sample opened and its apple cut out by one click.
inline bool cut_out_apple(HeadlessApp& app, const std::filesystem::path& scene = kSample) {
  app.open(scene);
  if (!app.settle()) return false;
  app.click(app.screen_of(kOnApple));
  return app.settle();
}

}  // namespace splatcut::testing
