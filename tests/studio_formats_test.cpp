// The window and the table of formats: axes of a .spz, exports in every format.
#include <doctest/doctest.h>

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
  write(path, gzip(plain.substr(0, plain.size() - 12)));
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
  app.click({831, 286});  // opens the section View
  app.frames(3);
  app.click({941, 482});  // "Take the other axes"
  REQUIRE(app.settle());
  CHECK(scene().taken_axes == SpzAxes::kRub);
  // With work that is not saved it asks first, and then still takes the other axes.
  app.studio().apply(EditSelection{SelectionEdit::kAll});
  REQUIRE(app.settle());
  app.click({941, 547});  // the button, below the object now
  app.frames(3);
  REQUIRE(app->interface().dialog_open());
  CHECK(scene().taken_axes == SpzAxes::kRub);
  app.click({550 + 215 - 62, 380 + 75 - 28});  // Open
  REQUIRE(app.settle());
  CHECK(scene().taken_axes == SpzAxes::kPly);
}

TEST_CASE("formats: every written format can be exported, with its ending, and loads again") {
  const Folder folder;
  HeadlessApp app(1100, 760);
  REQUIRE(cut_out_apple(app));
  for (const SceneFormat& format : written_formats()) {
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
