#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "app/cli/commands.h"
#include "core/error.h"
#include "scene/formats/scene_formats.h"

using namespace splatcut;

namespace {

constexpr std::array kMoved = {"eval", "study", "make-scene"};

bool is_scene(const std::string& word) {
  return has_scene_extension(word) || word.ends_with(".splatcut.json");
}

// Options first, then a scene and no command: `splatcut --width 1280 scene.ply`.
bool only_options_before_scene(const std::vector<std::string>& words) {
  constexpr std::array kCommands = {"view",    "info",  "render",  "cut",
                                    "convert", "merge", "compare", "describe"};
  if (words.empty() || !words.front().starts_with('-')) return false;
  const auto first = std::ranges::find_if(words, [&](const std::string& word) {
    return is_scene(word) || std::ranges::find(kCommands, word) != kCommands.end() ||
           std::ranges::find(kMoved, word) != kMoved.end();
  });
  return first != words.end() && is_scene(*first);
}

// `splatcut`, `splatcut SCENE` and `splatcut OPTIONS SCENE` mean `splatcut view`; of a command that has
// moved, its name is enough.
std::vector<std::string> with_command(std::vector<std::string> words) {
  const std::string first = words.empty() ? "" : words.front();
  if (words.empty() || is_scene(first) || only_options_before_scene(words))
    words.insert(words.begin(), "view");
  if (std::ranges::find(kMoved, first) != kMoved.end()) words.resize(1);
  return words;
}

void add_moved_command(CLI::App& program, const std::string& name) {
  program.add_subcommand(name)->group("")->callback([name] {
    throw Error("splatcut " + name, "is a command of the laboratory now",
                "Run splatcut-lab " + name + " with the same options");
  });
}

void add_commands(CLI::App& program, const CommonOptions& common) {
  add_info_command(program, common);
  add_render_command(program, common);
  add_cut_command(program, common);
  add_convert_command(program, common);
  add_merge_command(program, common);
  add_compare_command(program, common);
  add_view_command(program, common);
  add_describe_command(program);
  for (const char* name : kMoved) add_moved_command(program, name);
}

}  // namespace

int main(int argc, char** argv) {
  const CommandLine line{"splatcut", "Click an object in a 3D Gaussian Splatting scene, hold a clean cutout",
                         "splatcut cut scene.ply --click 512,384 -o cutout", add_commands};
  return run_command_line(line, with_command({argv + 1, argv + argc}));
}
