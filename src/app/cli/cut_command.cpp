// splatcut cut: strokes in, cutout out.
#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <array>
#include <chrono>
#include <memory>

#include "app/cli/commands.h"
#include "app/cli/cut_report.h"
#include "app/cli/object_options.h"
#include "app/cli/work_cut.h"
#include "app/console/camera_options.h"
#include "app/console/console.h"
#include "app/console/kept_inputs.h"
#include "app/console/mask_options.h"
#include "app/console/scene_options.h"
#include "app/console/setting_options.h"
#include "core/atomic_file.h"
#include "core/error.h"
#include "core/json_file.h"
#include "core/stage_clock.h"
#include "segment/session/doubts.h"
#include "segment/session/session.h"
#include "segment/session/settings_table.h"

namespace splatcut {

namespace {

struct CutArguments {
  std::filesystem::path scene, work, output;
  ObjectOptions object;
  EdgeOptions edges;
  std::vector<std::string> set;
  std::string preset = "default";
  SceneOptions how;
  CameraOptions camera;
  MaskOptions masks;
  int scale = 0;
  std::optional<float> smoothness;
  bool coarse = false, json = false, overwrite = false;
};

CutSettings settings_of(const CutArguments& args) {
  CutSettings settings = preset(args.preset);
  if (args.smoothness) set_setting("smoothness", fmt::format("{}", *args.smoothness), &settings);
  settings.cut.coarse = args.coarse;
  args.masks.apply(&settings);
  for (const std::string& assignment : args.set) set_setting(assignment, &settings);
  return settings;
}

nlohmann::json settings_json(const CutArguments& args, const ObjectInput& input, const ChosenCamera& chosen,
                             const CutSettings& settings) {
  nlohmann::json json = {
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
  if (!input.mask.empty()) json["mask"] = input.mask.string();
  if (!input.masks_folder.empty()) json["masks"] = input.masks_folder.string();
  if (input.segmenter) json.update({{"text", input.segmenter->text}, {"segmenter", input.segmenter->words}});
  return json;
}

Session session_of(const std::shared_ptr<const Scene>& scene, const ChosenCamera& chosen,
                   const PreparedCache& cache) {
  return Session({.cloud = {scene, &scene->cloud},
                  .up_world = chosen.up_world,
                  .photographs = chosen.given,
                  .prepare = {.observing = {}, .model = {}, .cache = cache}});
}

// The request of the command line, or that of each object of --seeds.
std::vector<CutObject> objects_of(const CutArguments& args, const ObjectInput& input, const Scene& scene,
                                  bool quiet, const Job& job, ChosenCamera* chosen) {
  RequestRemarks remarks;
  CutRequest request = request_of(input, args.camera, scene.cloud, job, chosen, &remarks);
  if (!remarks.understood.empty() && !quiet) {
    end_progress();
    to_stderr(remarks.understood + "\n");
  }
  for (const std::string& remark : remarks.warnings) warn(remark, quiet);
  stop_if_cancelled(job, "splatcut cut");
  std::vector<CutObject> objects = objects_of(input.objects, *chosen, args.camera);
  if (objects.empty()) objects.push_back({{}, std::move(request), chosen->camera, {}});
  for (CutObject& object : objects) {
    object.request.part_step = args.scale;
    check_inside(object.request);
  }
  return objects;
}

void warn_of_doubts(const std::vector<CutObject>& objects, bool quiet) {
  for (const CutObject& object : objects) {
    const std::string whose = object.name.empty() ? "" : object.name + ": ";
    for (const std::string& sentence : doubts(object.result)) warn(whose + sentence, quiet);
    if (object.name.empty() && object.result.ambiguous && !quiet)
      to_stderr("--scale takes a smaller or a larger one\n");
  }
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

// The work file gives scene, strokes and settings.
void refuse_beside_work(const CLI::App& command) {
  for (const CLI::Option* option : command.get_options([](const CLI::Option* o) { return o->count() > 0; })) {
    const std::string name = option->get_name();
    constexpr std::array kMayStand = {"--work", "--output", "--edges", "--json", "--overwrite"};
    if (std::ranges::find(kMayStand, name) == kMayStand.end())
      throw Error("--work", fmt::format("cannot go with {}: the work file says that", name),
                  "Change the work in the window, or leave the option out");
  }
}

void run_cut(const CutArguments& args, const CommonOptions& common) {
  if (!args.work.empty())
    return run_work_cut({args.work, args.output, args.edges, args.overwrite, args.json, common.quiet,
                         prepared_cache(common)});
  if (args.scene.empty()) throw CLI::RequiredError("scene, or --work FILE.splatcut.json,");
  refuse_written_inputs(args.output, {args.scene, args.camera.cameras, args.object.seeds, args.object.mask,
                                      args.object.masks_folder});
  const ObjectInput input = args.object.read(args.camera);
  const Job job =
      console_job(common.quiet);  // first: Ctrl+C must find its handler once there is a folder to remove
  OutputFolder folder(args.output, args.overwrite);
  const auto start = std::chrono::steady_clock::now();
  const auto scene =
      std::make_shared<const Scene>(args.how.load(args.scene, args.camera.cameras, common.quiet, job));
  stop_if_cancelled(job, "splatcut cut");
  refuse_written_inputs(args.output, scene->files);
  const double load_ms = ms_since(start);
  ChosenCamera chosen = choose_camera(args.camera, scene->cloud, scene->origin);
  warn(chosen.warning, common.quiet);
  const CutSettings settings = settings_of(args);
  if (input.segmenter) end_progress();  // the program prints to the same place
  std::vector<CutObject> objects = objects_of(args, input, *scene, common.quiet, job, &chosen);
  const nlohmann::json said = settings_json(args, input, chosen, settings);
  Session session = session_of(scene, chosen, prepared_cache(common));
  const std::vector<std::uint8_t> owner = cut_objects(&objects, &session, settings, job);
  end_progress();
  stop_if_cancelled(job, "splatcut cut");
  warn_of_doubts(objects, common.quiet);
  RunReport report{*scene, said, objects, {}, 0, load_ms, ms_since(start)};
  const CutoutFolder to{folder, *scene, session.blocks(), chosen.up_world, chosen.given, args.edges};
  report.edges = write_cutouts(to, objects, job);
  for (const EdgesReport& edges : report.edges) report.total_ms += edges.ms;
  report.rest = write_rest(to, owner, chosen.camera);
  if (report.rest == 0) warn("the cut takes the whole scene: rest.ply holds no Gaussians", common.quiet);
  const std::string text = json_text(report_json(report), 2) + "\n";
  write_text_file(folder.file("report.json"), text);
  stop_if_cancelled(job, "splatcut cut");
  folder.commit();
  if (!common.quiet || args.json) fmt::print("{}", args.json ? text : summary(report, args.output.string()));
}

}  // namespace

void add_cut_command(CLI::App& program, const CommonOptions& common) {
  auto args = std::make_shared<CutArguments>();
  CLI::App& command =
      *program.add_subcommand("cut", "Cut the object that clicks, strokes, masks or words point at");
  command.footer(
      "Settings of --set (and more for experiments: a wrong name lists them):\n" + settings_help() +
      "Example: splatcut cut scene.ply --camera-pos 0,-1,-4 --camera-target 0,0,0 --click 512,384 --click "
      "40,40:rest -o cutout");
  command.add_option("scene", args->scene, "Scene file");
  args->how.add_to(command);
  args->camera.add_to(command);
  args->object.add_to(command);
  command
      .add_option("--work", args->work,
                  "Work saved by the window (.splatcut.json): computes all its objects again")
      ->check(CLI::ExistingFile);
  command.add_option("-o,--output", args->output, "Folder to write")->required();
  args->edges.add_to(command);
  args->masks.add_to(command, false);
  command.get_option("--parts-only")->excludes("--masks");
  command.add_option("--smoothness", args->smoothness,
                     "Weight of the neighbour term in the last cut, 0 to 500: as the window's slider");
  command
      .add_option("--scale", args->scale,
                  "Next larger (+1, +2, ...) or smaller (-1, ...) part for the first click or box")
      ->check(CLI::Range(-100, 100));
  add_setting_options(command, &args->preset, &args->set);
  command.add_flag("--coarse", args->coarse, "Threshold the likelihood instead of the cut");
  command.add_flag("--json", args->json, "Print the report as JSON");
  command.add_flag("--overwrite", args->overwrite, "Replace existing output");
  command.callback([args, &common, &command] {
    if (!args->work.empty()) refuse_beside_work(command);
    run_cut(*args, common);
  });
}

}  // namespace splatcut
