// The table of formats, and every format against every other.
#include "scene/formats/scene_formats.h"

#include <set>

#include "places.h"
#include "scene/formats/losses.h"
#include "scene_file_helpers.h"

using namespace splatcut;
using namespace splatcut::testing;

TEST_CASE("formats: names differ, every extension finds its row, lists follow from the rows") {
  std::set<std::string> names, extensions;
  for (const SceneFormat& format : scene_formats()) {
    CAPTURE(format.name);
    CHECK(names.insert(format.name).second);
    CHECK(extensions.insert(format.extension).second);
    const bool is_read = format.read != nullptr, is_written = format.write != nullptr;
    CHECK((is_read || is_written));
    CHECK(is_written == (format.plan != nullptr));
    std::string name = "some.scene" + std::string(format.extension);
    REQUIRE(find_format(name));
    CHECK(*find_format(name) == format);
    for (char& c : name) c = static_cast<char>(std::toupper(c));
    REQUIRE(find_format(name));
    CHECK(*find_format(name) == format);
    if (is_read)
      CHECK(input_format_from_name(name) == format);
    else
      CHECK_THROWS_AS(input_format_from_name(name), Error);
  }
  const std::vector<SceneFormat> three = {SceneFormat::kPly, SceneFormat::kCompressedPly, SceneFormat::kSpz};
  CHECK(spoken_extensions(three, "or") == ".ply, .compressed.ply or .spz");
  CHECK(extensions_of(three) == std::vector<std::string>{".ply", ".spz"});
  CHECK(names_of(three) == std::vector<std::string>{"ply", "compressed.ply", "spz"});
  CHECK(with_extension("/a/b.compressed.ply", SceneFormat::kSpz) == "/a/b.spz");
  CHECK(with_extension("b.2.ply", SceneFormat::kCompressedPly) == "b.2.compressed.ply");
  CHECK(with_extension("b.c", SceneFormat::kPly) == "b.c.ply");
  CHECK(with_extension("b.gltf", SceneFormat::kGlb) == "b.glb");
  CHECK_FALSE(has_scene_extension("scene.png"));
  CHECK(output_format_from_name("b.GLB") == SceneFormat::kGlb);
  CHECK(input_format_from_name("b.gltf") == SceneFormat::kGlb);
  CHECK(input_format_from_name("a/meta.json") == SceneFormat::kSog);
  CHECK(input_format_from_name("a/lod-meta.json") == SceneFormat::kStreamedSog);
  for (const char* read_only : {"b.gltf", "meta.json", "lod-meta.json", "b.ksplat", "b.png"})
    CHECK_THROWS_AS(output_format_from_name(read_only), Error);
}

TEST_CASE("formats: that an extension is unknown is said with every ending that is read") {
  std::string says;
  try {
    input_format_from_name("scene.blend");
  } catch (const Error& error) {
    says = error.what();
  }
  CHECK(says.find("the file extension is none of .ply, ") != std::string::npos);
  for (const char* ending : {".glb", ".gltf", ".ksplat", ".sog"}) {
    CAPTURE(ending);
    CHECK(says.find(ending) != std::string::npos);
  }
}

TEST_CASE("formats: every reader has a case that runs under the sanitizers") {
  const std::string labels = text_of(project_folder() + "/tests/quick_tests.cmake");
  for (const SceneFormat& format : read_formats())
    CHECK_MESSAGE(labels.find('"' + std::string(format.name) + '"') != std::string::npos, format.name);
}

TEST_CASE("losses: the share of Gaussians beyond the range of bytes is said, rounding alone is not") {
  const Folder folder;
  Scene scene;
  scene.cloud = varied_cloud(1000, 1);
  for (std::size_t g = 0; g < 1000; ++g) {
    scene.cloud.f_dc[g] = g < 250 ? glm::vec3(0, 1.9f, 0) : glm::vec3(1.7f);  // colour 1.036, and 0.98
    if (g < 30) scene.cloud.f_dc[g] = glm::vec3(0, 0, -3.4f);                 // beyond -0.5 / 0.15
    if (g < 5) scene.cloud.scale[g].y = 1e-6f;                                // exp(-10) is the smallest
  }
  scene.up = glm::vec3(0, -1, 0);                   // a plan is made where up is known
  for (float& v : scene.cloud.sh_rest) v = 0.995f;  // within half a step of 127/128
  scene.cloud.sh_rest[9 * 7] = -1.2f;
  const auto lost = [&](const char* name) {
    const SceneFormat format = output_format_from_name(name);
    const std::string sentence = save_scene(folder / name, scene, {}, format).loss;
    std::string planned = format.plan(scene, all_gaussians(scene.cloud), false)
                              .lost;  // the same words, as a sentence of its own
    if (!planned.empty()) {
      planned.pop_back();
      planned[0] = static_cast<char>(std::tolower(planned[0]));
    }
    CHECK(planned == sentence);
    return sentence;
  };
  CHECK(mentions(lost("a.splat"),
                 {"degree 1 are dropped", "the colours of 25.0 % of the Gaussians", "clamped"}));
  const std::string spz = lost("a.spz");
  CHECK(mentions(
      spz, {"24 bits", "the colours of 3.0 %", "the sizes of 0.5 %", "the spherical harmonics of 0.1 %"}));
  CHECK(spz.find("antialiasing") == spz.npos);
  CHECK(lost("a.compressed.ply").find("clamped") == std::string::npos);
  CHECK(lost("a.ply").empty());
  scene.cloud.antialiased = true;
  for (const char* name : {"a.splat", "a.glb", "a.usda"})
    CHECK(mentions(lost(name), {"antialiasing is left out"}));
  for (const char* name : {"a.ply", "a.compressed.ply", "a.spz", "a.sog"})
    CHECK(lost(name).find("antialiasing") == std::string::npos);
  std::vector<std::uint8_t> keep(1000, 0);
  keep[400] = keep[401] = 1;  // of those written only
  CHECK(save_scene(folder / "b.splat", scene, keep, SceneFormat::kSplat).loss.find("clamped") ==
        std::string::npos);
  const std::vector<std::uint32_t> two = {400, 401};
  CHECK(SceneFormat::kSplat.plan(scene, two, false).lost.find("clamped") == std::string::npos);
}

TEST_CASE("plans: nothing is said to be kept in full beside what is lost") {
  Scene scene;
  scene.cloud = varied_cloud(10, 1);
  scene.other_properties = {"mask"};
  scene.cloud.antialiased = true;
  for (const SceneFormat& format : written_formats()) {
    const FormatPlan plan = format.plan(scene, all_gaussians(scene.cloud), false);
    CAPTURE(format.name);
    CHECK_FALSE(plan.lost.empty());
    CHECK(plan.kept.find("Everything") == std::string::npos);
  }
}
