// Streamed scenes: an index of ranges in several .sog, made by hand.
#include <fmt/format.h>
#include <tbb/task_arena.h>

#include <nlohmann/json.hpp>

#include "quick.h"
#include "scene/packing/webp.h"
#include "scene/packing/zip_file.h"
#include "scene_file_helpers.h"

using namespace splatcut;
using namespace splatcut::testing;
using nlohmann::json;

namespace {

Scene scene_at(float x, std::size_t gaussians, int degree) {
  Scene scene;
  scene.cloud = varied_cloud(gaussians, degree);
  for (glm::vec3& p : scene.cloud.position) p.x += x;
  return scene;
}

void unzip(const fs::path& archive, const fs::path& folder) {
  fs::create_directories(folder);
  const MappedFile file(archive);
  const ZipReader zip(file);
  for (const char* name : {"meta.json", "means_l.webp", "means_u.webp", "quats.webp", "scales.webp",
                           "sh0.webp", "shN_centroids.webp", "shN_labels.webp"}) {
    if (zip.find(name).empty()) continue;
    const std::vector<std::byte> bytes = zip.read(name);
    write(folder / name, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
  }
}

json level(int file, int offset, int count) {
  return {{"file", file}, {"offset", offset}, {"count", count}};
}
json leaf(const json& levels) {
  return {{"bound", {{"min", {0, 0, 0}}, {"max", {1, 1, 1}}}}, {"lods", levels}};
}
json inner(const std::vector<json>& children) {
  return {{"bound", {{"min", {0, 0, 0}}, {"max", {1, 1, 1}}}}, {"children", children}};
}

// Four pieces of different degrees, one of them an archive, and an environment.
struct Streamed {
  Folder folder;
  fs::path path = folder / "streamed";
  std::vector<std::string> names = {"0_0/meta.json", "0_1/meta.json", "1_0/meta.json", "d.sog"};
  json index;

  explicit Streamed(bool marked = false) {
    const std::vector<std::pair<std::size_t, int>> sizes = {{600, 1}, {300, 0}, {100, 3}, {120, 2}, {50, 1}};
    fs::create_directories(path);
    for (std::size_t i = 0; i < sizes.size(); ++i) {
      Scene scene = scene_at(20.0f * static_cast<float>(i), sizes[i].first, sizes[i].second);
      scene.cloud.antialiased = marked || i == 1;
      save_scene(path / "d.sog", scene, {}, SceneFormat::kSog);
      if (i != 3) unzip(path / "d.sog", path / (i == 4 ? "env" : fs::path(names[i]).parent_path()));
    }
    Scene last = scene_at(60, 120, 2);
    last.cloud.antialiased = marked;
    save_scene(path / "d.sog", last, {}, SceneFormat::kSog);
    index = {{"version", 1},
             {"count", 1},
             {"counts", {1, 1}},
             {"lodLevels", 2},
             {"environment", "env/meta.json"},
             {"filenames", names}};
    index["tree"] = inner(
        {leaf({{"0", level(0, 100, 300)}, {"1", level(2, 0, 40)}}),
         inner({leaf({{"0", level(1, 0, 300)}}), leaf({{"10", level(0, 0, 50)}, {"9", level(0, 450, 100)}})}),
         leaf({{"0", level(3, 0, 0)}, {"1", level(3, 20, 100)}, {"2", level(2, 40, 60)}})});
  }
  fs::path write_index(const json& value) const {
    write(path / "lod-meta.json", value.dump());
    return path / "lod-meta.json";
  }
  std::string refused(const json& value) const { return refusal(write_index(value)); }
  std::string refused_tree(const json& tree) const {
    json changed = index;
    changed["tree"] = tree;
    return refused(changed);
  }
};

struct Taken {
  const char* file;
  std::size_t first, count;
};

// Each Gaussian is that of its piece, to the last bit; what its piece has no coefficients for is zero.
void check_taken(const Scene& got, const fs::path& folder, const std::vector<Taken>& taken) {
  std::vector<std::size_t> at_row(got.file_rows, got.cloud.size());
  for (std::size_t g = 0; g < got.cloud.size(); ++g) at_row[got.cloud.file_row[g]] = g;
  std::size_t row = 0;
  for (const Taken& part : taken) {
    CAPTURE(part.file);
    const GaussianCloud piece = load_scene(folder / part.file).cloud;
    std::size_t found = 0, different = 0;
    for (std::size_t i = 0; i < piece.size(); ++i) {
      if (piece.file_row[i] < part.first || piece.file_row[i] >= part.first + part.count) continue;
      ++found;
      const std::size_t g = at_row.at(row + piece.file_row[i] - part.first);
      REQUIRE(g < got.cloud.size());
      bool same = got.cloud.position[g] == piece.position[i] && got.cloud.scale[g] == piece.scale[i] &&
                  got.cloud.rotation[g] == piece.rotation[i] && got.cloud.opacity[g] == piece.opacity[i] &&
                  got.cloud.f_dc[g] == piece.f_dc[i];
      const std::size_t own = piece.sh_stride() / 3, all = got.cloud.sh_stride() / 3;
      for (std::size_t c = 0; c < 3; ++c)
        for (std::size_t k = 0; k < all; ++k)
          same = same &&
                 got.cloud.sh_rest_of(g)[c * all + k] == (k < own ? piece.sh_rest_of(i)[c * own + k] : 0.0f);
      different += !same;
    }
    CHECK(found == part.count);
    CHECK(different == 0);
    row += part.count;
  }
  CHECK(got.cloud.size() == row);
  CHECK(got.file_rows == row);
}

const std::vector<Taken> kTaken = {{"0_0/meta.json", 100, 300},
                                   {"0_1/meta.json", 0, 300},
                                   {"0_0/meta.json", 450, 100},
                                   {"d.sog", 20, 100},
                                   {"env/meta.json", 0, 50}};

}  // namespace

TEST_CASE(
    "streamed sog: the finest level of every leaf and the environment, value by value, on any threads") {
  const Streamed made;
  made.write_index(made.index);
  const Scene scene = load_scene(made.path);
  CHECK(scene.format == SceneFormat::kStreamedSog);
  CHECK(scene.path == made.path / "lod-meta.json");
  CHECK(scene.cloud.sh_degree == 2);
  CHECK(scene.dropped == 0);
  CHECK_FALSE(scene.cloud.antialiased);
  CHECK(mentions(scene.left_out, {"Coarser levels", "finest"}));
  check_taken(scene, made.path, kTaken);
  tbb::task_arena(1).execute([&] { check_equal(load_scene(made.path).cloud, scene.cloud); });
}

TEST_CASE("streamed sog: a coarser level where a leaf has one, else the coarsest that it has") {
  const Streamed made;
  LoadOptions options;
  options.lod = 2;
  const Scene scene = load_scene(made.write_index(made.index), options);
  check_taken(scene, made.path,
              {{"1_0/meta.json", 0, 40},
               {"0_1/meta.json", 0, 300},
               {"0_0/meta.json", 450, 100},
               {"1_0/meta.json", 40, 60},
               {"env/meta.json", 0, 50}});
  CHECK(mentions(scene.left_out, {"level of detail 2"}));
  for (const std::string name :
       made.index["filenames"])  // also of other levels: nothing is written over them
    CHECK(std::ranges::count(scene.files, made.path / name) > 0);
  options.lod = 1;
  CHECK(load_scene(made.path, options).cloud.size() == 40 + 300 + 100 + 100 + 50);
  options.lod = 100;
  CHECK(load_scene(made.path, options).cloud.size() == 40 + 300 + 50 + 60 + 50);
  const SceneLevels levels = levels_of(made.path);  // without the environment, 50
  CHECK(levels.gaussians.size() == 11);             // as one leaf has a level 10
  CHECK(levels.gaussians[0] == 800);
  CHECK(levels.gaussians[1] == 540);
  CHECK(levels.gaussians[10] == 450);
  CHECK(levels.sh_degree == 1);
  CHECK_THROWS_WITH_AS(load_scene(made.path / "d.sog", options), doctest::Contains("no levels of detail"),
                       Error);
}

TEST_CASE(
    "streamed sog: under another name, of older writers, of one level, without or only an environment") {
  const Streamed made(true);
  json old = made.index;
  for (const char* key : {"version", "count", "counts"}) old.erase(key);
  old["environment"] = nullptr;
  write(made.path / "renamed.json", old.dump(2));
  const Scene scene = load_scene(made.path / "renamed.json");
  check_taken(scene, made.path, {kTaken.begin(), kTaken.end() - 1});
  CHECK(scene.cloud.antialiased);

  json one = made.index;
  one["tree"] = leaf({{"0", level(2, 7, 90)}});
  one["filenames"][2] = "./d.sog/../1_0//meta.json";
  const Scene single = load_scene(made.write_index(one));
  check_taken(single, made.path, {{"1_0/meta.json", 7, 90}, kTaken.back()});
  CHECK(single.left_out.empty());
  CHECK(single.cloud.sh_degree == 3);

  one["tree"] = leaf(json::object());
  one["filenames"] = json::array();
  check_taken(load_scene(made.write_index(one)), made.path, {kTaken.back()});
}

TEST_CASE(
    "streamed sog: what was read is written in every format; progress is said and stopping is no error") {
  const Streamed made;
  made.write_index(made.index);
  const Scene scene = load_scene(made.path);
  for (const SceneFormat& to : both_ways()) {
    const fs::path path = made.folder / fmt::format("b{}", to.extension);
    save_scene(path, scene, {}, to);
    CHECK(load_scene(path).cloud.size() == 850);
  }
  CHECK_THROWS_WITH_AS(save_scene(made.folder / "lod-meta.json", scene, {}, SceneFormat::kStreamedSog),
                       doctest::Contains("only read"), Error);
  std::vector<double> unpacked;
  std::stop_source stop;
  const Job job{stop.get_token(), [&](std::string_view stage, double fraction) {
                  if (stage != "unpacking pictures") return;
                  unpacked.push_back(fraction);
                  if (fraction > 0.4) stop.request_stop();
                }};
  load_scene(made.path, job);
  CHECK(unpacked == std::vector<double>{0, 0.25, 0.5});
}

QUICK_CASE("streamed sog",
           "streamed sog: ranges, numbers and trees that cannot be are refused with a sentence") {
  const Streamed made;
  const auto with_range = [&](const json& range) { return made.refused_tree(leaf({{"0", range}})); };
  CHECK(
      mentions(with_range(level(0, 500, 101)), {"lod-meta.json", "500 to 601 of 0_0/meta.json", "has 600"}));
  CHECK(mentions(with_range(level(4, 0, 1)), {"piece 4", "of 4", "Write it again"}));
  CHECK(mentions(with_range(level(-1, 0, 1)), {"file of a leaf is -1"}));
  CHECK(mentions(with_range(level(0, -1, 1)), {"offset of a leaf is -1"}));
  CHECK(mentions(with_range(level(0, 0, -5)), {"count of a leaf is -5"}));
  CHECK(mentions(with_range({{"file", 0}, {"offset", 0}, {"count", 4294967296}}), {"4294967296", "up to"}));
  CHECK(mentions(with_range({{"file", 0}, {"offset", 1e300}, {"count", 1}}), {"offset", "1e+300"}));
  CHECK(mentions(with_range({{"file", 0}, {"offset", 0}, {"count", 4294967295}}), {"which has 600"}));
  CHECK(mentions(with_range({{"file", "a"}, {"offset", 0}, {"count", 1}}), {"file of a leaf is string"}));
  CHECK(mentions(with_range({{"offset", 0}, {"count", 1}}), {"not the index", "'file'"}));
  CHECK(mentions(with_range(7), {"not the index"}));
  CHECK(mentions(made.refused_tree(leaf({{"fine", level(0, 0, 1)}})), {"\"fine\"", "no number"}));
  CHECK(mentions(made.refused_tree(leaf({{"-1", level(0, 0, 1)}})), {"\"-1\"", "no number"}));
  CHECK(mentions(made.refused_tree(leaf(json::array({level(0, 0, 1)}))), {"have no numbers"}));
  const json twice = leaf({{"0", level(0, 10, 20)}});
  CHECK(mentions(made.refused_tree(inner({twice, leaf({{"0", level(0, 29, 5)}})})),
                 {"two leaves", "same Gaussians of 0_0/meta.json"}));
  CHECK(mentions(made.refused_tree(inner({twice, twice})), {"two leaves"}));
  json both = twice;
  both["children"] = {twice};
  CHECK(mentions(made.refused_tree(both), {"both children and levels"}));
  CHECK(mentions(made.refused_tree(inner({json(3)})), {"a node of its tree is number"}));
  CHECK(mentions(made.refused_tree({{"children", "many"}}), {"are no list"}));
  CHECK(mentions(made.refused_tree(nullptr), {"a node of its tree is null"}));
  json deep = twice;
  for (int i = 0; i < 1001; ++i) deep = json::object({{"children", json::array({std::move(deep)})}});
  CHECK(mentions(made.refused_tree(deep), {"deeper than 1000"}));

  std::string bottomless = "{\"filenames\": [], \"tree\": ";
  for (int i = 0; i < 100000; ++i) bottomless += "{\"children\": [";
  write(made.path / "lod-meta.json", bottomless);
  CHECK(mentions(refusal(made.path), {"lod-meta.json", "nested deeper than 4000"}));
  for (int i = 0; i < 100000; ++i) bottomless += "]}";
  write(made.path / "lod-meta.json", bottomless + "}");
  CHECK(mentions(refusal(made.path), {"nested deeper than 4000"}));
}

QUICK_CASE(
    "streamed sog",
    "streamed sog: names that leave the folder, files that are missing or others, and other versions") {
  const Streamed made;
  const auto with = [&](const char* key, const json& value) {
    json changed = made.index;
    changed[key] = value;
    return made.refused(changed);
  };
  write(made.folder / "meta.json", text_of(made.path / "env/meta.json"));
  const std::string outside = (made.path / "0_0/meta.json").string();
  for (const std::string name : {"../meta.json", "0_0/../../meta.json", "..", "", outside.c_str()})
    CHECK(mentions(with("filenames", {name, "0_1/meta.json", "1_0/meta.json", "d.sog"}),
                   {"not in its folder"}));
  CHECK(mentions(with("filenames", {std::string("d.sog\0a", 7), "0_1/meta.json", "d.sog", "d.sog"}),
                 {"not in its folder"}));
  CHECK(mentions(with("environment", "../meta.json"), {"\"../meta.json\"", "not in its folder"}));
  CHECK(mentions(with("environment", "0_0/./meta.json"), {"environment is also a piece"}));
  CHECK(mentions(with("environment", "gone/meta.json"), {"piece gone/meta.json is missing", "whole folder"}));
  CHECK(mentions(with("environment", "env"), {"env", "directory"}));
  CHECK(mentions(with("environment", 3), {"not the index", "type must be string"}));
  CHECK(mentions(with("environment", "lod-meta.json"), {"lod-meta.json", "not that of a .sog"}));
  CHECK(mentions(with("filenames", {1, 2, 3, 4}), {"not the index"}));
  CHECK(mentions(with("filenames", "0_0/meta.json"), {"not the index"}));
  CHECK(mentions(with("version", 2), {"version 2 of a streamed scene", "not supported"}));
  CHECK(mentions(with("version", "two"), {"version string"}));
  json none = made.index;
  none.erase("environment");
  none["tree"] = inner({});
  CHECK(mentions(made.refused(none), {"holds no Gaussians"}));
  none.erase("tree");
  CHECK(mentions(made.refused(none), {"not the index", "'tree'"}));

  made.write_index(made.index);
  write(made.path / "1_0/quats.webp", "RIFF no");  // of a level that is not taken
  CHECK(load_scene(made.path).cloud.size() == 850);
  write(made.path / "0_1/quats.webp", "RIFF no");
  CHECK(mentions(refusal(made.path), {"0_1/quats.webp", "no WebP"}));
  fs::remove(made.path / "0_1/quats.webp");
  CHECK(mentions(refusal(made.path), {"0_1/quats.webp", "cannot be opened"}));
  fs::remove_all(made.path / "0_1");
  CHECK(mentions(refusal(made.path), {"piece 0_1/meta.json is missing"}));
}

TEST_CASE("streamed sog: many names of small files that unpack to much are refused before they take memory") {
  const Streamed made;
  constexpr int kWidth = 512, kNames = 40;
  const std::vector<std::byte> bytes = write_webp(Image<Rgba8>(kWidth, kWidth, {0, 0, 0, 255}));
  const std::string picture(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  write(made.path / "p.webp", picture);
  json meta = {{"version", 2}, {"count", kWidth * kWidth}};
  meta["means"] = {{"mins", {0, 0, 0}}, {"maxs", {1, 1, 1}}, {"files", {"p.webp", "p.webp"}}};
  for (const char* part : {"quats", "scales", "sh0"})
    meta[part] = {{"codebook", {0.0, 1.0}}, {"files", {"p.webp"}}};
  json index = made.index, leaves = json::array();
  index["filenames"] = json::array();
  for (int i = 0; i < kNames; ++i) {
    const std::string name = fmt::format("m{}.json", i);
    write(made.path / name, meta.dump());
    index["filenames"].push_back(name);
    leaves.push_back(leaf({{"0", level(i, 0, 1)}}));
  }
  index["tree"] = inner(leaves);
  CHECK(mentions(made.refused(index), {"lod-meta.json", "damaged", "no scene packs so well"}));
}
