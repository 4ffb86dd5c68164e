#include "app/studio/seen_views.h"

namespace splatcut {

bool SeenViews::known(const Flags& labels) const {
  return labels && ws_.seen && ws_.seen->up_world == ws_.document().up_world &&
         (ws_.seen->labels == labels || *ws_.seen->labels == *labels);
}

const UnseenGround* SeenViews::ground() const {
  return known(viewport_.active_labels()) ? ws_.seen->ground.get() : nullptr;
}

void SeenViews::update() {
  const bool heat = shows_seen_heat(ws_.view), ground = ws_.view.display == DisplayMode::kHide;
  if (!ws_.scene || !(heat || ground) || !viewport_.style_current() || cuts_.cutting() != 0 ||
      !ws_.tasks.idle())
    return;
  const Flags& labels = viewport_.active_labels();
  if (!labels || given_up_ == labels || count_flags(*labels) == 0) return;
  if (known(labels) && (heat ? ws_.seen->heat != nullptr : ws_.seen->ground != nullptr)) return;
  start(labels, heat);
}

void SeenViews::start(const Flags& labels, bool heat) {
  given_up_ = nullptr;
  const TaskThread::Order order(TaskKind::kSeen, [this, labels] { given_up_ = labels; });
  auto seen = std::make_shared<SeenObject>();
  if (known(labels)) *seen = *ws_.seen;
  seen->labels = labels;
  seen->up_world = ws_.document().up_world;
  ws_.tasks.submit(order, [this, seen, heat, scene = ws_.scene](const Job& job) {
    const Drawer drawer(*scene->cloud, nullptr, scene->blocks.get());
    const std::vector<Camera>& cameras = scene->views().cameras;
    if (heat)
      seen->heat = std::make_shared<const std::vector<float>>(
          heat_of(seen_by_views(drawer, *seen->labels, seen->up_world, cameras, job), *seen->labels));
    else
      seen->ground = std::make_shared<const UnseenGround>(
          unseen_ground(drawer, *seen->labels, seen->up_world, cameras, job));
    if (job.cancelled()) return;
    ws_.tasks.post([this, seen, scene] {
      if (scene != ws_.scene) return;
      ws_.seen = seen;
      ++ws_.view_serial;
    });
  });
}

bool SeenViews::cancel() {
  if (!ws_.tasks.busy(TaskKind::kSeen)) return false;
  ws_.tasks.cancel(TaskKind::kSeen);
  given_up_ = viewport_.active_labels();
  return true;
}

}  // namespace splatcut
