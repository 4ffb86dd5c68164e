#include "app/window/application.h"

#include <fmt/format.h>
#include <glad/gl.h>

#include <algorithm>
#include <cfloat>
#include <chrono>
#include <new>
#include <thread>

#include "core/error.h"

namespace splatcut {

namespace {

constexpr double kDoubleClickSeconds = 0.35;
constexpr float kDoubleClickPoints = 6;
constexpr std::size_t kRecentKept = 8;

// Keys that a held key repeats.
bool repeats(Action action) {
  return action == Action::kUndo || action == Action::kRedo || action == Action::kBrushSmaller ||
         action == Action::kBrushLarger || action == Action::kPartLarger || action == Action::kPartSmaller ||
         action == Action::kCursor;
}

// The keys that ImGui knows, by the codes of KeyChanged; Tab is not for it, see FocusWalk.
void name_keys(ImGuiIO& io) {
  const std::pair<ImGuiKey, int> kKeys[] = {{ImGuiKey_LeftArrow, key::kLeft},
                                            {ImGuiKey_RightArrow, key::kRight},
                                            {ImGuiKey_UpArrow, key::kUp},
                                            {ImGuiKey_DownArrow, key::kDown},
                                            {ImGuiKey_PageUp, key::kPageUp},
                                            {ImGuiKey_PageDown, key::kPageDown},
                                            {ImGuiKey_Home, key::kHome},
                                            {ImGuiKey_End, key::kEnd},
                                            {ImGuiKey_Insert, key::kInsert},
                                            {ImGuiKey_Delete, key::kDelete},
                                            {ImGuiKey_Backspace, key::kBackspace},
                                            {ImGuiKey_Space, ' '},
                                            {ImGuiKey_Enter, key::kEnter},
                                            {ImGuiKey_Escape, key::kEscape},
                                            {ImGuiKey_KeyPadEnter, key::kKeypadEnter},
                                            {ImGuiKey_A, 'A'},
                                            {ImGuiKey_C, 'C'},
                                            {ImGuiKey_V, 'V'},
                                            {ImGuiKey_X, 'X'},
                                            {ImGuiKey_Y, 'Y'},
                                            {ImGuiKey_Z, 'Z'}};
  for (const auto& [imgui_key, code] : kKeys) io.KeyMap[imgui_key] = code;
}

}  // namespace

Application::Application(const ApplicationOptions& options) : studio_(options.studio) {
  interface_.make_current();
  name_keys(ImGui::GetIO());
  if (!options.sample.empty() && std::filesystem::exists(options.sample))
    interface_.state().sample = options.sample;
  choose_renderer(options.renderer, options.studio.wake);
  resize(size_points_, 1);
}

void Application::choose_renderer(RendererChoice choice, const std::function<void()>& wake) {
  const GlInfo gl = current_gl_info();
  const bool use_gl = choice == RendererChoice::kGl || (choice == RendererChoice::kAuto && !gl.software);
  std::string name = gl.renderer.substr(0, gl.renderer.find(" ("));
  interface_.state().renderer_line = use_gl ? fmt::format("OpenGL on {}", name)
                                     : choice == RendererChoice::kCpu
                                         ? "CPU renderer (asked for)"
                                         : fmt::format("CPU renderer (OpenGL is software here: {})", name);
  studio_.set_gpu_view(use_gl);
  if (use_gl) gpu_ = std::make_unique<GpuView>(wake);
}

void Application::resize(const glm::vec2& size_points, float pixels_per_point) {
  size_points_ = size_points;
  pixels_per_point_ = pixels_per_point;
  interface_.resize(size_points, pixels_per_point, &renderer_);
}

void Application::handle(const UiEvent& event) {
  interface_.make_current();
  std::visit([this](const auto& e) { handle_one(e); }, event);
}

glm::vec2 Application::in_viewport_px(const glm::vec2& point) const {
  return (point - interface_.viewport().min) * pixels_per_point_;
}

void Application::set_modifiers(const Modifiers& modifiers) {
  ImGuiIO& io = ImGui::GetIO();
  io.KeyShift = modifiers.shift;
  io.KeyCtrl = modifiers.ctrl;
  io.KeyAlt = modifiers.alt;
}

void Application::handle_one(const PointerMoved& event) {
  take(event);
}

void Application::take_now(const PointerMoved& event) {
  pointer_ = event.position_points;
  left_window_ = !UiRect{{0, 0}, size_points_}.contains(pointer_);
  ImGui::GetIO().MousePos = {pointer_.x, pointer_.y};
  set_modifiers(event.modifiers);
  if (dragging_picture_ || interface_.picture_at(pointer_, studio_))
    studio_.pointer_moved(in_viewport_px(pointer_), event.modifiers);
  else
    studio_.pointer_left();
}

void Application::handle_one(const PointerButtonChanged& event) {
  take(event);
}

void Application::take_now(const PointerButtonChanged& event) {
  const auto index = static_cast<std::size_t>(event.button);
  set_modifiers(event.modifiers);
  button_down_[index] = event.down;
  if (event.down) walk_.leave();
  if (event.down) pressed_since_frame_[index] = true;
  if (!event.down) {
    dropped_since_frame_ |= !dragging_picture_;  // what is dragged ends where the pointer is now
    if (dragging_picture_) studio_.pointer_released(in_viewport_px(pointer_), event.button, event.modifiers);
    dragging_picture_ = button_held() && dragging_picture_;
    if (left_window_) take(PointerLeft());
    return;
  }
  const bool twice = is_second_click(event);
  interface_.state().double_clicked = twice;
  if (!interface_.picture_at(pointer_, studio_)) return;
  if (event.button == PointerButton::kLeft && interface_.handle_at(pointer_)) return;
  dragging_picture_ = true;
  if (twice && tool_of(studio_.view().tool).double_click)  // else a stroke may begin where the last one ended
    studio_.pointer_double_clicked(in_viewport_px(pointer_));
  else
    studio_.pointer_pressed(in_viewport_px(pointer_), event.button, event.modifiers);
}

void Application::handle_one(const PointerLeft& event) {
  take(event);
}

// A drag goes on outside of the window. Else nothing lies under the pointer any more.
void Application::take_now(const PointerLeft&) {
  left_window_ = true;
  if (button_held()) return;
  pointer_ = kNowhere;
  ImGui::GetIO().MousePos = {-FLT_MAX, -FLT_MAX};
  studio_.pointer_left();
}

bool Application::button_held() const {
  return std::ranges::any_of(button_down_, [](bool down) { return down; });
}

bool Application::is_second_click(const PointerButtonChanged& press) {
  const double now_s = press.time_s.value_or(clock_s_);
  const bool left = press.button == PointerButton::kLeft;
  const bool twice = left && last_click_s_ && now_s - *last_click_s_ < kDoubleClickSeconds &&
                     glm::length(pointer_ - last_click_) < kDoubleClickPoints;
  last_click_s_ = twice || !left ? std::nullopt : std::optional(now_s);
  last_click_ = pointer_;
  return twice;
}

void Application::handle_one(const WheelTurned& event) {
  if (interface_.picture_at(pointer_, studio_))
    studio_.wheel(event.steps, event.modifiers);
  else
    ImGui::GetIO().MouseWheel += event.steps;
}

bool Application::walks(const KeyChanged& event) {
  if (!event.down) return false;
  if (event.key == key::kTab && !event.modifiers.ctrl && !event.modifiers.alt) {
    walk_.step(event.modifiers.shift ? -1 : 1);
    return true;
  }
  if (ImGui::GetIO().WantTextInput) return false;
  switch (event.key) {
    case ' ':
    case key::kEnter:
    case key::kKeypadEnter:
      return event.repeated ? walk_.mark().has_value() : walk_.press();
    case key::kEscape:
      return walk_.leave();
    default:
      if (action_for(event.key, event.modifiers) == Action::kCursor) walk_.leave();
      return false;
  }
}

void Application::handle_one(const KeyChanged& event) {
  const bool in_field = ImGui::GetIO().WantTextInput || interface_.dialog_open();
  const bool comes_after = in_field && (!held_back_.empty() || waits_for_walk(event));
  if (!comes_after && walks(event)) return;
  take(event);
  if (!event.down) return studio_.key_released(event.key);
  if (ImGui::GetIO().WantTextInput || interface_.dialog_open()) return;
  if (event.key == key::kEscape && interface_.dragging_handle()) return;
  if (event.repeated && !repeats(action_for(event.key, event.modifiers))) return;
  studio_.key_pressed(event.key, event.modifiers, event.repeated);
}

void Application::handle_one(const TextTyped& event) {
  take(event);
}

// A field takes letters as text: their keys need no frame each, in which it would see them held.
bool Application::is_only_text(const KeyChanged& event) const {
  const ImGuiIO& io = ImGui::GetIO();
  return event.key >= 0 && event.key < key::kEscape && !event.modifiers.ctrl && !event.modifiers.alt &&
         (event.down ? io.WantTextInput : !io.KeysDown[event.key]);
}

// What is pressed and typed after Tab is for what Tab comes to; steps of Tab add up.
bool Application::waits_for_walk(const HeldEvent& event) const {
  const auto* key = std::get_if<KeyChanged>(&event);
  const bool typed = key ? key->key != key::kTab : std::holds_alternative<TextTyped>(event);
  return typed && walk_.searching();
}

void Application::take(const HeldEvent& event) {
  const auto* key = std::get_if<KeyChanged>(&event);
  const bool walk_first = waits_for_walk(event);
  if (held_back_.empty() && !walk_first && key && is_only_text(*key)) return set_modifiers(key->modifiers);
  const bool waits = !held_back_.empty() || walk_first || dropped_since_frame_ ||
                     (key && !key->down && key_pressed_since_frame_);
  if (waits)
    held_back_.push_back(event);
  else
    std::visit([this](const auto& e) { take_now(e); }, event);
}

void Application::take_held_back() {
  key_pressed_since_frame_ = dropped_since_frame_ = false;
  for (const HeldEvent& event : std::exchange(held_back_, {})) {
    const auto* key = std::get_if<KeyChanged>(&event);
    if (held_back_.empty() && key && !waits_for_walk(event) && walks(*key)) continue;
    take(event);
  }
}

void Application::take_now(const TextTyped& event) {
  ImGui::GetIO().AddInputCharacter(event.code_point);
}

void Application::take_now(const KeyChanged& event) {
  // X11 says what was held before the event: a field would take letters typed after Ctrl for shortcuts.
  Modifiers now = event.modifiers;
  if (event.key == key::kLeftShift || event.key == key::kRightShift) now.shift = event.down;
  if (event.key == key::kLeftControl || event.key == key::kRightControl) now.ctrl = event.down;
  if (event.key == key::kLeftAlt || event.key == key::kRightAlt) now.alt = event.down;
  set_modifiers(now);
  if (event.key >= 0 && event.key < key::kCount) ImGui::GetIO().KeysDown[event.key] = event.down;
  key_pressed_since_frame_ |= event.down;
}

void Application::handle_one(const FileDropped& event) {
  open({event.path, {}, event.more});
}

namespace {

// True if a file is missing, or its name or first bytes are those of no scene. False for saved work and
// folders: these show it only once they are read.
bool begins_as_no_scene(const std::filesystem::path& path) {
  std::error_code ignored;
  const auto type = std::filesystem::status(path, ignored).type();
  if (is_work_file(path) ||
      (type != std::filesystem::file_type::regular && type != std::filesystem::file_type::not_found))
    return false;
  try {
    check_beginning(path);
    return false;
  } catch (const Error&) {
    return true;
  }
}

}  // namespace

void Application::open(const OpenScene& command) {
  interface_.state().after_save.reset();
  // What is no scene leaves the work: the reason is said in place of a question.
  if (studio_.unsaved_and_not_exported() && !(command.added.empty() && begins_as_no_scene(command.path)))
    interface_.state().open_asked = command;
  else
    studio_.apply(command);
}

void Application::handle_one(const FocusChanged& event) {
  if (event.focused) return;
  studio_.release_keys();
  held_back_.clear();
  std::ranges::fill(ImGui::GetIO().KeysDown, false);
  set_modifiers({});
}

void Application::remember_recent() {
  const OpenedScene* scene = studio_.scene();
  if (!scene || scene->serial == recent_scene_) return;
  recent_scene_ = scene->serial;
  auto& recent = interface_.state().recent;
  const std::filesystem::path path = std::filesystem::absolute(scene->scene->path);
  std::erase(recent, path);
  recent.insert(recent.begin(), path);
  if (recent.size() > kRecentKept) recent.resize(kRecentKept);
}

bool Application::advance(double seconds, bool draws) {
  FrameTimes times;
  auto before = std::chrono::steady_clock::now();
  const auto lap = [&before] {
    const auto now = std::chrono::steady_clock::now();
    return std::chrono::duration<double, std::milli>(now - std::exchange(before, now)).count();
  };
  clock_s_ += seconds;
  interface_.make_current();
  const glm::vec2 view_px = interface_.viewport().size() * pixels_per_point_;
  studio_.set_viewport(static_cast<int>(std::lround(view_px.x)), static_cast<int>(std::lround(view_px.y)),
                       pixels_per_point_);
  const bool busy = studio_.update(seconds);
  remember_recent();
  if (!studio_.document().objects.empty()) interface_.state().hint_wanted = false;
  for (const UiRequest request : studio_.take_ui_requests()) interface_.show(request, studio_, &renderer_);
  times.update = lap();
  Requests ask;
  build_interface(seconds, &ask);
  times.interface = lap();
  if (draws) draw();
  times.draw = lap();
  for (const Action action : ask.actions) studio_.run(action);
  for (const Command& command : ask.commands) {
    if (const auto* opened = std::get_if<OpenScene>(&command))
      open(*opened);
    else
      studio_.apply(command);
  }
  UiState& state = interface_.state();
  if (state.after_save && studio_.history().cursor() != state.after_save->cursor)
    state.after_save.reset();  // what was to be saved before is no longer what stands there
  if (state.after_save && studio_.work().saves() != state.after_save->saves) {
    state.open_now = std::exchange(state.after_save, {})->open;
    if (!state.open_now) studio_.run(Action::kQuit);  // asks again where more was done meanwhile
  }
  if (const auto command = std::exchange(state.open_now, {})) studio_.apply(*command);
  times.requests = lap();
  if (times.total() > longest_.total()) longest_ = times;
  return busy || walk_.searching() || !held_back_.empty() || !ask.actions.empty() || !ask.commands.empty();
}

void Application::build_interface(double seconds, Requests* ask) {
  // A press and release between two frames is a click, too.
  for (int i = 0; i < 3; ++i)
    ImGui::GetIO().MouseDown[i] = std::exchange(pressed_since_frame_[i], false) || button_down_[i];
  ImTextureID gpu_pictures[2] = {};
  if (gpu_) draw_by_gpu(gpu_pictures);
  interface_.state().marked = walk_.mark();
  walk_.before_frame();
  interface_.build(studio_, seconds, &renderer_, gpu_pictures, ask);
  walk_.after_frame();
  take_held_back();
}

void Application::draw_by_gpu(ImTextureID pictures[2]) {
  GLint target = 0;  // drawing splats binds others
  glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &target);
  try {
    const auto textures = gpu_->draw(studio_);
    for (std::size_t i = 0; i < 2; ++i) pictures[i] = texture_id(textures[i]);
  } catch (const std::exception& error) {
    go_on_without_gpu(error);
  }
  glBindFramebuffer(GL_FRAMEBUFFER, static_cast<GLuint>(target));
}

// A scene may be larger than what a driver's buffers hold, or than the memory left for copies, or a driver
// refuses what it held before: the scene is drawn all the same, and no work is lost.
void Application::go_on_without_gpu(const std::exception& why) {
  const auto* known = dynamic_cast<const Error*>(&why);
  std::string reason = known                                       ? std::string(known->unstopped())
                       : dynamic_cast<const std::bad_alloc*>(&why) ? "there is not enough memory"
                                                                   : "its driver failed";
  reason.resize(std::min(reason.size(), reason.find(". ")));  // what helps is done here
  gpu_.reset();
  interface_.state().renderer_line = fmt::format("CPU renderer ({})", reason);
  studio_.leave_gpu_view(
      fmt::format("The graphics card cannot go on ({}). The CPU draws until the end of the program, slower "
                  "while the view moves.",
                  reason));
}

void Application::draw() {
  glDisable(GL_SCISSOR_TEST);
  const ImVec4& back = interface_.theme().colour.panel_low;
  glClearColor(back.x, back.y, back.z, 1);
  glClear(GL_COLOR_BUFFER_BIT);
  renderer_.draw(*ImGui::GetDrawData());
  renderer_.end_frame();
}

bool Application::settle(double most_seconds) {
  const auto start = std::chrono::steady_clock::now();
  int quiet = 0;
  while (std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() < most_seconds) {
    advance(1.0 / 60);
    quiet = studio_.idle() ? quiet + 1 : 0;
    if (quiet >= 3) return true;
    if (quiet == 0) std::this_thread::sleep_for(std::chrono::milliseconds(25));  // the work needs the cores
  }
  return false;
}

}  // namespace splatcut
