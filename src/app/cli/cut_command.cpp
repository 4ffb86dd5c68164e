// splatcut cut: strokes in, cutout out.
#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <array>
#include <chrono>
#include <memory>

#include "app/cli/commands.h"
#include "app/cli/cutout_files.h"
#include "app/cli/many_objects.h"
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

void print_summary(const CutArguments& args, const Scene& scene, const nlohmann::json& report) {
  if (report.contains("objects")) {
    for (const auto& o : report["objects"])
      fmt::print("{}: {} of {} Gaussians\n", o["file"].get<std::string>(), o["gaussians"].get<std::size_t>(),
                 scene.cloud.size());
    fmt::print(
        "{}: NAME.ply NAME.labels.u8 NAME.png NAME.tint.png NAME.masks.png of each, rest.ply rest.png "
        "labels.u8 report.json\n",
        args.output.string());
    return;
  }
  fmt::print("{} of {} Gaussians cut out in {:.0f} ms\n", report["object"]["gaussians"].get<std::size_t>(),
             scene.cloud.size(), report["total_ms"].get<double>());
  if (report["edges"].contains("why_kept"))
    fmt::print("edges are kept: {}\n", report["edges"]["why_kept"].get<std::string>());
  for (const auto& stage : report["stages"])
    fmt::print("  {:<16} {:8.0f} ms\n", stage["name"].get<std::string>(), stage["ms"].get<double>());
  fmt::print("{}: object.ply rest.ply labels.u8 object.png rest.png tint.png masks.png report.json\n",
             args.output.string());
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

CutResult cut_one_object(Session* session, const CutRequest& request, const CutSettings& settings,
                         const Job& job) {
  CutResult result = session->cut(request, settings, job);
  end_progress();
  stop_if_cancelled(job, "splatcut cut");
  if (result.outcome == Outcome::kNothingFound)
    throw Error("splatcut cut", "no object was found: " + result.reason);
  return result;
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
  const auto ms_since_start = [&] {
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  };
  const auto scene =
      std::make_shared<const Scene>(args.how.load(args.scene, args.camera.cameras, common.quiet, job));
  stop_if_cancelled(job, "splatcut cut");
  refuse_written_inputs(args.output, scene->files);
  const double load_ms = ms_since_start();
  ChosenCamera chosen = choose_camera(args.camera, scene->cloud);
  warn(chosen.warning, common.quiet);
  const CutSettings settings = settings_of(args);
  if (input.segmenter) end_progress();  // the program prints to the same place
  RequestRemarks remarks;
  CutRequest request = request_of(input, args.camera, scene->cloud, job, &chosen, &remarks);
  request.part_step = args.scale;
  if (!remarks.understood.empty() && !common.quiet) {
    end_progress();
    to_stderr(remarks.understood + "\n");
  }
  for (const std::string& remark : remarks.warnings) warn(remark, common.quiet);
  stop_if_cancelled(job, "splatcut cut");
  for (const StrokedView& view : request.strokes) check_inside(view.strokes, view.camera);
  const ManyObjects many{*scene, chosen, args.camera, settings, args.scale, input.objects, args.edges};
  check_objects(many);
  const nlohmann::json said = settings_json(args, input, chosen, settings);
  Session session = session_of(scene, chosen, prepared_cache(common));
  nlohmann::json json;
  if (input.objects.empty()) {
    CutResult result = cut_one_object(&session, request, settings, job);
    for (const std::string& sentence : doubts(result)) warn(sentence, common.quiet);
    if (result.ambiguous && !common.quiet) to_stderr("--scale takes a smaller or a larger one\n");
    result.stages.insert(result.stages.begin(), {"load", load_ms});
    const CutoutObject object(*scene, result.labels, args.edges,
                              {chosen.up_world, chosen.given, session.blocks()}, job);
    end_progress();
    stop_if_cancelled(job, "splatcut cut");
    result.stages.push_back({"edges", object.ms()});
    if (std::ranges::all_of(result.labels, [](std::uint8_t l) { return l != 0; }))
      warn("the cut takes the whole scene: rest.ply holds no Gaussians", common.quiet);
    json = report_json(*scene, result, said, ms_since_start());
    json["edges"] = object.report();
    write_cutout_scenes(folder, *scene, result.labels, object);
    write_cutout_pictures(folder, {scene->cloud, nullptr, &session.blocks()}, chosen.camera, result, object);
  } else {
    json = cut_many_objects(many, &session, folder, job);
    end_progress();
    stop_if_cancelled(job, "splatcut cut");
    for (const auto& object : json["objects"])
      for (const auto& sentence : object["doubts"])
        warn(fmt::format("{}: {}", object["name"].get<std::string>(), sentence.get<std::string>()),
             common.quiet);
    const nlohmann::json load = {{"name", "load"}, {"ms", load_ms}};
    json["stages"].insert(json["stages"].begin(), load);
    json.update(run_json(*scene, said, ms_since_start()));
  }
  write_text_file(folder.file("report.json"), json_text(json, 2) + "\n");
  stop_if_cancelled(job, "splatcut cut");
  folder.commit();
  if (args.json)
    fmt::print("{}\n", json_text(json, 2));
  else if (!common.quiet)
    print_summary(args, *scene, json);
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
