#include "app/studio/edits.h"
#include "app/document/words.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/error.h"

namespace splatcut {

namespace {

std::span<const std::uint8_t> all_of(const Flags& flags) {
  return flags ? std::span(*flags) : std::span<const std::uint8_t>();
}

}  // namespace

void Edits::in_turn(std::function<void()> command, OnCancel on_cancel, std::string writes) {
  if (under_way_)
    waiting_.push_back({std::move(command), on_cancel, std::move(writes)});
  else
    command();
}

void Edits::at_last(std::function<void()> command) {
  const auto is_dropped = [](const Waiting& w) { return w.on_cancel == OnCancel::kDropped; };
  if (!under_way_ && std::ranges::none_of(waiting_, is_dropped)) return command();
  waiting_.push_back({[this, command = std::move(command)] { at_last(command); }, OnCancel::kStays, {}});
}

void Edits::after_cuts(const std::string& title, std::function<void()> command, bool writes_file) {
  const ObjectId object = cuts_.next();
  under_way_ = true;
  for_cuts_ = std::move(command);
  for_cuts_title_ = title;
  for_cuts_writes_ = writes_file;
  cuts_failed_ = cuts_.failed();
  ws_.say(Message::Kind::kInfo,
          fmt::format("{}: as soon as {} is computed", title, ws_.document().find(object)->name));
}

void Edits::once_cut(SetOperation operation, const std::string& title, std::function<void()> command) {
  if (operation == SetOperation::kAdd || cuts_.next() == 0) return command();
  after_cuts(title, [this, command = std::move(command)] {
    try {
      command();
    } catch (const Error& error) {
      ws_.say(Message::Kind::kRefused, error.what());
    }
  });
}

std::vector<std::string> Edits::files_waiting() const {
  std::vector<std::string> files;
  if (for_cuts_ && for_cuts_writes_) files.push_back(for_cuts_title_);
  for (const Waiting& waiting : waiting_)
    if (!waiting.writes.empty()) files.push_back(waiting.writes);
  return files;
}

void Edits::update() {
  for (const std::string& lost : std::exchange(lost_, {}))
    ws_.say_also(Message::Kind::kError, lost + ": not done, as another scene was opened before");
  if (!for_cuts_) return;
  if (cuts_.failed() != cuts_failed_) {
    const std::string scene = scene_waits_for_cuts() ? ". The other scene is not opened" : "";
    ws_.say_also(Message::Kind::kRefused,
                 for_cuts_title_ + ": not done, as what it waited for failed" + scene);
    cancel();
    return;
  }
  if (cuts_.next() != 0) return;
  const std::function<void()> command = std::exchange(for_cuts_, nullptr);
  waiting_.push_front({command, OnCancel::kDropped, {}});
  finish();
}

bool Edits::cancel() {
  if (!under_way_) return false;
  if (scene_waits_for_cuts())
    std::erase_if(waiting_, [](const Waiting& w) { return w.on_cancel == OnCancel::kWithFile; });
  for_cuts_ = nullptr;
  for (TaskThread* tasks : {&ws_.quick, &ws_.tasks}) tasks->cancel(TaskKind::kSelect);
  ++number_;
  std::erase_if(waiting_, [](const Waiting& w) { return w.on_cancel == OnCancel::kDropped; });
  finish();
  return true;
}

bool Edits::scene_waits_for_cuts() const {
  return for_cuts_ && for_cuts_writes_ &&
         std::ranges::any_of(waiting_, [](const Waiting& w) { return w.on_cancel == OnCancel::kWithFile; });
}

std::string Edits::dropped_by_cancel() const {
  if (!for_cuts_ || !for_cuts_writes_) return {};
  return fmt::format(". {}: not done{}", for_cuts_title_,
                     scene_waits_for_cuts() ? ", and the other scene is not opened" : "");
}

void Edits::reset(bool same) {
  if (!same) lost_ = files_waiting();
  std::erase_if(waiting_, [&](const Waiting& w) { return !same || w.on_cancel == OnCancel::kDropped; });
  cancel();
  volume_key_.clear();
  volume_seen_.reset();
}

void Edits::push(std::string title, Document after, std::string merge_key, const std::string& message) {
  if (!ws_.history.push(std::move(title), std::move(after), std::move(merge_key)))
    return ws_.say(Message::Kind::kInfo, message);
  // Asking again for what was cancelled means that it is wanted now.
  const ObjectItem* active = ws_.document().active_object();
  if (active) cuts_.want_again(*active);
  const bool comes = active && cuts_.comes(*active);  // it is done once the cut is
  ws_.say(comes ? Message::Kind::kInfo : Message::Kind::kDone, message);
}

std::uint64_t Edits::begin() {
  under_way_ = true;
  return ++number_;
}

void Edits::end(std::uint64_t number, const std::function<void()>& last) {
  if (number != number_) return;
  if (last) last();
  if (number == number_) finish();
}

void Edits::push_later(const Step& step) {
  begin();
  start(step);
}

void Edits::push_once_cut(SetOperation operation, const Step& step) {
  once_cut(operation, step.title, [this, step] { push_later(step); });
}

void Edits::start(const Step& step) {
  const History& history = ws_.history;
  Document before = step.replaces && history.merges(step.merge_key)
                        ? history.entries()[history.cursor() - 1].document
                        : history.now();
  const auto failed = [this, number = number_] { end(number); };
  ws_.quick.submit({TaskKind::kSelect, failed}, [this, step, document = std::move(before), failed,
                                                 serial = history.serial(), number = number_,
                                                 scene = ws_.scene, graph = ws_.graph](const Job& job) {
    job.progress("selecting", 0);
    Document after = document;
    std::string message, refusal;
    try {
      message = step.change(&after, {*scene->cloud, graph.get(), job}, job);
    } catch (const Error& error) {
      refusal = error.what();
    }
    if (job.cancelled()) return;
    ws_.quick.post([this, step, after = std::move(after), message, refusal, serial, number, failed] {
      if (number != number_) return;
      if (serial != ws_.history.serial()) return start(step);
      if (refusal.empty())
        push(step.title, after, step.merge_key, message);
      else
        ws_.say(Message::Kind::kRefused, refusal);
      finish();
    });
  });
}

void Edits::finish() {
  under_way_ = false;
  while (!under_way_ && !waiting_.empty()) {
    const std::function<void()> next = std::move(waiting_.front().command);
    waiting_.pop_front();
    next();
  }
}

void Edits::select_later(Selection region, SetOperation operation, std::string title) {
  push_later({std::move(title),
              {},
              [region = std::move(region), operation](Document* d, const EditContext& context, const Job&) {
                return edit_selection(d, region, operation, context);
              }});
}

template <class C>
void Edits::change_all(const C& c) {
  Document now = ws_.document();
  const std::string message = edit(&now, c, ws_.context());
  ws_.history.change_all([&](Document* state) {
    try {
      edit(state, c, ws_.context());
    } catch (const Error&) {  // an older or newer state has nothing to change
    }
  });
  if constexpr (std::is_same_v<C, ActivateObject>)  // its strokes are to count
    if (const ObjectItem* active = ws_.document().active_object()) cuts_.want_again(*active);
  ws_.say(Message::Kind::kInfo, message);
}

void Edits::perform_plain(const Command& command) {
  return std::visit(
      [this](const auto& c) {
        if constexpr (kKnows<std::decay_t<decltype(c)>>) {
          ws_.require_scene();
          if constexpr (kPasses<std::decay_t<decltype(c)>>) {
            push_later({c.title(), merge_key_of(c), [c](Document* d, const EditContext& context, const Job&) {
                          return edit(d, c, context);
                        }});
          } else if constexpr (kNoWork<std::decay_t<decltype(c)>>) {
            change_all(c);
          } else {
            Document after = ws_.document();
            const std::string message = edit(&after, c, ws_.context());
            push(title_of(c, ws_.document()), std::move(after), merge_key_of(c), message);
          }
        }
      },
      command);
}

TakenBy Edits::taken_by() const {
  return ws_.view.by_centre ? TakenBy::kCentre : TakenBy::kFootprint;
}

void Edits::perform(const SelectRegion& c) {
  ws_.require_scene();
  if (std::ranges::none_of(c.region.pixels(), [](std::uint8_t p) { return p != 0; }))
    throw Error("", "The shape holds no pixel");
  const DrawLimits limits = viewport_.draw_limits();
  const bool through = ws_.view.see_through, on_surface = !through && !c.path_px.empty();
  const bool limited = through && ws_.view.depth_limit > 0;
  const float depth_limit = ws_.view.depth_limit * viewport_.camera().scene_size();
  const std::shared_ptr<const Frame> surface = viewport_.full_picture_of(c.camera, viewport_.pressed_pane());
  push_once_cut(
      c.operation,
      {fmt::format("{} ({}, {})", title_of(c.operation), c.shape, through ? "see-through" : "visible"),
       {},
       [c, limits, through, limited, on_surface, depth_limit, surface, by = taken_by(),
        shown = viewport_.shown(viewport_.pressed_pane())](Document* document, const EditContext& context,
                                                           const Job& job) {
         const Flags visible = within_far_plane(context.cloud, c.camera, shown, limits.far_plane);
         SeeThroughOptions options{.by = by};
         std::shared_ptr<const Frame> frame = surface;
         if ((limited || on_surface) && !frame)
           frame = raster_frame(context.cloud, c.camera, shown, limits, job);
         if (limited && frame) options = {&frame->depth, depth_limit, by};
         const Mask region =
             on_surface && frame ? surface_region(c.region, c.path_px, frame->depth) : c.region;
         const Selection found =
             through ? select_through(context.cloud, c.camera, region, all_of(visible), options)
                     : select_visible(context.cloud, c.camera, region, all_of(visible), by, job);
         return job.cancelled() ? std::string() : edit_by_shape(document, found, c.operation, context);
       }});
}

// From the state before its first selection, seen as it was then; a cut in between has reached that, too.
void Edits::perform(const SelectVolume& c) {
  ws_.require_scene();
  const bool again = c.adjusts && ws_.history.merges(volume_key_);
  if (!again) {
    volume_key_ = fmt::format("volume {}", ++volumes_);
    volume_seen_ = viewport_.shown(viewport_.pressed_pane());
  }
  push_once_cut(
      c.operation,
      {std::string(title_of(c.operation)) + (c.volume.round ? " (sphere)" : " (box)"), volume_key_,
       [c, seen = volume_seen_, by = taken_by()](Document* document, const EditContext& context, const Job&) {
         return edit_by_shape(document, select_volume(context.cloud, c.volume, all_of(seen), by), c.operation,
                              context);
       },
       again});
}

void Edits::perform(const SelectColour& c) {
  ws_.require_scene();
  push_once_cut(c.operation, {std::string(title_of(c.operation)) + " (colour)",
                              {},
                              [c](Document* document, const EditContext& context, const Job&) {
                                return edit_selection(document,
                                                      select_colour(context.cloud, c.colour, c.tolerance),
                                                      c.operation, context);
                              }});
}

void Edits::require_gaussian(std::int32_t gaussian) const {
  ws_.require_scene();
  if (gaussian < 0) throw Error("", "There is nothing in that place", "Click on something that can be seen");
  if (static_cast<std::size_t>(gaussian) >= ws_.gaussians()) throw Error("", "There is no such Gaussian");
}

void Edits::perform(const PickColour& c) {
  require_gaussian(c.gaussian);
  perform(SelectColour{base_colour(*ws_.scene->cloud, static_cast<std::size_t>(c.gaussian)),
                       ws_.view.colour_tolerance, c.operation});
}

void Edits::perform(const SelectFlood& c) {
  require_gaussian(c.gaussian);
  push_once_cut(
      c.operation,
      {std::string(title_of(c.operation)) + " (flood)",
       {},
       [c, shown = viewport_.shown(viewport_.pressed_pane()), tolerance = ws_.view.colour_tolerance](
           Document* document, const EditContext& context, const Job&) {
         const auto start = static_cast<std::size_t>(c.gaussian);
         return edit_selection(
             document,
             select_flood(context.cloud, context.graph->get(context.job), start, tolerance, all_of(shown)),
             c.operation, context);
       }});
}

void Edits::perform(const SelectScene& c) {
  ws_.require_scene();
  const SceneSource* file = ws_.scene->file(c.file);
  if (!file) throw Error("", "There is no such file");
  push_once_cut(c.operation,
                {fmt::format("{} ({})", title_of(c.operation), scene_name(file->path)),
                 {},
                 [c, scene = ws_.scene](Document* document, const EditContext& context, const Job&) {
                   return edit_selection(document, gaussians_of(*scene, c.file), c.operation, context);
                 }});
}

void Edits::perform(const SelectRange& c) {
  ws_.require_scene();
  const char* const names[] = {" (opacity)", " (size)", " (depth)", " (needles)"};
  push_once_cut(
      c.operation,
      {std::string(title_of(c.operation)) + names[static_cast<int>(c.property)],
       {},
       [c, camera = viewport_.pane_camera()](Document* document, const EditContext& context, const Job&) {
         const std::vector<float> values = property_values(context.cloud, c.property, &camera);
         return edit_selection(document, select_range(values, c.low, c.high), c.operation, context);
       }});
}

void Edits::undo() {
  History& history = ws_.history;
  if (!history.can_undo()) throw Error("", "There is nothing to undo");
  const std::string title = row_title(history, history.cursor());
  history.undo();
  ws_.say(Message::Kind::kInfo, "Undone: " + title);
}

void Edits::redo() {
  History& history = ws_.history;
  if (!history.can_redo()) throw Error("", "There is nothing to redo");
  history.redo();
  ws_.say(Message::Kind::kInfo, "Redone: " + row_title(history, history.cursor()));
}

}  // namespace splatcut
