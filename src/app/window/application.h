// The whole program behind the window: studio, interface, renderers. Needs a current OpenGL context and is
// told of events and sizes; a real window, an off-screen test and a screenshot drive it the same way. Main
// thread only.
#pragma once

#include <deque>
#include <memory>
#include <optional>

#include "app/studio/studio.h"
#include "app/window/focus_walk.h"
#include "app/window/gpu_view.h"
#include "app/window/interface.h"
#include "app/window/ui_events.h"
#include "render/context.h"

namespace splatcut {

enum class RendererChoice { kAuto, kGl, kCpu };

struct ApplicationOptions {
  StudioOptions studio;
  RendererChoice renderer = RendererChoice::kAuto;
  std::filesystem::path sample;  // offered on the start page; empty: none
};

// Milliseconds of one frame on the main thread.
struct FrameTimes {
  double update = 0, interface = 0, draw = 0, requests = 0;
  double total() const { return update + interface + draw + requests; }
};

class Application {
 public:
  explicit Application(const ApplicationOptions& options);

  // size_points: of the window in logical points; framebuffer pixels = points times pixels_per_point.
  void resize(const glm::vec2& size_points, float pixels_per_point);
  void handle(const UiEvent& event);
  // Advances by `seconds` and draws into the bound framebuffer. True while something moves or is awaited.
  bool frame(double seconds) { return advance(seconds, true); }
  // The same without drawing, and what it would have drawn: for who looks at the last of many frames alone.
  bool advance(double seconds) { return advance(seconds, false); }
  void draw();
  bool wants_to_close() { return interface_.state().quit_wanted; }

  // Advances by 1/60 s until nothing moves and nothing runs; draws nothing. False after `most_seconds` of
  // real time.
  bool settle(double most_seconds);

  Studio& studio() { return studio_; }
  Interface& interface() { return interface_; }
  // The longest frame since the last call: what a user feels as a stall.
  FrameTimes take_longest() { return std::exchange(longest_, FrameTimes()); }

 private:
  void handle_one(const PointerMoved& event);
  void handle_one(const PointerButtonChanged& event);
  void handle_one(const PointerLeft& event);
  void handle_one(const WheelTurned& event);
  void handle_one(const KeyChanged& event);
  void handle_one(const TextTyped& event);
  void handle_one(const FileDropped& event);
  void handle_one(const FocusChanged& event);
  glm::vec2 in_viewport_px(const glm::vec2& point) const;
  bool is_second_click(const PointerButtonChanged& press);
  void set_modifiers(const Modifiers& modifiers);
  // Keys and text for the interface, which looks at what is held once a frame: what follows a key that was
  // pressed and released between two frames waits for the next, and so does the pointer.
  using HeldEvent = std::variant<KeyChanged, TextTyped, PointerMoved, PointerButtonChanged, PointerLeft>;
  void take(const HeldEvent& event);
  void take_held_back();
  bool walks(const KeyChanged& event);  // true: the key was for the walk of Tab alone
  bool is_only_text(const KeyChanged& event) const;
  bool waits_for_walk(const HeldEvent& event) const;
  void take_now(const KeyChanged& event);
  void take_now(const TextTyped& event);
  void take_now(const PointerMoved& event);
  void take_now(const PointerButtonChanged& event);
  void take_now(const PointerLeft& event);
  bool button_held() const;
  void choose_renderer(RendererChoice choice, const std::function<void()>& wake);
  void open(const OpenScene& command);  // asks first where work would be lost
  void remember_recent();
  void build_interface(double seconds, Requests* ask);
  void draw_by_gpu(ImTextureID pictures[2]);
  void go_on_without_gpu(const std::exception& why);
  bool advance(double seconds, bool draws);

  Studio studio_;
  Interface interface_;
  UiRenderer renderer_;
  std::unique_ptr<GpuView> gpu_;
  FocusWalk walk_;
  glm::vec2 size_points_{1280, 720};
  float pixels_per_point_ = 1;
  static constexpr glm::vec2 kNowhere{-1e6f, -1e6f};
  glm::vec2 pointer_ = kNowhere;
  bool left_window_ = false;  // the pointer is outside, perhaps with a button that is still held
  bool dragging_picture_ = false;
  bool pressed_since_frame_[3] = {};
  bool key_pressed_since_frame_ = false;
  bool dropped_since_frame_ = false;  // a button was released over the interface, which has not seen it yet
  std::deque<HeldEvent> held_back_;
  bool button_down_[3] = {};
  double clock_s_ = 0;
  std::optional<double> last_click_s_;
  glm::vec2 last_click_{0};
  std::uint64_t recent_scene_ = 0;
  FrameTimes longest_;
};

}  // namespace splatcut
