// Lists of cuts: the same files as `cut` writes, done once, whatever ends the program in between.
#include <doctest/doctest.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <random>

#include "cut_program.h"

using namespace splatcut::testing;
using nlohmann::json;

namespace {

json job_on(const std::string& thing, json more = json::object()) {
  json job = {{"name", thing},
              {"scene", still_life().scene},
              {"cameras", (still_life().place / "made/cameras.json").string()},
              {"camera", 0},
              {"click", still_life().click_on(thing)}};
  job.update(more);
  return job;
}

std::string lines_of(const std::vector<json>& jobs) {
  std::string text;
  for (const json& job : jobs) text += job.dump() + "\n";
  return text;
}

// Every file below the folder by its name; results without their seconds.
std::map<std::string, std::string> bytes_below(const std::string& folder) {
  namespace fs = std::filesystem;
  std::map<std::string, std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(still_life().place / folder)) {
    if (entry.is_directory()) continue;
    const std::string name = fs::relative(entry.path(), still_life().place / folder).string();
    std::string text = still_life().place.text(folder + "/" + name);
    if (name.ends_with("result.json")) {
      json result = json::parse(text);
      result.erase("seconds");
      text = result.dump();
    } else if (name.ends_with(".jsonl")) {
      std::istringstream in(std::exchange(text, ""));
      for (std::string line; std::getline(in, line);) {
        json result = json::parse(line);
        result.erase("seconds");
        text += result.dump() + "\n";
      }
    } else if (name.ends_with(".csv")) {
      text = std::to_string(std::ranges::count(text, '\n'));  // its cells are those of the lines
    }
    files[name] = text;
  }
  return files;
}

std::vector<json> results_in(const std::string& file) {
  std::istringstream in(still_life().place.text(file));
  std::vector<json> results;
  for (std::string line; std::getline(in, line);) results.push_back(json::parse(line));
  return results;
}

}  // namespace

TEST_CASE("batch: a job may have the batch's name") {
  const Workplace& place = still_life().place;
  json job = job_on("apple", {{"write", {"labels"}}, {"parts-only", true}});
  job["name"] = "batch";
  place.write("named.jsonl", lines_of({job}));
  const Result result = place.run("batch named.jsonl -o named");
  CHECK_MESSAGE(result.code == 0, result.err);
  CHECK(place.exists("named/batch/labels.u8"));
}

TEST_CASE("batch: a job's files are those of the cut with the same options, and it is done once") {
  const Workplace& place = still_life().place;
  const std::string apple = still_life().click_on("apple");
  const auto comma = apple.find(',');
  const int x = std::stoi(apple), y = std::stoi(apple.substr(comma + 1));
  place.write("two.jsonl",
              "# two ways to say it\n\n" +
                  lines_of({job_on("apple", {{"set", {"views.most=2", "clean.trim=1"}}, {"scale", -1}}),
                            {{"scene", still_life().scene},
                             {"cameras", (place / "made/cameras.json").string()},
                             {"camera", "view_00"},
                             {"parts-only", true},
                             {"coarse", false},
                             {"size", "504x378"},
                             {"write", {"labels", "npy"}},
                             {"seeds", {{"clicks", {{{"x", x / 2}, {"y", y / 2}}}}}}}}));
  const Result wrong = place.run("batch two.jsonl -o two");
  CHECK(wrong.code == 1);
  CHECK(results_in("two/results.jsonl")[0]["error"].get<std::string>().find("clean.trim") !=
        std::string::npos);
  CHECK_FALSE(place.exists("two/apple"));
  std::string text = place.text("two.jsonl");
  text.replace(text.find(",\"clean.trim=1\""), std::string(",\"clean.trim=1\"").size(), "");
  place.write("two.jsonl", text);
  const Result first = place.run("batch two.jsonl -o two");
  REQUIRE_MESSAGE(first.code == 0, first.err);
  CHECK(first.out.find("2 jobs: 1 done before, 1 done, 0 failed") != std::string::npos);

  REQUIRE(place.run(still_life().cut("--click " + apple + " --set views.most=2 --scale -1 -o alone")).code ==
          0);
  std::set<std::string> names = place.files_in("alone");
  for (const std::string& name : names)
    if (name != "report.json")
      CHECK_MESSAGE(place.text("two/apple/" + name) == place.text("alone/" + name), name);
  names.insert("result.json");
  CHECK(place.files_in("two/apple") == names);
  const json report = json::parse(place.text("alone/report.json"));
  json of_job = json::parse(place.text("two/apple/report.json"));
  CHECK_FALSE(of_job.contains("total_ms"));
  CHECK(of_job["cut"] == report["cut"]);
  CHECK(of_job["settings"]["values"] == report["settings"]["values"]);

  CHECK(place.files_in("two/job_00004") ==
        std::set<std::string>{"labels.npy", "labels.u8", "report.json", "result.json"});
  REQUIRE(place
              .run(still_life().cut(
                  "--parts-only --size 504x378 --seeds {\"clicks\":[{\"x\":" + std::to_string(x / 2) +
                  ",\"y\":" + std::to_string(y / 2) + "}]} --write labels -o parts"))
              .code == 0);
  CHECK(place.files_in("parts") == std::set<std::string>{"labels.u8", "report.json"});
  const std::string labels = place.text("parts/labels.u8");
  CHECK(place.text("two/job_00004/labels.u8") == labels);
  const std::string npy = place.text("two/job_00004/labels.npy");  // by numpy's description of its format
  REQUIRE(npy.size() == 128 + labels.size());
  CHECK(npy.substr(0, 10) == std::string("\x93NUMPY\x01\x00\x76\x00", 10));
  CHECK(npy.substr(10, 118) ==
        "{'descr': '|u1', 'fortran_order': False, 'shape': (20000,), }" + std::string(56, ' ') + "\n");
  CHECK(npy.substr(128) == labels);

  const std::vector<json> results = results_in("two/results.jsonl");
  REQUIRE(results.size() == 2);
  CHECK(results[0]["job"] == "apple");
  CHECK(results[0]["line"] == 3);
  CHECK(results[0]["objects"][0]["gaussians"] == report["object"]["gaussians"]);
  CHECK(results[0]["objects"][0]["doubts"] == report["doubts"]);
  CHECK(results[1]["files"] == json{"labels.npy", "labels.u8", "report.json"});
  CHECK(place.text("two/summary.csv").find("\napple,3," + still_life().scene + ",done,1,") !=
        std::string::npos);

  const auto before = bytes_below("two");
  const std::string with_seconds = place.text("two/results.jsonl");
  const Result again = place.run("batch two.jsonl -o two --jobs 2");
  CHECK(again.code == 0);
  CHECK(again.out.find("2 jobs: 2 done before, 0 done, 0 failed") != std::string::npos);
  CHECK(place.text("two/results.jsonl") == with_seconds);
  CHECK(bytes_below("two") == before);
  CHECK(place.leftovers().empty());
}

TEST_CASE("batch: what is no job fails with a sentence, and the others are done") {
  const Workplace& place = still_life().place;
  place.make_folder("mixed/taken");
  place.write("mixed/taken/mine.txt", "mine");
  place.write("ends_its_parent.sh", "kill -9 $PPID\n");
  json ends =
      job_on("plant", {{"text", "a plant"}, {"segmenter", "sh ends_its_parent.sh {image} {text} {mask}"}});
  ends.erase("click");
  const std::vector<std::pair<std::string, const char*>> lines = {
      {"{\"scene\": ", "not valid JSON"},
      {"[1, 2]", "no object"},
      {"{\"click\": \"1,1\"}", "names no \"scene\""},
      {job_on("apple", {{"nonsense", 1}}).dump(), "\"nonsense\" is no option"},
      {job_on("apple", {{"output", "elsewhere"}}).dump(), "\"output\" is no option"},
      {job_on("apple", {{"views", 900}}).dump(), "900"},
      {job_on("apple", {{"coarse", "yes"}}).dump(), "neither true nor false"},
      {job_on("apple", {{"click", "5"}}).dump(), "is not a pixel"},
      {job_on("apple", {{"preset", ""}}).dump(), "is empty"},
      {job_on("apple", {{"name", "no scene"}, {"scene", "missing.ply"}}).dump(), "missing.ply"},
      {job_on("apple", {{"name", "taken"}}).dump(), "no result of a batch"},
      {job_on("mug").dump(), nullptr},
      {job_on("mug").dump(), "the folder mug is that of line 12"},
      {ends.dump(), "its process was killed"},
      {job_on("books", {{"write", "labels"}}).dump(), nullptr},
  };
  std::string text;
  for (const auto& line : lines) text += line.first + "\n";
  place.write("mixed.jsonl", text);
  const Result result = place.run("batch mixed.jsonl -o mixed --jobs 2");
  CHECK(result.code == 1);
  CHECK(result.err.find("13 of 15 jobs failed") != std::string::npos);
  const std::vector<json> results = results_in("mixed/results.jsonl");
  REQUIRE(results.size() == lines.size());
  for (std::size_t i = 0; i < lines.size(); ++i) {
    CAPTURE(results[i].dump());
    CHECK(results[i]["line"] == i + 1);
    REQUIRE(results[i].contains("error") == (lines[i].second != nullptr));
    if (lines[i].second)
      CHECK(results[i]["error"].get<std::string>().find(lines[i].second) != std::string::npos);
  }
  CHECK(place.files_in("mixed") ==
        std::set<std::string>{"books", "mug", "taken", "results.jsonl", "summary.csv"});
  CHECK(place.text("mixed/taken/mine.txt") == "mine");
  CHECK(place.run("batch mixed.jsonl -o mixed --shard 2/2").err.find("--shard") != std::string::npos);
  CHECK(place.run("batch mixed.jsonl -o mixed --shard 1").code == 1);
  CHECK(place.run("batch mixed/results.jsonl -o mixed").err.find("is what is read here") !=
        std::string::npos);
  place.write("empty.jsonl", "\n# nothing\n");
  CHECK(place.run("batch empty.jsonl -o empty").err.find("holds no job") != std::string::npos);
  CHECK_FALSE(place.exists("empty"));
}

TEST_CASE("batch: a job that was changed is done again, and files of its old result leave") {
  const Workplace& place = still_life().place;
  place.write("change.jsonl", lines_of({job_on("apple", {{"write", {"labels", "npy"}}})}));
  REQUIRE(place.run("batch change.jsonl -o change").code == 0);
  place.write("change/apple/notes.txt", "mine");
  place.write("change.jsonl", lines_of({job_on("apple", {{"write", "labels"}, {"scale", 1}})}));
  const std::string before = place.text("change/apple/labels.u8");
  REQUIRE(place.run("batch change.jsonl -o change").code == 0);
  CHECK(place.text("change/apple/labels.u8") != before);
  CHECK(place.files_in("change/apple") ==
        std::set<std::string>{"labels.u8", "notes.txt", "report.json", "result.json"});
  std::filesystem::remove(place / "change/apple/labels.u8");  // what lacks a file is not done
  CHECK(place.run("batch change.jsonl -o change").out.find("0 done before, 1 done") != std::string::npos);
  CHECK(place.run("batch change.jsonl -o change --overwrite").out.find("0 done before, 1 done") !=
        std::string::npos);
}

TEST_CASE("batch: shards, workers and kills at any moment change nothing of what is there in the end") {
  const Workplace& place = still_life().place;
  if (!place.exists("made2")) REQUIRE(place.run("make-scene other -o made2 --gaussians 8000").code == 0);
  std::vector<json> jobs;
  for (const std::string thing : {"apple", "mug", "plant", "books"}) {
    const bool first = thing == "apple";
    jobs.push_back(job_on(thing, {{"write", first ? json{"object", "labels"} : json{"labels"}}}));
    jobs.push_back(job_on(
        thing,
        {{"name", "other " + thing}, {"scene", (place / "made2/other.ply").string()}, {"write", "labels"}}));
  }
  place.write("list.jsonl", lines_of(jobs));
  REQUIRE(place.run("batch list.jsonl -o whole").code == 0);
  const auto whole = bytes_below("whole");
  CHECK(whole.size() == 8 * 3 + 1 + 2);

  REQUIRE(place.run("batch list.jsonl -o workers --jobs 3").code == 0);
  CHECK(bytes_below("workers") == whole);

  // Two scenes, two parts: each has one of them.
  for (const char* part : {"0", "1"})
    REQUIRE(place.run(std::string("batch list.jsonl -o parts_of_it --shard ") + part + "/2").code == 0);
  for (const int part : {0, 1}) {
    const std::vector<json> results =
        results_in("parts_of_it/results." + std::to_string(part) + "-of-2.jsonl");
    CHECK(results.size() == 4);
    for (const json& result : results)
      CHECK(result["scene"] == jobs[static_cast<std::size_t>(part)]["scene"]);
  }
  const Result collected = place.run("batch list.jsonl -o parts_of_it");
  CHECK(collected.out.find("8 done before, 0 done") != std::string::npos);
  auto parts = bytes_below("parts_of_it");
  CHECK(std::erase_if(parts,
                      [](const auto& file) { return file.first.find("-of-2") != std::string::npos; }) == 4);
  CHECK(parts == whole);

  // In three parts each scene lies in two: no job's files know which were done before it.
  for (const char* part : {"2", "0", "1"})
    REQUIRE(place.run(std::string("batch list.jsonl -o thirds --shard ") + part + "/3").code == 0);
  REQUIRE(place.run("batch list.jsonl -o thirds").code == 0);
  auto thirds = bytes_below("thirds");
  std::erase_if(thirds, [](const auto& file) { return file.first.find("-of-3") != std::string::npos; });
  for (const auto& [name, bytes] : whole) CHECK_MESSAGE(thirds[name] == bytes, name);
  CHECK(thirds.size() == whole.size());

  std::mt19937 random(7);
  int ended = 0;
  for (int round = 0; round < 5; ++round) {
    const int signals[] = {SIGKILL, SIGTERM, SIGINT};
    const auto killed_before = place.leftovers();  // nobody clears up after a SIGKILL until a later run does
    const Result result = place.run_interrupted("batch list.jsonl -o killed --jobs 2",
                                                static_cast<int>(random() % 900), signals[round % 3]);
    ended += result.code != 0;
    if (result.signal == 0 && result.code != 0) {
      CHECK(result.err.find("The same command goes on") != std::string::npos);
      CHECK(std::ranges::includes(killed_before, place.leftovers()));
    }
  }
  MESSAGE(ended, " of 5 were ended");
  REQUIRE(place.run("batch list.jsonl -o killed").code == 0);
  CHECK(bytes_below("killed") == whole);
  CHECK(place.leftovers().empty());
}
