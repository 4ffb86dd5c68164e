// Changes of files as steps of the history: undo, redo, jumps. Each step keeps the scene before it.
#include <algorithm>
#include <utility>

#include "app/studio/scene_files.h"
#include "core/error.h"

namespace splatcut {

SceneFiles::Kept SceneFiles::kept_now(std::uint64_t step) const {
  return {step, ws_.scene, ws_.graph, ws_.session, ws_.clean, ws_.coarse, ws_.history};
}

// Each holds a scene.
void SceneFiles::keep_before(Kept kept) {
  constexpr std::size_t kAlwaysKept = 3;
  before_files_.push_back(std::move(kept));
  std::size_t gaussians = 0, fit = 0;
  for (auto k = before_files_.rbegin(); k != before_files_.rend(); ++k) {
    gaussians += k->scene->cloud->size();
    if (fit >= kAlwaysKept && gaussians > ws_.options.most_kept_gaussians) break;
    ++fit;
  }
  before_files_.erase(before_files_.begin(), before_files_.end() - static_cast<std::ptrdiff_t>(fit));
}

void SceneFiles::go_back_to(Kept kept) {
  stop_for_loading();
  interrupted_.reset();
  cancel_loading();
  preparing_stopped_ = false;
  take(kept.scene);
  ws_.graph = std::move(kept.graph);
  ws_.session = std::move(kept.session);
  ws_.clean = std::move(kept.clean);
  ws_.coarse = std::move(kept.coarse);
  ws_.history = std::move(kept.history);
  calls_.opened(true);
  start_preparing();
}

bool SceneFiles::stop_changing() {
  if (!changing()) return false;
  cancel_loading();
  ws_.say(Message::Kind::kInfo, "The files stay as they are");
  return true;
}

bool SceneFiles::undo_files() {
  if (!ws_.history.can_undo()) return false;
  const History::Entry& entry = ws_.history.entries()[ws_.history.cursor()];
  if (entry.other_files == 0) return false;
  const std::string title = entry.title;
  if (stays(entry)) {
    ws_.history.undo();
    ws_.say(Message::Kind::kInfo, "Not undone: " + title + ". The scene before it is no longer kept");
    return true;
  }
  if (redo_steps_ != ws_.history.steps_serial()) undone_files_.clear();  // another way was taken since
  undone_files_.push_back(kept_now(entry.other_files));
  const auto before = std::ranges::find(before_files_, entry.other_files, &Kept::step);
  Kept to = std::move(*before);
  before_files_.erase(before, before_files_.end());
  go_back_to(std::move(to));
  redo_steps_ = ws_.history.steps_serial();
  ws_.say(Message::Kind::kInfo, "Undone: " + title);
  return true;
}

bool SceneFiles::stays(const History::Entry& step) const {
  return step.other_files != 0 && std::ranges::count(before_files_, step.other_files, &Kept::step) == 0;
}

std::vector<std::string> SceneFiles::redo_titles() const {
  std::vector<std::string> titles;
  if (redo_steps_ != ws_.history.steps_serial()) return titles;
  for (auto kept = undone_files_.rbegin(); kept != undone_files_.rend(); ++kept)
    for (std::size_t i = kept->history.cursor(); i < kept->history.entries().size(); ++i)
      titles.push_back(row_title(kept->history, i));
  return titles;
}

bool SceneFiles::redo_files() {
  if (ws_.history.can_redo()) {
    const History::Entry& next = ws_.history.entries()[ws_.history.cursor() + 1];
    if (next.other_files == 0) return false;
    ws_.history.redo();
    ws_.say(Message::Kind::kInfo, "Nothing to redo: " + next.title + ". It was not undone");
    return true;
  }
  if (!can_redo_files()) return false;
  Kept to = std::move(undone_files_.back());
  undone_files_.pop_back();
  keep_before(kept_now(to.step));
  go_back_to(std::move(to));
  redo_steps_ = ws_.history.steps_serial();
  ws_.say(Message::Kind::kInfo, "Redone: " + ws_.history.entries()[ws_.history.cursor()].title);
  return true;
}

// A kept scene's history ends at the step before its change of files.
void SceneFiles::perform(const JumpHistory& c) {
  std::size_t entry = c.entry;
  if (entry >= ws_.history.entries().size() + redo_titles().size()) throw Error("", "There is no such step");
  while (entry >= ws_.history.entries().size()) {
    const std::size_t behind = entry - ws_.history.entries().size();
    ws_.history.jump(ws_.history.entries().size() - 1);
    redo_files();
    entry = ws_.history.cursor() + behind;
  }
  const auto changed_between = [&] {
    std::size_t at = ws_.history.cursor();
    while (at > entry && ws_.history.entries()[at].other_files == 0) --at;
    return at;
  };
  for (std::size_t change = changed_between(); change > entry; change = changed_between()) {
    const std::size_t steps = change - entry;
    ws_.history.jump(change);
    undo_files();
    entry = ws_.history.cursor() - std::min(steps - 1, ws_.history.cursor());
  }
  ws_.history.jump(entry);
  ws_.say(Message::Kind::kInfo, "Now at: " + ws_.history.entries()[entry].title);
}

}  // namespace splatcut
