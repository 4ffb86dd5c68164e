// Scenes that no training makes: each command ends with a result or with one sentence, the same on one thread
// and two. SPLATCUT_HOSTILE=1000000 makes them of so many Gaussians and prints the table of
// docs/reliability.md.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <cstdlib>

#include "hostile_scenes.h"
#include "program_runner.h"

using namespace splatcut::testing;

namespace {

namespace fs = std::filesystem;

struct Command {
  const char *name, *words, *output;
};

constexpr const char* kCamera = " --camera-pos 0,0,-6 --camera-target 0,0,0 --camera-fov 50 --size 640x480 ";

const std::vector<Command>& commands() {
  static const std::string render = std::string("render a.ply -o out.png --quiet") + kCamera;
  static const std::string cut = std::string("cut a.ply -o out --no-cache --quiet --click 320,240") + kCamera;
  static const std::vector<Command> all = {
      {"info", "info a.ply --quiet", ""},
      {"render, view guessed", "render a.ply -o out.png --quiet", "out.png"},
      {"render", render.c_str(), "out.png"},
      {"convert to .spz", "convert a.ply -o out.spz --quiet", "out.spz"},
      {"convert to .sog", "convert a.ply -o out.sog --quiet", "out.sog"},
      {"merge", "merge a.ply a.ply -o out.glb --quiet", "out.glb"},
      {"cut", cut.c_str(), "out"},
  };
  return all;
}

// What a run left, in a word that can be compared.
std::string outcome(const Workplace& place, const Command& command, const Result& result) {
  if (result.code != 0) return result.err;
  const std::string output = command.output;
  if (output.empty()) return result.out;
  return output == "out" ? place.text("out/labels.u8") + place.text("out/object.png") : place.text(output);
}

void run_both(const Workplace& place, const std::string& scene, const Command& command, bool print) {
  CAPTURE(scene);
  CAPTURE(std::string(command.name));
  std::string said, first;
  for (const char* threads : {"2", "1"}) {
    if (*command.output) fs::remove_all(place / command.output);
    const auto start = std::chrono::steady_clock::now();
    const Result result = place.run(std::string(command.words) + " --threads " + threads);
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    CAPTURE(result.err);
    CHECK(result.signal == 0);
    CHECK((result.code == 0 || result.code == 1));
    CHECK(std::count(result.err.begin(), result.err.end(), '\n') == result.code);
    CHECK(result.err.find("defect") == std::string::npos);
    CHECK(place.leftovers().empty());
    const std::string is = outcome(place, command, result);
    if (first.empty()) first = is;
    CHECK(is == first);
    if (said.empty() && print)
      said = fmt::format("| {} | {} | {} | {:.1f} | {:.0f} |\n", scene, command.name,
                         result.code == 0 ? "result" : result.err.substr(0, result.err.size() - 1), seconds,
                         result.peak_mb);
  }
  fmt::print("{}", said);
  std::fflush(stdout);
}

}  // namespace

TEST_CASE("hostile: a result or a sentence, the same on one thread and two") {
  const char* asked = std::getenv("SPLATCUT_HOSTILE");
  const char* only = std::getenv("SPLATCUT_HOSTILE_SCENE");
  const std::size_t gaussians = asked ? std::stoul(asked) : 2000;
  if (asked)
    fmt::print("| scene | command | ends with | s, two threads | peak MB |\n|---|---|---|---|---|\n");
  for (const HostileScene& scene : hostile_scenes()) {
    if (only && std::string(only) != scene.name) continue;
    const Workplace place;
    write_hostile(place / "a.ply", scene, gaussians);
    for (const Command& command : commands()) run_both(place, scene.name, command, asked != nullptr);
  }
}
