// .spz and compressed .ply, written by hand and by our own writers.
#include <fmt/format.h>

#include "output_helpers.h"
#include "quick.h"
#include "scene_file_helpers.h"
#include "synthetic_cloud.h"

using namespace splatcut;
using namespace splatcut::testing;

QUICK_CASE("compressed.ply", "compressed ply: values within the steps of a chunk") {
  const Folder folder;
  for (int degree = 0; degree <= 3; ++degree) {
    Scene scene;
    scene.cloud = varied_cloud(700, degree);
    save_scene(folder / "a.compressed.ply", scene, {}, SceneFormat::kCompressedPly);
    const Scene got = load_scene(folder / "a.compressed.ply");
    CHECK(got.format == SceneFormat::kCompressedPly);
    // The writer keeps the cloud's order, so rows are indices: half a step of 10 bits over the range
    check_same(scene.cloud, got,
               {10 * 0.51f / 1023, 2 * 0.51f / 1023, 1e-5f, 0.51f / 255, 2 * 0.51f / 255, 0.51f * 8 / 256});
  }
}

QUICK_CASE("spz", "spz: versions 1 and 2 by hand, axes turned to x right, y down, z forward") {
  const Folder folder;
  const auto file = [](std::uint32_t version, const std::string& position, const std::string& rotation) {
    std::string text =
        "NGSP" + bytes_of(version) + bytes_of(std::uint32_t{1}) + std::string("\x01\x08\x00\x00", 4);
    text += position + "\xff" + std::string("\x80\x00\xff", 3) + std::string("\xa0\x90\x00", 3) + rotation;
    return gzip(text + "\xc0\x80\x80\xc0\x80\x80\xc0\x80\x80");  // red of y, z, x: 0.5
  };
  // half floats 1, 2, -0.5; 24-bit numbers 1, 2, -0.5 with 8 fractional bits
  write(folder / "1.spz", file(1, std::string("\x00\x3c\x00\x40\x00\xb8", 6), "\xff\x80\x80"));
  write(folder / "2.spz", file(2, std::string("\x00\x01\x00\x00\x02\x00\x80\xff\xff", 9), "\x80\xff\x80"));
  for (const char* name : {"1.spz", "2.spz"}) {
    const Scene scene = load_scene(folder / name);
    REQUIRE(scene.cloud.size() == 1);
    CHECK(scene.cloud.position[0] == glm::vec3(1, -2, 0.5f));
    CHECK(scene.cloud.opacity[0] == 1.0f);
    CHECK(scene.cloud.scale[0].x == doctest::Approx(1.0));
    CHECK(scene.cloud.scale[0].y == doctest::Approx(std::exp(-1.0)));
    CHECK(scene.cloud.f_dc[0].z == doctest::Approx(0.5 / 0.15));
    CHECK(scene.cloud.sh_rest_of(0)[0] == -0.5f);  // y
    CHECK(scene.cloud.sh_rest_of(0)[1] == -0.5f);  // z
    CHECK(scene.cloud.sh_rest_of(0)[2] == 0.5f);   // x
  }
  CHECK(load_scene(folder / "1.spz").cloud.rotation[0].x == doctest::Approx(1).epsilon(0.01));
  CHECK(load_scene(folder / "2.spz").cloud.rotation[0].y == doctest::Approx(-1).epsilon(0.01));
}

QUICK_CASE(
    "spz",
    "spz: of version 4 with spherical harmonics of degree 4, those up to 3 are read and that is said") {
  const Folder folder;
  constexpr std::size_t kPoints = 3, kCoefficients = 3 * 24;  // a row
  std::string sh;
  for (std::size_t row = 0; row < kPoints; ++row)
    sh += std::string(3 * 15, '\xc0') + std::string(kCoefficients - 3 * 15, '\xff');
  const std::string attributes[] = {std::string(9 * kPoints, '\1'),   std::string(kPoints, '\x80'),
                                    std::string(3 * kPoints, '\x80'), std::string(3 * kPoints, '\x80'),
                                    std::string(4 * kPoints, '\0'),   sh};
  std::string text = "NGSP" + bytes_of(4u) + bytes_of(std::uint32_t{kPoints}) +
                     std::string("\x04\x08\x00\x06", 4) + bytes_of(32u) + std::string(12, '\0');
  std::string streams;
  for (const std::string& attribute : attributes) {
    const std::string packed = zstd(attribute);
    text += bytes_of(std::uint64_t{packed.size()}) + bytes_of(std::uint64_t{attribute.size()});
    streams += packed;
  }
  write(folder / "a.spz", text + streams);
  const Scene scene = load_scene(folder / "a.spz");
  REQUIRE(scene.cloud.size() == kPoints);
  CHECK(scene.cloud.sh_degree == 3);
  CHECK(std::ranges::all_of(scene.cloud.sh_rest, [](float v) { return std::abs(v) == 0.5f; }));
  CHECK(scene.left_out == "Spherical harmonics of degree 4 are left out, those up to degree 3 are read");
  save_scene(folder / "b.spz", scene, {}, SceneFormat::kSpz);
  CHECK(load_scene(folder / "b.spz").left_out.empty());
}

QUICK_CASE("spz",
           "spz: small scenes keep their shape, what 24 bits cannot hold is refused, sizes beyond are said") {
  const Folder folder;
  const auto saved = [&](float unit) {
    Scene scene;
    scene.format = SceneFormat::kSplat;
    scene.cloud = random_cloud(500, 3);
    for (glm::vec3& p : scene.cloud.position) p *= unit;
    for (glm::vec3& s : scene.cloud.scale) s *= unit;
    const SaveReport report = save_scene(folder / "a.spz", scene, {}, SceneFormat::kSpz);
    const Scene again = load_scene(folder / "a.spz");
    float farthest = 0;
    for (std::size_t g = 0; g < again.cloud.size(); ++g)
      farthest = std::max(
          farthest, glm::distance(again.cloud.position[g], scene.cloud.position[again.cloud.file_row[g]]));
    CHECK(farthest < 1e-3f * unit);
    return report.loss;
  };
  CHECK(saved(1).find("sizes") == std::string::npos);
  CHECK(saved(1e-4f).find("sizes") != std::string::npos);
  CHECK(saved(1e6f).find("sizes") != std::string::npos);
  for (const float unit : {1e-6f, 1e8f})
    CHECK_THROWS_WITH_AS(saved(unit), doctest::Contains("24 bits"), Error);
}

QUICK_CASE("spz",
           "spz: version 4, zstd streams, holds what version 3 of the same cloud holds, at every degree") {
  const Folder folder;
  for (int degree = 0; degree <= 3; ++degree) {
    CAPTURE(degree);
    Scene scene;
    scene.cloud = varied_cloud(500, degree);
    save_scene(folder / "3.spz", scene, {}, SceneFormat::kSpz);
    const std::string v3 = gunzip(text_of(folder / "3.spz"));
    const std::size_t rest = 3 * static_cast<std::size_t>(sh_rest_coefficients(degree));
    std::string table, streams;
    std::size_t begin = 16;
    for (const std::size_t bytes :
         {std::size_t{9}, std::size_t{1}, std::size_t{3}, std::size_t{3}, std::size_t{4}, rest}) {
      if (bytes == 0) continue;
      const std::string packed = zstd(v3.substr(begin, 500 * bytes));
      table += bytes_of(std::uint64_t{packed.size()}) + bytes_of(std::uint64_t{500 * bytes});
      streams += packed;
      begin += 500 * bytes;
    }
    REQUIRE(begin == v3.size());
    std::string header = "NGSP" + bytes_of(4u) + v3.substr(8, 6) + std::string(1, '\0');
    header += static_cast<char>(table.size() / 16);
    header += bytes_of(32u) + std::string(12, '\0');
    const std::string v4 = header + table + streams;
    write(folder / "4.spz", v4);
    const Scene a = load_scene(folder / "3.spz"), b = load_scene(folder / "4.spz");
    CHECK(b.cloud.sh_degree == degree);
    check_equal(a.cloud, b.cloud);
    write(folder / "cut.spz", v4.substr(0, v4.size() - 9));
    CHECK(mentions(refusal(folder / "cut.spz"), {"truncated", "stream"}));
    std::string damaged = v4;
    damaged[32 + table.size()] ^= 0x5a;
    write(folder / "damaged.spz", damaged);
    CHECK(mentions(refusal(folder / "damaged.spz"), {"damaged", "stream 0"}));
  }
}

TEST_CASE(
    "compressed ply by hand: old chunks of 12 numbers have colours in 0..1, newer ones of 18 their own "
    "range") {
  const Folder folder;
  const auto file = [](bool with_colour) {
    std::string text = "ply\nformat binary_little_endian 1.0\nelement chunk 1\n";
    for (const char* bound : {"min_x", "min_y", "min_z", "max_x", "max_y", "max_z", "min_scale_x",
                              "min_scale_y", "min_scale_z", "max_scale_x", "max_scale_y", "max_scale_z"})
      text += "property float " + std::string(bound) + "\n";
    if (with_colour)
      for (const char* bound : {"min_r", "min_g", "min_b", "max_r", "max_g", "max_b"})
        text += "property float " + std::string(bound) + "\n";
    text += "element vertex 2\n";
    for (const char* field : {"position", "rotation", "scale", "color"})
      text += "property uint packed_" + std::string(field) + "\n";
    text += "end_header\n";
    for (const float v : {-1.0f, 0.0f, 2.0f, 3.0f, 4.0f, 6.0f, -5.0f, -5.0f, -5.0f, -1.0f, -3.0f, -2.0f})
      text += bytes_of(v);
    if (with_colour)
      for (const float v : {-0.5f, 0.0f, 0.0f, 1.5f, 1.0f, 2.0f}) text += bytes_of(v);
    // The least of every range, no rotation (w the largest: 512 of 1023 in the rest), black, opacity 0x33 /
    // 255.
    const std::uint32_t none = 512u << 20 | 512u << 10 | 512u;
    for (const std::uint32_t v : {0u, none, 0u, 0x33u}) text += bytes_of(v);
    // The most of every range.
    for (const std::uint32_t v : {0xffffffffu, none, 0xffffffffu, 0xffffffffu}) text += bytes_of(v);
    return text;
  };
  for (const bool with_colour : {false, true}) {
    CAPTURE(with_colour);
    write(folder / "a.compressed.ply", file(with_colour));
    const Scene scene = load_scene(folder / "a.compressed.ply");
    REQUIRE(scene.cloud.size() == 2);
    const std::size_t low = scene.cloud.file_row[0] == 0 ? 0 : 1, high = 1 - low;
    CHECK(scene.cloud.position[low] == glm::vec3(-1, 0, 2));
    CHECK(scene.cloud.position[high] == glm::vec3(3, 4, 6));
    CHECK(scene.cloud.scale[low].z == doctest::Approx(std::exp(-5.0)));
    CHECK(scene.cloud.scale[high].y == doctest::Approx(std::exp(-3.0)));
    CHECK(scene.cloud.rotation[low].w == doctest::Approx(1).epsilon(1e-5));
    CHECK(scene.cloud.opacity[low] == doctest::Approx(0.2));
    const auto colour = [&](std::size_t g) { return 0.5f + 0.28209479f * scene.cloud.f_dc[g]; };
    CHECK(colour(low).r == doctest::Approx(with_colour ? -0.5 : 0));
    CHECK(colour(high).r == doctest::Approx(with_colour ? 1.5 : 1));
    CHECK(colour(high).b == doctest::Approx(with_colour ? 2 : 1));
  }
}

TEST_CASE("compressed ply: strays are kept apart, and what they move is said") {
  const Folder folder;
  Scene scene;
  scene.cloud = varied_cloud(3000, 0);
  const auto written = [&] {
    const SaveReport report = save_scene(folder / "a.compressed.ply", scene, {}, SceneFormat::kCompressedPly);
    const Scene got = load_scene(folder / "a.compressed.ply");
    const auto lost = [&](const glm::vec3& p) {
      return std::ranges::none_of(got.cloud.position,
                                  [&](const glm::vec3& q) { return glm::distance(p, q) < 0.01f; });
    };
    return std::pair(std::ranges::count_if(scene.cloud.position, lost), report.loss);
  };
  const auto [none, nothing_said] = written();
  CHECK(none == 0);
  CHECK(nothing_said.find("times their size") == std::string::npos);
  constexpr std::size_t kStrays = 40;
  for (std::size_t i = 0; i < kStrays; ++i) scene.cloud.position[70 * i] *= 1e5f;
  const auto [moved, said] = written();
  CHECK(moved < 256);  // one chunk, where each stray has made its own coarse
  CHECK(mentions(said, {fmt::format("{} Gaussians move by more than 10 times their size", moved).c_str()}));
}

TEST_CASE("compressed ply: sizes beyond the format's are said") {
  const Folder folder;
  Scene scene;
  scene.cloud = varied_cloud(200, 0);
  for (std::size_t g = 0; g < 20; ++g) scene.cloud.scale[g] = glm::vec3(1e-9f);
  const SaveReport report = save_scene(folder / "a.compressed.ply", scene, {}, SceneFormat::kCompressedPly);
  CHECK(mentions(report.loss, {"the sizes of 10.0 % of the Gaussians lie beyond the format's range"}));
  for (glm::vec3& scale : scene.cloud.scale)
    scale = {0.01f, 0.02f, 0};  // flat, as 2D Gaussian Splatting has them
  CHECK(save_scene(folder / "a.compressed.ply", scene, {}, SceneFormat::kCompressedPly).loss.find("sizes") ==
        std::string::npos);
}

TEST_CASE("spz: positions are as fine as the Gaussians ask for, where 24 bits hold them") {
  const Folder folder;
  for (const float size : {0.01f, 3e-4f, 1e-5f}) {
    CAPTURE(size);
    Scene scene;
    scene.cloud = varied_cloud(300, 0);
    float farthest = 0;
    for (std::size_t g = 0; g < scene.cloud.size(); ++g) {
      scene.cloud.scale[g] = glm::vec3(size);
      const glm::vec3 at = glm::abs(scene.cloud.position[g]);
      farthest = std::max({farthest, at.x, at.y, at.z});
    }
    REQUIRE(farthest > 1);
    save_scene(folder / "a.spz", scene, {}, SceneFormat::kSpz);
    LoadOptions axes;
    axes.spz_axes = SpzAxes::kRub;
    const Scene got = load_scene(folder / "a.spz", axes);
    const float step = std::max(size / 20, farthest * std::ldexp(1.0f, -22));
    for (const glm::vec3& p : scene.cloud.position)
      CHECK(std::ranges::any_of(got.cloud.position,
                                [&](const glm::vec3& q) { return glm::distance(p, q) <= step; }));
  }
}

TEST_CASE("ply: normals that say something are said to be lost, zeros are not") {
  const Folder folder;
  const std::vector<std::string> names = splat_names(0);
  std::string zeros = numbered_ply(names, 5);
  const std::size_t rows = zeros.size() - 5 * names.size() * sizeof(float);
  const auto put = [&](std::size_t row, std::size_t field, float value) {
    zeros.replace(rows + (row * names.size() + field) * sizeof(float), sizeof(float), bytes_of(value));
  };
  for (std::size_t row = 0; row < 5; ++row)
    for (const std::size_t normal : {3, 4, 5}) put(row, normal, 0);
  write(folder / "zeros.ply", zeros);
  put(4, 5, 1);
  write(folder / "one.ply", zeros);
  CHECK(load_scene(folder / "zeros.ply").other_properties.empty());
  CHECK(load_scene(folder / "one.ply").other_properties == std::vector<std::string>{"nz"});
}

TEST_CASE("spz: a stray that makes all positions coarse is said, and named where nothing can be written") {
  const Folder folder;
  Scene scene;
  scene.cloud = varied_cloud(3000, 0);
  for (glm::vec3& scale : scene.cloud.scale) scale = glm::vec3(0.02f);
  const auto said = [&] { return save_scene(folder / "a.spz", scene, {}, SceneFormat::kSpz).loss; };
  CHECK(said().find("their size") == std::string::npos);
  scene.cloud.position[70] = {0, 1.2e5f, 0};
  const std::string lost = said();
  CAPTURE(lost);
  LoadOptions axes;
  axes.spz_axes = SpzAxes::kRub;
  const Scene got = load_scene(folder / "a.spz", axes);
  int moved = 0;
  for (std::size_t g = 0; g < got.cloud.size(); ++g)
    moved += glm::distance(got.cloud.position[g], scene.cloud.position[got.cloud.file_row[g]]) > 0.01f;
  CHECK(moved > 30);
  CHECK(mentions(lost, {fmt::format("{} Gaussians move by more than half their size", moved).c_str(),
                        "1 Gaussian lies farther than", "1.2e+05", "without it positions would be finer"}));
  scene.cloud.position[70].y = 1e6f;
  CHECK_THROWS_WITH_AS(said(), doctest::Contains("because 1 Gaussian lies farther than"), Error);
  CHECK_THROWS_WITH_AS(said(), doctest::Contains("Delete what lies there"), Error);
  // All of it is far away: that helps, and is said; where nothing does, nothing is advised.
  for (std::size_t g = 0; g < scene.cloud.size(); ++g) scene.cloud.position[g] += glm::vec3(1e6f, 0, 0);
  scene.cloud.position[70] = scene.cloud.position[71];
  CHECK_THROWS_WITH_AS(said(), doctest::Contains("move the scene near the origin"), Error);
  for (std::size_t g = 0; g < scene.cloud.size(); g += 2) scene.cloud.position[g].x *= -1;
  CHECK(what_is_said(said).find("near the origin") == std::string::npos);
  CHECK_THROWS_WITH_AS(said(), doctest::Contains("Choose another format"), Error);
}

TEST_CASE("sog: Gaussians of a wide scene that move by more than half their size are said") {
  const Folder folder;
  Scene scene;
  scene.cloud = varied_cloud(2000, 0);
  for (glm::vec3& scale : scene.cloud.scale) scale = glm::vec3(0.02f);
  const auto said = [&] { return save_scene(folder / "a.sog", scene, {}, SceneFormat::kSog).loss; };
  CHECK(said().find("their size") == std::string::npos);
  for (glm::vec3& p : scene.cloud.position) p *= 1000;
  const std::string lost = said();
  CAPTURE(lost);
  const Scene got = load_scene(folder / "a.sog");  // in the order of ours
  int moved = 0;
  for (std::size_t g = 0; g < got.cloud.size(); ++g)
    moved += std::ranges::none_of(scene.cloud.position, [&](const glm::vec3& p) {
      return glm::distance(p, got.cloud.position[g]) <= 0.01f;
    });
  CHECK(moved > 1000);
  CHECK(mentions(lost, {fmt::format("{} Gaussians move by more than half their size", moved).c_str()}));
}

TEST_CASE("splat: a flat Gaussian is written as thin, not as nothing") {
  const Folder folder;
  Scene scene;
  scene.cloud = varied_cloud(20, 0);
  for (glm::vec3& scale : scene.cloud.scale) scale = {0.01f, 0.02f, 0};
  save_scene(folder / "a.splat", scene, {}, SceneFormat::kSplat);
  const std::string bytes = text_of(folder / "a.splat");
  for (std::size_t row = 0; row < 20; ++row) {
    float thin = 0;
    std::memcpy(&thin, bytes.data() + row * 32 + 20, sizeof thin);
    CHECK(thin > 0);
    CHECK(thin < 1e-15f);
  }
}
