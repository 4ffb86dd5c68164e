// Masks as other tools write them, and the names they give them.
#include "app/console/mask_file.h"

#include <doctest/doctest.h>
#include <zlib.h>

#include <fstream>
#include <string>
#include <vector>

#include "app/console/mask_folder.h"
#include "core/error.h"
#include "core/picture_file.h"
#include "core/png_file.h"
#include "program_runner.h"
#include "scene/camera/camera_names.h"

using namespace splatcut;
using namespace splatcut::testing;

namespace {

namespace fs = std::filesystem;

std::string from_hex(std::string_view hex) {
  std::string bytes;
  for (std::size_t i = 0; i + 1 < hex.size(); i += 2)
    bytes += static_cast<char>(std::stoi(std::string(hex.substr(i, 2)), nullptr, 16));
  return bytes;
}

// 4 x 2 pixels of a palette of black, (128, 0, 0) and (0, 40, 0), indices 0120 / 0011; made with zlib.
const char* const kPalettePng =
    "89504e470d0a1a0a0000000d494844520000000400000002080300000048768d5100000009504c5445000000800000002800"
    "c08e53b20000001049444154789c636060646200024646000023000665c11eb40000000049454e44ae426082";
// A chunk behind the header of a PNG, which says that its numbers are those of a screen.
std::string with_gamma(std::string png) {
  const auto big_endian = [](std::uint32_t value) {
    std::string bytes;
    for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>(value >> shift & 0xff);
    return bytes;
  };
  constexpr std::size_t kHeaderEnd = 8 + 4 + 4 + 13 + 4;
  const std::string chunk = "gAMA" + big_endian(45455);
  const auto sum = static_cast<std::uint32_t>(
      crc32(0, reinterpret_cast<const Bytef*>(chunk.data()), static_cast<uInt>(chunk.size())));
  return png.insert(kHeaderEnd, big_endian(4) + chunk + big_endian(sum));
}

// 16 x 8 pixels, grey, the right half white.
const char* const kJpeg =
    "ffd8ffe000104a46494600010100000100010000ffdb004300080606070605080707070909080a0c140d0c0b0b0c1912130f"
    "141d1a1f1e1d1a1c1c20242e2720222c231c1c2837292c30313434341f27393d38323c2e333432ffc0000b08000800100101"
    "1100ffc40014000100000000000000000000000000000008ffc40014100100000000000000000000000000000000ffda0008"
    "010100003f003f9fefffd9";

// 2 x 2 pixels of four colours, as far as their beginning; the pixels are missing.
const char* const kCmykJpeg =
    "ffd8ffc00014080002000204011100021100031100041100ffda000e0401000200030004000000003f00";

template <class Pixel>
Image<Pixel> image_of(int width, const std::vector<Pixel>& pixels) {
  Image<Pixel> image(width, static_cast<int>(pixels.size()) / width);
  std::ranges::copy(pixels, image.pixels().begin());
  return image;
}

// "#" for the object, row after row.
std::string drawn(const Mask& mask) {
  std::string text;
  for (const std::uint8_t m : mask.pixels()) text += m == kMaskObject ? '#' : m == 0 ? '.' : '?';
  return text;
}

std::string drawn(const std::vector<Rgba8>& pixels, bool lossy = false) {
  Picture picture;
  picture.pixels = image_of(static_cast<int>(pixels.size()), pixels);
  picture.lossy = lossy;
  const ReadMask read = mask_of(picture, "here");
  return drawn(read.mask) + " " + read.how;
}

Rgba8 grey(int level) {
  const auto v = static_cast<std::uint8_t>(level);
  return {v, v, v, 255};
}

Camera camera_called(const std::string& name) {
  Camera camera;
  camera.name = name;
  camera.width_px = 8;
  camera.height_px = 6;
  camera.fx_px = camera.fy_px = 8;
  return camera;
}
std::vector<Camera> cameras_called(const std::vector<std::string>& names) {
  std::vector<Camera> cameras;
  for (const std::string& name : names) cameras.push_back(camera_called(name));
  return cameras;
}
using Indices = std::vector<std::size_t>;

}  // namespace

TEST_CASE("mask file: grey, 0 and 1, ids, colours on black, alpha, each understood as it is meant") {
  CHECK(drawn({grey(0), grey(127), grey(128), grey(255)}) == "..## white");
  CHECK(drawn({grey(0), grey(1), grey(1), grey(0)}) == ".##. numbers, 0 is the rest");
  CHECK(drawn({grey(0), grey(3), grey(70), grey(1)}) == ".### numbers, 0 is the rest");
  CHECK(drawn({grey(0), grey(0)}) == ".. ");
  CHECK(drawn({{0, 0, 0, 255}, {128, 0, 0, 255}, {0, 64, 0, 255}, {0, 0, 9, 255}}) ==
        ".##. any colour on black");
  // A dark thing cut out of its photograph: white is where nothing is.
  CHECK(drawn({{255, 255, 255, 0}, {20, 10, 5, 255}, {0, 0, 0, 255}, {90, 80, 70, 127}}) == ".##. alpha");
  CHECK(drawn({{9, 9, 9, 0}, {9, 9, 9, 1}, {9, 9, 9, 1}, {9, 9, 9, 0}}) ==
        ".##. alpha");  // 0 and 1 there, too
  // Smoothed borders alone are no mask: then the colours are.
  CHECK(drawn({{255, 255, 255, 255}, {0, 0, 0, 254}, {0, 0, 0, 255}, {255, 255, 255, 250}}) == "#..# white");
  // Ids in one channel, all of them dark.
  CHECK(drawn({{0, 0, 0, 255}, {1, 0, 0, 255}, {7, 0, 0, 255}, {0, 0, 0, 255}}) ==
        ".##. any colour on black");
  CHECK(drawn({{9, 9, 9, 255}, {9, 9, 9, 255}}) == "## numbers, 0 is the rest");  // alpha does not vary
  // JPEG: neither black nor grey are quite that.
  CHECK(drawn({{3, 1, 6, 255}, {250, 255, 240, 255}}, true) == ".# white");
  CHECK(drawn({{3, 1, 6, 255}, {9, 0, 2, 255}}, true) == ".. ");
  CHECK_THROWS_WITH_AS(drawn({{200, 90, 60, 255}, {90, 120, 90, 255}}), doctest::Contains("photograph"),
                       Error);
}

TEST_CASE("mask file: of a few pixels must have the camera's shape, too") {
  const auto said = [](int width, int height) {
    Mask mask(width, height);
    mask.at(0, 0) = kMaskObject;
    Camera camera = camera_called("a");
    camera.width_px = 504;
    camera.height_px = 378;
    try {
      checked_mask({mask, "white"}, camera, "a.png");
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  CHECK(said(4, 3).empty());
  CHECK(said(125, 94).empty());
  CHECK(said(2, 1).find("the mask is 2x1 pixels") != std::string::npos);
}

TEST_CASE("mask file: numbers of many objects, some above half of white, are no smoothed white") {
  const auto understood = [](const std::vector<int>& levels) {  // three rows of each
    Picture picture;
    picture.pixels = Image<Rgba8>(static_cast<int>(levels.size()), 3);
    for (int y = 0; y < 3; ++y)
      for (int x = 0; x < picture.pixels.width(); ++x)
        picture.pixels.at(x, y) = grey(levels[static_cast<std::size_t>(x)]);
    const ReadMask read = mask_of(picture, "here");
    return drawn(read.mask).substr(0, levels.size()) + " " + read.how;
  };
  CHECK(understood({0, 7, 7, 7, 7, 7, 7, 0, 200, 200}) == ".######.## numbers, 0 is the rest");
  CHECK(understood({0, 60, 140, 200, 200, 180, 90, 30}) == "..####.. white");  // dim, with wide borders
  CHECK(understood({0, 7, 7, 7, 7, 7, 7, 0, 255, 255}) == "........## white");
}

TEST_CASE("mask file: PNG of a palette by its indices, of 16 bits by its numbers, JPEG by what is bright") {
  const Workplace place;
  place.write("palette.png", from_hex(kPalettePng));
  const ReadMask palette = read_mask(place / "palette.png");
  CHECK(palette.mask.width() == 4);
  CHECK(drawn(palette.mask) == ".##...##");
  CHECK(palette.how == "palette, index > 0");
  place.write("named.png", from_hex(kJpeg));  // a name is only a name
  const ReadMask jpeg = read_mask(place / "named.png");
  REQUIRE(jpeg.mask.width() == 16);
  REQUIRE(jpeg.mask.height() == 8);
  CHECK(drawn(jpeg.mask).substr(0, 16) == "........########");
  CHECK(picture_size(place / "named.png") == glm::ivec2(16, 8));
  CHECK(picture_size(place / "palette.png") == glm::ivec2(4, 2));
  for (const auto& [numbers, expected] : std::vector<std::pair<std::vector<std::uint16_t>, std::string>>{
           {{0, 1, 700, 0}, ".##."}, {{0, 30000, 40000, 65535}, "..##"}, {{0, 1, 1, 0}, ".##."}}) {
    write_png(place / "wide.png", image_of(4, numbers));
    CHECK(drawn(read_mask(place / "wide.png").mask) == expected);
    place.write("gamma.png", with_gamma(place.text("wide.png")));
    CHECK(drawn(read_mask(place / "gamma.png").mask) == expected);
  }
  for (const std::size_t size : {20, 150}) {
    place.write("cut.jpg", from_hex(kJpeg).substr(0, size));
    CHECK_THROWS_WITH_AS(read_mask(place / "cut.jpg"), doctest::Contains("damaged"), Error);
  }
  place.write("pointer.png", "version https://git-lfs.github.com/spec/v1\n");
  CHECK_THROWS_WITH_AS(read_mask(place / "pointer.png"), doctest::Contains("git lfs pull"), Error);
  place.write("text.png", "no picture");
  CHECK_THROWS_WITH_AS(read_mask(place / "text.png"), doctest::Contains("neither PNG"), Error);
}

TEST_CASE("mask file: a JPEG in the colours of print is refused with what to do") {
  const Workplace place;
  place.write("a.jpg", from_hex(kCmykJpeg));
  CHECK_THROWS_WITH_AS(read_picture(place / "a.jpg"), doctest::Contains("CMYK"), Error);
  CHECK_THROWS_WITH_AS(read_picture(place / "a.jpg"), doctest::Contains("RGB"), Error);
}

TEST_CASE("names: with and without endings, by path below images, numbers only where they are written so") {
  const std::vector<Camera> cameras = cameras_called({"0000", "0001", "0004", "view.001", "IMG_7.JPG"});
  const auto found = [&](const std::string& name) { return find_camera(cameras, name, "cameras").name; };
  CHECK(found("0001.jpg") == "0001");
  CHECK(found("images/0001.png") == "0001");
  CHECK(found("IMG_7") == "IMG_7.JPG");
  CHECK(found("img_7.jpg") == "IMG_7.JPG");
  CHECK(found("view.001") == "view.001");
  CHECK(found("2") == "0004");
  CHECK(found("0") == "0000");
  for (const char* none : {"0003", "01", "5", "view", "-1", ""})
    CHECK_THROWS_WITH_AS(found(none), doctest::Contains("has no camera"), Error);
  const std::vector<Camera> rig = cameras_called({"cam0/0001", "cam1/0001", "cam1/0002"});
  CHECK(find_camera(rig, "cam1/0001", "rig").name == "cam1/0001");
  CHECK(find_camera(rig, "cam1\\0001.jpg", "rig").name == "cam1/0001");
  CHECK(find_camera(rig, "0002", "rig").name == "cam1/0002");
  CHECK_THROWS_WITH_AS(find_camera(rig, "0001", "rig"), doctest::Contains("2 cameras"), Error);
  const std::vector<Camera> twins = cameras_called({"a", "b", "b"});
  CHECK(find_camera(twins, "2", "twins").name == "b");
  CHECK_THROWS_WITH_AS(find_camera(twins, "b", "twins"), doctest::Contains("number 1"), Error);

  std::vector<Camera> named = cameras_called({"images/a.jpg", "x\\images\\b.c.png"});
  name_after_pictures(&named);
  CHECK(named[0].name == "a");
  CHECK(named[1].name == "b.c");
  named = cameras_called({"images/cam0/0.jpg", "./images/cam1/0.jpg", "images/cam1/1.jpg"});
  name_after_pictures(&named);
  CHECK(named[0].name == "cam0/0");
  CHECK(named[2].name == "cam1/1");
}

TEST_CASE("names of masks: letters of other scripts, in one character or as macOS writes them") {
  // Composed, then decomposed, as Unicode has it.
  for (const auto& [whole, parts] : std::vector<std::pair<std::string, std::string>>{
           {"\u00fc", "u\u0308"},
           {"\u1ebf", "e\u0302\u0301"},
           {"\u01b0", "u\u031b"},
           {"\u0439\u0401", "\u0438\u0306\u0415\u0308"},
           {"\u304c\u3065\u3070\u3071", "\u304b\u3099\u3064\u3099\u306f\u3099\u306f\u309a"},
           {"\u30ac\u30d7\u30f4", "\u30ab\u3099\u30d5\u309a\u30a6\u3099"},
           {"\ud55c\uae00\uac00", "\u1112\u1161\u11ab\u1100\u1173\u11af\u1100\u1161"}}) {
    CAPTURE(whole);
    const std::vector<Camera> cameras = cameras_called({"x", whole + "_1", "y"});
    CHECK(cameras_of_mask(cameras, whole + "_1") == Indices{1});
    CHECK(cameras_of_mask(cameras, parts + "_1") == Indices{1});
    CHECK(cameras_of_mask(cameras_called({parts + "_1"}), whole + "_01_mask") == Indices{0});
  }
  CHECK(cameras_of_mask(cameras_called({"\u306f", "\u30b7"}), "\u30b7") == Indices{1});
  CHECK(cameras_of_mask(cameras_called({"a\xff", "b\xe3\x81"}), "b\xe3\x81") == Indices{1});  // no UTF-8
}

TEST_CASE("names of masks: endings, zeros, accents as macOS writes them") {
  const std::vector<Camera> cameras = cameras_called({"0001", "0010", "caf\xc3\xa9_01", "_mask", "a_mask"});
  CHECK(cameras_of_mask(cameras, "0001_mask") == Indices{0});
  CHECK(cameras_of_mask(cameras, "0001.mask") == Indices{0});
  CHECK(cameras_of_mask(cameras, "00001-mask") == Indices{0});
  for (const char* name : {"mask_0001", "0001_masks", "0001_seg", "0001_alpha", "0001_MASK"})
    CHECK(cameras_of_mask(cameras, name) == Indices{0});
  CHECK(cameras_of_mask(cameras, "CAFE_1") == Indices{2});
  CHECK(cameras_of_mask(cameras, "1") == Indices{0});
  CHECK(cameras_of_mask(cameras, "10") == Indices{1});
  CHECK(cameras_of_mask(cameras, "cafe\xcc\x81_01") == Indices{2});
  CHECK(cameras_of_mask(cameras, "a_mask") == Indices{4});  // its own name, not that of "a"
  CHECK(cameras_of_mask(cameras, "2").empty());
}

TEST_CASE(
    "mask folder: hidden files are skipped, sizes scaled, black is rest, strangers left out with a warning") {
  const Workplace place;
  place.make_folder("masks/.hidden");
  place.make_folder("masks/__MACOSX");
  const std::vector<Camera> cameras = cameras_called({"0000", "0001", "0002", "0003"});
  const auto half = [](int width, int height) {
    Image<std::uint8_t> image(width, height);
    for (int y = 0; y < height; ++y)
      for (int x = width / 2; x < width; ++x) image.at(x, y) = 255;
    return image;
  };
  write_png(place / "masks/0000.png", Image<std::uint8_t>(8, 6));
  write_png(place / "masks/1_mask.png", half(4, 3));
  write_png(place / "masks/0002.png", half(8, 6));
  write_png(place / "masks/0009.png", half(8, 6));
  place.write("masks/._0003.png", "AppleDouble");
  place.write("masks/.hidden/0003.png", "hidden");
  place.write("masks/__MACOSX/0003.png", "hidden");
  const MaskFolder found = load_mask_folder(cameras, {place / "masks", {}, {}});
  CHECK(found.reference.camera.name == "0001");
  CHECK(drawn(found.reference.mask).substr(0, 8) == "....####");
  REQUIRE(found.others.size() == 2);
  CHECK(found.others[0].camera.name == "0000");
  CHECK(drawn(found.others[0].mask) == std::string(48, '.'));
  CHECK(found.how ==
        "3 of 4 masks have a camera; taken for the object: white; scaled by 2; 1 black: there all is rest");
  REQUIRE(found.warnings.size() == 1);
  CHECK(found.warnings[0].find("0009.png") != std::string::npos);
  const MaskFolder wanted = load_mask_folder(cameras, {place / "masks", "0002", {}});
  CHECK(wanted.reference.camera.name == "0002");
  // A photograph beside its mask, with names of the same camera.
  place.write("masks/0001.jpg", from_hex(kJpeg));
  const MaskFolder beside = load_mask_folder(cameras, {place / "masks", {}, {}});
  CHECK(drawn(beside.reference.mask).substr(0, 8) == "....####");
  REQUIRE(beside.warnings.size() == 2);
  CHECK(
      beside.warnings[1].find("1 picture lies beside the mask of its camera and is left out: \"0001.jpg\"") !=
      std::string::npos);
  write_png(place / "masks/0001-mask.png", half(4, 3));
  CHECK_THROWS_WITH_AS(load_mask_folder(cameras, {place / "masks", {}, {}}),
                       doctest::Contains("another mask"), Error);
  fs::remove(place / "masks/0001-mask.png");
  write_png(place / "masks/0002.png", half(8, 8));
  CHECK_THROWS_WITH_AS(load_mask_folder(cameras, {place / "masks", {}, {}}), doctest::Contains("8x8"), Error);
}
