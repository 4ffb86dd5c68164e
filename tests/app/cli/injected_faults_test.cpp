// Calls to the system that fail, one at a time (fault_shim.cpp), in each command that writes: the output is
// the old or the new as a whole, nothing of others is lost, and what could not be done is said in one
// sentence. Every call is tried where SPLATCUT_EVERY_FAULT is set (tests/fail_at_each_call.sh), else the 1st,
// 2nd, 4th, 8th...
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <cstdlib>
#include <map>
#include <nlohmann/json.hpp>
#include <regex>

#include "program_runner.h"

using namespace splatcut::testing;
using nlohmann::json;

namespace {

namespace fs = std::filesystem;

struct Deed {
  std::string name, before, now, output;  // before: what writes an older output of other content
  int steps = 4;                          // where not every call is tried: the 1st, that many times later...
};

struct Fault {
  std::string call, how;
  const char* meant;
};

constexpr const char* kFromBytes = ":65536";  // allocations of less do not count

constexpr const char* kNothingLeft = "12+:1";

const std::vector<Fault>& faults() {
  static const std::vector<Fault> all = {
      {"write", "28", "no space, once"},
      {"write", "28+", "no space from there on"},
      {"write", "short", "takes half of the bytes"},
      {"read", "5", "input/output error"},
      {"read", "short+", "gives half of the bytes, from there on"},
      {"open", "24", "too many open files"},
      {"close", "5", "input/output error"},
      {"truncate", "28", "no space"},
      {"rename", "5", "input/output error"},
      {"rename", "22+", "not possible here, from there on"},
      {"link", "1+", "not permitted, from there on"},
      {"mkdir", "28", "no space"},
      {"remove", "1", "not permitted"},
      {"lock", "37", "no locks here"},
      {"sync", "5", "input/output error"},
      {"sync", "22+", "not possible here, from there on"},
      {"map", "12", "no memory"},
      {"allocate", "12", "no memory for a large array"},
      {"allocate", "12+", "no memory for large arrays, from there on"},
      {"allocate", kNothingLeft, "no memory at all, from there on"},
  };
  return all;
}

const std::vector<Deed>& deeds() {
  static const std::string cut =
      "cut made/a.ply --cameras made/cameras.json --camera 0 -o out --overwrite --quiet ";
  static const std::string render =
      "render made/a.ply --cameras made/cameras.json -o out.png --overwrite --quiet ";
  static const std::string eval = "eval made/one.json --no-curve -o out --overwrite --quiet ";
  static const std::vector<Deed> all = {
      {"cut", cut + "--no-cache --click 490,422", cut + "--click 670,490", "out", 16},
      {"cut of two objects", cut + "--click 490,422", cut + "--no-cache --seeds made/two.json", "out", 64},
      {"convert to .ply", "convert b.splat -o out.ply --overwrite --quiet",
       "convert made/a.ply -o out.ply --overwrite --quiet", "out.ply"},
      {"convert to .spz", "convert b.splat -o out.spz --overwrite --quiet",
       "convert made/a.ply -o out.spz --overwrite --quiet", "out.spz"},
      {"convert to .sog", "convert b.splat -o out.sog --overwrite --quiet",
       "convert made/a.ply -o out.sog --overwrite --quiet", "out.sog"},
      {"convert to .glb", "convert b.splat -o out.glb --overwrite --quiet",
       "convert made/a.ply -o out.glb --overwrite --quiet", "out.glb"},
      {"convert from .sog", "convert b.splat -o out.splat --overwrite --quiet",
       "convert a.sog -o out.splat --overwrite --quiet", "out.splat"},
      {"merge", "merge made/a.ply b.splat -o out.ply --overwrite --quiet",
       "merge b.splat made/a.ply -o out.ply --overwrite --quiet", "out.ply"},
      {"render", render + "--camera 1", render + "--camera 0", "out.png"},
      {"eval", eval + "--clicks 2", eval + "--clicks 1", "out", 256},
  };
  return all;
}

// How many runs of a deed with a fault ended which way.
struct Ends {
  int runs = 0, old_said = 0, new_said = 0, new_unsaid = 0, left = 0;
};

class Bench {
 public:
  Bench() {
    REQUIRE(place_.run("make-scene a -o made --gaussians 8000 --sh-degree 1 --quiet").code == 0);
    REQUIRE(place_.run("make-scene b -o made_b --gaussians 8000 --quiet").code == 0);
    REQUIRE(place_.run("convert made_b/b.ply -o b.splat --quiet").code == 0);
    REQUIRE(place_.run("convert made/a.ply -o a.sog --quiet").code == 0);
    json suite = json::parse(place_.text("made/suite.json"));
    json apple = suite["scenes"][1];
    apple["test_views"] = {apple["test_views"][0], apple["test_views"][1]};
    suite["scenes"] = {apple};
    place_.write("made/one.json", suite.dump());
    json seeds = json::parse(place_.text("made/seeds.json"));
    seeds["objects"] = {seeds["objects"][0], seeds["objects"][1]};
    place_.write("made/two.json", seeds.dump());
  }

  // The older output and the newer one, from runs without faults.
  void prepare(const Deed& deed) {
    deed_ = deed;
    remove(deed.output);
    run_well(deed.before);
    if (fs::is_directory(place_ / deed.output)) {
      place_.make_folder(deed.output + "/photos");
      place_.write(deed.output + "/notes.txt", "mine");
      place_.write(deed.output + "/photos/a.jpg", "mine");
    }
    old_ = contents();
    remove("kept");
    fs::copy(place_ / deed.output, place_ / "kept", fs::copy_options::recursive);
    run_well(deed.now);
    new_ = contents();
    REQUIRE(old_ != new_);
    run_well(deed.now);
    REQUIRE(contents() == new_);
  }

  // False where the run made fewer such calls.
  bool try_at(const Fault& fault, int nth, Ends* ends) {
    restore();
    const std::string at =
        fmt::format("{}:{}:{}{}", fault.call, nth, fault.how,
                    fault.call == "allocate" && fault.how != kNothingLeft ? kFromBytes : "");
    CAPTURE(deed_.name);
    CAPTURE(at);
    const Result result = place_.run_with(
        {"SPLATCUT_FAULT=" + at, "SPLATCUT_FAULT_HIT=hit", "LD_PRELOAD=" + fault_shim()}, deed_.now);
    CAPTURE(result.err);
    CAPTURE(result.signal);
    const std::map<std::string, std::string> is = contents();
    const bool reached = place_.exists("hit");
    if (result.code == 0) {
      CHECK(is == new_);
      CHECK((result.err.empty() || result.err.find("warning") != std::string::npos));
    } else {
      CHECK(reached);
      CHECK(result.code == 1);
      CHECK(is_one_sentence(result.err));
      if (fault.call == "allocate") CHECK(result.err.find("memory") != std::string::npos);
      CHECK((is == old_ || is == new_));
    }
    const bool left = !place_.leftovers().empty();
    ends->left += left;
    ++(result.code == 0 ? ends->new_unsaid : is == old_ ? ends->old_said : ends->new_said);
    ends->runs += reached;
    // Left until the next run: what may not be removed; folders of others that may not be moved or looked
    // into, which is said.
    const bool may_stay = fault.call == "remove" || fault.how == kNothingLeft;
    const bool of_others = fault.call == "rename" || fault.call == "open";
    if (!may_stay && !(of_others && result.code == 1 && is == new_)) CHECK(!left);
    check_others();
    if (left || !has_others()) {
      run_well(deed_.now);
      CHECK(contents() == new_);
      CHECK(place_.leftovers().empty());
      CHECK(has_others());
    }
    return reached;
  }

 private:
  void run_well(const std::string& arguments) {
    remove("cache");  // what a report says of it
    const Result result = place_.run(arguments);
    REQUIRE_MESSAGE(result.code == 0, arguments, ": ", result.err);
  }

  void remove(const std::string& name) { fs::remove_all(place_ / name); }

  void restore() {
    for (const char* name : {"hit", "cache"}) remove(name);
    for (const std::string ending : {"", ".splatcut.part", ".splatcut.new"}) remove(deed_.output + ending);
    fs::copy(place_ / "kept", place_ / deed_.output, fs::copy_options::recursive);
  }

  // The output's files by name, without times and without those of others.
  std::map<std::string, std::string> contents() const {
    static const std::regex kTimes(
        R"re("([a-z_]*ms|peak_rss_mb|cache|cut|first mask|graph|labels in views|likelihood|load|parts|trim)": *[-+.e0-9]+,?\s*)re");
    std::map<std::string, std::string> found;
    if (!fs::is_directory(place_ / deed_.output)) return {{deed_.output, place_.text(deed_.output)}};
    for (const auto& entry : fs::recursive_directory_iterator(place_ / deed_.output)) {
      const std::string name = fs::relative(entry.path(), place_ / "").string();
      if (!entry.is_regular_file() || name.ends_with(".txt") || name.ends_with(".jpg")) continue;
      found[name] = place_.text(name);
      if (name.ends_with(".json")) found[name] = std::regex_replace(found[name], kTimes, "");
    }
    return found;
  }

  bool is_folder() const { return fs::is_directory(place_ / "kept"); }
  bool has_others() const {
    return !is_folder() || (place_.text(deed_.output + "/notes.txt") == "mine" &&
                            place_.exists(deed_.output + "/photos/a.jpg"));
  }
  // At their place, or beside it until the next run.
  void check_others() const {
    if (!is_folder()) return;
    const auto is_there = [&](const std::string& name) {
      return place_.exists(deed_.output + name) || place_.exists(deed_.output + ".splatcut.new" + name);
    };
    CHECK(is_there("/notes.txt"));
    CHECK(is_there("/photos/a.jpg"));
  }

  static bool is_one_sentence(const std::string& text) {
    return std::count(text.begin(), text.end(), '\n') == 1 && text.ends_with(".\n") &&
           !text.ends_with("?.\n") && text.starts_with("splatcut") &&
           text.find("defect") == std::string::npos && text.find("std::") == std::string::npos;
  }

  Workplace place_;
  Deed deed_;
  std::map<std::string, std::string> old_, new_;
};

}  // namespace

TEST_CASE(
    "injected faults: whatever call fails, an output is the old or the new, and one sentence says why") {
  const char* every_nth = std::getenv("SPLATCUT_EVERY_FAULT");
  const int stride = every_nth ? std::stoi(every_nth) : 0;
  const char* only = std::getenv("SPLATCUT_FAULTS_OF");        // a deed
  const char* only_call = std::getenv("SPLATCUT_FAULT_CALL");  // a call
  Bench bench;
  std::vector<int> reached(faults().size(), 0);
  if (stride > 0)
    fmt::print(
        "| command | call | fails | runs | refused, old | refused, new | done | left until the next run "
        "|\n|---|---|---|---|---|---|---|---|\n");
  for (const Deed& deed : deeds()) {
    if (only && deed.name != only) continue;
    bench.prepare(deed);
    for (const Fault& fault : faults()) {
      if (only_call && fault.call != only_call) continue;
      Ends ends;
      int& runs = reached[static_cast<std::size_t>(&fault - faults().data())];
      const int first = fault.how == kNothingLeft ? 128 : 1;  // before main() nothing can be said
      for (int nth = first; bench.try_at(fault, nth, &ends);)
        nth = stride > 0 && fault.how != kNothingLeft ? nth + stride : nth * deed.steps;
      runs += ends.runs;
      if (stride > 0 && ends.runs > 0)
        fmt::print("| {} | {} | {} | {} | {} | {} | {} | {} |\n", deed.name, fault.call, fault.meant,
                   ends.runs, ends.old_said, ends.new_said, ends.new_unsaid - 1, ends.left);
      std::fflush(stdout);
    }
  }
  for (std::size_t f = 0; f < reached.size() && !only && !only_call; ++f) {
    CAPTURE(faults()[f].call);
    CAPTURE(faults()[f].meant);
    CHECK(reached[f] > 0);
  }
}
