// Every format against every other.
#include <fmt/format.h>

#include "format_limits.h"
#include "ksplat_by_hand.h"

using namespace splatcut;
using namespace splatcut::testing;

namespace {

void check_pair(const Folder& folder, const Scene& from, const SceneFormat& to) {
  const FormatLimits& expected = limits().at(to.name);
  const fs::path path = folder / fmt::format("b{}", to.extension);
  const SaveReport report = save_scene(path, from, {}, to);
  CHECK(report.gaussians == from.cloud.size());
  CHECK(report.bytes == fs::file_size(path));
  const FormatPlan plan = to.plan(from, all_gaussians(from.cloud), false);
  CHECK(static_cast<double>(plan.bytes) ==
        doctest::Approx(static_cast<double>(report.bytes)).epsilon(plan.about ? 1.0 : 0.05));
  const bool lossless = std::string_view(to.name) == "ply" || std::string_view(to.name) == "glb";
  CHECK(report.loss.empty() == lossless);
  const Scene got = load_scene(path);
  CHECK(got.format == to);
  CHECK(got.dropped == 0);
  CHECK(got.cloud.sh_degree == (expected.drops_sh ? 0 : from.cloud.sh_degree));
  check_same(as_written(from, expected.reorders), got, expected.limit);
}

}  // namespace

TEST_CASE("pairs: from every format into every other, each value within the steps of the second") {
  const Folder folder;
  for (const SceneFormat& from : both_ways()) REQUIRE(limits().contains(from.name));
  for (int degree = 0; degree <= 3; ++degree) {
    Scene made;
    made.cloud = varied_cloud(1200, degree);
    for (const SceneFormat& from : both_ways()) {
      const fs::path path = folder / fmt::format("a{}", from.extension);
      save_scene(path, made, {}, from);
      Scene scene = load_scene(path);
      scene.rows_can_be_copied = false;  // rows of .ply are written anew, too
      for (const SceneFormat& to : both_ways()) {
        CAPTURE(degree);
        CAPTURE(from.name);
        CAPTURE(to.name);
        check_pair(folder, scene, to);
      }
    }
  }
}

TEST_CASE("pairs: what is read only goes into every other format, and is refused as a target") {
  const Folder folder;
  for (int level = 0; level <= 2; ++level) {
    write(folder / "a.ksplat", ksplat_by_hand(level));
    const Scene scene = load_scene(folder / "a.ksplat");
    for (const SceneFormat& to : both_ways()) {
      const fs::path path = folder / fmt::format("b{}", to.extension);
      save_scene(path, scene, {}, to);
      CHECK(load_scene(path).cloud.size() == 4);
    }
  }
  Scene scene;
  scene.cloud = varied_cloud(3, 0);
  CHECK_THROWS_WITH_AS(save_scene(folder / "c.ksplat", scene, {}, SceneFormat::kKsplat),
                       doctest::Contains("only read"), Error);
  CHECK_FALSE(fs::exists(folder / "c.ksplat"));
}

TEST_CASE(
    "pairs: a .sog written again loses no more than half a step of rotation, and the same scene gives the "
    "same bytes") {
  const Folder folder;
  Scene scene;
  scene.cloud = varied_cloud(3000, 2);
  scene.cloud.opacity[5] = 0;  // its colour stays, too
  save_scene(folder / "a.sog", scene, {}, SceneFormat::kSog);
  save_scene(folder / "b.sog", scene, {}, SceneFormat::kSog);
  CHECK(text_of(folder / "a.sog") == text_of(folder / "b.sog"));
  const Scene once = load_scene(folder / "a.sog");
  save_scene(folder / "c.sog", once, {}, SceneFormat::kSog);
  const Scene twice = load_scene(folder / "c.sog");
  check_same(as_written(once, true), twice, {2e-6f, 1e-6f, limits().at("sog").limit.rotation, 0, 0, 0});
  scene.cloud.antialiased = true;
  CHECK(save_scene(folder / "d.sog", scene, {}, SceneFormat::kSog).loss.find("antialiasing") ==
        std::string::npos);
  CHECK(load_scene(folder / "d.sog").cloud.antialiased);
}
