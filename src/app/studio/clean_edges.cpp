#include "app/studio/clean_edges.h"

#include "core/error.h"

namespace splatcut {

void CleanEdges::update() {
  constexpr double kCalmSeconds = 1;
  if (!ws_.scene || !viewport_.style_current() || cuts_.cutting() != 0) return;
  const Flags& labels = viewport_.active_labels();
  if (std::exchange(seen_, labels) != labels || !ws_.tasks.idle()) seen_since_s_ = ws_.clock_s;
  const bool alone = shows_clean_edges(ws_.view), calm = ws_.clock_s - seen_since_s_ > kCalmSeconds;
  const bool wanted = alone || (calm && ws_.view.clean_edges);
  if (!wanted || !labels || settled_ == labels || !ws_.tasks.idle()) return;
  settled_ = labels;
  if (count_flags(*labels) > 0 && !ws_.clean->known(*labels, ws_.document().up_world)) start(labels);
}

void CleanEdges::perform(const CleanAnyway&) {
  const ObjectItem* object = ws_.document().active_object();
  if (!ws_.scene || !object || ws_.gaussians_of(object->id) == 0)
    throw Error("clean edges", "there is no object to clean", "Click an object first");
  ws_.clean->clean_anyway(*ws_.labels.labels(ws_.document(), *object, ws_.gaussians()));
  settled_ = nullptr;
  ++ws_.view_serial;
  ws_.view.clean_edges = true;
}

void CleanEdges::start(const Flags& labels) {
  settled_ = nullptr;
  const TaskThread::Order order(TaskKind::kClean, [this, labels] { settled_ = labels; });
  ws_.tasks.submit(order,
                   [this, labels, clean = ws_.clean, up_world = ws_.document().up_world](const Job& job) {
                     const auto object = clean->made(*labels, up_world, job);
                     if (!object) return;
                     ws_.tasks.post([this, labels, object] {
                       settled_ = labels;
                       ++ws_.view_serial;
                       if (!object->report.cleaned && shows_clean_edges(ws_.view))
                         ws_.say(Message::Kind::kInfo, "Edges stay as they are: " + object->report.reason);
                     });
                   });
}

bool CleanEdges::cancel() {
  if (!shows_clean_edges(ws_.view) || !ws_.tasks.busy(TaskKind::kClean)) return false;
  ws_.tasks.cancel(TaskKind::kClean);
  settled_ = seen_;
  return true;
}

}  // namespace splatcut
