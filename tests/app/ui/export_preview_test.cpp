// The export dialog's picture of what is written: as it looks, at the side or small beside the numbers, and
// the folder that the dialog begins in.
#include <doctest/doctest.h>

#include <cmath>
#include <filesystem>
#include <string>

#include "app/window/settings.h"
#include "hands.h"
#include "scene/formats/scene_file.h"

using namespace splatcut;
using namespace splatcut::testing;

namespace {

// White splats that cover a ball, on a spiral, and black ones within it that nothing shows.
Scene white_ball_dark_within() {
  constexpr std::size_t kShell = 6000, kWithin = 6000;
  Scene scene;
  scene.cloud.resize(kShell + kWithin, 0);
  for (std::size_t g = 0; g < kShell + kWithin; ++g) {
    const bool shell = g < kShell;
    const float t = (static_cast<float>(shell ? g : g - kShell) + 0.5f) / kShell, z = 1 - 2 * t,
                round = std::sqrt(1 - z * z), turn = 2.39996f * static_cast<float>(g);
    scene.cloud.position[g] =
        (shell ? 1.0f : 0.8f) * glm::vec3(round * std::cos(turn), round * std::sin(turn), z);
    scene.cloud.scale[g] = glm::vec3(0.05f);
    scene.cloud.opacity[g] = 0.99f;
    scene.cloud.rotation[g] = glm::quat(1, 0, 0, 0);
    scene.cloud.f_dc[g] = glm::vec3(shell ? 1.7f : -1.7f);
    scene.cloud.file_row[g] = static_cast<std::uint32_t>(g);
  }
  scene.file_rows = scene.cloud.size();
  return scene;
}

void open_export(HeadlessApp& app) {
  app.key('E', {.ctrl = true});
  app.frames(3);
  REQUIRE(app.interface_state().export_open);
}

}  // namespace

TEST_CASE(
    "export preview: what lies within an object and is not seen is not shown, in windows of three sizes") {
  const ScratchFolder folder("export_preview");
  save_scene(folder / "ball.ply", white_ball_dark_within(), {}, SceneFormat::kPly);
  for (const glm::ivec2& size : {glm::ivec2(640, 480), {800, 600}, {1360, 840}}) {
    CAPTURE(size.x);
    HeadlessApp app(size.x, size.y);
    app.open(folder / "ball.ply");
    REQUIRE(app.settle());
    open_export(app);
    const ExportPreview& preview = app.interface_state().export_preview;
    REQUIRE(preview.picture.width() >= 100);
    CHECK_FALSE(preview.grips.shown.empty());
    std::size_t white = 0, dark = 0;
    for (const Rgba8& pixel : preview.picture.pixels()) {
      white += pixel[3] > 200 && pixel[0] > 200;
      dark += pixel[3] > 200 && pixel[0] < 100;
    }
    CHECK(white > 300);
    CHECK(dark == 0);
    const std::uint64_t drawn = preview.picture_serial;
    app.frames(5);
    CHECK(preview.picture_serial == drawn);  // nothing moved
    app.interface_state().exporting.placement.turn_deg = 30;
    app.frames(1);
    CHECK(preview.picture_serial == drawn + 1);
    const UiRect dialog = app.window("Export###export");
    CHECK(dialog.max.x <= static_cast<float>(size.x));
    CHECK(dialog.max.y <= static_cast<float>(size.y));
  }
}

TEST_CASE(
    "export preview: the dialog begins in the folder of the last export, of other scenes and starts, too") {
  const ScratchFolder folder("export_folder");
  std::filesystem::create_directories(folder / "out");
  Settings kept;
  const auto begins_in = [](HeadlessApp& app) {
    open_export(app);
    const auto begins = std::filesystem::path(app.interface_state().exporting.path).parent_path();
    app.key(key::kEscape);
    app.frames(2);
    return begins;
  };
  {
    Hands hands(false);
    CHECK(begins_in(hands.app) == kSmallSample.parent_path());
    hands.studio().apply(Export{{ExportWhat::kScene, SceneFormat::kSplat, folder / "out/all.splat"}});
    REQUIRE(hands.app.settle());
    hands.studio().apply(OpenScene{kSample});
    REQUIRE(hands.app.settle());
    CHECK(begins_in(hands.app) == folder / "out");
    kept = settings_of(*hands.app, kept);
  }
  Hands again(false);
  use_settings(kept, &*again.app);
  CHECK(begins_in(again.app) == folder / "out");
  std::filesystem::remove_all(folder / "out");
  CHECK(begins_in(again.app) == kSmallSample.parent_path());
  // What was exported beside its own scene is no reason to put another scene's there, too.
  std::filesystem::create_directories(folder / "one");
  const std::filesystem::path scene = folder / "one" / kSmallSample.filename();
  std::filesystem::copy_file(kSmallSample, scene);
  again.studio().apply(OpenScene{scene});
  REQUIRE(again.app.settle());
  again.studio().apply(Export{{ExportWhat::kScene, SceneFormat::kSplat, folder / "one/all.splat"}});
  REQUIRE(again.app.settle());
  CHECK(begins_in(again.app) == folder / "one");
  again.studio().apply(OpenScene{kSample});
  REQUIRE(again.app.settle());
  CHECK(begins_in(again.app) == kSample.parent_path());
}
