// The window and the table of formats: axes of a .spz, exports in every format.
#include <doctest/doctest.h>

#include <chrono>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <thread>

#include "hands.h"
#include "scene/cloud/scene_memory.h"
#include "scene_file_helpers.h"
#include "synthetic_cloud.h"

using namespace splatcut;
using namespace splatcut::testing;

namespace {

// The sample as a .spz that says nothing of its axes, without cameras beside it.
fs::path unsaid_sample(const Folder& folder) {
  const fs::path path = folder / "sample.spz";
  save_scene(path, load_scene(kSample), {}, SceneFormat::kSpz);
  std::string plain = gunzip(text_of(path));
  plain[14] = 0;  // the flags
  write(path, gzip(plain));
  return path;
}

}  // namespace

TEST_CASE("formats: of a level of detail it is only said to fit the memory if it does") {
  const SceneLevels levels{{20'000'000, 5'000'000}, 0};
  const std::uint64_t coarse = memory_of_scene(5'000'000, 0);
  CHECK(remark_on_level(levels, 1, coarse).find("the finest that the free memory holds") !=
        std::string::npos);
  const std::string tight = remark_on_level(levels, 1, coarse - 1);
  CHECK(tight.find("the coarsest: it takes") != std::string::npos);
  CHECK(tight.find("holds") == std::string::npos);
  CHECK(remark_on_level(levels, 0, {}) ==
        "Level of detail 0 of 2 is read, 0 the finest. View has the others");
}

TEST_CASE(
    "formats: the window says which axes it took of a .spz, takes the other, and saved work keeps them") {
  const Folder folder;
  HeadlessApp app(1100, 760);
  const fs::path path = unsaid_sample(folder);
  app.open(path);
  REQUIRE(app.settle());
  const auto scene = [&]() -> const Scene& { return *app.studio().scene()->scene; };
  CHECK(scene().taken_axes == SpzAxes::kRub);
  const glm::vec3 first = scene().cloud.position[0];
  app.studio().apply(OpenScene{path, SpzAxes::kPly});
  REQUIRE(app.settle());
  CHECK(scene().taken_axes == SpzAxes::kPly);
  CHECK(std::ranges::any_of(scene().cloud.position,
                            [&](const glm::vec3& p) { return p == glm::vec3(first.x, -first.y, -first.z); }));
  const fs::path work = folder / "turned.splatcut.json";
  app.studio().apply(SaveWork{work});
  REQUIRE(app.settle());
  app.open(path);
  REQUIRE(app.settle());
  CHECK(scene().taken_axes == SpzAxes::kRub);
  app.open(work);
  REQUIRE(app.settle());
  CHECK(scene().taken_axes == SpzAxes::kPly);
  app.press_item("side/scroll", {"View"});
  const fs::path cameras = kSampleFolder / "cameras.json";
  app.studio().apply(OpenScene{.path = path, .spz_axes = SpzAxes::kPly, .cameras = cameras, .camera = "2"});
  REQUIRE(app.settle());
  app.press_item("side/scroll", {"Take the other axes"});
  REQUIRE(app.settle());
  CHECK(scene().taken_axes == SpzAxes::kRub);
  CHECK(app.studio().scene()->files.front().cameras == cameras);
  CHECK(app.studio().scene()->files.front().camera == "2");
  // With work that is not saved it asks first, and then still takes the other axes.
  app.studio().apply(EditSelection{SelectionEdit::kAll});
  REQUIRE(app.settle());
  app.press_item("side/scroll", {"Take the other axes"});
  REQUIRE(app->interface().dialog_open());
  CHECK(scene().taken_axes == SpzAxes::kRub);
  app.press_item("###open_anyway", {"Open"});
  REQUIRE(app.settle());
  CHECK(scene().taken_axes == SpzAxes::kPly);
}

TEST_CASE(
    "formats: of levels of detail the finest that memory holds is opened and said, another one can be had") {
  const Folder folder;
  for (const auto& [name, gaussians] : {std::pair{"0.sog", 2000u}, {"1.sog", 200u}}) {
    Scene piece;
    piece.cloud = random_cloud(gaussians, 3, 1);
    save_scene(folder / name, piece, {}, SceneFormat::kSog);
  }
  const fs::path path = folder / "scene.lcc2";
  write(
      path,
      R"({"totalSplats": 2200, "totalLevels": 2, "lodSplats": [2000, 200], "root": {"splatFiles": ["0.sog", "1.sog"],
      "child": [{"data": {"3dgs": {"name": 1}}, "child": [{"data": {"3dgs": {"name": 0}}}]}]}})");
  HeadlessApp app(1100, 760);
  app.open(folder.path);
  REQUIRE(app.settle());
  const auto gaussians = [&] { return app.studio().scene()->cloud->size(); };
  CHECK(gaussians() == 2000);
  const auto said = [&](std::string_view part) {
    return std::ranges::any_of(app.studio().messages(), [&](const Message& message) {
      return message.text.find(part) != std::string::npos;
    });
  };
  CHECK(said("Level of detail 0 of 2 is read"));
  app.press_item("side/scroll", {"View"});
  app.press_item("side/scroll", {"##detail"});
  app.press_item("##Combo_00", {"1: 200 Gaussians, 0.0 GB"});
  REQUIRE(app.settle());
  CHECK(gaussians() == 200);
  const fs::path work = folder / "coarse.splatcut.json";
  app.studio().apply(SaveWork{work});
  REQUIRE(app.settle());
  app.open(path);
  REQUIRE(app.settle());
  CHECK(gaussians() == 2000);
  app.open(work);
  REQUIRE(app.settle());
  CHECK(gaussians() == 200);
}

TEST_CASE(
    "formats: cameras of another scene beside an export that says its up are left out without a toast") {
  const ScratchFolder folder("others_cameras");
  std::filesystem::copy_file(kSampleFolder / "cameras.json", folder / "cameras.json");
  Hands hands;
  ExportRequest request{ExportWhat::kObject, SceneFormat::kPly, folder / "apple.ply"};
  request.placement.up = ExportUp::kPlusZ;
  hands.studio().apply(Export{request});
  REQUIRE(hands.app.settle());
  hands.studio().apply(OpenScene{folder / "apple.ply"});
  REQUIRE(hands.app.settle());
  CHECK(hands.studio().scene()->views().cameras.empty());
  for (const Message& m : hands.studio().messages()) CHECK(m.text.find("otherwise") == std::string::npos);
  CHECK(hands.studio().why_not(Action::kNextCamera).find("not its own") != std::string::npos);
}

TEST_CASE("formats: a file of cameras that holds none is said, and hinders nothing") {
  const ScratchFolder folder("no_cameras");
  std::filesystem::copy_file(kSmallSample, folder / "s.compressed.ply");
  std::ofstream(folder / "cameras.json") << R"({"a": 1})";
  Hands hands(false, with_kept_scenes(), folder / "s.compressed.ply");
  REQUIRE(hands.studio().scene());
  CHECK(std::ranges::any_of(hands.studio().messages(), [](const Message& m) {
    return m.text.find("No cameras were read from cameras.json") != std::string::npos;
  }));
  std::filesystem::copy_file(kSampleFolder / "cameras.json", folder / "cameras.json",
                             std::filesystem::copy_options::overwrite_existing);
  std::filesystem::create_directory_symlink("sparse", folder / "sparse");  // leads to itself
  hands.app.open(folder / "s.compressed.ply");
  REQUIRE(hands.app.settle());
  CHECK_FALSE(hands.studio().scene()->views().cameras.empty());
  std::filesystem::remove(folder / "cameras.json");
  hands.app.open(folder / "s.compressed.ply");
  REQUIRE(hands.app.settle());
  CHECK(hands.studio().scene()->views().cameras.empty());
}

TEST_CASE("formats: a scene on a map is worked on near 0, 0, 0, with its cameras, and exported on the map") {
  const Folder folder;
  constexpr glm::dvec3 kMap{500000, 100, 4500000};
  const auto save_at = [&](const char* name, const glm::dvec3& place, unsigned seed) {
    Scene scene;
    scene.cloud = random_cloud(300, seed, 1);
    scene.origin = place;
    save_scene(folder / name, scene, {}, SceneFormat::kPly);
    return folder / name;
  };
  const fs::path first = save_at("a.ply", kMap, 3), second = save_at("b.ply", kMap + glm::dvec3(8, 0, 0), 4);
  write(
      folder / "cameras.json",
      R"([{"img_name": "a", "width": 96, "height": 72, "fx": 90, "fy": 90, "position": [500000.25, 100, 4499995],
             "rotation": [[1, 0, 0], [0, 1, 0], [0, 0, 1]]}])");
  HeadlessApp app(1100, 760);
  Studio& studio = app.studio();
  app.open(first);
  REQUIRE(app.settle());
  const glm::dvec3 origin = studio.scene()->scene->origin;
  REQUIRE(glm::length(origin - kMap) < 2);
  REQUIRE(studio.scene()->views().cameras.size() == 1);
  CHECK(glm::length(glm::dvec3(studio.scene()->views().cameras[0].centre_world()) + origin -
                    glm::dvec3(500000.25, 100, 4499995)) < 1e-5);
  studio.apply(AddScene{second});
  REQUIRE(app.settle());
  CHECK(studio.scene()->scene->origin == origin);
  const auto all = [&] { return studio.scene()->cloud->position; };
  const std::vector<glm::vec3> both = all();
  // Without the first file, and from saved work, it stays where it was.
  studio.apply(RemoveScene{studio.scene()->files.back().id});
  studio.apply(AddScene{second});
  REQUIRE(app.settle());
  const fs::path work = folder / "map.splatcut.json";
  studio.apply(SaveWork{work});
  REQUIRE(app.settle());
  app.open(work);
  REQUIRE(app.settle());
  CHECK(all() == both);
  CHECK(studio.scene()->scene->origin == origin);
  ExportRequest request;
  request.what = ExportWhat::kScene;
  request.path = folder / "out.ply";
  studio.apply(Export{request});
  request.path = folder / "middle.ply";
  request.placement.origin = ExportOrigin::kCentre;
  studio.apply(Export{request});
  REQUIRE(app.settle());
  const Scene out = load_scene(folder / "out.ply", {.origin = origin});
  REQUIRE(out.cloud.size() == 600);
  CHECK(out.cloud.position == both);
  CHECK(text_of(folder / "out.ply").find("property double x") != std::string::npos);
  CHECK(text_of(folder / "middle.ply").find("property float x") != std::string::npos);
  CHECK(load_scene(folder / "middle.ply").origin == glm::dvec3(0));
}

TEST_CASE("formats: every written format can be exported, with its ending, and loads again") {
  const Folder folder;
  HeadlessApp app(1100, 760);
  REQUIRE(cut_out_apple(app));
  for (const SceneFormat& format : both_ways()) {
    CAPTURE(format.name);
    ExportRequest request;
    request.format = format;
    request.path = with_extension(folder / "apple.ply", format);
    app.studio().apply(Export{request});
    REQUIRE(app.settle());
    const Scene got = load_scene(request.path);
    CHECK(got.format == format);
    CHECK(got.cloud.size() == app.studio().gaussians_of(app.studio().document().active));
  }
}

TEST_CASE("formats: objects whose names become the same file are exported beside each other") {
  const Folder folder;
  std::set<std::string> taken;
  for (const auto& [name, file] : {std::pair{"mug", "mug"},
                                   {"mug_2", "mug_2"},
                                   {"mug", "mug_3"},
                                   {"\u00fc", "\u00fc"},
                                   {"a/b", "a_b"},
                                   {"a:b", "a_b_2"},
                                   {"", "object"}})
    CHECK(free_file_name(name, &taken) == file);

  const Scene scene = load_scene(kSample);
  Document document;
  for (const std::size_t gaussians : {10u, 20u, 30u}) {
    ObjectItem& object = add_object(&document);
    object.name = "mug";
    std::vector<std::uint8_t> hand(scene.cloud.size(), 0);
    std::fill_n(hand.begin() + static_cast<std::ptrdiff_t>(100 * gaussians), gaussians, kHandObject);
    object.hand = make_flags(std::move(hand));
  }
  const ExportReport report = run_export(
      scene, document, 0, {.what = ExportWhat::kAllObjects, .path = folder / "all", .overwrite = true});
  CHECK(report.files == 3);
  for (const auto& [file, gaussians] : {std::pair{"mug.ply", 10u}, {"mug_2.ply", 20u}, {"mug_3.ply", 30u}})
    CHECK(load_scene(folder / "all" / file).cloud.size() == gaussians);
}

TEST_CASE(
    "formats: all objects in one file say whose each Gaussian is, the last one's where several have it") {
  const Folder folder;
  const Scene scene = load_scene(kSample);
  Document document;
  for (const std::ptrdiff_t from : {0, 20, 5000}) {
    std::vector<std::uint8_t> hand(scene.cloud.size(), 0);
    std::fill_n(hand.begin() + from, 30, kHandObject);
    add_object(&document).hand = make_flags(std::move(hand));
  }
  ExportRequest request{.what = ExportWhat::kOneFile, .path = folder / "objects.ply"};
  const ExportReport report = run_export(scene, document, 0, request);
  CHECK(report.gaussians == 80);
  CHECK(report.loss.find("which object") == std::string::npos);
  CHECK(load_scene(request.path).cloud.size() == 80);
  std::ifstream in(request.path, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(in), {}};
  CHECK(bytes.find("property uchar object_id\n") != std::string::npos);
  const std::size_t rows = bytes.find("end_header\n") + 11, row = (bytes.size() - rows) / 80;
  std::map<int, int> of;
  for (std::size_t g = 0; g < 80; ++g) ++of[static_cast<unsigned char>(bytes[rows + (g + 1) * row - 1])];
  CHECK(of == std::map<int, int>{{1, 20}, {2, 30}, {3, 30}});
  const auto names = nlohmann::json::parse(std::ifstream(folder / "objects.json"));
  CHECK(names["objects"][1] == nlohmann::json{{"object_id", 2}, {"name", "Object 2"}});
  CHECK_THROWS_AS(run_export(scene, document, 0, request), Error);  // it is there
  request.format = SceneFormat::kSplat;
  request.path = folder / "objects.splat";
  CHECK(run_export(scene, document, 0, request).loss.find("which object") != std::string::npos);
}

TEST_CASE(
    "formats: a file that is added while another is being taken out comes, and what is opened then, too") {
  const Folder folder;
  Scene small;
  small.cloud = random_cloud(300, 3, 1);
  for (const char* name : {"a.ply", "b.ply"}) save_scene(folder / name, small, {}, SceneFormat::kPly);
  HeadlessApp app(1100, 760);
  Studio& studio = app.studio();
  app.open(folder / "a.ply");
  REQUIRE(app.settle());
  studio.apply(AddScene{folder / "b.ply"});
  REQUIRE(app.settle());
  const auto taken_out = [&] {  // what it comes to waits for update() when the next is asked for
    studio.apply(RemoveScene{studio.scene()->files.back().id});
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
  };
  taken_out();
  studio.apply(AddScene{kSample});
  REQUIRE(app.settle());
  REQUIRE(studio.scene()->files.size() == 2);
  CHECK(studio.scene()->files.back().path == kSample);
  taken_out();
  studio.apply(OpenScene{kSample});
  REQUIRE(app.settle());
  REQUIRE(studio.scene()->files.size() == 1);
  CHECK(studio.scene()->files.front().path == kSample);
}

TEST_CASE("formats: the axis that points up in a file is shown as it was written") {
  const Folder folder;
  HeadlessApp app(1100, 760);
  app.open(kSmallSample);
  REQUIRE(app.settle());
  for (const char* name : {"up.spz", "up.ply", "up.glb"}) {
    CAPTURE(std::string(name));
    ExportRequest request;
    request.path = folder / name;
    request.format = *find_format(request.path);
    request.placement.up = ExportUp::kPlusZ;
    app.open(kSmallSample);
    REQUIRE(app.settle());
    app.studio().apply(EditSelection{SelectionEdit::kAll});
    app.studio().apply(Export{request});
    REQUIRE(app.settle());
    REQUIRE(fs::exists(request.path));
    HeadlessApp again(1100, 760);
    again.open(request.path);
    REQUIRE(again.settle());
    const glm::vec3 up = again.studio().document().up_world;
    again.press_item("side/scroll", {"View"});
    again.press_item("side/scroll", {"+Z"});  // is so already
    REQUIRE(again.settle());
    CHECK(glm::dot(again.studio().document().up_world, up) > 0.999f);
  }
}
