#include "app/studio/saved_work.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <thread>
#include <utility>

#include "app/console/kept_inputs.h"
#include "app/work/work_history.h"
#include "app/work/work_picture.h"
#include "core/error.h"

namespace splatcut {

namespace {

// A change is saved once nothing more has changed for a moment, or after some seconds of changes without a
// pause. What takes long to write is written after a rest in proportion. Moves of the view alone are saved
// later: it moves all the time.
constexpr double kAutosaveAfterSeconds = 0.3, kAutosaveAtLatestSeconds = 2, kAutosaveViewAfterSeconds = 10,
                 kAutosaveAgainSeconds = 30, kRestOverWriting = 3;

}  // namespace

SavedWork::SavedWork(Workspace& workspace, Viewport& viewport, const CutJobs& cuts)
    : ws_(workspace), viewport_(viewport), cuts_(cuts), autosaves_(workspace.options.state_folder) {
  autosaved_serial_ = saved_serial_ = ws_.history.serial();
  find_offers();
}

// Nothing is work, too, where there was some: it was all removed.
bool SavedWork::unsaved() const {
  return ws_.scene && (saved_is_work_ || is_work(ws_.document())) && differs();
}

bool SavedWork::is_work(const Document& document) const {
  return !document.objects.empty() || document.deleted || ws_.scene->files.size() > 1;
}

// What is chosen and what lies behind the scene is no work.
bool SavedWork::differs() const {
  const std::uint64_t serial = ws_.history.serial();
  if (saved_serial_ == serial) return false;
  if (saved_serial_ == 0 || saved_scene_ != ws_.scene->serial) return true;
  if (std::exchange(compared_serial_, serial) == serial) return differs_;
  Document now = ws_.document();
  now.active = saved_document_.active;
  now.background = saved_document_.background;
  return differs_ = !same(now, saved_document_);
}

void SavedWork::keep_as_saved(std::uint64_t serial, const Document& document, std::uint64_t scene) {
  saved_serial_ = serial;
  saved_document_ = document;
  saved_is_work_ = is_work(document);
  saved_scene_ = scene;
  compared_serial_ = 0;
}

// A file without work, nor any that could be redone, goes. What was restored is not offered again while it
// waits to be saved. What is known of a file stays: nobody writes it any more.
void SavedWork::find_offers() {
  std::vector<LeftWork> found;
  for (const std::filesystem::path& file : autosaves_.left_behind()) {
    if (file == restored_ || keeping_.contains(file)) continue;
    const auto known = std::ranges::find(offers_, file, &LeftWork::file);
    LeftWork left = known == offers_.end() ? left_work(file) : *known;
    if (left.nothing) {
      autosaves_.remove(file);
      continue;
    }
    found.push_back(std::move(left));
    if (found.back().serial == 0) found.back().serial = next_offer_serial_++;
  }
  offers_ = std::move(found);
  sort_offers();
}

void SavedWork::sort_offers() {
  if (!ws_.scene) return;
  const auto others = std::stable_partition(offers_.begin(), offers_.end(), [&](const LeftWork& left) {
    return same_file(left.scene, ws_.scene->scene->path);
  });
  own_offers_ = static_cast<std::size_t>(others - offers_.begin());
}

void SavedWork::opened(const std::optional<RestoredWork>& work, const std::filesystem::path& file) {
  const bool own = is_work_file(file) && file.parent_path() != ws_.options.state_folder;
  work_path_ = own ? file : std::filesystem::path();
  std::error_code failure;
  if (work && !own && is_regular_file(work->saved_as, failure)) work_path_ = work->saved_as;
  if (work && std::ranges::find(offers_, file, &LeftWork::file) != offers_.end()) restored_ = file;
  autosaved_serial_ = ws_.history.serial();
  keep_as_saved(autosaved_serial_, ws_.document(), ws_.scene->serial);
  autosaved_view_ = seen();
  if (work && !own) autosaved_serial_ = saved_serial_ = 0;  // restored: nowhere else yet
  written_in_s_ = 0;
  find_offers();
}

// A program that was killed may hold its autosave for some seconds more: until its memory is given back. In
// the first of them it is likely, and looked for also where older work is offered.
void SavedWork::look_for_more(double seconds) {
  constexpr double kLikelySeconds = 10, kOftenSeconds = 0.25, kEverySeconds = 2, kForSeconds = 60;
  const bool likely = looked_for_s_ < kLikelySeconds;
  if ((!likely && !offers_.empty()) || looked_for_s_ > kForSeconds) return;
  const double every_s = likely ? kOftenSeconds : kEverySeconds;
  const bool now = std::floor(looked_for_s_ / every_s) < std::floor((looked_for_s_ + seconds) / every_s);
  looked_for_s_ += seconds;
  if (!now) return;
  autosaves_.look_again();
  find_offers();
}

void SavedWork::update(double seconds) {
  look_for_more(seconds);
  if (!ws_.scene || autosaves_.own().empty()) return;
  const std::uint64_t serial = ws_.history.serial();
  rested_s_ += seconds;
  if (std::exchange(waiting_serial_, serial) != serial) quiet_s_ = 0;
  const bool shows_other =
      unsaved() && (autosaved_view_.display != ws_.view.display || autosaved_view_.hidden != ws_.view.hidden);
  const bool changed = autosaved_serial_ != serial || shows_other;
  const bool looks_elsewhere = unsaved() && autosaved_view_ != seen();
  if (!changed && !looks_elsewhere) return;
  quiet_s_ += seconds;
  unkept_s_ = changed ? unkept_s_ + seconds : 0;
  const bool due = quiet_s_ >= (changed ? kAutosaveAfterSeconds : kAutosaveViewAfterSeconds) ||
                   unkept_s_ >= kAutosaveAtLatestSeconds;
  if (!due || rested_s_ < kRestOverWriting * written_in_s_) return;
  quiet_s_ = unkept_s_ = rested_s_ = 0;
  autosaved_serial_ = serial;
  autosaved_view_ = seen();
  const auto failed = [this] {  // not forgotten: tried again without another change
    autosaved_serial_ = 0;
    rested_s_ = kRestOverWriting * written_in_s_ - kAutosaveAgainSeconds;
  };
  ws_.writes.submit({TaskKind::kAutosave, failed}, autosaving());
}

WorkView SavedWork::seen() const {
  return {viewport_.camera().kept_pose(), ws_.view.display, ws_.view.hidden, cuts_.doubtful_sides()};
}

// Shading costs as much as a frame, so the worker does it: of the frame that is shown now.
std::function<Image<Rgb8>()> SavedWork::small_picture() const {
  const FrameResult* shown = viewport_.picture();
  if (!shown || shown->scene != ws_.scene->serial || shown->frames.empty() || shown->owners.empty())
    return [] { return Image<Rgb8>(); };
  FrameStyle style = viewport_.style(0);
  style.highlight = nullptr;  // of the pointer: no work
  if (style.owner && style.owner->size() != ws_.gaussians()) style.owner = nullptr;  // of the files before
  if (style.heat && style.heat->size() != ws_.gaussians()) style.heat = nullptr;
  return [style, frame = shown->frames.front(), owners = shown->owners.front()] {
    return work_picture(shaded(*frame, style, owners.get()));
  };
}

TaskThread::Work SavedWork::autosaving() {
  return [this, path = autosaves_.own(), restored = restored_, document = ws_.document(),
          view = autosaved_view_, scene = ws_.scene, steps = saved_steps(ws_.history),
          picture = small_picture(), saved_as = work_path_](const Job&) {
    const auto start = std::chrono::steady_clock::now();
    write_work_file(path, *scene, document, view, steps, saved_as);
    write_work_picture(path, picture());
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
    ws_.writes.post([this, restored, seconds = took.count()] {
      written_in_s_ = seconds;
      rested_s_ = 0;
      forget_restored(restored);
    });
  };
}

// It is in a file of this program now; what was left behind before it is offered next.
void SavedWork::forget_restored(const std::filesystem::path& file) {
  if (file.empty() || file != restored_) return;
  autosaves_.remove(std::exchange(restored_, {}));
  find_offers();
}

void SavedWork::keep_unsaved() {
  if (!ws_.scene || autosaves_.own().empty() || !unsaved()) return;
  ws_.writes.cancel(TaskKind::kAutosave);
  autosaved_view_ = seen();
  // It is waited for when the worker ends; what it posts comes too late.
  ws_.writes.submit(TaskKind::kSave, [write = autosaving(), restored = restored_](const Job& job) {
    write(job);
    std::error_code ignored;
    std::filesystem::remove(restored, ignored);
    if (!restored.empty()) std::filesystem::remove(picture_of_work(restored), ignored);
  });
}

void SavedWork::keep_from_other_scene() {
  if (!ws_.scene || autosaves_.own().empty() || !unsaved()) return;
  ws_.writes.cancel(TaskKind::kAutosave);
  const auto done = [this, file = autosaves_.own(), restored = restored_](bool written) {
    if (written) autosaves_.remove(restored);  // its work is in the other
    for (const std::filesystem::path& kept : {file, restored}) keeping_.erase(kept);
    find_offers();
  };
  keeping_.insert({autosaves_.own(), restored_});
  const TaskThread::Order order(TaskKind::kSave, [done] { done(false); });
  ws_.writes.submit(order, [this, done, write = autosaving()](const Job& job) {
    write(job);
    ws_.writes.post([done] { done(true); });
  });
  autosaves_.leave_own();
}

void SavedWork::leave() {
  if (unsaved()) return keep_unsaved();
  if (autosaves_.own().empty()) return;
  ws_.writes.cancel(TaskKind::kAutosave);
  while (ws_.writes.busy(TaskKind::kAutosave)) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  forget_restored(restored_);
  std::error_code ignored;
  std::filesystem::remove(autosaves_.own(), ignored);
  std::filesystem::remove(picture_of_work(autosaves_.own()), ignored);
}

void SavedWork::perform(const SaveWork& c) {
  ws_.require_scene();
  std::filesystem::path path = c.path;
  if (!is_work_file(path)) path += kWorkEnding;
  refuse_written_inputs(path, ws_.scene->scene->files);
  ws_.tasks.submit(TaskKind::kSave,
                   [this, path, serial = ws_.history.serial(), document = ws_.document(), view = seen(),
                    scene = ws_.scene, steps = saved_steps(ws_.history)](const Job& job) {
                     job.progress("saving", 0);
                     write_work_file(path, *scene, document, view, steps);
                     ws_.tasks.post([this, path, serial, scene, document] {
                       ws_.say(Message::Kind::kDone, "Work saved to " + path.string());
                       if (scene != ws_.scene) return;
                       work_path_ = path;
                       keep_as_saved(serial, document, scene->serial);
                       ++saves_;
                     });
                   });
}

void SavedWork::perform(const DropAutosave& c) {
  if (std::ranges::find(offers_, c.file, &LeftWork::file) == offers_.end())
    throw Error("", "There is no such work");
  autosaves_.remove(c.file);
  ws_.say(Message::Kind::kInfo, "The work of last time is gone");
  find_offers();
}

}  // namespace splatcut
