// .lcc2, a tree over pieces: its text made by hand, its pieces by our writers.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "quick.h"
#include "scene/cloud/scene_memory.h"
#include "scene/cloud/spherical_harmonics.h"
#include "scene_file_helpers.h"

using namespace splatcut;
using namespace splatcut::testing;
using nlohmann::json;

namespace {

json node(int piece, int start, std::int64_t count, const json& children = nullptr) {
  json made = {{"data", {{"3dgs", {{"name", piece}, {"start", start}, {"count", count}}}}}};
  if (!children.is_null()) made["child"] = children;
  return made;
}

// Of two levels: pieces 0 (fine) and 1 (coarse) hold two parts of the scene, of which the second has no finer
// level; piece 2 lies around.
struct Lcc2 {
  Folder folder;
  std::vector<std::string> names;
  json text;

  explicit Lcc2(const SceneFormat& format = SceneFormat::kSog) {
    fs::create_directories(folder / "data/3dgs");
    const std::vector<std::pair<std::size_t, int>> sizes = {{500, 1}, {100, 2}, {30, 0}};
    for (std::size_t i = 0; i < sizes.size(); ++i) {
      Scene scene;
      scene.cloud = varied_cloud(sizes[i].first, sizes[i].second);
      for (glm::vec3& p : scene.cloud.position) p.z += 20 * static_cast<float>(i);
      names.push_back(fmt::format("data/3dgs/{}{}", i, format.extension));
      save_scene(folder / names.back(), scene, {}, format);
    }
    text = {
        {"totalSplats", 600}, {"totalLevels", 2}, {"lodSplats", {560, 100}}, {"splatType", format.extension}};
    text["root"] = {{"splatFiles", names}, {"data", {{"env", {{"name", 2}}}}}};
    // Children may be a list, or have names.
    text["root"]["child"] = {node(1, 0, 40, {{"0", node(0, 0, 300)}, {"1", node(0, 300, 200)}}),
                             node(1, 40, 60)};
  }
  fs::path write_text(const std::string& content) const {
    write(folder / "scene.lcc2", content);
    return folder / "scene.lcc2";
  }
  fs::path write_text() const { return write_text(text.dump()); }
  std::string refused(const json& changed) const { return refusal(write_text(changed.dump())); }
  std::string refused_children(const json& children) const {
    json changed = text;
    changed["root"]["child"] = children;
    return refused(changed);
  }
  std::string refused_node(const json& only) const { return refused_children(json::array({only})); }
};

struct Part {
  std::size_t piece, first, count;
};

// Each Gaussian is that of its piece, turned a quarter about x: what the file calls z is -y.
void check_parts(const Scene& got, const Lcc2& made, const std::vector<Part>& parts) {
  std::vector<std::size_t> at_row(got.file_rows, got.cloud.size());
  for (std::size_t g = 0; g < got.cloud.size(); ++g) at_row[got.cloud.file_row[g]] = g;
  const glm::quat upright(std::sqrt(0.5f), std::sqrt(0.5f), 0, 0);
  const ShTurn turn(glm::mat3_cast(upright));
  std::size_t row = 0;
  float worst = 0;
  for (const Part& part : parts) {
    const GaussianCloud piece =
        load_scene(made.folder / made.names[part.piece], {.spz_axes = SpzAxes::kPly}).cloud;
    for (std::size_t i = 0; i < piece.size(); ++i) {
      if (piece.file_row[i] < part.first || piece.file_row[i] >= part.first + part.count) continue;
      const std::size_t g = at_row.at(row + piece.file_row[i] - part.first);
      REQUIRE(g < got.cloud.size());
      const glm::vec3& p = piece.position[i];
      CHECK(got.cloud.position[g] == glm::vec3(p.x, -p.z, p.y));
      CHECK(got.cloud.scale[g] == piece.scale[i]);
      CHECK(got.cloud.opacity[g] == piece.opacity[i]);
      CHECK(got.cloud.f_dc[g] == piece.f_dc[i]);
      worst = std::max(worst, 1 - std::abs(glm::dot(got.cloud.rotation[g], upright * piece.rotation[i])));
      std::vector<float> rest(got.cloud.sh_stride());
      const std::size_t own = piece.sh_stride() / 3, all = rest.size() / 3;
      for (std::size_t c = 0; c < 3; ++c)
        for (std::size_t k = 0; k < own; ++k) rest[c * all + k] = piece.sh_rest_of(i)[c * own + k];
      turn.apply(rest, got.cloud.sh_degree);
      for (std::size_t k = 0; k < rest.size(); ++k)
        worst = std::max(worst, std::abs(rest[k] - got.cloud.sh_rest_of(g)[k]));
    }
    row += part.count;
  }
  CHECK(worst < 1e-6f);
  CHECK(got.file_rows == row);
  CHECK(got.cloud.size() == row);
}

}  // namespace

QUICK_CASE(
    "lcc2",
    "lcc2: of each part the finest level or the one asked for, of .sog and .spz, with what lies around") {
  for (const SceneFormat& format : {SceneFormat::kSog, SceneFormat::kSpz}) {
    CAPTURE(format.name);
    const Lcc2 made(format);
    made.write_text();
    const Scene scene = load_scene(made.folder.path);
    CHECK(scene.format == SceneFormat::kLcc2);
    CHECK(scene.path == made.folder / "scene.lcc2");
    CHECK(scene.left_out == "Of its 2 levels of detail, level 0 is read, 0 the finest");
    check_parts(scene, made, {{0, 0, 300}, {0, 300, 200}, {1, 40, 60}, {2, 0, 30}});
    CHECK(scene.cloud.sh_degree == 2);
    for (const unsigned lod : {1u, 50u}) {
      const Scene coarse = load_scene(made.folder / "scene.lcc2", {.lod = lod});
      check_parts(coarse, made, {{1, 0, 40}, {1, 40, 60}, {2, 0, 30}});
      CHECK(mentions(coarse.left_out, {"level 1 is read"}));
      for (const std::string& name : made.names)  // what other levels are made of is no place to write to
        CHECK(std::ranges::count(coarse.files, made.folder / name) > 0);
    }
  }
}

TEST_CASE(
    "lcc2: texts of older programs, commas before brackets, ranges that are whole pieces, no surroundings") {
  const Lcc2 made;
  json old = {{"total_splats", 600}, {"lod_level", 2}, {"lod_3dgs_info", {100, 560}}};
  old["root"] = made.text["root"];
  old["root"].erase("splatFiles");
  old["root"]["files"] = {"/data/3dgs/0", "/data/3dgs/1", "data/3dgs/2.sog"};
  check_parts(load_scene(made.write_text(old.dump())), made,
              {{0, 0, 300}, {0, 300, 200}, {1, 40, 60}, {2, 0, 30}});
  CHECK(levels_of(made.folder / "scene.lcc2").gaussians == std::vector<std::uint64_t>{560, 100});

  std::string loose = made.text.dump();
  loose.replace(loose.size() - 1, 1, ", \n}");
  loose.replace(loose.find("100],"), 5, "100 ,\t],\"note\":\"a,}\\\",]\",");
  check_parts(load_scene(made.write_text(loose)), made,
              {{0, 0, 300}, {0, 300, 200}, {1, 40, 60}, {2, 0, 30}});

  json whole = made.text;
  whole["root"]["child"] = {
      {{"data", {{"3dgs", {{"name", 1}}}}}, {"child", {{{"data", {{"3dgs", {{"name", 0}}}}}}}}}};
  fs::remove(made.folder / made.names[2]);
  check_parts(load_scene(made.write_text(whole.dump())), made, {{0, 0, 500}});
  CHECK(levels_of(made.folder / "scene.lcc2").gaussians == std::vector<std::uint64_t>{560, 100});
}

TEST_CASE(
    "levels of detail: what each has is known from the index, and the finest that memory holds is chosen") {
  const Lcc2 made;
  const SceneLevels levels = levels_of(made.write_text());
  CHECK(levels.gaussians == std::vector<std::uint64_t>{560, 100});
  CHECK(levels.sh_degree == 1);
  CHECK(finest_level(levels, memory_of_scene(560, 1)) == 0);
  CHECK(finest_level(levels, memory_of_scene(560, 1) - 1) == 1);
  CHECK(finest_level(levels, 1) == 1);
  CHECK(finest_level({}, 0) == 0);
  CHECK(levels_of(made.folder / made.names[0]).gaussians.empty());
}

QUICK_CASE("lcc2", "lcc2: numbers, trees and names that cannot be are refused with a sentence") {
  const Lcc2 made;
  const auto with_root = [&](const char* key, const json& value) {
    json changed = made.text;
    changed["root"][key] = value;
    return made.refused(changed);
  };
  const auto with = [&](const char* key, const json& value) {
    json changed = made.text;
    changed[key] = value;
    return made.refused(changed);
  };
  CHECK(mentions(made.refused_node(node(3, 0, 1)), {"piece 3", "of 3"}));
  CHECK(mentions(made.refused_node(node(-1, 0, 1)), {"piece of a node is -1"}));
  CHECK(mentions(made.refused_node(node(0, 0, -1)), {"count of a node is -1"}));
  CHECK(mentions(made.refused_node(node(0, 400, 101)), {"400 to 501", "which has 500"}));
  CHECK(mentions(made.refused_node(node(0, 0, 4294967295u)), {"which has 500"}));
  CHECK(mentions(made.refused_children({node(0, 0, 10), node(0, 9, 10)}), {"two leaves", "same Gaussians"}));
  CHECK(mentions(made.refused_node(1), {"a node of its tree is number"}));
  CHECK(mentions(made.refused_children("many"), {"are no list"}));
  CHECK(mentions(made.refused_children(json::array()), {"level of detail 0 holds no Gaussians"}));
  CHECK(mentions(with("totalLevels", 0), {"0 levels of detail"}));
  CHECK(mentions(with("totalLevels", 65), {"65 levels of detail"}));
  CHECK(mentions(with("totalLevels", "2"), {"number of levels of it is string"}));
  CHECK(mentions(with("root", 7), {"not the text of an .lcc2"}));
  CHECK(mentions(with_root("splatFiles", 7), {"not the text of an .lcc2"}));
  CHECK(mentions(with_root("splatFiles", {"../0.sog", "1.sog", "2.sog"}), {"not in its folder"}));
  CHECK(mentions(with_root("splatFiles", {"gone.sog", "1.sog", "2.sog"}), {"piece gone.sog is missing"}));
  CHECK(mentions(with_root("splatFiles", {"scene.lcc2", made.names[1], "2.sog"}), {"not that of a .sog"}));
  CHECK(mentions(with_root("data", {{"env", {{"name", 9}}}}), {"piece 9"}));
  CHECK(mentions(with_root("data", {{"env", 2}}), {"not the text of an .lcc2"}));
  CHECK(mentions(refusal(made.write_text("{\"totalLevels\": 2,")), {"not valid JSON"}));
  std::string deep = "{\"totalLevels\": 2, \"root\": {\"splatFiles\": [], \"child\": ";
  for (int i = 0; i < 100000; ++i) deep += "[";
  CHECK(mentions(refusal(made.write_text(deep)), {"nested deeper"}));
}
