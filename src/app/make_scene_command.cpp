// splatcut make-scene: the labelled still life, with the switches for what makes real scenes hard.
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>

#include "app/commands.h"
#include "app/console.h"
#include "app/output_folder.h"
#include "scene/atomic_file.h"
#include "scene/camera_file.h"
#include "scene/morton.h"
#include "scene/scene_file.h"
#include "scene/still_life.h"

namespace splatcut {

namespace {

struct MakeSceneArguments {
  std::string name, format = "ply";
  std::filesystem::path output;
  StillLifeOptions options;
  bool overwrite = false;
};

nlohmann::json seeds_json(const LabelledScene& made) {
  nlohmann::json objects = nlohmann::json::array();
  for (const auto& seed : made.seeds)
    objects.push_back({{"object", seed.object}, {"camera", seed.camera},
                       {"clicks", {{{"x", seed.pixel.x}, {"y", seed.pixel.y}, {"label", "object"}}}}});
  return {{"labels", made.label_name}, {"objects", objects}};
}

// One entry per object, as `splatcut eval` takes them: clicks by the robot, every camera a test view.
nlohmann::json suite_json(const LabelledScene& made, const std::string& file, const std::string& labels_file) {
  nlohmann::json views = nlohmann::json::array(), scenes = nlohmann::json::array();
  for (const Camera& camera : made.cameras) views.push_back({{"camera", camera.name}});
  for (const auto& seed : made.seeds) {
    const auto label = std::ranges::find(made.label_name, seed.object) - made.label_name.begin();
    scenes.push_back({{"name", seed.object}, {"scene", file}, {"cameras", "cameras.json"},
                      {"truth", {{"labels", labels_file}, {"label", label}}},
                      {"reference", {{"camera", made.cameras[static_cast<std::size_t>(seed.camera)].name}}},
                      {"clicks", "robot"}, {"test_views", views}});
  }
  return {{"scenes", scenes}};
}

void run_make_scene(const MakeSceneArguments& args, const CommonOptions& common) {
  refuse_existing(args.output, args.overwrite);
  const Job job = console_job(common.quiet);
  const LabelledScene made = make_still_life(args.options);
  if (job.cancelled()) throw Error("splatcut make-scene", "cancelled, nothing was written");
  OutputFolder folder(args.output, args.overwrite);
  Scene scene;
  scene.file_rows = made.cloud.size();
  scene.format = SceneFormat::kSplat;  // no file behind it: every row is written from the cloud
  // Rows along a Morton curve: compressed .ply wants neighbours together, and the labels follow.
  const std::vector<std::uint32_t> order = morton_order(made.cloud.position);
  scene.cloud = permuted(made.cloud, order);
  std::vector<std::uint8_t> label(order.size());
  for (std::uint32_t row = 0; row < order.size(); ++row) {
    scene.cloud.file_row[row] = row;
    label[row] = made.label[order[row]];
  }
  const std::string file = args.name + "." + args.format;
  save_scene(folder.file(file), scene, {}, format_from_name(file));
  const std::string labels_file = args.name + ".labels.u8";
  AtomicFile labels(folder.file(labels_file));
  labels.write(std::as_bytes(std::span(label)));
  labels.commit();
  save_inria_cameras(folder.file("cameras.json"), made.cameras);
  write_text_file(folder.file("seeds.json"), seeds_json(made).dump(1) + "\n");
  write_text_file(folder.file("suite.json"), suite_json(made, file, labels_file).dump(1) + "\n");
  if (job.cancelled()) throw Error("splatcut make-scene", "cancelled, nothing was written");
  folder.commit();
  if (!common.quiet) fmt::print("{}: {} Gaussians in {}, labels, cameras.json, seeds.json, suite.json\n", args.output.string(), scene.cloud.size(), file);
}

}  // namespace

void add_make_scene_command(CLI::App& program, const CommonOptions& common) {
  auto args = std::make_shared<MakeSceneArguments>();
  StillLifeOptions& options = args->options;
  CLI::App& command = *program.add_subcommand("make-scene", "Make a labelled still life");
  command.add_option("name", args->name, "Name of the files")->required();
  command.add_option("-o,--output", args->output, "Folder to write")->required();
  command.add_option("--gaussians", options.gaussians, "How many")->check(CLI::Range(std::size_t{1000}, std::size_t{10000000}));
  command.add_option("--seed", options.seed, "Random seed");
  command.add_option("--sh-degree", options.sh_degree, "Spherical harmonics")->check(CLI::Range(0, 3));
  command.add_option("--format", args->format, "ply, compressed.ply, splat or spz")->check(CLI::IsMember({"ply", "compressed.ply", "splat", "spz"}));
  command.add_option("--thin-width-scale", options.thin_width_scale, "Width of leaves, handle and cable")->check(CLI::Range(0.01f, 10.0f));
  command.add_flag("--straddling", options.straddling, "Splats across object borders");
  command.add_flag("--floaters", options.floaters, "Faint blobs in the air");
  command.add_flag("--unseen-interior", options.unseen_interior, "Splats inside the objects");
  command.add_flag("--twins", options.twins, "An identical second apple");
  command.add_flag("--occluder", options.occluder, "A board in front of the mug");
  command.add_flag("--low-contrast", options.low_contrast, "Objects in the colour of the table");
  command.add_flag("--contact", options.contact, "Objects that touch");
  command.add_flag("--overwrite", args->overwrite, "Replace existing output");
  command.callback([args, &common] { run_make_scene(*args, common); });
}

}  // namespace splatcut
