// What is damaged, packed too well or of another kind is refused with a sentence, or gives a bounded scene.
#include <fmt/format.h>

#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "ksplat_by_hand.h"
#include "quick.h"
#include "scene/packing/webp.h"
#include "scene/packing/zip_file.h"

using namespace splatcut;
using namespace splatcut::testing;

namespace {

// Loads what may be anything: an Error with a sentence, or a cloud no larger than is stated.
void load_damaged(const fs::path& path) {
  try {
    const Scene scene = load_scene(path);
    const std::size_t cloud_bytes = scene.cloud.size() * (68 + 4 * scene.cloud.sh_stride());
    CHECK(cloud_bytes <= 6 * (256 * fs::file_size(path) + (16 << 20)));
  } catch (const Error& error) {
    CHECK(mentions(error.what(), {path.filename().c_str()}));
  }
}

std::string text_of_bytes(const std::vector<std::byte>& bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

ZipEntry entry(const std::string& name, const std::string& text) {
  const auto bytes = std::as_bytes(std::span(text));
  return {name, {bytes.begin(), bytes.end()}};
}

}  // namespace

QUICK_CASE("sog", "sog: as a folder, inside another folder of the archive, and what is wrong with others") {
  const Folder folder;
  Scene scene;
  scene.cloud = varied_cloud(500, 1);
  save_scene(folder / "a.sog", scene, {}, SceneFormat::kSog);
  const MappedFile file(folder / "a.sog");
  const ZipReader zip(file);
  const std::vector<std::string> names = {"meta.json",          "means_l.webp",   "means_u.webp",
                                          "quats.webp",         "scales.webp",    "sh0.webp",
                                          "shN_centroids.webp", "shN_labels.webp"};
  std::vector<ZipEntry> entries;
  for (const std::string& name : names) {
    const std::string text = text_of_bytes(zip.read(name));
    entries.push_back(entry(fmt::format("inner/{}", name), text));
    fs::create_directories(folder / "open");
    write(folder / "open" / name, text);
  }
  std::vector<ZipEntry> packed = entries;  // by the Finder, which adds files of the same names
  packed.insert(packed.begin(), entry("__MACOSX/inner/meta.json", "of the Finder"));
  write(folder / "inner.sog", text_of_bytes(zip_of(packed)));
  const Scene expected = load_scene(folder / "a.sog");
  for (const fs::path& path : {folder / "inner.sog", folder / "open/meta.json", folder / "open"}) {
    CAPTURE(path.string());
    const Scene got = load_scene(path);
    CHECK(got.cloud.position == expected.cloud.position);
    CHECK(got.cloud.sh_rest == expected.cloud.sh_rest);
  }
  CHECK(load_scene(folder / "open").path == folder / "open/meta.json");

  const auto with = [&](const std::string& name, const std::string& text) {
    std::vector<ZipEntry> changed = entries;
    for (ZipEntry& e : changed)
      if (e.name == fmt::format("inner/{}", name)) e = entry(e.name, text);
    write(folder / "bad.sog", text_of_bytes(zip_of(changed)));
    return refusal(folder / "bad.sog");
  };
  auto meta = nlohmann::json::parse(text_of_bytes(zip.read("meta.json")));
  const auto with_meta = [&](const char* key, const nlohmann::json& value) {
    auto changed = meta;
    changed[key] = value;
    return with("meta.json", changed.dump());
  };
  CHECK(mentions(with("quats.webp", "RIFF no"), {"quats.webp", "no WebP"}));
  CHECK(mentions(with("meta.json", "{"), {"meta.json"}));
  CHECK(mentions(with_meta("version", 3), {"version 3"}));
  CHECK(mentions(with_meta("count", 100000), {"pixels for 100000"}));
  CHECK(mentions(with_meta("count", -1), {"whole number"}));
  CHECK(mentions(with_meta("means", 7), {"meta.json"}));
  auto beyond = meta["shN"];
  beyond["codebook"][3] = 1e60;
  CHECK(mentions(with_meta("shN", beyond), {"beyond all bounds"}));
  CHECK(mentions(with("sh0.webp", text_of_bytes(write_webp(Image<Rgba8>(4, 4)))), {"sh0.webp", "16 pixels"}));
  // 16 million pixels in a few dozen bytes
  CHECK(mentions(with("scales.webp", text_of_bytes(write_webp(Image<Rgba8>(4096, 4096)))),
                 {"damaged", "no scene packs so well"}));
  // Some writers leave out the least value of a codebook: the others go on by their mean step.
  auto scales = meta["scales"];
  const double second = scales["codebook"][1], last = scales["codebook"][255];
  scales["codebook"][0] = nullptr;
  CHECK(with_meta("scales", scales) == "no error");
  float least = 1;
  for (const glm::vec3& scale : load_scene(folder / "bad.sog").cloud.scale)
    least = std::min({least, scale.x, scale.y, scale.z});
  CHECK(std::log(least) == doctest::Approx(second - (last - second) / 255).epsilon(1e-4));
  scales["codebook"][7] = nullptr;
  CHECK(mentions(with_meta("scales", scales), {"meta.json"}));
  // Version 1 has logits, whether it says its number or not.
  auto first = meta;
  first["means"]["shape"] = {500, 3};
  first.erase("version");
  with("meta.json", first.dump());
  const std::vector<float> opacity = load_scene(folder / "bad.sog").cloud.opacity;
  CHECK(opacity != expected.cloud.opacity);
  first["version"] = 1;
  with("meta.json", first.dump());
  CHECK(load_scene(folder / "bad.sog").cloud.opacity == opacity);
  write(folder / "bad.sog", text_of_bytes(zip_of(std::vector<ZipEntry>{entry("scene.ply", "ply")})));
  CHECK(mentions(refusal(folder / "bad.sog"), {"ZIP without meta.json", "Unpack"}));
  auto outside = meta;
  outside["quats"]["files"] = {"../open/quats.webp"};
  write(folder / "open/meta.json", outside.dump());
  CHECK(mentions(refusal(folder / "open/meta.json"), {"another folder"}));
}

TEST_CASE("spz: data that end before their checksum, or do not fit it, are refused") {
  const Folder folder;
  Scene scene;
  scene.cloud = varied_cloud(300, 1);
  save_scene(folder / "good.spz", scene, {}, SceneFormat::kSpz);
  const MappedFile file(folder / "good.spz");
  const std::string good = text_of_bytes({file.bytes().begin(), file.bytes().end()});
  const auto read_as = [&](const std::string& text) {
    write(folder / "a.spz", text);
    return refusal(folder / "a.spz");
  };
  CHECK(read_as(good + "a tail") == "no error");
  for (const std::size_t cut : {1, 4, 8, 20})
    CHECK(mentions(read_as(good.substr(0, good.size() - cut)), {"ends at byte"}));
  for (std::size_t at = 100; at < good.size(); at += good.size() / 23) {
    std::string wrong = good;
    wrong[at] = static_cast<char>(wrong[at] ^ 0x10);
    CAPTURE(at);
    CHECK(read_as(wrong) != "no error");
  }
}

QUICK_CASE("spz",
           "packed files that promise a thousand times their size are refused before they are unpacked") {
  const Folder folder;
  const std::uint32_t points = 20'000'000;
  const std::string head = "NGSP" + bytes_of(3u) + bytes_of(points) + std::string("\x00\x0c\x00\x00", 4);
  const std::string zeros(400'000, '\0');  // what there is of 400 MB: the promise alone decides
  write(folder / "a.spz", gzip(head + zeros));
  CHECK(mentions(refusal(folder / "a.spz"), {"damaged", "400000000 unpacked"}));
  std::string v4 = "NGSP" + bytes_of(4u) + bytes_of(points) + std::string("\x00\x0c\x00\x05", 4) +
                   bytes_of(32u) + std::string(12, '\0');
  std::string streams;
  for (const std::uint64_t bytes : {9u, 1u, 3u, 3u, 4u}) {
    const std::string packed = zstd(std::string(10'000, '\0'));
    v4 += bytes_of(std::uint64_t{packed.size()}) + bytes_of(bytes * points);
    streams += packed;
  }
  write(folder / "b.spz", v4 + streams);
  CHECK(mentions(refusal(folder / "b.spz"), {"damaged", "no scene packs so well"}));
}

TEST_CASE("damage: every format, cut anywhere or with bytes changed, gives an Error or a bounded scene") {
  const Folder folder;
  Scene scene;
  scene.cloud = varied_cloud(60, 1);
  std::map<std::string, std::string> files;
  for (const SceneFormat& format : both_ways()) {
    const std::string name = fmt::format("whole{}", format.extension);
    save_scene(folder / name, scene, {}, format);
    files[format.extension] = text_of(folder / name);
  }
  save_scene(folder / "v4.spz", scene, {}, SceneFormat::kSpz, {4});
  files[".4.spz"] = text_of(folder / "v4.spz");
  files[".raw.spz"] = gunzip(files[".spz"]);
  for (const char* level : {"0", "1", "2"})
    files[fmt::format(".{}.ksplat", level)] = ksplat_by_hand(std::atoi(level));
  std::mt19937 random(19);
  for (const auto& [extension, whole] : files) {
    CAPTURE(extension);
    const fs::path path = folder / fmt::format("d{}", extension);
    for (int i = 0; i < 60; ++i) {
      write(path, whole.substr(0, 1 + random() % whole.size()));
      load_damaged(path);
    }
    for (int i = 0; i < 200; ++i) {
      std::string bytes = whole;
      // Heads are where sizes stand
      const std::size_t reach = i % 2 ? bytes.size() : std::min<std::size_t>(bytes.size(), 64);
      for (int k = 0; k < 1 + i % 4; ++k) bytes[random() % reach] = static_cast<char>(random());
      write(path, bytes);
      load_damaged(path);
    }
  }
}

QUICK_CASE("splat", "splat: a first number that begins as a packed .spz does is one") {
  const Folder folder;
  write(folder / "a.splat", "\x1f\x8b\x20\x3f" + bytes_of(glm::vec2(0)) + bytes_of(glm::vec3(1)) +
                                "\x80\x80\x80\xff\xff\x80\x80\x80");
  CHECK(load_scene(folder / "a.splat").cloud.position[0].x == doctest::Approx(0.6271).epsilon(1e-3));
}

QUICK_CASE("splat", "files of other kinds are refused with what to do") {
  const Folder folder;
  const auto check = [&](const char* name, const std::string& bytes,
                         std::initializer_list<const char*> parts) {
    write(folder / name, bytes);
    CHECK(mentions(refusal(folder / name), parts));
  };
  check("scan.las", "LASF", {"point cloud", "Train"});
  check("renamed.bin", "LASF and more", {"point cloud", "Train"});
  check("scan.e57", "ASTM-E57", {"point cloud", "Train"});
  check("scene.obj", "v 0 0 0", {"mesh", "Train"});
  check("a.splatv", std::string("\x4b\x67\x00\x00", 4), {"moving scene", ".ply"});
  check("moving.splat", std::string("\x4b\x67\x00\x00", 4) + std::string(60, 'a'), {"moving scene", ".ply"});
  check("picture.splat", "\x89PNG\r\n\x1a\n and more", {"this is a picture, not a scene"});
  check("photo.ply", std::string("\xff\xd8\xff\xe0\x00\x10JFIF", 10), {"this is a picture, not a scene"});
  for (const std::string& zip :
       {std::string("PK"), text_of_bytes(zip_of(std::vector<ZipEntry>{entry("a", "b")}))}) {
    check("step-30000.ckpt", zip, {"checkpoint", "ns-export"});
    check("model.pt", zip, {"checkpoint", "save_ply"});
    check("chair.usdz", zip, {"USD package"});
    check("chair.ssproj", zip, {"SuperSplat", "Export"});
  }
  check("lod-meta.json", "{}", {"lod-meta.json", "not the index of a streamed scene", "'filenames'"});
  check("scene.xyzzy", "what", {"extension", ".splat", ".sog"});
}

QUICK_CASE("JSON",
           "text in glTF and .sog that is no JSON, or another, is refused without the words of a library") {
  const Folder folder;
  const auto said = [&](const char* name, const std::string& text) {
    write(folder / name, text);
    const std::string sentence = refusal(folder / name);
    CHECK(sentence.find("json.exception") == std::string::npos);
    return sentence;
  };
  CHECK(mentions(said("a.gltf", "{\"asset\": "), {"a.gltf", "is not valid JSON at byte"}));
  CHECK(mentions(said("a.gltf", "{\"asset\": {}}"), {"is not glTF as its standard has it", "not found"}));
  const std::string deep(4001, '[');
  CHECK(mentions(said("a.gltf", "{\"asset\": " + deep), {"a.gltf", "nested deeper than 4000 at byte 4010"}));
  CHECK(mentions(said("a.gltf", R"({"asset": "\")" + deep + "\"}"), {"is not glTF as its standard has it"}));
  CHECK(
      mentions(said("meta.json", "{\"means\": 1, \"quats\": "), {"meta.json", "is not valid JSON at byte"}));
  CHECK(mentions(said("meta.json", "{\"means\": 1, \"quats\": 2, \"version\": 2}"),
                 {"is not that of a .sog", "'count'"}));
}
