// The sizes that the last click can have. Those beside the one that it has are shown while the pointer stays
// on its dot, and for a while after a step; the one that was asked for is shown until it is computed.
#include <algorithm>

#include "app/studio/clicks.h"

namespace splatcut {

namespace {

constexpr double kShownSeconds = 1.6, kFadeSeconds = 0.6;
constexpr double kAwaitedSeconds = 20;  // a cut that takes longer was not waited for

}  // namespace

// What a click or a step of the wheel asked for is there: it shows from now on.
void Clicks::note_sizes() {
  if (ws_.tools.scale_armed() || ws_.clock_s - stepped_s_ < kAwaitedSeconds) stepped_s_ = ws_.clock_s;
}

float Clicks::sizes_opacity() const {
  if (on_last_dot() || (cuts_.cutting() != 0 && cuts_.cutting() == ws_.document().active)) return 1;
  const double since_s = ws_.clock_s - stepped_s_;
  return static_cast<float>(std::clamp(1 - (since_s - kShownSeconds) / kFadeSeconds, 0.0, 1.0));
}

const StrokeSizes* Clicks::known_sizes() const {
  const ObjectItem* object = ws_.document().active_object();
  const CutRun* run = object ? cuts_.run(object->id) : nullptr;
  if (!run || !run->sizes) return nullptr;
  return run->sizes->key == ws_.history.keys(*object).last_click ? run->sizes.get() : nullptr;
}

std::size_t Clicks::size_wanted() const {
  const StrokeSizes* known = known_sizes();
  if (!known) return 0;
  const Stroke* last = last_stroke(ws_.document().active_object()->views);
  const auto wanted = static_cast<std::ptrdiff_t>(known->likeliest) + last->size_step;
  return static_cast<std::size_t>(
      std::clamp<std::ptrdiff_t>(wanted, 0, static_cast<std::ptrdiff_t>(known->count()) - 1));
}

// The larger one first, as what was clicked is more often too small.
void Clicks::cut_sizes_ahead() {
  const ObjectItem* object = ws_.document().active_object();
  const StrokeSizes* known = known_sizes();
  if (!known || object->locked || ws_.tools.dragging() || !viewport_.idle()) return;
  const std::size_t size = size_wanted();
  const int step = static_cast<int>(size) - static_cast<int>(known->likeliest);
  std::vector<int> steps;
  if (size + 1 < known->count()) steps.push_back(step + 1);
  if (size > 0) steps.push_back(step - 1);
  cuts_.cut_ahead(steps);
}

// Nothing while other meanings of the click are offered and the wheel was not turned: one question at a time.
const StrokeSizes* Clicks::sizes() const {
  const ObjectItem* object = ws_.document().active_object();
  if (!object || object->locked || ws_.view.display != DisplayMode::kWhole || ws_.view.heat ||
      ws_.gaussians_of(object->id) == 0 || sizes_opacity() <= 0)
    return nullptr;
  const StrokeSizes* known = known_sizes();
  if (!known || known->count() < 2 || (last_stroke(object->views)->size_step == 0 && offer())) return nullptr;
  return known;
}

}  // namespace splatcut
