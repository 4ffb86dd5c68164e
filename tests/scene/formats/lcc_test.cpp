// .lcc, its files made by hand.
#include <fmt/format.h>

#include "quick.h"
#include "scene/cloud/quantise.h"
#include "scene_file_helpers.h"

using namespace splatcut;
using namespace splatcut::testing;

namespace {

using Shorts = std::array<std::uint16_t, 3>;

// Opaque red, the quaternion x y z w = (1, 0, 0, 1) / sqrt(2) to a step: y and z by the middle of 10 bits.
std::string row_at(const glm::vec3& p, const Shorts& scale) {
  std::string row = bytes_of(p.x) + bytes_of(p.y) + bytes_of(p.z) + std::string("\xff\x00\x33\xff", 4);
  for (const std::uint16_t s : scale) row += bytes_of(s);
  constexpr std::uint32_t kLargestIsW = 3;
  row += bytes_of(1023u | 512u << 10 | 512u << 20 | kLargestIsW << 30);
  return row + std::string(6, '\0');  // a normal
}

// 15 coefficients: the red one of z, which is the second, at the end of its range.
std::string harmonics_row() {
  std::string row;
  for (int k = 0; k < 15; ++k) row += bytes_of(k == 1 ? 0x7ffu : 0u);
  return row + std::string(4, '\0');
}

struct Level {
  std::uint32_t count;
  std::uint64_t begin;
};
std::string unit(std::initializer_list<Level> levels) {
  std::string text(4, '\0');  // its place on the ground
  for (const Level& level : levels)
    text += bytes_of(level.count) + bytes_of(level.begin) + bytes_of(level.count * 32);
  return text;
}

const char* const kRanges = R"({"name": "scale", "min": [0.1, 0.2, 0.3], "max": [1.1, 1.2, 1.3]},
  {"name": "shcoef", "min": [0, 0, 0], "max": [1, 2, 4]},
  {"name": "envscale", "min": [5, 5, 5], "max": [6, 6, 6]}, {"name": "envshcoef", "min": [0, 0, 0], "max": [3, 3, 3]})";

// Two units and two levels of detail: A | B, C finest, D coarsest; E around them.
void write_lcc(const Folder& folder, const std::string& type, const std::string& ranges = kRanges) {
  write(folder / "a.lcc", fmt::format(R"({{"version": "5.0", "totalLevel": 2, {} "attributes": [{}]}})",
                                      type.empty() ? "" : fmt::format(R"("fileType": "{}",)", type), ranges));
  write(folder / "index.bin", unit({{1, 0}, {0, 0}}) + unit({{2, 32}, {1, 96}}));
  write(folder / "data.bin", row_at({1, 2, 3}, {0, 65535, 32768}) + row_at({4, 5, 6}, {0, 0, 0}) +
                                 row_at({7, 8, 9}, {0, 0, 0}) + row_at({10, 11, 12}, {65535, 65535, 65535}));
  std::string harmonics;
  for (int row = 0; row < 4; ++row) harmonics += harmonics_row();
  write(folder / "shcoef.bin", harmonics);
  write(folder / "environment.bin",
        row_at({100, 200, 300}, {65535, 0, 0}) + (type == "Portable" ? "" : harmonics_row()));
}

std::vector<glm::vec3> positions_in_file_order(const Scene& scene) {
  std::vector<glm::vec3> positions(scene.file_rows);
  for (std::size_t g = 0; g < scene.cloud.size(); ++g)
    positions[scene.cloud.file_row[g]] = scene.cloud.position[g];
  return positions;
}

std::size_t gaussian_of(const Scene& scene, std::uint32_t row) {
  return static_cast<std::size_t>(std::ranges::find(scene.cloud.file_row, row) -
                                  scene.cloud.file_row.begin());
}

}  // namespace

QUICK_CASE("lcc", "lcc: known values of the finest level and what lies around, z up become y down") {
  const Folder folder;
  write_lcc(folder, "Quality");
  const Scene scene = load_scene(folder / "a.lcc");
  CHECK(scene.format == SceneFormat::kLcc);
  CHECK(positions_in_file_order(scene) ==
        std::vector<glm::vec3>{{1, -3, 2}, {4, -6, 5}, {7, -9, 8}, {100, -300, 200}});
  CHECK(scene.left_out == "Of its 2 levels of detail, level 0 is read, 0 the finest");
  CHECK(scene.files == std::vector<fs::path>{folder / "a.lcc", folder / "index.bin", folder / "data.bin",
                                             folder / "shcoef.bin", folder / "environment.bin"});
  const auto a = gaussian_of(scene, 0), around = gaussian_of(scene, 3);
  CHECK(glm::length(scene.cloud.scale[a] - glm::vec3(0.1f, 1.2f, 0.3f + 32768.0f / 65535)) < 1e-6f);
  CHECK(glm::length(scene.cloud.scale[around] - glm::vec3(6, 5, 5)) < 1e-6f);
  CHECK(scene.cloud.opacity[a] == 1);
  CHECK(glm::length(colour_from_f_dc(scene.cloud.f_dc[a]) - glm::vec3(1, 0, 0.2f)) < 1e-6f);
  // A quarter turn about x in the file, and another to our axes: half a turn.
  const glm::mat3 turned = glm::mat3_cast(scene.cloud.rotation[a]);
  CHECK(glm::length(turned[0] - glm::vec3(1, 0, 0)) < 2e-3f);
  CHECK(glm::length(turned[1] - glm::vec3(0, -1, 0)) < 2e-3f);
  // What is brighter from +z of the file is so from -y here: the coefficient of -y.
  REQUIRE(scene.cloud.sh_degree == 3);
  for (std::size_t i = 0; i < 45; ++i) {
    CHECK(scene.cloud.sh_rest_of(static_cast<std::uint32_t>(a))[i] ==
          doctest::Approx(i == 0 ? 1 : 0).scale(1e5));
    CHECK(scene.cloud.sh_rest_of(static_cast<std::uint32_t>(around))[i] ==
          doctest::Approx(i == 0 ? 3 : 0).scale(1e5));
  }
}

TEST_CASE("lcc: a level by its number, the coarsest beyond the last, the folder for the file, no harmonics") {
  const Folder folder;
  write_lcc(folder, "Quality");
  LoadOptions coarse;
  for (const unsigned level : {1u, 7u}) {
    coarse.lod = level;
    const Scene scene = load_scene(folder.path, coarse);
    CHECK(scene.path == folder / "a.lcc");
    CHECK(positions_in_file_order(scene) == std::vector<glm::vec3>{{10, -12, 11}, {100, -300, 200}});
    CHECK(scene.left_out == "Of its 2 levels of detail, level 1 is read, 0 the finest");
  }
  CHECK(levels_of(folder.path).gaussians == std::vector<std::uint64_t>{3, 1});
  CHECK(levels_of(folder.path).sh_degree == 3);
  write_lcc(folder, "");  // as older files are: the range says that there are spherical harmonics
  CHECK(load_scene(folder / "a.lcc").cloud.sh_degree == 3);
  write_lcc(folder, "Portable");
  fs::remove(folder / "shcoef.bin");
  CHECK(load_scene(folder / "a.lcc").cloud.sh_degree == 0);
  CHECK(load_scene(folder / "a.lcc").file_rows == 4);
  write(folder / "environment.bin", "");
  CHECK(load_scene(folder / "a.lcc").file_rows == 3);
  CHECK(load_scene(folder / "a.lcc").oddity == "environment.bin beside it is empty");
  fs::remove(folder / "environment.bin");
  CHECK(load_scene(folder / "a.lcc").file_rows == 3);
}

QUICK_CASE("lcc", "lcc: damaged files are refused, each with what is wrong") {
  const Folder folder;
  const auto check = [&](const char* name, const std::string& content,
                         std::initializer_list<const char*> said) {
    write_lcc(folder, "Quality");
    write(folder / name, content);
    CHECK(mentions(refusal(folder / "a.lcc"), said));
  };
  write_lcc(folder, "Quality");
  const std::string data = text_of(folder / "data.bin"), harmonics = text_of(folder / "shcoef.bin"),
                    around = text_of(folder / "environment.bin"), text = text_of(folder / "a.lcc");
  check("index.bin", unit({{1, 0}, {0, 0}}).substr(0, 35), {"35 bytes", "2 levels"});
  check("index.bin", unit({{5, 0}, {0, 0}}), {"5 Gaussians from byte 0", "128"});
  check("index.bin", unit({{1, 8}, {0, 0}}), {"byte 8"});
  check("index.bin", unit({{1, ~std::uint64_t{0} - 31}, {0, 0}}), {"18446744073709551584"});
  check("index.bin", unit({{4294967295u, 0}, {0, 0}}), {"4294967295 Gaussians"});
  check("data.bin", data.substr(0, 90), {"which has 90"});
  check("shcoef.bin", harmonics.substr(0, 150), {"shcoef.bin", "truncated"});
  check("environment.bin", around.substr(0, 95), {"environment.bin", "truncated", "95 bytes"});
  for (const char* name : {"index.bin", "data.bin", "shcoef.bin"}) {
    write_lcc(folder, "Quality");
    fs::remove(folder / name);
    CHECK(mentions(refusal(folder / "a.lcc"), {name, "missing beside it"}));
  }
  check("a.lcc", text.substr(0, 40), {"not valid JSON"});
  check("a.lcc", R"({"totalLevel": 2})", {"attributes"});
  check("a.lcc", R"({"totalLevel": 0, "attributes": []})", {"levels is 0"});
  check("a.lcc", R"({"totalLevel": 2, "attributes": []})", {"no range of scales"});
  check("a.lcc",
        R"({"totalLevel": 2, "attributes": [{"name": "scale", "min": [0, 0, 1e30], "max": [1, 1, 1]}]})",
        {"goes beyond 1e+15"});
  check("a.lcc", R"({"totalLevel": 2, "attributes": [{"name": "scale", "min": [0], "max": [1, 1, 1]}]})",
        {"not the text of an .lcc"});
}
