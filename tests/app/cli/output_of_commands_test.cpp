// Commands leave the old output as it was where they are ended, and write over nothing that they read.
#include <doctest/doctest.h>

#include <cstdio>
#include <nlohmann/json.hpp>
#include <set>

#include "core/byte_hash.h"
#include "core/error.h"
#include "output_helpers.h"
#include "program_runner.h"
#include "small_still_life.h"

using namespace splatcut;
using namespace splatcut::testing;

namespace fs = std::filesystem;

namespace {

// Work of as many objects as there can be, each the whole scene by hand: little to compute, much to write.
void write_large_work(const Workplace& place, const std::string& file, const std::string& scene,
                      int count = 255) {
  nlohmann::json objects = nlohmann::json::array();
  for (int id = 1; id <= count; ++id)
    objects.push_back({{"id", id},
                       {"name", "all"},
                       {"colour", {1, 2, 3}},
                       {"views", nlohmann::json::array()},
                       {"hand", {1, 20000}}});
  char hash[17];
  std::snprintf(hash, sizeof hash, "%016llx",
                static_cast<unsigned long long>(hash_of_file(still_life().place / "made/small.ply")));
  place.write(file, nlohmann::json{{"splatcut_work", 7},
                                   {"scene", {{"path", scene}, {"hash", hash}}},
                                   {"next_id", 256},
                                   {"up", {0, -1, 0}},
                                   {"preset", "default"},
                                   {"background", {0, 0, 0}},
                                   {"objects", objects}}
                        .dump());
}

}  // namespace

TEST_CASE("output: saved work computed again and stopped while it is written leaves the old folder") {
  const Workplace place;
  write_large_work(place, "large.splatcut.json", still_life().scene);
  place.make_folder("out");
  place.write("out/all.ply", "old");
  for (const int signal : {SIGINT, SIGTERM}) {
    CAPTURE(signal);
    const pid_t run = place.begin("cut --work large.splatcut.json --overwrite -o out");
    REQUIRE(place.appears("out.splatcut.new/all.ply"));
    ::kill(run, signal);
    const Result result = place.finish(run);
    CHECK_MESSAGE(result.code == 1, result.err);
    CHECK(result.err.find("cancelled, nothing was written") != std::string::npos);
    CHECK(place.files_in("out") == std::set<std::string>{"all.ply"});
    CHECK(place.text("out/all.ply") == "old");
    CHECK(place.leftovers().empty());
  }
}

TEST_CASE("output: of saved work what --write names is written, and the report names no more") {
  const Workplace place;
  write_large_work(place, "one.splatcut.json", still_life().scene, 1);
  REQUIRE(place.run("cut --work one.splatcut.json --edges keep --write labels -o out").code == 0);
  CHECK(place.files_in("out") == std::set<std::string>{"all.labels.u8", "report.json"});
  const nlohmann::json object = nlohmann::json::parse(place.text("out/report.json"))["objects"][0];
  CHECK(object["labels"] == "all.labels.u8");
  CHECK_FALSE(object.contains("file"));
}

TEST_CASE("output: signals that end the program leave the old cutout as it was") {
  StillLife& life = still_life();
  const Workplace& place = life.place;
  place.make_folder("kept");
  for (const char* name : {"object.ply", "report.json", "notes.txt"})
    place.write(std::string("kept/") + name, "old");
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    CAPTURE(signal);
    const pid_t child = place.begin("cut " + life.scene + " " + life.camera +
                                    " --no-cache --overwrite -o kept --click " + life.click);
    CHECK(place.appears("kept.splatcut.part"));  // it works, and has not begun to write
    ::kill(child, signal);
    const Result result = place.finish(child);
    CHECK(result.code == 1);
    CHECK(place.files_in("kept") == std::set<std::string>{"notes.txt", "object.ply", "report.json"});
    CHECK(place.text("kept/object.ply") == "old");
    CHECK(place.leftovers().empty());
  }
}

TEST_CASE("output: no command writes over what it reads, by whatever name, and no picture over a scene's") {
  StillLife& life = still_life();
  const Workplace place;
  const std::string bytes = life.place.text("made/small.ply");
  place.make_folder("work");
  place.write("work/object.ply", bytes);
  fs::copy(life.place / "made/cameras.json", place / "work/cameras.json");
  fs::create_symlink("work/object.ply", place / "link.ply");
  fs::create_hard_link(place / "work/object.ply", place / "hard.ply");
  place.make_folder("elsewhere");
  fs::create_hard_link(place / "work/object.ply", place / "elsewhere/rest.ply");
  fs::create_directory_symlink("work", place / "linked");
  place.write("a.png", "a");
  place.write("labels.u8", std::string(20000, '\1'));
  const std::string cut =
      "cut work/object.ply --cameras work/cameras.json --camera 0 --click " + life.click + " --overwrite -o ";
  const std::string shot = "render work/object.ply --overwrite --size 8x8 -o ";
  const std::vector<std::pair<std::string, std::string>> refused = {
      {cut + "work", "work: holds work/object.ply, which is read here"},
      {cut + "linked", "linked: holds work/object.ply"},
      {cut + "elsewhere", "elsewhere: holds work/object.ply"},
      {cut + ".", "holds work/object.ply"},
      {"convert work/object.ply --overwrite -o link.ply", "link.ply: is what is read here"},
      {"convert work/object.ply --overwrite -o hard.ply", "hard.ply: is what is read here"},
      {"merge link.ply a.ply --overwrite -o work/object.ply", "is what is read here (link.ply)"},
      {shot + "work/object.ply", "is the name of a scene (.ply)"},
      {shot + "new.jpg", "is the name of another kind of picture (.jpg), and a PNG is written"},
      {shot + "NEW.WebP", "(.webp)"},
      {"compare a.png a.png --diff new.jpeg", "(.jpeg)"},
      {shot + "new.splat", "is the name of a scene (.splat)"},
      {shot + "labels.u8 --what labels --labels labels.u8", "is what is read here (labels.u8)"},
      {shot + "work/cameras.json --cameras work/cameras.json", "is what is read here"},
      {shot + "work/cameras.json --cameras work", "work/cameras.json: lies in work, which is read here"},
      {"compare a.png a.png --overwrite --diff a.png", "is what is read here"},
      {"compare a.png a.png --overwrite --diff hard.ply", "is the name of a scene"},
      {"eval made/suite.json --overwrite -o made", "made: holds made/suite.json"},
      {"study made/suite.json -o made", "made: holds made/suite.json"}};
  place.make_folder("made");
  place.write("made/suite.json", "{}");
  for (const auto& [words, said] : refused) {
    CAPTURE(words);
    const Result result = place.run(words);
    CHECK(result.code == 1);
    CHECK_MESSAGE(result.err.find(said) != std::string::npos, result.err);
  }
  CHECK(place.text("work/object.ply") == bytes);
  CHECK(place.files_in("work") == std::set<std::string>{"cameras.json", "object.ply"});
  CHECK(place.files_in("elsewhere") == std::set<std::string>{"rest.ply"});
  CHECK(place.files_in("made") == std::set<std::string>{"suite.json"});
  CHECK(place.text("a.png") == "a");
  CHECK_FALSE(place.exists("new.splat"));
  CHECK(place.leftovers().empty());
}

TEST_CASE("output: saved work is not computed again into a folder that holds it or its scene") {
  const Workplace place;
  place.make_folder("made");
  place.write("made/all.ply", still_life().place.text("made/small.ply"));
  place.make_folder("out");
  write_large_work(place, "out/kept.splatcut.json", (place / "made/all.ply").string());
  for (const char* output : {"out", "made"}) {
    const Result result =
        place.run(std::string("cut --work out/kept.splatcut.json --overwrite -o ") + output);
    CHECK(result.code == 1);
    CHECK_MESSAGE(result.err.find("which is read here") != std::string::npos, result.err);
  }
  CHECK(place.files_in("out") == std::set<std::string>{"kept.splatcut.json"});
  CHECK(place.files_in("made") == std::set<std::string>{"all.ply"});
}
