// splatcut-lab make-scene: the labelled still life, with the switches for what makes real scenes hard.
#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <memory>

#include "app/console/console.h"
#include "app/console/output_folder.h"
#include "app/lab/lab_commands.h"
#include "app/measure/still_life_files.h"
#include "scene/still_life/still_life.h"

namespace splatcut {

namespace {

struct MakeSceneArguments {
  std::string name, format = "ply";
  std::filesystem::path output;
  StillLifeOptions options;
  bool overwrite = false;
};

void run_make_scene(const MakeSceneArguments& args, const CommonOptions& common) {
  refuse_existing(args.output, args.overwrite);
  const Job job = console_job(common.quiet);
  const LabelledScene made = make_still_life(args.options, job);
  if (job.cancelled()) throw Error("splatcut-lab make-scene", "cancelled, nothing was written");
  OutputFolder folder(args.output, args.overwrite);
  write_still_life(folder, made, args.name, args.format);
  if (job.cancelled()) throw Error("splatcut-lab make-scene", "cancelled, nothing was written");
  folder.commit();
  if (!common.quiet)
    fmt::print("{}: {} Gaussians in {}, labels, own, cameras.json, seeds.json, suite.json\n",
               args.output.string(), made.cloud.size(), args.name + "." + args.format);
}

}  // namespace

void add_make_scene_command(CLI::App& program, const CommonOptions& common) {
  auto args = std::make_shared<MakeSceneArguments>();
  StillLifeOptions& options = args->options;
  CLI::App& command = *program.add_subcommand("make-scene", "Make a labelled still life");
  command.add_option("name", args->name, "Name of the files")->required();
  command.add_option("-o,--output", args->output, "Folder to write")->required();
  command.add_option("--gaussians", options.gaussians, "How many")
      ->check(CLI::Range(std::size_t{1000}, std::size_t{10000000}));
  command.add_option("--seed", options.seed, "Random seed");
  command.add_option("--sh-degree", options.sh_degree, "Spherical harmonics")->check(CLI::Range(0, 3));
  command.add_option("--format", args->format, "What the scene is written as")
      ->check(CLI::IsMember(names_of(written_formats())));
  command.add_option("--thin-width-scale", options.thin_width_scale, "Width of leaves, handle and cable")
      ->check(within(0.01, 10));
  command.add_flag("--straddling", options.straddling, "Splats across object borders");
  command.add_flag("--skirts", options.skirts, "Splats of objects under what they stand on");
  command.add_flag("--floaters", options.floaters, "Faint blobs in the air");
  command.add_flag("--unseen-interior", options.unseen_interior, "Splats inside the objects");
  command.add_flag("--twins", options.twins, "An identical second apple");
  command.add_flag("--occluder", options.occluder, "A board in front of the mug");
  command.add_flag("--low-contrast", options.low_contrast, "Objects in the colour of the table");
  command.add_flag("--contact", options.contact, "Objects that touch");
  command.add_flag("--hidden-missing", options.hidden_missing, "Without what no camera sees");
  command.add_option("--without", options.without, "Without that object, all else in its place");
  command.add_flag("--overwrite", args->overwrite, "Replace existing output");
  command.callback([args, &common] { run_make_scene(*args, common); });
}

}  // namespace splatcut
