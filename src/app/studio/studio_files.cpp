// Files out: work, exports, pictures.
#include <fmt/chrono.h>
#include <fmt/format.h>

#include <chrono>

#include "app/studio/capture.h"
#include "app/studio/studio.h"
#include "app/studio/words.h"
#include "app/studio/work_file.h"
#include "core/error.h"
#include "core/png_file.h"

namespace splatcut {

namespace {

std::string described(const std::filesystem::path& work) {
  const auto written = std::chrono::file_clock::to_sys(std::filesystem::last_write_time(work));
  const std::time_t seconds = std::chrono::system_clock::to_time_t(
      std::chrono::time_point_cast<std::chrono::system_clock::duration>(written));
  const std::string when = fmt::format("{:%Y-%m-%d %H:%M}", fmt::localtime(seconds));
  try {
    return fmt::format("{}, {}", read_work_file(work).scene.filename().string(), when);
  } catch (const Error&) {
    return when;  // what is wrong with it is said when it is restored
  }
}

}  // namespace

void Studio::find_autosave() {
  if (options_.state_folder.empty()) return;
  for (const char* name : {kAutosaveBefore, kAutosave})
    if (std::filesystem::exists(options_.state_folder / name)) restorable_ = options_.state_folder / name;
  if (!restorable_.empty()) restorable_says_ = described(restorable_);
}

void Studio::perform(const SaveWork& c) {
  require_scene();
  std::filesystem::path path = c.path;
  if (!is_work_file(path)) path += ".splatcut.json";
  tasks_.submit(TaskKind::kSave, [this, path, serial = document_serial_, document = document(),
                                  view = camera_.pose(), scene = scene_](const Job& job) {
    job.progress("saving", 0);
    write_work_file(path, *scene->scene, scene->hash, document, view);
    tasks_.post([this, path, serial, scene] {
      say(Message::Kind::kDone, "Work saved to " + path.string());
      if (scene != scene_) return;
      work_path_ = path;
      saved_serial_ = serial;
    });
  });
  if (options_.inline_tasks) tasks_.deliver();
}

void Studio::leave() {
  if (options_.state_folder.empty() || unsaved()) return;
  tasks_.cancel(TaskKind::kAutosave);
  std::error_code ignored;
  if (restorable_ != options_.state_folder / kAutosave)
    std::filesystem::remove(options_.state_folder / kAutosave, ignored);
}

void Studio::perform(const RestoreAutosave&) {
  if (restorable_.empty()) throw Error("restore", "there is no autosaved work");
  say(Message::Kind::kInfo, "Restoring the work of last time: " + restorable_says_);
  perform(OpenScene{restorable_});  // after that it is no longer offered
}

void Studio::perform(const DropAutosave&) {
  if (restorable_.empty()) throw Error("restore", "there is no autosaved work");
  std::error_code ignored;
  std::filesystem::remove(std::exchange(restorable_, {}), ignored);
  say(Message::Kind::kInfo, "The work of last time is gone");
}

void Studio::perform(const Export& c) {
  require_scene();
  const TaskThread::Order export_order(TaskKind::kExport,
                                       [this] { ui_requests_.push_back(UiRequest::kExportFailed); });
  tasks_.submit(export_order, [this, request = c.request, document = document(), object = document().active,
                               scene = scene_](const Job& job) {
    job.progress("exporting", 0);
    const ExportReport report = run_export(*scene->scene, document, object, request);
    std::string text = fmt::format("{} Gaussians, {} saved to {}", grouped(report.gaussians),
                                   human_bytes(report.bytes), request.path.string());
    if (!report.loss.empty()) text += ". Lost: " + report.loss;
    tasks_.post([this, text] { say(Message::Kind::kDone, text); });
  });
  if (options_.inline_tasks) tasks_.deliver();
}

void Studio::perform(const SaveSnapshot& c) {
  require_scene();
  const Camera camera = viewport_camera();
  tasks_.submit(TaskKind::kExport, [this, c, camera, visible = shown(0), limits = draw_limits(),
                                    background = document().background, scene = scene_](const Job& job) {
    job.progress("drawing", 0);
    const Image<Rgba8> picture =
        capture(*scene->cloud, camera, visible, limits, background, c.transparent, job);
    if (job.cancelled()) return;
    write_png(c.path, picture);
    tasks_.post([this, c] { say(Message::Kind::kDone, "Picture saved to " + c.path.string()); });
  });
  if (options_.inline_tasks) tasks_.deliver();
}

}  // namespace splatcut
