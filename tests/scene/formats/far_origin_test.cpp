// Scenes whose positions are in double and far from 0, 0, 0, as on a map.
#include <fmt/format.h>

#include "scene/camera/camera_file.h"
#include "scene/formats/losses.h"
#include "scene/formats/merged_scene.h"
#include "scene_file_helpers.h"

using namespace splatcut;
using namespace splatcut::testing;

namespace {

constexpr glm::dvec3 kMap{500000, -3, 4500000};  // the middle of the file's Gaussians, up to a unit

const std::vector<std::string> kOthers = {"f_dc_0",  "f_dc_1", "f_dc_2", "opacity", "scale_0", "scale_1",
                                          "scale_2", "rot_0",  "rot_1",  "rot_2",   "rot_3"};

// 25 Gaussians on a diagonal, 0.1 units from each other, of sizes exp(-3).
glm::dvec3 true_place(int row) {
  return glm::dvec3(0.1, 0.01, -0.1) * static_cast<double>(row - 12);
}

std::string ply_at(const glm::dvec3& middle, bool text = false) {
  std::string ply =
      fmt::format("ply\nformat {} 1.0\nelement vertex 25\n", text ? "ascii" : "binary_little_endian");
  for (const char* name : {"x", "y", "z"}) ply += fmt::format("property double {}\n", name);
  for (const std::string& name : kOthers) ply += fmt::format("property float {}\n", name);
  ply += "end_header\n";
  for (int row = 0; row < 25; ++row) {
    const glm::dvec3 p = middle + true_place(row);
    const std::vector<float> values = {0, 0, 0, 0, -3, -3, -3, 1, 0, 0, 0};
    if (text) {
      ply += fmt::format("{:.9f} {:.9f} {:.9f} {}\n", p.x, p.y, p.z, fmt::join(values, " "));
      continue;
    }
    for (const double v : {p.x, p.y, p.z}) ply += bytes_of(v);
    for (const float v : values) ply += bytes_of(v);
  }
  return ply;
}

// How far the Gaussians of rows from `first` on are from where the file has them.
double worst_place(const Scene& scene, const glm::dvec3& middle, int first = 0) {
  double worst = 0;
  for (std::size_t g = 0; g < scene.cloud.size(); ++g) {
    const int row = static_cast<int>(scene.cloud.file_row[g]) - first;
    if (row < 0 || row >= 25) continue;
    const glm::dvec3 place = glm::dvec3(scene.cloud.position[g]) + scene.origin;
    worst = std::max(worst, glm::length(place - middle - true_place(row)));
  }
  return worst;
}

// The doubles at the beginning of each row of a binary .ply.
double worst_of_rows(const std::string& ply, std::size_t row_bytes, const glm::dvec3& middle) {
  double worst = 0;
  for (int row = 0; row < 25; ++row) {
    glm::dvec3 p;
    std::memcpy(&p, ply.data() + ply.find("end_header\n") + 11 + static_cast<std::size_t>(row) * row_bytes,
                sizeof p);
    worst = std::max(worst, glm::length(p - middle - true_place(row)));
  }
  return worst;
}

}  // namespace

TEST_CASE("far: whole units are taken off positions in double, as numbers or as text, and it is said") {
  const Folder folder;
  for (const bool text : {false, true}) {
    write(folder / "far.ply", ply_at(kMap, text));
    const Scene scene = load_scene(folder / "far.ply");
    CHECK(scene.origin == kMap);
    CHECK(worst_place(scene, kMap) < 1e-7);
    CHECK(mentions(scene.oddity, {"500000, -3, 4500000 is taken off", "cameras"}));
  }
}

TEST_CASE("far: nothing is taken off where 32 bits are fine enough, or are what the file has") {
  const Folder folder;
  for (const glm::dvec3& near : {glm::dvec3(0), glm::dvec3(2000, 0, -2000)}) {
    write(folder / "near.ply", ply_at(near));
    const Scene scene = load_scene(folder / "near.ply");
    CHECK(scene.origin == glm::dvec3(0));
    CHECK(scene.oddity.empty());
  }
  std::string floats = ply_at(kMap, true);  // its rows are text: any type can stand before them
  for (const char* axis : {"x", "y", "z"})
    floats.replace(floats.find(fmt::format("double {}", axis)), 6, "float");
  write(folder / "floats.ply", floats);
  CHECK(load_scene(folder / "floats.ply").origin == glm::dvec3(0));
}

TEST_CASE("far: a .ply has the positions again, copied or written anew, other formats say what is missing") {
  const Folder folder;
  write(folder / "far.ply", ply_at(kMap));
  const Scene scene = load_scene(folder / "far.ply");
  std::vector<std::uint8_t> all(scene.cloud.size(), 1);
  CHECK(save_scene(folder / "copied.ply", scene, all, SceneFormat::kPly).loss.empty());
  CHECK(text_of(folder / "copied.ply") == text_of(folder / "far.ply"));
  CHECK(save_scene(folder / "anew.ply", with_cloud(scene, scene.cloud), {}, SceneFormat::kPly).loss.empty());
  CHECK(worst_of_rows(text_of(folder / "anew.ply"), 3 * 8 + 14 * 4, kMap) < 1e-7);
  const Scene again = load_scene(folder / "anew.ply");
  CHECK(again.origin == kMap);
  CHECK(again.cloud.position == scene.cloud.position);
  for (const SceneFormat& format : written_formats()) {
    if (format == SceneFormat::kPly) continue;
    CAPTURE(format.name);
    const std::string name = std::string("near") + format.extension;
    CHECK(mentions(save_scene(folder / name, scene, {}, format).loss, {"less 500000, -3, 4500000"}));
    CHECK(mentions(format.plan(scene, all_gaussians(scene.cloud), false).lost, {"less 500000, -3, 4500000"}));
    if (!format.read) continue;
    const Scene near = load_scene(folder / name, {.spz_axes = SpzAxes::kRub});
    for (const glm::vec3& p : near.cloud.position) {  // some formats have an order of their own
      const int row = static_cast<int>(std::lround(10 * p.x)) + 12;
      CHECK(glm::length(glm::dvec3(p) - true_place(row)) < 0.01);
    }
  }
}

TEST_CASE("far: a scene beside another takes that one's origin, and it is said where it is too far for it") {
  const Folder folder;
  const glm::dvec3 beside = kMap + glm::dvec3(40, 0, 0.5);
  write(folder / "a.ply", ply_at(kMap));
  write(folder / "b.ply", ply_at(beside, true));
  write(folder / "c.ply", ply_at(glm::dvec3(0)));
  std::vector<Scene> scenes;
  scenes.push_back(load_scene(folder / "a.ply"));
  for (const char* name : {"b.ply", "c.ply"})
    scenes.push_back(load_scene(folder / name, {.origin = scenes.front().origin}));
  CHECK(scenes[1].oddity.empty());
  CHECK(mentions(scenes[2].oddity, {"rounded"}));
  const MergedScene whole = merged(std::move(scenes));
  save_scene(folder / "all.ply", whole.scene, {}, SceneFormat::kPly);
  const Scene all = load_scene(folder / "all.ply", {.origin = kMap});
  REQUIRE(all.cloud.size() == 75);
  CHECK(worst_place(all, kMap) < 1e-7);
  CHECK(worst_place(all, beside, 25) < 3e-6);
  CHECK(worst_place(all, glm::dvec3(0), 50) < 0.3);  // 4,500,000 units away
}

TEST_CASE("far: a scene of 32 bits that stands beside one on a map comes near 0, 0, 0 with it") {
  const Folder folder;
  Scene scene;
  scene.cloud = varied_cloud(40, 1);
  scene.file_rows = scene.cloud.size();
  for (glm::vec3& p : scene.cloud.position) p += glm::vec3(kMap);
  save_scene(folder / "a.ply", scene, {}, SceneFormat::kPly);
  std::string text = text_of(folder / "a.ply");
  write(folder / "a.ply", text.insert(text.find("element"), "comment up 0 0 0\n"));
  const Scene beside = load_scene(folder / "a.ply", {.origin = kMap});
  CHECK(mentions(beside.oddity, {"what the file says of up is no direction"}));
  for (std::size_t g = 0; g < beside.cloud.size(); ++g)
    CHECK(beside.cloud.position[g] == scene.cloud.position[beside.cloud.file_row[g]] - glm::vec3(kMap));
  save_scene(folder / "b.ply", with_cloud(beside, beside.cloud), {}, SceneFormat::kPly);
  CHECK(load_scene(folder / "b.ply", {.origin = glm::dvec3(0)}).cloud.size() == 40);
}

TEST_CASE("far: cameras on a map stand before the scene once the same is taken off them") {
  const Folder folder;
  const glm::dvec3 centre = kMap + glm::dvec3(0.125, -0.25, -3.0625);  // 32 bits round z to half a unit
  fs::create_directories(folder / "colmap");
  write(folder / "colmap/cameras.txt", "1 PINHOLE 96 72 90 90 48 36\n");
  // A third of a turn about (1, 1, 1), world to camera: (x, y, z) becomes (y, z, x).
  write(folder / "colmap/images.txt", fmt::format("1 0.5 -0.5 -0.5 -0.5 {:.6f} {:.6f} {:.6f} 1 a.png\n\n",
                                                  -centre.y, -centre.z, -centre.x));
  const std::string place = fmt::format("{:.6f}, {:.6f}, {:.6f}", centre.x, centre.y, centre.z);
  write(folder / "cameras.json",
        R"([{"img_name": "a", "width": 96, "height": 72, "fx": 90, "fy": 90, "position": [)" + place +
            R"(], "rotation": [[0, 0, 1], [1, 0, 0], [0, 1, 0]]}])");
  write(folder / "transforms.json",
        fmt::format(R"({{"w": 96, "h": 72, "fl_x": 90, "frames": [{{"file_path": "a", "transform_matrix":
            [[0, 0, -1, {:.6f}], [1, 0, 0, {:.6f}], [0, -1, 0, {:.6f}], [0, 0, 0, 1]]}}]}})",
                    centre.x, centre.y, centre.z));
  for (const char* name : {"colmap", "cameras.json", "transforms.json"}) {
    CAPTURE(name);
    const std::vector<Camera> cameras = load_cameras(folder / name, nullptr, kMap);
    REQUIRE(cameras.size() == 1);
    CHECK(glm::length(cameras[0].centre_world() - glm::vec3(0.125f, -0.25f, -3.0625f)) < 1e-5f);
    CHECK(glm::length(cameras[0].forward_world() - glm::vec3(1, 0, 0)) < 1e-6f);
  }
}
