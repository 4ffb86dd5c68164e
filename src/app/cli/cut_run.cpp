#include "app/cli/cut_run.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>

#include "app/cli/cut_placing.h"
#include "app/cli/cut_report.h"
#include "app/console/console.h"
#include "app/console/labels_file.h"
#include "app/console/setting_options.h"
#include "core/atomic_file.h"
#include "core/error.h"
#include "core/json_file.h"
#include "core/stage_clock.h"
#include "segment/session/settings_table.h"

namespace splatcut {

namespace {

nlohmann::json settings_json(const CutArguments& args, const ObjectInput& input, const ChosenCamera& chosen,
                             const CutSettings& settings) {
  nlohmann::json said = {
      {"preset", args.preset},
      {"reference", chosen.camera.name},
      {"views", settings.orbit.views},
      {"work_width_px", settings.work_width_px},
      {"neighbours", settings.neighbours},
      {"lambda", settings.last_lambda()},
      {"set", args.set},
      {"coarse", settings.cut.coarse},
      {"first_mask", args.masks.first_mask.empty() ? "as the preset" : args.masks.first_mask},
      {"scale", args.scale},
      {"parts_only", settings.parts_only},
      {"values", values_json(settings)}};
  if (!input.mask.empty()) said["mask"] = input.mask.string();
  if (!input.masks_folder.empty()) said["masks"] = input.masks_folder.string();
  if (input.segmenter) said.update({{"text", input.segmenter->text}, {"segmenter", input.segmenter->words}});
  return said;
}

// What would be without effect.
void refuse_unused(const CutArguments& args, const ObjectInput& input, const CutSettings& settings) {
  const bool masked = !input.mask.empty() || !input.masks_folder.empty() || input.segmenter;
  if (settings.parts_only && masked)
    throw Error("parts_only", "the parts cannot be the answer where masks are given",
                "Leave one of them out");
  const auto fill =
      std::ranges::find(input.objects, "fill", [](const NamedSeeds& o) { return file_name_of(o.name); });
  if (args.cutout.writes("fill") && fill != input.objects.end())
    throw Error("--write fill", fmt::format("writes fill.ply, and so does the object \"{}\"", fill->name),
                "Give it another name");
  if (settings.first_mask_from != FirstMaskFrom::kParts && (args.scale != 0 || args.choice))
    throw Error(args.choice ? "--choice" : "--scale",
                "chooses among parts, and the first mask comes from pixels",
                "Leave it out, or take the first mask from parts (--first-mask parts)");
}

// The request of the options, or that of each object of --seeds.
std::vector<CutObject> objects_of(const CutArguments& args, const ObjectInput& input, const Scene& scene,
                                  const CutRunOptions& options, const Job& job, ChosenCamera* chosen) {
  RequestRemarks remarks;
  CutRequest request = request_of(input, args.camera, scene.cloud, job, chosen, &remarks);
  if (!remarks.understood.empty() && !options.quiet) {
    end_progress();
    to_stderr(remarks.understood + "\n");
  }
  for (const std::string& remark : remarks.warnings) options.warn(remark);
  stop_if_cancelled(job, "splatcut cut");
  std::vector<CutObject> objects = objects_of(input.objects, *chosen, args.camera);
  if (objects.empty())
    objects.push_back(
        {.request = std::move(request), .camera = chosen->camera, .doubt_of_mask = std::move(remarks.doubt)});
  for (CutObject& object : objects) {
    if (Stroke* first = first_stroke(&object.request.strokes); first && args.scale != 0)
      first->size_step = args.scale;
    if (args.choice) object.request.choice = *args.choice - 1;
    constexpr std::size_t kPixelBytes = 32;  // of what is drawn, and of the pictures made of it
    check_picture(object.camera, kPixelBytes);
    check_inside(object.request);
  }
  return objects;
}

std::vector<EdgesReport> write_cutouts(const CutoutFolder& to, const std::vector<CutObject>& objects,
                                       const Job& job) {
  std::vector<EdgesReport> edges;
  for (const CutObject& object : objects) {
    const ObjectView shown{object.camera, object.result.views};
    edges.push_back(write_object(to, files_of(object), object.result.labels, &shown, job));
    end_progress();
    stop_if_cancelled(job, "splatcut cut");
  }
  return edges;
}

// Says where there are fewer meanings than the one that was chosen.
void warn_of_choices(const std::vector<CutObject>& objects, const CutRunOptions& options) {
  for (const CutObject& object : objects)
    if (const std::string said = fewer_meanings(object.result, object.request.choice); !said.empty())
      options.warn((object.name.empty() ? "" : object.name + ": ") + said);
}

}  // namespace

void CutArguments::add_to(CLI::App& command) {
  command.add_option("scene", scene, "Scene file");
  how.add_to(command);
  camera.add_to(command);
  object.add_to(command);
  cutout.add_to(command);
  masks.add_to(command, false);
  for (const char* given : {"--mask", "--masks", "--text"})
    command.get_option("--first-mask")->excludes(given);
  command.add_option("--smoothness", smoothness,
                     "Weight of the neighbour term in the last cut, 0 to 500: as the window's slider");
  command
      .add_option("--scale", scale,
                  "Next larger (+1, +2, ...) or smaller (-1, ...) part for the first click or box")
      ->check(CLI::Range(-kMostSizeSteps, kMostSizeSteps))
      ->excludes("--mask")
      ->excludes("--masks")
      ->excludes("--text");
  command
      .add_option("--choice", choice,
                  "Another meaning of the first click or box: 1 the likeliest (default), 2 or 3 the next")
      ->check(CLI::Range(1, static_cast<int>(kMostMeanings)))
      ->excludes("--seeds")  // says it itself
      ->excludes("--mask")
      ->excludes("--masks")
      ->excludes("--text");
  add_setting_options(command, &preset, &set);
  command.add_flag("--coarse", coarse, "Threshold the likelihood instead of the cut");
  command.get_option("--coarse")->excludes("--smoothness");
  for (const char* without_effect :
       {"--mask", "--masks", "--text", "--views", "--propagate", "--refine", "--smoothness", "--coarse"})
    command.get_option("--parts-only")->excludes(without_effect);
}

CutSettings CutArguments::settings() const {
  CutSettings settings = splatcut::preset(preset);
  if (smoothness) set_setting("smoothness", fmt::format("{}", *smoothness), &settings);
  settings.cut.coarse = coarse;
  masks.apply(&settings);
  for (const std::string& assignment : set) set_setting(assignment, &settings);
  return settings;
}

std::vector<std::filesystem::path> CutArguments::inputs() const {
  return {scene, camera.cameras, object.seeds, object.mask, object.masks_folder};
}

std::string CutArguments::scene_key() const {
  return json_text({scene.string(), how.spz_axes, how.lod.value_or(0), camera.cameras.string(), camera.up});
}

SharedScene::SharedScene(const CutArguments& args, PreparedCache cache, bool quiet, const Job& job)
    : key_(args.scene_key()), cache_(std::move(cache)) {
  const auto start = std::chrono::steady_clock::now();
  scene_ = std::make_shared<const Scene>(args.how.load(args.scene, args.camera.cameras, quiet, job));
  load_ms_ = ms_since(start);
}

Session& SharedScene::session(const ChosenCamera& chosen) {
  if (!session_)
    session_.emplace(SessionScene{.cloud = {scene_, &scene_->cloud},
                                  .up_world = chosen.up_world,
                                  .photographs = chosen.given,
                                  .prepare = {.observing = {}, .model = {}, .cache = cache_}});
  return *session_;
}

FinishedCut run_cut_in(SharedScene* shared, const CutArguments& args, const ObjectInput& input,
                       const OutputFolder& folder, const CutRunOptions& options, const Job& job) {
  const auto start = std::chrono::steady_clock::now();
  const Scene& scene = shared->scene();
  ChosenCamera chosen = choose_camera(args.camera, scene);
  if (!chosen.warning.empty()) options.warn(chosen.warning);
  const CutSettings settings = args.settings();
  args.cutout.check();
  refuse_unused(args, input, settings);
  if (input.segmenter) end_progress();  // the program prints to the same place
  std::vector<CutObject> objects = objects_of(args, input, scene, options, job, &chosen);
  const nlohmann::json said = settings_json(args, input, chosen, settings);
  Session& session = shared->session(chosen);
  const ExportPlacement placement =
      placement_of(args.cutout, {scene.cloud, nullptr, &session.blocks()}, chosen.camera, job);
  stop_if_cancelled(job, "splatcut cut");
  if (args.cutout.writes("objects") && placement == ExportPlacement{} &&  // rows are copied
      std::ranges::count(scene.other_properties, "object_id") > 0)
    throw Error(scene.path.string(), "has a property object_id already, where objects are to be numbered",
                "Leave objects out of --write, or convert the scene first");
  const std::vector<std::uint8_t> owner = cut_objects(&objects, &session, settings, job);
  end_progress();
  stop_if_cancelled(job, "splatcut cut");
  warn_of_choices(objects, options);
  RunReport report{scene,        said, objects,           args.cutout,
                   {},           {},   shared->load_ms(), shared->load_ms() + ms_since(start),
                   options.times};
  CutoutFolder to{folder,       scene,       session.blocks(),          chosen.up_world,
                  chosen.given, args.cutout, args.cutout.writes("rest")};
  if (placement != ExportPlacement{})
    to.to = {similarity_of(placement, scene.cloud, owner, chosen.up_world),
             placement.origin == ExportOrigin::kScene};
  to.up = up_to_write(chosen, placement);
  to.owner = owner;
  report.edges = write_cutouts(to, objects, job);
  for (const EdgesReport& edges : report.edges) report.total_ms += edges.ms + edges.seen_ms;
  report.rest = write_rest(to, owner, report.edges, chosen.camera);
  if (report.rest.gaussians == 0) options.warn("the cut takes the whole scene: the rest holds no Gaussians");
  for (const auto& [file, lost] : lost_by_file(report)) options.warn(fmt::format("{}: {}", file, lost));
  if (args.cutout.writes("objects")) {
    std::vector<std::string> names;
    for (const CutObject& object : objects) names.push_back(object.name);
    write_object_names(folder.file("objects.json"), names);
  }
  FinishedCut run{report_json(report), summary(report), std::move(objects)};
  run.report["placed"] = {{"origin", args.cutout.origin}, {"up", args.cutout.up}, {"scale", placement.scale}};
  write_text_file(folder.file("report.json"), json_text(run.report, 2) + "\n");
  stop_if_cancelled(job, "splatcut cut");
  return run;
}

}  // namespace splatcut
