// What readers take of memory, in bytes for each byte of the file, beyond what the program takes for a scene
// of one Gaussian: of files as they are written, and of files that promise as much as they can.
// SPLATCUT_MEMORY=300000 makes them of so many Gaussians and prints the table of docs/reliability.md.
#include <fmt/format.h>

#include <cstdlib>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>

#include "core/image.h"
#include "core/png_file.h"
#include "program_runner.h"
#include "scene/packing/webp.h"
#include "scene/packing/zip_file.h"
#include "scene_file_helpers.h"

using namespace splatcut;
using namespace splatcut::testing;

namespace {

constexpr double kMb = 1 << 20;

// What unpacks to no more than this is read, however small its file (scene/formats/decode.h).
constexpr double kAlwaysMb = 16, kMostFold = 256, kMostCloudFold = 6;

struct Measured {
  double file_mb = 0, peak_mb = 0;
  Result result;
  double factor() const { return peak_mb / file_mb; }
};

// Files are made in processes of their own: a program starts with the largest memory of who starts it.
template <class Make>
void apart(const Make& make) {
  const pid_t child = ::fork();
  REQUIRE(child >= 0);
  if (child == 0) {
    make();
    ::_exit(0);
  }
  int status = 0;
  REQUIRE(::waitpid(child, &status, 0) == child);
  REQUIRE(status == 0);
}

class Meter {
 public:
  Meter() {
    save(1, 0, SceneFormat::kPly, "base.ply");
    base_mb_ = place.run("info base.ply --quiet").peak_mb;
    if (printed()) fmt::print("| file | holds | MB | taken, MB | factor |\n|---|---|---|---|---|\n");
  }
  static bool printed() { return std::getenv("SPLATCUT_MEMORY") != nullptr; }
  static std::size_t gaussians() {
    const char* asked = std::getenv("SPLATCUT_MEMORY");
    return asked ? std::stoul(asked) : 30'000;
  }

  void save(std::size_t count, int degree, const SceneFormat& format, const std::string& name,
            const SaveOptions& options = {}) const {
    apart([&] {
      Scene scene;
      scene.cloud = varied_cloud(count, degree);
      save_scene(place / name, scene, {}, format, options);
    });
  }
  // command: what reads the file; empty for info.
  Measured measure(const std::string& file, const std::string& holds, const std::string& command = {}) const {
    Measured out;
    out.result = place.run((command.empty() ? "info " + file : command) + " --quiet");
    CAPTURE(file);
    CAPTURE(out.result.err);
    CHECK(out.result.signal == 0);
    CHECK((out.result.code == 0 || out.result.code == 1));
    out.file_mb = static_cast<double>(fs::file_size(place / file)) / kMb;
    out.peak_mb = std::max(0.0, out.result.peak_mb - base_mb_);
    if (printed())
      fmt::print("| {} | {}{} | {:.3g} | {:.0f} | {:.2g} |\n", file, holds,
                 out.result.code == 0 ? "" : ": refused", out.file_mb, out.peak_mb, out.factor());
    return out;
  }

  Workplace place;

 private:
  double base_mb_ = 0;
};

std::string text_rows(const GaussianCloud& cloud) {
  std::string text = "ply\nformat ascii 1.0\nelement vertex " + std::to_string(cloud.size()) + "\n";
  for (const std::string& name : splat_names(0)) text += "property float " + name + "\n";
  text += "end_header\n";
  for (std::size_t g = 0; g < cloud.size(); ++g) {
    const glm::vec3 &p = cloud.position[g], &c = cloud.f_dc[g];
    text += fmt::format("{:.3f} {:.3f} {:.3f} 0 0 0 {:.2f} {:.2f} {:.2f} 1 -4 -4 -4 1 0 0 0\n", p.x, p.y, p.z,
                        c.r, c.g, c.b);
  }
  return text;
}

// Bytes that gzip shrinks about 250 fold: noise, then zeros.
std::string nearly_all_zeros(std::size_t size) {
  std::string out(size, '\0');
  std::mt19937 random(3);
  for (std::size_t i = 0; i < size / 310; ++i) out[i] = static_cast<char>(random());
  return out;
}

std::string spz_3(std::uint32_t points, const std::function<std::string(std::size_t)>& content) {
  constexpr std::size_t kPointBytes = 9 + 1 + 3 + 3 + 4;
  return gzip("NGSP" + bytes_of(3u) + bytes_of(points) + std::string("\x00\x0c\x00\x00", 4) +
              content(kPointBytes * points));
}

std::string spz_4_of_zeros(std::uint32_t points) {
  std::string text = "NGSP" + bytes_of(4u) + bytes_of(points) + std::string("\x00\x0c\x00\x05", 4) +
                     bytes_of(32u) + std::string(12, '\0');
  std::string streams;
  for (const std::uint64_t bytes : {9u, 1u, 3u, 3u, 4u}) {
    const std::string packed = zstd(std::string(bytes * points, '\0'));
    text += bytes_of(std::uint64_t{packed.size()}) + bytes_of(bytes * points);
    streams += packed;
  }
  return text + streams;
}

// A .sog of degree 0 whose pictures are of one colour.
void write_flat_sog(const fs::path& path, int side) {
  const std::size_t count = static_cast<std::size_t>(side) * static_cast<std::size_t>(side);
  const std::vector<float> codebook(256, -3.0f);
  const auto files = [](std::initializer_list<const char*> names) {
    return nlohmann::json{{"files", std::vector<std::string>(names.begin(), names.end())}};
  };
  nlohmann::json meta = {{"version", 2},
                         {"count", count},
                         {"means", files({"means_l.webp", "means_u.webp"})},
                         {"scales", files({"scales.webp"})},
                         {"quats", files({"quats.webp"})},
                         {"sh0", files({"sh0.webp"})}};
  meta["means"]["mins"] = {-1, -1, -1};
  meta["means"]["maxs"] = {1, 1, 1};
  meta["scales"]["codebook"] = meta["sh0"]["codebook"] = codebook;
  Image<Rgba8> flat(side, side);
  std::ranges::fill(flat.pixels(), Rgba8{128, 128, 128, 254});
  const std::vector<std::byte> picture = write_webp(flat);
  const std::string text = meta.dump();
  const auto bytes = std::as_bytes(std::span(text));
  std::vector<ZipEntry> entries = {{"meta.json", {bytes.begin(), bytes.end()}}};
  for (const char* name : {"means_l.webp", "means_u.webp", "scales.webp", "quats.webp", "sh0.webp"})
    entries.push_back({name, picture});
  const std::vector<std::byte> archive = zip_of(entries);
  write(path, {reinterpret_cast<const char*>(archive.data()), archive.size()});
}

// The scene of one.glb, shown by many nodes.
void write_repeated_gltf(const Workplace& place, std::size_t nodes) {
  const std::string glb = place.text("one.glb");
  std::uint32_t json_bytes = 0;
  std::memcpy(&json_bytes, glb.data() + 12, sizeof json_bytes);
  nlohmann::json text = nlohmann::json::parse(glb.substr(20, json_bytes));
  const nlohmann::json node = text["nodes"][0];
  text["nodes"] = std::vector<nlohmann::json>(nodes, node);
  std::vector<std::size_t> all(nodes);
  for (std::size_t i = 0; i < nodes; ++i) all[i] = i;
  text["scenes"][0]["nodes"] = all;
  text["buffers"][0]["uri"] = "many.bin";
  place.write("many.bin", glb.substr(20 + json_bytes + 8));
  place.write("many.gltf", text.dump());
}

}  // namespace

TEST_CASE("memory: scene files as they are written") {
  const Meter meter;
  const std::size_t count = Meter::gaussians();
  constexpr double kMostFactor = 20;  // .sog packs best
  for (const int degree : {0, 3}) {
    const std::string holds = fmt::format("{} Gaussians of degree {}", count, degree);
    for (const SceneFormat& format : both_ways()) {
      const std::string name = fmt::format("degree{}{}", degree, format.extension);
      meter.save(count, degree, format, name);
      CHECK(meter.measure(name, holds).factor() < kMostFactor);
    }
    meter.save(count, degree, SceneFormat::kSpz, fmt::format("v4_degree{}.spz", degree), {4});
    CHECK(meter.measure(fmt::format("v4_degree{}.spz", degree), holds + ", version 4").factor() <
          kMostFactor);
  }
  apart([&] { meter.place.write("text.ply", text_rows(varied_cloud(count, 0))); });
  CHECK(meter.measure("text.ply", fmt::format("{} Gaussians as text", count)).factor() < kMostFactor);
}

TEST_CASE("memory: files that promise as much as they can") {
  const Meter meter;
  const auto is_bounded = [](const Measured& m) {
    const double unpacked_mb = std::max(kAlwaysMb, kMostFold * m.file_mb);
    CHECK(m.peak_mb < (1 + kMostCloudFold) * unpacked_mb + m.file_mb);
  };
  const auto is_refused_early = [&](const Measured& m, const char* why) {
    CHECK(m.result.code == 1);
    CHECK(mentions(m.result.err, {why}));
    CHECK(m.peak_mb < m.file_mb + 2 * kAlwaysMb);
  };
  constexpr std::uint32_t kPoints = 10'000'000;
  constexpr const char* kTooMuch = "no scene packs so well";
  const auto zeros = [](std::size_t size) { return std::string(size, '\0'); };
  apart([&] { meter.place.write("zeros.spz", spz_3(kPoints, zeros)); });
  is_refused_early(meter.measure("zeros.spz", "200 MB of zeros, gzip"), kTooMuch);
  apart([&] { meter.place.write("dense.spz", spz_3(3'000'000, nearly_all_zeros)); });
  const Measured dense = meter.measure("dense.spz", "60 MB, gzip 250 fold");
  CHECK(dense.result.code == 0);
  is_bounded(dense);

  apart([&] { meter.place.write("zeros4.spz", spz_4_of_zeros(kPoints)); });
  is_refused_early(meter.measure("zeros4.spz", "200 MB of zeros, zstd"), kTooMuch);

  apart([&] { write_flat_sog(meter.place / "flat.sog", 2000); });
  is_refused_early(meter.measure("flat.sog", "5 pictures of 16 MB of one colour"), kTooMuch);
  apart([&] { write_flat_sog(meter.place / "small.sog", 900); });
  const Measured small = meter.measure("small.sog", "5 pictures of 3.2 MB of one colour");
  CHECK(small.result.code == 0);
  is_bounded(small);

  meter.save(1000, 0, SceneFormat::kGlb, "one.glb");
  apart([&] { write_repeated_gltf(meter.place, 30'000); });
  is_refused_early(meter.measure("many.gltf", "1000 Gaussians shown 30,000 times"), kTooMuch);
}

TEST_CASE("memory: text and pictures that hold as much as they can") {
  const Meter meter;
  constexpr double kMostJsonFactor = 40;
  const auto check_json = [&](const std::string& name, const std::string& one, const std::string& holds) {
    apart([&] {
      constexpr std::size_t kBytes = 2'000'000;
      std::string text = "[" + one;
      while (text.size() < kBytes) text += "," + one;
      meter.place.write(name, text + "]");
    });
    const Measured text =
        meter.measure(name, holds, fmt::format("render base.ply --cameras {} -o x.png", name));
    CHECK(text.result.code == 1);
    CHECK(text.factor() < kMostJsonFactor);
  };
  check_json("numbers.json", "0", "numbers");
  check_json("lists.json", "[]", "empty lists");
  check_json("objects.json", R"({"":0})", "objects");
  check_json("deep.json", std::string(900, '[') + std::string(900, ']'), "lists within lists, 900 deep");
  check_json("endless.json", std::string(2'000'000, '['), "a list within a list, without end");

  // A mask of nothing is such a picture, so it is read: what it takes is known from its sides alone.
  constexpr int kSide = 4096;
  apart([&] { write_png(meter.place / "black.png", Image<std::uint8_t>(kSide, kSide)); });
  const Measured picture =
      meter.measure("black.png", "4096 x 4096 black pixels", "compare black.png black.png");
  CHECK(picture.result.code == 0);
  CHECK(picture.peak_mb < 3 * 3 * kSide * kSide / kMb);
}
