#include "app/cli/work_cut.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "app/cli/cutout_files.h"
#include "app/console/console.h"
#include "app/console/kept_inputs.h"
#include "app/console/output_folder.h"
#include "app/document/export_plan.h"
#include "app/document/stroke_hits.h"
#include "app/work/work_file.h"
#include "core/atomic_file.h"
#include "core/error.h"
#include "core/json_file.h"

namespace splatcut {

namespace {

struct WrittenObject {
  std::string name;
  ObjectFiles files;
  std::size_t gaussians = 0;
  EdgesReport edges;
};

// Writes every object that has Gaussians.
std::vector<WrittenObject> write_objects(const Document& document, const CutoutFolder& to, const Job& job) {
  std::vector<WrittenObject> written;
  visit_objects(document, to.scene.cloud.size(), [&](const ObjectToSave& o) {
    stop_if_cancelled(job, "splatcut cut");
    WrittenObject object{o.name, files_of_object(o.file), count_flags(o.labels), {}};
    object.edges = write_object(to, object.files, o.labels, nullptr, job);
    written.push_back(std::move(object));
  });
  stop_if_cancelled(job, "splatcut cut");
  return written;
}

nlohmann::json objects_json(const std::vector<WrittenObject>& objects, const CutoutOptions& options) {
  nlohmann::json list = nlohmann::json::array();
  for (const WrittenObject& o : objects) {
    list.push_back({{"name", o.name}, {"gaussians", o.gaussians}, {"edges", o.edges.json()}});
    if (options.writes("object")) list.back()["file"] = o.files.scene;
    if (options.writes("labels")) list.back()["labels"] = o.files.labels;
    if (options.writes("hull")) list.back()["hull"] = o.files.hull;
    if (!o.edges.lost.empty()) list.back()["lost"] = o.edges.lost;
  }
  return list;
}

// What the object has now is left to it by those that were begun while its cut was on its way.
void leave_what_came(const OpenedScene& scene, Document* document, ObjectId came) {
  const DrawnPart part = drawn_part_of(scene.cloud, scene.blocks);
  for (ObjectItem& object : document->objects)
    if (std::ranges::find(object.leaves_also, came) != object.leaves_also.end())
      object = left_what_came(
          *document, object, std::span(&came, 1), [&] { return hits_of(object, part); }, scene.cloud->size());
}

}  // namespace

Document computed_again(const OpenedScene& scene, Document document, const Job& job,
                        const PreparedCache& cache) {
  Session session = session_on(scene, cache);
  for (ObjectItem& object : document.objects) {
    if (!object.views.empty() && !object.cut_kept) {
      CutResult result = session.cut(cut_request(document, object), cut_settings(document, object), job);
      if (job.cancelled()) break;
      if (result.outcome == Outcome::kNothingFound)
        throw Error(object.name, "is not found again: " + result.reason);
      object.cut = make_flags(std::move(result.labels));
      object.cut_key = cut_key(document, object);
    }
    leave_what_came(scene, &document, object.id);
  }
  return document;
}

void refuse_unwritten(std::span<const std::string> written) {
  constexpr std::array kWritten = {"object", "labels", "hull"};
  for (const std::string& what : written)
    if (std::ranges::find(kWritten, what) == kWritten.end())
      throw Error("--write " + what, "is not written of saved work",
                  "It takes object, labels and hull; the window exports the rest and pictures");
}

void run_work_cut(const WorkCutOptions& options) {
  const Job job = console_job(options.quiet);  // first: a signal must find its handler once there is a folder
  const WorkFile file = read_work_file(options.work);
  std::vector<std::filesystem::path> inputs = {options.work};
  for (const SceneSource& source : file.files) inputs.push_back(source.path);
  refuse_written_inputs(options.output, inputs);
  OutputFolder folder(options.output, options.overwrite);
  const auto scene = open_scene(file.files, job);
  stop_if_cancelled(job, "splatcut cut");
  RestoredWork work = restored(file, *scene);
  warn(work.warning, options.quiet);
  const Document document = computed_again(*scene, std::move(work.document), job, options.cache);
  end_progress();
  stop_if_cancelled(job, "splatcut cut");
  const std::vector<Camera>& cameras = scene->views().cameras;
  CutoutFolder to{folder, *scene->scene, *scene->blocks, document.up_world, cameras, options.cutout};
  to.up = document.up_world;
  const std::vector<WrittenObject> objects = write_objects(document, to, job);
  if (objects.empty()) throw Error(options.work.string(), "holds no object with any Gaussians");
  for (const WrittenObject& o : objects)
    if (!o.edges.lost.empty()) warn(fmt::format("{}: {}", o.files.scene, o.edges.lost), options.quiet);
  const nlohmann::json report = {{"work", options.work.string()},
                                 {"scene", scene->scene->path.string()},
                                 {"preset", document.preset},
                                 {"objects", objects_json(objects, options.cutout)}};
  write_text_file(folder.file("report.json"), json_text(report, 2) + "\n");
  stop_if_cancelled(job, "splatcut cut");
  folder.commit();
  if (options.json) fmt::print("{}\n", json_text(report, 2));
  if (options.quiet || options.json) return;
  for (const WrittenObject& o : objects) fmt::print("{}: {} Gaussians\n", o.name, o.gaussians);
}

}  // namespace splatcut
