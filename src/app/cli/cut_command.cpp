// splatcut cut: strokes in, cutout out.
#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <array>
#include <memory>

#include "app/cli/commands.h"
#include "app/cli/cut_run.h"
#include "app/cli/work_cut.h"
#include "app/console/console.h"
#include "app/console/kept_inputs.h"
#include "core/error.h"
#include "core/json_file.h"
#include "segment/session/doubts.h"
#include "segment/session/settings_table.h"

namespace splatcut {

namespace {

struct CutCommand {
  CutArguments cut;
  std::filesystem::path work, output;
  bool json = false, overwrite = false;
};

// The work file gives scene, strokes and settings.
void refuse_beside_work(const CLI::App& command, const std::vector<std::string>& written) {
  for (const CLI::Option* option : command.get_options([](const CLI::Option* o) { return o->count() > 0; })) {
    const std::string name = option->get_name();
    constexpr std::array kMayStand = {"--work", "--output", "--edges", "--write", "--json", "--overwrite"};
    constexpr std::array kOfACut = {"--origin", "--up", "--scale-by"};
    if (std::ranges::find(kOfACut, name) != kOfACut.end())
      throw Error("--work", fmt::format("cannot go with {}: its objects are written where they are", name),
                  "Place them in the window's export, or leave the option out");
    if (std::ranges::find(kMayStand, name) == kMayStand.end())
      throw Error("--work", fmt::format("cannot go with {}: the work file says that", name),
                  "Change the work in the window, or leave the option out");
  }
  if (command.get_option("--write")->count() > 0) refuse_unwritten(written);
}

void warn_of_doubts(const std::vector<CutObject>& objects, bool quiet) {
  for (const CutObject& object : objects) {
    const std::string whose = object.name.empty() ? "" : object.name + ": ";
    for (const std::string& sentence : object.doubts()) warn(whose + sentence, quiet);
    if (object.name.empty() && unsure(object.result) && !quiet)
      to_stderr("--choice takes another meaning, --scale a smaller or a larger part\n");
  }
}

void run_cut(const CutCommand& command, const CommonOptions& common) {
  const CutArguments& args = command.cut;
  if (!command.work.empty())
    return run_work_cut({command.work, command.output, args.cutout, command.overwrite, command.json,
                         common.quiet, prepared_cache(common)});
  if (args.scene.empty()) throw CLI::RequiredError("scene, or --work FILE.splatcut.json,");
  refuse_written_inputs(command.output, args.inputs());
  const ObjectInput input = args.object.read(args.camera);
  const Job job =
      console_job(common.quiet);  // first: Ctrl+C must find its handler once there is a folder to remove
  OutputFolder folder(command.output, command.overwrite);
  SharedScene scene(args, prepared_cache(common), common.quiet, job);
  stop_if_cancelled(job, "splatcut cut");
  refuse_written_inputs(command.output, scene.scene().files);
  const CutRunOptions how{
      .quiet = common.quiet,
      .warn = [&](const std::string& sentence) { warn(sentence, common.quiet); },
  };
  const FinishedCut run = run_cut_in(&scene, args, input, folder, how, job);
  warn_of_doubts(run.objects, common.quiet);
  const std::vector<std::string> files = folder.names();
  folder.commit();
  constexpr std::size_t kListed = 20;
  std::string written;
  for (const std::string& file : files) written += " " + file;
  if (files.size() > kListed) written = fmt::format(" {} files", files.size());
  if (command.json)
    fmt::print("{}\n", json_text(run.report, 2));
  else if (!common.quiet)
    fmt::print("{}{}:{}\n", run.summary, command.output.string(), written);
}

}  // namespace

void add_cut_command(CLI::App& program, const CommonOptions& common) {
  auto args = std::make_shared<CutCommand>();
  CLI::App& command =
      *program.add_subcommand("cut", "Cut the object that clicks, strokes, masks or words point at");
  command.footer(
      "Settings of --set (and more for experiments: a wrong name lists them):\n" + settings_help() +
      "Example: splatcut cut scene.ply --camera-pos 0,-1,-4 --camera-target 0,0,0 --click 512,384 --click "
      "40,40:rest -o cutout");
  args->cut.add_to(command);
  command
      .add_option("--work", args->work,
                  "Work saved by the window (.splatcut.json): computes all its objects again")
      ->check(CLI::ExistingFile);
  command.add_option("-o,--output", args->output, "Folder to write")->required();
  command.add_flag("--json", args->json, "Print the report as JSON");
  command.add_flag("--overwrite", args->overwrite, "Replace existing output");
  command.callback([args, &common, &command] {
    if (!args->work.empty()) refuse_beside_work(command, args->cut.cutout.write);
    run_cut(*args, common);
  });
}

}  // namespace splatcut
