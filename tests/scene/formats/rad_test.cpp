// .rad, its files made by hand.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "quick.h"
#include "scene/cloud/quantise.h"
#include "scene_file_helpers.h"

using namespace splatcut;
using namespace splatcut::testing;
using nlohmann::json;

namespace {

std::string padded(std::string bytes) {
  bytes.resize((bytes.size() + 7) / 8 * 8, '\0');
  return bytes;
}
std::string with_text(const std::string& mark, const json& text) {
  const std::string words = text.dump();
  return mark + bytes_of(static_cast<std::uint32_t>(words.size())) + padded(words);
}

template <class T>
std::string all_of(std::initializer_list<T> values) {
  std::string bytes;
  for (const T value : values) bytes += bytes_of(value);
  return bytes;
}
std::string floats(std::initializer_list<float> values) {
  return all_of<float>(values);
}
std::string octets(std::initializer_list<int> values) {
  std::string bytes;
  for (const int value : values) bytes += static_cast<char>(value);
  return bytes;
}
// What zlib writes less its header and its sum.
std::string deflated(const std::string& bytes) {
  std::string packed(bytes.size() + 64, '\0');
  uLongf size = packed.size();
  REQUIRE(compress(reinterpret_cast<Bytef*>(packed.data()), &size,
                   reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()) == Z_OK);
  return packed.substr(2, size - 6);
}

struct RadProperty {
  const char *name, *encoding;
  std::string bytes;
  float least = 0, most = 1;
};

std::string chunk_of(std::size_t base, std::size_t count, const std::vector<RadProperty>& properties,
                     bool packed) {
  json list = json::array();
  std::string payload;
  for (const RadProperty& p : properties) {
    const std::string bytes = packed ? deflated(p.bytes) : p.bytes;
    list.push_back({{"offset", payload.size()},
                    {"bytes", bytes.size()},
                    {"property", p.name},
                    {"encoding", p.encoding},
                    {"min", p.least},
                    {"max", p.most}});
    if (packed) list.back()["compression"] = "gz";
    payload += padded(bytes);
  }
  return with_text("RADC", {{"version", 1},
                            {"base", base},
                            {"count", count},
                            {"payloadBytes", payload.size()},
                            {"properties", list}}) +
         bytes_of(std::uint64_t{payload.size()}) + payload;
}

// In the file itself, or beside it as "NUMBER.radc".
std::string rad_of(std::size_t count, const std::vector<std::string>& chunks,
                   const Folder* beside = nullptr) {
  json list = json::array();
  std::string all;
  for (const std::string& chunk : chunks) {
    list.push_back({{"offset", beside ? 0 : all.size()}, {"bytes", chunk.size()}});
    if (beside) {
      const std::string name = fmt::format("{}.radc", list.size() - 1);
      list.back()["filename"] = name;
      write(*beside / name, chunk);
    } else {
      all += chunk;
    }
  }
  return with_text("RAD0", {{"version", 1}, {"type", "gsplat"}, {"count", count}, {"chunks", list}}) + all;
}

// Two Gaussians: at (1, 3, 5) and (2, 4, 6).
std::vector<RadProperty> two(const std::string& centre = floats({1, 2, 3, 4, 5, 6}),
                             const char* encoding = "f32") {
  return {{"center", encoding, centre},
          {"alpha", "r8", octets({0, 255}), 0, 1},
          {"rgb", "r8_delta", octets({51, 204, 255, 1, 0, 51}), 0, 1},
          {"scales", "ln_0r8", octets({0, 1, 255, 128, 1, 1}), -2, 2},
          {"orientation", "oct88r8", octets({255, 128, 255, 128, 128, 0})}};
}

std::string refused(const Folder& folder, const std::string& bytes) {
  write(folder / "a.rad", bytes);
  return refusal(folder / "a.rad");
}

}  // namespace

QUICK_CASE("rad", "rad: known values of every encoding, packed or not, in chunks within or beside") {
  const Folder folder;
  const std::string halves = all_of<std::uint16_t>({0x3c00, 0x4000, 0x4200, 0x4400, 0x4500, 0x4600});
  std::string planes, half_planes;
  for (std::size_t b = 0; b < 4; ++b)
    for (std::size_t v = 0; v < 6; ++v) planes += floats({1, 2, 3, 4, 5, 6})[4 * v + b];
  for (std::size_t b = 0; b < 2; ++b)
    for (std::size_t v = 0; v < 6; ++v) half_planes += halves[2 * v + b];
  const std::vector<std::pair<const char*, std::string>> centres = {{"f32", floats({1, 2, 3, 4, 5, 6})},
                                                                    {"f16", halves},
                                                                    {"f32_lebytes", planes},
                                                                    {"f16_lebytes", half_planes}};
  for (const auto& [encoding, centre] : centres)
    for (const bool packed : {false, true})
      for (const bool beside : {false, true}) {
        CAPTURE(encoding);
        write(folder / "a.rad",
              rad_of(4, {chunk_of(0, 2, two(centre, encoding), packed), chunk_of(2, 2, two(), packed)},
                     beside ? &folder : nullptr));
        const Scene scene = load_scene(folder / "a.rad");
        CHECK(scene.format == SceneFormat::kRad);
        CHECK(scene.files.size() == (beside ? 3 : 1));
        CHECK(scene.left_out.empty());
        REQUIRE(scene.cloud.size() == 4);
        for (std::size_t g = 0; g < 4; ++g) {
          const bool second = scene.cloud.file_row[g] % 2 == 1;
          CHECK(scene.cloud.position[g] == (second ? glm::vec3(2, 4, 6) : glm::vec3(1, 3, 5)));
          CHECK(scene.cloud.opacity[g] == (second ? 1.0f : 0.0f));
          const glm::vec3 rgb =
              second ? glm::vec3(1, 0, 0.2f) : glm::vec3(0.2f, 1, 0);  // 51 + 204, 255 + 1, 0 + 51
          CHECK(glm::length(colour_from_f_dc(scene.cloud.f_dc[g]) - rgb) < 1e-6f);
          const glm::vec3 scale = second ? glm::vec3(std::exp(-2.0f), 1, std::exp(-2.0f))
                                         : glm::vec3(0, std::exp(2.0f), std::exp(-2.0f));
          CHECK(glm::length(scene.cloud.scale[g] - scale) < 0.01f);  // 128 is a step above the middle
          // Half a turn about x, to a step; the other about anything by nothing.
          const glm::quat q = scene.cloud.rotation[g];
          if (second) CHECK(std::abs(q.w) > 0.9999f);
          if (!second) CHECK(std::abs(q.x) > 0.9999f);
        }
      }
}

TEST_CASE(
    "rad: other encodings, spherical harmonics coefficient by coefficient, by the least degree of the "
    "chunks") {
  const Folder folder;
  std::vector<RadProperty> one = {{"center", "f32", floats({1, 2, 3})},
                                  {"alpha", "f16", all_of<std::uint16_t>({0x3800})},
                                  {"rgb", "f32", floats({0.5f, 0.5f, 0.5f})},
                                  {"scales", "ln_f16", all_of<std::uint16_t>({0x0000, 0x3c00, 0xbc00})},
                                  {"orientation", "f32", floats({0, 0.6f, 0})}};
  std::string nine;
  for (int i = 0; i < 9; ++i) nine += octets({i * 10});
  one.push_back({"sh1", "s8", nine, -2, 2});
  write(folder / "a.rad", rad_of(1, {chunk_of(0, 1, one, true)}));
  const Scene scene = load_scene(folder / "a.rad");
  REQUIRE(scene.cloud.sh_degree == 1);
  CHECK(scene.cloud.opacity[0] == 0.5f);
  CHECK(glm::length(scene.cloud.scale[0] - glm::vec3(1, std::exp(1.0f), std::exp(-1.0f))) < 1e-6f);
  CHECK(glm::length(glm::vec4(scene.cloud.rotation[0].w, scene.cloud.rotation[0].x, scene.cloud.rotation[0].y,
                              scene.cloud.rotation[0].z) -
                    glm::vec4(0.8f, 0, 0.6f, 0)) < 1e-6f);
  for (std::size_t k = 0; k < 3; ++k)
    for (std::size_t c = 0; c < 3; ++c)
      CHECK(scene.cloud.sh_rest_of(0)[3 * c + k] ==
            doctest::Approx(static_cast<double>(10 * (3 * k + c)) / 127 * 2));
  one.pop_back();
  std::vector<RadProperty> with = one;
  with.push_back({"sh1", "f32", floats({1, 2, 3, 4, 5, 6, 7, 8, 9})});
  write(folder / "a.rad", rad_of(2, {chunk_of(0, 1, with, true), chunk_of(1, 1, one, true)}));
  CHECK(load_scene(folder / "a.rad").cloud.sh_degree == 0);
}

TEST_CASE(
    "rad: of a tree the leaves, or a level of merged Gaussians, and what it has is known from the tree "
    "alone") {
  // 0 has 1 and 2; 1 has 3, 4; 2 is a leaf. Each stands at x = its number.
  const auto tree = [](std::initializer_list<std::uint16_t> counts,
                       std::initializer_list<std::uint32_t> starts) {
    std::vector<RadProperty> all = {{"center", "f32", floats({0, 1, 2, 3, 4, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0})},
                                    {"alpha", "r8", octets({255, 255, 100, 100, 100}), 0, 2},
                                    {"rgb", "r8", std::string(15, '\x7f')},
                                    {"scales", "ln_0r8", std::string(15, '\x7f'), -12, 9},
                                    {"orientation", "oct88r8", std::string(15, '\x7f')},
                                    {"child_count", "u16", all_of<std::uint16_t>(counts)},
                                    {"child_start", "u32", all_of<std::uint32_t>(starts)}};
    return rad_of(5, {chunk_of(0, 5, all, true)});
  };
  const Folder folder;
  write(folder / "a.rad", tree({2, 2, 0, 0, 0}, {1, 3, 0, 0, 0}));
  const auto places = [&](unsigned lod) {
    const Scene scene = load_scene(folder / "a.rad", {.lod = lod});
    std::vector<float> x;
    for (const glm::vec3& p : scene.cloud.position) x.push_back(p.x);
    std::ranges::sort(x);
    return x;
  };
  CHECK(places(0) == std::vector<float>{2, 3, 4});
  CHECK(places(1) == std::vector<float>{1, 2});
  CHECK(places(2) == std::vector<float>{0});
  CHECK(places(9) == std::vector<float>{0});
  CHECK(levels_of(folder / "a.rad").gaussians == std::vector<std::uint64_t>{3, 2, 1});
  CHECK(mentions(load_scene(folder / "a.rad").left_out, {"3 levels", "level 0 is read"}));
  const Scene coarse = load_scene(folder / "a.rad", {.lod = 2});
  CHECK(coarse.cloud.opacity[0] == 1);
  CHECK(mentions(coarse.left_out, {"above 1"}));
  write(folder / "b.rad", tree({2, 0, 0, 0, 0}, {1, 0, 0, 0, 0}));
  CHECK(mentions(load_scene(folder / "b.rad").left_out,
                 {"2 Gaussians that its tree does not reach are left out"}));
  CHECK(mentions(refused(folder, tree({2, 2, 0, 0, 0}, {1, 2, 0, 0, 0})), {"reached twice"}));
  CHECK(mentions(refused(folder, tree({2, 1, 0, 0, 0}, {1, 0, 0, 0, 0})), {"reached twice"}));
  CHECK(mentions(refused(folder, tree({2, 9, 0, 0, 0}, {1, 3, 0, 0, 0})), {"9 children from 3"}));
  CHECK(mentions(refused(folder, tree({2, 1, 0, 0, 0}, {1, 4294967295u, 0, 0, 0})), {"1 children"}));
}

QUICK_CASE("rad", "rad: damaged files are refused, each with what is wrong") {
  const Folder folder;
  const std::string good = chunk_of(0, 2, two(), true), whole = rad_of(2, {good});
  for (std::size_t size = 8; size < whole.size(); size += 13)
    CHECK_FALSE(refused(folder, whole.substr(0, size)).empty());
  CHECK(mentions(refused(folder, rad_of(3, {good})), {"hold 2 Gaussians, not 3"}));
  CHECK(mentions(refused(folder, rad_of(0, {})), {"promises 0"}));
  CHECK(mentions(refused(folder, rad_of(4, {good, good})), {"does not hold the Gaussians from 2 on"}));
  CHECK(mentions(refused(folder, rad_of(2, {chunk_of(0, 1u << 30, two(), true)})), {"does not hold"}));
  CHECK(mentions(refused(folder, rad_of(1u << 30, {chunk_of(0, 1u << 30, two(), true)})),
                 {"no scene packs so well"}));
  std::vector<RadProperty> nowhere = two();
  nowhere.erase(nowhere.begin());
  CHECK(mentions(refused(folder, rad_of(2, {chunk_of(0, 2, nowhere, true)})), {"no property \"center\""}));
  CHECK(mentions(refused(folder, rad_of(2, {chunk_of(0, 2, two("", "f32"), false)})), {"0 of 24 bytes"}));
  CHECK(mentions(refused(folder, rad_of(2, {chunk_of(0, 2, two(floats({1}), "f32"), true)})), {"truncated"}));
  CHECK(mentions(refused(folder, rad_of(2, {chunk_of(0, 2, two(floats({1}), "s8"), true)})),
                 {"encoding", "s8", "center"}));
  std::vector<RadProperty> tree = two();
  tree.push_back({"child_count", "f32", std::string(8, '\0')});
  CHECK(mentions(refused(folder, rad_of(2, {chunk_of(0, 2, tree, true)})), {"f32", "child_count"}));
  std::vector<RadProperty> shared = two();
  shared.push_back({"sh_label", "u16", std::string(4, '\0')});
  CHECK(mentions(refused(folder, rad_of(2, {chunk_of(0, 2, shared, true)})), {"shared", "not read"}));
  std::string other = whole;
  other.replace(other.find("gsplat"), 6, "dsplat");
  CHECK(mentions(refused(folder, other), {"gsplat"}));
  std::string away = rad_of(2, {good}, &folder);
  away.replace(away.find("0.radc"), 6, "../rad");
  CHECK(mentions(refused(folder, away), {"not in its folder"}));
  write(folder / "a.radc", good);
  CHECK(mentions(refusal(folder / "a.radc"), {"piece of a scene of Spark"}));
}

TEST_CASE("rad: a file that many chunks name counts once for what it may unpack to") {
  const Folder folder;
  constexpr std::size_t kMany = 600'000, kSmall = 8;
  const auto zeros = [](std::size_t count) {
    std::vector<RadProperty> all;
    for (const auto& [name, numbers] :
         {std::pair{"center", 3}, {"alpha", 1}, {"rgb", 3}, {"scales", 3}, {"orientation", 3}})
      all.push_back({name, "f32", std::string(4 * static_cast<std::size_t>(numbers) * count, '\0')});
    return all;
  };
  std::string all;
  json list = json::array();
  for (std::size_t i = 0; i <= kSmall; ++i) {
    const std::size_t count = i < kSmall ? 1 : kMany;
    const std::string chunk = chunk_of(i, count, zeros(count), true);
    list.push_back({{"offset", all.size()}, {"bytes", chunk.size()}, {"filename", "all.radc"}});
    all += chunk;
  }
  write(folder / "all.radc", all);
  CHECK(mentions(
      refused(folder,
              with_text("RAD0",
                        {{"version", 1}, {"type", "gsplat"}, {"count", kMany + kSmall}, {"chunks", list}})),
      {"no scene packs so well"}));
}
