// Files written by hand and by other programs: what each format holds, and what of it is refused.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "format_limits.h"
#include "ksplat_by_hand.h"
#include "places.h"
#include "quick.h"

using namespace splatcut;
using namespace splatcut::testing;

QUICK_CASE("ksplat", "ksplat by hand: three levels, buckets full and not, sections of different degree") {
  const Folder folder;
  for (int level = 0; level <= 2; ++level) {
    CAPTURE(level);
    write(folder / "a.ksplat", ksplat_by_hand(level));
    const Scene scene = load_scene(folder / "a.ksplat");
    REQUIRE(scene.cloud.size() == 4);
    CHECK(scene.cloud.sh_degree == 2);
    for (std::size_t g = 0; g < 4; ++g) {
      const std::uint32_t row = scene.cloud.file_row[g];
      const glm::vec3 expected(static_cast<float>(row + 1), -2, 0.5f);
      CHECK(glm::length(scene.cloud.position[g] - expected) <= (level == 0 ? 0 : 2 * 8.0f / 65534));
      CHECK(scene.cloud.scale[g] == glm::vec3(0.5f, 0.25f, 0.125f));
      CHECK(scene.cloud.rotation[g].y == doctest::Approx(-1));
      CHECK(scene.cloud.opacity[g] == doctest::Approx(0.2));
      CHECK(scene.cloud.f_dc[g].z == doctest::Approx(0.5 / 0.28209479));
      for (std::size_t n = 0; n < 8; ++n)
        for (std::size_t c = 0; c < 3; ++c) {
          const float sh = row == 3 ? 0.0f : static_cast<float>(n) / 8 - 0.5f + 0.25f * static_cast<float>(c);
          CHECK(std::abs(scene.cloud.sh_rest_of(g)[c * 8 + n] - sh) <= (level == 2 ? 2.01f / 255 : 0));
        }
    }
  }
  std::string bad = ksplat_by_hand(1);
  bad[0] = 3;
  write(folder / "a.ksplat", bad);
  CHECK(mentions(refusal(folder / "a.ksplat"), {"version 3.1", "not supported"}));
  bad = ksplat_by_hand(1);
  bad[16] = 9;
  write(folder / "a.ksplat", bad);
  CHECK(mentions(refusal(folder / "a.ksplat"), {"4 Gaussians", "promises 9"}));
  write(folder / "a.ksplat", ksplat_by_hand(0).substr(0, 6300));
  CHECK(mentions(refusal(folder / "a.ksplat"), {"truncated"}));
}

QUICK_CASE("ply", "ply: text has the values of its binary twin, and colours stand for f_dc") {
  const Folder folder;
  const std::vector<std::string> names = splat_names(9);
  const std::string binary = numbered_ply(names, 50);
  write(folder / "binary.ply", binary);
  std::string text =
      "ply\nformat ascii 1.0\ncomment a list goes before\nelement camera 2\nproperty list uchar int "
      "n\nelement vertex 50\nproperty int label\n";
  for (const std::string& name : names) text += "property float " + name + "\n";
  text += "end_header\n2 7 8\n0\n";
  const std::string rows = binary.substr(header(names, 50).size());
  for (std::size_t row = 0; row < 50; ++row) {
    text += "3";
    for (std::size_t f = 0; f < names.size(); ++f) {
      float v = 0;
      std::memcpy(&v, rows.data() + 4 * (row * names.size() + f), sizeof v);
      char word[40];
      std::snprintf(word, sizeof word, " %.9g", static_cast<double>(v));
      text += word;
    }
    text += row % 2 ? "\r\n" : "\n";
  }
  write(folder / "text.ply", text);
  const Scene a = load_scene(folder / "binary.ply"), b = load_scene(folder / "text.ply");
  check_equal(a.cloud, b.cloud);
  const SaveReport report = save_scene(folder / "out.ply", b, {}, SceneFormat::kPly);
  CHECK(report.loss == "4 properties are left out, \"label\" among them");
  check_same(as_written(b, false), load_scene(folder / "out.ply"), limits().at("ply").limit);

  write(folder / "cut.ply", text.substr(0, text.size() - 90));
  CHECK(mentions(refusal(folder / "cut.ply"), {"truncated", "row 49"}));
  std::string bad = text;
  bad.replace(bad.rfind(" "), 3, " x1");
  write(folder / "bad.ply", bad);
  CHECK(mentions(refusal(folder / "bad.ply"), {"row 49", "x1", "no number", "rot_3"}));
  bad.resize(bad.rfind(" "));
  bad += " 1e60\n";  // infinite: the row is dropped
  write(folder / "bad.ply", bad);
  CHECK(load_scene(folder / "bad.ply").dropped == 1);
  bad = text;  // each row is a line of its own: what one lacks is not taken from the next
  bad.erase(bad.find(' ', bad.find("\n3 ") + 3),
            bad.find('\n', bad.find("\n3 ") + 3) - bad.find(' ', bad.find("\n3 ") + 3));
  write(folder / "bad.ply", bad);
  CHECK(mentions(refusal(folder / "bad.ply"), {"row 0 ends before \"y\""}));
  bad = text;
  bad.insert(bad.find('\n', bad.find("\n3 ") + 1), " 7");
  write(folder / "bad.ply", bad);
  CHECK(mentions(refusal(folder / "bad.ply"), {"row 0 has more than 27 numbers"}));
  bad = text;
  bad.insert(bad.find("\n3 "), "\n \r\n");
  write(folder / "blank.ply", bad);
  check_equal(load_scene(folder / "blank.ply").cloud, b.cloud);
  bad = text;
  bad.replace(bad.find("vertex 50"), 9, "vertex 4000000000");
  write(folder / "huge.ply", bad);
  CHECK(mentions(refusal(folder / "huge.ply"), {"truncated", "4000000000"}));

  // Red 1, green 0.5, blue 0: as bytes and as floats, binary and as text.
  const std::string rest =
      "property float opacity\nproperty float scale_0\nproperty float scale_1\nproperty float "
      "scale_2\nproperty float rot_0\nproperty float rot_1\nproperty float rot_2\nproperty "
      "float rot_3\nend_header\n";
  const auto colours = [](const std::string& type) {
    return "property float x\nproperty float y\nproperty float z\nproperty " + type + " red\nproperty " +
           type + " green\nproperty " + type + " blue\n";
  };
  const std::string begin = "ply\nformat ascii 1.0\nelement vertex 1\n", tail = " 0 -1 -2 -3 1 0 0 0\n";
  std::string packed = "ply\nformat binary_little_endian 1.0\nelement vertex 1\n" + colours("uchar") + rest;
  for (const float v : {1.0f, 2.0f, 3.0f}) packed += bytes_of(v);
  packed += "\xff\x80";
  packed += '\0';
  for (const float v : {0.0f, -1.0f, -2.0f, -3.0f, 1.0f, 0.0f, 0.0f, 0.0f}) packed += bytes_of(v);
  for (const std::string& file : {begin + colours("uchar") + rest + "1 2 3 255 128 0" + tail,
                                  begin + colours("float") + rest + "1 2 3 1 0.5019608 0" + tail, packed}) {
    write(folder / "colours.ply", file);
    const Scene scene = load_scene(folder / "colours.ply");
    CHECK(scene.cloud.position[0] == glm::vec3(1, 2, 3));
    CHECK(scene.cloud.f_dc[0].x == doctest::Approx(0.5 / 0.28209479));
    CHECK(scene.cloud.f_dc[0].y == doctest::Approx((128.0 / 255 - 0.5) / 0.28209479));
    CHECK(scene.cloud.f_dc[0].z == doctest::Approx(-0.5 / 0.28209479));
    CHECK(scene.other_properties.empty());
  }
  save_scene(folder / "copy.ply", load_scene(folder / "colours.ply"), {}, SceneFormat::kPly);
  CHECK(text_of(folder / "copy.ply") == packed);
}

QUICK_CASE("glb", "glb by hand: nodes place their Gaussians, normalised bytes, drafts with logarithms") {
  const Folder folder;
  // One Gaussian: position, rotation (bytes), scale, opacity (byte), f_dc.
  const auto glb = [&](const std::string& nodes, const glm::vec3& scale, const std::string& extension = "{}",
                       bool sh = false) {
    std::string binary;
    for (const float v : {1.0f, 2.0f, 3.0f}) binary += bytes_of(v);
    binary += std::string("\x00\x00\x7f\x00", 4);  // half a turn around z
    for (int c = 0; c < 3; ++c) binary += bytes_of(scale[c]);
    binary += std::string("\x33\x00\x00\x00", 4);
    for (const float v : {0.1f, 0.2f, 0.3f}) binary += bytes_of(v);
    for (const float v : {0.5f, 0.6f, 0.7f}) binary += bytes_of(v);
    std::string attributes = R"("POSITION":0,"KHR_gaussian_splatting:ROTATION":1,)"
                             R"("KHR_gaussian_splatting:SCALE":2,"KHR_gaussian_splatting:OPACITY":3,)"
                             R"("KHR_gaussian_splatting:SH_DEGREE_0_COEF_0":4)";
    if (sh)
      for (const char* n : {"0", "1", "2"})
        attributes += R"(,"KHR_gaussian_splatting:SH_DEGREE_1_COEF_)" + std::string(n) + "\":5";
    std::string text =
        R"({"asset":{"version":"2.0"},"scenes":[{"nodes":[0]}],"nodes":)" + nodes +
        R"(,"meshes":[{"primitives":[{"mode":0,"attributes":{)" + attributes +
        R"(},"extensions":{"KHR_gaussian_splatting":)" + extension +
        R"(}}]}],)"
        R"("accessors":[{"bufferView":0,"componentType":5126,"count":1,"type":"VEC3"},)"
        R"({"bufferView":0,"byteOffset":12,"componentType":5120,"normalized":true,"count":1,"type":"VEC4"},)"
        R"({"bufferView":0,"byteOffset":16,"componentType":5126,"count":1,"type":"VEC3"},)"
        R"({"bufferView":0,"byteOffset":28,"componentType":5121,"normalized":true,"count":1,"type":"SCALAR"},)"
        R"({"bufferView":0,"byteOffset":32,"componentType":5126,"count":1,"type":"VEC3"},)"
        R"({"bufferView":0,"byteOffset":44,"componentType":5126,"count":1,"type":"VEC3"}],)"
        R"("bufferViews":[{"buffer":0,"byteLength":56}],"buffers":[{"byteLength":56}]})";
    text.resize((text.size() + 3) / 4 * 4, ' ');
    return "glTF" + bytes_of(2u) + bytes_of(static_cast<std::uint32_t>(28 + text.size() + binary.size())) +
           bytes_of(static_cast<std::uint32_t>(text.size())) + "JSON" + text +
           bytes_of(static_cast<std::uint32_t>(binary.size())) + std::string("BIN\0", 4) + binary;
  };
  const fs::path path = folder / "a.glb";
  const glm::vec3 sizes(0.5f, 0.25f, 0.125f);
  write(path, glb(R"([{"mesh":0}])", sizes));
  Scene scene = load_scene(path);
  REQUIRE(scene.cloud.size() == 1);
  CHECK(scene.cloud.position[0] == glm::vec3(-1, -2, 3));
  CHECK(scene.cloud.scale[0] == sizes);
  CHECK(scene.cloud.rotation[0].z == doctest::Approx(1));
  CHECK(scene.cloud.opacity[0] == doctest::Approx(0.2));
  CHECK(scene.cloud.f_dc[0] == glm::vec3(0.1f, 0.2f, 0.3f));
  write(path, glb(R"([{"mesh":0}])", glm::log(sizes)));
  CHECK(load_scene(path).cloud.scale[0].z == doctest::Approx(0.125));
  // Twice as large, a quarter turn around z, then moved: (1, 2, 3) -> (2, 4, 6) -> (-4, 2, 6) -> (6, 2, 6).
  const std::string quarter = "[0,0,0.70710678,0.70710678]";
  write(path, glb(R"([{"children":[1],"translation":[10,0,0]},{"mesh":0,"scale":[2,2,2],"rotation":)" +
                      quarter + "}]",
                  sizes));
  scene = load_scene(path);
  CHECK(glm::length(scene.cloud.position[0] - glm::vec3(-6, -2, 6)) < 1e-5f);
  CHECK(glm::length(scene.cloud.scale[0] - 2.0f * sizes) < 1e-5f);
  // Half a turn and a quarter: what was along x is along -y, and so is it with both signs changed.
  CHECK(std::abs((glm::mat3_cast(scene.cloud.rotation[0]) * glm::vec3(1, 0, 0)).y) == doctest::Approx(1));
  write(path, glb(R"([{"mesh":0,"matrix":[0,1,0,0,-1,0,0,0,0,0,1,0,0,0,0,1]}])", sizes));
  CHECK(glm::length(load_scene(path).cloud.position[0] - glm::vec3(2, -1, 3)) < 1e-5f);
  write(path, glb(R"([{"mesh":0}])", sizes, "{}", true));
  scene = load_scene(path);
  CHECK(scene.cloud.sh_degree == 1);
  CHECK(scene.cloud.sh_rest_of(0)[0] == -0.5f);  // y
  CHECK(scene.cloud.sh_rest_of(0)[1] == 0.5f);   // z
  CHECK(scene.cloud.sh_rest_of(0)[5] == -0.6f);  // x of green

  // Turned by a quarter from x to y: y takes the coefficient of x, x that of y with another sign.
  write(path, glb(R"([{"mesh":0,"rotation":)" + quarter + "}]", sizes, "{}", true));
  scene = load_scene(path);
  for (const auto& [at, expected] : {std::pair(0, 0.5f), {1, 0.5f}, {2, 0.5f}, {3, 0.6f}, {8, 0.7f}}) {
    CAPTURE(at);
    CHECK(std::abs(scene.cloud.sh_rest_of(0)[static_cast<std::size_t>(at)]) == doctest::Approx(expected));
  }
  CHECK(scene.cloud.sh_rest_of(0)[0] ==
        doctest::Approx(-0.5f));  // of y: -x before, whose sign axes changed, too
  CHECK(scene.cloud.sh_rest_of(0)[2] == doctest::Approx(0.5f));

  const auto refused = [&](const std::string& bytes, std::initializer_list<const char*> parts) {
    write(path, bytes);
    CHECK(mentions(refusal(path), parts));
  };
  refused(glb(R"([{"mesh":0,"scale":[1,2,1]}])", sizes), {"stretches", "Apply"});
  refused(glb(R"([{"mesh":0,"scale":[-1,1,1]}])", sizes), {"mirrors"});
  refused(glb(R"([{"children":[0]}])", sizes), {"no tree"});
  refused(glb(R"([{}])", sizes), {"holds no Gaussians", "Export"});
  refused(glb(R"([{"mesh":7}])", sizes), {"standard"});
  refused(glb(R"([{"mesh":0}])", sizes, R"({"colorSpace":"lin_rec709_display"})"), {"linear"});
  refused(glb(R"([{"mesh":0}])", sizes, R"({"kernel":"box"})"), {"box"});
  refused(glb(R"([{"mesh":0}])", sizes, R"({"extensions":{"X":{}}})"), {"packed"});
  std::string far = glb(R"([{"mesh":0}])", sizes);
  far.replace(far.find("\"byteOffset\":12"), 15, "\"byteOffset\":99");
  refused(far, {"ROTATION", "truncated"});
  far = glb(R"([{"mesh":0}])", sizes);
  far.replace(far.find("\"count\":1"), 9, "\"count\":9");
  refused(far, {"POSITION", "truncated"});

  // The same as .gltf, with its numbers beside it.
  Scene written;
  written.cloud = varied_cloud(100, 1);
  save_scene(folder / "b.glb", written, {}, SceneFormat::kGlb);
  const std::string bytes = text_of(folder / "b.glb");
  std::uint32_t text_bytes = 0;
  std::memcpy(&text_bytes, bytes.data() + 12, 4);
  auto text = nlohmann::json::parse(bytes.substr(20, text_bytes));
  CHECK(text["meshes"][0]["primitives"][0]["mode"] == 0);  // points
  text["buffers"][0]["uri"] = "b.bin";
  write(folder / "b.gltf", text.dump());
  write(folder / "b.bin", bytes.substr(28 + text_bytes));
  check_same(written.cloud, load_scene(folder / "b.gltf"), limits().at("glb").limit);
  CHECK(load_scene(folder / "b.gltf").files == std::vector<fs::path>{folder / "b.gltf", folder / "b.bin"});
  text["buffers"][0]["uri"] = "../b.bin";
  write(folder / "b.gltf", text.dump());
  CHECK(mentions(refusal(folder / "b.gltf"), {"another folder", ".glb"}));
}

QUICK_CASE("ksplat", "files of others: .ksplat and .ply of PlayCanvas, against what is known of them") {
  const fs::path fixtures = fs::path(project_folder()) / "tests" / "data" / "formats";
  const Scene ply = load_scene(fixtures / "supersplat.ply");
  CHECK(ply.file_rows == 64);
  CHECK(ply.dropped == 0);
  CHECK(ply.cloud.sh_degree == 3);

  const Scene grid = load_scene(fixtures / "minimal.ksplat");
  REQUIRE(grid.cloud.size() == 4);
  for (std::size_t g = 0; g < 4; ++g) {
    const std::uint32_t row = grid.cloud.file_row[g];
    const auto x = static_cast<float>(row % 2), z = static_cast<float>(row / 2);
    CHECK(grid.cloud.position[g] == glm::vec3(x - 1, 0, z - 1));
    CHECK(grid.cloud.scale[g].y == doctest::Approx(0.1));
    CHECK(grid.cloud.f_dc[g].x == doctest::Approx((std::round((x + 1) / 3 * 255) / 255 - 0.5) / 0.28209479));
  }
}
