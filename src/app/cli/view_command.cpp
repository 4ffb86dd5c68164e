// splatcut view: the window.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <iostream>
#include <memory>

#include "app/cli/commands.h"
#include "app/console/console.h"
#include "app/console/scene_options.h"
#include "app/window/window.h"
#include "app/work/work_file.h"
#include "core/error.h"
#include "scene/formats/scene_formats.h"

namespace splatcut {

namespace {

struct ViewArguments {
  WindowOptions window;
  SceneOptions how;
  std::string renderer = "auto";
  bool check = false, frame_times = false;
};

bool is_missing(const std::filesystem::path& path) {
  std::error_code unreadable;
  return !path.empty() && !std::filesystem::exists(path, unreadable) && !unreadable;
}

void run_view(ViewArguments args) {
  if (const std::string reason = args.check ? why_no_window() : ""; !reason.empty())
    throw Error("window", "cannot be opened here: " + reason);
  if (args.check) return;
  // Said here, not in a window that stays empty; one that opens some of the files says it of the others, but
  // not where saved work is the first.
  if (is_missing(args.window.open) &&
      (is_work_file(args.window.open) || std::ranges::all_of(args.window.added, is_missing)))
    throw Error(args.window.open.string(), "there is no such file or folder");
  if (is_missing(args.window.cameras))
    throw Error(args.window.cameras.string(), "there is no such file or folder");
  if (is_work_file(args.window.open) && !(args.window.cameras.empty() && args.window.camera.empty()))
    throw Error(args.window.open.string(), "is saved work, which has its own cameras",
                "Leave --cameras and --camera out");
  const auto is_spz = [](const std::filesystem::path& path) {
    const SceneFormat* format = find_format(path);
    return format && *format == SceneFormat::kSpz;
  };
  if (args.how.axes() && !is_spz(args.window.open) && std::ranges::none_of(args.window.added, is_spz))
    throw Error(args.window.open.string(), "is no .spz, whose axes alone can be chosen",
                "Leave --spz-axes out");
  args.window.renderer = args.renderer == "gl"    ? RendererChoice::kGl
                         : args.renderer == "cpu" ? RendererChoice::kCpu
                                                  : RendererChoice::kAuto;
  args.window.spz_axes = args.how.axes();
  args.window.lod = args.how.lod;
  if (args.frame_times) args.window.frame_times = &std::cout;
  constexpr bool kQuiet = true;
  args.window.stop = console_job(kQuiet).stop;
  run_window(args.window);
}

}  // namespace

void add_view_command(CLI::App& program, const CommonOptions& common) {
  auto args = std::make_shared<ViewArguments>();
  CLI::App& command = *program.add_subcommand("view", "Open the window (splatcut SCENE does the same)");
  command.footer("Example: splatcut view scene.ply");
  CLI::Option* scene = command.add_option("scene", args->window.open, "Scene file or .splatcut.json");
  command.add_option("more", args->window.added,
                     "Further scenes in the same window, side by side on what the first view shows");
  command
      .add_option("--cameras", args->window.cameras,
                  "cameras.json, transforms.json or a COLMAP folder, in place of cameras beside the scene")
      ->needs(scene);
  command
      .add_option("--camera", args->window.camera,
                  "Which of the cameras to begin with: its name, or its number from 0")
      ->needs(scene);
  args->how.add_to(command);
  command
      .add_option("--renderer", args->renderer,
                  "auto, gl or cpu: auto takes the CPU where OpenGL is software")
      ->check(CLI::IsMember({"auto", "gl", "cpu"}));
  command.add_option("--ui-scale", args->window.ui_scale, "Size of the interface, 1 is usual")
      ->check(within(0.5, 4));
  command.add_option("--width", args->window.width, "Width of the window")->check(CLI::Range(640, 8192));
  command.add_option("--height", args->window.height, "Height of the window")->check(CLI::Range(480, 8192));
  command.add_flag("--check", args->check, "Only say whether a window can open here (exit code 0 or 1)");
  command.add_flag(
      "--frame-times", args->frame_times,
      "Print the longest frame and the longest of its parts in every second, milliseconds as CSV");
  command.callback([args, &common] {
    args->window.cache = prepared_cache(common);
    run_view(*args);
  });
}

}  // namespace splatcut
