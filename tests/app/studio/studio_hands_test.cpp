// What artists' hands know from other tools: keys, cameras, selections, the history, words.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_access.hpp>

#include "app/studio/document_edits.h"
#include "app/studio/words.h"
#include "app/studio/work_file.h"
#include "headless_app.h"
#include "scene/raster/rasterizer.h"
#include "scene/raster/splat_math.h"

using namespace splatcut;
using namespace splatcut::testing;

namespace {

constexpr int kWidth = 900, kHeight = 520;

class Hands {
 public:
  explicit Hands(bool cut = true, ApplicationOptions options = {})
      : app(kWidth, kHeight, 1, std::move(options)) {
    app.interface_state().hint_wanted = false;
    app.open(kSample);
    REQUIRE(app.settle());
    if (!cut) return;
    studio().apply(SetPreset{"fast"});
    app.click(app.screen_of(kOnApple));
    REQUIRE(app.settle());
  }
  Studio& studio() { return app.studio(); }
  std::string said() { return studio().messages().empty() ? "" : studio().messages().back().text; }
  std::size_t selected() { return studio().gaussians_of(studio().document().active); }
  glm::vec2 in_viewport(const glm::vec2& screen) { return screen - app->interface().viewport().min; }
  glm::vec3 under(const glm::vec2& screen) {
    const auto hit = studio().pick(in_viewport(screen));
    REQUIRE(hit);
    return hit->position_world;
  }
  glm::vec2 seen_at(const glm::vec3& world) {
    const Camera camera = studio().viewport_camera();
    return app->interface().viewport().min + camera.pixel_from_camera(camera.camera_from_world(world));
  }
  HeadlessApp app;
};

}  // namespace

TEST_CASE("hands: numbers are written one way, lengths with three figures") {
  CHECK(grouped(999) == "999");
  CHECK(grouped(92440) == "92,440");
  CHECK(grouped(1234567) == "1,234,567");
  CHECK(length_text(0) == "0");
  CHECK(length_text(0.0235f) == "0.0235");
  CHECK(length_text(12.4f) == "12.4");
  CHECK(length_text(1250.4f) == "1,250");
  Hands hands(false);
  CHECK(std::ranges::any_of(hands.studio().messages(), [](const Message& m) {
    return m.text.find("180,") != std::string::npos && m.text.find("Gaussians") != std::string::npos;
  }));
  hands.app.key('A', {.ctrl = true});
  CHECK(hands.said().find("180,") != std::string::npos);
}

TEST_CASE("hands: a held bracket key changes the brush no more than threefold in a second") {
  Hands hands(false);
  hands.app.key('5');
  const float before = hands.studio().view().brush_px;
  hands.app->handle(KeyChanged{']', true, false, {}});
  for (int i = 0; i < 60; ++i) {
    hands.app.frames(1);
    hands.app->handle(KeyChanged{']', true, true, {}});
  }
  hands.app->handle(KeyChanged{']', false, false, {}});
  CHECK(hands.studio().view().brush_px > 1.5f * before);
  CHECK(hands.studio().view().brush_px < 3 * before);
}

TEST_CASE("hands: a new scene begins with the click tool, an ordinary brush and the whole scene") {
  Hands hands;
  ViewState view = hands.studio().view();
  view.tool = Tool::kBrush;
  view.operation = SetOperation::kRemove;
  view.brush_px = kMostBrushPx;
  hands.studio().apply(SetView{view});
  hands.studio().apply(OpenScene{kSample});
  REQUIRE(hands.app.settle());
  CHECK(hands.studio().view().tool == Tool::kClick);
  CHECK(hands.studio().view().operation == SetOperation::kAdd);
  CHECK(hands.studio().view().brush_px <= kMostKeptBrushPx);
}

TEST_CASE("hands: a click while the scene is prepared says what it waits for, and is cut afterwards") {
  HeadlessApp app(kWidth, kHeight);
  app.open(kSample);
  for (int i = 0; i < 5000 && !app.studio().picture(); ++i) app.frames(1);
  REQUIRE(app.studio().picture());
  if (app.studio().prepared()) return;  // a fast machine
  app.studio().apply(SetPreset{"fast"});
  app.click(app.screen_of(kOnApple));
  REQUIRE_FALSE(app.studio().messages().empty());
  CHECK(app.studio().messages().back().text.find("as soon as the scene is prepared") != std::string::npos);
  REQUIRE(app.settle());
  CHECK(app.studio().gaussians_of(app.studio().document().active) > 1000);
}

TEST_CASE("hands: thumbnails follow the history") {
  Hands hands;
  const auto serials = [&] {
    std::vector<std::uint64_t> out;
    const CutRun* run = hands.studio().cut_run(hands.studio().document().active);
    if (run)
      for (const ViewCard& card : run->views) out.push_back(card.serial);
    return out;
  };
  const auto first = serials();
  REQUIRE(first.size() > 1);
  hands.app.click(hands.app.screen_of(kOnOrange));
  REQUIRE(hands.app.settle());
  const auto second = serials();
  REQUIRE(second.size() > 1);
  CHECK(second != first);
  hands.app.key('Z', {.ctrl = true});
  REQUIRE(hands.app.settle());
  CHECK(serials() == first);
  hands.app.key('Z', {.shift = true, .ctrl = true});
  REQUIRE(hands.app.settle());
  CHECK(serials() == second);
  hands.studio().apply(JumpHistory{0});
  REQUIRE(hands.app.settle());
  CHECK(serials().empty());
}

TEST_CASE("hands: with everything undone the whole scene is shown, not an empty object alone") {
  Hands hands;
  hands.app.key('I');
  REQUIRE(hands.studio().view().display == DisplayMode::kIsolate);
  hands.studio().apply(JumpHistory{0});
  hands.app.frames(2);
  CHECK(hands.studio().view().display == DisplayMode::kWhole);
}

TEST_CASE("hands: up by three points draws marks, and computes no object again") {
  Hands hands;
  const std::vector<std::uint8_t> before = hands.studio().labels(hands.studio().document().active);
  hands.app.key('0');
  const glm::vec2 low = hands.app->interface().viewport().min;
  const glm::vec2 ground[] = {low + glm::vec2(200, 330), low + glm::vec2(400, 330),
                              low + glm::vec2(300, 260)};
  for (std::size_t i = 0; i < 2; ++i) {
    hands.app.click(ground[i]);
    CHECK(hands.studio().overlay().points_px.size() == i + 1);
  }
  CHECK(hands.studio().overlay().shape == ToolOverlay::Shape::kPoints);
  CHECK(glm::distance(hands.studio().overlay().points_px.front(), hands.in_viewport(ground[0])) < 1.5f);
  const glm::vec3 up = hands.studio().document().up_world;
  hands.app.click(ground[2]);
  CHECK(hands.studio().document().up_world != up);
  CHECK_FALSE(hands.studio().cutting());
  hands.app.frames(2);
  CHECK_FALSE(hands.studio().cutting());
  REQUIRE(hands.app.settle());
  CHECK(hands.studio().labels(hands.studio().document().active) == before);
}

TEST_CASE("hands: +Z up comes back with the view, and pressed again sets a leaning view upright") {
  const ScratchFolder folder("up");
  Hands hands;
  const auto upright = [&] {
    const glm::vec3 right = glm::row(glm::mat3_cast(hands.studio().camera().pose().camera_from_world), 0);
    return std::abs(glm::dot(right, hands.studio().document().up_world)) < 1e-3f;
  };
  hands.studio().apply(SetUp{{0, 0, 1}});
  REQUIRE(hands.app.settle());
  CHECK(upright());
  const CameraPose pose = hands.studio().camera().pose();
  hands.studio().apply(SaveWork{folder / "up.splatcut.json"});
  REQUIRE(hands.app.settle());
  hands.studio().apply(OpenScene{folder / "up.splatcut.json"});
  REQUIRE(hands.app.settle());
  CHECK(hands.studio().document().up_world == glm::vec3(0, 0, 1));
  CHECK(hands.studio().camera().up_world() == glm::vec3(0, 0, 1));
  CHECK(hands.studio().camera().pose() == pose);
  CameraPose leaning = pose;
  leaning.camera_from_world = glm::angleAxis(0.4f, glm::vec3(0, 0, 1)) * pose.camera_from_world;
  hands.studio().camera().set_pose(leaning);
  REQUIRE_FALSE(upright());
  hands.studio().apply(SetUp{{0, 0, 1}});
  REQUIRE(hands.app.settle());
  CHECK(upright());
}

TEST_CASE("hands: where a click found nothing, one comes nearer") {
  Hands hands;
  const glm::vec3 apple = hands.under(hands.app.screen_of(kOnApple));
  hands.studio().camera().zoom(-8);
  REQUIRE(hands.app.settle());
  const float far = glm::distance(hands.studio().camera().pose().position_world, apple);
  hands.studio().apply(ComeNearer{});
  REQUIRE(hands.app.settle());
  const float near = glm::distance(hands.studio().camera().pose().position_world, apple);
  CHECK(near < 0.4f * far);
  CHECK(glm::distance(hands.seen_at(apple), hands.app->interface().viewport().min +
                                                0.5f * hands.app->interface().viewport().size()) < 30);
}

TEST_CASE("hands: Esc closes a menu before it changes the tool") {
  Hands hands(false);
  hands.app.key('5');
  hands.app.click({kWidth - 316 + 289, 0});  // nothing there
  hands.app.interface_state().recent = {kSample};
  hands.app.frames(2);
  hands.app.click({89, 23});  // the arrow beside Open
  hands.app.frames(2);
  REQUIRE(hands.app->interface().dialog_open());
  hands.app.key(key::kEscape);
  hands.app.frames(2);
  CHECK_FALSE(hands.app->interface().dialog_open());
  CHECK(hands.studio().view().tool == Tool::kBrush);
  hands.app.key(key::kEscape);
  CHECK(hands.studio().view().tool == Tool::kNavigate);
}

TEST_CASE("hands: Enter saves work where a scene would be opened over it, and discards nothing") {
  Hands hands;
  const std::uint64_t serial = hands.studio().scene()->serial;
  hands.app.open(kSample);
  hands.app.frames(3);
  REQUIRE(hands.app->interface().dialog_open());
  hands.app.key(key::kEnter);
  hands.app.frames(3);
  CHECK(hands.app->interface().dialog_open());  // where to save
  CHECK(hands.app.interface_state().files.saving);
  hands.app.key(key::kEscape);
  REQUIRE(hands.app.settle());
  CHECK(hands.studio().scene()->serial == serial);
}

TEST_CASE("hands: a file is found by its first letters, by arrows, and opened by Enter") {
  const ScratchFolder folder("browse");
  std::filesystem::create_directories(folder / "garden");
  for (const char* name : {"alpha.ply", "beta.ply", "bicycle.ply"}) std::ofstream(folder / name) << "x";
  std::filesystem::copy_file(kSample, folder / "garden" / "mug.compressed.ply");
  HeadlessApp app(kWidth, kHeight);
  FileBrowser& files = app.interface_state().files;
  files.folder = folder.path();
  app.key('O', {.ctrl = true});
  app.frames(2);
  REQUIRE(files.open);
  REQUIRE(files.entries.size() == 4);
  const auto type = [&](char letter) {
    app->handle(TextTyped{static_cast<unsigned>(letter)});
    app.frames(1);
  };
  type('b');
  CHECK(files.name == "beta.ply");
  type('i');
  CHECK(files.name == "bicycle.ply");
  app.key(key::kUp);
  CHECK(files.name == "beta.ply");
  app.key(key::kHome);
  CHECK(files.cursor == 0);
  app.key(key::kEnter);  // the folder
  app.frames(2);
  REQUIRE(files.entries.size() == 1);
  app.key(key::kDown);
  CHECK(files.name == "mug.compressed.ply");
  app.key(key::kEnter);
  CHECK_FALSE(files.open);
  REQUIRE(app.settle());
  CHECK(app.studio().scene() != nullptr);
}

TEST_CASE("hands: an export that fails leaves its dialog open and says why") {
  const ScratchFolder folder("export_fails");
  Hands hands;
  hands.app.key('E', {.ctrl = true});
  hands.app.frames(2);
  std::ofstream(folder / "file") << "x";
  hands.app.interface_state().exporting.path = (folder / "file" / "object.ply").string();
  hands.app.frames(1);
  hands.app.key(key::kEnter);
  REQUIRE(hands.app.settle());
  hands.app.frames(2);
  CHECK(hands.app->interface().dialog_open());
  CHECK_FALSE(hands.app.interface_state().exporting.trouble.empty());
  hands.app.interface_state().exporting.path = (folder / "object.ply").string();
  hands.app.frames(1);
  hands.app.key(key::kEnter);
  REQUIRE(hands.app.settle());
  hands.app.frames(2);
  CHECK_FALSE(hands.app->interface().dialog_open());
  CHECK(std::filesystem::exists(folder / "object.ply"));
}

TEST_CASE("hands: two presses are a double-click by their own times, however slow the frames") {
  Hands hands(false);
  hands.app.key('1');
  const glm::vec2 at = hands.app.screen_of(kOnApple);
  const auto distance = [&] { return hands.studio().camera().pose().distance; };
  const auto two = [&](double apart_s) {
    hands.app.move(at);
    for (const double t : {100.0, 100.0 + apart_s}) {
      hands.app->handle(PointerButtonChanged{PointerButton::kLeft, true, {}, t});
      hands.app->frame(0.6);  // slower than any hand
      hands.app->handle(PointerButtonChanged{PointerButton::kLeft, false, {}, t + 0.05});
      hands.app->frame(0.6);
    }
    REQUIRE(hands.app.settle());
  };
  const float before = distance();
  two(0.8);
  CHECK(distance() == before);
  two(0.2);
  CHECK(distance() != before);
}

TEST_CASE("hands: what is under the pointer stays there while the wheel goes nearer and a drag shifts") {
  Hands hands(false);
  hands.app.key('1');
  for (const glm::vec2& pixel : {kOnApple, kOnMug}) {
    const glm::vec2 at = hands.app.screen_of(pixel);
    hands.studio().apply(GoToCamera{hands.studio().scene()->cameras.front()});
    REQUIRE(hands.app.settle());
    const glm::vec3 point = hands.under(at);
    const float before = glm::distance(hands.studio().camera().pose().position_world, point);
    hands.app.move(at);
    hands.app->handle(WheelTurned{3, {}});
    CHECK(glm::distance(hands.seen_at(point), at) < 1.5f);
    CHECK(glm::distance(hands.studio().camera().pose().position_world, point) < 0.75f * before);
    REQUIRE(hands.app.settle());
    const glm::vec2 to = at + glm::vec2(60, -35);
    hands.app.drag({at, at + glm::vec2(30, -10), to}, PointerButton::kRight);
    CHECK(glm::distance(hands.seen_at(point), to) < 4);
  }
}

TEST_CASE("hands: the view turns around what was clicked") {
  Hands hands;
  hands.app.key('1');
  const glm::vec3 apple = hands.under(hands.app.screen_of(kOnApple));
  const glm::vec2 before = hands.seen_at(apple);
  REQUIRE(glm::distance(before, hands.app->interface().viewport().min +
                                    0.5f * hands.app->interface().viewport().size()) > 40);
  hands.app.drag({{300, 120}, {360, 120}, {420, 120}}, PointerButton::kMiddle);
  CHECK(glm::distance(hands.seen_at(apple), before) < 3);
}

TEST_CASE("hands: F frames the object in what thumbnails leave free") {
  Hands hands;
  REQUIRE(hands.app->interface().covered_bottom(hands.studio()) > 0);
  hands.app.key('F');
  REQUIRE(hands.app.settle());
  const auto labels = hands.studio().labels(hands.studio().document().active);
  const GaussianCloud& cloud = *hands.studio().scene()->cloud;
  const UiRect view = hands.app->interface().viewport();
  const float lowest = view.max.y - hands.app->interface().covered_bottom(hands.studio());
  std::size_t inside = 0, all = 0;
  float top = 1e9f, bottom = -1e9f;
  for (std::size_t g = 0; g < labels.size(); ++g) {
    if (!labels[g]) continue;
    const glm::vec2 at = hands.seen_at(cloud.position[g]);
    ++all;
    const bool free = view.contains(at) && at.y < lowest;
    inside += free;
    if (free) top = std::min(top, at.y), bottom = std::max(bottom, at.y);
  }
  CHECK(static_cast<double>(inside) > 0.97 * static_cast<double>(all));
  CHECK(bottom - top > 0.4f * (lowest - view.min.y));
}

TEST_CASE("hands: while a flight key is held the wheel changes the speed, else it goes nearer") {
  Hands hands(false);
  hands.app.move(hands.app.screen_of(kOnMug));
  const auto flown = [&] {
    const glm::vec3 before = hands.studio().camera().pose().position_world;
    hands.app.frames(10);
    return glm::distance(before, hands.studio().camera().pose().position_world);
  };
  hands.app->handle(KeyChanged{'W', true, false, {}});
  const float usual = flown();
  CHECK(usual > 0);
  hands.app->handle(WheelTurned{-4, {}});
  CHECK(hands.studio().view().fly_speed < 0.5f);
  CHECK(flown() < 0.6f * usual);
  hands.app->handle(KeyChanged{'W', false, false, {}});
  const float speed = hands.studio().view().fly_speed;
  hands.app->handle(WheelTurned{-1, {}});
  CHECK(hands.studio().view().fly_speed == speed);
}

TEST_CASE("hands: the eyedropper takes one colour everywhere, the flood where it hangs together") {
  Hands hands(false);
  REQUIRE(hands.app.settle());
  const Scene& scene = *hands.studio().scene()->scene;
  hands.app.key('C');
  REQUIRE(hands.studio().view().tool == Tool::kColour);
  hands.app.click(hands.app.screen_of(kOnOrange));
  REQUIRE(hands.app.settle());
  const auto by_colour = hands.studio().labels(hands.studio().document().active);
  hands.app.key('G');
  hands.studio().apply(EditSelection{SelectionEdit::kNone});
  hands.app.click(hands.app.screen_of(kOnOrange));
  REQUIRE(hands.app.settle());
  const auto flooded = hands.studio().labels(hands.studio().document().active);
  const auto orange = sample_truth(scene, kOrange);
  std::size_t beyond = 0, of_orange = 0;
  for (std::size_t g = 0; g < flooded.size(); ++g) {
    beyond += flooded[g] && !by_colour[g];
    of_orange += flooded[g] && orange[g];
  }
  MESSAGE(count_flags(by_colour), " by colour, ", count_flags(flooded), " by flood, ", of_orange,
          " of the orange");
  CHECK(count_flags(flooded) > 100);
  CHECK(beyond == 0);
  CHECK(static_cast<double>(of_orange) > 0.8 * static_cast<double>(count_flags(flooded)));
  hands.app.click(hands.app.screen_of(kOnOrange), PointerButton::kLeft, {.ctrl = true});
  CHECK(hands.selected() == 0);
}

TEST_CASE("hands: Shift adds, Ctrl removes, Alt intersects, with clicks as with regions") {
  Hands hands;
  const std::vector<std::uint8_t> apple = hands.studio().labels(hands.studio().document().active);
  hands.app.click(hands.app.screen_of(kOnOrange), PointerButton::kLeft, {.shift = true});
  REQUIRE(hands.app.settle());
  CHECK(hands.selected() > count_flags(apple));
  hands.app.click(hands.app.screen_of(kOnApple), PointerButton::kLeft, {.alt = true});
  REQUIRE(hands.app.settle());
  CHECK(iou_of(hands.studio().labels(hands.studio().document().active), apple) > 0.85);
  hands.app.click(hands.app.screen_of(kOnApple), PointerButton::kLeft, {.ctrl = true});
  REQUIRE(hands.app.settle());
  CHECK(hands.selected() < count_flags(apple) / 2);
  // Held keys show before anything is pressed.
  hands.app.key('6');
  hands.app->handle(KeyChanged{key::kLeftControl, true, false, {}});
  CHECK(hands.studio().overlay().operation == SetOperation::kRemove);
  hands.app->handle(KeyChanged{key::kLeftControl, false, false, {.ctrl = true}});
  CHECK(hands.studio().overlay().operation == SetOperation::kAdd);
}

TEST_CASE("hands: backgrounds go round, and the checker is behind the object alone") {
  Hands hands;
  hands.app.key('I');
  REQUIRE(hands.app.settle());
  const auto corner = [&](int x, int y) { return hands.studio().picture()->pictures.front().at(x, y); };
  std::vector<Rgba8> seen;
  for (std::size_t i = 0; i < backdrops().size(); ++i) {
    hands.app.key('J');
    REQUIRE(hands.app.settle());
    seen.push_back(corner(3, 3));
    if (hands.studio().view().checker)
      CHECK(corner(3, 3) != corner(3 + 12, 3));
    else
      CHECK(corner(3, 3) == corner(3 + 12, 3));
  }
  CHECK(seen[1] == Rgba8{255, 255, 255, 255});
  CHECK(seen[3] == Rgba8{255, 0, 255, 255});
  CHECK(shows(backdrops()[0], hands.studio().document(), hands.studio().view()));
}

TEST_CASE("hands: an export stands where it is asked to, and looks the same from there") {
  const ScratchFolder folder("placed");
  Hands hands;
  const GaussianCloud& cloud = *hands.studio().scene()->cloud;
  const auto labels = hands.studio().labels(hands.studio().document().active);
  const glm::vec3 up = hands.studio().document().up_world;
  const ExportPlacement placement{ExportOrigin::kFoot, ExportUp::kPlusZ, 30, 2.5f, {1, 2, 3}};
  const Similarity to = similarity_of(placement, cloud, labels, up);
  CHECK(glm::distance(to.rotation * up, glm::vec3(0, 0, 1)) < 1e-5f);
  hands.studio().apply(
      Export{{ExportWhat::kObject, SceneFormat::kPly, folder / "apple.ply", false, placement}});
  REQUIRE(hands.app.settle());
  const Scene written = load_scene(folder / "apple.ply");
  REQUIRE(written.cloud.size() == count_flags(labels));
  const Box box = robust_bounds(written.cloud.position);
  CHECK(std::abs(box.centre().x - 1) < 0.05f);
  CHECK(std::abs(box.centre().y - 2) < 0.05f);
  CHECK(std::abs(box.min.z - 3) < 0.05f);
  CHECK(box.extent().z > 0);
  // The camera moved along sees the same colours: harmonics turned with the rest.
  const Camera camera = hands.studio().viewport_camera();
  Camera there = camera;
  there.camera_from_world_rotation =
      camera.camera_from_world_rotation * glm::transpose(glm::mat3_cast(to.rotation));
  const glm::vec3 eye =
      to.scale * (glm::mat3_cast(to.rotation) * (camera.centre_world() - to.origin)) + to.move;
  there.camera_from_world_translation = -(there.camera_from_world_rotation * eye);
  RasterOptions before, after;
  before.shown = labels;
  before.near_plane = 0.01f;
  after.near_plane = to.scale * 0.01f;
  const RasterOutput a = rasterize(cloud, camera, before), b = rasterize(written.cloud, there, after);
  float largest = 0;
  for (std::size_t i = 0; i < a.colour.size(); ++i) {
    const glm::vec3 d = glm::abs(a.colour.pixels()[i] - b.colour.pixels()[i]);
    largest = std::max({largest, d.r, d.g, d.b});
  }
  MESSAGE("SH degree ", written.cloud.sh_degree, ", largest difference ", largest);
  CHECK(written.cloud.sh_degree > 0);
  CHECK(largest < 2e-3f);
}

TEST_CASE("hands: harmonics of every degree turn with the object") {
  GaussianCloud cloud;
  cloud.resize(1, 3);
  cloud.position[0] = {0.3f, -0.2f, 0.5f};
  cloud.scale[0] = glm::vec3(0.1f);
  cloud.rotation[0] = {1, 0, 0, 0};
  cloud.opacity[0] = 0.9f;
  for (std::size_t i = 0; i < cloud.sh_rest.size(); ++i)
    cloud.sh_rest[i] = std::sin(static_cast<float>(7 * i + 1)) * 0.2f;
  const glm::quat turn = glm::normalize(glm::quat(0.3f, 0.8f, -0.2f, 0.45f));
  const GaussianCloud turned = placed(cloud, {}, {turn, 1, {}, {}});
  for (const glm::vec3& d :
       {glm::vec3(1, 0, 0), glm::vec3(0.2f, -0.7f, 0.4f), glm::vec3(-0.5f, 0.1f, -0.9f)}) {
    float basis[15], basis_turned[15];
    sh_rest_basis(3, glm::normalize(d), basis);
    sh_rest_basis(3, turn * glm::normalize(d), basis_turned);
    for (std::size_t channel = 0; channel < 3; ++channel) {
      float value = 0, value_turned = 0;
      for (std::size_t k = 0; k < 15; ++k) {
        value += basis[k] * cloud.sh_rest[channel * 15 + k];
        value_turned += basis_turned[k] * turned.sh_rest[channel * 15 + k];
      }
      CHECK(value_turned == doctest::Approx(value).epsilon(1e-4));
    }
  }
}

TEST_CASE("hands: a proposed name is one that no file has yet") {
  const ScratchFolder folder("names");
  CHECK(free_path(folder / "a.compressed.ply", ".compressed.ply") == folder / "a.compressed.ply");
  for (const char* name : {"a.compressed.ply", "a_2.compressed.ply"}) std::ofstream(folder / name) << "x";
  CHECK(free_path(folder / "a.compressed.ply", ".compressed.ply") == folder / "a_3.compressed.ply");
}

TEST_CASE("hands: two points are measured in scene units") {
  Hands hands(false);
  hands.app.key('K');
  const glm::vec2 a = hands.app.screen_of(kOnApple), b = hands.app.screen_of(kOnMug);
  const float truth = glm::distance(hands.under(a), hands.under(b));
  hands.app.click(a);
  CHECK_FALSE(hands.studio().overlay().length);
  hands.app.click(b);
  REQUIRE(hands.studio().overlay().length);
  CHECK(*hands.studio().overlay().length == doctest::Approx(truth).epsilon(1e-4));
  CHECK(hands.studio().document().objects.empty());
}

TEST_CASE("hands: the axes in the corner turn the view, and take the click") {
  Hands hands(false);
  hands.app.key(key::kKeypad7);
  REQUIRE(hands.app.settle());
  const glm::vec3 forward = hands.studio().viewport_camera().forward_world();
  CHECK(glm::dot(forward, hands.studio().document().up_world) < -0.99f);
  const UiRect view = hands.app->interface().viewport();
  const glm::vec2 middle(view.max.x - 55, view.min.y + 55);
  CHECK_FALSE(hands.app->interface().picture_at(middle, hands.studio()));
  hands.app.key(key::kKeypad1);
  REQUIRE(hands.app.settle());
  const glm::vec3 right(glm::row(hands.studio().viewport_camera().camera_from_world_rotation, 0));
  const float x_side = right.x > 0 ? 1.0f : -1.0f;
  REQUIRE(std::abs(right.x) > 0.99f);
  hands.app.click(middle + glm::vec2(x_side * 34, 0));  // the ball of +X
  REQUIRE(hands.app.settle());
  CHECK(hands.studio().viewport_camera().forward_world().x < -0.99f);
}
