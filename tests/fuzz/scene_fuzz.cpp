// Readers of the layer `scene`: scenes, cameras, pictures.
#include "core/picture_file.h"
#include "core/png_file.h"
#include "fuzz.h"
#include "scene/camera/camera_file.h"
#include "scene/formats/scene_file.h"
#include "scene/packing/webp.h"

namespace splatcut {

namespace {

namespace fs = std::filesystem;

// The first two bytes say where the second file begins.
std::pair<std::string_view, std::string_view> two_files(std::string_view bytes) {
  if (bytes.size() < 2) return {};
  const std::size_t first = static_cast<std::uint8_t>(bytes[0]) + 256u * static_cast<std::uint8_t>(bytes[1]);
  const std::string_view rest = bytes.substr(2);
  return {rest.substr(0, first), rest.substr(std::min(first, rest.size()))};
}

// What can be read can be written again in any format, or is refused.
void load_and_save(const fs::path& file) {
  const Scene scene = load_scene(file);
  for (const SceneFormat& format : written_formats())
    save_scene(place().folder() / "saved", scene, {}, format);
}

// Of a .sog: small numbers of entries, and 255 for a rotation whose last component is the largest.
void write_picture(const char* name, int width) {
  Image<Rgba8> picture(width, 1);
  for (int x = 0; x < width; ++x) picture.at(x, 0) = {static_cast<std::uint8_t>(x % 64), 0, 0, 255};
  const std::vector<std::byte> bytes = write_webp(picture);
  place().write(name, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

[[maybe_unused]] void fuzz_ply(std::string_view bytes) {
  load_and_save(place().write("a.ply", bytes));
}

[[maybe_unused]] void fuzz_splat(std::string_view bytes) {
  load_and_save(place().write("a.splat", bytes));
}

[[maybe_unused]] void fuzz_spz(std::string_view bytes) {
  load_and_save(place().write("a.spz", bytes));
}

[[maybe_unused]] void fuzz_sog(std::string_view bytes) {
  load_and_save(place().write("a.sog", bytes));
}

// The text of a .sog in a folder, with pictures that it can name: in a ZIP a checksum guards it.
[[maybe_unused]] void fuzz_sog_text(std::string_view bytes) {
  static const bool beside = [] {
    write_picture("p.webp", 4);
    write_picture("c.webp", 192);  // spherical harmonics of degree 1
    return true;
  }();
  if (beside) load_and_save(place().write("meta.json", bytes));
}

// Gaussians in a row.
[[maybe_unused]] void write_piece(const char* name, std::size_t gaussians, int degree,
                                  const SceneFormat& format) {
  Scene scene;
  scene.cloud.resize(gaussians, degree);
  for (std::size_t g = 0; g < gaussians; ++g) {
    scene.cloud.position[g] = glm::vec3(static_cast<float>(g));
    scene.cloud.scale[g] = glm::vec3(0.1f);
    scene.cloud.rotation[g] = glm::quat(1, 0, 0, 0);
    scene.cloud.opacity[g] = 0.5f;
    scene.cloud.file_row[g] = static_cast<std::uint32_t>(g);
  }
  save_scene(place().folder() / name, scene, {}, format);
}

// The index of a streamed scene, with pieces that it can name.
[[maybe_unused]] void fuzz_streamed_sog_text(std::string_view bytes) {
  static const bool beside = [] {
    write_piece("a.sog", 8, 1, SceneFormat::kSog);
    write_piece("b.sog", 5, 0, SceneFormat::kSog);
    return true;
  }();
  if (beside) load_and_save(place().write("lod-meta.json", bytes));
}

[[maybe_unused]] void fuzz_glb(std::string_view bytes) {
  load_and_save(place().write("a.glb", bytes));
}

// The text alone: in a .glb its length is counted.
[[maybe_unused]] void fuzz_gltf(std::string_view bytes) {
  static const fs::path beside = place().write("a.bin", std::string(168, '\x3f'));
  load_and_save(place().write("a.gltf", bytes));
}

[[maybe_unused]] void fuzz_ksplat(std::string_view bytes) {
  load_and_save(place().write("a.ksplat", bytes));
}

// The text up to a zero byte, then index.bin, beside files of four Gaussians and one around them.
[[maybe_unused]] void fuzz_lcc(std::string_view bytes) {
  static const bool beside = [] {
    place().write("data.bin", std::string(128, '\x3f'));
    place().write("shcoef.bin", std::string(256, '\x3f'));
    place().write("environment.bin", std::string(96, '\x3f'));
    return true;
  }();
  const std::size_t end = std::min(bytes.find('\0'), bytes.size());
  place().write("index.bin", bytes.substr(std::min(end + 1, bytes.size())));
  if (beside) load_and_save(place().write("a.lcc", bytes.substr(0, end)));
}

// The text, with pieces that it can name.
[[maybe_unused]] void fuzz_lcc2(std::string_view bytes) {
  static const bool beside = [] {
    write_piece("a.sog", 8, 1, SceneFormat::kSog);
    write_piece("b.sog", 5, 0, SceneFormat::kSog);
    write_piece("c.spz", 6, 2, SceneFormat::kSpz);
    return true;
  }();
  if (beside) load_and_save(place().write("a.lcc2", bytes));
}

// Not packed: in what deflate packs hardly a bit can be changed.
[[maybe_unused]] void fuzz_rad(std::string_view bytes) {
  load_and_save(place().write("a.rad", bytes));
}

[[maybe_unused]] void fuzz_json_cameras(std::string_view bytes) {
  std::string warning;
  load_cameras(place().write("a.json", bytes), &warning);
}

[[maybe_unused]] void fuzz_colmap(std::string_view bytes, const char* cameras, const char* images) {
  const auto [first, second] = two_files(bytes);
  place().write(images, second);
  std::string warning;
  load_cameras(place().write(cameras, first), &warning);
}

[[maybe_unused]] void fuzz_colmap_bin(std::string_view bytes) {
  fuzz_colmap(bytes, "cameras.bin", "images.bin");
}

[[maybe_unused]] void fuzz_colmap_txt(std::string_view bytes) {
  fs::remove(place().folder() / "cameras.bin");  // which would be read first
  fuzz_colmap(bytes, "cameras.txt", "images.txt");
}

[[maybe_unused]] void fuzz_png(std::string_view bytes) {
  const fs::path file = place().write("a.png", bytes);
  read_png_rgb(file);
  read_png_grey(file);
}

[[maybe_unused]] void fuzz_picture(std::string_view bytes) {
  const fs::path file = place().write("a", bytes);
  picture_size(file);
  read_picture(file);
}

}  // namespace

}  // namespace splatcut

SPLATCUT_FUZZ_ENTRY
