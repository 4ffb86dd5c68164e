#include "scene/camera/camera_file.h"
#include "scene/still_life/still_life_cameras.h"

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <cmath>
#include <fstream>

#include "core/error.h"
#include "places.h"
#include "quick.h"
#include "scene_file_helpers.h"

using namespace splatcut;
using namespace splatcut::testing;

namespace {

bool near(const glm::vec3& a, const glm::vec3& b) {
  return glm::length(a - b) < 1e-5f;
}

std::string camera_refusal(const fs::path& path) {
  try {
    load_cameras(path);
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

// The camera of all the files below: at (1, 2, 3), looking along world +x, world -z up in the picture.
void check_camera(const Camera& camera) {
  CHECK(camera.width_px == 640);
  CHECK(camera.height_px == 480);
  CHECK(camera.fx_px == 500);
  CHECK(camera.fy_px == 510);
  CHECK(camera.cx_px == 320);
  CHECK(camera.cy_px == 240);
  CHECK(near(camera.centre_world(), {1, 2, 3}));
  CHECK(near(camera.forward_world(), {1, 0, 0}));
  CHECK(near(camera.down_world(), {0, 0, 1}));
  // 10 in front, 1 to the right (world -y: down x forward), 2 below
  CHECK(near(camera.camera_from_world({11, 3, 5}), {1, 2, 10}));
}

// world->camera of that camera: rows x = (0, 1, 0), y = (0, 0, 1), z = (1, 0, 0): a third of a turn about (1,
// 1, 1).
const char* const kColmapPose = "0.5 -0.5 -0.5 -0.5 -2 -3 -1";

}  // namespace

QUICK_CASE("Inria cameras", "Inria cameras.json: read, written, read again") {
  const Folder folder;
  write(folder / "cameras.json",
        R"([{"id": 0, "img_name": "a", "width": 640, "height": 480, "position": [1, 2, 3],
             "rotation": [[0, 0, 1], [1, 0, 0], [0, 1, 0]], "fy": 510, "fx": 500}])");
  std::vector<Camera> cameras = load_cameras(folder / "cameras.json");
  REQUIRE(cameras.size() == 1);
  CHECK(cameras[0].name == "a");
  check_camera(cameras[0]);
  cameras.push_back(cameras[0]);
  cameras[1].name = 'b';
  cameras[1].cx_px = 300;
  save_inria_cameras(folder / "again.json", cameras);
  const std::vector<Camera> again = load_cameras(folder / "again.json");
  REQUIRE(again.size() == 2);
  check_camera(again[0]);
  CHECK(again[1].name == "b");
  CHECK(again[1].cx_px == 300);
}

QUICK_CASE("COLMAP", "COLMAP text: comments, an image without points, the folder or one of its files") {
  const Folder folder;
  write(folder / "cameras.txt",
        "# lenses\n1 PINHOLE 640 480 500 510 320 240\n2 SIMPLE_RADIAL 640 480 500 320 240 0.1\n");
  write(folder / "images.txt", std::string("# poses\n7 ") + kColmapPose + " 2 b c.jpg\n\n3 " + kColmapPose +
                                   " 1 a.png\n1.5 2.5 -1 3 4 5\n");
  for (const fs::path& path : {folder.path, folder / "images.txt"}) {
    const std::vector<Camera> cameras = load_cameras(path);
    REQUIRE(cameras.size() == 2);
    CHECK(cameras[0].name == "a");
    check_camera(cameras[0]);
    CHECK(cameras[1].name == "b c");
    CHECK(cameras[1].fy_px == 500);
  }
}

TEST_CASE("COLMAP text without lines of points: no image is taken for points") {
  const Folder folder;
  write(folder / "cameras.txt", "1 PINHOLE 640 480 500 510 320 240\n");
  const auto names_of = [&](const std::string& images) {
    write(folder / "images.txt", images);
    std::string names;
    for (const Camera& camera : load_cameras(folder.path)) names += camera.name + " ";
    return names;
  };
  const std::string pose = std::string(kColmapPose) + " 1 ";
  const std::string one = "1 " + pose, two = "2 " + pose, three = "3 " + pose;
  CHECK(names_of(one + "a.jpg\n" + two + "b.jpg\n" + three + "c.jpg\n") == "a b c ");
  CHECK(names_of(one + "a.jpg\n1 2 -1\n" + two + "b.jpg\n" + three + "c 1.jpg\n\n") == "a b c 1 ");
  CHECK(names_of(one + "0001\n" + two + "0002\n") == "0001 0002 ");  // all of them numbers
}

TEST_CASE("COLMAP: the files that are named are read, not those of the other kind beside them") {
  const Folder both;  // what is named is read, not what lies beside it
  for (const char* ending : {".bin", ".txt"}) {
    write(both / (std::string("cameras") + ending), "1 PINHOLE 640 480 500 510 320 240\n");
    write(both / (std::string("images") + ending), std::string("1 ") + kColmapPose + " 1 a.jpg\n");
  }
  CHECK(load_cameras(both / "images.txt").size() == 1);
}

TEST_CASE("folders of captures: COLMAP where nerfstudio and Inria's scripts put it") {
  for (const char* below : {"colmap/sparse/0", "distorted/sparse/0", "dense/sparse", "sparse"}) {
    CAPTURE(below);
    const Folder folder;
    fs::create_directories(folder / below);
    write(folder / below / "cameras.txt", "1 PINHOLE 640 480 500 510 320 240\n");
    write(folder / below / "images.txt",
          std::string("1 ") + kColmapPose + " 1 cam0/a.jpg\n2 " + kColmapPose + " 1 cam1\\a.jpg\n");
    const std::vector<Camera> cameras = load_cameras(folder.path);
    REQUIRE(cameras.size() == 2);
    CHECK(cameras[0].name == "cam0/a");
    CHECK(cameras[1].name == "cam1/a");
  }
  const Folder folder;
  CHECK(camera_refusal(folder.path).find("colmap/sparse/0") != std::string::npos);
  write(folder / "a.csv", "#name,x,y,alt\n");
  CHECK(camera_refusal(folder / "a.csv").find("RealityCapture") != std::string::npos);
  write(folder / "a.xml", "<document/>");
  CHECK(camera_refusal(folder / "a.xml").find("Metashape") != std::string::npos);
  write(folder / "a.PLY", "ply\n");
  CHECK(camera_refusal(folder / "a.PLY").find("no list of cameras") != std::string::npos);
}

TEST_CASE("one bad camera of many is left out with a sentence, where all are bad that is the error") {
  const Folder folder;
  const std::string good = R"("width": 640, "height": 480, "position": [1, 2, 3],
    "rotation": [[0, 0, 1], [1, 0, 0], [0, 1, 0]], "fy": 510, "fx": 500})";
  const std::string zeros = R"({"img_name": "bad", "width": 640, "height": 480, "position": [1, 2, 3],
    "rotation": [[0, 0, 0], [0, 0, 0], [0, 0, 0]], "fy": 510, "fx": 500})";
  write(folder / "cameras.json", "[" + zeros + R"(, {"img_name": "good.JPG", )" + good + "]");
  std::string warning;
  const std::vector<Camera> cameras = load_cameras(folder / "cameras.json", &warning);
  REQUIRE(cameras.size() == 1);
  CHECK(cameras[0].name == "good");
  CHECK(warning.find("camera 0") != std::string::npos);
  CHECK(warning.find("left out") != std::string::npos);
  write(folder / "cameras.json", "[" + zeros + "," + zeros + "]");
  CHECK(camera_refusal(folder / "cameras.json").find("camera 0") != std::string::npos);
  // As Python writes what is no number, which JSON does not know.
  for (const char* word : {"NaN", "Infinity", "-Infinity"}) {
    std::string bad = zeros;
    bad.replace(bad.find("1, 2, 3"), 1, word);
    write(folder / "cameras.json", "[" + bad + R"(, {"img_name": "a NaN \" NaN", )" + good + "]");
    const std::vector<Camera> left = load_cameras(folder / "cameras.json", &warning);
    REQUIRE(left.size() == 1);
    CHECK(left[0].name == "a NaN \" NaN");
    check_camera(left[0]);
    CHECK(warning.find("camera 0") != std::string::npos);
  }
  std::string as_text = "[{" + good + "]";
  as_text.replace(as_text.find("640"), 3, "\"640\"");
  write(folder / "cameras.json", as_text);
  check_camera(load_cameras(folder / "cameras.json")[0]);
}

TEST_CASE("COLMAP: images whose lens or pose is none are left out, where others are left") {
  const Folder folder;
  const std::string good = std::string("1 ") + kColmapPose + " 1 good.png\n\n";
  std::string lenses =
      "1 PINHOLE 640 480 500 510 320 240\n2 OPENCV_FISHEYE 640 480 500 510 320 240 0 0 0 0\n";
  lenses += "3 EUCM 640 480 500 510\n4 PINHOLE 0 0 500 510 320 240\n";
  write(folder / "cameras.txt", lenses);
  std::string warning;
  const auto check_left_out = [&](const std::string& bad, const std::string& why) {
    CAPTURE(bad);
    write(folder / "images.txt", good + bad + "\n\n");
    const std::vector<Camera> cameras = load_cameras(folder.path, &warning);
    REQUIRE(cameras.size() == 1);
    check_camera(cameras[0]);
    CHECK_MESSAGE(warning.find(why) != std::string::npos, warning);
  };
  const std::string pose = std::string("2 ") + kColmapPose;
  check_left_out(pose + " 2 a.png", "OPENCV_FISHEYE is not close to a pinhole");
  check_left_out(pose + " 3 a.png", "unknown model EUCM");
  check_left_out(pose + " 4 a.png", "0 x 0");
  check_left_out(pose + " 9 a.png", "camera 9, which is missing");
  check_left_out("2 nan nan nan nan 0 0 0 1 a.png", "\"a.png\" has no usable pose");
  write(folder / "images.txt", "version https://git-lfs.github.com/spec/v1\n");
  CHECK(camera_refusal(folder.path).find("git lfs pull") != std::string::npos);
}

QUICK_CASE("COLMAP", "COLMAP binary, below sparse/0, and cut short") {
  const Folder folder;
  fs::create_directories(folder / "sparse/0");
  std::string lenses = bytes_of(std::uint64_t{1}) + bytes_of(4u) + bytes_of(1) +
                       bytes_of(std::uint64_t{640}) + bytes_of(std::uint64_t{480});
  for (const double v : {500.0, 510.0, 320.0, 240.0}) lenses += bytes_of(v);
  std::string images = bytes_of(std::uint64_t{1}) + bytes_of(9u);
  for (const double v : {0.5, -0.5, -0.5, -0.5, -2.0, -3.0, -1.0}) images += bytes_of(v);
  images += bytes_of(4u) + "a.png" + '\0' + bytes_of(std::uint64_t{2}) + std::string(48, 'p');
  write(folder / "sparse/0/cameras.bin", lenses);
  write(folder / "sparse/0/images.bin", images);
  const std::vector<Camera> cameras = load_cameras(folder.path);
  REQUIRE(cameras.size() == 1);
  CHECK(cameras[0].name == "a");
  check_camera(cameras[0]);
  for (const std::size_t size : {4, 50, 75, 90}) {
    write(folder / "sparse/0/images.bin", images.substr(0, size));
    CHECK(camera_refusal(folder.path).find("truncated") != std::string::npos);
  }
}

QUICK_CASE("transforms", "transforms.json: OpenGL axes, lens by frame, by file or by angle") {
  const Folder folder;
  // columns: x right = (0, 1, 0), y up = (0, 0, -1), z back = (-1, 0, 0)
  const std::string matrix =
      R"("transform_matrix": [[0, 0, -1, 1], [1, 0, 0, 2], [0, -1, 0, 3], [0, 0, 0, 1]])";
  write(folder / "transforms.json",
        R"({"w": 640, "h": 480, "fl_x": 500, "fl_y": 510, "frames": [{"file_path": "images/a.png", )" +
            matrix + R"(}, {"file_path": "b.png", "fl_x": 700, )" + matrix + "}]}");
  const std::vector<Camera> cameras = load_cameras(folder.path);
  REQUIRE(cameras.size() == 2);
  CHECK(cameras[0].name == "a");
  check_camera(cameras[0]);
  CHECK(cameras[1].fx_px == 700);
  write(folder / "angle.json",
        R"({"camera_angle_x": 1.5707963267948966, "w": 640, "h": 480, "frames": [{)" + matrix + "}]}");
  CHECK(load_cameras(folder / "angle.json")[0].fy_px == doctest::Approx(320));
}

TEST_CASE("transforms.json: lenses far from a pinhole, numbers as text, null, sizes of JPEGs beside it") {
  const Folder folder;
  const std::string matrix =
      R"("transform_matrix": [[0, 0, -1, 1], [1, 0, 0, 2], [0, -1, 0, 3], [0, 0, 0, 1]])";
  const auto frames = [&](const std::string& head, const std::string& frame = "") {
    write(folder / "t.json",
          "{" + head + R"("frames": [{"file_path": "images/a", )" + frame + matrix + "}]}");
  };
  const std::string lens = R"("w": 640, "h": 480, "fl_x": 500, "fl_y": 510, )";
  for (const char* model : {"OPENCV_FISHEYE", "EQUIRECTANGULAR", "orthographic", "FOV", "VR180_L"}) {
    CAPTURE(model);
    for (const bool by_frame : {false, true}) {
      const std::string said = fmt::format(R"("camera_model": "{}", )", model);
      frames(lens + (by_frame ? "" : said), by_frame ? said : "");
      CHECK(camera_refusal(folder / "t.json").find("not close to a pinhole") != std::string::npos);
    }
  }
  for (const char* fisheye : {"true", "1"}) {
    frames(lens + fmt::format("\"is_fisheye\": {}, ", fisheye));
    CHECK(camera_refusal(folder / "t.json").find("pinhole") != std::string::npos);
  }
  frames(
      R"("camera_model": "OPENCV", "w": "640", "h": "480", "fl_x": "500", "fl_y": 510, "cx": null, "k1": null, )");
  check_camera(load_cameras(folder / "t.json")[0]);
  frames(R"("w": "wide", "h": 480, "fl_x": 500, )");
  CHECK(camera_refusal(folder / "t.json").find("\"w\" is no number") != std::string::npos);
  for (const char* height : {"429496729630", "\"1e300\""}) {
    CAPTURE(height);
    frames(fmt::format(R"("w": 640, "h": {}, "fl_x": 500, )", height));
    CHECK(camera_refusal(folder / "t.json").find("a picture of 640 x") != std::string::npos);
  }
  // Markers of a JPEG as far as its size: 480 rows of 640.
  fs::create_directories(folder / "images");
  write(folder / "images/a.jpg",
        std::string("\xff\xd8\xff\xe0\x00\x04zz\xff\xc0\x00\x11\x08\x01\xe0\x02\x80\x03", 18) +
            std::string(20, '\0'));
  frames(R"("fl_x": 500, "fl_y": 510, )");
  check_camera(load_cameras(folder / "t.json")[0]);
  // A picture that cannot be read takes its own camera away, and no other.
  write(folder / "images/b.jpg", "");
  const auto frame = [&](const char* name) {
    return fmt::format(R"({{"file_path": "images/{}", {}}})", name, matrix);
  };
  for (const std::string& order : {frame("b") + ", " + frame("a"), frame("a") + ", " + frame("b")}) {
    write(folder / "t.json", R"({"fl_x": 500, "fl_y": 510, "frames": [)" + order + "]}");
    const std::vector<Camera> cameras = load_cameras(folder / "t.json");
    REQUIRE(cameras.size() == 1);
    check_camera(cameras[0]);
  }
}

TEST_CASE("lens distortion is left out with a warning that says how much it is") {
  const Folder folder;
  const std::string pose =
      R"(, "transform_matrix": [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]])";
  const std::string lens = R"({"w": 600, "h": 800, "fl_x": 500, "fl_y": 500, )";
  write(folder / "plain.json", lens + R"("frames": [{"file_path": "a")" + pose + "}]}");
  std::string warning = "from before";
  load_cameras(folder / "plain.json", &warning);
  CHECK(warning.empty());
  // The corner is 500 px from the middle, r = 1: k1 = 0.01 moves it by 5 px.
  write(folder / "bent.json", lens + R"("k1": 0.01, "frames": [{"file_path": "a")" + pose + "}]}");
  load_cameras(folder / "bent.json", &warning);
  CHECK_MESSAGE(warning.find("5.0 pixels") != warning.npos, warning);
  CHECK(warning.find("bent.json") != warning.npos);
  write(folder / "images.txt", "1 1 0 0 0 0 0 0 1 a.png\n\n");
  for (const char* camera :
       {"1 RADIAL 600 800 500 300 400 0.015 -0.005\n", "1 OPENCV 600 800 500 500 300 400 0 0.01 0 0\n"}) {
    write(folder / "cameras.txt", camera);
    CHECK(load_cameras(folder.path, &warning).size() == 1);
    CHECK_MESSAGE(warning.find("5.0 pixels") != warning.npos, warning);
  }
}

QUICK_CASE("Inria cameras", "bad cameras are refused with file and entry") {
  const Folder folder;
  const auto check = [&](const std::string& name, const std::string& text, const char* part) {
    write(folder / name, text);
    const std::string message = camera_refusal(folder / name);
    CHECK_MESSAGE(message.find(part) != message.npos, message);
    CHECK(message.find(name) != message.npos);
  };
  CHECK(camera_refusal(folder / "none.json").find("no such file") != std::string::npos);
  CHECK(camera_refusal(folder.path).find("no cameras") != std::string::npos);
  const std::string pose = R"("position": [0, 0, 0], "rotation": [[1, 0, 0], [0, 1, 0], [0, 0, 1]])";
  check("empty.json", "", "empty");
  check("cut.json", "[{\"id\": 0", "not valid JSON at byte");
  check("page.json", "\n<!DOCTYPE html>", "web page");
  check("other.json", "{\"a\": 1}", "frames");
  check("list.json", "[]", "no cameras");
  check("number.json", "[1]", "camera 0");
  check("width.json", "[{\"height\": 4, \"fx\": 1, \"fy\": 1, " + pose + "}]", "width");
  check("size.json", "[{\"width\": -4, \"height\": 4, \"fx\": 1, \"fy\": 1, " + pose + "}]", "-4 x 4");
  // 2^32 + 4 is no picture of 4 pixels.
  check("vast.json", "[{\"width\": 4294967300, \"height\": 4, \"fx\": 1, \"fy\": 1, " + pose + "}]",
        "1048576 x 4");
  check("focal.json", "[{\"width\": 4, \"height\": 4, \"fx\": 0, \"fy\": 1, " + pose + "}]", "focal");
  check("flat.json", R"([{"width": 4, "height": 4, "fx": 1, "fy": 1, "position": [0, 0, 0],
                         "rotation": [[1, 0, 0], [0, 1, 0], [0, 0, 0]]}])",
        "pose");
  check("images.txt", "1 1 0 0 0 0 0 0 5 a.png\n\n", "cameras and images");
  write(folder / "cameras.txt", "1 PINHOLE 640 480 500 510 320 240\n");
  check("images.txt", "1 1 0 0 0 0 0 0 5 a.png\n\n", "camera 5");
  check("images.txt", "1 0 0 0 0 0 0 0 1 a.png\n\n", "pose");
  check("images.txt", "1 1 0 0\n\n", "line 1");
  check("cameras.txt", "1 PINHOLE 640 480 500\n", "line 1");
  write(folder / "images.txt", "1 1 0 0 0 0 0 0 1 a.png\n\n");
  check("cameras.txt", "1 OPENCV_FISHEYE 640 480 500 510 320 240 0 0 0 0\n", "pinhole");
}

TEST_CASE("the sample's cameras look at the sample") {
  const std::vector<Camera> cameras = load_cameras(project_folder() + "/assets/sample/cameras.json");
  REQUIRE(cameras.size() > 5);
  CHECK(cameras[0].name == "view_00");
  CHECK(cameras[0].fx_px == doctest::Approx(1004.243164));
}
