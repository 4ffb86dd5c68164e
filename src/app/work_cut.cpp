#include "app/work_cut.h"

#include <fmt/format.h>

#include "app/console.h"
#include "app/cutout_files.h"
#include "app/output_folder.h"
#include "app/studio/export_plan.h"
#include "app/studio/work_file.h"
#include "scene/atomic_file.h"
#include "scene/error.h"
#include "scene/json_file.h"

namespace splatcut {

Document computed_again(const OpenedScene& scene, Document document, const Job& job,
                        const PreparedCache& cache) {
  Session session(session_scene(scene, prepare(scene, job, cache)));
  for (ObjectItem& object : document.objects) {
    if (object.views.empty() || job.cancelled()) continue;
    CutResult result = session.cut(cut_request(document, object), cut_settings(document, object), job);
    if (result.outcome == Outcome::kNothingFound)
      throw Error(object.name, "is not found again: " + result.reason);
    object.cut = make_flags(std::move(result.labels));
    object.cut_key = cut_key(document, object);
  }
  return document;
}

void run_work_cut(const WorkCutOptions& options) {
  OutputFolder folder(options.output, options.overwrite);
  const Job job = console_job(options.quiet);
  const WorkFile file = read_work_file(options.work);
  const auto scene = open_scene(file.scene, job, file.spz_axes);
  if (job.cancelled()) throw Error("splatcut cut", "cancelled, nothing was written");
  RestoredWork work = restored(file, *scene->scene, scene->hash);
  warn(work.warning, options.quiet);
  const Document document = computed_again(*scene, std::move(work.document), job, options.cache);
  end_progress();
  if (job.cancelled()) throw Error("splatcut cut", "cancelled, nothing was written");
  nlohmann::json objects = nlohmann::json::array();
  std::set<std::string> taken;
  for (const ObjectItem& object : document.objects) {
    const std::vector<std::uint8_t> labels = labels_of(document, object, scene->cloud->size());
    const std::size_t gaussians = count_flags(labels);
    if (gaussians == 0) continue;
    const std::string name = free_file_name(object.name, &taken);
    save_scene(folder.file(name + ".ply"), *scene->scene, labels, SceneFormat::kPly);
    write_labels(folder.file(name + ".labels.u8"), *scene->scene, labels);
    objects.push_back({{"name", object.name},
                       {"file", name + ".ply"},
                       {"labels", name + ".labels.u8"},
                       {"gaussians", gaussians}});
  }
  if (objects.empty()) throw Error(options.work.string(), "holds no object with any Gaussians");
  const nlohmann::json report = {{"work", options.work.string()},
                                 {"scene", scene->scene->path.string()},
                                 {"preset", document.preset},
                                 {"objects", objects}};
  write_text_file(folder.file("report.json"), json_text(report, 2) + "\n");
  folder.commit();
  if (options.json) fmt::print("{}\n", json_text(report, 2));
  if (options.quiet || options.json) return;
  for (const auto& o : objects)
    fmt::print("{}: {} Gaussians\n", o["name"].get<std::string>(), o["gaussians"].get<std::size_t>());
}

}  // namespace splatcut
