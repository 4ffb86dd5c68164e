// What may be wrong around the program: files of others, names, a standard output that is full.
#include <doctest/doctest.h>
#include <fcntl.h>
#include <sys/stat.h>

#include <nlohmann/json.hpp>

#include "app/console/console.h"
#include "core/mapped_file.h"
#include "program_runner.h"
#include "small_still_life.h"

using namespace splatcut::testing;
using nlohmann::json;

namespace {

// One sentence, of this program and of no library.
void refused(const Result& result, std::initializer_list<const char*> parts) {
  CAPTURE(result.err);
  CHECK(result.code == 1);
  CHECK(std::count(result.err.begin(), result.err.end(), '\n') == 1);
  CHECK(result.err.ends_with(".\n"));
  for (const char* library : {"json.exception", "std::", "terminate", "basic_string", "filesystem error"})
    CHECK(result.err.find(library) == std::string::npos);
  for (const char* part : parts) CHECK_MESSAGE(result.err.find(part) != std::string::npos, part);
}

}  // namespace

TEST_CASE("faults: a name that is not UTF-8 is printed and written all the same") {
  const StillLife& life = still_life();
  const Workplace& place = life.place;
  const std::string name = "caf\xe9.ply";
  place.write(name, place.text("made/small.ply"));
  const Result info = place.run("info " + name + " --json");
  REQUIRE_MESSAGE(info.code == 0, info.err);
  CHECK(json::parse(info.out)["file"] == "caf\xef\xbf\xbd.ply");
  CHECK(json::parse(info.out)["gaussians"] == 20000);
  CHECK(place.run("info " + name).code == 0);
  const Result cut =
      place.run("cut " + name + " " + life.camera + " --click " + life.click + " --json -o out_\xe9");
  REQUIRE_MESSAGE(cut.code == 0, cut.err);
  CHECK(json::parse(cut.out)["object"]["gaussians"].get<int>() > 0);
  refused(place.run("info none_\xe9.ply --json"), {"No such file"});
}

TEST_CASE("faults: a suite that lacks its cameras, its names or its form is refused with a sentence") {
  const Workplace& place = still_life().place;
  const json reference = {{"camera", "view_00"}};
  const json entry = {{"name", "a"},
                      {"scene", "small.ply"},
                      {"reference", reference},
                      {"truth", {{"labels", "small.labels.u8"}}},
                      {"clicks", "robot"},
                      {"test_views", json::array()}};
  const auto suite = [&](const json& scenes) {
    place.write("made/odd.json", json{{"scenes", scenes}}.dump());
    return place.run("eval made/odd.json -o odd");
  };
  refused(suite(json::array({entry})), {"a", "view_00", "no cameras"});
  json nameless = entry;
  nameless.erase("name");
  refused(suite(json::array({nameless})), {"entry 0", "name"});
  for (const json& odd : {json(1), json("a"), json::array(), json(nullptr)})
    refused(suite(json::array({odd})), {"entry 0"});
  for (const auto& [key, value] : std::vector<std::pair<std::string, json>>{{"scene", 1},
                                                                            {"reference", 3},
                                                                            {"reference", {{"camera", 1.5}}},
                                                                            {"truth", "x"},
                                                                            {"clicks", {1}},
                                                                            {"test_views", 7},
                                                                            {"references", 5},
                                                                            {"cameras", json::array()},
                                                                            {"scribbles", 4}}) {
    json odd = entry;
    odd["cameras"] = "cameras.json";
    odd[key] = value;
    CAPTURE(key);
    refused(suite(json::array({odd})), {"a"});
  }
  const json view = {{"position", {0, 0, -3}}, {"target", {0, 0, 0}}, {"up", {0, -1, 0}}, {"fov_y_deg", 45}};
  for (const json& size : {json{0, 1}, json{40, -1}, json{1e9, 1e9}, json{1}, json("x")}) {
    json odd = entry;
    odd["reference"] = view;
    odd["reference"]["size"] = size;
    CAPTURE(size.dump());
    refused(suite(json::array({odd})), {});
  }
  for (const std::string& bytes : {std::string("\0\xff\x7f"
                                               "ELF\1\2",
                                               8),
                                   std::string("[1e999]"), std::string("\"\xff\""), std::string()}) {
    place.write("made/odd.json", bytes);
    refused(place.run("eval made/odd.json -o odd"), {"odd.json"});
  }
}

TEST_CASE("faults: seeds, cameras and labels of any form are refused with a sentence") {
  const StillLife& life = still_life();
  const Workplace& place = life.place;
  for (const char* text : {"",
                           "{",
                           "[1e999]",
                           "[]",
                           "7",
                           "\"\xff\"",
                           R"({"clicks": 5})",
                           R"({"clicks": [5]})",
                           R"({"clicks": [{"x": "a"}]})",
                           R"({"scribbles": [{"label": 5, "points": []}]})",
                           R"({"scribbles": {"label": "object"}})",
                           R"({"scribbles": [{"label": "object", "points": [[1]]}]})",
                           R"({"objects": [{"name": 1}]})",
                           R"({"scribbles": [{"label": "object", "radius_px": 1e30, "points": [[1, 2]]}]})",
                           R"({"scribbles": [{"label": "object", "radius_px": -1, "points": [[1, 2]]}]})",
                           R"({"boxes": 5})",
                           R"({"boxes": [{"corners": [[1, 2]]}]})",
                           R"({"boxes": [{"corners": [[1, 2], [3]]}]})",
                           R"({"boxes": [{"corners": [[1, 2], [1e30, 4]]}]})",
                           R"({"clicks": [{"x": 1e30, "y": 1}]})"}) {
    CAPTURE(text);
    place.write("odd.json", text);
    refused(place.run(life.cut("--seeds odd.json -o odd")), {"odd.json"});
    refused(place.run("render " + life.scene + " --cameras odd.json -o odd.png"), {"odd.json"});
  }
  refused(place.run("render " + life.scene + " --what labels --labels made -o odd.png"),
          {"made", "directory"});
  refused(place.run(life.cut("--seeds made -o odd")), {"made", "directory"});
  refused(place.run("cut --work odd.json -o odd"), {"odd.json"});
}

TEST_CASE("faults: a pipe in place of what is kept of a scene is passed by") {
  const StillLife& life = still_life();
  const Workplace place;
  const std::string cut = life.cut("--click " + life.click);
  REQUIRE(place.run(cut + " -o first").code == 0);
  const std::string kept = "cache/splatcut/" + *place.files_in("cache/splatcut").begin();
  std::filesystem::remove(place / kept);
  REQUIRE(::mkfifo((place / kept).c_str(), 0600) == 0);
  REQUIRE(place.run(cut + " -o second").code == 0);
  CHECK(place.text("second/labels.u8") == place.text("first/labels.u8"));
}

TEST_CASE("faults: a file that another program cuts short while it is read ends the run with a sentence") {
  const Workplace place;
  place.write("a.ply", std::string(1 << 20, 'x'));
  int ends[2];
  REQUIRE(::pipe(ends) == 0);
  const pid_t child = ::fork();
  if (child == 0) {
    ::dup2(ends[1], STDERR_FILENO);
    splatcut::console_job(true);
    const splatcut::MappedFile file(place / "a.ply");
    std::filesystem::resize_file(place / "a.ply", 0);
    ::_exit(file.bytes()[1 << 19] == std::byte{'x'} ? 0 : 2);
  }
  int status = 0;
  REQUIRE(::waitpid(child, &status, 0) == child);
  CHECK((WIFEXITED(status) && WEXITSTATUS(status) == 1));
  ::close(ends[1]);
  char said[200] = {};
  CHECK(::read(ends[0], said, sizeof said - 1) > 0);
  CHECK(std::string(said).find("became shorter") != std::string::npos);
  ::close(ends[0]);
}

TEST_CASE("faults: that the standard output is full is said") {
  const StillLife& life = still_life();
  const Workplace& place = life.place;
  place.write("full.sh", splatcut_program() + " info " + life.scene + " > /dev/full\n");
  refused(place.run_program("/bin/sh", "full.sh"), {"standard output", "No space"});
}
