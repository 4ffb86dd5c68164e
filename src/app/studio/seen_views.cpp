#include "app/studio/seen_views.h"

namespace splatcut {

SeenQuestion SeenViews::asked() const {
  return question_of(ws_.view, viewport_.active_labels(), ws_.document().up_world);
}

const UnseenGround* SeenViews::ground() const {
  const bool known = ws_.seen && ws_.seen->up_world == ws_.document().up_world &&
                     ws_.seen->labels == viewport_.active_labels();
  return known ? ws_.seen->ground.get() : nullptr;
}

bool SeenViews::looking() const {
  return ws_.tasks.busy(TaskKind::kSeen);
}

void SeenViews::update() {
  if (!ws_.scene) return;
  const SeenQuestion now = asked();
  if (now.what != given_up_.what) given_up_ = {};
  if (now.what == SeenWhat::kNothing) return ws_.tasks.cancel(TaskKind::kSeen);
  if (!now.labels || !viewport_.style_current() || cuts_.cutting() != 0 || !ws_.tasks.idle() ||
      given_up_ == now || answered_ == now || count_flags(*now.labels) == 0)
    return;
  answered_ = now;
  if (!ws_.seen || !ws_.seen->answers(now)) return start(now);
  auto same = std::make_shared<SeenObject>(*ws_.seen);
  same->labels = now.labels;
  ws_.seen = same;
}

void SeenViews::start(const SeenQuestion& asked) {
  answered_ = {};
  const TaskThread::Order order(TaskKind::kSeen, [this, asked] { given_up_ = asked; });
  ws_.tasks.submit(order, [this, asked, known = ws_.seen, scene = ws_.scene](const Job& job) {
    const auto seen = seen_object(asked, known.get(), *scene, job);
    if (job.cancelled()) return;
    ws_.tasks.post([this, seen, scene, asked] {
      if (scene != ws_.scene) return;
      ws_.seen = seen;
      answered_ = asked;
      ++ws_.view_serial;
    });
  });
}

bool SeenViews::cancel() {
  if (asked().what == SeenWhat::kNothing || !looking()) return false;
  ws_.tasks.cancel(TaskKind::kSeen);
  given_up_ = asked();
  return true;
}

}  // namespace splatcut
