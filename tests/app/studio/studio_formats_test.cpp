// The window and the table of formats: axes of a .spz, exports in every format.
#include <doctest/doctest.h>

#include <set>

#include "headless_app.h"
#include "scene_file_helpers.h"

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
  app.press_item("side/scroll", {"Take the other axes"});
  REQUIRE(app.settle());
  CHECK(scene().taken_axes == SpzAxes::kRub);
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
                                   {"\u00fc", "__"},
                                   {"\u00e9", "___2"},
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
