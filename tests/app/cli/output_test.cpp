// What is written appears whole or not at all, whoever else writes there, and nothing else is lost.
#include <doctest/doctest.h>
#include <fcntl.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <sys/un.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <thread>

#include "app/console/output_folder.h"
#include "core/byte_hash.h"
#include "core/error.h"
#include "program_runner.h"
#include "small_still_life.h"

using namespace splatcut;
using namespace splatcut::testing;

namespace {

namespace fs = std::filesystem;

std::string what_is_said(const std::function<void()>& work) {
  try {
    work();
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

bool says(const std::function<void()>& work, const std::string& part) {
  const std::string said = what_is_said(work);
  CAPTURE(said);
  CHECK(said.find(part) != std::string::npos);
  return said.find(part) != std::string::npos;
}

void write_folder(const fs::path& path, const std::vector<std::pair<std::string, std::string>>& files) {
  OutputFolder folder(path, true);
  for (const auto& [name, text] : files) write_text_file(folder.file(name), text);
  folder.commit();
}

// Work that is killed before it ends: no destructor runs.
void killed_after(const std::function<void()>& work) {
  const pid_t child = ::fork();
  if (child == 0) {
    work();
    ::_exit(0);
  }
  REQUIRE(::waitpid(child, nullptr, 0) == child);
}

}  // namespace

TEST_CASE("output: a device stays one and is written to, and that it is full is said") {
  const Workplace place;
  constexpr mode_t kMode = 0600;
  const bool made = ::mknod((place / "full").c_str(), S_IFCHR | kMode, ::makedev(1, 7)) == 0 &&
                    ::mknod((place / "null").c_str(), S_IFCHR | kMode, ::makedev(1, 3)) == 0;
  if (!made) {
    MESSAGE("only root can make devices");
    return;
  }
  CHECK(says([&] { write_text_file(place / "full", "text"); }, "full"));
  write_text_file(place / "null", "text");
  const Result drawn = place.run("render " + still_life().scene + " --size 64x48 --overwrite -o full");
  CHECK(drawn.code == 1);
  CHECK_MESSAGE(drawn.err.find("full") != std::string::npos, drawn.err);
  CHECK(place.run("render " + still_life().scene + " --size 64x48 -o null").code == 0);
  for (const char* device : {"full", "null"}) CHECK(fs::is_character_file(place / device));
  CHECK(place.leftovers().empty());
}

TEST_CASE("output: a pipe gets the bytes, and one that nobody reads is refused") {
  const Workplace place;
  REQUIRE(::mkfifo((place / "pipe").c_str(), 0600) == 0);
  CHECK(says([&] { write_text_file(place / "pipe", "text"); }, "no program reads"));
  const int reader = ::open((place / "pipe").c_str(), O_RDONLY | O_NONBLOCK);
  REQUIRE(reader >= 0);
  write_text_file(place / "pipe", "text");
  char text[8] = {};
  CHECK(::read(reader, text, sizeof text) == 4);
  CHECK(std::string(text) == "text");
  ::close(reader);
  CHECK(fs::is_fifo(place / "pipe"));
  CHECK(place.leftovers().empty());
}

TEST_CASE("output: folders and sockets are refused before any work is done") {
  const Workplace place;
  place.make_folder("folder");
  place.write("folder/mine.txt", "mine");
  sockaddr_un address{.sun_family = AF_UNIX, .sun_path = "socket"};
  const int socket = ::socket(AF_UNIX, SOCK_STREAM, 0);
  const fs::path before = fs::current_path();
  fs::current_path(place / "");
  REQUIRE(::bind(socket, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0);
  fs::current_path(before);
  ::close(socket);
  for (const auto& [output, part] : {std::pair{"folder", "is a folder"}, {"socket", "is a socket"}}) {
    CHECK(says([&] { check_output_file(place / output, true); }, part));
    CHECK(says([&] { write_text_file(place / output, "text"); }, part));
    const Result result = place.run(std::string("render missing.ply --overwrite -o ") + output);
    CHECK_MESSAGE(result.err.find(part) != std::string::npos, result.err);
  }
  CHECK(place.text("folder/mine.txt") == "mine");
  CHECK(place.leftovers().empty());
}

TEST_CASE("output: links are followed and stay links, also one that leads nowhere yet") {
  const Workplace place;
  place.make_folder("far");
  place.write("far/old.txt", "old");
  fs::create_symlink("far/old.txt", place / "to_old");
  fs::create_symlink("to_old", place / "to_link");
  fs::create_symlink("far/new.txt", place / "to_new");
  write_text_file(place / "to_link", "text");
  write_text_file(place / "to_new", "text");
  CHECK(place.text("far/old.txt") == "text");
  CHECK(place.text("far/new.txt") == "text");
  for (const char* link : {"to_old", "to_link", "to_new"}) CHECK(fs::is_symlink(place / link));
  fs::create_directory_symlink("far", place / "to_far");
  write_folder(place / "to_far", {{"old.txt", "again"}});
  CHECK(fs::is_symlink(place / "to_far"));
  CHECK(place.text("far/old.txt") == "again");
  CHECK(place.text("far/new.txt") == "text");
  CHECK(place.leftovers().empty());
}

TEST_CASE("output: a file that is replaced keeps its permissions, and no one else reads it before") {
  const Workplace place;
  const auto mode = [&](const char* name) {
    return static_cast<unsigned>(fs::status(place / name).permissions());
  };
  constexpr unsigned kPrivate = 0600, kShared = 0664;
  for (const unsigned kept : {kPrivate, kShared}) {
    place.write("a.txt", "old");
    fs::permissions(place / "a.txt", fs::perms{kept});
    AtomicFile file(place / "a.txt");
    CHECK(mode("a.txt.splatcut.part") == kPrivate);
    file.commit();
    CHECK(mode("a.txt") == kept);
  }
}

TEST_CASE("output: a name that is too long for what is written first is refused with how long it may be") {
  const Workplace place;
  const std::string longest(241, 'a');
  write_text_file(place / longest, "text");
  CHECK(says([&] { write_text_file(place / (longest + "a"), "text"); },
             "name is too long. Choose one of at most 241 letters"));
}

TEST_CASE("output: a file is held by one process, and what a killed one left is written over") {
  const Workplace place;
  {
    AtomicFile first(place / "a.txt");
    CHECK(says([&] { write_text_file(place / "a.txt", "second"); }, "is being written by another program"));
    first.commit();
  }
  write_text_file(place / "a.txt", "third");
  CHECK(place.text("a.txt") == "third");
  killed_after([&] {
    AtomicFile file(place / "a.txt");
    const std::string text(10000, 'x');
    file.write(std::as_bytes(std::span(text)));
    std::fflush(file.stream());
    ::_exit(0);
  });
  CHECK(place.text("a.txt") == "third");
  CHECK(place.leftovers().size() == 1);
  write_text_file(place / "a.txt", "fourth");
  CHECK(place.text("a.txt") == "fourth");
  CHECK(place.leftovers().empty());
}

TEST_CASE("output: what another gives up within a moment, as a killed program does, is waited for") {
  const Workplace place;
  std::optional<AtomicFile> held(std::in_place, place / "a.txt");
  const std::jthread ends([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    held.reset();
  });
  write_text_file(place / "a.txt", "mine");
  CHECK(place.text("a.txt") == "mine");
}

TEST_CASE("output: twenty writers of one file leave one whole file") {
  const Workplace place;
  std::vector<std::jthread> writers;
  std::atomic<int> written = 0;
  for (int w = 0; w < 20; ++w)
    writers.emplace_back([&, w] {
      for (int i = 0; i < 50; ++i)
        written += what_is_said([&] {
                     write_text_file(place / "a.txt", std::string(5000, static_cast<char>('a' + w)));
                   }).empty();
    });
  writers.clear();
  const std::string text = place.text("a.txt");
  CHECK(text == std::string(5000, text[0]));
  CHECK(written > 0);
  CHECK(place.leftovers().empty());
}

TEST_CASE("output: a folder is replaced as a whole, what is not the program's stays") {
  const Workplace place;
  write_folder(place / "out", {{"object.ply", "old"}, {"report.json", "old"}});
  place.write("out/notes.txt", "mine");
  place.make_folder("out/photos/deep");
  place.write("out/photos/deep/a.jpg", "mine");
  fs::create_symlink("/nowhere", place / "out/link");
  fs::permissions(place / "out", fs::perms::owner_all | fs::perms::group_read);
  struct stat before {
  }, after{};
  REQUIRE(::stat((place / "out/photos").c_str(), &before) == 0);
  write_folder(place / "out/", {{"object.ply", "new"}, {"report.json", "new"}});
  CHECK(place.files_in("out") ==
        std::set<std::string>{"link", "notes.txt", "object.ply", "photos", "report.json"});
  CHECK(place.text("out/object.ply") == "new");
  CHECK(place.text("out/report.json") == "new");
  CHECK(place.text("out/notes.txt") == "mine");
  CHECK(place.text("out/photos/deep/a.jpg") == "mine");
  CHECK(fs::is_symlink(place / "out/link"));
  CHECK(fs::status(place / "out").permissions() == (fs::perms::owner_all | fs::perms::group_read));
  REQUIRE(::stat((place / "out/photos").c_str(), &after) == 0);
  CHECK(before.st_ino == after.st_ino);
  CHECK(place.leftovers().empty());
}

TEST_CASE("output: a subfolder is filled in its place, what is not the program's stays in it") {
  const Workplace place;
  const auto write_sub = [&] {
    OutputFolder folder(place / "out", true);
    fs::create_directories(folder.file("sub/deep"));
    write_text_file(folder.file("sub/a.txt"), "new");
    write_text_file(folder.file("sub/deep/b.txt"), "new");
    folder.commit();
  };
  place.make_folder("out/sub/mine");
  for (const char* old : {"sub/a.txt", "sub/c.txt", "sub/mine/d.txt", "e.txt"})
    place.write(std::string("out/") + old, "old");
  write_sub();
  for (const char* ours : {"sub/a.txt", "sub/deep/b.txt"})
    CHECK(place.text(std::string("out/") + ours) == "new");
  for (const char* theirs : {"sub/c.txt", "sub/mine/d.txt", "e.txt"})
    CHECK(place.text(std::string("out/") + theirs) == "old");
  CHECK(place.leftovers().empty());
  fs::remove_all(place / "out/sub/deep");
  place.write("out/sub/deep", "a file");
  CHECK(says(write_sub, "sub/deep: is no folder"));
  fs::remove(place / "out/sub/a.txt");
  fs::remove(place / "out/sub/deep");
  place.make_folder("out/sub/a.txt");
  CHECK(says(write_sub, "sub/a.txt: is a folder"));
  CHECK(place.files_in("out/sub") == std::set<std::string>{"a.txt", "c.txt", "mine"});
  CHECK(place.leftovers().empty());
}

TEST_CASE("output: a run that fails leaves no folders above its own, and an empty name is none") {
  const Workplace place;
  place.make_folder("mine");
  { const OutputFolder folder(place / "mine/a/b/out", false); }
  CHECK(place.files_in("mine").empty());
  write_folder(place / "mine/a/b/out", {{"a.txt", "text"}});
  CHECK(place.exists("mine/a/b/out/a.txt"));
  CHECK(says([] { const OutputFolder folder("", true); }, "Name the folder to write"));
}

TEST_CASE("output: a name that is a folder there is refused, and both stay as they were") {
  const Workplace place;
  place.make_folder("out/object.ply");
  place.write("out/object.ply/mine.txt", "mine");
  place.write("out/report.json", "old");
  CHECK(says(
      [&] {
        write_folder(place / "out", {{"report.json", "new"}, {"object.ply", "new"}});
      },
      "is a folder"));
  CHECK(place.text("out/object.ply/mine.txt") == "mine");
  CHECK(place.text("out/report.json") == "old");
  CHECK(place.leftovers().empty());
}

TEST_CASE("output: the current folder is filled in place") {
  const Workplace place;
  place.make_folder("out");
  place.write("out/notes.txt", "mine");
  const fs::path before = fs::current_path();
  fs::current_path(place / "out");
  write_folder(".", {{"object.ply", "new"}});
  const bool there = fs::exists("object.ply");
  fs::current_path(before);
  CHECK(there);
  CHECK(place.files_in("out") == std::set<std::string>{"notes.txt", "object.ply"});
  CHECK(place.leftovers().empty());
}

TEST_CASE(
    "output: a second writer of a folder is refused, and existing is looked for again once it is free") {
  const Workplace place;
  {
    OutputFolder first(place / "out", false);
    CHECK(says([&] { OutputFolder(place / "out", true); }, "is being written by another program"));
    write_text_file(first.file("a.txt"), "first");
    first.commit();
  }
  CHECK(says([&] { OutputFolder(place / "out", false); }, "exists already"));
  CHECK(place.text("out/a.txt") == "first");
  CHECK(place.leftovers().empty());
}

TEST_CASE(
    "output: what a killed process left beside a folder is set right by the next, whenever it was killed") {
  const Workplace place;
  const auto fresh = [&] {
    fs::remove_all(place / "out");
    write_folder(place / "out", {{"a.txt", "old"}, {"b.txt", "old"}});
    place.write("out/notes.txt", "mine");
    place.make_folder("out/photos");
    place.write("out/photos/a.jpg", "mine");
  };
  const auto is_right = [&](const std::string& text) {
    CHECK(place.files_in("out") == std::set<std::string>{"a.txt", "b.txt", "notes.txt", "photos"});
    CHECK(place.text("out/a.txt") == text);
    CHECK(place.text("out/b.txt") == text);
    CHECK(place.text("out/notes.txt") == "mine");
    CHECK(place.text("out/photos/a.jpg") == "mine");
  };
  SUBCASE("while it wrote") {
    fresh();
    killed_after([&] {
      OutputFolder folder(place / "out", true);
      write_text_file(folder.file("a.txt"), "unfinished");
      ::_exit(0);
    });
    is_right("old");
  }
  SUBCASE("after the exchange, before the folders were brought back") {
    fresh();
    // As it is then: the replaced folder has the name of the new one, and links to its files are in the new.
    fs::rename(place / "out", place / "out.splatcut.new");
    place.make_folder("out");
    for (const char* name : {"a.txt", "b.txt"}) place.write(std::string("out/") + name, "new");
    fs::create_hard_link(place / "out.splatcut.new/notes.txt", place / "out/notes.txt");
    place.write("out.splatcut.part", std::string(8, '\1'));
  }
  CHECK_FALSE(place.leftovers().empty());
  write_folder(place / "out", {{"a.txt", "next"}, {"b.txt", "next"}});
  is_right("next");
  CHECK(place.leftovers().empty());
}

TEST_CASE("output: an empty folder that a killed process left is no replaced one") {
  const Workplace place;
  place.make_folder("out.splatcut.new");
  place.write("out.splatcut.part", "");
  {
    OutputFolder folder(place / "out", false);
    CHECK_FALSE(place.exists("out"));
    write_text_file(folder.file("a.txt"), "text");
    folder.commit();
  }
  CHECK(place.text("out/a.txt") == "text");
  CHECK(place.leftovers().empty());
}

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
