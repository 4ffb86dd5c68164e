// Which way is up, in files: written, read again, passed over where it is no direction.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "scene/formats/merged_scene.h"
#include "scene/formats/spz_axes.h"
#include "scene/packing/zip_file.h"
#include "scene_file_helpers.h"

using namespace splatcut;
using namespace splatcut::testing;

namespace {

Scene small_scene() {
  Scene scene;
  scene.cloud = varied_cloud(20, 1);
  scene.file_rows = scene.cloud.size();
  return scene;
}

struct Kind {
  const char* file;
  SceneFormat format;
  int spz_version = 3;
  bool says = true;
};
std::vector<Kind> kinds() {
  return {{"a.ply", SceneFormat::kPly},
          {"a.compressed.ply", SceneFormat::kCompressedPly},
          {"a3.spz", SceneFormat::kSpz},
          {"a4.spz", SceneFormat::kSpz, 4},
          {"a.sog", SceneFormat::kSog},
          {"a.glb", SceneFormat::kGlb},
          {"a.splat", SceneFormat::kSplat, 3, false}};
}

std::string meta_of(const fs::path& sog) {
  const MappedFile file(sog);
  const std::vector<std::byte> bytes = ZipReader(file).read("meta.json");
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

std::string text_of_glb(const fs::path& path) {
  const std::string whole = text_of(path);
  std::uint32_t bytes = 0;
  std::memcpy(&bytes, whole.data() + 12, sizeof bytes);
  return whole.substr(20, bytes);
}

// Of gzip's header, which is 10 bytes and then the comment.
std::string comment_of(const fs::path& spz) {
  return text_of(spz).c_str() + 10;
}

// Changes what stands between two marks, both of which stay.
std::string with_between(std::string text, const std::string& before, const std::string& after,
                         const std::string& now) {
  const std::size_t begin = text.find(before) + before.size(), end = text.find(after, begin);
  REQUIRE(text.find(before) != text.npos);
  return text.replace(begin, end - begin, now);
}

// A .glb with another text, whose length is a multiple of four.
void write_with_text(const fs::path& path, const std::string& glb, std::string text) {
  std::uint32_t was = 0;
  std::memcpy(&was, glb.data() + 12, sizeof was);
  text.resize((text.size() + 3) / 4 * 4, ' ');
  std::string out = glb.substr(0, 20) + text + glb.substr(20 + was);
  const auto whole = static_cast<std::uint32_t>(out.size()), now = static_cast<std::uint32_t>(text.size());
  std::memcpy(out.data() + 8, &whole, sizeof whole);
  std::memcpy(out.data() + 12, &now, sizeof now);
  write(path, out);
}

}  // namespace

TEST_CASE("up: every format that can say it gives it back, and .splat says that it is lost") {
  const Folder folder;
  const Scene scene = small_scene();
  for (const glm::vec3& up : {glm::vec3(0, 0, 1), glm::vec3(0, -1, 0), glm::vec3(0.3f, -0.9f, 0.2f) * 7.0f})
    for (const Kind& kind : kinds()) {
      CAPTURE(kind.file);
      CAPTURE(up.z);
      const fs::path path = folder / kind.file;
      const std::string without =
          save_scene(path, scene, {}, kind.format, {.spz_version = kind.spz_version}).loss;
      CHECK_FALSE(load_scene(path).up);
      const std::string with =
          save_scene(path, scene, {}, kind.format, {.spz_version = kind.spz_version, .up = up}).loss;
      const Scene got = load_scene(path);
      CHECK(got.oddity.empty());
      REQUIRE(got.up.has_value() == kind.says);
      if (!kind.says) {
        CHECK(with == without + "; which way is up is left out");
        continue;
      }
      CHECK(with == without);
      CHECK(glm::distance(*got.up, glm::normalize(up)) < 2e-6f);
      check_equal(got.cloud, [&] {  // nothing else is touched
        save_scene(path, scene, {}, kind.format, {.spz_version = kind.spz_version});
        return load_scene(path).cloud;
      }());
    }
}

TEST_CASE("up: it stands in the file in the file's own axes, where others find it") {
  const Folder folder;
  const Scene scene = small_scene();
  const auto put = [&](const Kind& kind, const glm::vec3& up) {
    save_scene(folder / kind.file, scene, {}, kind.format, {.spz_version = kind.spz_version, .up = up});
    return folder / kind.file;
  };
  const std::vector<Kind> all = kinds();
  CHECK(text_of(put(all[0], {0, 0, 1})).find("comment up 0 0 1\n") != std::string::npos);
  CHECK(text_of(put(all[1], {0, 0, 1})).find("comment up 0 0 1\n") != std::string::npos);
  CHECK(comment_of(put(all[2], kRightUpBack.position({0, 0, 1}))) ==
        "splatcut: x right, y up, z back; up 0 0 1");
  CHECK(nlohmann::json::parse(meta_of(put(all[4], {0, 0, 1})))["up"] == nlohmann::json{0, 0, 1});
  const auto glb = nlohmann::json::parse(text_of_glb(put(all[5], kLeftUpForward.position({0, 0, 1}))));
  CHECK(glb["scenes"][0]["extras"]["up"] == nlohmann::json{0, 0, 1});

  const auto usda = [&](const glm::vec3& up) {
    const SaveReport report = save_scene(folder / "a.usda", scene, {}, SceneFormat::kUsda, {.up = up});
    const std::string text = text_of(folder / "a.usda");
    return std::pair(text.substr(text.find("upAxis = ") + 10, 1), report.loss);
  };
  CHECK(usda({0, 0, -1}) == std::pair<std::string, std::string>("Z", ""));
  CHECK(usda({0, -1, 0}) == std::pair<std::string, std::string>("Y", ""));
  CHECK(mentions(usda({0, 0, 1}).second, {"up is said to be +y"}));
}

TEST_CASE(
    "up: a .ply whose rows are copied says the new one alone, and keeps its own where none is asked for") {
  const Folder folder;
  std::string text = numbered_ply(splat_names(0), 30);
  text.insert(text.find("element"), "comment up 1 0 0\r\n");
  write(folder / "a.ply", text);
  const Scene scene = load_scene(folder / "a.ply");
  REQUIRE(scene.rows_can_be_copied);
  CHECK(scene.up == glm::vec3(1, 0, 0));
  save_scene(folder / "b.ply", scene, {}, SceneFormat::kPly, {.up = glm::vec3(0, 2, 0)});
  const std::string copied = text_of(folder / "b.ply");
  CHECK(copied.find("comment up 1 0 0") == std::string::npos);
  CHECK(copied == with_between(text, "comment made by hand\n", "element", "comment up 0 1 0\n"));
  // Converted: what the source says goes along, into other axes too.
  save_scene(folder / "c.ply", scene, {}, SceneFormat::kPly);
  CHECK(load_scene(folder / "c.ply").up == glm::vec3(1, 0, 0));
  save_scene(folder / "c.glb", scene, {}, SceneFormat::kGlb);
  CHECK(load_scene(folder / "c.glb").up == glm::vec3(1, 0, 0));
  Scene other = with_cloud(scene, scene.cloud);
  CHECK(other.up == scene.up);
}

TEST_CASE("up: the header of a copied .ply has one kind of line ends") {
  const Folder folder;
  std::string text = numbered_ply(splat_names(0), 30);
  const std::size_t body = text.find("end_header\n") + 11;
  for (std::size_t at = 0, left = body; (at = text.find('\n', at)) < left; at += 2, ++left)
    text.insert(at, "\r");
  write(folder / "a.ply", text);
  const Scene scene = load_scene(folder / "a.ply");
  REQUIRE(scene.rows_can_be_copied);
  save_scene(folder / "b.ply", scene, {}, SceneFormat::kPly, {.up = glm::vec3(0, 2, 0)});
  CHECK(text_of(folder / "b.ply") ==
        with_between(text, "comment made by hand\r\n", "element", "comment up 0 1 0\r\n"));
}

TEST_CASE("up: what is no direction is passed over with a sentence, in every format") {
  const Folder folder;
  const Scene scene = small_scene();
  const fs::path ply = folder / "a.ply", spz = folder / "a.spz", sog = folder / "meta.json",
                 glb = folder / "a.glb";
  const auto passed_over = [](const fs::path& path) {
    const Scene got = load_scene(path);
    CHECK(got.cloud.size() == 20);
    CHECK(mentions(got.oddity, {"of up is no direction and is passed over"}));
    CHECK_FALSE(got.up);
  };
  save_scene(ply, scene, {}, SceneFormat::kPly, {.up = glm::vec3(0, 0, 1)});
  const std::string good_ply = text_of(ply);
  for (const char* said :
       {"0 0 0", "nan 0 1", "0 inf 1", "0 0", "0 0 1 0", "north", "0 0 1x", "", "1e999 0 0", "0,0,1"}) {
    CAPTURE(said);
    write(ply, with_between(good_ply, "comment up", "\n", std::string(" ") + said));
    passed_over(ply);
  }
  for (const char* said : {"0 0 1e-30", "0 0 1e30", "  0\t0  5 "}) {  // any length
    CAPTURE(said);
    write(ply, with_between(good_ply, "comment up", "\n", std::string(" ") + said));
    CHECK(load_scene(ply).up == glm::vec3(0, 0, 1));
  }
  write(ply, with_between(good_ply, "comment ", "\n", "upward is the sky"));
  CHECK_FALSE(load_scene(ply).up);
  CHECK(load_scene(ply).oddity.empty());

  save_scene(spz, scene, {}, SceneFormat::kSpz, {.up = glm::vec3(0, 0, 1)});
  const std::string good_spz = text_of(spz);
  for (const char* said : {"0 0 0", "nan nan nan", "up", ""}) {
    CAPTURE(said);
    write(spz, with_between(good_spz, "; up ", std::string(1, '\0'), said));
    passed_over(spz);
    CHECK_FALSE(load_scene(spz).taken_axes);  // the comment still says those
  }
  save_scene(spz, scene, {}, SceneFormat::kSpz, {.spz_version = 4, .up = glm::vec3(0, -1, 0)});
  const std::string good_v4 = text_of(spz), record = bytes_of(0x53430001u) + bytes_of(12u);
  for (const float z : {0.0f, kNan, kInfinity}) {
    CAPTURE(z);
    std::string bad = good_v4;
    bad.replace(bad.find(record) + 8, 12, bytes_of(0.0f) + bytes_of(0.0f) + bytes_of(z));
    write(spz, bad);
    passed_over(spz);
  }
  std::string shorter = good_v4;  // a record of ours with fewer bytes than it wants is none
  shorter.replace(shorter.find(record) + 4, 4, bytes_of(4u));
  write(spz, shorter);
  CHECK_FALSE(load_scene(spz).up);

  save_scene(folder / "a.sog", scene, {}, SceneFormat::kSog, {.up = glm::vec3(0, 0, 1)});
  const MappedFile packed(folder / "a.sog");
  const ZipReader zip(packed);
  const nlohmann::json meta = nlohmann::json::parse(meta_of(folder / "a.sog"));
  for (const char* part : {"means", "scales", "quats", "sh0", "shN"})
    for (const nlohmann::json& name : meta.at(part).at("files")) {
      const std::vector<std::byte> bytes = zip.read(name);
      write(folder / name.get<std::string>(), {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
    }
  save_scene(glb, scene, {}, SceneFormat::kGlb, {.up = glm::vec3(0, 0, 1)});
  const std::string good_glb = text_of(glb);
  for (const char* said : {"[0, 0, 0]", "[0, 0]", "[0, 0, 1, 0]", "\"+z\"", "[\"0\", 0, 1]", "null", "{}",
                           "[1e308, 1e308, 1e308]", "[[0], 0, 1]"}) {
    CAPTURE(said);
    nlohmann::json changed = meta;
    changed["up"] = nlohmann::json::parse(said);
    write(sog, changed.dump());
    passed_over(sog);
    nlohmann::json text = nlohmann::json::parse(text_of_glb(glb));
    text["scenes"][0]["extras"]["up"] = nlohmann::json::parse(said);
    write_with_text(folder / "b.glb", good_glb, text.dump());
    passed_over(folder / "b.glb");
  }
  nlohmann::json text = nlohmann::json::parse(text_of_glb(glb));
  text["scenes"][0]["extras"] = "of another program";
  write_with_text(folder / "b.glb", good_glb, text.dump());
  CHECK_FALSE(load_scene(folder / "b.glb").up);
}

TEST_CASE("up: a merged file says that of the first, and that another says otherwise") {
  std::vector<Scene> scenes;
  for (const auto& up : {std::optional<glm::vec3>(), std::optional(glm::vec3(0, -1, 0)),
                         std::optional(glm::vec3(0, -1, 0.001f)), std::optional(glm::vec3(0, 0, 1))}) {
    scenes.push_back(small_scene());
    scenes.back().path = fmt::format("scene_{}.ply", scenes.size());
    scenes.back().up = up;
  }
  const auto of = [&](std::vector<std::size_t> which) {
    std::vector<Scene> some;
    for (const std::size_t i : which) {
      some.push_back(with_cloud(scenes[i], scenes[i].cloud));
    }
    return merged(std::move(some));
  };
  CHECK(of({1, 2, 0}).scene.up == glm::vec3(0, -1, 0));
  CHECK(of({1, 2, 0}).loss.empty());
  CHECK(of({0, 0}).loss.empty());
  CHECK(mentions(of({1, 3}).loss, {"which way is up by scene_4.ply", "scene_2.ply"}));
  CHECK_FALSE(of({0, 3}).scene.up);
  CHECK(mentions(of({0, 3}).loss, {"which way is up by scene_4.ply"}));
}
