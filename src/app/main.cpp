#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "app/cli/commands.h"
#include "scene/formats/scene_formats.h"

using namespace splatcut;

namespace {

struct Command {
  const char* name;
  void (*add)(CLI::App& program, const CommonOptions& common);
};

// In the order of --help.
constexpr std::array kCommands = {
    Command{"info", add_info_command},   Command{"render", add_render_command},
    Command{"cut", add_cut_command},     Command{"batch", add_batch_command},
    Command{"serve", add_serve_command}, Command{"convert", add_convert_command},
    Command{"merge", add_merge_command}, Command{"compare", add_compare_command},
    Command{"view", add_view_command}};

bool is_scene(const std::string& word) {
  return has_scene_extension(word) || word.ends_with(".splatcut.json");
}

// A scene of several files by its folder, or a file that the window says what is wrong with.
bool is_there(const std::string& word) {
  std::error_code ignored;
  return std::filesystem::exists(word, ignored);
}

bool is_command(const std::string& word) {
  return std::ranges::any_of(kCommands, [&](const Command& command) { return command.name == word; });
}

// Options first and no command before what could be a scene: `splatcut --width 1280 scene.ply`, also without
// a scene. Help and version are the program's own.
bool only_options_before_scene(const std::vector<std::string>& words) {
  if (words.empty() || !words.front().starts_with('-')) return false;
  const std::array<std::string, 3> kOwn = {"-h", "--help", "--version"};
  const auto is_own = [&](const std::string& word) { return std::ranges::count(kOwn, word) > 0; };
  if (std::ranges::any_of(words, is_own) && std::ranges::none_of(words, is_scene)) return false;
  const auto first =
      std::ranges::find_if(words, [](const std::string& word) { return is_scene(word) || is_command(word); });
  return first == words.end() || is_scene(*first);
}

// `splatcut`, `splatcut SCENE` and `splatcut OPTIONS SCENE` mean `splatcut view`.
std::vector<std::string> with_command(std::vector<std::string> words) {
  if (words.empty() || is_scene(words.front()) || only_options_before_scene(words) ||
      (!is_command(words.front()) && is_there(words.front())))
    words.insert(words.begin(), "view");
  return words;
}

void add_commands(CLI::App& program, const CommonOptions& common) {
  for (const Command& command : kCommands) command.add(program, common);
}

}  // namespace

int main(int argc, char** argv) {
  const CommandLine line{"splatcut", "Click an object in a 3D Gaussian Splatting scene, hold a clean cutout",
                         "splatcut cut scene.ply --click 512,384 -o cutout", add_commands};
  return run_command_line(line, with_command({argv + 1, argv + argc}));
}
