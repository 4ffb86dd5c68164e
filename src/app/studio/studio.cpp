#include "app/studio/studio.h"

#include <algorithm>
#include <chrono>
#include <thread>

#include "app/document/words.h"
#include "core/error.h"

namespace splatcut {

Studio::Studio(const StudioOptions& options)
    : ws_{.options = options, .tasks = tasks_, .writes = writes_, .quick = quick_},
      cuts_(ws_),
      viewport_(ws_, cuts_),
      edits_(ws_, viewport_, cuts_),
      clicks_(ws_, viewport_, cuts_, edits_),
      work_(ws_, viewport_, cuts_),
      files_(ws_, viewport_, cuts_, work_,
             {[this](bool same) { scene_opened(same); },
              [this](std::function<void()> next) { edits_.at_last(std::move(next)); },
              [this] { return clean_edges_.without(); }}),
      exports_(ws_, viewport_),
      clean_edges_(ws_, viewport_, cuts_),
      seen_views_(ws_, viewport_, cuts_),
      free_sides_(ws_, viewport_),
      tasks_(options.wake, options.inline_tasks),
      writes_(options.wake, options.inline_tasks),
      quick_(options.wake, options.inline_tasks) {
  tasks_.on_error = writes_.on_error =
      quick_.on_error = [this](const std::string& text) { ws_.say(Message::Kind::kError, text); };
}

Studio::~Studio() = default;

namespace {

// What a command that writes a file is called in messages; empty: it writes none.
template <class C>
std::string written_name(const C& command) {
  if constexpr (requires { command.title(); })
    return kWritesFile<C> ? command.title() : std::string();
  else
    return kWritesFile<C> ? "Saving" : "";
}

}  // namespace

void Studio::apply(const Command& command) {
  std::visit(
      [&](const auto& c) {
        using C = std::decay_t<decltype(c)>;
        if (!kAtOnce<C> && edits_.waiting())
          return edits_.in_turn(
              [this, command] {
                follow_document();
                apply(command);
              },
              kWritesFile<C> ? Edits::OnCancel::kStays : Edits::OnCancel::kDropped, written_name(c));
        if constexpr (kAfterCuts<C>)
          if (cuts_.next() != 0)
            return edits_.after_cuts(
                c.title(), [this, command] { dispatch(command); }, kWritesFile<C>);
        if (std::is_same_v<C, OpenScene> && edits_.file_waits()) {
          ws_.say(Message::Kind::kInfo, "The scene is opened as soon as the file that waits is written");
          return edits_.in_turn([this, command] { dispatch(command); }, Edits::OnCancel::kWithFile);
        }
        dispatch(command);
      },
      command);
}

void Studio::dispatch(const Command& command) {
  try {
    std::visit(
        [&](const auto& c) {
          if (kMakesWork<std::decay_t<decltype(c)>> && ws_.scene && !files_.opening().empty())
            throw Error("", files_.opening(), "Wait for it, or press Esc: that keeps this scene");
          if constexpr (requires { clicks_.perform(c); })
            clicks_.perform(c);
          else if constexpr (requires { files_.perform(c); })
            files_.perform(c);
          else if constexpr (requires { work_.perform(c); })
            work_.perform(c);
          else if constexpr (requires { exports_.perform(c); })
            exports_.perform(c);
          else if constexpr (requires { edits_.perform(c); })
            edits_.perform(c);
          else if constexpr (requires { perform(c); })
            perform(c);
          else {
            static_assert(Edits::kKnows<std::decay_t<decltype(c)>>, "a command that nobody performs");
            edits_.perform_plain(command);
          }
        },
        command);
    follow_document();
  } catch (const Error& error) {
    ws_.say(Message::Kind::kRefused, error.what());
  } catch (const std::exception& error) {
    ws_.say(Message::Kind::kError, sentence_of(error));
  }
}

void Studio::run_all(const std::vector<Command>& commands) {
  for (const Command& command : commands) apply(command);
}

void Studio::scene_opened(bool same) {
  cuts_.reset();
  edits_.reset(same);
  clicks_.reset();
  // A release may be among the events that wait, and a click is not for another scene than its press. A drag
  // that moves the camera goes on.
  if (!std::exchange(held_pointer_, {}).empty() || !ws_.tools.moves_camera()) ws_.tools.let_go();
  held_actions_ = {};
  abandon_shape();
  hide_cursor();
  if (same) {
    ++ws_.view_serial;
    return viewport_.change_scene();
  }
  exports_.reset();
  ViewState& view = ws_.view;
  show(DisplayMode::kWhole, &view);
  view.heat = false;
  view.hidden.clear();
  view.tool = Tool::kClick;
  view.fly_speed = std::clamp(view.fly_speed, kLeastKeptSpeed, kMostKeptSpeed);
  view.operation = SetOperation::kAdd;
  view.brush_px = std::min(view.brush_px, kMostKeptBrushPx);
  ++ws_.view_serial;
  viewport_.reset();
}

// The view keeps to the document, however that changed.
void Studio::follow_document() {
  // Alone, an empty object would be a black picture.
  const ObjectItem* active = document().active_object();
  if (ws_.scene && ws_.view.display != DisplayMode::kWhole && gaussians_of(document().active) == 0 &&
      !edits_.waiting() && !(active && cuts_.comes(*active))) {
    show(DisplayMode::kWhole, &ws_.view);
    ++ws_.view_serial;
  }
  if (std::exchange(followed_serial_, ws_.history.serial()) == ws_.history.serial()) return;
  std::erase_if(ws_.view.hidden, [&](ObjectId id) { return !document().find(id); });
  constexpr float kSameDirection = 0.99999f;  // the controller keeps it normalised
  if (glm::dot(glm::normalize(document().up_world), camera().up_world()) < kSameDirection)
    camera().set_up(document().up_world);
  const bool alone = ws_.view.display == DisplayMode::kIsolate;
  if (followed_object_ != document().active && (!alone || gaussians_of(document().active) > 0)) {
    followed_object_ = document().active;
    if (alone) viewport_.turn_about_object();
  }
}

bool Studio::update(double seconds) {
  ws_.clock_s += seconds;
  tasks_.deliver();
  quick_.deliver();
  writes_.deliver();
  if (viewport_.display_current())
    for (const auto& event : std::exchange(held_pointer_, {})) event();
  follow_document();
  cuts_.update();
  edits_.update();
  run_held();
  const bool moves = viewport_.update(seconds, flight());
  if (ws_.scene && !viewport_.moving()) cuts_.looked_from(viewport_.pane_camera());
  if (ws_.scene && cuts_.doubts_whole() && viewport_.shows_all_of_object()) cuts_.saw_whole();
  clean_edges_.update();
  seen_views_.update();
  clicks_.update();
  files_.update();
  work_.update(seconds);
  return moves || !idle() || clicks_.sizes_fade();
}

bool Studio::unsaved_and_not_exported() const {
  const bool all_exported = !edits_.waiting() && cuts_.next() == 0 && exports_.have_all();
  return unsaved() && (!all_exported || work_.own_autosave().empty());
}

std::string Studio::coming() const {
  if (!ws_.scene) return files_.opening();
  return viewport_.picture() ? "" : "Drawing the first picture...";
}

TaskThread::Progress Studio::progress() const {
  const TaskThread::Progress quick = quick_.progress();
  return quick.busy ? quick : tasks_.progress();
}

std::size_t Studio::neighbourhoods() const {
  return ws_.session ? ws_.session->neighbourhoods() : 0;
}

bool Studio::idle() const {
  return tasks_.idle() && quick_.idle() && writes_.idle() && viewport_.idle();
}

ToolOverlay Studio::overlay() const {
  return ws_.tools.overlay(ws_.view, viewport_.pane_camera(), viewport_.pixels_per_point());
}

const std::vector<std::uint8_t>& Studio::labels(ObjectId object) const {
  static const std::vector<std::uint8_t> kNone;
  const ObjectItem* item = document().find(object);
  return item && ws_.scene ? *ws_.labels.labels(document(), *item, ws_.gaussians()) : kNone;
}

bool Studio::is_without_others(ObjectId object) const {
  const ObjectItem* item = document().find(object);
  if (!item || !ws_.scene) return false;
  const std::uint64_t serial = history().serial();
  if (without_others_.object != object || without_others_.serial != serial)
    without_others_ = {object, serial,
                       splatcut::is_without_others(document(), *item, ws_.gaussians(), &ws_.labels)};
  return without_others_.is_without;
}

std::optional<CleanReport> Studio::clean_edges() const {
  return clean_edges(document().active);
}

std::optional<CleanReport> Studio::clean_edges(ObjectId id) const {
  const ObjectItem* object = document().find(id);
  if (!object || !ws_.scene) return {};
  const Flags own = ws_.labels.labels(document(), *object, ws_.gaussians());
  const auto clean = ws_.clean->known(own, document().up_world);
  return clean ? std::optional(clean->report) : std::nullopt;
}

void Studio::set_viewport(int width_px, int height_px, float pixels_per_point) {
  viewport_.set_size(width_px, height_px, pixels_per_point);
  if (cursor_px_) cursor_px_ = within_picture(*cursor_px_);
}

void Studio::leave_gpu_view(const std::string& reason) {
  set_gpu_view(false);
  ws_.say(Message::Kind::kError, reason);
}

void Studio::perform(const ShowFloaters& c) {
  ws_.require_scene();
  viewport_.show_floaters(c.shown);
}

void Studio::perform(const ShowRange& c) {
  ws_.require_scene();
  viewport_.show_range(c.range);
}

// What runs for the person, the nearest to its end first.
bool Studio::cancel_task() {
  const std::string file = edits_.dropped_by_cancel();
  if (cuts_.cancel()) {
    if (edits_.waits_for_cuts()) edits_.cancel();
    ws_.say(Message::Kind::kInfo, "Cancelled. The strokes stay; R computes the cutout again" + file + ".");
    return true;
  }
  bool cancelled =
      cuts_.cancel_likelihood() || edits_.cancel() || clean_edges_.cancel() || seen_views_.cancel();
  if (!cancelled && tasks_.busy(TaskKind::kExport)) {
    tasks_.cancel(TaskKind::kExport);
    cancelled = true;
  }
  if (!cancelled && tasks_.busy(TaskKind::kLoad)) {
    files_.cancel_loading();
    cancelled = true;
  }
  if (cancelled) ws_.say(Message::Kind::kInfo, "Cancelled" + (edits_.waits_for_cuts() ? "" : file));
  return cancelled;
}

void Studio::perform(const Cancel&) {
  held_actions_ = {};
  const bool stopped = cancel_task() || abandon_shape();
  if (clicks_.decline_offer() || stopped || hide_cursor()) return;  // of every Esc: the manual says so
  if (viewport_.floaters_shown()) return viewport_.show_floaters(false);
  if (ws_.view.display != DisplayMode::kWhole)
    return perform(SetView{turned_over(ws_.view, ws_.view.display)});
  if (ws_.view.tool != Tool::kClick) run(Action::kToolClick);
}

void Studio::perform(const Undo&) {
  if (!files_.stop_changing() && !files_.undo_files()) edits_.undo();
}

void Studio::perform(const Redo&) {
  if (!files_.redo_files()) edits_.redo();
}

void Studio::perform(const Recompute&) {
  ws_.require_scene();
  cuts_.recompute();
}

// Asked for a second time, it levels the view: a capture's camera may be tilted.
void Studio::perform(const SetUp& c) {
  edits_.perform_plain(c);
  camera().set_up(document().up_world);
}

// "Click what belongs to it" is said: a tool with which a click does nothing to an object gives way.
void Studio::perform(const NewObject& c) {
  edits_.perform_plain(c);
  const Tool& tool = tool_of(ws_.view.tool);
  if (tool.strokes || tool.clicks_object || tool.selects != Tool::Selects::kNothing) return;
  ViewState view = ws_.view;
  view.tool = Tool::kClick;
  perform(SetView{view});
}

void Studio::perform(const SetView& c) {
  if (c.view.tool != ws_.view.tool) {
    abandon_shape();
    clicks_.decline_offer();  // its keys are those of tools
    held_actions_.meaning.reset();
  }
  if (c.view.display != ws_.view.display && c.view.display == DisplayMode::kIsolate)
    viewport_.turn_about_object();
  ws_.view = c.view;
  show(c.view.display, &ws_.view);
  ++ws_.view_serial;
}

// For commands that move the view without an action: thumbnails, and the axes over the picture.
void Studio::refuse_while_drawing() const {
  if (ws_.tools.at_work()) throw Error("", as_sentence(std::string(kViewStays)));
}

void Studio::perform(const GoToCamera& c) {
  ws_.require_scene();
  refuse_while_drawing();
  camera().go_to(c.camera);
  if (!c.camera.name.empty()) ws_.say(Message::Kind::kInfo, "Camera " + c.camera.name);
}

void Studio::perform(const LookAlong& c) {
  ws_.require_scene();
  refuse_while_drawing();
  if (!(glm::length(c.direction_world) > 0)) throw Error("", "That is no direction");
  camera().finish_transition();
  const std::vector<glm::vec3> points = viewport_.object_points();
  const Box box = robust_bounds(points);
  const glm::vec3 aside = glm::abs(camera().turned_around() - box.centre()) - 0.5f * box.extent();
  if (points.empty() || std::max({aside.x, aside.y, aside.z}) > 0)
    return camera().look_along(c.direction_world);
  // The view turns about the object: all of it stays in the picture, as near as it is where it can.
  const glm::vec3 eye = camera().pose().position_world;
  camera().frame(camera().framing(points, viewport_.pane_camera(), camera().rotation_along(c.direction_world),
                                  glm::distance(eye, box.centre())));
}

// Dark, grey, white, checker, magenta, and dark again.
void Studio::perform(const NextBackdrop&) {
  ws_.require_scene();
  const auto& all = backdrops();
  const auto now =
      std::ranges::find_if(all, [&](const Backdrop& b) { return shows(b, document(), ws_.view); });
  const auto step = now == all.end() ? 0 : (now - all.begin() + 1) % std::ssize(all);
  perform(SetBackdrop{static_cast<std::size_t>(step)});
  ws_.say(Message::Kind::kInfo, std::string("Background: ") + all[static_cast<std::size_t>(step)].name);
}

void Studio::perform(const SetBackdrop& c) {
  ws_.require_scene();
  if (c.number >= backdrops().size()) throw Error("", "There is no such background");
  const Backdrop& backdrop = backdrops()[c.number];
  ViewState view = ws_.view;
  view.checker = backdrop.checker;
  perform(SetView{view});
  if (!backdrop.checker) apply(SetBackground{backdrop.colour});
}

void Studio::perform(const SetFieldOfView& c) {
  camera().set_fov_y(c.fov_y_rad);
}

bool Studio::settle(double most_seconds) {
  const auto start = std::chrono::steady_clock::now();
  while (std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() < most_seconds) {
    update(1.0 / 60);
    if (idle()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  return false;
}

}  // namespace splatcut
