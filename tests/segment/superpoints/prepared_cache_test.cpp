// The cache of prepared scenes: what is read is what was written, and nothing else is taken for it.
#include "segment/superpoints/prepared_cache.h"

#include <doctest/doctest.h>
#include <unistd.h>

#include <cstring>
#include <fstream>
#include <glm/gtc/quaternion.hpp>
#include <random>
#include <set>

#include "core/byte_hash.h"
#include "quick.h"
#include "synthetic_cloud.h"

using namespace splatcut;
using namespace splatcut::testing;

namespace {

struct CacheFolder {
  std::filesystem::path path =
      std::filesystem::temp_directory_path() / ("splatcut_cache_test_" + std::to_string(::getpid()));
  CacheFolder() { std::filesystem::create_directories(path); }
  ~CacheFolder() { std::filesystem::remove_all(path); }
};

bool same(const PreparedScene& a, const PreparedScene& b) {
  if (a.parts.leaves != b.parts.leaves || a.parts.leaf_of != b.parts.leaf_of ||
      a.parts.trees.size() != b.parts.trees.size())
    return false;
  for (std::size_t t = 0; t < a.parts.trees.size(); ++t) {
    const PartTree &x = a.parts.trees[t], &y = b.parts.trees[t];
    if (x.parent != y.parent || x.children != y.children || x.area != y.area || x.cut != y.cut ||
        x.merge_cost != y.merge_cost || x.looks != y.looks || x.looks.size() != x.nodes())
      return false;
  }
  return true;
}

std::string bytes_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

void write_bytes(const std::filesystem::path& file, const std::string& bytes) {
  std::ofstream(file, std::ios::binary) << bytes;
}

struct Example {
  GaussianCloud cloud = random_cloud(2000, 4);
  Camera reference = front_camera();
  PreparedScene prepared = prepare_scene(cloud, observing_views(cloud, reference, {0, -1, 0}, {}));
  std::uint64_t key = prepared_key(cloud, observing_views(cloud, reference, {0, -1, 0}, {}), {});
};

}  // namespace

TEST_CASE("what was written is read again, every array of it") {
  const CacheFolder folder;
  const Example e;
  REQUIRE(e.prepared.parts.trees.size() == 8);
  const auto file = prepared_file({.folder = folder.path}, e.key);
  write_prepared(file, e.key, e.prepared);
  const auto again = read_prepared(file, e.key, e.cloud.size());
  REQUIRE(again);
  CHECK(same(*again, e.prepared));
  CHECK_FALSE(read_prepared(file, e.key + 1, e.cloud.size()));
  CHECK_FALSE(read_prepared(file, e.key, e.cloud.size() + 1));
  CHECK_FALSE(read_prepared(folder.path / "missing", e.key, e.cloud.size()));
  CHECK_FALSE(read_prepared(folder.path, e.key, e.cloud.size()));
}

QUICK_CASE("prepared cache",
           "a file cut short, with a byte changed anywhere, or with bytes to spare is as good as none") {
  const CacheFolder folder;
  const Example e;
  const auto file = prepared_file({.folder = folder.path}, e.key);
  write_prepared(file, e.key, e.prepared);
  const std::string whole = bytes_of(file);
  std::mt19937 random(7);
  for (const std::size_t size : {std::size_t{0}, std::size_t{7}, std::size_t{40}, std::size_t{200},
                                 whole.size() / 2, whole.size() - 1}) {
    CAPTURE(size);
    write_bytes(file, whole.substr(0, size));
    CHECK_FALSE(read_prepared(file, e.key, e.cloud.size()));
  }
  write_bytes(file, whole + "x");
  CHECK_FALSE(read_prepared(file, e.key, e.cloud.size()));
  for (int trial = 0; trial < 300; ++trial) {
    const std::size_t at = trial < 150 ? static_cast<std::size_t>(trial) : random() % whole.size();
    CAPTURE(at);
    std::string damaged = whole;
    damaged[at] = static_cast<char>(damaged[at] ^ (1 << random() % 8));
    write_bytes(file, damaged);
    CHECK_FALSE(read_prepared(file, e.key, e.cloud.size()));
  }
  write_bytes(file, whole);
  CHECK(read_prepared(file, e.key, e.cloud.size()));
}

QUICK_CASE("prepared cache", "indices that lead outside are refused even with a right checksum") {
  const CacheFolder folder;
  const Example e;
  const auto file = prepared_file({.folder = folder.path}, e.key);
  const auto refused = [&](const auto& damage) {
    PreparedScene wrong = e.prepared;
    damage(wrong);
    write_prepared(file, e.key, wrong);
    return !read_prepared(file, e.key, e.cloud.size());
  };
  CHECK_FALSE(refused([](PreparedScene&) {}));
  CHECK(refused([](PreparedScene& s) { s.parts.leaf_of[0] = s.parts.leaves; }));
  CHECK(refused([](PreparedScene& s) { s.parts.trees[1].parent[0] = 0; }));
  CHECK(refused([](PreparedScene& s) {
    s.parts.trees[1].children.back()[0] = static_cast<std::uint32_t>(s.parts.trees[1].nodes());
  }));
  CHECK(refused([](PreparedScene& s) { s.parts.trees[4].area.pop_back(); }));
  CHECK(refused([](PreparedScene& s) { s.parts.trees[2].looks.pop_back(); }));
}

TEST_CASE("the key changes with all that the preparation depends on") {
  Example e;
  const auto key = [&](const GaussianCloud& cloud, const Camera& camera, std::span<const Camera> given,
                       const PrepareOptions& options) {
    return prepared_key(cloud, observing_views(cloud, camera, {0, -1, 0}, given), options);
  };
  CHECK(key(e.cloud, e.reference, {}, {}) == e.key);
  GaussianCloud cloud = e.cloud;
  cloud.position[1999].z = std::nextafter(cloud.position[1999].z, 9.0f);
  CHECK(key(cloud, e.reference, {}, {}) != e.key);
  cloud = e.cloud;
  cloud.f_dc[3].y += 1;
  CHECK(key(cloud, e.reference, {}, {}) != e.key);
  cloud = e.cloud;
  cloud.near_plane *= 2;
  CHECK(key(cloud, e.reference, {}, {}) != e.key);
  Camera camera = e.reference;
  camera.fx_px += 1;
  CHECK(key(e.cloud, camera, {}, {}) != e.key);
  CHECK(key(e.cloud, e.reference, std::vector{camera}, {}) != e.key);
  PrepareOptions options;
  options.observing.width_px = 80;
  CHECK(key(e.cloud, e.reference, {}, options) != e.key);
  options = {};
  options.model.parts.merging.gap += 0.1f;
  CHECK(key(e.cloud, e.reference, {}, options) != e.key);
}

QUICK_CASE("prepared cache",
           "prepare_scene fills the cache and reads from it, a cancelled run leaves nothing") {
  const CacheFolder folder;
  const Example e;
  PrepareOptions options;
  options.cache.folder = folder.path / "made" / "here";
  std::stop_source stop;
  stop.request_stop();
  Job cancelled;
  cancelled.stop = stop.get_token();
  prepare_scene(e.cloud, observing_views(e.cloud, e.reference, {0, -1, 0}, {}), options, cancelled);
  CHECK_FALSE(std::filesystem::exists(options.cache.folder));
  CHECK_FALSE(
      prepare_scene(e.cloud, observing_views(e.cloud, e.reference, {0, -1, 0}, {}), options).from_cache);
  const PreparedScene again =
      prepare_scene(e.cloud, observing_views(e.cloud, e.reference, {0, -1, 0}, {}), options);
  CHECK(again.from_cache);
  CHECK(same(again, e.prepared));
}

TEST_CASE("a full cache loses what was used longest ago, and what is not its own stays") {
  const CacheFolder folder;
  const auto now = std::filesystem::file_time_type::clock::now();
  const auto put = [&](const std::string& name, std::size_t bytes, int hours_ago) {
    write_bytes(folder.path / name, std::string(bytes, 'x'));
    std::filesystem::last_write_time(folder.path / name, now - std::chrono::hours(hours_ago));
  };
  put("a.prepared", 400, 30);
  put("b.prepared", 400, 10);
  put("c.prepared", 400, 20);
  put("notes.txt", 4000, 99);
  put("d.prepared.77.part", 400, 2);
  put("e.prepared.78.part", 400, 0);
  trim_cache({.folder = folder.path, .most_bytes = 800});
  const auto there = [&](const char* name) { return std::filesystem::exists(folder.path / name); };
  CHECK_FALSE(there("a.prepared"));
  CHECK(there("b.prepared"));
  CHECK(there("c.prepared"));
  CHECK(there("notes.txt"));
  CHECK_FALSE(there("d.prepared.77.part"));
  CHECK(there("e.prepared.78.part"));
  trim_cache({.folder = folder.path, .most_bytes = 799});
  CHECK(there("b.prepared"));
  CHECK_FALSE(there("c.prepared"));
  trim_cache({.folder = folder.path / "missing", .most_bytes = 0});
}

TEST_CASE("a scene that fills its part of the cache loses its own files first, but for the last one") {
  const CacheFolder folder;
  const auto now = std::filesystem::file_time_type::clock::now();
  const auto file = [&](std::uint64_t scene, std::uint64_t key) {
    return prepared_file({.folder = folder.path, .scene = scene}, key);
  };
  const auto put = [&](std::uint64_t scene, std::uint64_t key, std::size_t bytes, int hours_ago) {
    write_bytes(file(scene, key), std::string(bytes, 'x'));
    std::filesystem::last_write_time(file(scene, key), now - std::chrono::hours(hours_ago));
  };
  put(1, 1, 300, 90);  // of another scene, used longest ago of all
  for (int i = 0; i < 5; ++i) put(2, static_cast<std::uint64_t>(i), 100, 50 - i);
  const auto left = [&](std::uint64_t scene) {
    std::set<std::uint64_t> keys;
    for (std::uint64_t key = 0; key < 5; ++key)
      if (std::filesystem::exists(file(scene, key))) keys.insert(key);
    return keys;
  };
  PreparedCache cache{.folder = folder.path, .most_bytes = 1000, .most_bytes_of_scene = 250, .scene = 2};
  trim_cache(cache);
  CHECK(left(2) == std::set<std::uint64_t>{3, 4});
  CHECK(left(1) == std::set<std::uint64_t>{1});
  cache.most_bytes_of_scene = 50;  // less than the last file alone
  trim_cache(cache);
  CHECK(left(2) == std::set<std::uint64_t>{4});
  CHECK(left(1) == std::set<std::uint64_t>{1});
  cache.most_bytes = 100;
  trim_cache(cache);
  CHECK(left(2) == std::set<std::uint64_t>{4});
  CHECK(left(1).empty());
}

TEST_CASE("hash: that of XXH3, in which every bit and the length count") {
  CHECK(hash_bytes({}) == 0x2d06800538d394c2);  // of its own tests
  std::vector<std::byte> bytes(3'000'001, std::byte{7});
  const std::uint64_t whole = hash_bytes(bytes);
  for (const std::size_t at : {std::size_t{0}, std::size_t{31}, std::size_t{1048576}, bytes.size() - 1})
    for (int bit = 0; bit < 8; ++bit) {
      bytes[at] ^= std::byte{1} << bit;
      CHECK(hash_bytes(bytes) != whole);
      bytes[at] ^= std::byte{1} << bit;
    }
  CHECK(hash_bytes(bytes) == whole);
  CHECK(hash_bytes(bytes, 1) != whole);
  CHECK(hash_bytes(std::span(bytes).first(3'000'000)) != whole);
  std::set<std::uint64_t> of_zeros;
  for (std::size_t n = 0; n < 200; ++n) of_zeros.insert(hash_bytes(std::vector<std::byte>(n)));
  CHECK(of_zeros.size() == 200);
}
