#include "app/studio/exports.h"

#include <fmt/format.h>

#include <algorithm>

#include "app/console/kept_inputs.h"
#include "app/picture/capture.h"
#include "app/picture/turntable.h"
#include "app/work/work_file.h"
#include "core/error.h"
#include "core/png_file.h"

namespace splatcut {

// Another scene may have been opened while it was written: the folder is remembered for all of them, unless
// it is the scene's own, where nobody looks for what was made of another.
void Exports::written(const std::filesystem::path& path, const OpenedScene& of) {
  folder_ = std::filesystem::absolute(path).parent_path();
  if (folder_ == std::filesystem::absolute(of.scene->path).parent_path()) folder_.clear();
  if (ws_.scene && ws_.scene->files.front().id == of.files.front().id) last_ = path;
}

bool Exports::have_all() const {
  const Document& document = ws_.document();
  if (!ws_.scene || document.deleted || ws_.scene->files.size() > 1) return false;
  return std::ranges::all_of(document.objects, [&](const ObjectItem& item) {
    const Flags now = ws_.labels.labels(document, item, ws_.gaussians());
    const auto then = exported_.find(item.id);
    return ws_.gaussians_of(item.id) == 0 ||
           (then != exported_.end() && (then->second.labels == now || *then->second.labels == *now));
  });
}

std::string Exports::doing() const {
  if (!ws_.tasks.busy(TaskKind::kExport)) return {};
  for (const auto& task : doing_)
    if (const auto text = task.lock()) return *text;
  return {};
}

void Exports::submit(TaskThread::Order order, std::string text, TaskThread::Work work) {
  std::erase_if(doing_, [](const auto& task) { return task.expired(); });
  const auto held = std::make_shared<const std::string>(std::move(text));
  doing_.push_back(held);
  ws_.tasks.submit(std::move(order), [held, work = std::move(work)](const Job& job) { work(job); });
}

std::string Exports::announced(const ExportRequest& request, const std::map<ObjectId, Flags>& objects) const {
  const Document& document = ws_.document();
  const ObjectItem* active = document.active_object();
  bool clean = true;
  if (request.what == ExportWhat::kObject || request.what == ExportWhat::kAllObjects)
    clean = std::ranges::all_of(objects, [&](const auto& object) {
      return count_flags(*object.second) == 0 || ws_.clean->known(object.second, document.up_world);
    });
  else if (request.what == ExportWhat::kRest && active)
    clean = ws_.clean->known_without(leaving_of(
                document, ws_.labels.labels(document, *active, ws_.gaussians()), ws_.view)) != nullptr;
  const std::string name = request.path.filename().string();
  return fmt::format("Exporting {}{}", name, request.clean_edges && !clean ? " once edges are clean" : "");
}

void Exports::perform(const Export& c) {
  ws_.require_scene();
  if (is_work_file(c.request.path)) {
    ws_.ui_requests.push_back(UiRequest::kExportFailed);
    throw Error(c.request.path.string(), "is the name of saved work, not of a scene", "Choose another");
  }
  const TaskThread::Order export_order(TaskKind::kExport,
                                       [this] { ws_.ui_requests.push_back(UiRequest::kExportFailed); });
  const bool all = c.request.what == ExportWhat::kAllObjects || c.request.what == ExportWhat::kOneFile;
  std::map<ObjectId, Flags> objects;  // that are written
  for (const ObjectItem& item : ws_.document().objects)
    if (all || (c.request.what == ExportWhat::kObject && item.id == ws_.document().active))
      objects[item.id] = ws_.labels.labels(ws_.document(), item, ws_.gaussians());
  const std::string text = announced(c.request, objects);
  ws_.say(Message::Kind::kInfo, text);
  submit(export_order, text,
         [this, objects, request = c.request, document = ws_.document(), object = ws_.document().active,
          scene = ws_.scene, clean = ws_.clean](const Job& job) {
           job.progress("exporting", 0);
           const ExportReport report = run_export(*scene->scene, document, object, request, clean.get(), job);
           if (job.cancelled()) return;
           ws_.tasks.post([this, report, objects, path = request.path, scene] {
             written(path, *scene);
             if (scene == ws_.scene) {
               std::erase_if(exported_, [&](const auto& e) { return e.second.path == path; });  // overwritten
               for (const auto& [id, labels] : objects) exported_[id] = {path, labels};
             }
             ws_.say(report.hole_kept.empty() ? Message::Kind::kDone : Message::Kind::kRefused,
                     text_of(report, path));
             ws_.messages.back().stays = true;
           });
         });
}

// The panes may not show the present document yet.
void Exports::perform(const SaveSnapshot& c) {
  ws_.require_scene();
  refuse_name_of_png(c.path);
  refuse_written_inputs(c.path, ws_.scene->scene->files);
  submit(
      TaskKind::kExport, "Saving the picture " + c.path.filename().string(),
      [this, c, camera = viewport_.pane_camera(), order = viewport_.style_order(),
       before = viewport_.styles(), limits = viewport_.draw_limits()](const Job& job) {
        job.progress("drawing", 0);
        LabelCache labels;
        const Styles styles = styled(order, before, &labels, job);
        const auto& clean = styles.clean[0];
        const Image<Rgba8> picture =
            capture(clean ? clean->cloud : *order.cloud, camera, clean ? nullptr : styles.shown[0], limits,
                    order.document.background, c.transparent, job);
        if (job.cancelled()) return;
        write_png(c.path, picture);
        ws_.tasks.post([this, c] { ws_.say(Message::Kind::kDone, "Picture saved to " + c.path.string()); });
      });
}

void Exports::perform(const SaveTurntable& c) {
  ws_.require_scene();
  check_turntable(c);
  refuse_scene_name(c.path);
  refuse_written_inputs(c.path, ws_.scene->scene->files);
  const ObjectItem* object = ws_.document().active_object();
  if (!object || ws_.gaussians_of(object->id) == 0)
    throw Error("", "There is no object to turn", "Click an object first");
  const Flags own = ws_.labels.labels(ws_.document(), *object, ws_.gaussians());
  DrawLimits limits = viewport_.draw_limits();
  limits.far_plane = DrawLimits{}.far_plane;  // that of another view
  submit(TaskKind::kExport, "Saving the turntable " + c.path.filename().string(),
         [this, c, own, limits, front = viewport_.pane_camera(), up_world = ws_.document().up_world,
          background = ws_.document().background, scene = ws_.scene, made = ws_.clean](const Job& job) {
           const std::vector<Camera> cameras =
               cameras_of_turn(object_extent(*scene->cloud, *own), front, up_world, c);
           const TurntableOptions options{c.as, c.path, c.turn_s, background};
           auto clean = c.clean_edges ? made->made(own, up_world, job) : nullptr;
           ExportReport report;
           if (clean) count_edges(clean->report, &report);
           if (clean && !clean->report.cleaned) clean = nullptr;
           if (!save_turntable(clean ? clean->cloud : *scene->cloud, cameras, clean ? nullptr : own, limits,
                               options, job))
             return;
           ws_.tasks.post([this, c, edges = edges_text(report), scene] {
             written(c.path, *scene);
             ws_.say(Message::Kind::kDone,
                     fmt::format("{} pictures saved to {}{}", c.frames, c.path.string(), edges));
             ws_.messages.back().stays = true;
           });
         });
}

}  // namespace splatcut
