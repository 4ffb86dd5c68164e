// `splatcut convert`: every format that is written, and the endings that are not.
#include <doctest/doctest.h>

#include <nlohmann/json.hpp>

#include "program_runner.h"
#include "scene/formats/scene_file.h"
#include "synthetic_cloud.h"

using namespace splatcut;
using namespace splatcut::testing;
using nlohmann::json;

TEST_CASE("convert goes through every format and back, and says what is lost") {
  const Workplace place;
  REQUIRE(place.run("make-scene lit -o lit --gaussians 5000 --sh-degree 3").code == 0);
  std::string from = "lit/lit.ply";
  for (const std::string name : {"a.ply", "a.glb", "a.spz", "a.compressed.ply", "a.sog", "a.splat"}) {
    CAPTURE(name);
    const Result result = place.run("convert " + from + " -o " + name);
    REQUIRE_MESSAGE(result.code == 0, result.err);
    CHECK((result.out.find("Lost:") != std::string::npos) == (name != "a.ply" && name != "a.glb"));
    const json info = json::parse(place.run("info " + name + " --json").out);
    CHECK(info["gaussians"] == 5000);
    CHECK(info["sh_degree"] == (name == "a.splat" ? 0 : 3));
    REQUIRE(place.run("convert " + name + " -o back_" + name + ".ply").code == 0);
    CHECK(json::parse(place.run("info back_" + name + ".ply --json").out)["gaussians"] == 5000);
    from = name;
  }
  CHECK(place.text("a.ply") == place.text("lit/lit.ply"));

  // Version 4; axes against what the file says, which only the user may ask for.
  REQUIRE(place.run("convert a.ply -o four.spz --spz-version 4").code == 0);
  CHECK(place.text("four.spz").starts_with("NGSP"));
  const auto highest = [&](const std::string& options) {
    return json::parse(place.run("info four.spz --json " + options).out)["bounds_98"]["max"][1].get<float>();
  };
  const float lowest =
      json::parse(place.run("info four.spz --json --spz-axes rub").out)["bounds_98"]["min"][1].get<float>();
  CHECK(highest("") == highest("--spz-axes rub"));
  CHECK(highest("--spz-axes ply") == doctest::Approx(-lowest).epsilon(1e-3));
  CHECK(place.run("info four.spz --spz-axes up").code == 1);
  CHECK(place.run("convert a.ply -o five.spz --spz-version 5").code == 1);
  for (const char* other :
       {"convert a.ply -o b.splat --spz-version 4", "merge a.ply a.spz -o b.ply --spz-version 3",
        "info a.ply --spz-axes rub", "merge a.ply a.splat -o b.ply --spz-axes ply"}) {
    const Result refused = place.run(other);
    CHECK_MESSAGE(refused.code == 1, other);
    CHECK_MESSAGE(refused.err.find("is no .spz") != std::string::npos, refused.err);
  }
  CHECK(place.run("merge a.ply a.spz -o b.ply --spz-axes ply").code == 0);
  CHECK(place.leftovers().empty());
}

TEST_CASE("convert refuses an ending that it reads but does not write, and lists what it writes") {
  const Workplace place;
  Scene scene;
  scene.cloud = random_cloud(50, 5, 0, 0.3f);
  save_scene(place / "scene.ply", scene, {}, SceneFormat::kPly);
  for (const std::string name : {"a.ksplat", "a.gltf", "meta.json", "lod-meta.json", "a.obj", "a"}) {
    CAPTURE(name);
    const Result result = place.run("convert scene.ply -o " + name);
    CHECK(result.code == 1);
    CHECK(result.err.find("Choose .ply, .compressed.ply, .splat, .spz, .sog, .glb or .usda.") !=
          std::string::npos);
    const bool read = name != "a.obj" && name != "a";
    CHECK((result.err.find("only read, not written") != std::string::npos) == read);
    CHECK_FALSE(place.exists(name));
  }
}
