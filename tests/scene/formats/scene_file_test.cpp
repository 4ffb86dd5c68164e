#include "scene/formats/scene_file.h"

#include <fmt/format.h>
#include <tbb/task_arena.h>

#include <numeric>

#include "quick.h"
#include "scene/cloud/morton.h"
#include "scene_file_helpers.h"

using namespace splatcut;
using namespace splatcut::testing;

QUICK_CASE("ply", "ply: known values, properties in any order and of any type, with and without normals") {
  const Folder folder;
  // rot before x, a double position, uchar and double properties nobody asked for.
  std::string text =
      "ply\r\nformat binary_little_endian 1.0\r\nelement vertex 1\r\nproperty uchar label\r\nproperty float "
      "rot_0\r\n"
      "property float rot_1\r\nproperty float rot_2\r\nproperty float rot_3\r\nproperty double x\r\nproperty "
      "double y\r\n"
      "property double z\r\nproperty double weight\r\nproperty float opacity\r\nproperty float "
      "scale_2\r\nproperty float "
      "scale_1\r\nproperty float scale_0\r\nproperty float f_dc_0\r\nproperty float f_dc_1\r\nproperty float "
      "f_dc_2\r\n"
      "end_header\r\n";
  text += '\x05';
  for (const float v : {0.0f, 0.0f, 0.0f, -2.0f}) text += bytes_of(v);
  for (const double v : {1.5, -2.5, 3.25, 9.0}) text += bytes_of(v);
  for (const float v : {std::log(3.0f), std::log(0.3f), std::log(0.2f), std::log(0.1f), 0.25f, 0.5f, 0.75f})
    text += bytes_of(v);
  write(folder / "odd.ply", text);
  const Scene scene = load_scene(folder / "odd.ply");
  REQUIRE(scene.cloud.size() == 1);
  CHECK(scene.cloud.sh_degree == 0);
  CHECK(scene.cloud.position[0] == glm::vec3(1.5f, -2.5f, 3.25f));
  CHECK(scene.cloud.opacity[0] == doctest::Approx(0.75));
  CHECK(scene.cloud.scale[0].x == doctest::Approx(0.1));
  CHECK(scene.cloud.scale[0].z == doctest::Approx(0.3));
  CHECK(scene.cloud.rotation[0].z == doctest::Approx(-1));
  CHECK(scene.cloud.f_dc[0] == glm::vec3(0.25f, 0.5f, 0.75f));
  save_scene(folder / "copy.ply", scene, {}, SceneFormat::kPly);
  CHECK(text_of(folder / "copy.ply") == text);
}

QUICK_CASE("ply",
           "ply: infinite opacity and flat scale are legal, NaN and zero rotations are dropped and counted") {
  const Folder folder;
  const std::vector<std::string> names = splat_names(9);
  std::string text = header(names, 5);
  for (int row = 0; row < 5; ++row) {
    for (const std::string& name : names) {
      float value = name == "rot_0" && row != 2 ? 1.0f : 0.0f;  // row 2: zero rotation
      if (name == "x") value = static_cast<float>(row);
      if (name == "opacity" && row == 0) value = kInfinity;
      if (name == "scale_1" && row == 0) value = -kInfinity;
      if (name == "f_rest_8" && row == 1) value = kNan;
      if (name == "z" && row == 3) value = kInfinity;
      text += bytes_of(value);
    }
  }
  write(folder / "nan.ply", text);
  const Scene scene = load_scene(folder / "nan.ply");
  CHECK(scene.file_rows == 5);
  CHECK(scene.dropped == 3);
  REQUIRE(scene.cloud.size() == 2);
  const std::size_t first = scene.cloud.file_row[0] == 0 ? 0 : 1;
  CHECK(scene.cloud.file_row[1 - first] == 4);
  CHECK(scene.cloud.opacity[first] == 1.0f);
  CHECK(scene.cloud.scale[first] == glm::vec3(1, 0, 1));
}

QUICK_CASE("ply", "ply: a subset has the rows of the file, byte for byte and in its order, for all degrees") {
  const Folder folder;
  for (const int rest : {0, 9, 24, 45}) {
    const std::vector<std::string> names = splat_names(rest);
    constexpr int kCount = 1000;
    const std::string text = numbered_ply(names, kCount);
    write(folder / "full.ply", text);
    const Scene scene = load_scene(folder / "full.ply");
    REQUIRE(scene.cloud.size() == kCount);
    CHECK(3 * sh_rest_coefficients(scene.cloud.sh_degree) == rest);
    std::vector<std::uint8_t> keep(kCount);
    std::string expected = header(names, 334);
    const std::size_t row_bytes = 4 * names.size();
    for (std::size_t row = 0; row < kCount; row += 3)
      expected += text.substr(header(names, kCount).size() + row * row_bytes, row_bytes);
    for (std::size_t g = 0; g < kCount; ++g) {
      const std::uint32_t row = scene.cloud.file_row[g];
      keep[g] = row % 3 == 0;
      REQUIRE(scene.cloud.position[g].x == static_cast<float>((row * 7919) % kCount));
      if (rest > 0) REQUIRE(scene.cloud.sh_rest_of(g)[1] == 0.001f * 10 + 0.01f * static_cast<float>(row));
    }
    const SaveReport report = save_scene(folder / "subset.ply", scene, keep, SceneFormat::kPly);
    CHECK(report.gaussians == 334);
    CHECK(report.bytes == expected.size());
    CHECK(report.loss.empty());
    CHECK(text_of(folder / "subset.ply") == expected);
  }
}

QUICK_CASE("ply", "round trip through every format and degree") {
  const Folder folder;
  for (int degree = 0; degree <= 3; ++degree) {
    Scene scene;
    scene.cloud = varied_cloud(3000, degree);
    CHECK(save_scene(folder / "a.ply", scene, {}, SceneFormat::kPly).loss.empty());
    check_same(scene.cloud, load_scene(folder / "a.ply"), {0, 1e-5f, 1e-6f, 1e-6f, 0, 0});

    // 24-bit positions of 12 fractional bits, 9-bit rotations, 1/16 steps of log scale, bytes
    CHECK(!save_scene(folder / "a.spz", scene, {}, SceneFormat::kSpz).loss.empty());
    const Scene spz = load_scene(folder / "a.spz");
    CHECK(spz.cloud.sh_degree == degree);
    check_same(scene.cloud, spz,
               {1.0f / 8192, 1.01f / 32, 1e-5f, 0.51f / 255, 0.51f / 255 / 0.15f, 0.51f / 128});

    const SaveReport splat = save_scene(folder / "a.splat", scene, {}, SceneFormat::kSplat);
    CHECK(mentions(splat.loss, {"rounded"}));
    CHECK((splat.loss.find("spherical harmonics") != splat.loss.npos) == (degree > 0));
    check_same(scene.cloud, load_scene(folder / "a.splat"), {0, 1e-6f, 1e-4f, 0.51f / 255, 1, 0});
  }
}

QUICK_CASE("ply", "bad files are refused with a clear sentence") {
  const Folder folder;
  const std::vector<std::string> names = splat_names(0);
  const std::string good = numbered_ply(names, 10);
  const auto check = [&](const std::string& name, const std::string& bytes,
                         std::initializer_list<const char*> parts) {
    write(folder / name, bytes);
    const std::string message = refusal(folder / name);
    CHECK(mentions(message, parts));
    CHECK(mentions(message, {name.c_str()}));
  };
  const auto without = [&](const std::string& name) {
    std::vector<std::string> fewer;
    for (const std::string& n : names)
      if (n != name) fewer.push_back(n);
    return numbered_ply(fewer, 10);
  };
  const auto with_count = [&](const std::string& count) {
    std::string text = good;
    return text.replace(text.find("vertex 10"), 9, "vertex " + count);
  };
  CHECK(mentions(refusal(folder / "none.ply"), {"none.ply", "No such file"}));
  CHECK(mentions(refusal(folder.path), {"this folder holds no scene", "meta.json", "Give a scene file"}));
  check("empty.ply", "", {"empty"});
  check("text.ply", "hello", {"not a .ply"});
  check("cut.ply", good.substr(0, good.size() - 70), {"truncated", "row 8", "byte"});
  check("head.ply", good.substr(0, 200), {"header is truncated"});
  check("big.ply", "ply\nformat binary_big_endian 1.0\nelement vertex 1\nend_header\n",
        {"big_endian", "binary_little_endian"});
  check("type.ply", "ply\nformat binary_little_endian 1.0\nelement vertex 1\nproperty half x\nend_header\n",
        {"half"});
  check("huge.ply", with_count("4000000000000000000"), {"truncated", "4000000000000000000"});
  check("overflow.ply", with_count("18446744073709551615"), {"truncated"});
  check("too_long.ply", with_count("99999999999999999999999"), {"bad count"});
  check("minus.ply", with_count("-5"), {"bad count"});
  std::string twice = good;
  check("twice.ply", twice.insert(twice.find("end_header"), "element vertex 3\nproperty float x\n"),
        {"the element \"vertex\" appears twice"});
  check("zero.ply", with_count("0"), {"vertex", "empty"});
  check("no_opacity.ply", without("opacity"), {"opacity", "missing", "f_dc_0"});
  check("1dgs.ply", without("scale_1"), {"scale_1", "missing"});
  check("odd_rest.ply", numbered_ply(splat_names(12), 10), {"12 f_rest", "45"});
  std::vector<std::string> many = names;
  for (int i = 0; i < 4096; ++i) many.push_back("more_" + std::to_string(i));
  check("many.ply", header(many, 1), {"an element has more than 4096 properties"});
  std::string elements = "ply\nformat binary_little_endian 1.0\n";  // 65,000 took 18 s
  for (int i = 0; i < 4097; ++i) elements += fmt::format("element e{} 0\n", i);
  check("elements.ply", elements + "end_header\n", {"the header has more than 4096 elements"});
  check("points.ply", numbered_ply({"x", "y", "z", "red", "green", "blue"}, 10), {"ordinary point cloud"});
  check("cut.splat", std::string(70, 'a'), {"truncated", "row 2", "byte 70"});
  check("zero.splat", std::string(64, '\x80'), {"none of the 2"});
  check("text.spz", "hello, this is no scene of any kind", {"NGSP"});
  check("short.spz", "NGSP", {"truncated"});
  const std::string spz_header =
      "NGSP" + bytes_of(3u) + bytes_of(4000000000u) + std::string("\x03\x0c\x00\x00", 4);
  check("huge.spz", gzip(spz_header), {"damaged", "260000000000", "packs"});
  check("nine.spz", gzip("NGSP" + bytes_of(9u) + bytes_of(1u) + bytes_of(0u)), {"version 9"});
  Scene scene;
  scene.cloud = varied_cloud(500, 1);
  for (const char* name : {"full.spz", "full.compressed.ply"}) {
    save_scene(folder / name, scene, {}, output_format_from_name(name));
    const std::string bytes = text_of(folder / name);
    check("half_" + std::string(name), bytes.substr(0, bytes.size() / 2), {"truncated"});
  }
}

QUICK_CASE("ply", "bad files: scenes beyond all lengths are refused, single Gaussians there are left out") {
  const Folder folder;
  const auto row = [](float x, float size) {
    return bytes_of(glm::vec3(x, 0, 0)) + bytes_of(glm::vec3(size)) + "\x80\x80\x80\xff\xff\x80\x80\x80";
  };
  const auto loaded = [&](const std::string& rows) {
    write(folder / "a.splat", rows);
    return load_scene(folder / "a.splat");
  };
  const auto said = [&](const std::string& rows) {
    try {
      loaded(rows);
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  CHECK(said(row(-3e12f, 1) + row(3e12f, 1)).find("coordinates go up to 3e+12") != std::string::npos);
  CHECK(said(row(3e13f, 1)).find("Scale it") != std::string::npos);
  CHECK(said(row(0, 1e-20f) + row(1e-14f, 1e-20f)).find("only 1e-14 units wide") != std::string::npos);
  CHECK(said(row(0, 1e-20f) + row(1e-11f, 1e-20f)).empty());
  CHECK(said(row(-1e11f, 1) + row(1e11f, 1)).empty());
  CHECK(said(row(5, 1)).empty());  // a single one has no extent
  std::string many;
  for (int i = 0; i < 300; ++i) many += row(static_cast<float>(i), 1);
  const Scene scene = loaded(many + row(1e20f, 1) + row(-3e38f, 1));
  CHECK(scene.dropped == 2);
  CHECK(scene.cloud.size() == 300);
  CHECK(loaded(many + row(1, 1e38f)).dropped == 1);  // a size, too: scaled, it would be no number
  CHECK(loaded(many + row(1, 1e14f)).dropped == 0);
}

TEST_CASE("loading stops at every stage when asked to, without an error and without a scene") {
  const Folder folder;
  Scene scene;
  scene.cloud = varied_cloud(5000, 2);
  for (const char* name : {"a.ply", "a.compressed.ply", "a.splat", "a.spz", "a.sog", "a.glb"}) {
    CAPTURE(name);
    save_scene(folder / name, scene, {}, output_format_from_name(name));
    int stages = 0;
    Job counting;
    counting.on_progress = [&](std::string_view, double) { ++stages; };
    REQUIRE(load_scene(folder / name, counting).cloud.size() == 5000);
    REQUIRE(stages >= 3);
    for (int stop_at = 1; stop_at < stages; ++stop_at) {
      CAPTURE(stop_at);
      std::stop_source source;
      Job job;
      job.stop = source.get_token();
      int stage = 0;
      job.on_progress = [&](std::string_view, double) {
        if (++stage == stop_at) source.request_stop();
      };
      CHECK_NOTHROW(load_scene(folder / name, job));
      CHECK(stage <= stop_at + 1);  // the stage at hand ends early and no other begins
    }
  }
}

QUICK_CASE("loops",
           "Morton order: sorted by interleaved bits, ties by index, the same on any number of threads") {
  std::vector<glm::vec3> points;
  std::mt19937 random(3);
  for (int i = 0; i < 200000; ++i) {
    const auto coordinate = [&] { return static_cast<float>(random() % 64); };
    points.emplace_back(coordinate(), coordinate(), coordinate());
  }
  REQUIRE(robust_bounds(points).min == glm::vec3(0));
  REQUIRE(robust_bounds(points).max == glm::vec3(63));
  const auto code = [&](std::uint32_t i) {
    std::uint64_t bits = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const float cell = std::min(points[i][axis] * (2097152.0f / 63.0f), 2097151.0f);
      for (int b = 0; b < 21; ++b) bits |= (static_cast<std::uint64_t>(cell) >> b & 1) << (3 * b + axis);
    }
    return bits;
  };
  std::vector<std::uint32_t> expected(points.size());
  std::iota(expected.begin(), expected.end(), 0u);
  std::ranges::stable_sort(expected, {}, code);
  for (const int threads : {1, 2, 3})
    tbb::task_arena(threads).execute([&] { CHECK(morton_order(points) == expected); });
  CHECK(morton_order({}).empty());
}

QUICK_CASE("ply", "saving: an empty selection and a changed source are refused, nothing is left behind") {
  const Folder folder;
  write(folder / "a.ply", numbered_ply(splat_names(0), 10));
  const Scene scene = load_scene(folder / "a.ply");
  const std::vector<std::uint8_t> nothing(10, 0);
  CHECK_THROWS_AS(save_scene(folder / "b.ply", scene, nothing, SceneFormat::kPly), Error);
  write(folder / "a.ply", numbered_ply(splat_names(0), 11));
  CHECK_THROWS_WITH_AS(save_scene(folder / "b.ply", scene, {}, SceneFormat::kPly),
                       doctest::Contains("changed"), Error);
  CHECK(std::distance(fs::directory_iterator(folder.path), {}) == 1);
}

TEST_CASE(
    "saving: a source that another program changed, cut short or removed is refused, the older output "
    "stays") {
  const Folder folder;
  const std::string whole = numbered_ply(splat_names(0), 10);
  write(folder / "old.ply", "old");
  for (const std::string& bytes : {whole.substr(0, whole.size() - 1), whole.substr(0, 10), std::string("x"),
                                   std::string(whole.size(), 'x'), whole, std::string()}) {
    CAPTURE(bytes.size());
    write(folder / "a.ply", whole);
    fs::last_write_time(folder / "a.ply", fs::file_time_type::clock::now() - std::chrono::hours(1));
    const Scene scene = load_scene(folder / "a.ply");
    write(folder / "a.ply", bytes);
    if (bytes.empty()) fs::remove(folder / "a.ply");
    CHECK_THROWS_AS(save_scene(folder / "old.ply", scene, {}, SceneFormat::kPly), Error);
    CHECK(text_of(folder / "old.ply") == "old");
    CHECK_NOTHROW(
        save_scene(folder / "b.splat", scene, {}, output_format_from_name("b.splat")));  // from memory
    CHECK(!fs::exists(folder / "old.ply.splatcut.part"));
  }
}

TEST_CASE("scene file: a folder that is none says which of its files may be one") {
  const Folder folder;
  for (const char* name : {"b.ply", "a.spz", "notes.txt"}) write(folder / name, "x");
  const std::string two = refusal(folder.path);
  CHECK(mentions(two, {"this folder is no scene by itself. Give a file. It holds a.spz, b.ply."}));
  CHECK_FALSE(mentions(two, {"notes.txt"}));
  for (const char* name : {"c.ply", "d.ply", "e.ply"}) write(folder / name, "x");
  CHECK(mentions(refusal(folder.path), {"a.spz, b.ply, c.ply and 2 more"}));
}

TEST_CASE("scene file: a folder stands for the only scene file in it, or for its last iteration") {
  const Folder folder;
  const auto remark = [&] { return remark_on_folder(folder.path, load_scene(folder.path)); };
  const std::string scene = numbered_ply(splat_names(0), 10);
  for (const char* name : {"notes.txt", ".b.ply", "cameras.json"}) write(folder / name, "x");
  fs::create_directory(folder / "c.ply");
  write(folder / "a.ply", scene);
  CHECK(load_scene(folder.path).path == folder / "a.ply");
  CHECK(remark() == "a.ply is read, the only scene in the folder");
  CHECK(remark_on_folder(folder / "a.ply", load_scene(folder / "a.ply")).empty());
  write(folder / "input.ply", scene);
  for (const char* iteration : {"iteration_7000", "iteration_30000", "iteration_best", "iteration_40000"})
    fs::create_directories(folder / "point_cloud" / iteration);
  for (const char* iteration : {"iteration_7000", "iteration_30000"})
    write(folder / "point_cloud" / iteration / "point_cloud.ply", scene);
  CHECK(load_scene(folder.path).path == folder / "point_cloud/iteration_30000/point_cloud.ply");
  CHECK(remark() == "point_cloud/iteration_30000/point_cloud.ply is read, the last iteration in the folder");
}
