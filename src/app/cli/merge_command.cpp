// splatcut merge: the Gaussians of several scenes in one file.
#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <memory>

#include "app/cli/commands.h"
#include "app/console/console.h"
#include "app/console/kept_inputs.h"
#include "app/console/output_folder.h"
#include "app/console/scene_options.h"
#include "scene/formats/merged_scene.h"

namespace splatcut {

namespace {

struct MergeArguments {
  std::vector<std::filesystem::path> scenes;
  std::filesystem::path output;
  SceneOptions how;
  std::optional<int> spz_version;
  bool overwrite = false;
};

// One bar for all files.
Job part_of(const Job& job, std::size_t scene, std::size_t scenes) {
  Job part = job;
  if (job.on_progress)
    part.on_progress = [&job, scene, scenes](std::string_view, double fraction) {
      job.progress(fmt::format("scene {} of {}", scene + 1, scenes),
                   (static_cast<double>(scene) + fraction) / static_cast<double>(scenes));
    };
  return part;
}

std::vector<Scene> load_all(const MergeArguments& args, bool quiet, const Job& job) {
  std::vector<Scene> scenes;
  for (std::size_t i = 0; i < args.scenes.size(); ++i) {
    const std::filesystem::path& path = args.scenes[i];
    const auto origin = i == 0 ? std::nullopt : std::optional(scenes.front().origin);
    scenes.push_back(
        args.how.load(path, {}, quiet, part_of(job, i, args.scenes.size()), path.string(), origin));
    stop_if_cancelled(job, "splatcut merge");
  }
  args.how.check_axes(scenes);
  return scenes;
}

std::vector<std::string> counts_of(const std::vector<Scene>& scenes) {
  std::vector<std::string> counts;
  for (const Scene& scene : scenes)
    counts.push_back(fmt::format("{}: {} Gaussians", scene.path.string(), scene.cloud.size()));
  return counts;
}

void run_merge(const MergeArguments& args, const CommonOptions& common) {
  refuse_written_inputs(args.output, args.scenes);
  check_output_file(args.output, args.overwrite);
  const SceneFormat format = output_format_from_name(args.output);
  const int spz_version = spz_version_for(args.output, args.spz_version);
  const Job job = console_job(common.quiet);
  std::vector<Scene> scenes = load_all(args, common.quiet, job);
  const std::vector<std::string> counts = counts_of(scenes);
  const MergedScene whole = merged(std::move(scenes), job);
  end_progress();
  stop_if_cancelled(job, "splatcut merge");
  refuse_written_inputs(args.output, whole.scene.files);
  const SaveReport report = save_scene(args.output, whole.scene, {}, format, {spz_version});
  if (common.quiet) return;
  std::string said;
  for (const std::string& count : counts) said += count + "\n";
  said += fmt::format("{}: {} Gaussians, {} bytes\n", args.output.string(), report.gaussians, report.bytes);
  const std::string between = whole.loss.empty() || report.loss.empty() ? "" : "; ";
  const std::string loss = whole.loss + between + report.loss;
  if (!loss.empty()) said += "Lost: " + loss + "\n";
  say_written(args.output, said);
}

}  // namespace

void add_merge_command(CLI::App& program, const CommonOptions& common) {
  auto args = std::make_shared<MergeArguments>();
  CLI::App& command =
      *program.add_subcommand("merge", "Write several scenes into one file, each in its own coordinates (" +
                                           spoken_extensions(written_formats(), "or") + ")");
  command.footer("Example: splatcut merge room.ply chair.spz -o both.ply");
  constexpr int kAtLeastTwo = -2;  // as CLI11 says it
  command.add_option("scenes", args->scenes, "Scene files, two or more, in the order of their Gaussians")
      ->required()
      ->expected(kAtLeastTwo)
      ->type_name("FILE");
  args->how.add_to(command);
  command.add_option("-o,--output", args->output, "File to write; its ending names the format")->required();
  add_spz_version(command, &args->spz_version);
  command.add_flag("--overwrite", args->overwrite, "Replace an existing file");
  command.callback([args, &common] { run_merge(*args, common); });
}

}  // namespace splatcut
