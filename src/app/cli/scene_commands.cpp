// splatcut info, render, convert.
#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <functional>
#include <memory>

#include "app/cli/commands.h"
#include "app/console/camera_options.h"
#include "app/console/console.h"
#include "app/console/kept_inputs.h"
#include "app/console/labels_file.h"
#include "app/console/output_folder.h"
#include "app/console/scene_options.h"
#include "core/error.h"
#include "core/json_file.h"
#include "core/mapped_file.h"
#include "core/png_file.h"
#include "scene/cloud/scene_memory.h"
#include "scene/formats/scene_file.h"
#include "scene/raster/rasterizer.h"

namespace splatcut {

namespace {

struct SceneArguments {
  std::filesystem::path scene, output, labels;
  SceneOptions how;
  CameraOptions camera;
  std::optional<int> spz_version;
  std::string what = "colour", background = "0,0,0";
  float low_pass_px2 = kLowPassPx2;
  bool all_cameras = false, json = false, overwrite = false;
};

nlohmann::json info_json(const Scene& scene) {
  const Box box = robust_bounds(scene.cloud.position);
  const auto list = [](const glm::dvec3& v) { return nlohmann::json{v.x, v.y, v.z}; };
  const auto in_file = [&](const glm::vec3& v) { return list(glm::dvec3(v) + scene.origin); };
  nlohmann::json info = {{"file", scene.path.string()},
                         {"format", scene.format.name},
                         {"file_bytes", scene.file_bytes},
                         {"file_rows", scene.file_rows},
                         {"gaussians", scene.cloud.size()},
                         {"dropped", scene.dropped},
                         {"memory_bytes", memory_of_scene(scene.cloud.size(), scene.cloud.sh_degree)},
                         {"sh_degree", scene.cloud.sh_degree},
                         {"bounds_98", {{"min", in_file(box.min)}, {"max", in_file(box.max)}}},
                         {"antialiased", scene.cloud.antialiased}};
  if (scene.origin != glm::dvec3(0)) info["origin"] = list(scene.origin);
  if (scene.up) info["up"] = list(*scene.up);
  if (scene.taken_axes) info["spz_axes"] = name_of(*scene.taken_axes);
  return info;
}

void run_info(const SceneArguments& args, const CommonOptions& common) {
  const Job job = console_job(common.quiet);
  const Scene scene = args.how.load(args.scene, {}, common.quiet, job);
  end_progress();
  stop_if_cancelled(job, "splatcut info");
  const nlohmann::json info = info_json(scene);
  if (args.json) {
    fmt::print("{}\n", json_text(info, 2));
    return;
  }
  for (const auto& [key, value] : info.items())
    fmt::print("{:<12} {}\n", key, value.is_string() ? value.get<std::string>() : json_text(value));
}

// strip: the rows of the picture from y0 on.
using TakeStrip = std::function<void(const RasterOutput& strip, int y0)>;

// Strip by strip, to the same bits, so that a large picture takes little memory beside itself and says how
// far it is.
void draw_strips(const GaussianCloud& cloud, const Camera& camera, const RasterOptions& options,
                 const Job& job, const TakeStrip& take) {
  constexpr int kStripPixels = 1 << 24, kTiles = 16;  // px
  const int rows = std::max(1, kStripPixels / camera.width_px / kTiles) * kTiles;
  for (int y = 0; y < camera.height_px && !job.cancelled(); y += rows) {
    job.progress("render", static_cast<double>(y) / camera.height_px);
    RasterOptions strip = options;
    strip.roi = PixelRect{0, y, camera.width_px, std::min(camera.height_px, y + rows)};
    take(rasterize(cloud, camera, strip, job), y);
  }
}

// The pixels of a strip, in their places of the whole.
template <class Pixel>
void put(const Image<Pixel>& strip, int y0, Image<Pixel>* whole) {
  std::ranges::copy(strip.pixels(),
                    whole->pixels().begin() + static_cast<std::ptrdiff_t>(y0) * whole->width());
}

Image<std::uint8_t> grey_of(const Image<float>& alpha) {
  Image<std::uint8_t> grey(alpha.width(), alpha.height());
  std::ranges::transform(alpha.pixels(), grey.pixels().begin(),
                         [](float a) { return static_cast<std::uint8_t>(a * 255 + 0.5f); });
  return grey;
}

std::size_t pixel_bytes_of(const std::string& what) {
  if (what == "depth") return sizeof(float) + sizeof(std::uint16_t);
  return what == "alpha" ? 1 : sizeof(Rgb8);
}

// Before a picture that takes long: so that it can be stopped.
void say_memory(const Camera& camera, std::size_t pixel_bytes, bool quiet) {
  constexpr double kFrom = 0.25, kGb = 1e9;
  const double gb =
      static_cast<double>(camera.width_px) * camera.height_px * static_cast<double>(pixel_bytes) / kGb;
  if (!quiet && gb >= kFrom)
    to_stderr(fmt::format("{} x {} pixels take {:.1f} GB of memory beside the scene.\n", camera.width_px,
                          camera.height_px, gb));
}

void write_depth(const std::filesystem::path& path, const Image<float>& depth) {
  // Near white, far black, over what is there; 16 bits.
  float nearest = 1e30f, farthest = 0;
  for (const float z : depth.pixels())
    if (z > 0) {
      nearest = std::min(nearest, z);
      farthest = std::max(farthest, z);
    }
  Image<std::uint16_t> grey(depth.width(), depth.height());
  const float range = std::max(1e-30f, farthest - nearest);
  std::ranges::transform(depth.pixels(), grey.pixels().begin(), [&](float z) {
    return z > 0 ? static_cast<std::uint16_t>(65535 - 60000 * (z - nearest) / range) : std::uint16_t{0};
  });
  write_png(path, grey);
}

// One view, as --what says.
void draw_view(const SceneArguments& args, const GaussianCloud& cloud, const Camera& camera,
               const RasterOptions& options, const std::filesystem::path& output, const Job& job) {
  const auto drawn = [&](auto whole, const auto& of_strip) {
    draw_strips(cloud, camera, options, job,
                [&](const RasterOutput& strip, int y0) { put(of_strip(strip), y0, &whole); });
    end_progress();
    stop_if_cancelled(job, "splatcut render");
    return whole;
  };
  const int width = camera.width_px, height = camera.height_px;
  check_picture(camera, pixel_bytes_of(args.what));
  if (args.what == "depth")
    write_depth(output, drawn(Image<float>(width, height),
                              [](const RasterOutput& strip) { return strip.expected_depth; }));
  else if (args.what == "alpha")
    write_png(output, drawn(Image<std::uint8_t>(width, height),
                            [](const RasterOutput& strip) { return grey_of(strip.alpha); }));
  else
    write_png(output, drawn(Image<Rgb8>(width, height),
                            [](const RasterOutput& strip) { return rgb8_from_linear(strip.colour); }));
}

// CAMERA.png for each camera, so that `cut --masks` finds them; in folders where the names have some.
void draw_all_cameras(const SceneArguments& args, const GaussianCloud& cloud, const ChosenCamera& chosen,
                      const RasterOptions& options, const Job& job) {
  OutputFolder folder(args.output, args.overwrite);
  for (const Camera& given : chosen.given) {
    const std::filesystem::path name = std::filesystem::path(given.name + ".png").lexically_normal();
    if (given.name.empty() || name.is_absolute() || *name.begin() == ".." ||
        given.name.find('\0') != std::string::npos)
      throw Error(args.camera.cameras.string(),
                  fmt::format("the camera {} has no name for a file", json_text(given.name)));
    const std::filesystem::path file = folder.file(name.string());
    if (std::filesystem::exists(file))
      throw Error(args.camera.cameras.string(), fmt::format("two cameras are called \"{}\"", given.name));
    std::filesystem::create_directories(file.parent_path());
    const Camera camera =
        args.camera.size.empty() ? given : resized(given, chosen.camera.width_px, chosen.camera.height_px);
    draw_view(args, cloud, camera, options, file, job);
  }
  folder.commit();
}

// What would be without effect.
glm::vec3 parse_colour(const std::string& text) {
  const std::optional<glm::dvec3> colour = three_numbers(text);
  if (!colour) throw Error("--background " + text, "is not a colour", "Write it as r,g,b, each from 0 to 1");
  return *colour;
}

void refuse_undrawn(const SceneArguments& args, bool with_background) {
  if (!args.labels.empty() && args.what != "labels")
    throw CLI::ArgumentMismatch("--labels goes with --what labels");
  if (with_background && (args.what == "depth" || args.what == "alpha"))
    throw CLI::ArgumentMismatch("--background is not seen in --what " + args.what);
  if (!args.camera.up.empty() && !args.camera.cameras.empty() && args.camera.position.empty())
    throw CLI::ArgumentMismatch("--camera-up turns no camera of --cameras: it goes with --camera-pos");
}

void run_render(const SceneArguments& args, const CommonOptions& common) {
  if (!args.all_cameras) {
    refuse_name_of_png(args.output);
    check_output_file(args.output, args.overwrite);
  }
  refuse_written_inputs(args.output, {args.scene, args.camera.cameras, args.labels});
  const Job job = console_job(common.quiet);
  const Scene scene = args.how.load(args.scene, args.camera.cameras, common.quiet, job);
  refuse_written_inputs(args.output, scene.files);
  const ChosenCamera chosen = choose_camera(args.camera, scene);
  warn(chosen.warning, common.quiet);
  RasterOptions options;
  options.background = parse_colour(args.background);
  options.low_pass_px2 = args.low_pass_px2;
  options.depth = args.what == "depth";
  std::vector<glm::vec3> colours;
  if (args.what == "labels") {
    if (args.labels.empty()) throw Error("splatcut render", "--what labels needs --labels FILE");
    for (const std::uint8_t l : load_labels(args.labels, scene)) colours.emplace_back(l ? 1.0f : 0.0f);
    options.colour_override = colours;
  }
  say_memory(chosen.camera, pixel_bytes_of(args.what), common.quiet);
  if (args.all_cameras)
    draw_all_cameras(args, scene.cloud, chosen, options, job);
  else
    draw_view(args, scene.cloud, chosen.camera, options, args.output, job);
  if (common.quiet) return;
  if (args.all_cameras)
    fmt::print("{}\n", args.output.string());
  else
    say_written(args.output, args.output.string() + "\n");
}

void run_convert(const SceneArguments& args, const CommonOptions& common) {
  refuse_written_inputs(args.output, {args.scene});
  check_output_file(args.output, args.overwrite);
  const SceneFormat format = output_format_from_name(args.output);
  const int spz_version = spz_version_for(args.output, args.spz_version);
  const Job job = console_job(common.quiet);
  const Scene scene = args.how.load(args.scene, {}, common.quiet, job);
  end_progress();
  stop_if_cancelled(job, "splatcut convert");
  refuse_written_inputs(args.output, scene.files);
  const SaveReport report = save_scene(args.output, scene, {}, format, {spz_version});
  if (common.quiet) return;
  say_written(args.output,
              fmt::format("{}: {} Gaussians, {} bytes\n{}", args.output.string(), report.gaussians,
                          report.bytes, report.loss.empty() ? "" : "Lost: " + report.loss + "\n"));
}

}  // namespace

void add_info_command(CLI::App& program, const CommonOptions& common) {
  auto args = std::make_shared<SceneArguments>();
  CLI::App& command = *program.add_subcommand("info", "Say what a scene file holds");
  command.add_option("scene", args->scene, "Scene file")->required();
  args->how.add_to(command);
  command.add_flag("--json", args->json, "Print JSON");
  command.callback([args, &common] { run_info(*args, common); });
}

void add_render_command(CLI::App& program, const CommonOptions& common) {
  auto args = std::make_shared<SceneArguments>();
  CLI::App& command = *program.add_subcommand("render", "Draw a view of a scene as PNG");
  command.footer("Example: splatcut render scene.ply --camera-pos 0,-1,-4 --camera-target 0,0,0 -o view.png");
  command.add_option("scene", args->scene, "Scene file")->required();
  args->how.add_to(command);
  args->camera.add_to(command);
  command.add_option("--what", args->what, "colour, depth, alpha or labels")
      ->check(CLI::IsMember({"colour", "depth", "alpha", "labels"}));
  command.add_option("--labels", args->labels, "labels.u8 of a cut, for --what labels");
  command.add_option("--background", args->background, "r,g,b from 0 to 1")
      ->check(CLI::Validator(
          [](std::string& text) {
            const glm::vec3 colour = parse_colour(text);
            const bool good = glm::clamp(colour, 0.0f, 1.0f) == colour;
            return good ? "" : fmt::format("{} is not within 0 to 1: 255 is 1", text);
          },
          "TEXT"));
  command
      .add_option("--lowpass", args->low_pass_px2,
                  fmt::format("px^2 added to the variance of every splat: {} as in training, {} as in web "
                              "viewers",
                              kLowPassPx2, kWebLowPassPx2))
      ->check(within(0, 100));
  command
      .add_flag("--all-cameras", args->all_cameras,
                "Draw what each camera of --cameras sees, as CAMERA.png in the folder of --output")
      ->needs("--cameras")
      ->excludes("--camera")
      ->excludes("--camera-pos");
  command.add_option("-o,--output", args->output, "PNG to write; with --all-cameras a folder")->required();
  command.add_flag("--overwrite", args->overwrite, "Replace an existing file");
  command.callback([args, &common, &command] {
    refuse_undrawn(*args, command.count("--background") > 0);
    run_render(*args, common);
  });
}

void add_convert_command(CLI::App& program, const CommonOptions& common) {
  auto args = std::make_shared<SceneArguments>();
  CLI::App& command = *program.add_subcommand(
      "convert", "Write a scene in another format (" + spoken_extensions(written_formats(), "or") + ")");
  command.footer("Example: splatcut convert scene.ply -o scene.spz");
  command.add_option("scene", args->scene, "Scene file")->required();
  args->how.add_to(command);
  command.add_option("-o,--output", args->output, "File to write; its ending names the format")->required();
  add_spz_version(command, &args->spz_version);
  command.add_flag("--overwrite", args->overwrite, "Replace an existing file");
  command.callback([args, &common] { run_convert(*args, common); });
}

}  // namespace splatcut
