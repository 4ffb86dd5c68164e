#include "app/studio/saved_work.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <thread>

#include "app/console/kept_inputs.h"
#include "app/work/work_history.h"
#include "core/error.h"

namespace splatcut {

namespace {

// Changes of the view alone are saved later: the view changes all the time.
constexpr double kAutosaveAfterSeconds = 2, kAutosaveViewAfterSeconds = 10, kAutosaveAgainSeconds = 30;

std::string work_and_time(const std::filesystem::path& work) {
  std::error_code ignored;  // it may go in this moment
  const auto written = std::chrono::file_clock::to_sys(std::filesystem::last_write_time(work, ignored));
  const std::time_t seconds = std::chrono::system_clock::to_time_t(
      std::chrono::time_point_cast<std::chrono::system_clock::duration>(written));
  const std::string when = fmt::format("{:%Y-%m-%d %H:%M}", fmt::localtime(seconds));
  try {
    const std::filesystem::path scene = read_work_file(work).files.front().path;
    return fmt::format("{}, {}", (scene.parent_path().filename() / scene.filename()).string(), when);
  } catch (const Error&) {
    return when;  // what is wrong with it is said when it is restored
  }
}

}  // namespace

SavedWork::SavedWork(Workspace& workspace, Viewport& viewport)
    : ws_(workspace), viewport_(viewport), autosaves_(workspace.options.state_folder) {
  autosaved_serial_ = saved_serial_ = ws_.history.serial();
  describe_offered();
}

bool SavedWork::unsaved() const {
  const Document& document = ws_.document();
  const bool several = ws_.scene && ws_.scene->files.size() > 1;
  return (!document.objects.empty() || document.deleted || several) && saved_serial_ != ws_.history.serial();
}

// What was restored is not offered again while it waits to be saved.
std::filesystem::path SavedWork::offered() const {
  const std::filesystem::path left = autosaves_.left_behind();
  return left == restored_ ? std::filesystem::path() : left;
}

void SavedWork::describe_offered() {
  if (autosave_found()) restorable_says_ = work_and_time(offered());
}

void SavedWork::opened(const std::optional<RestoredWork>& work, const std::filesystem::path& file) {
  const bool own = is_work_file(file) && file.parent_path() != ws_.options.state_folder;
  work_path_ = own ? file : std::filesystem::path();
  if (work && file == offered()) restored_ = file;
  autosaved_serial_ = saved_serial_ = ws_.history.serial();
  autosaved_pose_ = viewport_.camera().kept_pose();
  if (work && !own) autosaved_serial_ = saved_serial_ = 0;  // restored: nowhere else yet
}

// A program that was killed may hold its autosave for some seconds more.
void SavedWork::look_for_more(double seconds) {
  constexpr double kEverySeconds = 2, kForSeconds = 60;
  if (autosave_found() || looked_for_s_ > kForSeconds) return;
  const bool now =
      std::floor(looked_for_s_ / kEverySeconds) < std::floor((looked_for_s_ + seconds) / kEverySeconds);
  looked_for_s_ += seconds;
  if (!now) return;
  autosaves_.look_again();
  describe_offered();
}

void SavedWork::update(double seconds) {
  look_for_more(seconds);
  if (!ws_.scene || ws_.tasks.busy(TaskKind::kLoad) || autosaves_.own().empty()) return;
  const std::uint64_t serial = ws_.history.serial();
  if (std::exchange(waiting_serial_, serial) != serial) waited_s_ = 0;
  const bool changed = autosaved_serial_ != serial;
  const bool looks_elsewhere = unsaved() && autosaved_pose_ != viewport_.camera().kept_pose();
  if ((!changed && !looks_elsewhere) || ws_.tasks.busy(TaskKind::kCut)) return;
  waited_s_ += seconds;
  if (waited_s_ < (changed ? kAutosaveAfterSeconds : kAutosaveViewAfterSeconds)) return;
  waited_s_ = 0;
  autosaved_serial_ = serial;
  autosaved_pose_ = viewport_.camera().kept_pose();
  const auto failed = [this] {  // not forgotten: tried again without another change
    autosaved_serial_ = 0;
    waited_s_ = -kAutosaveAgainSeconds;
  };
  ws_.tasks.submit({TaskKind::kAutosave, failed}, autosaving());
}

TaskThread::Work SavedWork::autosaving() {
  return [this, path = autosaves_.own(), restored = restored_, document = ws_.document(),
          view = autosaved_pose_, scene = ws_.scene, steps = saved_steps(ws_.history)](const Job&) {
    write_work_file(path, *scene, document, view, steps);
    ws_.tasks.post([this, restored] { forget_restored(restored); });
  };
}

// It is in a file of this program now; what was left behind before it is offered next.
void SavedWork::forget_restored(const std::filesystem::path& file) {
  if (file.empty() || file != restored_) return;
  autosaves_.remove(std::exchange(restored_, {}));
  describe_offered();
}

void SavedWork::keep_unsaved() {
  if (!ws_.scene || autosaves_.own().empty() || !unsaved()) return;
  ws_.tasks.cancel(TaskKind::kAutosave);
  autosaved_pose_ = viewport_.camera().kept_pose();
  // It is waited for when the worker ends; what it posts comes too late.
  ws_.tasks.submit(TaskKind::kSave, [write = autosaving(), restored = restored_](const Job& job) {
    write(job);
    std::error_code ignored;
    std::filesystem::remove(restored, ignored);
  });
}

void SavedWork::leave() {
  if (autosaves_.own().empty() || unsaved()) return;
  ws_.tasks.cancel(TaskKind::kAutosave);
  while (ws_.tasks.busy(TaskKind::kAutosave)) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  forget_restored(restored_);
  std::error_code ignored;
  std::filesystem::remove(autosaves_.own(), ignored);
}

void SavedWork::perform(const SaveWork& c) {
  ws_.require_scene();
  std::filesystem::path path = c.path;
  if (!is_work_file(path)) path += ".splatcut.json";
  refuse_written_inputs(path, ws_.scene->scene->files);
  ws_.tasks.submit(TaskKind::kSave, [this, path, serial = ws_.history.serial(), document = ws_.document(),
                                     view = viewport_.camera().kept_pose(), scene = ws_.scene,
                                     steps = saved_steps(ws_.history)](const Job& job) {
    job.progress("saving", 0);
    write_work_file(path, *scene, document, view, steps);
    ws_.tasks.post([this, path, serial, scene] {
      ws_.say(Message::Kind::kDone, "Work saved to " + path.string());
      if (scene != ws_.scene) return;
      work_path_ = path;
      saved_serial_ = serial;
    });
  });
}

void SavedWork::perform(const DropAutosave&) {
  if (!autosave_found()) throw Error("restore", "there is no autosaved work");
  autosaves_.remove(offered());
  ws_.say(Message::Kind::kInfo, "The work of last time is gone");
  describe_offered();
}

}  // namespace splatcut
