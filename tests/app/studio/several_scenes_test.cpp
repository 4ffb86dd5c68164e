// Several scenes in one window: the same as their merge, with labels that go where their Gaussians go.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <glm/gtc/matrix_access.hpp>
#include <glm/gtc/quaternion.hpp>
#include <limits>

#include "app/cli/work_cut.h"
#include "app/document/carried_document.h"
#include "app/work/work_file.h"
#include "hands.h"
#include "opened_sample.h"
#include "scene/formats/merged_scene.h"
#include "synthetic_cloud.h"

using namespace splatcut;
using namespace splatcut::testing;

namespace {

constexpr std::size_t kAdded = 300;

std::filesystem::path small_scene(const ScratchFolder& folder, const std::string& name = "small.ply",
                                  unsigned seed = 1) {
  Scene scene;
  scene.cloud = random_cloud(kAdded, seed, 1);
  scene.file_rows = scene.cloud.size();
  save_scene(folder / name, scene, {}, SceneFormat::kPly);
  return folder / name;
}

std::vector<std::uint8_t> by_row(const Studio& studio, std::span<const std::uint8_t> flags) {
  const Scene& scene = *studio.scene()->scene;
  std::vector<std::uint8_t> rows(scene.file_rows, 0);
  for (std::size_t g = 0; g < flags.size(); ++g) rows[scene.cloud.file_row[g]] = flags[g];
  return rows;
}

std::vector<std::uint8_t> active_by_row(const Studio& studio) {
  return by_row(studio, studio.labels(studio.document().active));
}

std::vector<std::uint8_t> longer(std::vector<std::uint8_t> rows, std::size_t by) {
  rows.resize(rows.size() + by, 0);
  return rows;
}

bool same_cloud(const GaussianCloud& a, const GaussianCloud& b) {
  return a.position == b.position && a.scale == b.scale && a.rotation == b.rotation &&
         a.opacity == b.opacity && a.f_dc == b.f_dc && a.sh_rest == b.sh_rest && a.file_row == b.file_row &&
         a.near_plane == b.near_plane;
}

void add(Hands& hands, const std::filesystem::path& path) {
  hands.studio().apply(AddScene{path});
  REQUIRE(hands.app.settle());
}

const SceneSource& last_file(Hands& hands) {
  return hands.studio().scene()->files.back();
}

// Height of the box's lowest corner along up, once it is moved.
float lowest_corner(const Box& box, const Similarity& to, const glm::vec3& up) {
  float lowest = std::numeric_limits<float>::max();
  for (int corner = 0; corner < 8; ++corner) {
    const glm::vec3 at((corner & 1) ? box.min.x : box.max.x, (corner & 2) ? box.min.y : box.max.y,
                       (corner & 4) ? box.min.z : box.max.z);
    lowest = std::min(lowest, glm::dot(moved(at, to), glm::normalize(up)));
  }
  return lowest;
}

}  // namespace

TEST_CASE("several scenes: the window shows the merge, labels and history stay with their Gaussians") {
  const ScratchFolder folder("several");
  Hands hands;
  Studio& studio = hands.studio();
  const CameraPose pose = studio.camera().pose();
  const auto apple = active_by_row(studio);
  studio.apply(EditSelection{SelectionEdit::kGrow});
  REQUIRE(hands.app.settle());
  const auto grown = active_by_row(studio);
  REQUIRE(grown != apple);
  const std::size_t cuts = studio.cuts().done();

  const auto path = small_scene(folder);
  add(hands, path);
  REQUIRE(studio.scene()->files.size() == 2);
  CHECK(last_file(hands).gaussians == kAdded);
  std::vector<Scene> scenes;
  scenes.push_back(load_scene(kSmallSample));
  scenes.push_back(load_scene(path));
  CHECK(same_cloud(*studio.scene()->cloud, merged(std::move(scenes)).scene.cloud));
  CHECK(studio.camera().pose() == pose);
  CHECK(studio.unsaved());
  CHECK(active_by_row(studio) == longer(grown, kAdded));
  const std::size_t now = studio.history().cursor();
  studio.apply(JumpHistory{now - 2});  // before it grew
  CHECK(active_by_row(studio) == longer(apple, kAdded));
  studio.apply(JumpHistory{now});
  REQUIRE(hands.app.settle());
  CHECK(active_by_row(studio) == longer(grown, kAdded));
  CHECK(studio.cuts().done() == cuts);  // what was cut stays as it was

  studio.apply(NewObject{});
  studio.apply(SelectScene{last_file(hands).id});
  CHECK(hands.selected() == kAdded);
  studio.apply(RemoveScene{last_file(hands).id});
  REQUIRE(hands.app.settle());
  CHECK(same_cloud(*studio.scene()->cloud, load_scene(kSmallSample).cloud));
  CHECK(hands.selected() == 0);
  CHECK(by_row(studio, studio.labels(1)) == grown);
}

TEST_CASE("several scenes: saved work holds them, and what was cut before is kept until the next stroke") {
  const ScratchFolder folder("several_saved");
  Hands hands;
  Studio& studio = hands.studio();
  add(hands, small_scene(folder));
  studio.apply(PlaceScene{last_file(hands).id, {{0.5f, -1, 2}, {10, 20, -30}, 1.5f}});
  REQUIRE(hands.app.settle());
  REQUIRE(studio.document().objects[0].cut_kept);
  const auto file = folder / "several.splatcut.json";
  studio.apply(SaveWork{file});
  REQUIRE(hands.app.settle());
  CHECK_FALSE(studio.unsaved());
  const Document saved = studio.document();
  const auto labels = active_by_row(studio);

  const auto scene = open_scene(read_work_file(file).files);
  CHECK(same_cloud(*scene->cloud, *studio.scene()->cloud));
  Document read = restored(read_work_file(file), *scene).document;
  CHECK(same(read, saved));
  CHECK(same(computed_again(*scene, read), saved));
  Hands other(false);
  other.app.open(file);
  REQUIRE(other.app.settle());
  CHECK(other.studio().scene()->files.size() == 2);
  CHECK(same(other.studio().document(), saved));
  CHECK(active_by_row(other.studio()) == labels);

  studio.apply(Recompute{});
  REQUIRE(hands.app.settle());
  CHECK_FALSE(studio.document().objects[0].cut_kept);
  const Document cut = studio.document();
  REQUIRE(cut.objects[0].cut);
  read.objects[0].cut_kept = false;  // computed anew from the same strokes, which see what they saw
  read.objects[0].cut = nullptr;
  CHECK(same(computed_again(*scene, read), cut));

  std::filesystem::remove(folder / "small.ply");
  studio.apply(OpenScene{file});
  REQUIRE(hands.app.settle());
  CHECK(hands.said().find("small.ply") != std::string::npos);
  CHECK(studio.scene()->files.size() == 2);  // the open one stays
  small_scene(folder, "small.ply", 7);
  studio.apply(OpenScene{file});
  REQUIRE(hands.app.settle());
  CHECK(hands.said().find("belongs to another version of small.ply") != std::string::npos);
}

TEST_CASE("several scenes: a placed file stands where the numbers say, what was cut of it moves along") {
  const ScratchFolder folder("several_placed");
  Hands hands(false);
  Studio& studio = hands.studio();
  add(hands, kSmallSample);  // its twin
  const glm::vec3 middle = last_file(hands).bounds.centre();
  const GaussianCloud own = load_scene(kSmallSample).cloud;
  const auto checked_at = [&](const ScenePlace& place) {
    const glm::quat turn = glm::angleAxis(glm::radians(place.turn_deg.z), glm::vec3(0, 0, 1)) *
                           glm::angleAxis(glm::radians(place.turn_deg.y), glm::vec3(0, 1, 0)) *
                           glm::angleAxis(glm::radians(place.turn_deg.x), glm::vec3(1, 0, 0));
    const GaussianCloud& cloud = *studio.scene()->cloud;
    std::vector<glm::vec3> now(cloud.size());
    for (std::size_t g = 0; g < cloud.size(); ++g) now[cloud.file_row[g]] = cloud.position[g];
    float worst = 0;
    for (std::size_t g = 0; g < own.size(); ++g) {
      const glm::vec3 to = place.scale * (turn * (own.position[g] - middle)) + middle + place.move;
      worst = std::max(worst, glm::length(now[own.file_row[g]] - own.position[g]));  // the first stays
      worst = std::max(worst, glm::length(now[own.size() + own.file_row[g]] - to));
    }
    CHECK(worst < 1e-4f * studio.camera().scene_size());
  };
  const float size = studio.camera().scene_size();
  const Camera here = studio.viewport().pane_camera();
  const ScenePlace aside{3 * size * glm::transpose(here.camera_from_world_rotation)[0], {0, 0, 0}, 1};
  studio.apply(PlaceScene{last_file(hands).id, aside});
  REQUIRE(hands.app.settle());
  checked_at(aside);

  // An apple of the twin, clicked where the first one's is on the screen.
  const Camera there = moved(here, {{1, 0, 0, 0}, 1, {0, 0, 0}, aside.move});
  studio.apply(GoToCamera{there});
  REQUIRE(hands.app.settle());
  hands.app.click(hands.app.screen_of(kOnApple));
  REQUIRE(hands.app.settle());
  const auto apple = active_by_row(studio);
  const std::size_t expected = [] {  // of the scene alone
    Hands alone;
    return alone.selected();
  }();
  CHECK(std::abs(static_cast<double>(count_flags(apple)) / static_cast<double>(expected) - 1) < 0.01);
  REQUIRE(count_flags(std::span(apple).first(own.size())) == 0);
  const Camera clicked = studio.document().objects[0].views[0].camera;
  const Flags seen = studio.document().objects[0].views[0].seen;

  const ScenePlace turned{aside.move + glm::vec3(0, 0.3f * size, 0), {0, 90, 0}, 2};
  studio.apply(PlaceScene{last_file(hands).id, turned});
  REQUIRE(hands.app.settle());
  checked_at(turned);
  CHECK(active_by_row(studio) == apple);
  const StrokedView& view = studio.document().objects[0].views[0];
  const GaussianCloud& cloud = *studio.scene()->cloud;
  REQUIRE(view.seen);
  for (std::size_t g = 0; g < cloud.size(); ++g)
    REQUIRE((!(*view.seen)[g] || cloud.file_row[g] >= own.size()));  // of the twin alone
  // It sees the twin as the click did: the same pixels, depths twice as large.
  SceneSource before = last_file(hands);
  before.place = aside;
  const Similarity was = similarity_of(before), is = similarity_of(last_file(hands));
  for (std::size_t g = 0; g < own.size(); g += 997) {
    const glm::vec3 then = clicked.camera_from_world(moved(own.position[g], was)),
                    now = view.camera.camera_from_world(moved(own.position[g], is));
    CHECK(glm::length(now - 2.0f * then) < 1e-3f * size);
  }
  studio.apply(Recompute{});  // and the click still means the apple
  REQUIRE(hands.app.settle());
  const auto again = active_by_row(studio);
  std::size_t differ = 0;
  for (std::size_t row = 0; row < again.size(); ++row) differ += again[row] != apple[row];
  CHECK(differ <= count_flags(apple) / 100);
}

TEST_CASE("several scenes: an added file comes to stand upright on what one looks at") {
  const ScratchFolder folder("several_onto");
  Hands hands;
  Studio& studio = hands.studio();
  const auto a = small_scene(folder, "a.ply", 1), b = small_scene(folder, "b.ply", 2);
  const glm::vec3 seen = studio.viewport().looked_at_world(), beside = seen + glm::vec3(1, 0, 0.5f);
  const Camera camera = studio.viewport().pane_camera();
  const float free_px = static_cast<float>(camera.height_px) - studio.viewport().covered_bottom_px();
  const glm::vec2 middle(0.5f * static_cast<float>(camera.width_px), 0.5f * free_px);
  CHECK(glm::distance(camera.pixel_from_camera(camera.camera_from_world(seen)), middle) < 0.5f);
  const auto stands_on = [&](const SceneSource& file, const glm::vec3& point) {
    const glm::vec3 up = studio.document().up_world;
    return file.place == stood_on(file, stood_upright(file, {}, up), point, up);
  };
  studio.apply(AddScene{a, {}, seen});
  studio.apply(AddScene{b, {}, beside});  // while the first is read
  REQUIRE(hands.app.settle());
  REQUIRE(studio.scene()->files.size() == 3);
  const SceneSource first = studio.scene()->files[1], second = studio.scene()->files[2];
  CHECK(stands_on(first, seen));
  CHECK(stands_on(second, beside));
  studio.apply(PlaceScene{first.id, {}});
  REQUIRE(hands.app.settle());
  CHECK(studio.scene()->files[1].place == ScenePlace{});
  CHECK(studio.scene()->files[2].place == second.place);
  studio.apply(Undo{});
  REQUIRE(hands.app.settle());
  CHECK(studio.scene()->files[1].place == first.place);
}

TEST_CASE(
    "several scenes: a file is brought onto the surface in the middle of the free picture, or not at all") {
  const ScratchFolder folder("several_here");
  Hands hands(false);
  Studio& studio = hands.studio();
  add(hands, small_scene(folder));
  hands.app.click(hands.app.screen_of(kOnApple));  // for its thumbnails
  REQUIRE(hands.app.settle());
  const std::uint32_t id = last_file(hands).id;
  REQUIRE(studio.viewport().covered_bottom_px() > 0);
  // The view turns and is shifted: its pivot hangs in the air or lies under the table.
  hands.app.drag({{300, 200}, {300, 260}});
  hands.app.drag({{300, 260}, {300, 190}}, PointerButton::kRight);
  REQUIRE(hands.app.settle());
  const auto below = [&] {  // what is under the middle of the free part, but for the file itself
    const Camera camera = studio.viewport().pane_camera();
    std::vector<std::uint8_t> others = gaussians_of(*studio.scene(), id);
    for (std::uint8_t& g : others) g = !g;
    const glm::vec2 free(camera.width_px,
                         static_cast<float>(camera.height_px) - studio.viewport().covered_bottom_px());
    const auto hit = studio.viewport().hit_in(camera, 0.5f * free, make_flags(others));
    REQUIRE(hit);
    return hit->position_world;
  };
  REQUIRE(glm::distance(below(), studio.camera().pivot_world()) > 0.01f * studio.camera().scene_size());
  const glm::vec3 up = studio.document().up_world;
  for (int again = 0; again < 2; ++again) {  // it does not climb upon itself
    const glm::vec3 place = below();         // without thumbnails the second time
    studio.apply(BringHere{id});
    REQUIRE(hands.app.settle());
    CHECK(glm::distance(foot_world(last_file(hands), up), place) < 1e-3f * studio.camera().scene_size());
  }
  const ScenePlace stands = last_file(hands).place;
  const glm::vec3 outside = 100 * studio.camera().scene_size() * glm::vec3(1, 0, 0);
  studio.apply(GoToCamera{look_at(outside, 2.0f * outside, up, 0.9f, 640, 480)});  // into the sky
  REQUIRE(hands.app.settle());
  studio.apply(BringHere{id});
  REQUIRE(hands.app.settle());
  CHECK(hands.said().find("Nothing to stand on") != std::string::npos);
  CHECK(last_file(hands).place == stands);
}

TEST_CASE(
    "several scenes: those opened together stand upright on what the first view shows, as one added later") {
  const ScratchFolder folder("several_at_once");
  Scene lying;
  lying.cloud = random_cloud(kAdded, 4, 0);
  lying.file_rows = lying.cloud.size();
  lying.up = glm::vec3(1, 0, 0);
  save_scene(folder / "lying.ply", lying, {}, SceneFormat::kPly);
  Hands hands(false);
  Studio& studio = hands.studio();
  const auto a = small_scene(folder, "a.ply");
  studio.apply(OpenScene{kSmallSample, {}, {folder / "lying.ply", a}});
  REQUIRE(hands.app.settle());
  REQUIRE(studio.scene()->files.size() == 3);
  const glm::vec3 up = studio.document().up_world;
  const SceneSource &first = studio.scene()->files[1], &second = studio.scene()->files[2];
  CHECK(first.path == folder / "lying.ply");
  CHECK_FALSE(why_upright(first, first.place, up).empty());
  CHECK(first.place != ScenePlace{});
  const glm::vec3 apart = foot_world(first, up) - foot_world(second, up);
  CHECK(std::abs(glm::dot(apart, glm::normalize(up))) < 1e-3f * studio.camera().scene_size());
  studio.apply(OpenScene{kSmallSample, {}, {folder / "no.ply"}});
  REQUIRE(hands.app.settle());
  CHECK(studio.scene()->files.size() == 1);
  CHECK(hands.said().find("no.ply") != std::string::npos);
}

TEST_CASE(
    "several scenes: those opened together stand side by side, and one that is none is said while they "
    "open") {
  const ScratchFolder folder("several_beside");
  const auto bad = folder / "bad.ply";
  std::ofstream(bad) << "no scene";
  Hands hands(false);
  Studio& studio = hands.studio();
  const glm::vec3 seen = studio.viewport().looked_at_world();
  const auto a = small_scene(folder, "a.ply", 1), b = small_scene(folder, "b.ply", 2),
             c = small_scene(folder, "c.ply", 3);
  const auto said = [&](const std::string& words) {
    return std::ranges::any_of(studio.messages(),
                               [&](const Message& m) { return m.text.find(words) != std::string::npos; });
  };
  studio.apply(OpenScene{kSmallSample, {}, {a, bad, b, folder / "gone.ply", c}});
  REQUIRE(hands.app.settle());
  REQUIRE(studio.scene()->files.size() == 4);
  CHECK(hands.said().find("bad.ply") != std::string::npos);
  CHECK(hands.said().find("gone.ply") != std::string::npos);
  CHECK(said("a.ply, b.ply, c.ply added"));
  const glm::vec3 up = studio.document().up_world;
  const glm::vec3 row = glm::row(studio.viewport().pane_camera().camera_from_world_rotation, 0);
  const auto along = [&](const SceneSource& file) { return glm::dot(foot_world(file, up) - seen, row); };
  const std::vector<SceneSource> files = studio.scene()->files;
  float first = 0, last = 0;
  for (std::size_t i = 1; i < files.size(); ++i) {
    CHECK(std::abs(glm::dot(foot_world(files[i], up) - seen, up)) < 1e-3f);  // on one height
    const float half = half_extent(files[i], row);
    if (i == 1) first = along(files[i]) - half;
    if (i > 1) CHECK(along(files[i]) - half > last);  // beside the one before
    last = along(files[i]) + half;
  }
  CHECK(std::abs(first + last) < 1e-3f * (last - first));  // what one looks at is in the middle

  // One that is added later and is none leaves nothing behind: the next one comes in.
  studio.apply(AddScene{bad});
  REQUIRE(hands.app.settle());
  CHECK(hands.said().find("bad.ply") != std::string::npos);
  CHECK(studio.scene()->files.size() == 4);
  studio.apply(AddScene{bad});
  studio.apply(AddScene{small_scene(folder, "d.ply", 4)});  // while that is read
  REQUIRE(hands.app.settle());
  CHECK(studio.scene()->files.size() == 5);
  add(hands, small_scene(folder, "e.ply", 5));
  CHECK(studio.scene()->files.size() == 6);
  CHECK(hands.said().find("bad.ply") == std::string::npos);

  // The first of all is none.
  studio.apply(OpenScene{bad, {}, {a, b}});
  REQUIRE(hands.app.settle());
  REQUIRE(studio.scene()->files.size() == 2);
  CHECK(studio.scene()->files[0].path == a);
  CHECK(hands.said().find("bad.ply") != std::string::npos);
  studio.apply(OpenScene{bad, {}, {folder / "gone.ply"}});
  REQUIRE(hands.app.settle());
  CHECK(studio.scene()->files[0].path == a);
  CHECK(hands.said().find("bad.ply") != std::string::npos);
  CHECK(hands.said().find("gone.ply") != std::string::npos);
}

TEST_CASE(
    "several scenes: saved work among those opened together is refused in words, also where none opens") {
  const ScratchFolder folder("several_work");
  const auto work = folder / "my.splatcut.json";
  const auto scene = open_scene(kSmallSample);
  write_work_file(work, *scene, Document{});
  Hands hands(false);
  hands.studio().apply(OpenScene{folder / "gone.ply", {}, {work}});
  REQUIRE(hands.app.settle());
  CHECK(hands.said().find("my.splatcut.json: is saved work, not a scene") != std::string::npos);
  CHECK(hands.said().find("gone.ply") != std::string::npos);
  const auto a = small_scene(folder, "a.ply");
  hands.studio().apply(OpenScene{folder / "gone.ply", {}, {work, a}});
  REQUIRE(hands.app.settle());
  CHECK(hands.studio().scene()->files.front().path == a);
  CHECK(hands.said().find("my.splatcut.json: is saved work, not a scene") != std::string::npos);
}

TEST_CASE("several scenes: beside a thing that stands alone others stand on its ground, and all are seen") {
  const ScratchFolder folder("several_alone");
  const auto thing = [&](const char* name, const glm::vec3& size) {
    Scene scene;
    scene.cloud = random_cloud(kAdded, 7, 1);
    for (glm::vec3& p : scene.cloud.position) p = size * glm::normalize(p);
    scene.file_rows = scene.cloud.size();
    scene.up = glm::vec3(0, -1, 0);
    save_scene(folder / name, scene, {}, SceneFormat::kPly);
    return folder / name;
  };
  Hands hands(false);
  Studio& studio = hands.studio();
  studio.apply(
      OpenScene{thing("a.ply", {1, 2, 1}), {}, {thing("b.ply", {2, 1, 1}), thing("c.ply", {1, 1, 3})}});
  REQUIRE(hands.app.settle());
  const std::vector<SceneSource> files = studio.scene()->files;
  REQUIRE(files.size() == 3);
  const glm::vec3 up = studio.document().up_world;
  const Camera camera = studio.viewport().pane_camera();
  const glm::vec3 row = glm::row(camera.camera_from_world_rotation, 0);
  float last = glm::dot(foot_world(files[0], up), row) + half_extent(files[0], row);
  for (std::size_t i = 1; i < files.size(); ++i) {
    CHECK(std::abs(glm::dot(foot_world(files[i], up) - foot_world(files[0], up), up)) < 0.02f);
    CHECK(glm::dot(foot_world(files[i], up), row) - half_extent(files[i], row) > last);
    last = glm::dot(foot_world(files[i], up), row) + half_extent(files[i], row);
  }
  for (const SceneSource& file : files) {
    const glm::vec2 at = camera.pixel_from_camera(camera.camera_from_world(foot_world(file, up)));
    CHECK(at.x > 0);
    CHECK(at.x < static_cast<float>(camera.width_px));
    const float free_px = static_cast<float>(camera.height_px) - studio.viewport().kept_bottom_px();
    CHECK(at.y < free_px);  // above the room of the thumbnails
  }

  // A view that was moved while the others were read stays.
  Hands moved_hands(false);
  Studio& moved_studio = moved_hands.studio();
  const std::size_t before = moved_studio.scene()->files.size();
  REQUIRE(before == 1);
  moved_studio.apply(OpenScene{files[0].path, {}, {files[1].path, files[2].path}});
  for (int frame = 0; frame < 10000 && moved_studio.scene()->files[0].path != files[0].path; ++frame)
    moved_hands.app.frames(1);
  REQUIRE(moved_studio.scene()->files.size() == 1);
  moved_studio.camera().orbit({80, 10});
  const CameraPose pose = moved_studio.camera().goal();
  REQUIRE(moved_hands.app.settle());
  CHECK(moved_studio.scene()->files.size() == 3);
  CHECK(moved_studio.camera().goal() == pose);
}

TEST_CASE("several scenes: F frames what is placed, and the object that was clicked since") {
  const ScratchFolder folder("several_framed");
  Hands hands(false);
  Studio& studio = hands.studio();
  add(hands, small_scene(folder));
  hands.app.frames(3);  // its handles show
  const float size = studio.camera().scene_size();
  studio.apply(PlaceScene{last_file(hands).id, {{0.4f * size, 0, 0}, {}, 0.1f}});
  REQUIRE(hands.app.settle());
  const auto in_middle = [&](const glm::vec3& world) {
    const Camera camera = studio.viewport().pane_camera();
    const glm::vec2 middle(0.5f * static_cast<float>(camera.width_px),
                           0.5f * static_cast<float>(camera.height_px));
    return glm::distance(camera.pixel_from_camera(camera.camera_from_world(world)), middle) <
           0.2f * static_cast<float>(camera.height_px);
  };
  const SceneSource& file = last_file(hands);
  const auto middle_of_file = [&] { return moved(file.solid.centre(), similarity_of(file)); };
  REQUIRE_FALSE(in_middle(middle_of_file()));
  hands.app.key('F');
  REQUIRE(hands.app.settle());
  CHECK(in_middle(middle_of_file()));

  studio.apply(GoToCamera{studio.scene()->views().reference});
  REQUIRE(hands.app.settle());
  hands.app.click(hands.app.screen_of(kOnApple));
  REQUIRE(hands.app.settle());
  hands.app.key('F');
  REQUIRE(hands.app.settle());
  CHECK_FALSE(in_middle(middle_of_file()));
}

TEST_CASE("several scenes: asked for in haste, cancelled, refused") {
  const ScratchFolder folder("several_haste");
  Hands hands;
  Studio& studio = hands.studio();
  const auto labels = active_by_row(studio);
  const auto a = small_scene(folder, "a.ply", 1), b = small_scene(folder, "b.ply", 2);
  studio.apply(AddScene{a});
  studio.apply(AddScene{b});
  studio.apply(EditSelection{SelectionEdit::kInvert});  // while they are read
  REQUIRE(hands.app.settle());
  REQUIRE(studio.scene()->files.size() == 3);
  CHECK(studio.scene()->files[1].path == a);
  CHECK(studio.scene()->files[2].path == b);
  auto inverted = labels;
  for (std::uint8_t& label : inverted) label = !label;
  // Whether the edit or the files came first, what was in the window then is inverted.
  const auto now = active_by_row(studio);
  CHECK(std::equal(inverted.begin(), inverted.end(), now.begin()));

  const std::uint32_t first = studio.scene()->files[0].id, second = studio.scene()->files[1].id;
  const auto refused = [&](const Command& command) {
    studio.apply(command);
    REQUIRE(hands.app.settle());
    CHECK(studio.scene()->files.size() == 3);
    CHECK(active_by_row(studio) == now);
    return hands.said();
  };
  CHECK(refused(AddScene{folder / "no.ply"}).find("no.ply") != std::string::npos);
  CHECK(refused(AddScene{folder / "work.splatcut.json"}).find("is saved work") != std::string::npos);
  CHECK(refused(RemoveScene{first}).find("was opened first") != std::string::npos);
  CHECK(refused(PlaceScene{first, {{1, 0, 0}}}).find("was opened first") != std::string::npos);
  CHECK(refused(PlaceScene{second, {{0, 0, 0}, {0, 0, 0}, 0}}).find("placed 0 times as large") !=
        std::string::npos);
  CHECK(refused(PlaceScene{second, {{NAN, 0, 0}}}).find("moved") != std::string::npos);
  CHECK(refused(PlaceScene{99999, {}}).find("no such file") != std::string::npos);
  CHECK(refused(SelectScene{99999}).find("no such file") != std::string::npos);
  small_scene(folder, "a.ply", 5);  // by another program
  CHECK(refused(PlaceScene{second, {{1, 0, 0}}}).find("was changed by another program") != std::string::npos);

  studio.apply(AddScene{b});
  studio.apply(Cancel{});
  REQUIRE(hands.app.settle());
  CHECK(studio.scene()->files.size() <= 4);  // it may have come in before
  studio.apply(OpenScene{kSmallSample});
  REQUIRE(hands.app.settle());
  CHECK(studio.scene()->files.size() == 1);
}

TEST_CASE(
    "several scenes: adding, placing and taking out are undone and redone, with what was made meanwhile") {
  const ScratchFolder folder("several_undone");
  Hands hands;
  Studio& studio = hands.studio();
  const auto apple = active_by_row(studio);
  add(hands, small_scene(folder));
  studio.apply(NewObject{});
  studio.apply(SelectScene{last_file(hands).id});
  REQUIRE(hands.selected() == kAdded);
  const ObjectId object = studio.document().active;
  const ScenePlace aside{{1, 2, 3}, {0, 45, 0}, 2};
  studio.apply(PlaceScene{last_file(hands).id, aside});
  REQUIRE(hands.app.settle());
  const GaussianCloud placed = *studio.scene()->cloud;
  studio.apply(RemoveScene{last_file(hands).id});
  REQUIRE(hands.app.settle());
  CHECK(studio.gaussians_of(object) == 0);
  const auto go = [&](Action action) {
    REQUIRE(studio.why_not(action).empty());
    studio.run(action);
    REQUIRE(hands.app.settle());
  };
  go(Action::kUndo);
  CHECK(same_cloud(*studio.scene()->cloud, placed));
  CHECK(studio.gaussians_of(object) == kAdded);  // its marks came back with it
  CHECK(last_file(hands).place == aside);
  go(Action::kUndo);
  CHECK(last_file(hands).place == ScenePlace{});
  CHECK(studio.gaussians_of(object) == kAdded);
  go(Action::kUndo);  // the selection
  CHECK(studio.gaussians_of(object) == 0);
  go(Action::kRedo);
  CHECK(studio.gaussians_of(object) == kAdded);
  go(Action::kUndo);
  go(Action::kUndo);  // the object
  go(Action::kUndo);  // the file
  CHECK(studio.scene()->files.size() == 1);
  CHECK(active_by_row(studio) == apple);
  go(Action::kRedo);
  CHECK(studio.scene()->files.size() == 2);
  CHECK(active_by_row(studio) == longer(apple, kAdded));
  go(Action::kUndo);
  studio.apply(EditSelection{SelectionEdit::kNone});  // another way on: nothing is left to redo
  REQUIRE(hands.app.settle());
  CHECK_FALSE(studio.why_not(Action::kRedo).empty());
}

TEST_CASE("several scenes: what was saved is known apart from what was done after files were taken back") {
  const ScratchFolder folder("several_serials");
  Hands hands;
  Studio& studio = hands.studio();
  add(hands, small_scene(folder));
  studio.apply(NewObject{});
  studio.apply(SaveWork{folder / "two.splatcut.json"});
  REQUIRE(hands.app.settle());
  REQUIRE_FALSE(studio.unsaved());
  studio.apply(Undo{});  // the object
  studio.apply(Undo{});  // the file
  REQUIRE(hands.app.settle());
  REQUIRE(studio.scene()->files.size() == 1);
  for (int step = 0; step < 8; ++step) {  // as many steps as lay between: none of these documents is saved
    CHECK(studio.unsaved());
    studio.apply(NewObject{});
  }
}

TEST_CASE("several scenes: a file stood upright stands on its point, whichever way up it was") {
  SceneSource file;
  file.bounds = {{-1, -2, -3}, {2, 1, 4}};
  const ScenePlace placed{{5, 6, 7}, {10, 20, 30}, 1.5f};
  for (const glm::vec3& own :
       {glm::vec3(0, 1, 0), glm::vec3(0, -1, 0), glm::vec3(1, 0, 0), glm::vec3(0.3f, -0.5f, 0.8f)})
    for (const glm::vec3& up : {glm::vec3(0, -1, 0), glm::vec3(0, 0, 2), glm::vec3(0.6f, 0.1f, -0.2f)}) {
      auto views = std::make_shared<FileViews>();
      views->up_world = own;
      file.views = views;
      const glm::vec3 point(0.5f, -4, 9);
      file.place = stood_on(file, stood_upright(file, placed, up), point, up);
      const Similarity to = similarity_of(file);
      CHECK(glm::dot(glm::normalize(to.rotation * own), glm::normalize(up)) > 0.9999f);
      CHECK(file.place.scale == placed.scale);
      const float lowest = lowest_corner(file.bounds, to, up) - glm::dot(point, glm::normalize(up));
      CHECK(std::abs(lowest) < 1e-4f);
    }
}

TEST_CASE("several scenes: where a file stands upright already, that is said, and why none is sure of it") {
  const glm::vec3 up(0, -2, 0);
  SceneSource file;
  file.bounds = {{-1, -2, -3}, {2, 1, 4}};
  const auto with_up = [&](const glm::vec3& own, bool guess) {
    FileViews views;
    views.up_world = own;
    views.up_is_guess = guess;
    file.views = std::make_shared<FileViews>(views);
  };
  with_up({0, 0, 3}, false);
  CHECK(why_upright(file, {}, up).empty());
  const ScenePlace upright = stood_upright(file, {}, up);
  CHECK(why_upright(file, upright, up) == "It stands upright already");
  with_up({0, -1, 0}, false);
  CHECK(why_upright(file, {}, up) == "It stands upright already");
  CHECK(why_upright(file, {{1, 2, 3}, {0, 40, 0}, 2}, up) == "It stands upright already");  // turned about up
  CHECK(why_upright(file, {{}, {1, 0, 0}}, up).empty());
  with_up({0, -1, 0}, true);
  CHECK(why_upright(file, {}, up).starts_with("It stands upright already, as far as can be guessed"));
}

TEST_CASE("several scenes: the button that stands a file upright is greyed where it does") {
  const ScratchFolder folder("several_upright");
  HeadlessApp app(kSmallWidth, 1000);
  opened(app);
  Studio& studio = app.studio();
  const auto file = small_scene(folder);
  studio.apply(AddScene{file});
  REQUIRE(app.settle());
  const std::uint32_t id = studio.scene()->files.back().id;
  studio.apply(PlaceScene{id, {{}, {30, 0, 10}}});
  REQUIRE(app.settle());
  app.interface_state().placing.file = id;
  app.frames(3);
  const auto press = [&] {
    const UiRect at = app.button("Stand it upright");
    REQUIRE(at.size().x > 0);
    app.click(0.5f * (at.min + at.max));
    REQUIRE(app.settle());
  };
  const std::size_t steps = studio.history().entries().size();
  press();
  const SceneSource placed = studio.scene()->files.back();
  CHECK_FALSE(why_upright(placed, placed.place, studio.document().up_world).empty());
  CHECK(studio.history().entries().size() == steps + 1);
  press();
  CHECK(studio.history().entries().size() == steps + 1);
  // A scale is not cut off, and no number moves where the file becomes far too large.
  app->interface().make_current();
  const float begin = app.window("side/scroll").min.x + 64, end = app.button("Stand it upright").min.x - 4;
  if (end > begin)  // else the button has a row of its own
    CHECK(end - begin >= ImGui::CalcTextSize("0.2759 times").x + 2 * ImGui::GetStyle().FramePadding.x);
  const glm::vec2 before = app.button("Fit").min;
  REQUIRE(before.x > 0);
  studio.apply(PlaceScene{id, {{}, {}, 300}});
  REQUIRE(app.settle());
  app.frames(3);
  REQUIRE_FALSE(
      misfit(studio.scene()->files.back(), studio.viewport().pane_camera(), studio.document().up_world)
          .empty());
  CHECK(app.button("Fit").min == before);
}

TEST_CASE("several scenes: the numbers of a file say where it goes before it is there") {
  const ScratchFolder folder("several_going");
  HeadlessApp app(kSmallWidth, 1000);
  opened(app);
  Studio& studio = app.studio();
  studio.apply(AddScene{small_scene(folder)});
  REQUIRE(app.settle());
  const std::uint32_t id = studio.scene()->files.back().id;
  app.interface_state().placing.file = id;
  app.frames(3);
  const ScenePlace there{{1, 2, 3}, {}, 0.5f};
  studio.apply(PlaceScene{id, there});
  app.frames(1);
  REQUIRE(studio.loading());
  CHECK(studio.scene()->files.back().place != there);
  CHECK(app.interface_state().placing.place == there);  // what is typed now begins there
  REQUIRE(app.settle());
  CHECK(studio.scene()->files.back().place == there);
}

TEST_CASE("several scenes: scaled, a file stays on its foot") {
  SceneSource file;
  file.bounds = {{-1, -1, -1}, {1, 1, 1}};
  file.solid = {{-1, -2, -3}, {2, 1, 4}};
  const ScenePlace placed{{5, 6, 7}, {10, 20, 30}, 1.5f};
  for (const glm::vec3& up : {glm::vec3(0, -1, 0), glm::vec3(0, 0, 2), glm::vec3(0.6f, 0.1f, -0.2f)})
    for (const float scale : {0.1f, 1.5f, 20.0f}) {
      file.place = placed;
      const glm::vec3 foot = foot_world(file, up);
      file.place = scaled_on_foot(file, placed, scale, up);
      CHECK(file.place.scale == scale);
      CHECK(file.place.turn_deg == placed.turn_deg);
      CHECK(glm::distance(foot_world(file, up), foot) < 1e-4f);
      const Similarity to = similarity_of(file);
      const float lowest = lowest_corner(file.solid, to, up) - glm::dot(foot, glm::normalize(up));
      CHECK(std::abs(lowest) < 1e-3f);
    }
}

TEST_CASE("several scenes: a file far larger or smaller than what is looked at is told, and Fit mends it") {
  const ScratchFolder folder("several_fit");
  Hands hands(false);
  Studio& studio = hands.studio();
  Scene scene = load_scene(kSmallSample);
  const GaussianCloud own = scene.cloud;
  const auto scaled = [&](float scale, const std::string& name) {
    for (std::size_t g = 0; g < own.size(); ++g) {
      scene.cloud.position[g] = scale * own.position[g];
      scene.cloud.scale[g] = scale * own.scale[g];
    }
    scene.rows_can_be_copied = false;
    save_scene(folder / name, scene, {}, SceneFormat::kPly);
    return folder / name;
  };
  const auto added = [&](const std::filesystem::path& path) {
    studio.apply(AddScene{path, {}, studio.viewport().looked_at_world()});
    REQUIRE(hands.app.settle());
    return hands.said();
  };
  for (const auto& [scale, says] : {std::pair(30.0f, "smaller"), {0.01f, "larger"}, {200.0f, "inside"}}) {
    CAPTURE(scale);
    const std::string said = added(scaled(scale, fmt::format("a{}.ply", scale)));
    CAPTURE(said);
    const bool told = said.find(says) != std::string::npos || said.find("inside") != std::string::npos;
    CHECK(told);
    CHECK(said.find("Fit") != std::string::npos);
    const Camera camera = studio.viewport().pane_camera();
    const glm::vec3 up = studio.document().up_world, foot = foot_world(last_file(hands), up);
    studio.apply(PlaceScene{last_file(hands).id, fitted(last_file(hands), camera, up)});
    REQUIRE(hands.app.settle());
    CHECK(share_of_picture(last_file(hands), camera, up) == doctest::Approx(0.5).epsilon(0.01));
    CHECK(glm::distance(foot_world(last_file(hands), up), foot) < 1e-2f * studio.camera().scene_size());
    CHECK(misfit(last_file(hands), camera, up).empty());
    studio.apply(RemoveScene{last_file(hands).id});
    REQUIRE(hands.app.settle());
  }
  CHECK(added(scaled(1, "a1.ply")).find("Fit") == std::string::npos);
}

TEST_CASE("several scenes: the box of an added file holds all of it but strays") {
  const ScratchFolder folder("several_solid");
  Hands hands(false);
  Scene scene;
  scene.cloud = random_cloud(4000, 3, 0);
  scene.file_rows = scene.cloud.size();
  std::ranges::fill(scene.cloud.opacity, 0.9f);
  Box all{scene.cloud.position[0], scene.cloud.position[0]};
  for (const glm::vec3& p : scene.cloud.position) {
    all.min = glm::min(all.min, p);
    all.max = glm::max(all.max, p);
  }
  for (std::size_t g = 0; g < 12; ++g)  // strays
    scene.cloud.position[331 * g] = all.centre() + (3.0f + 0.7f * static_cast<float>(g)) * all.extent();
  save_scene(folder / "strays.ply", scene, {}, SceneFormat::kPly);
  add(hands, folder / "strays.ply");
  const Box solid = last_file(hands).solid;
  CHECK(glm::length(solid.extent() - all.extent()) < 0.05f * glm::length(all.extent()));
  CHECK(glm::length(last_file(hands).bounds.extent()) < 0.95f * glm::length(solid.extent()));
}

TEST_CASE("several scenes: carried arrays against brute force") {
  const ScratchFolder folder("several_brute");
  const auto a = small_scene(folder, "a.ply", 1), b = small_scene(folder, "b.ply", 2),
             c = small_scene(folder, "c.ply", 3);
  const auto scene_of = [](const std::vector<std::pair<std::uint32_t, std::filesystem::path>>& files) {
    std::vector<SceneSource> sources;
    for (const auto& [id, path] : files) sources.push_back({.id = id, .path = path});
    return open_scene(sources);
  };
  const auto before = scene_of({{1, a}, {2, b}, {3, c}}), after = scene_of({{1, a}, {3, c}, {4, b}});
  // A number for each Gaussian by its file and row there.
  const auto value = [](std::uint32_t id, std::size_t row) {
    return static_cast<std::uint8_t>((id * 31 + row * 7) % 3);
  };
  const auto flags = [&](const OpenedScene& scene, bool new_ones) {
    std::vector<std::uint8_t> out(scene.cloud->size());
    for (std::size_t g = 0; g < out.size(); ++g) {
      const std::size_t row = scene.cloud->file_row[g];
      const std::uint32_t id = scene.files[row / kAdded].id;
      out[g] = id == 4 && !new_ones ? 0 : value(id, row % kAdded);
    }
    return make_flags(out);
  };
  Document document;
  ObjectItem& object = add_object(&document, "all");
  object.hand = flags(*before, true);
  object.cut = object.hand;
  document.deleted = object.hand;
  object.views.push_back({Camera{}, {Stroke{SeedLabel::kObject, 3, {{1, 1}}}}, nullptr});
  CarriedDocument carried(*before, *after);
  const Document now = carried(document);
  const Flags expected = flags(*after, false);
  CHECK(*now.objects[0].hand == *expected);
  CHECK(now.objects[0].hand == now.deleted);  // shared as before
  CHECK(*now.objects[0].cut == *expected);
  const Flags& seen = now.objects[0].views[0].seen;
  REQUIRE(seen);
  for (std::size_t g = 0; g < seen->size(); ++g)
    REQUIRE((*seen)[g] == (after->files[after->cloud->file_row[g] / kAdded].id != 4));
  CHECK(carried(document).objects[0].views[0].seen == seen);
}
