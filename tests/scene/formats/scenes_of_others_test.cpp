// Scenes as other tools write them: marks, filters, flat Gaussians, what stands in place of a file.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "format_limits.h"
#include "scene/packing/ply_header.h"

using namespace splatcut;
using namespace splatcut::testing;

namespace {

// Two Gaussians at x = 1 and 2 of opacity 1/2 and sizes 1, 1/2, 1/4, rotated by nothing, all else 0. Values
// of further columns, 0.5 each. drop: a name that is missing.
std::string small_ply(const std::vector<std::string>& more = {}, const std::string& drop = "",
                      const std::string& before = "") {
  std::vector<std::string> names = {"x",       "y",       "z",       "f_dc_0", "f_dc_1", "f_dc_2", "opacity",
                                    "scale_0", "scale_1", "scale_2", "rot_0",  "rot_1",  "rot_2",  "rot_3"};
  names.insert(names.end(), more.begin(), more.end());
  std::erase(names, drop);
  std::string text = "ply\nformat binary_little_endian 1.0\n" + before + "element vertex 2\n";
  for (const std::string& name : names) text += "property float " + name + "\n";
  text += "end_header\n";
  for (int row = 0; row < 2; ++row)
    for (const std::string& name : names) {
      float value = 0;
      if (name == "x") value = static_cast<float>(row + 1);
      if (name == "rot_0") value = 1;
      if (name == "scale_1") value = std::log(0.5f);
      if (name == "scale_2") value = std::log(0.25f);
      if (std::ranges::count(more, name)) value = 0.5f;
      text += bytes_of(value);
    }
  return text;
}

}  // namespace

TEST_CASE("ply: marks of antialiased training are read from comments, kept by rows, written by us") {
  const Folder folder;
  for (const auto& [comment, marked] :
       std::vector<std::pair<std::string, bool>>{{"SplatRenderMode: mip", true},
                                                 {"antialiased 1", true},
                                                 {"Antialiased: true", true},
                                                 {"SplatRenderMode: default", false},
                                                 {"antialiased 0", false},
                                                 {"not antialiased 1", false}}) {
    CAPTURE(comment);
    write(folder / "a.ply", small_ply({}, "", "comment " + comment + "\n"));
    const Scene scene = load_scene(folder / "a.ply");
    CHECK(scene.cloud.antialiased == marked);
    for (const char* name : {"b.ply", "b.compressed.ply", "b.spz", "b.sog"}) {
      CAPTURE(name);
      const SaveReport saved = save_scene(folder / name, scene, {}, output_format_from_name(name));
      CHECK(saved.loss.find("antialias") == std::string::npos);
      CHECK(load_scene(folder / name).cloud.antialiased == marked);
    }
    Scene moved = scene;
    moved.rows_can_be_copied = false;
    save_scene(folder / "c.ply", moved, {}, SceneFormat::kPly);
    CHECK(load_scene(folder / "c.ply").cloud.antialiased == marked);
    CHECK((save_scene(folder / "b.splat", scene, {}, SceneFormat::kSplat).loss.find("antialias") !=
           std::string::npos) == marked);
  }
}

TEST_CASE(
    "ply: the 3D filter of Mip-Splatting is fused: sizes grow by it, opacity falls as the volume grows") {
  const Folder folder;
  write(folder / "a.ply", small_ply({"filter_3D"}));  // 0.5
  const Scene scene = load_scene(folder / "a.ply");
  const glm::vec3 expected(std::sqrt(1.25f), std::sqrt(0.5f), std::sqrt(0.3125f));
  CHECK(glm::length(scene.cloud.scale[0] - expected) < 1e-6f);
  CHECK(scene.cloud.opacity[0] ==
        doctest::Approx(0.5 * (1 * 0.5 * 0.25) / (expected.x * expected.y * expected.z)));
  CHECK(scene.other_properties.empty());
  save_scene(folder / "b.ply", scene, {}, SceneFormat::kPly);  // the rows as they are: fused again when read
  check_equal(load_scene(folder / "b.ply").cloud, scene.cloud);
  const std::string good = small_ply({"filter_3D"});
  const std::size_t filter = good.size() - 4, log_size = filter - 5 * 4;  // of the last row
  for (const auto& [at, value] : {std::pair(filter, 1e30f), {log_size, 79.9f}}) {
    std::string bad = good;
    write(folder / "bad.ply", bad.replace(at, 4, bytes_of(value)));
    CHECK(load_scene(folder / "bad.ply").dropped == 1);
  }
}

TEST_CASE("ply: 2D Gaussians have a third axis of no size") {
  const Folder folder;
  write(folder / "a.ply", small_ply({}, "scale_2"));
  const Scene scene = load_scene(folder / "a.ply");
  REQUIRE(scene.cloud.size() == 2);
  CHECK(scene.cloud.scale[0] == glm::vec3(1, 0.5f, 0));
  save_scene(folder / "b.spz", scene, {}, SceneFormat::kSpz);
  CHECK(load_scene(folder / "b.spz").cloud.scale[0].z < 1e-4f);
  write(folder / "worse.ply", small_ply({}, "scale_1"));
  CHECK(mentions(refusal(folder / "worse.ply"), {"scale_1", "missing"}));
}

TEST_CASE("ply: of degree 4 the coefficients up to degree 3 are taken, channel by channel, and it is said") {
  const Folder folder;
  std::vector<std::string> rest;
  for (int i = 0; i < 72; ++i) rest.push_back(fmt::format("f_rest_{}", i));
  std::string text = small_ply(rest);
  const std::size_t row = (14 + 72) * sizeof(float), first = text.size() - row + 14 * sizeof(float);
  for (int i = 0; i < 72; ++i)
    text.replace(first + static_cast<std::size_t>(i) * sizeof(float), 4,
                 bytes_of(0.01f * static_cast<float>(i)));
  write(folder / "a.ply", text);
  const Scene scene = load_scene(folder / "a.ply");
  CHECK(scene.cloud.sh_degree == 3);
  const std::size_t second = scene.cloud.file_row[0] == 1 ? 0 : 1;
  for (std::size_t c = 0; c < 3; ++c)
    for (std::size_t k = 0; k < 15; ++k)
      CHECK(scene.cloud.sh_rest_of(second)[15 * c + k] == 0.01f * static_cast<float>(24 * c + k));
  CHECK(mentions(scene.left_out, {"degree 4", "degree 3"}));
}

TEST_CASE("ply: linear colours become sRGB, and are refused where they depend on the view") {
  const Folder folder;
  const auto with_space = [](std::string text, char space) {
    text.replace(text.find("end_header"), 0, "element color_space 1\nproperty uchar color_space\n");
    return text + space;
  };
  write(folder / "a.ply", with_space(small_ply(), '\1'));
  const Scene scene = load_scene(folder / "a.ply");  // 0.5 is 0.735357 in sRGB
  CHECK(0.5f + 0.28209479f * scene.cloud.f_dc[0].x == doctest::Approx(0.735357).epsilon(1e-5));
  CHECK_FALSE(scene.rows_can_be_changed);  // sRGB beside them would be read as linear
  write(folder / "b.ply", with_space(small_ply(), '\0'));
  CHECK(load_scene(folder / "b.ply").cloud.f_dc[0] == glm::vec3(0));
  std::vector<std::string> rest;
  for (int i = 0; i < 9; ++i) rest.push_back(fmt::format("f_rest_{}", i));
  write(folder / "c.ply", with_space(small_ply(rest), '\1'));
  CHECK(mentions(refusal(folder / "c.ply"), {"linear", "sRGB"}));
}

TEST_CASE("ply: an element of no rows takes no bytes, numbers of text may have a plus") {
  const Folder folder;
  write(folder / "a.ply", small_ply({}, "", "element face 0\nproperty list uchar int vertex_indices\n"));
  CHECK(load_scene(folder / "a.ply").cloud.size() == 2);
  write(folder / "b.ply", small_ply({}, "", "element face 1\nproperty list uchar int vertex_indices\n"));
  CHECK(mentions(refusal(folder / "b.ply"), {"list properties"}));
  std::string text = "ply\nformat ascii 1.0\nelement vertex 1\n";
  for (const char* name : {"x", "y", "z", "f_dc_0", "f_dc_1", "f_dc_2", "opacity", "scale_0", "scale_1",
                           "scale_2", "rot_0", "rot_1", "rot_2", "rot_3"})
    text += fmt::format("property float {}\n", name);
  write(folder / "c.ply", text + "end_header\n+1.5 -2 3 0 0 0 +0 -1 -1 -1 1 0 0 +0\n+9 9\n");
  CHECK(load_scene(folder / "c.ply").cloud.position[0] == glm::vec3(1.5f, -2, 3));
  write(folder / "d.ply", text + "end_header\n+-1.5 -2 3 0 0 0 0 -1 -1 -1 1 0 0 0\n");
  CHECK(mentions(refusal(folder / "d.ply"), {"no number"}));
}

TEST_CASE(
    "what stands in place of a file is said: pointers of Git LFS, web pages, other data in gzip, nothing") {
  const Folder folder;
  for (const char* name : {"a.ply", "a.splat", "a.spz", "a.sog", "a.glb"}) {
    CAPTURE(name);
    write(folder / name, "version https://git-lfs.github.com/spec/v1\noid sha256:4d7a\nsize 123456\n");
    CHECK(mentions(refusal(folder / name), {"pointer of Git LFS", "git lfs pull"}));
    for (const char* page :
         {"<!DOCTYPE html><html>", "<html><head>", "\n <HTML>", "\xef\xbb\xbf<!doctype HTML>",
          "<?xml version=\"1.0\"?><Error><Code>AccessDenied</Code></Error>"}) {
      write(folder / name, page);
      CHECK(mentions(refusal(folder / name), {"web page"}));
    }
    write(folder / name, gzip(small_ply()));
    CHECK(mentions(refusal(folder / name), {"gzip", "gunzip"}));
  }
  std::string empty = small_ply();
  empty.replace(empty.find("vertex 2"), 8, "vertex 0");
  write(folder / "a.ply", empty.substr(0, empty.find("end_header") + 11));
  CHECK(mentions(refusal(folder / "a.ply"), {"empty"}));
}

TEST_CASE("spz: steps larger than the Gaussians are refused with what to do") {
  const Folder folder;
  Scene scene;
  scene.cloud = varied_cloud(100, 0);
  for (glm::vec3& p : scene.cloud.position) p.x += 4.5e6f;
  CHECK_THROWS_WITH_AS(save_scene(folder / "a.spz", scene, {}, SceneFormat::kSpz),
                       doctest::Contains("near the origin"), Error);
  for (glm::vec3& p : scene.cloud.position) p.x -= 4.4999e6f;
  CHECK_NOTHROW(save_scene(folder / "a.spz", scene, {}, SceneFormat::kSpz));
}

TEST_CASE("gltf: numbers inside the text, signs in names, no scenes, and extensions that are required") {
  const Folder folder;
  Scene written;
  written.cloud = varied_cloud(50, 2);
  save_scene(folder / "a.glb", written, {}, SceneFormat::kGlb);
  const std::string bytes = text_of(folder / "a.glb");
  std::uint32_t text_bytes = 0;
  std::memcpy(&text_bytes, bytes.data() + 12, 4);
  const auto original = nlohmann::json::parse(bytes.substr(20, text_bytes));
  const std::string numbers = bytes.substr(28 + text_bytes);
  const auto put = [&](const nlohmann::json& text) { write(folder / "b.gltf", text.dump()); };

  auto text = original;
  text["buffers"][0]["uri"] = "my%20num%62ers.bin";
  write(folder / "my numbers.bin", numbers);
  put(text);
  check_same(written.cloud, load_scene(folder / "b.gltf"), limits().at("glb").limit);

  fs::create_directories(folder / "below");
  write(folder / "below/numbers.bin", numbers);
  for (const char* uri : {"./my%20numbers.bin", "below/numbers.bin"}) {
    text["buffers"][0]["uri"] = uri;
    put(text);
    check_same(written.cloud, load_scene(folder / "b.gltf"), limits().at("glb").limit);
  }
  for (const char* uri :
       {"", "../numbers.bin", "below/../../numbers.bin", "/numbers.bin", "https://a.b/numbers.bin"}) {
    CAPTURE(uri);
    text["buffers"][0]["uri"] = uri;
    put(text);
    CHECK(mentions(refusal(folder / "b.gltf"), {"another folder"}));
  }

  constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string packed;
  for (std::size_t i = 0; i < numbers.size(); i += 3) {
    std::uint32_t three = 0;
    for (std::size_t j = i; j < i + 3; ++j)
      three = three << 8 | (j < numbers.size() ? static_cast<std::uint8_t>(numbers[j]) : 0u);
    for (const int shift : {18, 12, 6, 0}) packed += kDigits[three >> shift & 63];
  }
  for (std::size_t i = 0; i < (3 - numbers.size() % 3) % 3; ++i) packed[packed.size() - 1 - i] = '=';
  text["buffers"][0]["uri"] = "data:application/octet-stream;base64," + packed;
  text.erase("scenes");
  text.erase("scene");
  put(text);
  check_same(written.cloud, load_scene(folder / "b.gltf"), limits().at("glb").limit);
  text["buffers"][0]["uri"] = "data:application/octet-stream;base64,AA*A";
  put(text);
  CHECK(mentions(refusal(folder / "b.gltf"), {"base64"}));

  text = original;
  text["buffers"][0]["uri"] = "my numbers.bin";
  text["extensionsRequired"] = {"KHR_gaussian_splatting", "EXT_meshopt_compression"};
  put(text);
  CHECK(mentions(refusal(folder / "b.gltf"), {"needs the extension EXT_meshopt_compression"}));
  text.erase("extensionsRequired");
  const auto views = text["accessors"][1]["bufferView"];
  for (const nlohmann::json& wrong : std::vector<nlohmann::json>{1e53, -1, 0.5, "0", nullptr}) {
    text["accessors"][1]["bufferView"] = wrong;
    put(text);
    CHECK(mentions(refusal(folder / "b.gltf"), {"a whole number is wanted, not"}));
  }
  text["accessors"][1]["bufferView"] = views.get<double>();  // 1.0 is one
  put(text);
  check_same(written.cloud, load_scene(folder / "b.gltf"), limits().at("glb").limit);
  text["bufferViews"][0]["extensions"] = {{"EXT_meshopt_compression", {{"mode", "ATTRIBUTES"}}}};
  put(text);
  CHECK(mentions(refusal(folder / "b.gltf"), {"EXT_meshopt_compression"}));
}
