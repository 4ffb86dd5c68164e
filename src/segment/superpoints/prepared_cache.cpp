#include "segment/superpoints/prepared_cache.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "core/atomic_file.h"
#include "core/byte_hash.h"
#include "core/error.h"
#include "core/mapped_file.h"
#include "core/parallel.h"

namespace splatcut {

namespace {

constexpr std::uint32_t kFormatVersion = 7;
constexpr std::uint64_t kMagic =
    0x50455250544c5053;  // "SPLTPREP", read backwards on a machine of the other byte order
constexpr const char* kEnding = ".prepared";

struct Header {
  std::uint64_t magic = kMagic, version = kFormatVersion;
  std::uint64_t key = 0;
  std::uint64_t payload_bytes = 0, checksum = 0;
};
static_assert(sizeof(Header) == 40);

// Every array of a prepared scene, in the order of the file. Scene may be const.
template <class Scene, class Visit>
void visit_arrays(Scene& scene, const Visit& visit) {
  visit(scene.parts.leaf_of);
  visit(scene.parts.leaf_centre_world);
  visit(scene.parts.leaf_area);
  for (auto& tree : scene.parts.trees) {
    visit(tree.parent);
    visit(tree.children);
    visit(tree.area);
    visit(tree.cut);
    visit(tree.merge_cost);
    visit(tree.looks);
  }
}

// What the payload starts with: three numbers and the size of each array.
std::vector<std::uint64_t> sizes_of(const PreparedScene& scene) {
  std::vector<std::uint64_t> sizes = {scene.parts.leaves, scene.parts.trees.size(), scene.parts.plain_trees};
  visit_arrays(scene, [&](const auto& array) { sizes.push_back(array.size()); });
  return sizes;
}

std::uint64_t checksum_of(const PreparedScene& scene, std::span<const std::uint64_t> sizes) {
  Hasher hash(kFormatVersion);
  hash.add(sizes);
  visit_arrays(scene, [&](const auto& array) { hash.add(std::as_bytes(std::span(array))); });
  return hash.value();
}

std::uint64_t payload_bytes(const PreparedScene& scene, std::span<const std::uint64_t> sizes) {
  std::uint64_t bytes = sizes.size_bytes();
  visit_arrays(scene, [&](const auto& array) { bytes += std::span(array).size_bytes(); });
  return bytes;
}

class Reader {
 public:
  // A pipe is not opened: that would block.
  explicit Reader(const std::filesystem::path& path) : file_(nullptr, &std::fclose) {
    std::error_code failure;
    if (std::filesystem::is_regular_file(path, failure)) file_.reset(std::fopen(path.c_str(), "rb"));
    left_ = file_ ? std::filesystem::file_size(path, failure) : 0;
    if (failure) left_ = 0;
  }
  std::uint64_t left() const { return left_; }

  // False, and nothing taken from memory, where the file is shorter.
  template <class T>
  bool read(std::uint64_t count, std::vector<T>* values) {
    if (count > left_ / sizeof(T)) return false;
    values->resize(count);
    left_ -= count * sizeof(T);
    return count == 0 || std::fread(values->data(), sizeof(T), count, file_.get()) == count;
  }

 private:
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> file_;
  std::uint64_t left_ = 0;
};

// Whether body(i) holds for all i.
template <class Body>
bool all_of_range(std::size_t n, const Body& body) {
  std::atomic<bool> all = true;
  for_chunks(n, [&](std::size_t from, std::size_t to) {
    bool good = true;
    for (std::size_t i = from; i < to; ++i) good &= body(i);
    if (!good) all = false;
  });
  return all;
}

bool sound(const PartTree& t, std::uint32_t leaves) {
  const std::size_t n = t.nodes();
  if (n < leaves || t.children.size() != n || t.area.size() != n || t.cut.size() != n ||
      t.merge_cost.size() != n || (!t.looks.empty() && t.looks.size() != n))
    return false;
  return all_of_range(n, [&](std::size_t i) {
    const auto below = [&](std::uint32_t child) { return child == kNoPart || child < i; };
    return (t.parent[i] == kNoPart || (t.parent[i] > i && t.parent[i] < n)) && below(t.children[i][0]) &&
           below(t.children[i][1]);
  });
}

// No index of the scene leads outside of it: what is read may be used without looking again.
bool sound(const PreparedScene& scene, std::size_t gaussians) {
  const PartHierarchy& parts = scene.parts;
  if (!parts.leaf_of.empty() && parts.leaf_of.size() != gaussians) return false;
  if (parts.plain_trees > parts.trees.size() || parts.leaf_centre_world.size() != parts.leaves ||
      parts.leaf_area.size() != parts.leaves)
    return false;
  return all_of_range(
             parts.leaf_of.size(),
             [&](std::size_t g) { return parts.leaf_of[g] == kNoPart || parts.leaf_of[g] < parts.leaves; }) &&
         std::ranges::all_of(parts.trees, [&](const PartTree& t) { return sound(t, parts.leaves); });
}

void add_camera(const Camera& c, Hasher* hash) {
  hash->number(c.width_px);
  hash->number(c.height_px);
  for (const float f : {c.fx_px, c.fy_px, c.cx_px, c.cy_px}) hash->number(f);
  hash->add(std::span(&c.camera_from_world_rotation[0][0], 9));
  hash->add(std::span(&c.camera_from_world_translation.x, 3));
}

void add_options(const PrepareOptions& o, Hasher* hash) {
  for (const double value :
       {static_cast<double>(o.observing.width_px), static_cast<double>(o.observing.most_given),
        static_cast<double>(o.observing.ring), static_cast<double>(o.observing.elevation_swing_rad)})
    hash->number(value);
  for (const PartWeight& weight : part_weights())
    if (weight.prepared) hash->number(weight.get(o.model));
}

struct KeptFile {
  std::filesystem::file_time_type used;
  std::uintmax_t bytes;  // 0 once it is removed
  std::filesystem::path path;
};

// What is prepared of any scene, the files used longest ago first. Removes what interrupted writers left.
std::vector<KeptFile> kept_files(const std::filesystem::path& folder) {
  std::vector<KeptFile> files;
  std::error_code failure;
  for (const auto& entry : std::filesystem::directory_iterator(folder, failure)) {
    const bool interrupted =
        entry.path().extension() == ".part" && entry.path().string().find(kEnding) != std::string::npos;
    if (!entry.is_regular_file(failure) || (!interrupted && entry.path().extension() != kEnding)) continue;
    const auto used = entry.last_write_time(failure);
    constexpr std::chrono::hours kLongestWrite(1);
    if (failure) continue;
    if (!interrupted)
      files.push_back({used, entry.file_size(failure), entry.path()});
    else if (std::filesystem::file_time_type::clock::now() - used > kLongestWrite)
      std::filesystem::remove(entry.path(), failure);
  }
  std::ranges::sort(files, {}, &KeptFile::used);
  return files;
}

// Until they and what stays beside them take no more.
void remove_oldest(std::span<KeptFile> files, std::uintmax_t most_bytes, std::uintmax_t beside) {
  std::uintmax_t sum = beside;
  for (const KeptFile& file : files) sum += file.bytes;
  std::error_code failure;
  for (KeptFile& file : files) {
    if (sum <= most_bytes) return;
    if (!std::filesystem::remove(file.path, failure)) continue;
    sum -= std::exchange(file.bytes, 0);
  }
}

}  // namespace

std::uint64_t prepared_key(const GaussianCloud& cloud, std::span<const Camera> observing,
                           const PrepareOptions& options) {
  Hasher hash(kFormatVersion);
  hash.number(hash_of_program());
  hash.number(cloud.size());
  hash.number(cloud.near_plane);  // what the observing views show
  if (cloud.antialiased) hash.number(1);
  hash.add(std::as_bytes(std::span(cloud.position)));
  hash.add(std::as_bytes(std::span(cloud.scale)));
  hash.add(std::as_bytes(std::span(cloud.rotation)));
  hash.add(std::as_bytes(std::span(cloud.opacity)));
  hash.add(std::as_bytes(std::span(cloud.f_dc)));
  // Not the other harmonics: what is prepared is drawn without colour.
  add_options(options, &hash);
  hash.number(observing.size());
  for (const Camera& camera : observing) add_camera(camera, &hash);
  return hash.value();
}

std::filesystem::path prepared_file(const PreparedCache& cache, std::uint64_t key) {
  return cache.folder / fmt::format("{:016x}-{:016x}{}", cache.scene, key, kEnding);
}

std::optional<PreparedScene> read_prepared(const std::filesystem::path& path, std::uint64_t key,
                                           std::size_t gaussians) {
  Reader file(path);
  std::vector<Header> header;
  std::vector<std::uint64_t> counts, sizes;
  if (!file.read(1, &header)) return {};
  const Header& h = header.front();
  if (h.magic != kMagic || h.version != kFormatVersion || h.key != key || h.payload_bytes != file.left())
    return {};
  constexpr std::uint64_t kCounts = 3, kMostTrees = 1000;
  if (!file.read(kCounts, &counts) || counts[1] > kMostTrees) return {};
  PreparedScene scene;
  scene.parts.leaves = static_cast<std::uint32_t>(counts[0]);
  scene.parts.trees.resize(counts[1]);
  scene.parts.plain_trees = counts[2];
  std::size_t arrays = 0;
  visit_arrays(scene, [&](const auto&) { ++arrays; });
  if (!file.read(arrays, &sizes)) return {};
  bool whole = true;
  std::size_t next = 0;
  visit_arrays(scene, [&](auto& array) { whole = whole && file.read(sizes[next++], &array); });
  counts.insert(counts.end(), sizes.begin(), sizes.end());
  if (!whole || file.left() != 0 || checksum_of(scene, counts) != h.checksum || !sound(scene, gaussians))
    return {};
  return scene;
}

void write_prepared(const std::filesystem::path& path, std::uint64_t key, const PreparedScene& scene) {
  const std::vector<std::uint64_t> sizes = sizes_of(scene);
  Header header;
  header.key = key;
  header.payload_bytes = payload_bytes(scene, sizes);
  header.checksum = checksum_of(scene, sizes);
  AtomicFile file(path);
  file.write(std::as_bytes(std::span(&header, 1)));
  file.write(std::as_bytes(std::span(sizes)));
  visit_arrays(scene, [&](const auto& array) { file.write(std::as_bytes(std::span(array))); });
  file.commit();
}

void trim_cache(const PreparedCache& cache) {
  std::vector<KeptFile> files = kept_files(cache.folder);
  const std::string of_scene = fmt::format("{:016x}-", cache.scene);
  const auto others = std::stable_partition(files.begin(), files.end(), [&](const KeptFile& file) {
    return file.path.filename().string().starts_with(of_scene);
  });
  const std::span<KeptFile> own(files.begin(), others);
  if (!own.empty()) remove_oldest(own.first(own.size() - 1), cache.most_bytes_of_scene, own.back().bytes);
  std::erase_if(files, [](const KeptFile& file) { return file.bytes == 0; });
  std::ranges::stable_sort(files, {}, &KeptFile::used);
  remove_oldest(files, cache.most_bytes, 0);
}

}  // namespace splatcut
