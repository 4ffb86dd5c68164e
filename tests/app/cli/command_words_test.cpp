// Words of the command line: which of them are commands, which are scenes to view.
#include <doctest/doctest.h>

#include <string>

#include "program_runner.h"

using namespace splatcut::testing;

TEST_CASE("options may stand before any command, and a scene after it does not make it another") {
  const Workplace place;
  place.write("scene.ply", "");
  const std::string help = place.run("--help").out;
  for (const std::string command : {"info", "render", "cut", "convert", "compare", "view"}) {
    CAPTURE(command);
    CHECK(help.find("\n  " + command + " ") != std::string::npos);
    const std::string its_own = place.run(command + " --help").out;
    CHECK(its_own.find("Usage: splatcut " + command) != std::string::npos);
    CHECK(place.run("--quiet " + command + " --help scene.ply").out == its_own);
  }
  CHECK(place.run_program(lab_program(), "cut").code == 2);
}

TEST_CASE("a folder without a command is a scene to view, unless a command has its name") {
  const Workplace place;
  place.make_folder("garden");
  place.make_folder("info");
  CHECK(place.run("garden --check").err.find("subcommand") == std::string::npos);
  place.write("cam.json", "{}");
  for (const std::string words : {"--width 800 --height 600", "--width 800 garden", "--width 800 cam.json",
                                  "cam.json", "--renderer cpu nowhere"}) {
    CAPTURE(words);
    CHECK(place.run(words + " --check").err.find("subcommand") == std::string::npos);
  }
  CHECK(place.run("--width 800 nowhere").err.find("nowhere: there is no such file") != std::string::npos);
  CHECK(place.run("--width 800 gone.splatcut.json cam.json")
            .err.find("gone.splatcut.json: there is no such file") != std::string::npos);
  CHECK(place.run("--help").code == 0);
  CHECK(place.run("nowhere --check").err.find("nowhere is neither a command nor a file") !=
        std::string::npos);
  CHECK(place.run("info --check").code == 2);  // is no option of `info`
}
