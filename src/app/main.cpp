#include <fmt/format.h>
#include <tbb/global_control.h>

#include <cstdio>
#include <new>
#include <optional>
#include <string>
#include <vector>

#include "app/commands.h"
#include "app/console.h"
#include "scene/error.h"

using namespace splatcut;

namespace {

constexpr int kCouldNot = 1, kWrongUsage = 2;

// `splatcut` and `splatcut SCENE` mean `splatcut view`.
void parse(CLI::App& program, int argc, char** argv) {
  const std::string first = argc > 1 ? argv[1] : "";
  const auto ends = [&](const char* ending) { return first.ends_with(ending); };
  const bool scene = ends(".ply") || ends(".splat") || ends(".spz") || ends(".splatcut.json");
  std::vector<std::string> words;  // from the last to the first, as CLI11 wants them
  for (int i = argc - 1; i > 0; --i) words.emplace_back(argv[i]);
  if (argc == 1 || scene) words.emplace_back("view");
  program.parse(std::move(words));
}

int run(int argc, char** argv) {
  CLI::App program{"Click an object in a 3D Gaussian Splatting scene, hold a clean cutout"};
  program.footer("Example: splatcut cut scene.ply --click 512,384 -o cutout");
  program.set_version_flag("--version", "splatcut " SPLATCUT_VERSION);
  program.require_subcommand(1);
  program.fallthrough();
  CommonOptions common;
  program
      .add_option("--threads", common.threads, "Worker threads (0: all cores); results do not depend on it")
      ->check(CLI::NonNegativeNumber);
  program.add_flag("--quiet", common.quiet, "Print errors only");
  program.add_flag("!--no-cache", common.cache,
                   "Keep nothing of scenes that were prepared, and use nothing that was kept");
  std::optional<tbb::global_control> limit;
  program.parse_complete_callback([&] {
    if (common.threads > 0)
      limit.emplace(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(common.threads));
  });
  add_info_command(program, common);
  add_render_command(program, common);
  add_cut_command(program, common);
  add_convert_command(program, common);
  add_make_scene_command(program, common);
  add_eval_command(program, common);
  add_study_command(program, common);
  add_compare_command(program, common);
  add_view_command(program, common);
  try {
    parse(program, argc, argv);
    return 0;
  } catch (const CLI::ParseError& error) {
    return program.exit(error) == 0 ? 0 : kWrongUsage;
  }
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const std::bad_alloc&) {
    splatcut::end_progress();
    fmt::print(stderr, "splatcut: not enough memory for this scene. Try fewer views or a smaller scene.\n");
  } catch (const std::exception& error) {
    splatcut::end_progress();
    fmt::print(stderr, "splatcut: {}\n", error.what());
  }
  return kCouldNot;
}
