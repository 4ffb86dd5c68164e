#include "app/studio/clean_edges.h"

#include "core/error.h"

namespace splatcut {

void CleanEdges::update() {
  constexpr double kCalmSeconds = 1;
  if (!ws_.scene || !viewport_.style_current() || cuts_.cutting() != 0) return;
  const Flags& labels = viewport_.active_labels();
  if (std::exchange(seen_, labels) != labels || !ws_.tasks.idle()) seen_since_s_ = ws_.clock_s;
  const bool alone = shows_clean_edges(ws_.view), calm = ws_.clock_s - seen_since_s_ > kCalmSeconds;
  const bool wanted = alone || (calm && ws_.view.clean_edges && ws_.options.works_ahead);
  if (!wanted || !labels || !ws_.tasks.idle() || settled_ == now()) return;
  settled_ = now();
  if (count_flags(*labels) > 0 && !ws_.clean->known(labels, ws_.document().up_world)) start();
}

CleanEdges::Asked CleanEdges::now() const {
  return {seen_, ws_.document().up_world, ws_.clean->is_cleaned_anyway(seen_)};
}

void CleanEdges::perform(const CleanAnyway&) {
  const ObjectItem* object = ws_.document().active_object();
  if (!ws_.scene || !object || ws_.gaussians_of(object->id) == 0)
    throw Error("", "There is no object to clean", "Click an object first");
  ws_.clean->clean_anyway(ws_.labels.labels(ws_.document(), *object, ws_.gaussians()));
  ws_.tasks.cancel(TaskKind::kClean);  // what it computes is not wanted any more
  settled_ = {};
  ++ws_.view_serial;
  ws_.view.clean_edges = true;
}

void CleanEdges::start() {
  settled_ = {};
  const Asked asked = now();
  const TaskThread::Order order(TaskKind::kClean, [this, asked] { settled_ = asked; });
  ws_.tasks.submit(order, [this, asked, clean = ws_.clean](const Job& job) {
    const auto object = clean->made(asked.labels, asked.up_world, job);
    if (!object) return;
    ws_.tasks.post([this, asked, clean, object] {
      if (clean != ws_.clean || clean->known(asked.labels, ws_.document().up_world) != object) return;
      settled_ = asked;
      ++ws_.view_serial;
      if (!object->report.cleaned && shows_clean_edges(ws_.view))
        ws_.say(Message::Kind::kInfo, "Edges stay as they are: " + object->report.reason);
    });
  });
}

bool CleanEdges::cancel() {
  if (!shows_clean_edges(ws_.view) || !ws_.tasks.busy(TaskKind::kClean)) return false;
  ws_.tasks.cancel(TaskKind::kClean);
  settled_ = now();
  return true;
}

}  // namespace splatcut
