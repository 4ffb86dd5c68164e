#include "app/studio/session_files.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <chrono>

#include "app/studio/capture.h"
#include "app/studio/turntable.h"
#include "app/studio/words.h"
#include "core/error.h"
#include "core/png_file.h"

namespace splatcut {

namespace {

// Changes of the view alone are saved later: the view changes all the time.
constexpr double kAutosaveAfterSeconds = 2, kAutosaveViewAfterSeconds = 10;
constexpr std::size_t kCoarseFrom = 300000;  // Gaussians; fewer are drawn fast enough as they are

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

std::string described(const OpenedScene& opened) {
  const Scene& scene = *opened.scene;
  std::string text = fmt::format("{}: {} Gaussians, SH degree {}", scene.path.filename().string(),
                                 grouped(scene.cloud.size()), scene.cloud.sh_degree);
  if (scene.dropped) text += fmt::format(", {} unusable rows left out", grouped(scene.dropped));
  return text + (opened.cameras.empty()
                     ? std::string(". Does it lean or stand on its head? Set what is up under View")
                     : fmt::format(", {} cameras (N, P)", opened.cameras.size()));
}

}  // namespace

SessionFiles::SessionFiles(Workspace& workspace, Viewport& viewport, std::function<void()> opened)
    : ws_(workspace), viewport_(viewport), opened_(std::move(opened)) {
  autosaved_serial_ = saved_serial_ = ws_.history.serial();
  find_autosave();
}

void SessionFiles::perform(const OpenScene& c) {
  const std::uint64_t serial = next_scene_serial_++;
  ws_.say(Message::Kind::kInfo, "Opening " + c.path.filename().string());
  ws_.tasks.cancel(TaskKind::kCut);
  ws_.tasks.submit(TaskKind::kLoad, [this, path = c.path, axes = c.spz_axes, serial](const Job& job) {
    std::optional<WorkFile> file;
    if (is_work_file(path)) file = read_work_file(path);
    const std::shared_ptr<OpenedScene> scene =
        file ? open_scene(file->scene, job, file->spz_axes) : open_scene(path, job, axes);
    if (job.cancelled()) return;
    scene->serial = serial;
    std::optional<RestoredWork> work;
    if (file) work = restored(*file, *scene->scene, scene->hash);
    const std::string note = work ? work->warning : axes ? "" : scene->scene->axes_note;
    ws_.tasks.post([this, scene, work, note, work_path = file ? path : std::filesystem::path()] {
      opened(scene, work, work_path);
      for (const std::string& said : {scene->scene->left_out, scene->scene->oddity, note})
        if (!said.empty()) ws_.say(Message::Kind::kInfo, said);
    });
  });
}

void SessionFiles::opened(const std::shared_ptr<OpenedScene>& scene, const std::optional<RestoredWork>& work,
                          const std::filesystem::path& work_path) {
  ws_.tasks.cancel(TaskKind::kPrepare);
  ws_.scene = scene;
  ws_.prepared = nullptr;
  ws_.session = nullptr;
  ws_.coarse = nullptr;
  ws_.labels.clear();
  Document start;
  start.up_world = scene->up_world;
  ws_.history.reset(work ? work->document : start, work ? "Open work" : "Open scene");
  opened_();
  if (work && work->view) viewport_.camera().set_pose(*work->view);
  const bool own = is_work_file(work_path) && work_path.parent_path() != ws_.options.state_folder;
  work_path_ = own ? work_path : std::filesystem::path();
  if (work_path == restorable_) restorable_.clear();
  autosaved_serial_ = saved_serial_ = ws_.history.serial();
  autosaved_pose_ = viewport_.camera().pose();
  if (work && !own) autosaved_serial_ = saved_serial_ = 0;  // restored: nowhere else yet
  ws_.say(Message::Kind::kDone, described(*scene));
  start_preparing();
}

void SessionFiles::start_preparing() {
  ws_.tasks.submit(TaskKind::kPrepare, [this, scene = ws_.scene](const Job& job) {
    if (scene->cloud->size() >= kCoarseFrom)
      ws_.tasks.post(
          [this, scene, coarse = std::make_shared<const CoarseCloud>(coarse_cloud(*scene->cloud))] {
            if (scene == ws_.scene) ws_.coarse = coarse;
          });
    auto prepared = prepare(*scene, job, ws_.options.cache);
    if (job.cancelled()) return;
    auto session = std::make_shared<Session>(session_scene(*scene, prepared));
    session->make_ready(preset("default"), job);
    ws_.tasks.post([this, scene, prepared, session] {
      if (scene != ws_.scene) return;
      ws_.prepared = prepared;
      ws_.session = session;
    });
  });
}

void SessionFiles::find_autosave() {
  const std::filesystem::path& folder = ws_.options.state_folder;
  if (folder.empty()) return;
  for (const char* name : {kAutosaveBefore, kAutosave})
    if (std::filesystem::exists(folder / name)) restorable_ = folder / name;
  if (!restorable_.empty()) restorable_says_ = described(restorable_);
}

void SessionFiles::update(double seconds) {
  if (ws_.options.state_folder.empty() || !ws_.scene) return;
  const std::uint64_t serial = ws_.history.serial();
  if (std::exchange(waiting_serial_, serial) != serial) waited_s_ = 0;
  const bool changed = autosaved_serial_ != serial;
  const bool looks_elsewhere = unsaved() && autosaved_pose_ != viewport_.camera().pose();
  if ((!changed && !looks_elsewhere) || ws_.tasks.busy(TaskKind::kCut)) return;
  waited_s_ += seconds;
  if (waited_s_ < (changed ? kAutosaveAfterSeconds : kAutosaveViewAfterSeconds)) return;
  waited_s_ = 0;
  autosaved_serial_ = serial;
  autosaved_pose_ = viewport_.camera().pose();
  const std::filesystem::path path = ws_.options.state_folder / kAutosave;
  const std::filesystem::path before = ws_.options.state_folder / kAutosaveBefore;
  if (restorable_ == path) {  // the offered autosave must not be overwritten
    std::error_code trouble;
    std::filesystem::rename(path, before, trouble);
    if (!trouble) restorable_ = before;
  }
  ws_.tasks.submit(TaskKind::kAutosave,
                   [path, restored = restorable_ == before ? std::filesystem::path() : before,
                    document = ws_.document(), view = autosaved_pose_, scene = ws_.scene](const Job&) {
                     std::filesystem::create_directories(path.parent_path());
                     write_work_file(path, *scene->scene, scene->hash, document, view);
                     std::error_code ignored;  // what was restored is in the file now
                     if (!restored.empty()) std::filesystem::remove(restored, ignored);
                   });
}

void SessionFiles::leave() {
  if (ws_.options.state_folder.empty() || unsaved()) return;
  ws_.tasks.cancel(TaskKind::kAutosave);
  std::error_code ignored;
  if (restorable_ != ws_.options.state_folder / kAutosave)
    std::filesystem::remove(ws_.options.state_folder / kAutosave, ignored);
}

void SessionFiles::perform(const SaveWork& c) {
  ws_.require_scene();
  std::filesystem::path path = c.path;
  if (!is_work_file(path)) path += ".splatcut.json";
  ws_.tasks.submit(TaskKind::kSave, [this, path, serial = ws_.history.serial(), document = ws_.document(),
                                     view = viewport_.camera().pose(), scene = ws_.scene](const Job& job) {
    job.progress("saving", 0);
    write_work_file(path, *scene->scene, scene->hash, document, view);
    ws_.tasks.post([this, path, serial, scene] {
      ws_.say(Message::Kind::kDone, "Work saved to " + path.string());
      if (scene != ws_.scene) return;
      work_path_ = path;
      saved_serial_ = serial;
    });
  });
}

void SessionFiles::perform(const RestoreAutosave&) {
  if (restorable_.empty()) throw Error("restore", "there is no autosaved work");
  ws_.say(Message::Kind::kInfo, "Restoring the work of last time: " + restorable_says_);
  perform(OpenScene{restorable_});  // after that it is no longer offered
}

void SessionFiles::perform(const DropAutosave&) {
  if (restorable_.empty()) throw Error("restore", "there is no autosaved work");
  std::error_code ignored;
  std::filesystem::remove(std::exchange(restorable_, {}), ignored);
  ws_.say(Message::Kind::kInfo, "The work of last time is gone");
}

void SessionFiles::perform(const Export& c) {
  ws_.require_scene();
  const TaskThread::Order export_order(TaskKind::kExport,
                                       [this] { ws_.ui_requests.push_back(UiRequest::kExportFailed); });
  ws_.tasks.submit(export_order, [this, request = c.request, document = ws_.document(),
                                  object = ws_.document().active, scene = ws_.scene](const Job& job) {
    job.progress("exporting", 0);
    const ExportReport report = run_export(*scene->scene, document, object, request);
    std::string text = fmt::format("{} Gaussians, {} saved to {}", grouped(report.gaussians),
                                   human_bytes(report.bytes), request.path.string());
    if (!report.loss.empty()) text += ". Lost: " + report.loss;
    ws_.tasks.post([this, text] { ws_.say(Message::Kind::kDone, text); });
  });
}

void SessionFiles::perform(const SaveSnapshot& c) {
  ws_.require_scene();
  ws_.tasks.submit(
      TaskKind::kExport, [this, c, camera = viewport_.pane_camera(), visible = viewport_.shown(0),
                          limits = viewport_.draw_limits(), background = ws_.document().background,
                          scene = ws_.scene](const Job& job) {
        job.progress("drawing", 0);
        const Image<Rgba8> picture =
            capture(*scene->cloud, camera, visible, limits, background, c.transparent, job);
        if (job.cancelled()) return;
        write_png(c.path, picture);
        ws_.tasks.post([this, c] { ws_.say(Message::Kind::kDone, "Picture saved to " + c.path.string()); });
      });
}

void SessionFiles::perform(const SaveTurntable& c) {
  ws_.require_scene();
  check_turntable(c);
  const ObjectItem* object = ws_.document().active_object();
  if (!object || ws_.gaussians_of(object->id) == 0)
    throw Error("turntable", "there is no object to turn", "Click an object first");
  const Flags own = ws_.labels.labels(ws_.document(), *object, ws_.gaussians());
  DrawLimits limits = viewport_.draw_limits();
  limits.far_plane = DrawLimits{}.far_plane;  // that of another view
  ws_.tasks.submit(TaskKind::kExport,
                   [this, c, own, limits, front = viewport_.pane_camera(), up_world = ws_.document().up_world,
                    background = ws_.document().background, scene = ws_.scene](const Job& job) {
                     const std::vector<Camera> cameras =
                         cameras_of_turn(object_extent(*scene->cloud, *own), front, up_world, c);
                     const TurntableOptions options{c.as, c.path, c.turn_s, background};
                     if (!save_turntable(*scene->cloud, cameras, own, limits, options, job)) return;
                     ws_.tasks.post([this, c] {
                       ws_.say(Message::Kind::kDone,
                               fmt::format("{} frames saved to {}", c.frames, c.path.string()));
                     });
                   });
}

}  // namespace splatcut
