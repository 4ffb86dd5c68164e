// A folder that is written is replaced as a whole, and what is not the program's stays in it.
#include <doctest/doctest.h>
#include <sys/stat.h>
#include <unistd.h>

#include "app/console/output_folder.h"
#include "output_helpers.h"
#include "program_runner.h"

using namespace splatcut;
using namespace splatcut::testing;

namespace {

namespace fs = std::filesystem;

void write_folder(const fs::path& path, const std::vector<std::pair<std::string, std::string>>& files) {
  OutputFolder folder(path, true);
  for (const auto& [name, text] : files) write_text_file(folder.file(name), text);
  folder.commit();
}

}  // namespace

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

TEST_CASE("output: a file of a folder that is replaced keeps its permissions and owner") {
  const Workplace place;
  constexpr unsigned kSomebody = 1234;
  constexpr fs::perms kOwn = fs::perms::owner_read | fs::perms::owner_write;
  place.make_folder("out/sub");
  fs::permissions(place / "out/sub", fs::perms::owner_all);
  for (const char* name : {"a.txt", "sub/b.txt"}) {
    place.write(std::string("out/") + name, "old");
    fs::permissions(place / "out" / name, kOwn);
    if (::geteuid() == 0) REQUIRE(::chown((place / "out" / name).c_str(), kSomebody, kSomebody) == 0);
  }
  OutputFolder folder(place / "out", true);
  fs::create_directories(folder.file("sub"));
  for (const char* name : {"a.txt", "sub/b.txt", "c.txt"}) write_text_file(folder.file(name), "new");
  folder.commit();
  for (const char* name : {"a.txt", "sub/b.txt"}) {
    CHECK(place.text(std::string("out/") + name) == "new");
    CHECK(fs::status(place / "out" / name).permissions() == kOwn);
    struct stat status {};
    REQUIRE(::stat((place / "out" / name).c_str(), &status) == 0);
    if (::geteuid() == 0) CHECK(status.st_uid == kSomebody);
  }
  CHECK(fs::status(place / "out/sub").permissions() == fs::perms::owner_all);
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
