#include "app/studio/scene_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <utility>

#include "app/document/words.h"
#include "app/workspace/carried_document.h"
#include "core/error.h"

namespace splatcut {

namespace {

constexpr std::size_t kCoarseFrom = 300000;  // Gaussians; fewer are drawn fast enough as they are

bool same_files(const std::vector<SceneSource>& a, const std::vector<SceneSource>& b) {
  return std::ranges::equal(a, b, [](const SceneSource& left, const SceneSource& right) {
    return left.id == right.id && (left.onto || left.place == right.place);
  });
}

// As what a step of placing a file is named.
std::string what_was_done(const ScenePlace& before, const ScenePlace& after) {
  if (after == ScenePlace{}) return "put back as in its file";
  if (after.scale != before.scale) return "scaled";  // on its foot, which moves its middle
  if (after.turn_deg != before.turn_deg) return "turned";
  return "moved";
}

// Takes saved work out of files that are opened with a scene. Returns a sentence for each.
std::vector<std::string> refused_work(std::vector<std::filesystem::path>* added) {
  std::vector<std::string> refused;
  for (const std::filesystem::path& path : *added)
    if (is_work_file(path))
      refused.push_back(path.filename().string() + ": is saved work, not a scene. Open it alone");
  std::erase_if(*added, is_work_file);
  return refused;
}

}  // namespace

SceneFiles::SceneFiles(Workspace& workspace, Viewport& viewport, CutJobs& cuts, SavedWork& work, Calls calls)
    : ws_(workspace), viewport_(viewport), cuts_(cuts), work_(work), calls_(std::move(calls)) {}

void SceneFiles::stop_for_loading() {
  cuts_.pause();
  // Waited for, it would keep the other scene waiting. If that cannot be opened it goes on, see update().
  preparing_stopped_ |= ws_.tasks.busy(TaskKind::kPrepare);
  ws_.tasks.cancel(TaskKind::kPrepare);
}

void SceneFiles::perform(const OpenScene& c) {
  const std::uint64_t serial = next_scene_serial_++;
  const auto& offers = work_.offers();
  const auto left = std::ranges::find(offers, c.path, &LeftWork::file);
  opening_ = left == offers.end() ? "Opening " + scene_name(c.path) : "Restoring unsaved work: " + left->says;
  ws_.say(Message::Kind::kInfo, opening_);
  stop_for_loading();
  if (changing()) interrupted_ = last_change_;
  changing_to_.clear();
  std::vector<SceneSource> files = {
      {.path = c.path, .spz_axes = c.spz_axes, .cameras = c.cameras, .camera = c.camera, .lod = c.lod}};
  const TaskThread::Order order(TaskKind::kLoad, [this] {
    opening_.clear();
    go_on_changing();
  });
  ws_.tasks.submit(order, [this, path = c.path, files, added = c.added, axes = c.spz_axes, serial,
                           id = next_file_id_](const Job& job) mutable {
    std::optional<WorkFile> file;
    if (is_work_file(path)) file = read_work_file(path);
    if (file && !added.empty())
      throw Error(path.filename().string(), "is saved work: other scenes cannot be opened with it",
                  "Open it, then add them");
    std::vector<std::string> refused = refused_work(&added);
    for (SceneSource& source : file ? file->files : files) {
      source.id = id++;
      std::error_code ignored;
      if (!file || source.cameras.empty() || std::filesystem::exists(source.cameras, ignored)) continue;
      refused.push_back(source.cameras.string() + ": is not there. The cameras beside the scene are taken");
      source.cameras.clear();
    }
    const std::shared_ptr<OpenedScene> scene =
        file ? open_scene(file->files, job, nullptr, &refused) : open_first(files, &added, &refused, job);
    if (job.cancelled()) return;
    scene->serial = serial;
    std::optional<RestoredWork> work;
    if (file) work = restored(*file, *scene);
    if (file && !refused.empty() && !work->warning.empty())
      refused.push_back(std::exchange(work->warning, {}) + '.');
    ws_.tasks.post([this, scene, work, id, added, axes, refused,
                    work_path = file && refused.empty() ? path : std::filesystem::path()] {
      next_file_id_ = std::max(next_file_id_, id);
      if (!is_last(*scene)) return;
      opened(scene, work, work_path);
      for (const std::string& remark : scene->remarks) ws_.say_also(Message::Kind::kInfo, remark);
      if (work && !work->warning.empty()) ws_.say_also(Message::Kind::kInfo, work->warning);
      add_all(added, axes, refused);
    });
  });
}

StandsOn SceneFiles::row_of_added() const {
  const glm::vec3 up = glm::normalize(ws_.document().up_world);
  const Camera camera = viewport_.pane_camera();
  const glm::vec3 right = glm::transpose(camera.camera_from_world_rotation)[0];
  const glm::vec3 level = right - glm::dot(right, up) * up;
  const glm::vec3 row = glm::length(level) > 0.1f ? glm::normalize(level) : glm::vec3(0);
  const std::vector<SceneSource>& files = ws_.scene->files;
  const SceneSource& first = files.front();
  const bool alone = first.views->cameras.empty() && !contains(first.bounds, camera.centre_world());
  return alone && row != glm::vec3(0) ? beside(files, row, up)
                                      : StandsOn{viewport_.looked_at_world(), up, row};
}

// Those that were asked for with the scene, in one change of its files.
void SceneFiles::add_all(const std::vector<std::filesystem::path>& added, std::optional<SpzAxes> axes,
                         std::vector<std::string> refused) {
  if (added.empty()) return say_refused(refused);
  std::vector<SceneSource> files = wanted_files();
  const StandsOn row = row_of_added();
  std::string names;
  for (const std::filesystem::path& path : added) {
    files.push_back({.id = next_file_id_++, .path = path, .spz_axes = axes, .onto = row});
    put_before_view_ = files.back().id;
    names += (names.empty() ? "" : ", ") + scene_name(path);
  }
  const std::optional<CameraPose> seen_from =
      row.begins_there ? std::optional(viewport_.camera().goal()) : std::nullopt;
  change_files(std::move(files), "Adding " + names, {{}, std::move(refused), seen_from});
}

void SceneFiles::say_refused(const std::vector<std::string>& refused) {
  std::string text;
  for (const std::string& sentence : refused) text += (text.empty() ? "" : "\n") + sentence;
  if (!text.empty()) ws_.say(Message::Kind::kError, text);
}

void SceneFiles::cancel_loading() {
  const bool opens = !opening_.empty();
  stop_loading();
  if (opens && interrupted_) return go_on_changing();
  filling_.reset();
}

void SceneFiles::go_on_changing() {
  if (const std::optional<Change> change = std::exchange(interrupted_, {}))
    change_files(change->files, change->doing, change->said);
}

void SceneFiles::stop_loading() {
  ++next_scene_serial_;  // what is on its way is not the last
  ws_.tasks.cancel(TaskKind::kLoad);
  changing_to_.clear();
  opening_.clear();
}

std::vector<SceneSource> SceneFiles::wanted_files() const {
  ws_.require_scene();
  return changing_to_.empty() ? ws_.scene->files : changing_to_;
}

ScenePlace SceneFiles::place_to_be(std::uint32_t file) const {
  const std::vector<SceneSource> files = wanted_files();
  const auto found = std::ranges::find(files, file, &SceneSource::id);
  return found != files.end() ? found->place : ScenePlace{};
}

SceneSource& SceneFiles::added_file(std::vector<SceneSource>* files, std::uint32_t id) const {
  const auto found = std::ranges::find(*files, id, &SceneSource::id);
  if (found == files->end()) throw Error("", "The scene has no such file");
  if (found == files->begin())
    throw Error(found->path.filename().string(), "was opened first: the others stand in its scene");
  return *found;
}

void SceneFiles::perform(const AddScene& c) {
  if (is_work_file(c.path))
    throw Error(c.path.filename().string(), "is saved work, not a scene", "Open it, or add the scene itself");
  std::vector<SceneSource> files = wanted_files();
  files.push_back({.id = next_file_id_++, .path = c.path, .spz_axes = c.spz_axes});
  Said said;
  if (c.onto_world) {
    StandsOn row = row_of_added();
    row.small_on_world = said.put_on_world = *c.onto_world;
    files.back().onto = row.begins_there ? row : StandsOn{*c.onto_world, row.up_world};
    put_before_view_ = files.back().id;
    if (row.begins_there) said.seen_from = viewport_.camera().goal();
  }
  change_files(std::move(files), "Adding " + scene_name(c.path), std::move(said));
}

void SceneFiles::perform(const PlaceScene& c) {
  std::vector<SceneSource> files = wanted_files();
  SceneSource& file = added_file(&files, c.file);
  check(c.place, file.path);
  if (file.place == c.place && !file.onto) return;
  const std::string done = c.done.empty() ? what_was_done(file.place, c.place) : c.done;
  file.place = c.place;
  file.onto.reset();
  const std::string name = scene_name(file.path);
  change_files(std::move(files), "Placing " + name, {name + " " + done});
}

void SceneFiles::perform(const BringHere& c) {
  std::vector<SceneSource> files = wanted_files();
  const SceneSource& file = added_file(&files, c.file);
  const auto at = viewport_.surface_in_middle(c.file);
  if (!at)
    throw Error("", "Nothing to stand on is in the middle of the picture",
                "Turn the view so that the place is in its middle");
  const glm::vec3& up_world = ws_.document().up_world;
  constexpr float kSamePlace = 1e-3f;  // of the file's half height: nobody sees it
  const float near = kSamePlace * half_extent(file, glm::normalize(up_world));
  if (!file.onto && glm::distance(foot_world(file, up_world), *at) <= near)
    return ws_.say(Message::Kind::kInfo, scene_name(file.path) + " stands there already");
  perform(PlaceScene{c.file, stood_on(file, file.place, *at, up_world), "brought here"});
}

void SceneFiles::perform(const RemoveScene& c) {
  std::vector<SceneSource> files = wanted_files();
  const std::string name = scene_name(added_file(&files, c.file).path);
  std::erase_if(files, [&](const SceneSource& file) { return file.id == c.file; });
  change_files(std::move(files), "Taking out " + name, {name + " taken out; the file stays as it is"});
}

// True if no other change or scene was asked for since, and it was not cancelled. A later change holds this
// one.
bool SceneFiles::is_last(const OpenedScene& scene) const {
  return scene.serial + 1 == next_scene_serial_;
}

void SceneFiles::change_files(std::vector<SceneSource> files, const std::string& doing, Said said) {
  ws_.say(Message::Kind::kInfo, doing);
  stop_for_loading();
  changing_to_ = files;
  last_change_ = {files, doing, said};
  const TaskThread::Order order(TaskKind::kLoad, [this] { changing_to_.clear(); });
  ws_.tasks.submit(order, [this, files = std::move(files), before = ws_.scene, serial = next_scene_serial_++,
                           said = std::move(said)](const Job& job) mutable {
    const std::shared_ptr<OpenedScene> scene = open_scene(files, job, before.get(), &said.refused);
    if (job.cancelled()) return;
    scene->serial = serial;
    const bool none_came = same_files(scene->files, before->files);
    if (said.done.empty()) said.done = added_text(*scene, *before);
    ws_.tasks.post([this, files, scene, said, none_came] {
      std::erase_if(changing_to_, [&](const SceneSource& file) {
        return std::ranges::count(files, file.id, &SceneSource::id) > 0 && !scene->file(file.id);
      });
      if (!none_came && is_last(*scene)) return carry_document(scene, said);
      if (same_files(changing_to_, scene->files)) changing_to_.clear();
      say_refused(said.refused);
    });
  });
}

// Labels pass over the Gaussians, so that it is done on the worker; again where the document changed
// meanwhile.
void SceneFiles::carry_document(const std::shared_ptr<OpenedScene>& scene, const Said& said) {
  const TaskThread::Order order(TaskKind::kLoad, [this] { changing_to_.clear(); });
  ws_.tasks.submit(order, [this, scene, said, before = ws_.scene, history = ws_.history,
                           serial = ws_.history.serial(), fill = filling_](const Job& job) mutable {
    job.progress("carrying labels", 0);
    CarriedDocument carry(*before, *scene);
    history.carry(std::ref(carry));
    const Flags replaced = fill && scene->file(fill->file) ? carry.carried(fill->replaced) : nullptr;
    if (job.cancelled()) return;
    ws_.tasks.post([this, scene, said, replaced, before, history = std::move(history), serial] {
      calls_.at_last([this, scene, said, replaced, before, history, serial] {
        if (scene->files.front().id != ws_.scene->files.front().id) return;  // another one was opened
        if (!is_last(*scene)) return say_refused(said.refused);
        if (before != ws_.scene || serial != ws_.history.serial()) return carry_document(scene, said);
        files_changed(scene, history, said, replaced);
      });
    });
  });
}

void SceneFiles::files_changed(const std::shared_ptr<OpenedScene>& scene, History history, const Said& said,
                               const Flags& replaced) {
  preparing_stopped_ = false;
  if (same_files(changing_to_, scene->files)) changing_to_.clear();
  ws_.history.forget_redo();
  keep_before(kept_now(next_step_));
  undone_files_.clear();
  take(scene);
  ws_.history = std::move(history);
  ws_.history.push_other_files(said.done.substr(0, said.done.find(';')), next_step_++);
  fill_came(*scene, replaced);
  calls_.opened(true);
  const SceneSource* put = scene->file(std::exchange(put_before_view_, 0));
  const glm::vec3& up_world = ws_.document().up_world;
  const bool in_view =
      put && said.put_on_world &&
      glm::distance(foot_world(*put, up_world), *said.put_on_world) < 1e-3f * viewport_.camera().scene_size();
  if (said.seen_from == viewport_.camera().goal() && !in_view) viewport_.show_all_of_scene();
  ws_.say(Message::Kind::kDone, said.done);
  for (const std::string& remark : scene->remarks) ws_.say_also(Message::Kind::kInfo, remark);
  if (put)
    if (const std::string says = misfit(*put, viewport_.pane_camera(), up_world); !says.empty())
      ws_.say_also(Message::Kind::kInfo, says);
  say_refused(said.refused);
  start_preparing();
}

void SceneFiles::take(const std::shared_ptr<const OpenedScene>& scene) {
  ws_.scene = scene;
  ws_.graph = std::make_shared<SceneGraph>(scene->cloud);
  ws_.session = std::make_shared<Session>(session_on(*scene, ws_.options.cache));
  ws_.clean = std::make_shared<CleanObjects>(scene);
  ws_.seen = nullptr;
  ws_.coarse = nullptr;
  ws_.labels.clear();
}

void SceneFiles::opened(const std::shared_ptr<OpenedScene>& scene, const std::optional<RestoredWork>& work,
                        const std::filesystem::path& work_path) {
  work_.keep_from_other_scene();
  preparing_stopped_ = false;
  opening_.clear();
  before_files_.clear();
  undone_files_.clear();
  filling_.reset();
  interrupted_.reset();
  take(scene);
  Document start;
  start.up_world = scene->views().up_world;
  if (work && !work->history.steps.empty())
    ws_.history.reset(work->history);
  else
    ws_.history.reset(work ? work->document : start, work ? "Open work" : "Open scene");
  calls_.opened(false);
  if (work && work->view) {
    viewport_.camera().set_pose(work->view->pose);
    show(work->view->display, &ws_.view);
    ws_.view.hidden = work->view->hidden;
    cuts_.take_doubtful_sides(work->view->sides);
  }
  work_.opened(work, work_path);
  ws_.say(Message::Kind::kDone, described(*scene) + (work ? ". Its work is restored" : ""));
  start_preparing();
}

void SceneFiles::update() {
  if (redo_steps_ != ws_.history.steps_serial()) undone_files_.clear();  // nothing leads to them any more
  if (!ws_.scene || ws_.tasks.busy(TaskKind::kLoad)) return;
  if (std::exchange(preparing_stopped_, false)) start_preparing();
}

// What is clicked is prepared when it is clicked or pointed at; a scene itself, to be moved by alone.
void SceneFiles::start_preparing() {
  if (ws_.coarse || ws_.gaussians() < kCoarseFrom) return;
  ws_.tasks.submit(TaskKind::kPrepare, [this, scene = ws_.scene](const Job& job) {
    const auto coarse = std::make_shared<const CoarseCloud>(coarse_cloud(*scene->cloud, job));
    if (job.cancelled()) return;
    ws_.tasks.post([this, scene, coarse] {
      if (scene == ws_.scene) ws_.coarse = coarse;
    });
  });
}

}  // namespace splatcut
