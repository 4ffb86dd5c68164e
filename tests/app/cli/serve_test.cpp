// A conversation with `splatcut serve`: the same objects as `cut`, a reply a request, nothing else on stdout.
#include <doctest/doctest.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <random>

#include "cut_program.h"

using namespace splatcut::testing;
using nlohmann::json;

namespace {

json request(const char* what, json fields = json::object()) {
  fields["do"] = what;
  return fields;
}

struct Said {
  int code = 0;
  std::string err;
  std::map<json, json> replies;  // by id, which is the number of the request's line
  std::size_t lines = 0, progress = 0;
};

// `feed`: shell commands that write the requests.
Said heard(const std::string& feed) {
  const Workplace& place = still_life().place;
  place.write("talk.sh", "(" + feed + ") | " + splatcut_program() + " serve\n");
  const Result result = place.run_program("/bin/bash", "talk.sh");
  Said said{result.code, result.err, {}};
  std::istringstream in(result.out);
  for (std::string line; std::getline(in, line);) {
    const json reply = json::parse(line);  // throws where a line is something else
    if (reply.contains("progress")) {
      ++said.progress;
      continue;
    }
    ++said.lines;
    REQUIRE(reply.contains("id"));
    REQUIRE(reply["ok"].is_boolean());
    CHECK(reply.contains("error") != reply["ok"].get<bool>());
    if (!reply["id"].is_null()) CHECK(said.replies.emplace(reply["id"], reply).second);
  }
  return said;
}

Said talk(const std::vector<json>& requests) {
  std::string lines;
  for (std::size_t i = 0; i < requests.size(); ++i) {
    json numbered = requests[i];
    numbered["id"] = i;
    lines += numbered.dump() + "\n";
  }
  still_life().place.write("requests.jsonl", lines);
  return heard("cat requests.jsonl");
}

json opened() {
  return request("open", {{"scene", still_life().scene},
                          {"cameras", (still_life().place / "made/cameras.json").string()}});
}

json click_on(const std::string& thing, const char* label = "object") {
  const std::string at = still_life().click_on(thing);
  return request("click",
                 {{"x", std::stoi(at)}, {"y", std::stoi(at.substr(at.find(',') + 1))}, {"label", label}});
}

std::string bytes_of_base64(const std::string& text) {
  still_life().place.write("a.base64", text);
  still_life().place.write("decode.sh", "base64 -d a.base64 >a.bytes\n");
  REQUIRE(still_life().place.run_program("/bin/bash", "decode.sh").code == 0);
  return still_life().place.text("a.bytes");
}

}  // namespace

TEST_CASE("serve: a conversation cuts what `cut` cuts, and takes it back") {
  const Workplace& place = still_life().place;
  const std::string two =
      "--click " + still_life().click_on("apple") + " --click " + still_life().click_on("mug") + ":rest";
  REQUIRE(place.run(still_life().cut("--click " + still_life().click_on("apple") + " -o one_click")).code ==
          0);
  REQUIRE(place
              .run(still_life().cut("--click " + still_life().click_on("apple") +
                                    " --edges keep --write pictures -o as_is"))
              .code == 0);
  CHECK(place.files_in("as_is") ==
        std::set<std::string>{"masks.png", "object.png", "report.json", "tint.png"});
  REQUIRE(place.run(still_life().cut(two + " --edges keep --fill surface -o two_clicks")).code == 0);
  const json apple = click_on("apple");
  place.write("larger.json", json{{"clicks", {{{"x", apple["x"]}, {"y", apple["y"]}, {"scale", 1}}}}}.dump());
  REQUIRE(place.run(still_life().cut("--seeds larger.json -o larger")).code == 0);
  const Said said = talk({
      request("click", {{"x", 1}, {"y", 1}}),                                            // 0: no scene
      opened(),                                                                          // 1
      request("settings", {{"preset", "default"}}),                                      // 2
      request("labels"),                                                                 // 3: no object
      click_on("apple"),                                                                 // 4
      request("labels"),                                                                 // 5
      request("preview", {{"what", "object"}, {"path", "served.png"}}),                  // 6
      request("export", {{"path", "served.ply"}}),                                       // 7
      click_on("mug", "rest"),                                                           // 8
      request("labels", {{"path", "served.npy"}}),                                       // 9
      request("export", {{"path", "served.ply"}, {"edges", "keep"}}),                    // 10: is there
      request("export", {{"path", "kept.ply"}, {"edges", "keep"}}),                      // 11
      request("export", {{"path", "rest.ply"}, {"what", "rest"}, {"fill", "surface"}}),  // 12
      request("size", {{"step", 1}}),                                                    // 13: has none
      request("undo"),                                                                   // 14
      request("size", {{"step", 1}}),                                                    // 15
      request("labels", {{"path", "larger.u8"}}),                                        // 16
      request("undo"),                                                                   // 17
      request("click", {{"x", 5000}, {"y", 1}}),                                         // 18: outside
      request("labels"),                                                                 // 19: as before it
      request("preview", {{"width", 100}}),                                              // 20
      request("camera", {{"camera", 3}, {"size", "504x378"}}),                           // 21
      request("camera", {{"camera", "no such"}}),                                        // 22
      request("export", {{"path", still_life().scene}, {"overwrite", true}}),            // 23: an input
      request("preview", {{"path", "a.ply"}}),                                           // 24
      request("undo"),                                                                   // 25
      request("undo"),                                                                   // 26: nothing left
      request("clear"),                                                                  // 27
      request("close"),                                                                  // 28
      request("click", {{"x", 1}, {"y", 1}}),                                            // 29
      request("describe"),                                                               // 30
      request("quit"),                                                                   // 31
      request("describe"),                                                               // 32: never read
  });
  CHECK(said.code == 0);
  CHECK(said.err.empty());
  CHECK(said.lines == 32);
  for (const auto& [id, reply] : said.replies) {
    const bool fails = std::set<int>{0, 3, 10, 13, 18, 22, 23, 24, 26, 29}.contains(id.get<int>());
    CHECK_MESSAGE(reply["ok"] == !fails, reply.dump());
    if (fails) CHECK(reply["error"].get<std::string>().ends_with("."));
  }
  CHECK(said.replies.at(10)["error"].get<std::string>().find("Send \"overwrite\": true") !=
        std::string::npos);
  CHECK(said.replies.at(1)["cameras"].size() == 24);
  CHECK(said.replies.at(1)["camera"]["name"] == "view_00");
  CHECK(said.replies.at(21)["camera"]["size"] == json{504, 378});
  const std::string one = place.text("one_click/labels.u8");
  CHECK(bytes_of_base64(said.replies.at(5)["labels"]) == one);
  CHECK(bytes_of_base64(said.replies.at(19)["labels"]) == one);
  CHECK(said.replies.at(4)["doubts"] == json::parse(place.text("one_click/report.json"))["doubts"]);
  CHECK(place.text("served.png") == place.text("as_is/object.png"));
  CHECK(place.text("served.ply") == place.text("one_click/object.ply"));
  CHECK(place.text("served.npy").substr(128) == place.text("two_clicks/labels.u8"));
  CHECK(place.text("kept.ply") == place.text("two_clicks/object.ply"));
  CHECK(place.text("rest.ply") == place.text("two_clicks/rest.ply"));
  CHECK(said.replies.at(12)["fill"] == json::parse(place.text("two_clicks/report.json"))["edges"]["fill"]);
  CHECK(place.text("larger.u8") == place.text("larger/labels.u8"));
  CHECK(said.replies.at(20)["width"] == 100);
  CHECK(bytes_of_base64(said.replies.at(20)["png"]).starts_with("\x89PNG"));
  CHECK(said.replies.at(30)["protocol"] == 2);
  CHECK(place.run("serve --schema").out == said.replies.at(30)["schema"].dump(2) + "\n");
}

TEST_CASE(
    "serve and batch clean edges as `cut` does, behind thick skirts, too, and say of them what it says") {
  const Workplace& place = still_life().place;
  REQUIRE(place.run("make-scene thick -o thick --gaussians 60000 --straddling --skirts").code == 0);
  const std::string scene = (place / "thick/thick.ply").string(),
                    cameras = (place / "thick/cameras.json").string();
  const json seeds = json::parse(place.text("thick/seeds.json"));
  const auto orange = std::ranges::find(seeds["objects"], "orange",
                                        [](const json& thing) { return thing["object"].get<std::string>(); });
  const json at = (*orange)["clicks"][0];
  const std::string click = at["x"].dump() + "," + at["y"].dump();
  REQUIRE(
      place.run("cut " + scene + " --cameras " + cameras + " --camera 0 --click " + click + " -o thick_cut")
          .code == 0);
  json edges = json::parse(place.text("thick_cut/report.json"))["edges"];
  REQUIRE(edges["edges"] == "clean");
  CHECK(edges["agreed"] < 6);
  CHECK(edges["used"] == 6);
  place.write(
      "thick.jsonl",
      json{{"name", "orange"}, {"scene", scene}, {"cameras", cameras}, {"camera", 0}, {"click", click}}
              .dump() +
          "\n");
  const Result batch = place.run("batch thick.jsonl -o thick_batch");
  REQUIRE_MESSAGE(batch.code == 0, batch.err);
  json in_batch = json::parse(place.text("thick_batch/orange/report.json"))["edges"];
  edges.erase("ms");
  in_batch.erase("ms");
  CHECK(in_batch == edges);
  for (const char* file : {"object.ply", "rest.ply"})
    CHECK(place.text(std::string("thick_batch/orange/") + file) ==
          place.text(std::string("thick_cut/") + file));
  const Said said = talk({
      request("open", {{"scene", scene}, {"cameras", cameras}}),  // 0
      request("click", {{"x", at["x"]}, {"y", at["y"]}}),         // 1
      request("export", {{"path", "thick.ply"}}),                 // 2
      request("export", {{"path", "r.ply"}, {"what", "rest"}}),   // 3
  });
  REQUIRE(said.code == 0);
  CHECK(place.text("thick.ply") == place.text("thick_cut/object.ply"));
  CHECK(place.text("r.ply") == place.text("thick_cut/rest.ply"));
  for (const int id : {2, 3})
    for (const char* key : {"edges", "views", "agreed", "used", "left", "split", "made_solid", "recoloured"})
      CHECK_MESSAGE(said.replies.at(id)[key] == edges[key], key);
}

TEST_CASE("serve: every option of cut is a field of one request, or left out on purpose") {
  const json schema = json::parse(still_life().place.run("serve --schema").out);
  std::multiset<std::string> fields;
  for (const json& kind : schema["oneOf"]) {
    CHECK(kind["description"].get<std::string>().size() > 10);
    CHECK(kind["additionalProperties"] == false);
    for (const auto& [name, field] : kind["properties"].items()) fields.insert(name);
  }
  // What serve has requests for, what asks the file system for the object, and what a folder of files needs.
  const std::set<std::string> left_out = {"help",   "click", "box",       "scale",     "seeds",
                                          "mask",   "masks", "text",      "segmenter", "work",
                                          "output", "write", "overwrite", "json"};
  std::istringstream help(still_life().place.run("cut --help").out);
  int options = 0;
  for (std::string line; std::getline(help, line);) {
    const std::size_t start = line.find("--");
    if (!line.starts_with("  -") || start > 5) continue;
    const std::string name = line.substr(start + 2, line.find_first_of(" {", start) - start - 2);
    ++options;
    if (!left_out.contains(name)) CHECK_MESSAGE(fields.count(name) == 1, name);
  }
  CHECK(options > 25);
}

TEST_CASE("serve: 200 lines that are no requests have a reply each, and the program lives") {
  const std::vector<std::string> good = {
      opened().dump(),
      R"({"id": 1, "do": "click", "x": 512, "y": 384, "label": "object"})",
      R"({"id": "a", "do": "scribble", "points": [[1, 2], [3, 4]], "radius_px": 3})",
      R"({"do": "box", "corners": [[1, 2], [30, 40]]})",
      R"({"do": "camera", "camera-pos": [0, 1, 2], "camera-target": "0,0,0", "size": "64x48"})",
      R"({"do": "settings", "set": ["views.most=3"], "parts-only": true})",
      R"({"do": "preview", "what": "tint", "width": 32})",
      R"({"do": "size", "step": 1})",
      R"({"do": "choice", "choice": 2})",
  };
  std::mt19937 random(11);
  const auto any = [&](std::size_t below) { return static_cast<std::size_t>(random() % below); };
  std::string lines = opened().dump() + "\n";
  for (int i = 0; i < 200; ++i) {
    std::string line = good[any(good.size())];
    for (std::size_t changes = 1 + any(4); changes > 0; --changes) {
      const std::size_t at = any(line.size());
      const char byte = static_cast<char>(random());
      switch (any(4)) {
        case 0:
          line[at] = byte == '\n' ? 'x' : byte;
          break;
        case 1:
          line.erase(at, 1 + any(6));
          break;
        case 2:
          line.insert(at, std::string(1 + any(3), "{[\"0-,:}"[any(8)]));
          break;
        default:
          line.resize(at);
      }
      if (line.find_first_not_of(" \r\t") == std::string::npos) line = "x";
    }
    lines += line + "\n";
  }
  lines += R"({"id": "last", "do": "describe"})";
  still_life().place.write("requests.jsonl", lines);
  const Workplace& place = still_life().place;
  place.write("talk.sh", splatcut_program() + " serve <requests.jsonl\n");
  const Result result = place.run_program("/bin/bash", "talk.sh");
  CHECK(result.code == 0);
  int replies = 0, refused = 0;
  json last;
  std::istringstream in(result.out);
  for (std::string line; std::getline(in, line);) {
    const json reply = json::parse(line);
    if (reply.contains("progress")) continue;
    ++replies;
    refused += !reply["ok"].get<bool>();
    last = reply;
  }
  CHECK(replies == 202);
  CHECK(refused > 150);
  CHECK(last["id"] == "last");
  CHECK(last["ok"] == true);
}

TEST_CASE("serve: a hole is filled in the rest alone, and asked for the object that is refused in words") {
  const Said said = talk({
      opened(),                                                                            // 0
      click_on("apple"),                                                                   // 1
      request("export", {{"path", "hole.ply"}, {"fill", "surface"}}),                      // 2
      request("export", {{"path", "hole.ply"}, {"what", "object"}, {"fill", "surface"}}),  // 3
      request("export", {{"path", "hole.ply"}, {"fill", "none"}, {"edges", "keep"}}),      // 4
      request("quit"),                                                                     // 5
  });
  for (const int refused : {2, 3}) {
    CHECK(said.replies.at(refused)["ok"] == false);
    CHECK(said.replies.at(refused)["error"].get<std::string>().find("\"fill\"") != std::string::npos);
  }
  CHECK(said.replies.at(4)["ok"] == true);
}

TEST_CASE("serve: a request is cancelled, and the next one is answered as if it had not been") {
  const Workplace& place = still_life().place;
  json open = opened(), cut = click_on("plant"), cancel = request("cancel", {{"request", 2}});
  open["id"] = 1;
  cut["id"] = 2;
  cancel["id"] = 3;
  json again = cut;
  again["id"] = 4;
  place.write("requests.jsonl",
              open.dump() + "\n" + cut.dump() + "\n" + cancel.dump() + "\n" + again.dump() + "\n");
  const Said said = heard("cat requests.jsonl");  // all of it is there before the scene is open
  CHECK(said.code == 0);
  CHECK(said.replies.at(3) == json{{"id", 3}, {"ok", true}, {"cancelled", true}});
  CHECK(said.replies.at(2)["ok"] == false);
  CHECK(said.replies.at(2)["error"].get<std::string>().find("cancelled") != std::string::npos);
  CHECK(said.replies.at(4)["ok"] == true);
  CHECK(said.replies.at(4)["gaussians"] > 100);
}

TEST_CASE("serve: a signal, the end of stdin and a client that is gone end it, whatever it does") {
  const Workplace& place = still_life().place;
  json open = opened();
  place.write("requests.jsonl", open.dump() + "\n" + click_on("books").dump() + "\n");
  place.write("end.sh", splatcut_program() +
                            " serve --no-cache < <(cat requests.jsonl; sleep 20) & served=$!\n"
                            "sleep 0.3; kill -TERM $served; wait $served; echo code $?\n");
  const Result ended = place.run_program("/bin/bash", "end.sh");
  CHECK(ended.out.find("code 1") != std::string::npos);
  CHECK(ended.err.find("ended by a signal") != std::string::npos);
  CHECK(heard("true").code == 0);
  CHECK(heard("true").lines == 0);
  place.write("gone.sh", "cat requests.jsonl | (" + splatcut_program() +
                             " serve; echo $? >gone.txt) | head -c 1 >/dev/null\n");
  place.run_program("/bin/bash", "gone.sh");
  CHECK(std::stoi(place.text("gone.txt")) <= 1);
}

TEST_CASE("serve: closed standard streams end it, and no pipe of its own takes their place") {
  const Workplace& place = still_life().place;
  place.write("closed.sh", "timeout -k 1 9 " + splatcut_program() + " serve <&-; echo stdin $?\n" +
                               R"(echo '{"id":1,"do":"describe"}' | timeout -k 1 9 )" + splatcut_program() +
                               " serve >&-; echo stdout $? >&2\n");
  const Result closed = place.run_program("/bin/bash", "closed.sh");
  CHECK(closed.out == "stdin 0\n");
  CHECK_MESSAGE(closed.err.find("nobody reads the replies") != std::string::npos, closed.err);
  CHECK(closed.err.find("stdout 1") != std::string::npos);
}

TEST_CASE("serve: what a request must not hold is refused in words, and changes nothing") {
  const auto refusal = [](const std::string& line) {
    still_life().place.write("requests.jsonl", line + "\n");
    const Workplace& place = still_life().place;
    place.write("talk.sh", splatcut_program() + " serve <requests.jsonl\n");
    const json reply = json::parse(place.run_program("/bin/bash", "talk.sh").out);
    CHECK(reply["ok"] == false);
    return reply.value("error", "");
  };
  const auto says = [&](const std::string& line, std::initializer_list<const char*> parts) {
    const std::string error = refusal(line);
    for (const char* part : parts) CHECK_MESSAGE(error.find(part) != std::string::npos, error);
  };
  says(R"({"id":1.5,"do":"undo"})", {"\"id\" is 1.5", "text or a whole number"});
  says(R"({"id":1,"do":"open","scene":""})", {"open: \"scene\" is empty"});
  says(R"({"id":1,"do":"size","step":3000000000})", {"\"step\" is 3000000000", "-1000000 to 1000000"});
  says(R"({"id":1,"do":"size","step":"a"})", {"\"step\" is not a whole number"});
}

TEST_CASE("serve: a scribble without points and a box with one corner are refused, and are no steps") {
  const Said said = talk({
      opened(),                                              // 0
      click_on("apple"),                                     // 1
      request("scribble", {{"points", json::array()}}),      // 2
      request("box", {{"corners", {{604, 430}}}}),           // 3
      request("scribble", {{"points", {{604, 430}, {1}}}}),  // 4
      request("undo"),                                       // 5
  });
  const auto error = [&](int reply) { return said.replies.at(reply).value("error", ""); };
  CHECK(error(2).find("a scribble has no point") != std::string::npos);
  CHECK_MESSAGE(error(3).find("a box has two opposite corners. Write them as") != std::string::npos,
                error(3));
  CHECK_MESSAGE(error(4).find("a point is [1]") != std::string::npos, error(4));
  CHECK(said.replies.at(5)["gaussians"] == 0);  // the click
}

TEST_CASE("serve: the Python of docs/serve.md does what it says") {
  const Workplace& place = still_life().place;
  std::ifstream in(project_folder() + "/docs/serve.md");
  std::string script;
  bool inside = false;
  for (std::string line; std::getline(in, line);) {
    if (line.starts_with("```"))
      inside = line == "```python";
    else if (inside)
      script += line + "\n";
  }
  CHECK(std::ranges::count(script, '\n') <= 45);
  place.write("serve.py", script);
  std::string spot = still_life().click_on("apple");
  spot[spot.find(',')] = ' ';
  place.write("python.sh",
              "python3 serve.py " + still_life().scene + " " + spot + " " + splatcut_program() + "\n");
  const Result result = place.run_program("/bin/bash", "python.sh");
  CHECK_MESSAGE(result.code == 0, result.err);
  CHECK(result.out.find("20000 Gaussians in the scene") != std::string::npos);
  CHECK(result.out.find("rows of 20000 are the object's") != std::string::npos);
  CHECK(place.text("preview.png").starts_with("\x89PNG"));
  CHECK(place.text("object.ply").starts_with("ply"));
}

TEST_CASE("serve says where what was said first has fewer meanings than the one asked for") {
  int fewer = 0;
  for (const char* thing : {"apple", "mug", "orange", "plant", "books"}) {
    const Said said = talk({opened(), click_on(thing), request("choice", {{"choice", 3}})});
    const json& reply = said.replies.at(2);
    REQUIRE(reply["ok"]);
    const bool is_fewer = !reply.contains("choices") || reply["choices"] < 3;
    CHECK((reply["doubts"].dump().find("what was said first can mean") != std::string::npos) == is_fewer);
    fewer += is_fewer;
  }
  CHECK(fewer > 0);
}
