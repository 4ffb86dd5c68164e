// What can say which object is meant: folders of masks, words with a program, a file of several objects.
#include <doctest/doctest.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>

#include "program_runner.h"
#include "small_still_life.h"

using namespace splatcut::testing;
using nlohmann::json;

namespace {

constexpr const char* kSize = " --size 504x378";

double iou(const std::string& a, const std::string& b) {
  REQUIRE(a.size() == b.size());
  std::size_t both = 0, either = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    both += a[i] && b[i];
    either += a[i] || b[i];
  }
  return either ? static_cast<double>(both) / static_cast<double>(either) : 1.0;
}

// The true mask of the apple in a view, in the same place for every test.
std::string apple_mask(int view, const std::string& size = kSize) {
  const Workplace& place = still_life().place;
  const std::string name = "truth_" + std::to_string(view) + (size.empty() ? "_full" : "") + ".png";
  if (place.exists(name)) return name;
  place.write("apple.labels.u8", still_life().truth_of("apple"));
  REQUIRE(place
              .run("render " + still_life().scene + " " + still_life().cameras + " --camera " +
                   std::to_string(view) + size + " --what labels --labels apple.labels.u8 -o " + name)
              .code == 0);
  return name;
}

void copy(const std::string& from, const std::string& to) {
  still_life().place.write(to, still_life().place.text(from));
}

// A folder with the apple's masks: view and name of each.
void mask_folder(const std::string& folder, const std::vector<std::pair<int, std::string>>& masks,
                 const std::string& size = kSize) {
  const Workplace& place = still_life().place;
  std::filesystem::remove_all(place / folder);
  place.make_folder(folder);
  for (const auto& [view, name] : masks) {
    std::filesystem::create_directories((place / (folder + "/" + name)).parent_path());
    copy(apple_mask(view, size), folder + "/" + name);
  }
}

void black_mask(const std::string& name) {  // nothing is labelled
  const Workplace& place = still_life().place;
  place.write("none.labels.u8", std::string(20000, '\0'));
  REQUIRE(place
              .run("render " + still_life().scene + " " + still_life().camera + kSize +
                   " --what labels --labels none.labels.u8 --overwrite -o " + name)
              .code == 0);
}

std::string cut_with(const std::string& rest) {
  return "cut " + still_life().scene + " " + still_life().cameras + " --preset fast" + rest;
}

void refused(const std::string& arguments, const std::vector<std::string>& whole,
             std::initializer_list<const char*> parts, int code = 1) {
  const Workplace& place = still_life().place;
  const Result result = place.run(arguments + " -o refused", whole);
  CAPTURE(arguments);
  CAPTURE(result.err);
  CHECK(result.code == code);
  if (code == 1) {  // before the sentence, what a program of the user's printed
    const std::size_t sentence = result.err.rfind("splatcut: ");
    REQUIRE(sentence != std::string::npos);
    CHECK((sentence == 0 || result.err[sentence - 1] == '\n'));
    CHECK(result.err.find('\n', sentence) == result.err.size() - 1);
    CHECK(result.err.ends_with(".\n"));
  }
  for (const char* part : parts) CHECK_MESSAGE(result.err.find(part) != std::string::npos, part);
  CHECK_FALSE(place.exists("refused"));
  CHECK(place.leftovers().empty());
}

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

}  // namespace

TEST_CASE("--masks: masks of several cameras, found by name, are all used, the object is the one they show") {
  const Workplace& place = still_life().place;
  mask_folder("masks", {{0, "view_00.png"}, {3, "view_03.JPG.png"}, {7, "inner/view_07.PNG"}});
  place.write("masks/notes.txt", "not a mask");
  REQUIRE(place.run(cut_with(std::string(kSize) + " --masks masks/ -o by_masks")).code == 0);
  const json report = json::parse(place.text("by_masks/report.json"));
  CHECK(report["settings"]["reference"] == "view_00");
  REQUIRE(report["views"].size() == 3);
  for (const json& view : report["views"]) CHECK(view["used"] == true);
  CHECK(iou(place.text("by_masks/labels.u8"), still_life().truth_of("apple")) > 0.8);

  // --camera chooses the reference where that camera has a mask; otherwise the first with one is taken, and
  // said so.
  REQUIRE(place.run(cut_with(std::string(kSize) + " --masks masks --camera view_07 -o from_7")).code == 0);
  CHECK(json::parse(place.text("from_7/report.json"))["settings"]["reference"] == "view_07");
  const Result other = place.run(cut_with(std::string(kSize) + " --masks masks --camera 1 -o from_1"));
  REQUIRE(other.code == 0);
  CHECK(other.err.find("\"view_01\" has no mask, \"view_00\" is the reference") != std::string::npos);
  CHECK(place.text("from_1/labels.u8") == place.text("by_masks/labels.u8"));
}

TEST_CASE("--masks: masks larger than any view is looked at serve as well") {
  const Workplace& place = still_life().place;
  const std::string large = " --size 2016x1512";
  std::filesystem::remove_all(place / "large_masks");
  place.make_folder("large_masks");
  for (const int view : {0, 3}) {
    const std::string to = "large_masks/view_0" + std::to_string(view) + ".png";
    apple_mask(view);
    REQUIRE(place
                .run("render " + still_life().scene + " " + still_life().cameras + " --camera " +
                     std::to_string(view) + large + " --what labels --labels apple.labels.u8 -o " + to)
                .code == 0);
  }
  REQUIRE(place.run(cut_with(large + " --masks large_masks -o by_large")).code == 0);
  const json report = json::parse(place.text("by_large/report.json"));
  REQUIRE(report["views"].size() == 2);
  CHECK(report["views"][1]["used"] == true);
  CHECK(iou(place.text("by_large/labels.u8"), still_life().truth_of("apple")) > 0.8);
}

TEST_CASE("--masks with one mask is --mask, in the camera's own size, too") {
  const Workplace& place = still_life().place;
  mask_folder("one", {{3, "view_03.png"}}, "");
  REQUIRE(place.run(cut_with(" --masks one -o by_folder")).code == 0);
  REQUIRE(place.run(cut_with(" --camera view_03 --mask one/view_03.png -o by_file")).code == 0);
  for (const char* file : {"labels.u8", "object.ply", "object.png", "tint.png", "masks.png"})
    CHECK_MESSAGE(place.text(std::string("by_folder/") + file) == place.text(std::string("by_file/") + file),
                  file);
}

TEST_CASE("masks that cannot be used are refused, with the file and the reason, and nothing is written") {
  const Workplace& place = still_life().place;
  const std::string masks = cut_with(std::string(kSize) + " --masks bad");
  refused(cut_with(" --masks nowhere"), {}, {"nowhere", "No such file"});
  place.make_folder("bad");
  refused(masks, {}, {"bad", "holds no masks", "NAME.png"});
  mask_folder("bad", {{0, "view_00.png"}, {3, "photo_3.png"}});
  refused(masks, {}, {"photo_3.png", "no camera is called \"photo_3\"", "view_00"});
  mask_folder("bad", {{0, "view_00.png"}, {0, "view_00.jpg.png"}});
  refused(masks, {}, {"view_00", "another mask"});
  mask_folder("bad", {{0, "view_00.png"}});
  refused(cut_with(" --masks bad"), {}, {"view_00.png", "504x378", "--size"});
  black_mask("bad/view_03.png");
  refused(masks, {}, {"view_03.png", "empty"});
  refused(cut_with(std::string(kSize) + " --camera 3 --mask bad/view_03.png"), {}, {"view_03.png", "empty"});
  place.write("bad/view_03.png", place.text("bad/view_00.png").substr(0, 200));
  refused(masks, {}, {"view_03.png"});
  mask_folder("bad", {{0, "view_00.png"}});
  refused("cut " + still_life().scene + " --masks bad", {}, {"--cameras"});
  refused(masks + " --camera-pos 0,-1,-4 --camera-target 0,0,0", {}, {"--camera-pos", "--camera"});
  refused(masks + " --click 5,5", {}, {"--masks"}, 2);
  refused(masks + " --mask bad/view_00.png", {}, {"--mask"}, 2);
  refused(masks + " --parts-only", {}, {"--parts-only"}, 2);
  // Two cameras of one name cannot be told apart.
  json cameras = json::parse(place.text("made/cameras.json"));
  cameras[1]["img_name"] = "view_00";
  place.write("twins.json", cameras.dump());
  refused("cut " + still_life().scene + " --cameras twins.json --masks bad" + kSize, {},
          {"2 cameras", "view_00"});
}

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
  refused(cut, with("./text.sh {image} {text} {mask}"), {"not a whole PNG"});
  script("black.sh", "cp black.png \"$3\"\n");
  refused(cut, with("./black.sh {image} {text} {mask}"), {"black.sh", "empty"});
  script("large.sh", "cp truth_0_full.png \"$3\"\n");
  refused(cut, with("./large.sh {image} {text} {mask}"), {"large.sh", "504x378"});
  const std::string no_text = cut_with(std::string(kSize) + " --camera 0");
  refused(no_text, {"--text", "", "--segmenter", "run {image} {text} {mask}"}, {"--text", "empty"});
  refused(no_text + " --click 5,5", with("run {image} {text} {mask}"), {"--text"}, 2);
  refused(cut + " --click 5,5", with("run {image} {text} {mask}"), {"--text"}, 2);
  CHECK(place.files_in("tmp").empty());
}

namespace {

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

}  // namespace

namespace {

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
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    if (signal == SIGINT) ::kill(slow.cut, signal);
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

namespace {

json one_click(const std::string& thing) {
  const std::string at = still_life().click_on(thing);
  const auto comma = at.find(',');
  return json::array({json{{"x", std::stoi(at.substr(0, comma))}, {"y", std::stoi(at.substr(comma + 1))}}});
}

}  // namespace

TEST_CASE(
    "several objects: each is what it is alone, less what later ones claim, and everything lies in one "
    "file") {
  const Workplace& place = still_life().place;
  for (const char* thing : {"apple", "mug"})
    REQUIRE(
        place.run(still_life().cut("--click " + still_life().click_on(thing) + " -o alone_" + thing)).code ==
        0);
  const std::string apple = place.text("alone_apple/labels.u8"), mug = place.text("alone_mug/labels.u8");
  // The second claims what the first does; the third has a camera of its own.
  place.write("three.json", json{{"objects",
                                  {{{"name", "red apple"}, {"clicks", one_click("apple")}},
                                   {{"object", "mug"}, {"camera", 0}, {"clicks", one_click("mug")}},
                                   {{"name", "again"}, {"camera", "view_00"}, {"clicks", one_click("mug")}}}}}
                                .dump());
  refused(still_life().cut("--seeds three.json"), {}, {"\"mug\"", "objects after it"});
  place.write("two.json", json{{"objects",
                                {{{"name", "red apple"}, {"clicks", one_click("apple")}},
                                 {{"object", "mug"}, {"camera", "view_00"}, {"clicks", one_click("mug")}}}}}
                              .dump());
  const Result result = place.run("cut " + still_life().scene + " " + still_life().cameras +
                                  " --preset fast --seeds two.json --json -o both");
  REQUIRE_MESSAGE(result.code == 0, result.err);
  CHECK(place.files_in("both") ==
        std::set<std::string>{"labels.u8", "mug.labels.u8", "mug.masks.png", "mug.ply", "mug.png",
                              "mug.tint.png", "red_apple.labels.u8", "red_apple.masks.png", "red_apple.ply",
                              "red_apple.png", "red_apple.tint.png", "report.json", "rest.ply", "rest.png"});
  std::string owner(20000, '\0'), first = apple;
  for (std::size_t g = 0; g < owner.size(); ++g) owner[g] = mug[g] ? '\2' : apple[g] ? '\1' : '\0';
  for (std::size_t g = 0; g < owner.size(); ++g) first[g] = owner[g] == '\1';
  CHECK(place.text("both/labels.u8") == owner);
  CHECK(place.text("both/mug.labels.u8") == mug);
  CHECK(place.text("both/red_apple.labels.u8") == first);
  CHECK(place.text("both/mug.ply") == place.text("alone_mug/object.ply"));
  CHECK(place.text("both/mug.tint.png") == place.text("alone_mug/tint.png"));
  const json report = json::parse(result.out);
  REQUIRE(report["objects"].size() == 2);
  std::size_t in_files = json::parse(place.run("info both/rest.ply --json").out)["gaussians"];
  CHECK(report["rest"]["gaussians"] == in_files);
  for (const json& object : report["objects"]) {
    const std::size_t gaussians =
        json::parse(place.run("info both/" + object["file"].get<std::string>() + " --json").out)["gaussians"];
    CHECK(object["gaussians"] == gaussians);
    CHECK(object["camera"] == "view_00");
    CHECK(object["views"].size() >= 1);
    in_files += gaussians;
  }
  CHECK(in_files == 20000);
  CHECK(report["objects"][0]["name"] == "red apple");
  CHECK(report["objects"][0]["index"] == 1);
  CHECK(report["objects"][0]["left_to_later"] ==
        std::count(apple.begin(), apple.end(), '\1') - std::count(first.begin(), first.end(), '\1'));
  int prepared = 0;
  for (const json& stage : report["stages"]) prepared += stage["name"] == "graph" || stage["name"] == "cache";
  CHECK(report["stages"][0]["name"] == "load");
  CHECK(prepared == 1);
  for (const json& object : report["objects"])
    for (const json& stage : object["stages"]) CHECK(stage["name"] != "graph");
}

TEST_CASE("what is claimed by two is the later one's") {
  const Workplace& place = still_life().place;
  // Two clicks, so the first is both things; the second takes its own back.
  json both = one_click("apple");
  both.push_back(one_click("mug")[0]);
  place.write("overlap.json",
              json{{"objects",
                    {{{"name", "both"}, {"clicks", both}}, {{"name", "mug"}, {"clicks", one_click("mug")}}}}}
                  .dump());
  const Result result = place.run(still_life().cut("--seeds overlap.json --json -o overlap"));
  REQUIRE_MESSAGE(result.code == 0, result.err);
  const std::string mug = place.text("overlap/mug.labels.u8"), owner = place.text("overlap/labels.u8"),
                    first = place.text("overlap/both.labels.u8");
  const json report = json::parse(result.out);
  CHECK(report["objects"][0]["left_to_later"].get<int>() > 100);
  CHECK(iou(mug, still_life().truth_of("mug")) > 0.7);
  const std::string apple = still_life().truth_of("apple");
  std::size_t kept = 0;
  for (std::size_t g = 0; g < apple.size(); ++g) kept += apple[g] && first[g];
  CHECK(10 * kept > 9 * static_cast<std::size_t>(std::count(apple.begin(), apple.end(), '\1')));
  for (std::size_t g = 0; g < owner.size(); ++g) {
    if ((owner[g] == '\2') == (mug[g] == '\1') && (owner[g] == '\1') == (first[g] == '\1')) continue;
    FAIL("row ", g);
  }
}

TEST_CASE("a choice in the seeds takes another meaning of the first click") {
  const Workplace& place = still_life().place;
  const auto labels = [&](const json& seeds, const std::string& file) {
    place.write("choice.json", seeds.dump());
    const Result result =
        place.run(still_life().cut("--seeds choice.json --parts-only --overwrite -o chosen"));
    REQUIRE_MESSAGE(result.code == 0, result.err);
    return place.text("chosen/" + file);
  };
  int others = 0;
  for (const char* thing : {"mug", "books", "plant", "pot"}) {
    const json clicks = one_click(thing);
    const std::string likeliest = labels({{"clicks", clicks}}, "labels.u8");
    CHECK(labels({{"clicks", clicks}, {"choice", 1}}, "labels.u8") == likeliest);
    const std::string second = labels({{"clicks", clicks}, {"choice", 2}}, "labels.u8");
    others += second != likeliest;
    const json named = {{"objects", json::array({json{{"name", "it"}, {"clicks", clicks}, {"choice", 2}}})}};
    CHECK(labels(named, "it.labels.u8") == second);
  }
  CHECK(others > 0);
}

TEST_CASE("seeds come through a pipe, too, of one object or several") {
  const Workplace& place = still_life().place;
  const json one = {{"clicks", one_click("apple")}, {"choice", 1}};
  json several = {{"objects", json::array({one})}};
  several["objects"][0]["name"] = "apple";
  for (const json& seeds : {one, several}) {
    place.write("seeds.json", seeds.dump());
    place.write("piped.sh", "cat seeds.json | " SPLATCUT_PROGRAM " " +
                                still_life().cut("--seeds /dev/stdin --parts-only --overwrite -o piped"));
    const Result piped = place.run_program("/bin/sh", "piped.sh");
    REQUIRE_MESSAGE(piped.code == 0, piped.err);
    REQUIRE(place.run(still_life().cut("--seeds seeds.json --parts-only --overwrite -o from_file")).code ==
            0);
    CHECK(place.text("piped/labels.u8") == place.text("from_file/labels.u8"));
  }
}

TEST_CASE("files of objects that cannot be used are refused") {
  const Workplace& place = still_life().place;
  const json clicks = one_click("apple");
  const auto with = [&](const json& objects, std::initializer_list<const char*> parts,
                        const std::string& more = "") {
    place.write("objects.json", json{{"objects", objects}}.dump());
    refused(still_life().cut("--seeds objects.json" + more), {}, parts);
  };
  const json apple = {{"name", "apple"}, {"clicks", clicks}};
  with(json::array(), {"objects.json", "1 to 255"});
  with(json::array({json{{"clicks", clicks}}}), {"object 0", "name"});
  with({apple, {{"name", "mug"}}}, {"object 1", "neither clicks"});
  with({apple, apple}, {"apple.ply", "taken"});
  with({{{"name", "a b"}, {"clicks", clicks}}, {{"name", "a/b"}, {"clicks", clicks}}}, {"a_b.ply", "taken"});
  with(json::array({json{{"name", "rest"}, {"clicks", clicks}}}), {"rest.ply", "taken"});
  with(json::array({json{{"name", "apple"}, {"camera", "none"}, {"clicks", clicks}}}), {"camera \"none\""});
  with(json::array({json{{"name", "apple"}, {"camera", 1.5}, {"clicks", clicks}}}), {"\"camera\""});
  with(json::array({json{{"name", "apple"}, {"clicks", json::array({json{{"x", 5000}, {"y", 3}}})}}}),
       {"5000", "outside"});
  with(json::array({json{{"name", "apple"}, {"clicks", json::array({json{{"x", "left"}}})}}}),
       {"object 0", "form"});
  with(json::array({json{{"name", "apple"}, {"choice", 4}, {"clicks", clicks}}}), {"object 0", "\"choice\""});
  with(json::array({json{{"name", "apple"}, {"choice", "second"}, {"clicks", clicks}}}), {"from 1 to 3"});
  with(json::array({apple}), {"--click", "in the file"}, " --click 5,5");
  place.write(
      "objects.json",
      json{{"objects", json::array({json{{"name", "apple"}, {"camera", "view_00"}, {"clicks", clicks}}})}}
          .dump());
  refused("cut " + still_life().scene + " --seeds objects.json", {}, {"\"apple\"", "--cameras"});
}
