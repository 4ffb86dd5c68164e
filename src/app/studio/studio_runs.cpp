// Which cut of an object is shown: that of the labels, wherever the history stands.
#include <algorithm>

#include "app/studio/studio.h"

namespace splatcut {

const CutRun* Studio::cut_run(ObjectId object) const {
  const auto found = runs_.find(object);
  return found == runs_.end() ? nullptr : &found->second;
}

// Of objects that are gone the last few are kept, as undo may bring them back; those before have no pictures
// of their views then, as in opened work, until they are cut again.
void Studio::forget_runs() {
  constexpr int kMostGone = 8;
  int gone = 0;
  for (auto run = runs_.end(); run != runs_.begin();) {
    --run;
    if (!document().find(run->first) && ++gone > kMostGone) run = runs_.erase(run);
  }
}

void Studio::keep_run(ObjectId object, CutRun run) {
  constexpr std::size_t kMostBefore = 24;
  std::erase_if(runs_before_, [&](const auto& b) { return b.first == object && b.second.key == run.key; });
  runs_before_.emplace_back(object, std::move(run));
  if (runs_before_.size() > kMostBefore) runs_before_.pop_front();
}

// Of that key, shown now or kept for a step in the history; null: forgotten.
CutRun* Studio::run_of(ObjectId object, const std::string& key) {
  const auto now = runs_.find(object);
  if (now != runs_.end() && now->second.key == key) return &now->second;
  const auto before = std::ranges::find_if(
      runs_before_, [&](const auto& b) { return b.first == object && b.second.key == key; });
  return before == runs_before_.end() ? nullptr : &before->second;
}

// If it has no labels yet, shows those before again.
void Studio::end_running_cut() {
  runs_[cutting_object_].running = false;
  runs_[cutting_object_].preview = nullptr;
  cutting_object_ = 0;
  ++view_serial_;
  show_runs_of_now();
}

// Shows thumbnails, doubts and times of the labels at the history's cursor.
void Studio::show_runs_of_now() {
  for (const ObjectItem& object : document().objects) {
    const auto now = runs_.find(object.id);
    const bool differs = now == runs_.end() ? !object.cut_key.empty()
                                            : !now->second.running && now->second.key != object.cut_key;
    if (!differs || object.id == cutting_object_) continue;
    if (now != runs_.end() && now->second.result) {
      keep_run(object.id, std::move(now->second));
    }
    if (now != runs_.end()) runs_.erase(now);
    const auto then = std::ranges::find_if(runs_before_, [&](const auto& run) {
      return run.first == object.id && run.second.key == object.cut_key;
    });
    if (then == runs_before_.end()) continue;
    runs_[object.id] = std::move(then->second);
    runs_before_.erase(then);
  }
}

}  // namespace splatcut
