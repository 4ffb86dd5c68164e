// Several scenes in one window: the same as their merge, with labels that go where their Gaussians go.
#include <doctest/doctest.h>

#include <algorithm>
#include <fstream>
#include <glm/gtc/quaternion.hpp>
#include <nlohmann/json.hpp>

#include "app/cli/work_cut.h"
#include "app/work/work_file.h"
#include "app/workspace/carried_document.h"
#include "core/byte_hash.h"
#include "core/error.h"
#include "core/json_file.h"
#include "hands.h"
#include "opened_sample.h"
#include "scene/formats/merged_scene.h"
#include "several_scenes.h"

using namespace splatcut;
using namespace splatcut::testing;

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
  const Document& before_grown = studio.history().entries()[studio.history().cursor() - 2].document;
  CHECK(by_row(studio, labels_of(before_grown, before_grown.objects[0], studio.scene()->cloud->size())) ==
        longer(apple, kAdded));
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

TEST_CASE(
    "several scenes: saved work opens without a file that is missing, which is said, and is not changed") {
  const ScratchFolder folder("several_missing");
  Hands hands;
  Studio& studio = hands.studio();
  const auto apple = active_by_row(studio);
  add(hands, small_scene(folder));
  add(hands, small_scene(folder, "c.ply", 7));
  for (const std::size_t i : {1, 2}) studio.apply(SelectScene{studio.scene()->files[i].id});
  REQUIRE(hands.app.settle());
  const auto file = folder / "missing.splatcut.json";
  studio.apply(SaveWork{file});
  REQUIRE(hands.app.settle());
  const auto labels = active_by_row(studio);
  REQUIRE(count_flags(labels) > count_flags(apple));
  const std::filesystem::path missing = studio.scene()->files[1].path;
  const std::size_t rows = studio.scene()->files[1].file_rows;
  std::filesystem::remove(missing);
  const std::uint64_t before = hash_of_file(file);

  CHECK_THROWS_AS(open_scene(read_work_file(file).files), Error);  // as `cut --work` opens it
  Hands other(false);
  other.app.open(file);
  REQUIRE(other.app.settle());
  REQUIRE(other.studio().scene()->files.size() == 2);
  std::vector<std::uint8_t> left = labels;
  const auto first = left.begin() + static_cast<std::ptrdiff_t>(apple.size());
  left.erase(first, first + static_cast<std::ptrdiff_t>(rows));
  CHECK(active_by_row(other.studio()) == left);
  CHECK(other.said().find(missing.filename().string()) != std::string::npos);
  CHECK(other.said().find("save this under another name") != std::string::npos);
  CHECK(other.studio().work().work_path().empty());
  CHECK(hash_of_file(file) == before);
  // What was restored after a crash does not become the work that was saved as a whole, either.
  nlohmann::json crashed = json_of_file(file);
  crashed["saved_as"] = file.string();
  std::ofstream(folder / "left.splatcut.json") << crashed.dump();
  WorkFile work = read_work_file(folder / "left.splatcut.json");
  for (std::size_t i = 0; i < work.files.size(); ++i) work.files[i].id = static_cast<std::uint32_t>(i + 1);
  std::vector<std::string> refused;
  const RestoredWork read = restored(work, *open_scene(work.files, {}, nullptr, &refused));
  CHECK(refused.size() == 1);
  CHECK(read.saved_as.empty());
  CHECK(read.document.objects.size() == 1);
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
  CHECK(differ <= count_flags(apple) / 10);  // cells lie otherwise in what is turned
}

TEST_CASE("several scenes: a correction of what was cut before a file was added means what it meant then") {
  const ScratchFolder folder("several_corrected");
  Hands hands, alone;
  Studio& studio = hands.studio();
  const auto apple = active_by_row(studio);
  const glm::vec3 on_apple = hands.under(hands.app.screen_of(kOnApple));
  add(hands, small_scene(folder));
  const float size = studio.camera().scene_size();
  const SceneSource& file = last_file(hands);
  ScenePlace close;  // before the fruit, a little to the side of where the first click was
  close.scale = 0.15f * size / glm::length(file.solid.extent());
  const Camera camera = studio.viewport().pane_camera();
  close.move = glm::mix(on_apple, camera.centre_world(), 0.15f) - file.solid.centre() +
               0.12f * size * glm::transpose(camera.camera_from_world_rotation)[0];
  studio.apply(PlaceScene{file.id, close});
  REQUIRE(hands.app.settle());
  REQUIRE(active_by_row(studio) == longer(apple, kAdded));

  // On the rest, beside the apple: the table.
  const glm::vec2 table = hands.seen_at(on_apple) + glm::vec2(0, 110);
  const auto stroke = [&](Hands& h, const glm::vec2& screen, SeedLabel label) {
    h.studio().apply(AddStroke{h.studio().viewport().pane_camera(), click(h.in_viewport(screen), label)});
    REQUIRE(h.app.settle());
  };
  stroke(hands, table, SeedLabel::kObject);
  stroke(alone, table, SeedLabel::kObject);
  const auto expected = longer(active_by_row(alone.studio()), kAdded), got = active_by_row(studio);
  REQUIRE(count_flags(expected) > count_flags(apple));
  std::size_t differ = 0;
  for (std::size_t row = 0; row < got.size(); ++row) differ += got[row] != expected[row];
  CHECK(differ <= count_flags(expected) / 100);  // the order of the Gaussians is another
  REQUIRE(studio.document().objects[0].among);

  // What was added is not the object's: to say so changes nothing of what it hides.
  const glm::vec2 added = [&] {
    const auto is_added = [&](const std::optional<PickedPoint>& hit) {
      return hit && !(*studio.document().objects[0].among)[static_cast<std::size_t>(hit->gaussian)];
    };
    const UiRect viewport = hands.app->interface().viewport();
    for (float y = 4; y < viewport.max.y - viewport.min.y; y += 8)
      for (float x = 4; x < viewport.max.x - viewport.min.x; x += 8)
        if (is_added(studio.viewport().pick({x, y}))) return viewport.min + glm::vec2(x, y);
    FAIL("what was added is not in the picture");
    return glm::vec2(0);
  }();
  stroke(hands, added, SeedLabel::kRest);
  CHECK(active_by_row(studio) == got);
  // Saved work knows it.
  studio.apply(SaveWork{folder / "among.splatcut.json"});
  REQUIRE(hands.app.settle());
  const auto scene = open_scene(read_work_file(folder / "among.splatcut.json").files);
  CHECK(same(restored(read_work_file(folder / "among.splatcut.json"), *scene).document, studio.document()));
  // Clicked, it is.
  stroke(hands, added, SeedLabel::kObject);
  CHECK_FALSE(studio.document().objects[0].among);
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
