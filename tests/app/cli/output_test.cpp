// A file that is written appears whole or not at all, whoever else writes there, and nothing else is lost.
#include <doctest/doctest.h>
#include <fcntl.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <sys/un.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cstring>
#include <optional>
#include <thread>

#include "output_helpers.h"
#include "program_runner.h"

using namespace splatcut;
using namespace splatcut::testing;

namespace fs = std::filesystem;

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
             "name is too long. Choose one of at most 241 bytes"));
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
