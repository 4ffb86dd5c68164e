#include "scene/formats/merged_scene.h"

#include "scene/cloud/morton.h"
#include "scene_file_helpers.h"

using namespace splatcut;
using namespace splatcut::testing;

namespace {

constexpr glm::vec3 kAside{20, 0, 0};  // the clouds of varied_cloud() reach 5 units far

Scene scene_of(GaussianCloud cloud) {
  Scene scene;
  scene.file_rows = cloud.size();
  scene.cloud = std::move(cloud);
  return scene;
}

GaussianCloud moved_aside(GaussianCloud cloud) {
  for (glm::vec3& position : cloud.position) position += kAside;
  return cloud;
}

// Gaussians by row: what they are, whatever their order in memory.
GaussianCloud in_file_order(const Scene& scene) {
  std::vector<std::uint32_t> order(scene.cloud.size());
  for (std::size_t g = 0; g < order.size(); ++g) order[g] = static_cast<std::uint32_t>(g);
  std::ranges::sort(order, {}, [&](std::uint32_t g) { return scene.cloud.file_row[g]; });
  return permuted(scene.cloud, order);
}

// The Gaussians of `part` stand in `whole` from row `begin` on, with harmonics beyond their own all zero.
void check_part(const GaussianCloud& part, const GaussianCloud& whole, std::size_t begin) {
  REQUIRE(whole.size() >= begin + part.size());
  const auto had = static_cast<std::size_t>(sh_rest_coefficients(part.sh_degree));
  const auto has = static_cast<std::size_t>(sh_rest_coefficients(whole.sh_degree));
  float worst = 0;  // of what a .ply keeps as logarithms
  bool equal = true;
  for (std::size_t i = 0; i < part.size(); ++i) {
    const std::size_t g = begin + i;
    equal = equal && whole.position[g] == part.position[i] && whole.f_dc[g] == part.f_dc[i];
    for (std::size_t k = 0; k < 3 * has; ++k) {
      const float expected = k % has < had ? part.sh_rest_of(i)[k / has * had + k % has] : 0;
      equal = equal && whole.sh_rest_of(g)[k] == expected;
    }
    worst = std::max(worst, std::abs(whole.opacity[g] - part.opacity[i]));
    worst = std::max(worst, glm::length(whole.scale[g] / part.scale[i] - 1.0f));
    worst = std::max(worst, 1 - std::abs(glm::dot(whole.rotation[g], part.rotation[i])));
  }
  CHECK(equal);
  CHECK(worst < 1e-5f);
}

}  // namespace

TEST_CASE("merge: files of other formats and degrees keep place, colour and order through a .ply") {
  const Folder folder;
  save_scene(folder / "a.ply", scene_of(varied_cloud(300, 1)), {}, SceneFormat::kPly);
  save_scene(folder / "b.spz", scene_of(moved_aside(varied_cloud(200, 3))), {}, SceneFormat::kSpz);
  save_scene(folder / "c.splat", scene_of(varied_cloud(100, 0)), {}, SceneFormat::kSplat);
  const Scene a = load_scene(folder / "a.ply"), b = load_scene(folder / "b.spz"),
              c = load_scene(folder / "c.splat");
  const MergedScene whole = merged({a, b, c});
  CHECK(whole.loss.empty());
  CHECK(whole.scene.file_rows == 600);
  CHECK(whole.scene.cloud.sh_degree == 3);
  const SaveReport report = save_scene(folder / "abc.ply", whole.scene, {}, SceneFormat::kPly);
  CHECK(report.gaussians == 600);
  CHECK(report.loss.empty());
  const GaussianCloud read = in_file_order(load_scene(folder / "abc.ply"));
  REQUIRE(read.size() == 600);
  check_part(in_file_order(a), read, 0);
  check_part(in_file_order(b), read, 300);
  check_part(in_file_order(c), read, 500);
}

TEST_CASE("merge: every format that is written takes all parts, each at its place") {
  const Folder folder;
  const Scene near = scene_of(varied_cloud(300, 2)), far = scene_of(moved_aside(varied_cloud(200, 0)));
  const MergedScene whole = merged({near, far});
  for (const SceneFormat& format : both_ways()) {
    CAPTURE(std::string(format.name));
    const std::filesystem::path path = folder / (std::string("whole") + format.extension);
    CHECK(save_scene(path, whole.scene, {}, format).gaussians == 500);
    const Scene read = load_scene(path);
    CHECK(read.cloud.size() == 500);
    CHECK(std::ranges::count_if(read.cloud.position, [](const glm::vec3& p) { return p.x > 10; }) == 200);
  }
}

TEST_CASE("merge: Gaussians lie in Morton order, which compact formats rely on") {
  const MergedScene whole =
      merged({scene_of(varied_cloud(3000, 0)), scene_of(moved_aside(varied_cloud(1000, 0)))});
  const std::vector<std::uint32_t> order = morton_order(whole.scene.cloud.position);
  CHECK(std::ranges::is_sorted(order));
  CHECK(whole.scene.cloud.near_plane == near_plane_of(whole.scene.cloud));
}

TEST_CASE("merge: rows that were dropped leave no gap in the file and do not shift others") {
  const Folder folder;
  GaussianCloud holed = varied_cloud(10, 0);
  holed.position[4].y = kNan;
  save_scene(folder / "holed.ply", scene_of(holed), {}, SceneFormat::kPly);
  const Scene a = load_scene(folder / "holed.ply"), b = scene_of(varied_cloud(6, 0));
  REQUIRE(a.dropped == 1);
  const MergedScene whole = merged({a, b, a});
  CHECK(whole.scene.file_rows == 26);
  CHECK(whole.scene.dropped == 2);
  save_scene(folder / "whole.ply", whole.scene, {}, SceneFormat::kPly);
  const GaussianCloud read = in_file_order(load_scene(folder / "whole.ply"));
  REQUIRE(read.size() == 24);
  check_part(in_file_order(a), read, 0);
  check_part(b.cloud, read, 9);
  check_part(in_file_order(a), read, 15);
}

TEST_CASE("merge: the mark of antialiasing stays where all have it, else a sentence says whose is lost") {
  Scene marked = scene_of(varied_cloud(10, 0)), plain = marked;
  marked.cloud.antialiased = true;
  marked.path = "marked.spz";
  CHECK(merged({marked, marked}).scene.cloud.antialiased);
  CHECK(merged({marked, marked}).loss.empty());
  CHECK(merged({plain, plain}).loss.empty());
  const MergedScene mixed = merged({plain, marked});
  CHECK_FALSE(mixed.scene.cloud.antialiased);
  CHECK(mentions(mixed.loss, {"marked.spz", "antialiasing is left out"}));
}

TEST_CASE("merge: columns of a .ply that say nothing of Gaussians are lost, and it is said") {
  const Folder folder;
  std::vector<std::string> names = splat_names(0);
  names.emplace_back("segment");
  write(folder / "more.ply", numbered_ply(names, 20));
  const Scene more = load_scene(folder / "more.ply");
  const MergedScene whole = merged({more, more});
  CHECK(whole.scene.other_properties == std::vector<std::string>{"nx", "ny", "nz", "segment"});
  CHECK(mentions(save_scene(folder / "whole.ply", whole.scene, {}, SceneFormat::kPly).loss,
                 {"4 properties are left out, \"nx\" among them"}));
}

TEST_CASE("merge: more rows than a row number can count are refused") {
  Scene large = scene_of(varied_cloud(10, 0));
  large.path = "large.ply";
  large.file_rows = std::size_t{1} << 31;
  std::string said;
  try {
    merged({large, large});
  } catch (const Error& error) {
    said = error.what();
  }
  CHECK(mentions(said, {"large.ply", "4294967296", "more than can be handled"}));
}
