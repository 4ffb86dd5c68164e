// splatcut cut: strokes in, cutout out.
#include <fmt/format.h>

#include <chrono>
#include <memory>
#include <nlohmann/json.hpp>

#include "app/camera_options.h"
#include "app/commands.h"
#include "app/console.h"
#include "app/cutout_files.h"
#include "app/mask_options.h"
#include "app/seeds_file.h"
#include "app/tuning_options.h"
#include "app/work_cut.h"
#include "scene/atomic_file.h"
#include "scene/error.h"
#include "scene/png_file.h"

namespace splatcut {

namespace {

struct CutArguments {
  std::filesystem::path scene, seeds, mask, work, output;
  std::vector<std::string> clicks, set;
  std::string preset = "default";
  CameraOptions camera;
  MaskOptions masks;
  int scale = 0;
  float lambda = -1;
  bool coarse = false, json = false, overwrite = false;
};

Strokes strokes_of(const CutArguments& args) {
  Strokes strokes;
  if (!args.seeds.empty()) strokes = load_seeds(args.seeds);
  for (const std::string& text : args.clicks) strokes.push_back(parse_click(text));
  if (strokes.empty() && args.mask.empty())
    throw Error("splatcut cut", "nothing says which object is meant", "Give --click x,y, --seeds FILE or --mask FILE");
  return strokes;
}

PipelineOptions pipeline_of(const CutArguments& args, const ChosenCamera& chosen) {
  PipelineOptions options = preset(args.preset);
  if (args.lambda >= 0) options.cut.energy.lambda = args.lambda;
  options.cut.coarse = args.coarse;
  options.pick.scale_steps = args.scale;
  args.masks.apply(&options);
  for (const std::string& assignment : args.set) set_tuning_option(assignment, &options);
  if (args.mask.empty()) return options;
  Mask mask = read_png_grey(args.mask);
  if (mask.width() != chosen.camera.width_px || mask.height() != chosen.camera.height_px)
    throw Error(args.mask.string(),
                fmt::format("is {}x{} pixels, the camera's picture {}x{}", mask.width(), mask.height(), chosen.camera.width_px, chosen.camera.height_px),
                "Give --size, or another mask");
  for (auto& m : mask.pixels()) m = m >= 128 ? kMaskObject : 0;
  options.given_first_mask = std::move(mask);
  return options;
}

void check_inside(const Strokes& strokes, const Camera& camera) {
  for (const Stroke& stroke : strokes)
    for (const glm::vec2& p : stroke.points_px)
      if (!(p.x >= 0 && p.y >= 0 && p.x < static_cast<float>(camera.width_px) && p.y < static_cast<float>(camera.height_px)))
        throw Error("strokes", fmt::format("the point {},{} lies outside of the {}x{} picture", p.x, p.y, camera.width_px, camera.height_px));
}

void print_summary(const CutArguments& args, const Scene& scene, const nlohmann::json& report) {
  fmt::print("{} of {} Gaussians cut out in {:.0f} ms\n", report["object"]["gaussians"].get<std::size_t>(), scene.cloud.size(),
             report["total_ms"].get<double>());
  for (const auto& stage : report["stages"]) fmt::print("  {:<16} {:8.0f} ms\n", stage["name"].get<std::string>(), stage["ms"].get<double>());
  fmt::print("{}: object.ply rest.ply labels.u8 object.png rest.png tint.png masks.png report.json\n", args.output.string());
}

// A first click that could mean several sizes says so.
void say_other_sizes(const PipelineReport& report) {
  if (report.ambiguous)
    fmt::print(stderr, "the first click could mean a part of another size: this is {} of {}, see --scale\n", report.first_size + 1, report.first_sizes);
}

void run_cut(const CutArguments& args, const CommonOptions& common) {
  if (!args.work.empty()) return run_work_cut({args.work, args.output, args.overwrite, args.json, common.quiet, prepared_cache(common)});
  if (args.scene.empty()) throw CLI::RequiredError("scene, or --work FILE.splatcut.json,");
  const Strokes strokes = strokes_of(args);
  const Job job = console_job(common.quiet);  // first: Ctrl+C must find its handler once there is a folder to remove
  OutputFolder folder(args.output, args.overwrite);
  const auto start = std::chrono::steady_clock::now();
  const auto ms_since_start = [&] { return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count(); };
  const Scene scene = load_scene(args.scene, job);
  if (job.cancelled()) throw Error("splatcut cut", "cancelled, nothing was written");
  const double load_ms = ms_since_start();
  const ChosenCamera chosen = choose_camera(args.camera, scene.cloud);
  warn(chosen.warning, common.quiet);
  check_inside(strokes, chosen.camera);
  PipelineOptions options = pipeline_of(args, chosen);
  options.scene_cameras = chosen.given;
  options.cache = prepared_cache(common);
  PipelineReport report = cut_out(scene.cloud, nullptr, chosen.camera, chosen.up_world, strokes, options, job);
  end_progress();
  if (report.outcome == Outcome::kCancelled) throw Error("splatcut cut", "cancelled, nothing was written");
  if (report.outcome == Outcome::kNothingFound) throw Error("splatcut cut", "no object was found: " + report.reason);
  if (!common.quiet) say_other_sizes(report);
  report.stages.insert(report.stages.begin(), {"load", load_ms});
  const nlohmann::json settings = {{"preset", args.preset}, {"views", options.orbit.views}, {"work_width_px", options.work_width_px},
                                   {"neighbours", options.neighbours}, {"lambda", options.cut.energy.lambda}, {"set", args.set}, {"coarse", options.cut.coarse},
                                   {"first_mask", args.masks.first_mask.empty() ? "as the preset" : args.masks.first_mask}, {"scale", args.scale}, {"parts_only", args.masks.parts_only}};
  const nlohmann::json json = report_json(scene, report, settings, ms_since_start());
  write_cutout_scenes(folder, scene, report.labels);
  write_cutout_pictures(folder, scene.cloud, chosen.camera, report);
  write_text_file(folder.file("report.json"), json.dump(2) + "\n");
  if (job.cancelled()) throw Error("splatcut cut", "cancelled, nothing was written");
  folder.commit();
  if (args.json)
    fmt::print("{}\n", json.dump(2));
  else if (!common.quiet)
    print_summary(args, scene, json);
}

}  // namespace

void add_cut_command(CLI::App& program, const CommonOptions& common) {
  auto args = std::make_shared<CutArguments>();
  CLI::App& command = *program.add_subcommand("cut", "Cut the object that clicks, strokes or a mask point at");
  command.footer("Example: splatcut cut scene.ply --camera-pos 0,-1,-4 --camera-target 0,0,0 --click 512,384 --click 40,40:rest -o cutout");
  command.add_option("scene", args->scene, "Scene file");
  args->camera.add_to(command);
  command.add_option("--click", args->clicks, "Pixel x,y[:object|:rest] of the reference view; may be repeated");
  command.add_option("--seeds", args->seeds, "JSON file with clicks and scribbles");
  command.add_option("--mask", args->mask, "PNG mask of the reference view, white = object");
  command.add_option("--work", args->work, "Work saved by the window (.splatcut.json): computes all its objects again")->check(CLI::ExistingFile);
  command.add_option("-o,--output", args->output, "Folder to write")->required();
  command.add_option("--preset", args->preset, "fast, default, best, paper or paper-code");
  args->masks.add_to(command, false);
  command.add_option("--smoothness", args->lambda, "Weight of the neighbour term")->check(CLI::Range(0.0, 500.0));
  command.add_option("--scale", args->scale, "Next larger (+1, +2, ...) or smaller (-1, ...) part for the first click")->check(CLI::Range(-100, 100));
  add_tuning_options(command, &args->set);
  command.add_flag("--coarse", args->coarse, "Threshold the likelihood instead of the cut");
  command.add_flag("--json", args->json, "Print the report as JSON");
  command.add_flag("--overwrite", args->overwrite, "Replace existing output");
  command.callback([args, &common] { run_cut(*args, common); });
}

}  // namespace splatcut
