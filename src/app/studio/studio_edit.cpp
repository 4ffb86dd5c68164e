// Commands that change the document, and what follows from a change.
#include <fmt/format.h>

#include <algorithm>

#include "app/studio/document_edits.h"
#include "app/studio/studio.h"
#include "app/studio/words.h"
#include "core/error.h"

namespace splatcut {

namespace {

const char* title_of(SelectionEdit edit) {
  switch (edit) {
    case SelectionEdit::kAll:
      return "Select all";
    case SelectionEdit::kNone:
      return "Select none";
    case SelectionEdit::kInvert:
      return "Invert";
    case SelectionEdit::kGrow:
      return "Grow";
    case SelectionEdit::kShrink:
      return "Shrink";
    case SelectionEdit::kLargestPart:
      return "Largest part";
    case SelectionEdit::kRemoveFloaters:
      return "Remove floaters";
  }
  return "";
}

const char* title_of(SetOperation operation) {
  switch (operation) {
    case SetOperation::kAdd:
      return "Add";
    case SetOperation::kRemove:
      return "Remove";
    case SetOperation::kIntersect:
      return "Intersect";
  }
  return "";
}

// Titles of the history, and keys by which a slider's steps become one.
struct Titles {
  std::string operator()(const EditSelection& c) const { return title_of(c.edit); }
  std::string operator()(const ClearStrokes&) const { return "Clear strokes"; }
  std::string operator()(const NewObject&) const { return "New object"; }
  std::string operator()(const RemoveObject&) const { return "Remove object"; }
  std::string operator()(const RenameObject& c) const { return "Rename to " + c.name; }
  std::string operator()(const RecolourObject&) const { return "Colour"; }
  std::string operator()(const ShowObject& c) const { return c.visible ? "Show object" : "Hide object"; }
  std::string operator()(const LockObject& c) const { return c.locked ? "Lock object" : "Unlock object"; }
  std::string operator()(const ActivateObject&) const { return "Choose object"; }
  std::string operator()(const MergeObjects&) const { return "Merge objects"; }
  std::string operator()(const SplitObject&) const { return "Split object"; }
  std::string operator()(const DuplicateObject&) const { return "Duplicate object"; }
  std::string operator()(const SeparateObject&) const { return "Separate object"; }
  std::string operator()(const DeleteSelected&) const { return "Delete from the scene"; }
  std::string operator()(const RestoreDeleted&) const { return "Restore deleted"; }
  std::string operator()(const ChooseMeaning& c) const {
    return fmt::format("Meaning {} of the click", c.choice + 1);
  }
  std::string operator()(const LeaveOutView& c) const {
    return c.left_out ? "Leave out a view" : "Use a view";
  }
  std::string operator()(const SetSmoothness&) const { return "Smoothness"; }
  std::string operator()(const SetPreset& c) const { return "Quality: " + c.preset; }
  std::string operator()(const SetBackground&) const { return "Background"; }
  std::string operator()(const SetUp&) const { return "Set up direction"; }
};

template <class C>
std::string merge_key_of(const C&) {
  return {};
}
std::string merge_key_of(const SetSmoothness& c) {
  return fmt::format("smoothness {}", c.object);
}
std::string merge_key_of(const SetBackground&) {
  return "background";
}
std::string merge_key_of(const RecolourObject& c) {
  return fmt::format("colour {}", c.object);
}

}  // namespace

void Studio::require_scene() const {
  if (!scene_)
    throw Error("splatcut", "no scene is open", "Open one with Ctrl+O, or drop a file on the window");
}

EditContext Studio::context() const {
  return {*scene_->cloud, prepared_ ? &prepared_->graph : nullptr};
}

void Studio::push(std::string title, Document after, std::string merge_key, const std::string& message) {
  if (bytes_of(after) == bytes_of(history_.now())) {  // nothing to undo
    say(Message::Kind::kInfo, message);
    return;
  }
  history_.push(std::move(title), std::move(after), std::move(merge_key));
  // Asking again for what was cancelled means that it is wanted now.
  if (const ObjectItem* active = document().active_object()) given_up_.erase(cut_key(document(), *active));
  document_changed();
  say(Message::Kind::kDone, message);
}

template <class DocumentCommand>
void Studio::perform(const DocumentCommand& command) {
  require_scene();
  Document after = history_.now();
  const std::string message = edit(&after, command, context());
  push(Titles{}(command), std::move(after), merge_key_of(command), message);
}

// Performs every document command that has no method of its own.
template void Studio::perform(const EditSelection&);
template void Studio::perform(const ClearStrokes&);
template void Studio::perform(const NewObject&);
template void Studio::perform(const RemoveObject&);
template void Studio::perform(const RenameObject&);
template void Studio::perform(const RecolourObject&);
template void Studio::perform(const ShowObject&);
template void Studio::perform(const LockObject&);
template void Studio::perform(const ActivateObject&);
template void Studio::perform(const MergeObjects&);
template void Studio::perform(const SplitObject&);
template void Studio::perform(const DuplicateObject&);
template void Studio::perform(const SeparateObject&);
template void Studio::perform(const DeleteSelected&);
template void Studio::perform(const RestoreDeleted&);
template void Studio::perform(const ChooseMeaning&);
template void Studio::perform(const LeaveOutView&);
template void Studio::perform(const SetSmoothness&);
template void Studio::perform(const SetPreset&);
template void Studio::perform(const SetBackground&);

void Studio::apply_selection(const Selection& region, SetOperation operation, const std::string& title) {
  Document after = history_.now();
  const std::string message = splatcut::edit_selection(&after, region, operation, context());
  push(title, std::move(after), {}, message);
}

// For what arrives from the worker.
void Studio::select_or_refuse(const Selection& region, SetOperation operation, const std::string& title) {
  try {
    apply_selection(region, operation, title);
  } catch (const Error& error) {
    say(Message::Kind::kRefused, error.what());
  }
}

void Studio::perform(const SelectRegion& c) {
  require_scene();
  if (std::ranges::none_of(c.region.pixels(), [](std::uint8_t p) { return p != 0; }))
    throw Error("selection", "the shape holds no pixel");
  const Flags visible = within_far_plane(*scene_->cloud, c.camera, shown(0), draw_limits().far_plane);
  const std::string title =
      std::string(title_of(c.operation)) + (view_.see_through ? " (see-through)" : " (visible)");
  if (view_.see_through) {
    SeeThroughOptions options;
    if (view_.depth_limit > 0 && picture_ && !picture_->frames.empty()) {
      options.surface_depth = &picture_->frames.front()->depth;
      options.depth_limit = view_.depth_limit * camera_.scene_size();
    }
    apply_selection(select_through(*scene_->cloud, c.camera, c.region,
                                   visible ? std::span(*visible) : std::span<const std::uint8_t>(), options),
                    c.operation, title);
    return;
  }
  tasks_.submit(TaskKind::kSelect, [this, c, visible, title, scene = scene_](const Job& job) {
    job.progress("selecting", 0);
    auto found = select_visible(*scene->cloud, c.camera, c.region,
                                visible ? std::span(*visible) : std::span<const std::uint8_t>(), job);
    if (job.cancelled()) return;
    tasks_.post([this, found = std::move(found), c, title, scene] {
      if (scene == scene_) select_or_refuse(found, c.operation, title);
    });
  });
  if (options_.inline_tasks) tasks_.deliver();
}

void Studio::perform(const SelectVolume& c) {
  require_scene();
  // From the state before its first selection, seen as it was then; a cut in between has reached that, too.
  const bool again = c.adjusts && history_.merges(volume_key_);
  if (!again) {
    volume_key_ = fmt::format("volume {}", ++volumes_);
    volume_seen_ = shown(0);
  }
  Document after = again ? history_.entries()[history_.cursor() - 1].document : history_.now();
  const Selection region = select_volume(
      *scene_->cloud, c.volume, volume_seen_ ? std::span(*volume_seen_) : std::span<const std::uint8_t>());
  const std::string message = splatcut::edit_selection(&after, region, c.operation, context());
  push(std::string(title_of(c.operation)) + (c.volume.round ? " (sphere)" : " (box)"), std::move(after),
       volume_key_, message);
}

void Studio::perform(const SelectColour& c) {
  require_scene();
  apply_selection(select_colour(*scene_->cloud, c.colour, c.tolerance), c.operation,
                  std::string(title_of(c.operation)) + " (colour)");
}

void Studio::require_gaussian(std::int32_t gaussian) const {
  require_scene();
  if (gaussian < 0 || static_cast<std::size_t>(gaussian) >= scene_->cloud->size())
    throw Error("selection", "there is no such Gaussian");
}

void Studio::perform(const PickColour& c) {
  require_gaussian(c.gaussian);
  perform(SelectColour{base_colour(*scene_->cloud, static_cast<std::size_t>(c.gaussian)),
                       view_.colour_tolerance, c.operation});
}

void Studio::perform(const SelectFlood& c) {
  require_gaussian(c.gaussian);
  if (!prepared_) throw Error("flood", "neighbours are still being prepared", "Try again in a moment");
  const Flags visible = shown(0);
  apply_selection(
      select_flood(*scene_->cloud, prepared_->graph, static_cast<std::size_t>(c.gaussian),
                   view_.colour_tolerance, visible ? std::span(*visible) : std::span<const std::uint8_t>()),
      c.operation, std::string(title_of(c.operation)) + " (flood)");
}

void Studio::perform(const SelectRange& c) {
  require_scene();
  const Camera camera = viewport_camera();
  const char* const names[] = {" (opacity)", " (size)", " (depth)"};
  apply_selection(select_range(property_values(*scene_->cloud, c.property, &camera), c.low, c.high),
                  c.operation, std::string(title_of(c.operation)) + names[static_cast<int>(c.property)]);
}

void Studio::perform(const ShowFloaters& c) {
  require_scene();
  highlight_floaters_ = c.shown;
  ++view_serial_;
  if (!c.shown) return;
  refresh_style();
  say(Message::Kind::kInfo, fmt::format("{} Gaussians float apart from the object{}", grouped(floater_count_),
                                        floater_count_ ? ", shown in white" : ""));
}

void Studio::perform(const Undo&) {
  if (!history_.can_undo()) throw Error("undo", "there is nothing to undo");
  const std::string title = history_.entries()[history_.cursor()].title;
  history_.undo();
  document_changed();
  say(Message::Kind::kInfo, "Undone: " + title);
}

void Studio::perform(const Redo&) {
  if (!history_.can_redo()) throw Error("redo", "there is nothing to redo");
  history_.redo();
  document_changed();
  say(Message::Kind::kInfo, "Redone: " + history_.entries()[history_.cursor()].title);
}

void Studio::perform(const JumpHistory& c) {
  if (c.entry >= history_.entries().size()) throw Error("history", "there is no such step");
  history_.jump(c.entry);
  document_changed();
  say(Message::Kind::kInfo, "Back at: " + history_.entries()[c.entry].title);
}

void Studio::perform(const Cancel&) {
  for (const TaskKind kind : {TaskKind::kCut, TaskKind::kSelect, TaskKind::kExport, TaskKind::kLoad}) {
    if (!tasks_.busy(kind)) continue;
    tasks_.cancel(kind);
    if (kind == TaskKind::kCut) {
      given_up_.insert(cutting_key_);
      end_running_cut();
      say(Message::Kind::kInfo, "Cancelled. The strokes stay; R computes the cutout again.");
    } else {
      say(Message::Kind::kInfo, "Cancelled");
    }
    return;
  }
  if (tools_.abandon()) return;
  if (const ClickMeanings* offered = offer()) {
    declined_offer_ = offered->key;
    return;
  }
  if (highlight_floaters_) return perform(ShowFloaters{false});
  if (view_.display != DisplayMode::kWhole) return run(Action::kShowAll);
  if (view_.tool != Tool::kNavigate) run(Action::kToolNavigate);
}

void Studio::perform(const Recompute&) {
  require_scene();
  const ObjectItem* object = document().active_object();
  if (!object || object->views.empty())
    throw Error("cutout", "the object has no strokes", "Click on it first");
  if (!session_) throw Error("cutout", "the scene is still being prepared", "Try again in a moment");
  given_up_.erase(cut_key(document(), *object));
  session_ = std::make_shared<Session>(session_->scene());  // with empty caches
  start_cut(*object);
}

// Asked for a second time, it levels the view: a capture's camera may be tilted.
void Studio::perform(const SetUp& c) {
  require_scene();
  Document after = history_.now();
  const std::string message = edit(&after, c, context());
  push(Titles{}(c), std::move(after), {}, message);
  camera_.set_up(document().up_world);
}

void Studio::perform(const SetView& c) {
  if (c.view.tool != view_.tool) tools_.abandon();
  view_ = c.view;
  ++view_serial_;
}

void Studio::perform(const GoToCamera& c) {
  require_scene();
  camera_.go_to(c.camera);
  if (!c.camera.name.empty()) say(Message::Kind::kInfo, "Camera " + c.camera.name);
}

void Studio::perform(const LookAlong& c) {
  require_scene();
  if (!(glm::length(c.direction_world) > 0)) throw Error("view", "that is no direction");
  camera_.look_along(c.direction_world);
}

// Dark, grey, white, checker, magenta, and dark again.
void Studio::perform(const NextBackdrop&) {
  require_scene();
  const auto& all = backdrops();
  const auto now = std::ranges::find_if(all, [&](const Backdrop& b) { return shows(b, document(), view_); });
  const auto step = now == all.end() ? 0 : (now - all.begin() + 1) % std::ssize(all);
  perform(SetBackdrop{static_cast<std::size_t>(step)});
}

void Studio::perform(const SetBackdrop& c) {
  require_scene();
  if (c.number >= backdrops().size()) throw Error("background", "there is no such one");
  const Backdrop& backdrop = backdrops()[c.number];
  ViewState view = view_;
  view.checker = backdrop.checker;
  perform(SetView{view});
  if (!backdrop.checker) perform(SetBackground{backdrop.colour});
}

void Studio::perform(const SetFieldOfView& c) {
  camera_.set_fov_y(c.fov_y_rad);
}

void Studio::document_changed() {
  ++document_serial_;
  counts_.clear();
  autosave_wait_s_ = 0;
  constexpr float kSameDirection = 0.99999f;  // the controller keeps it normalised
  if (glm::dot(glm::normalize(document().up_world), camera_.up_world()) < kSameDirection)
    camera_.set_up(document().up_world);
  show_runs_of_now();
  // Alone, an empty object would be a black picture.
  if (scene_ && view_.display != DisplayMode::kWhole && gaussians_of(document().active) == 0 &&
      cutting_object_ == 0) {
    view_.display = DisplayMode::kWhole;
    ++view_serial_;
  }
}

std::vector<std::uint8_t> Studio::labels(ObjectId object) const {
  const ObjectItem* item = document().find(object);
  if (!item || !scene_) return {};
  return labels_of(document(), *item, scene_->cloud->size());
}

std::size_t Studio::gaussians_of(ObjectId object) const {
  const auto known = counts_.find(object);
  if (known != counts_.end()) return known->second;
  return counts_[object] = count_flags(labels(object));
}

}  // namespace splatcut
