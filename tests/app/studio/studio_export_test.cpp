// Exports that stand where they are asked to.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <limits>
#include <string>

#include "app/document/words.h"
#include "core/png_file.h"
#include "hands_on_edges.h"
#include "scene/raster/rasterizer.h"
#include "scene/raster/splat_math.h"

using namespace splatcut;
using namespace splatcut::testing;

TEST_CASE("hands: an export that fails leaves its dialog open and says why") {
  const ScratchFolder folder("export_fails");
  Hands hands;
  hands.app.key('E', {.ctrl = true});
  hands.app.frames(2);
  hands.app->interface().make_current();
  ImGui::ClearActiveID();  // the name is being typed
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

TEST_CASE("hands: what an export is asked to have up is of the file's own axes") {
  const ScratchFolder folder("up");
  Hands hands;
  for (const auto& [up, sign] : {std::pair{ExportUp::kPlusY, 1.0f}, {ExportUp::kMinusY, -1.0f}}) {
    CAPTURE(sign);
    const ExportPlacement placement{.origin = ExportOrigin::kFoot, .up = up};
    hands.studio().apply(
        Export{{ExportWhat::kObject, SceneFormat::kUsda, folder / "apple.usda", true, placement}});
    REQUIRE(hands.app.settle());
    // As the text has it, not as our own readers turn it: the apple stands on the origin.
    std::ifstream in(folder / "apple.usda");
    std::string line;
    while (std::getline(in, line) && line.find("extent") == std::string::npos) continue;
    glm::vec3 low, high;
    REQUIRE(std::sscanf(line.c_str(), " float3[] extent = [(%f, %f, %f), (%f, %f, %f)]", &low.x, &low.y,
                        &low.z, &high.x, &high.y, &high.z) == 6);
    const float above = sign > 0 ? high.y : -low.y, below = sign > 0 ? -low.y : high.y;
    CHECK(above > 0);
    CHECK(below < 0.2f * above);
  }
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
  const Camera camera = hands.studio().viewport().pane_camera();
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

namespace {

// Over all Gaussians: a file's stand in another order than those that it was written from.
double sum_of_colours(const GaussianCloud& cloud) {
  double sum = 0;
  for (const glm::vec3& c : cloud.f_dc) sum += static_cast<double>(c.r + c.g + c.b);
  return sum;
}
double sum_of_sides(const GaussianCloud& cloud) {
  double sum = 0;
  for (const glm::vec3& s : cloud.scale) sum += static_cast<double>(s.x + s.y + s.z);
  return sum;
}

}  // namespace

TEST_CASE(
    "hands: what was turned upright for a file is upright when that is opened, also beside the cameras") {
  const ScratchFolder folder("says_up");
  Hands hands;
  const glm::vec3 up = hands.studio().document().up_world;
  const GaussianCloud cloud = *hands.studio().scene()->cloud;
  const auto labels = hands.studio().labels(hands.studio().document().active);
  HeadlessApp other(kHandsWidth, kHandsHeight);
  for (const bool beside_cameras : {false, true}) {
    CAPTURE(beside_cameras);
    if (beside_cameras) std::filesystem::copy(kSampleFolder / "cameras.json", folder / "cameras.json");
    for (const ExportUp turned : {ExportUp::kPlusZ, ExportUp::kScene})
      for (const SceneFormat& format : {SceneFormat::kPly, SceneFormat::kCompressedPly, SceneFormat::kSpz,
                                        SceneFormat::kSog, SceneFormat::kGlb}) {
        CAPTURE(format.name);
        const ExportPlacement placement{.origin = ExportOrigin::kFoot, .up = turned};
        const std::filesystem::path path = folder / ("apple" + std::string(format.extension));
        hands.studio().apply(Export{{ExportWhat::kObject, format, path, true, placement}});
        REQUIRE(hands.app.settle());
        other.open(path);
        REQUIRE(other.settle());
        const OpenedScene& scene = *other.studio().scene();
        REQUIRE(scene.files.front().path == path);
        const glm::vec3 expected = similarity_of(placement, cloud, labels, up, format.axes).rotation * up;
        CHECK(glm::distance(other.studio().document().up_world, expected) < 1e-5f);
        CHECK(glm::distance(other.studio().camera().up_world(), expected) < 1e-5f);
        // The capture's cameras stay where they stand as the file does.
        const bool theirs = beside_cameras && turned == ExportUp::kScene;
        CHECK(scene.views().cameras.empty() != theirs);
        CHECK(scene.remarks.empty());
        CHECK(scene.files.front().cameras_are_others == (beside_cameras && !theirs));
      }
  }
  const auto guessed = [&] {
    return std::ranges::any_of(other.studio().messages(),
                               [](const Message& m) { return m.text.find("is guessed") != m.text.npos; });
  };
  CHECK_FALSE(guessed());
  const ScratchFolder alone("says_no_up");
  Scene unsaid;
  unsaid.cloud = cloud;
  unsaid.file_rows = cloud.size();
  save_scene(alone / "unsaid.ply", unsaid, {}, SceneFormat::kPly);
  other.open(alone / "unsaid.ply");
  REQUIRE(other.settle());
  CHECK(guessed());
}

TEST_CASE("hands: an object is exported with clean edges, placed or not, or with its rows as they are") {
  const ScratchFolder folder("edges");
  Hands hands = hands_on_sample();
  take_what_touches_it(hands);
  const std::size_t labelled = hands.selected();
  const CleanObject clean = cleaned_without_window(hands);
  CAPTURE(clean.report.why_not);
  REQUIRE(changed(clean.report));
  const ExportPlacement twice{ExportOrigin::kScene, ExportUp::kScene, 0, 2, {}};
  const auto exported_as = [&](const char* name, const ExportPlacement& placement, bool edges) {
    hands.studio().apply(
        Export{{ExportWhat::kObject, SceneFormat::kPly, folder / name, false, placement, edges}});
    REQUIRE(hands.app.settle());
    return load_scene(folder / name).cloud;
  };
  const GaussianCloud written = exported_as("clean.ply", {}, true),
                      larger = exported_as("twice.ply", twice, true);
  REQUIRE(written.size() == clean.cloud.size());
  EdgesKnown known{.clean = true};  // now
  known.count(hands.studio().clean_edges(hands.studio().document().active), "Apple");
  CHECK(left_to_write({}, labelled, known) == written.size());
  REQUIRE(larger.size() == clean.cloud.size());
  const GaussianCloud kept = exported_as("kept.ply", {}, false);
  REQUIRE(kept.size() == labelled);
  CHECK(sum_of_sides(written) == doctest::Approx(sum_of_sides(clean.cloud)).epsilon(1e-6));
  CHECK(sum_of_sides(larger) == doctest::Approx(2 * sum_of_sides(clean.cloud)).epsilon(1e-6));
  CHECK(sum_of_colours(written) == doctest::Approx(sum_of_colours(clean.cloud)).epsilon(1e-6));
  CHECK(sum_of_colours(larger) == doctest::Approx(sum_of_colours(clean.cloud)).epsilon(1e-6));
  const double apart = std::abs(sum_of_colours(kept) - sum_of_colours(clean.cloud)) +
                       std::abs(sum_of_sides(kept) - sum_of_sides(clean.cloud));
  CHECK(apart > 1e-5 * std::abs(sum_of_colours(clean.cloud)));
  CHECK(hands.said().find("edges clean") == std::string::npos);  // of the last one, whose rows were kept
}

TEST_CASE("hands: the rest is exported without ghosts, or with all its rows") {
  const ScratchFolder folder("rest");
  Hands hands = hands_on_sample();
  take_what_touches_it(hands);
  const OpenedScene& scene = *hands.studio().scene();
  const auto labels = hands.studio().labels(hands.studio().document().active);
  const RestChanges changes =
      clean_object({*scene.cloud, labels, hands.studio().document().up_world, scene.views().cameras, true})
          .rest;
  REQUIRE(changes.ghosts.size() + changes.given_back.size() > 0);
  const std::size_t all = scene.cloud->size() - hands.selected();
  const auto exported_as = [&](const char* name, bool edges, bool fill = false) {
    hands.studio().apply(
        Export{{ExportWhat::kRest, SceneFormat::kPly, folder / name, false, {}, edges, fill}});
    REQUIRE(hands.app.settle());
    return load_scene(folder / name).cloud.size();
  };
  CHECK(exported_as("rest.ply", true) == all - changes.ghosts.size() + changes.given_back.size());
  CHECK(exported_as("kept.ply", false) == all);
  const SurfacePatch patch =
      fill_surface(*scene.cloud, labels, {}, hands.studio().document().up_world, scene.views().cameras, {});
  CHECK(exported_as("filled.ply", false, true) ==
        all - patch.changes.ghosts.size() + patch.changes.given_back.size());
  CHECK((hands.said().find("No hole is filled: " + patch.why_not) != std::string::npos) ==
        !patch.why_not.empty());
  REQUIRE(patch.why_not.empty());
  CHECK(hands.said().find(grouped(patch.changes.given_back.size()) + " of them invented to fill the hole") !=
        std::string::npos);
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

namespace {
std::string bytes_of_file(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}
}  // namespace

TEST_CASE("hands: nothing is saved over the file that the scene was read from, by whatever name") {
  const ScratchFolder folder("own_file");
  const std::filesystem::path scene = folder / "mine.compressed.ply", link = folder / "link.compressed.ply",
                              work = folder / "link.splatcut.json", picture = folder / "link.png";
  std::filesystem::copy(kSmallSample, scene);
  for (const auto& name : {link, work, picture}) std::filesystem::create_symlink(scene, name);
  HeadlessApp app(kHandsWidth, kHandsHeight);
  app.open(scene);
  REQUIRE(app.settle());
  const auto refused = [&](const Command& command, const std::string& sentence) {
    app.studio().apply(command);
    REQUIRE(app.settle());
    const std::string said = app.studio().messages().back().text;
    CHECK_MESSAGE(said.find(sentence) != std::string::npos, said);
  };
  for (const auto& name : {scene, link})
    refused(Export{{ExportWhat::kScene, SceneFormat::kCompressedPly, name, true}}, "is what is read here");
  refused(SaveWork{work}, "is what is read here");
  refused(SaveSnapshot{picture}, "is what is read here");
  refused(SaveSnapshot{folder / "new.ply"}, "is the name of a scene");
  CHECK(bytes_of_file(scene) == bytes_of_file(kSmallSample));
  for (const auto& name : {link, work, picture}) CHECK(std::filesystem::is_symlink(name));
  CHECK_FALSE(std::filesystem::exists(folder / "new.ply"));
}

TEST_CASE("hands: an export that would move everything to nowhere is refused") {
  const ScratchFolder folder("nowhere");
  Hands hands;
  const float nowhere = std::numeric_limits<float>::quiet_NaN(), far = std::numeric_limits<float>::infinity();
  for (const ExportPlacement& placement : {ExportPlacement{.turn_deg = nowhere},
                                           {.turn_deg = far},
                                           {.scale = nowhere},
                                           {.move = {0, nowhere, 0}},
                                           {.move = {0, 0, -far}}}) {
    hands.studio().apply(
        Export{{ExportWhat::kObject, SceneFormat::kPly, folder / "apple.ply", false, placement}});
    REQUIRE(hands.app.settle());
    CHECK_FALSE(std::filesystem::exists(folder / "apple.ply"));
  }
}

TEST_CASE(
    "exports: what is given back is left out where it would take a copy of a large scene, and only there") {
  Scene scene;
  RestChanges changes;
  changes.ghosts = {3};
  changes.given_back = hands_on_sample(false).studio().scene()->scene->cloud;
  const std::size_t given_back = changes.given_back.size();
  for (int bits = 0; bits < 32; ++bits) {
    const auto is = [bits](int bit) { return (bits >> bit & 1) != 0; };
    const bool large = is(0), changeable = is(1), moved = is(3), filled = is(4);
    const SceneFormat& format = is(2) ? SceneFormat::kPly : SceneFormat::kSpz;
    CAPTURE(bits);
    scene.cloud.position.resize(large ? kMostToCopy + 1 : 10);
    scene.rows_can_be_changed = changeable;
    const bool beside = changeable && is(2);
    const bool left_out = large && !beside && !moved && !filled;  // copied for their sake alone
    RestChanges of_this = changes;
    CHECK(spare_copy(scene, format, moved, filled ? changes : RestChanges(), &of_this) ==
          (left_out ? given_back : 0));
    CHECK(of_this.given_back.size() == (left_out ? 0 : given_back));
    CHECK(of_this.ghosts == changes.ghosts);
  }
}

TEST_CASE("hands: a picture asked for before a cut or an edit ends shows what comes of it") {
  const ScratchFolder folder("picture_soon");
  for (const bool alone : {true, false}) {
    CAPTURE(alone);
    Hands hands = hands_on_sample();
    Studio& studio = hands.studio();
    ViewState view = studio.view();
    view.clean_edges = false;  // they come later
    if (alone) view.display = DisplayMode::kIsolate;
    studio.apply(SetView{view});
    const auto picture = [&](const std::string& name) {
      studio.apply(SaveSnapshot{folder / name, false});
      REQUIRE(hands.app.settle());
      return bytes_of_file(folder / name);
    };
    REQUIRE(hands.app.settle());
    const auto soon_and_later = [&](const Command& command) {
      const std::string before = picture("before.png");
      studio.apply(command);
      const std::string soon = picture("soon.png"), later = picture("later.png");
      const bool same = soon == later;
      CHECK(same);
      return before != later;
    };
    const bool corrected = soon_and_later(StepScale{1});
    CHECK(corrected == alone);  // the picture has no outlines
    CHECK(soon_and_later(DeleteSelected{}));
  }
}
