// Words and a program of the user's say which object is meant: what it gets, how it fails, how it ends.
#include <doctest/doctest.h>

#include <cerrno>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>

#include "cut_program.h"

using namespace splatcut::testing;
using nlohmann::json;

namespace {

// Set while it lives, then as it was.
class Variable {
 public:
  Variable(const char* name, const std::string& value) : name_(name) {
    if (const char* old = std::getenv(name)) old_ = old;
    ::setenv(name, value.c_str(), 1);
  }
  Variable(const Variable&) = delete;
  Variable& operator=(const Variable&) = delete;
  ~Variable() { old_ ? ::setenv(name_, old_->c_str(), 1) : ::unsetenv(name_); }

 private:
  const char* name_;
  std::optional<std::string> old_;
};

void script(const std::string& name, const std::string& lines) {
  const Workplace& place = still_life().place;
  place.write(name, "#!/bin/sh\n" + lines);
  std::filesystem::permissions(place / name, std::filesystem::perms::owner_all);
}

// Or dead and not yet waited for by whoever inherited it.
bool is_gone(pid_t process) {
  for (int tenths = 0; tenths < 100; ++tenths) {
    std::ifstream stat("/proc/" + std::to_string(process) + "/stat");
    std::string number, name, state = "Z";
    stat >> number >> name >> state;
    if (state == "Z") return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
  return false;
}

// Waits until the process has met the signal: it catches a first one alone, so that a second one ends it.
bool has_met(pid_t process, int signal) {
  const auto caught = [&] {
    std::ifstream status("/proc/" + std::to_string(process) + "/status");
    for (std::string line; std::getline(status, line);)
      if (line.starts_with("SigCgt:"))
        return (std::stoull(line.substr(7), nullptr, 16) >> (signal - 1) & 1) != 0;
    return false;
  };
  for (int ms = 0; ms < 10'000 && caught(); ++ms) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  return !caught();
}

struct Slow {
  pid_t cut = 0, segmenter = 0, its_child = 0;
};

// A cut whose segmenter is at work, with a child of its own.
Slow slow_cut(const std::string& ears) {
  const Workplace& place = still_life().place;
  std::filesystem::remove(place / "pids.txt");
  script("slow.sh",
         ears + "sleep 300 &\necho $$ $! > pids.part.txt\nmv pids.part.txt pids.txt\nwait\nsleep 300\n");
  Slow slow;
  slow.cut = place.begin(cut_with(std::string(kSize) + " --camera 0 -o stopped --overwrite"),
                         {"--text", "apple", "--segmenter", "./slow.sh {image} {text} {mask}"});
  REQUIRE(place.appears("pids.txt"));
  std::istringstream pids(place.text("pids.txt"));
  REQUIRE((pids >> slow.segmenter >> slow.its_child));
  return slow;
}

constexpr const char* kDeaf = "trap '' TERM INT HUP\n";

}  // namespace

TEST_CASE("--text: the program gets the picture and the words, and its mask is used as --mask") {
  const Workplace& place = still_life().place;
  place.make_folder("tmp");
  place.make_folder("my tools");
  apple_mask(0);
  script("my tools/segment.sh",
         "for a; do echo \"[$a]\"; done > arguments.txt\ncp \"$2\" seen.png\necho looking >&2\necho "
         "printed\ncp truth_0.png \"${4#--out=}\"\n");
  const Variable tmp("TMPDIR", (place / "tmp").string());
  const std::string cut = cut_with(std::string(kSize) + " --camera 0");
  const Result result = place.run(cut + " --json -o by_text",
                                  {"--text", "the {mask} \"red\" apple; $HOME", "--segmenter",
                                   R"('./my tools/segment.sh'  -i\ "a b" {image} "{text}" --out={mask} '')"});
  REQUIRE_MESSAGE(result.code == 0, result.err);
  REQUIRE(place.run(cut + " --mask truth_0.png -o by_its_mask").code == 0);
  CHECK(place.text("by_text/labels.u8") == place.text("by_its_mask/labels.u8"));
  CHECK(place.text("by_text/tint.png") == place.text("by_its_mask/tint.png"));
  CHECK(result.err.find("looking") != std::string::npos);
  CHECK(json::parse(result.out)["settings"]["text"] ==
        "the {mask} \"red\" apple; $HOME");  // stdout is the report alone
  const std::string arguments = place.text("arguments.txt");
  CHECK(arguments.starts_with("[-i a b]\n"));
  CHECK(arguments.find("\n[the {mask} \"red\" apple; $HOME]\n[--out=/") != std::string::npos);
  CHECK(arguments.ends_with("/mask.png]\n[]\n"));
  REQUIRE(place
              .run("render " + still_life().scene + " " + still_life().camera + kSize +
                   " -o view.png --overwrite")
              .code == 0);
  CHECK(place.text("seen.png") == place.text("view.png"));
  CHECK(place.files_in("tmp").empty());

  const Variable kept("SPLATCUT_SEGMENTER", "'my tools/segment.sh' -i {image} {text} --out={mask}");
  REQUIRE(place.run(cut + " -o by_kept", {"--text", "apple"}).code == 0);
  CHECK(place.text("by_kept/labels.u8") == place.text("by_text/labels.u8"));
}

TEST_CASE("--text that gets no mask is refused with what to do, and leaves no temporary files") {
  const Workplace& place = still_life().place;
  place.make_folder("tmp");
  black_mask("black.png");
  apple_mask(0, "");
  const Variable tmp("TMPDIR", (place / "tmp").string());
  const Variable none("SPLATCUT_SEGMENTER", "");
  const std::string cut = cut_with(std::string(kSize) + " --camera 0 --text apple");
  const auto with = [](const std::string& command) {
    return std::vector<std::string>{"--segmenter", command};
  };
  refused(cut, {}, {"--segmenter", "{image}", "SPLATCUT_SEGMENTER"});
  refused(cut, with("run {image} {mask}"), {"{text} is missing"});
  refused(cut, with("run {image} {text}"), {"{mask} is missing"});
  refused(cut, with("run '{image} {text} {mask}"), {"quote"});
  refused(cut, with("no-such-program {image} {text} {mask}"),
          {"no-such-program", "cannot be started", "PATH"});
  script("fails.sh", "echo out of memory >&2\nexit 3\n");
  refused(cut, with("./fails.sh {image} {text} {mask}"), {"out of memory", "exit code 3"});
  script("dies.sh", "kill -9 $$\n");
  refused(cut, with("./dies.sh {image} {text} {mask}"), {"signal 9"});
  script("idle.sh", "exit 0\n");
  refused(cut, with("./idle.sh {image} {text} {mask}"), {"wrote no mask", "{mask}"});
  script("text.sh", "echo hello > \"$3\"\n");
  refused(cut, with("./text.sh {image} {text} {mask}"), {"not a whole picture"});
  script("black.sh", "cp black.png \"$3\"\n");
  refused(cut, with("./black.sh {image} {text} {mask}"), {"black.sh", "found nothing", "other words"});
  REQUIRE(place
              .run("render " + still_life().scene + " " + still_life().camera +
                   " --size 300x300 --what alpha --overwrite -o square.png")
              .code == 0);
  script("square.sh", "cp square.png \"$3\"\n");
  refused(cut, with("./square.sh {image} {text} {mask}"), {"square.sh", "300x300", "504x378"});
  const std::string no_text = cut_with(std::string(kSize) + " --camera 0");
  refused(no_text, {"--text", "", "--segmenter", "run {image} {text} {mask}"}, {"--text", "empty"});
  refused(no_text + " --click 5,5", with("run {image} {text} {mask}"), {"--text"}, 2);
  refused(cut + " --click 5,5", with("run {image} {text} {mask}"), {"--text"}, 2);
  CHECK(place.files_in("tmp").empty());
}

TEST_CASE("--text: a mask of twice the size or of 0 and 1 serves as well") {
  const Workplace& place = still_life().place;
  apple_mask(0, "");
  script("large.sh", "cp truth_0_full.png \"$3\"\n");
  CHECK(place
            .run(cut_with(std::string(kSize) + " --camera 0 -o by_large_text"),
                 {"--text", "apple", "--segmenter", "./large.sh {image} {text} {mask}"})
            .code == 0);
  CHECK(iou(place.text("by_large_text/labels.u8"), still_life().truth_of("apple")) > 0.8);
}

TEST_CASE("a signal that ends the program ends the segmenter and what it started") {
  const Workplace& place = still_life().place;
  place.make_folder("tmp");
  const Variable tmp("TMPDIR", (place / "tmp").string());
  const std::vector<std::pair<int, std::string>> cases = {
      {SIGINT, ""}, {SIGINT, kDeaf}, {SIGTERM, ""}, {SIGHUP, ""}};
  for (const auto& [signal, ears] : cases) {
    const Slow slow = slow_cut(ears);
    CAPTURE(signal);
    CAPTURE(ears);
    ::kill(slow.cut, signal);
    const Result result = place.finish(slow.cut);
    CHECK(result.code == 1);
    CHECK(result.err.find("cancelled, nothing was written") != std::string::npos);
    CHECK((::kill(slow.segmenter, 0) == -1 && errno == ESRCH));
    CHECK(is_gone(slow.its_child));
    CHECK_FALSE(place.exists("stopped"));
    CHECK(place.files_in("tmp").empty());
    CHECK(place.leftovers().empty());
  }
}

TEST_CASE("a second Ctrl+C and SIGKILL end a deaf segmenter, too, and the next run removes what was left") {
  const Workplace& place = still_life().place;
  place.make_folder("tmp");
  const Variable tmp("TMPDIR", (place / "tmp").string());
  for (const int signal : {SIGINT, SIGKILL}) {
    CAPTURE(signal);
    const Slow slow = slow_cut(kDeaf);
    ::kill(slow.cut, signal);
    if (signal == SIGINT) {
      REQUIRE(has_met(slow.cut, signal));
      ::kill(slow.cut, signal);
    }
    CHECK(place.finish(slow.cut).signal == signal);
    CHECK(is_gone(slow.segmenter));
    CHECK(is_gone(slow.its_child));
    CHECK_FALSE(place.exists("stopped"));
    CHECK_FALSE(place.leftovers().empty());
    REQUIRE(place.files_in("tmp").size() == 1);
    std::filesystem::last_write_time(place / ("tmp/" + *place.files_in("tmp").begin()),
                                     std::filesystem::file_time_type::clock::now() - std::chrono::hours(1));
    apple_mask(0);
    script("quick.sh", "cp truth_0.png \"$3\"\n");
    const Result next = place.run(cut_with(std::string(kSize) + " --camera 0 -o stopped"),
                                  {"--text", "apple", "--segmenter", "./quick.sh {image} {text} {mask}"});
    CHECK_MESSAGE(next.code == 0, next.err);
    CHECK(place.leftovers().empty());
    CHECK(place.files_in("tmp").empty());
    std::filesystem::remove_all(place / "stopped");
  }
}

TEST_CASE("a second program is refused the folder that a first is writing") {
  const Workplace& place = still_life().place;
  const Slow slow = slow_cut("");
  const Result second =
      place.run(cut_with(std::string(kSize) + " --camera 0 --click 5,5 --overwrite -o stopped"));
  CHECK(second.code == 1);
  CHECK_MESSAGE(second.err.find("stopped: is being written by another program") != std::string::npos,
                second.err);
  ::kill(slow.cut, SIGTERM);
  CHECK(place.finish(slow.cut).code == 1);
  CHECK(place.leftovers().empty());
}
