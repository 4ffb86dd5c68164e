#include "app/studio/session_files.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <thread>

#include "app/studio/capture.h"
#include "app/studio/carried_document.h"
#include "app/studio/turntable.h"
#include "app/studio/words.h"
#include "core/error.h"
#include "core/png_file.h"

namespace splatcut {

namespace {

// Changes of the view alone are saved later: the view changes all the time.
constexpr double kAutosaveAfterSeconds = 2, kAutosaveViewAfterSeconds = 10, kAutosaveAgainSeconds = 30;
constexpr std::size_t kCoarseFrom = 300000;  // Gaussians; fewer are drawn fast enough as they are

std::string described(const std::filesystem::path& work) {
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

std::string described(const OpenedScene& opened) {
  const Scene& scene = *opened.scene;
  const std::size_t more = opened.files.size() - 1;
  std::string text = fmt::format("{}{}: {} Gaussians, SH degree {}", scene.path.filename().string(),
                                 more ? fmt::format(" and {} more", more) : "", grouped(scene.cloud.size()),
                                 scene.cloud.sh_degree);
  if (scene.dropped) text += fmt::format(", {} unusable rows left out", grouped(scene.dropped));
  return text + (opened.views().cameras.empty()
                     ? std::string(". Does it lean or stand on its head? Set what is up under View")
                     : fmt::format(", {} cameras (N, P)", opened.views().cameras.size()));
}

bool same_files(const std::vector<SceneSource>& a, const std::vector<SceneSource>& b) {
  return std::ranges::equal(a, b, [](const SceneSource& left, const SceneSource& right) {
    return left.id == right.id && left.place == right.place;
  });
}

}  // namespace

SessionFiles::SessionFiles(Workspace& workspace, Viewport& viewport, CutJobs& cuts, Calls calls)
    : ws_(workspace),
      viewport_(viewport),
      cuts_(cuts),
      calls_(std::move(calls)),
      autosaves_(workspace.options.state_folder) {
  autosaved_serial_ = saved_serial_ = ws_.history.serial();
  describe_offered();
}

bool SessionFiles::unsaved() const {
  const Document& document = ws_.document();
  const bool several = ws_.scene && ws_.scene->files.size() > 1;
  return (!document.objects.empty() || document.deleted || several) && saved_serial_ != ws_.history.serial();
}

// What was restored is not offered again while it waits to be saved.
std::filesystem::path SessionFiles::offered() const {
  const std::filesystem::path left = autosaves_.left_behind();
  return left == restored_ ? std::filesystem::path() : left;
}

void SessionFiles::describe_offered() {
  if (autosave_found()) restorable_says_ = described(offered());
}

void SessionFiles::stop_for_loading() {
  cuts_.pause();
  // Waited for, it would keep the other scene waiting. If that cannot be opened it goes on, see update().
  preparing_stopped_ |= ws_.tasks.busy(TaskKind::kPrepare);
  ws_.tasks.cancel(TaskKind::kPrepare);
}

void SessionFiles::perform(const OpenScene& c) {
  const std::uint64_t serial = next_scene_serial_++;
  const bool restores = autosave_found() && c.path == offered();  // after that it is no longer offered
  ws_.say(Message::Kind::kInfo, restores ? "Restoring the work of last time: " + restorable_says_
                                         : "Opening " + c.path.filename().string());
  stop_for_loading();
  changing_to_.clear();
  std::vector<SceneSource> files = {{.path = c.path, .spz_axes = c.spz_axes}};
  for (const std::filesystem::path& added : c.added) files.push_back({.path = added});
  ws_.tasks.submit(
      TaskKind::kLoad, [this, path = c.path, files, serial, id = next_file_id_](const Job& job) mutable {
        std::optional<WorkFile> file;
        if (is_work_file(path)) file = read_work_file(path);
        if (file && files.size() > 1)
          throw Error(path.filename().string(), "is saved work: other scenes cannot be opened with it",
                      "Open it, then add them");
        if (file) files = file->files;
        for (SceneSource& source : files) source.id = id++;
        const std::shared_ptr<OpenedScene> scene = open_scene(files, job);
        if (job.cancelled()) return;
        scene->serial = serial;
        std::optional<RestoredWork> work;
        if (file) work = restored(*file, *scene);
        ws_.tasks.post([this, scene, work, id, work_path = file ? path : std::filesystem::path()] {
          next_file_id_ = std::max(next_file_id_, id);
          opened(scene, work, work_path);
          for (const std::string& remark : scene->remarks) ws_.say(Message::Kind::kInfo, remark);
          if (work && !work->warning.empty()) ws_.say(Message::Kind::kInfo, work->warning);
        });
      });
}

void SessionFiles::cancel_loading() {
  ws_.tasks.cancel(TaskKind::kLoad);
  changing_to_.clear();
}

std::vector<SceneSource> SessionFiles::wanted_files() const {
  ws_.require_scene();
  return changing_to_.empty() ? ws_.scene->files : changing_to_;
}

SceneSource& SessionFiles::added_file(std::vector<SceneSource>* files, std::uint32_t id) const {
  const auto found = std::ranges::find(*files, id, &SceneSource::id);
  if (found == files->end()) throw Error("scene", "there is no such file in it");
  if (found == files->begin())
    throw Error(found->path.filename().string(), "was opened first: the others stand in its scene");
  return *found;
}

void SessionFiles::perform(const AddScene& c) {
  if (is_work_file(c.path))
    throw Error(c.path.filename().string(), "is saved work, not a scene", "Open it, or add the scene itself");
  std::vector<SceneSource> files = wanted_files();
  files.push_back({.id = next_file_id_++, .path = c.path, .spz_axes = c.spz_axes});
  const std::string name = c.path.filename().string();
  change_files(std::move(files), "Adding " + name, name + " added; place it under Files");
}

void SessionFiles::perform(const PlaceScene& c) {
  std::vector<SceneSource> files = wanted_files();
  SceneSource& file = added_file(&files, c.file);
  check(c.place, file.path);
  if (file.place == c.place) return;
  file.place = c.place;
  const std::string name = file.path.filename().string();
  change_files(std::move(files), "Placing " + name, name + " placed");
}

void SessionFiles::perform(const RemoveScene& c) {
  std::vector<SceneSource> files = wanted_files();
  const std::string name = added_file(&files, c.file).path.filename().string();
  std::erase_if(files, [&](const SceneSource& file) { return file.id == c.file; });
  change_files(std::move(files), "Taking out " + name, name + " taken out; the file stays as it is");
}

void SessionFiles::change_files(std::vector<SceneSource> files, const std::string& doing,
                                const std::string& done) {
  ws_.say(Message::Kind::kInfo, doing);
  stop_for_loading();
  changing_to_ = files;
  const TaskThread::Order order(TaskKind::kLoad, [this] { changing_to_.clear(); });
  ws_.tasks.submit(order, [this, files = std::move(files), before = ws_.scene, serial = next_scene_serial_++,
                           done](const Job& job) {
    const std::shared_ptr<OpenedScene> scene = open_scene(files, job, before.get());
    if (job.cancelled()) return;
    scene->serial = serial;
    ws_.tasks.post([this, scene, done] { carry_document(scene, done); });
  });
}

// Labels pass over the Gaussians, so that it is done on the worker; again where the document changed
// meanwhile.
void SessionFiles::carry_document(const std::shared_ptr<OpenedScene>& scene, const std::string& done) {
  const TaskThread::Order order(TaskKind::kLoad, [this] { changing_to_.clear(); });
  ws_.tasks.submit(order, [this, scene, done, before = ws_.scene, history = ws_.history,
                           serial = ws_.history.serial()](const Job& job) mutable {
    job.progress("carrying labels", 0);
    history.carry(CarriedDocument(*before, *scene));
    if (job.cancelled()) return;
    ws_.tasks.post([this, scene, done, before, history = std::move(history), serial] {
      calls_.in_turn([this, scene, done, before, history, serial] {
        if (scene->files.front().id != ws_.scene->files.front().id) return;  // another one was opened
        if (before != ws_.scene || serial != ws_.history.serial()) return carry_document(scene, done);
        files_changed(scene, history, done);
      });
    });
  });
}

void SessionFiles::files_changed(const std::shared_ptr<OpenedScene>& scene, History history,
                                 const std::string& done) {
  preparing_stopped_ = false;
  if (same_files(changing_to_, scene->files)) changing_to_.clear();
  constexpr std::size_t kMostKept = 3;  // each holds a scene
  ws_.history.forget_redo();
  before_files_.push_back(kept_now(next_step_));
  if (before_files_.size() > kMostKept) before_files_.erase(before_files_.begin());
  undone_files_.clear();
  take(scene);
  ws_.history = std::move(history);
  ws_.history.push_other_files(done.substr(0, done.find(';')), next_step_++);
  calls_.opened(true);
  ws_.say(Message::Kind::kDone, done);
  for (const std::string& remark : scene->remarks) ws_.say(Message::Kind::kInfo, remark);
  start_preparing();
}

SessionFiles::Kept SessionFiles::kept_now(std::uint64_t step) const {
  return {step, ws_.scene, ws_.prepared, ws_.session, ws_.coarse, ws_.history};
}

void SessionFiles::go_back_to(Kept kept) {
  stop_for_loading();
  cancel_loading();
  preparing_stopped_ = false;
  take(kept.scene);
  ws_.prepared = std::move(kept.prepared);
  ws_.session = std::move(kept.session);
  ws_.coarse = std::move(kept.coarse);
  ws_.history = std::move(kept.history);
  calls_.opened(true);
  if (!ws_.session) start_preparing();
}

bool SessionFiles::undo_files() {
  const History::Entry& entry = ws_.history.entries()[ws_.history.cursor()];
  const auto before = std::ranges::find(before_files_, entry.other_files, &Kept::step);
  if (entry.other_files == 0 || before == before_files_.end()) return false;
  const std::string title = entry.title;
  undone_files_.push_back(kept_now(entry.other_files));
  Kept to = std::move(*before);
  before_files_.erase(before, before_files_.end());
  go_back_to(std::move(to));
  redo_serial_ = ws_.history.serial();
  ws_.say(Message::Kind::kInfo, "Undone: " + title);
  return true;
}

bool SessionFiles::can_redo_files() const {
  return !undone_files_.empty() && redo_serial_ == ws_.history.serial();
}

bool SessionFiles::redo_files() {
  if (!can_redo_files()) return false;
  Kept to = std::move(undone_files_.back());
  undone_files_.pop_back();
  before_files_.push_back(kept_now(to.step));
  go_back_to(std::move(to));
  redo_serial_ = ws_.history.serial();
  ws_.say(Message::Kind::kInfo, "Redone: " + ws_.history.entries()[ws_.history.cursor()].title);
  return true;
}

void SessionFiles::take(const std::shared_ptr<const OpenedScene>& scene) {
  ws_.scene = scene;
  ws_.prepared = nullptr;
  ws_.session = nullptr;
  ws_.coarse = nullptr;
  ws_.labels.clear();
}

void SessionFiles::opened(const std::shared_ptr<OpenedScene>& scene, const std::optional<RestoredWork>& work,
                          const std::filesystem::path& work_path) {
  preparing_stopped_ = false;
  before_files_.clear();
  undone_files_.clear();
  take(scene);
  Document start;
  start.up_world = scene->views().up_world;
  ws_.history.reset(work ? work->document : start, work ? "Open work" : "Open scene");
  calls_.opened(false);
  if (work && work->view) viewport_.camera().set_pose(*work->view);
  const bool own = is_work_file(work_path) && work_path.parent_path() != ws_.options.state_folder;
  work_path_ = own ? work_path : std::filesystem::path();
  if (work && work_path == offered()) restored_ = work_path;
  autosaved_serial_ = saved_serial_ = ws_.history.serial();
  autosaved_pose_ = viewport_.camera().kept_pose();
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

void SessionFiles::update(double seconds) {
  if (!ws_.scene || ws_.tasks.busy(TaskKind::kLoad)) return;
  if (std::exchange(preparing_stopped_, false) && !ws_.session) start_preparing();
  if (autosaves_.own().empty()) return;
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
  ws_.tasks.submit({TaskKind::kAutosave, failed},
                   [this, path = autosaves_.own(), restored = restored_, document = ws_.document(),
                    view = autosaved_pose_, scene = ws_.scene](const Job&) {
                     write_work_file(path, *scene, document, view);
                     ws_.tasks.post([this, restored] { forget_restored(restored); });
                   });
}

// It is in a file of this program now; what was left behind before it is offered next.
void SessionFiles::forget_restored(const std::filesystem::path& file) {
  if (file.empty() || file != restored_) return;
  autosaves_.remove(std::exchange(restored_, {}));
  describe_offered();
}

void SessionFiles::leave() {
  if (autosaves_.own().empty() || unsaved()) return;
  ws_.tasks.cancel(TaskKind::kAutosave);
  while (ws_.tasks.busy(TaskKind::kAutosave)) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  forget_restored(restored_);
  std::error_code ignored;
  std::filesystem::remove(autosaves_.own(), ignored);
}

void SessionFiles::perform(const SaveWork& c) {
  ws_.require_scene();
  std::filesystem::path path = c.path;
  if (!is_work_file(path)) path += ".splatcut.json";
  ws_.tasks.submit(TaskKind::kSave,
                   [this, path, serial = ws_.history.serial(), document = ws_.document(),
                    view = viewport_.camera().kept_pose(), scene = ws_.scene](const Job& job) {
                     job.progress("saving", 0);
                     write_work_file(path, *scene, document, view);
                     ws_.tasks.post([this, path, serial, scene] {
                       ws_.say(Message::Kind::kDone, "Work saved to " + path.string());
                       if (scene != ws_.scene) return;
                       work_path_ = path;
                       saved_serial_ = serial;
                     });
                   });
}

void SessionFiles::perform(const RestoreAutosave&) {
  if (!autosave_found()) throw Error("restore", "there is no autosaved work");
  perform(OpenScene{offered()});
}

void SessionFiles::perform(const DropAutosave&) {
  if (!autosave_found()) throw Error("restore", "there is no autosaved work");
  autosaves_.remove(offered());
  ws_.say(Message::Kind::kInfo, "The work of last time is gone");
  describe_offered();
}

void SessionFiles::perform(const Export& c) {
  ws_.require_scene();
  if (is_work_file(c.request.path)) {
    ws_.ui_requests.push_back(UiRequest::kExportFailed);
    throw Error(c.request.path.string(), "is the name of saved work, not of a scene", "Choose another");
  }
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
