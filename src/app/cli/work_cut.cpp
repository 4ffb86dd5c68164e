#include "app/cli/work_cut.h"

#include <fmt/format.h>

#include "app/cli/cutout_files.h"
#include "app/console/console.h"
#include "app/console/kept_inputs.h"
#include "app/console/output_folder.h"
#include "app/document/export_plan.h"
#include "app/work/work_file.h"
#include "core/atomic_file.h"
#include "core/error.h"
#include "core/json_file.h"

namespace splatcut {

namespace {

// Of every object with Gaussians; what report.json says of them.
nlohmann::json write_objects(const Document& document, const OpenedScene& opened, const EdgeOptions& edges,
                             const OutputFolder& folder, const Job& job) {
  const Scene& scene = *opened.scene;
  nlohmann::json objects = nlohmann::json::array();
  std::set<std::string> taken;
  for (const ObjectItem& object : document.objects) {
    stop_if_cancelled(job, "splatcut cut");
    const std::vector<std::uint8_t> labels = labels_of(document, object, scene.cloud.size());
    const std::size_t gaussians = count_flags(labels);
    if (gaussians == 0) continue;
    const std::string name = free_file_name(object.name, &taken);
    const CutoutObject written(scene, labels, edges,
                               {document.up_world, opened.views().cameras, *opened.blocks}, job);
    stop_if_cancelled(job, "splatcut cut");
    write_object_files(folder, scene, name, written, labels);
    objects.push_back({{"name", object.name},
                       {"file", name + ".ply"},
                       {"labels", name + ".labels.u8"},
                       {"gaussians", gaussians},
                       {"edges", written.report()}});
  }
  return objects;
}

}  // namespace

Document computed_again(const OpenedScene& scene, Document document, const Job& job,
                        const PreparedCache& cache) {
  Session session = session_on(scene, cache);
  for (ObjectItem& object : document.objects) {
    if (object.views.empty() || object.cut_kept || job.cancelled()) continue;
    CutResult result = session.cut(cut_request(document, object), cut_settings(document, object), job);
    if (result.outcome == Outcome::kNothingFound)
      throw Error(object.name, "is not found again: " + result.reason);
    object.cut = make_flags(std::move(result.labels));
    object.cut_key = cut_key(document, object);
  }
  return document;
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
  const nlohmann::json objects = write_objects(document, *scene, options.edges, folder, job);
  if (objects.empty()) throw Error(options.work.string(), "holds no object with any Gaussians");
  const nlohmann::json report = {{"work", options.work.string()},
                                 {"scene", scene->scene->path.string()},
                                 {"preset", document.preset},
                                 {"objects", objects}};
  write_text_file(folder.file("report.json"), json_text(report, 2) + "\n");
  stop_if_cancelled(job, "splatcut cut");
  folder.commit();
  if (options.json) fmt::print("{}\n", json_text(report, 2));
  if (options.quiet || options.json) return;
  for (const auto& o : objects)
    fmt::print("{}: {} Gaussians\n", o["name"].get<std::string>(), o["gaussians"].get<std::size_t>());
}

}  // namespace splatcut
