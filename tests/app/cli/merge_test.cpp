// splatcut merge, run in folders of its own. What a merged scene holds:
// tests/scene/formats/merged_scene_test.cpp.
#include <doctest/doctest.h>

#include <nlohmann/json.hpp>

#include "program_runner.h"
#include "scene/formats/scene_file.h"
#include "small_still_life.h"
#include "synthetic_cloud.h"

using namespace splatcut;
using namespace splatcut::testing;
using nlohmann::json;

namespace {

void save(const Workplace& place, const std::string& name, GaussianCloud cloud) {
  Scene scene;
  scene.file_rows = cloud.size();
  scene.cloud = std::move(cloud);
  save_scene(place / name, scene, {}, output_format_from_name(name), {4});  // a .spz that says its axes
}

struct Files {
  Workplace place;
  Files() {
    save(place, "a.ply", random_cloud(300, 1, 1));
    save(place, "b.spz", random_cloud(200, 2, 3));
    save(place, "c.splat", random_cloud(100, 3));
  }
};

std::vector<glm::vec3> positions_by_row(const std::filesystem::path& path) {
  const Scene scene = load_scene(path);
  std::vector<glm::vec3> positions(scene.file_rows);
  for (std::size_t g = 0; g < scene.cloud.size(); ++g)
    positions[scene.cloud.file_row[g]] = scene.cloud.position[g];
  return positions;
}

}  // namespace

TEST_CASE("merge writes the Gaussians of all files in their order, says what is lost") {
  const Files files;
  const Workplace& place = files.place;
  const Result result = place.run("merge a.ply b.spz c.splat -o all.ply");
  REQUIRE_MESSAGE(result.code == 0, result.err);
  CHECK(result.err.empty());
  CHECK(
      result.out.starts_with("a.ply: 300 Gaussians\nb.spz: 200 Gaussians\nc.splat: 100 Gaussians\n"
                             "all.ply: 600 Gaussians, "));
  CHECK(result.out.find("Lost:") == std::string::npos);
  const json info = json::parse(place.run("info all.ply --json").out);
  CHECK(info["gaussians"] == 600);
  CHECK(info["sh_degree"] == 3);
  std::vector<glm::vec3> expected;
  for (const char* name : {"a.ply", "b.spz", "c.splat"})
    for (const glm::vec3& position : positions_by_row(place / name)) expected.push_back(position);
  CHECK(positions_by_row(place / "all.ply") == expected);

  const Result lossy = place.run("merge c.splat a.ply -o two.splat");
  REQUIRE(lossy.code == 0);
  CHECK(lossy.out.find("\nLost: view-dependent colour") != std::string::npos);
  CHECK(place.run("merge c.splat a.ply -o quiet.splat --quiet").out.empty());
  CHECK(place.text("quiet.splat") == place.text("two.splat"));
  CHECK(place.run("merge a.ply c.splat -o four.spz --spz-version 4").code == 0);
  CHECK(place.text("four.spz").starts_with("NGSP"));
  CHECK(place.leftovers().empty());
}

TEST_CASE("merge puts together what a cut took apart: the same picture") {
  const StillLife& life = still_life();
  const Workplace& place = life.place;
  REQUIRE(place.run(life.cut("--click " + life.click + " --edges keep -o apart")).code == 0);
  REQUIRE(place.run("merge apart/rest.ply apart/object.ply -o together.ply").code == 0);
  CHECK(load_scene(place / "together.ply").cloud.size() == load_scene(place / life.scene).cloud.size());
  for (const auto& [scene, picture] :
       {std::pair<std::string, std::string>{life.scene, "whole.png"}, {"together.ply", "together.png"}})
    REQUIRE(place.run("render " + scene + " " + life.camera + " -o " + picture).code == 0);
  CHECK(place.run("compare whole.png together.png --max-diff 1 --pixels 0.01").code == 0);
}

TEST_CASE("merge does not depend on --threads") {
  const Files files;
  const Workplace& place = files.place;
  for (const char* ending : {".ply", ".compressed.ply", ".sog"}) {
    for (const char* threads : {"1", "3"})
      REQUIRE(place.run(std::string("merge a.ply b.spz -o on_") + threads + ending + " --threads " + threads)
                  .code == 0);
    CHECK(place.text(std::string("on_1") + ending) == place.text(std::string("on_3") + ending));
  }
}

TEST_CASE("merge: one bad file, a bad name or a file that is there: a sentence, nothing written") {
  const Files files;
  const Workplace& place = files.place;
  place.write("short.ply", place.text("a.ply").substr(0, 20000));
  place.write("there.ply", "precious");
  const auto refused = [&](const std::string& arguments, std::initializer_list<const char*> parts) {
    const Result result = place.run("merge " + arguments);
    CAPTURE(arguments);
    CAPTURE(result.err);
    CHECK(result.code == 1);
    CHECK(result.out.empty());
    CHECK(result.err.starts_with("splatcut: "));
    CHECK(result.err.ends_with(".\n"));
    for (const char* part : parts) CHECK(result.err.find(part) != std::string::npos);
    CHECK_FALSE(place.exists("out.ply"));
  };
  refused("a.ply none.ply -o out.ply", {"none.ply", "No such file"});
  refused("none.ply a.ply -o out.ply", {"none.ply", "No such file"});
  refused("a.ply b.spz short.ply -o out.ply", {"short.ply", "truncated"});
  refused("a.ply short.ply -o there.ply --overwrite", {"short.ply", "truncated"});
  refused("a.ply b.spz -o there.ply", {"there.ply", "--overwrite"});
  refused("a.ply b.spz -o out.ksplat", {"only read, not written"});
  refused("a.ply b.spz -o nowhere/out.ply", {"nowhere/out.ply"});
  CHECK(place.text("there.ply") == "precious");
  for (const char* usage : {"merge", "merge -o out.ply", "merge a.ply -o out.ply", "merge a.ply b.spz"})
    CHECK_MESSAGE(place.run(usage).code == 2, usage);
  CHECK_FALSE(place.exists("out.ply"));
  CHECK(place.leftovers().empty());
}

TEST_CASE("merge: the output is none of the files, whatever is said about overwriting") {
  const Files files;
  const Workplace& place = files.place;
  const std::string before = place.text("a.ply");
  const Result result = place.run("merge c.splat a.ply -o a.ply --overwrite");
  CHECK(result.code == 1);
  CHECK(result.err.find("a.ply: is what is read here") != std::string::npos);
  CHECK(place.text("a.ply") == before);
}

TEST_CASE("merge: a warning names the file that it is about") {
  const Files files;
  const Workplace& place = files.place;
  GaussianCloud faint = random_cloud(50, 4);
  for (float& opacity : faint.opacity) opacity = 0.001f;
  save(place, "faint.ply", faint);
  const Result result = place.run("merge a.ply faint.ply -o out.ply");
  CHECK(result.code == 0);
  CHECK(result.err == "splatcut: warning: faint.ply: all of its Gaussians are too faint to be seen.\n");
}
