// NVOS and SPIn-NeRF folders: stand-ins in the released layout, drawn from a still life whose labels are
// known.
#include <algorithm>
#include <nlohmann/json.hpp>

#include "app/lab/benchmark_folders.h"
#include "app/lab/published_scores.h"
#include "app/lab/scribble_picture.h"
#include "app/measure/evaluate_picture.h"
#include "core/error.h"
#include "core/png_file.h"
#include "program_runner.h"
#include "segment/masks/mask_tools.h"

using namespace splatcut;
using namespace splatcut::testing;
using nlohmann::json;
namespace fs = std::filesystem;

namespace {

constexpr const char* kThing = "apple";

// A still life of 12,000 Gaussians as a reconstruction, and the apple's true masks at 504 x 378.
struct StandIn {
  Workplace place;
  std::unique_ptr<LoadedCase> life;

  StandIn() {
    REQUIRE(place.run("make-scene small -o scenes/apple --gaussians 12000").code == 0);
    for (const json& entry : read_suite(place / "scenes/apple/suite.json"))
      if (entry.at("name") == kThing) life = load_case(entry, place / "scenes/apple", {}, {});
    REQUIRE(life);
    fs::remove(place / "scenes/apple/suite.json");
  }

  const Camera& camera(std::size_t i) const { return life->test.scene_cameras[i]; }
  Mask truth(std::size_t i, int width = 504, int height = 378) const {
    return thresholded(
        render_labels(life->scene.cloud, resized(camera(i), width, height), life->test.truth_labels), 0.5f);
  }
  void save(const std::string& name, const Image<std::uint8_t>& grey) const {
    fs::create_directories((place / name).parent_path());
    write_png(place / name, grey);
  }
  void touch(const std::string& name) const {
    fs::create_directories((place / name).parent_path());
    place.write(name, "");
  }
  // A thin line through the middle of a mask: every row's middle pixel.
  static Mask spine(const Mask& mask) {
    Mask line(mask.width(), mask.height());
    for (int y = 0; y < mask.height(); ++y) {
      int first = -1, last = -1;
      for (int x = 0; x < mask.width(); ++x)
        if (mask.at(x, y)) last = x, first = first < 0 ? x : first;
      for (int x = (first + last) / 2 - 1; first >= 0 && x <= (first + last) / 2 + 1; ++x)
        if (mask.contains(x, y) && mask.at(x, y)) line.at(x, y) = kMaskObject;
    }
    return line;
  }

  void make_nvos() const {
    touch(std::string("nvos/labels/llff/reference_image/apple/") + camera(0).name + ".JPG");
    save("nvos/labels/llff/scribbles/apple/pos_0_apple.png", spine(eroded(truth(0), 6)));
    Mask rest(504, 378);
    const Mask around = dilated(truth(0), 12),
               near = dilated(truth(0), 10);  // as people draw it: about the object
    for (std::size_t i = 0; i < rest.size(); ++i)
      rest.pixels()[i] = around.pixels()[i] && !near.pixels()[i] ? kMaskObject : 0;
    save("nvos/labels/llff/scribbles/apple/neg_0_apple.png", rest);
    save("nvos/labels/llff/scribbles/apple/vis_0_apple.png", truth(0));
    touch(std::string("nvos/labels/llff/masks/apple/") + camera(3).name + ".JPG");
    save("nvos/labels/llff/masks/apple/" + camera(3).name + "_mask.png", truth(3));
  }
  // The first named as the camera, the second by its number, the third with the prefix of a split.
  void make_spin_nerf() const {
    const std::string folder = "spin/apple (stand-in)/";
    save(folder + camera(0).name + ".png", truth(0));
    save(folder + "image002.png", truth(2));
    Mask ones = truth(5, 252, 189);
    for (auto& m : ones.pixels()) m = m ? 1 : 0;
    save(folder + "0_" + camera(5).name + ".png", ones);
    save(folder + camera(0).name + "_pseudo.png", Mask(504, 378, kMaskObject));
    save(folder + camera(0).name + "_cutout.png", Mask(504, 378, kMaskObject));
  }

  void refused(const std::string& command, std::vector<std::string> words) const {
    const Result result = place.run(command);
    CHECK(result.code == 1);
    for (const std::string& word : words)
      CHECK_MESSAGE(result.err.find(word) != std::string::npos, word << " in: " << result.err);
    CHECK(!place.exists("out"));
    CHECK(place.leftovers().empty());
  }
};

const std::string kNvos = "eval --nvos nvos --scenes scenes -o out",
                  kSpin = "eval --spin-nerf spin --scenes scenes -o out";

}  // namespace

TEST_CASE("a scribble's picture becomes discs that lie on it and cover it to the stated distance") {
  Mask drawn(200, 100);
  for (int x = 20; x < 180; ++x)
    for (int y = 40; y < 47; ++y) drawn.at(x, y) = kMaskObject;
  drawn.at(5, 90) = kMaskObject;  // a dot of one pixel
  const Strokes strokes = strokes_of_picture(drawn, SeedLabel::kRest);
  REQUIRE(strokes.size() > 10);
  for (const Stroke& s : strokes) {
    REQUIRE(s.points_px.size() == 1);
    CHECK(s.label == SeedLabel::kRest);
    CHECK(drawn.at(static_cast<int>(s.points_px[0].x), static_cast<int>(s.points_px[0].y)) != 0);
    CHECK(s.radius_px <= 4);
  }
  CHECK(
      std::ranges::any_of(strokes, [](const Stroke& s) { return s.points_px[0] == glm::vec2(5.5f, 90.5f); }));
  for (int x = 20; x < 180; ++x)  // 8 px: twice the half width
    CHECK(std::ranges::any_of(strokes, [&](const Stroke& s) {
      return glm::distance(s.points_px[0], glm::vec2(static_cast<float>(x) + 0.5f, 43.5f)) <= 8.01f;
    }));
}

TEST_CASE("NVOS: scribbles become strokes in the reference, the mask is the truth of its own camera") {
  const StandIn made;
  made.make_nvos();
  for (const char* given : {"nvos", "nvos/labels", "nvos/labels/llff"}) {
    const std::vector<BenchmarkTask> tasks = nvos_tasks(made.place / given, made.place / "scenes");
    REQUIRE(tasks.size() == 1);
    CHECK(tasks[0].name == kThing);
    CHECK(tasks[0].reference == made.camera(0).name);
  }
  const auto loaded = load_task(nvos_tasks(made.place / "nvos", made.place / "scenes")[0], {}, {});
  const EvaluationCase& test = loaded->test;
  CHECK(test.reference.name == made.camera(0).name);
  CHECK(test.reference.width_px == 504);
  REQUIRE(test.truth_masks.size() == 1);
  CHECK(test.truth_masks[0] == made.truth(3));
  CHECK(test.test_views[0].name == made.camera(3).name);
  const Mask object = made.truth(0);
  int positive = 0, negative = 0;
  for (const Stroke& s : test.clicks) {
    const bool on = object.at(static_cast<int>(s.points_px[0].x), static_cast<int>(s.points_px[0].y)) != 0;
    CHECK(on == (s.label == SeedLabel::kObject));
    ++(on ? positive : negative);
  }
  CHECK(positive >= 2);
  CHECK(negative >= 10);
}

TEST_CASE(
    "NVOS by the command: measured, with the published figures beside it, in one folder or as a 3DGS "
    "output") {
  const StandIn made;
  made.make_nvos();
  const Result result = made.place.run(kNvos);
  REQUIRE_MESSAGE(result.code == 0, result.err);
  CHECK(result.out.find(".925") != std::string::npos);
  const json measured = json::parse(made.place.text("out/eval.json"));
  REQUIRE(measured["scenes"].size() == 1);
  const json& scene = measured["scenes"][0];
  CHECK(scene["name"] == kThing);
  CHECK(scene["image_iou"].get<double>() > 0.8);
  CHECK(scene["accuracy"].get<double>() > 0.98);
  CHECK(scene["psnr_db"].get<double>() > 20);
  CHECK(scene["ssim"].get<double>() > 0.9);
  CHECK(measured["mean"]["ssim"] == scene["ssim"]);
  CHECK(measured["published"].size() == 3);
  CHECK(measured["clicks"] == "all");
  CHECK(made.place.run(kNvos + " --clicks 2").code == 2);  // all scribbles count: no number of clicks
  // The same reconstruction as 3DGS leaves it; the last iteration counts.
  made.place.make_folder("runs/apple_undistort/point_cloud/iteration_30000");
  made.place.make_folder("runs/apple_undistort/point_cloud/iteration_7000");
  made.place.write("runs/apple_undistort/point_cloud/iteration_7000/point_cloud.ply", "not a scene");
  fs::copy(made.place / "scenes/apple/small.ply",
           made.place / "runs/apple_undistort/point_cloud/iteration_30000/point_cloud.ply");
  fs::copy(made.place / "scenes/apple/cameras.json", made.place / "runs/apple_undistort/cameras.json");
  REQUIRE(made.place.run("eval --nvos nvos --scenes runs -o again").code == 0);
  CHECK(json::parse(made.place.text("again/eval.json"))["scenes"][0]["image_iou"] == scene["image_iou"]);
}

TEST_CASE(
    "SPIn-NeRF: the first mask is given, the others scored, cut-outs are not looked at, numbers and prefixes "
    "are cameras") {
  const StandIn made;
  made.make_spin_nerf();
  const auto tasks = spin_nerf_tasks(made.place / "spin", made.place / "scenes");
  REQUIRE(tasks.size() == 1);
  CHECK(tasks[0].name == kThing);
  // By name: 0_..., image002, then the camera's own.
  const auto loaded = load_task(tasks[0], {}, {});
  const EvaluationCase& test = loaded->test;
  CHECK(test.reference.name == made.camera(5).name);
  CHECK(test.reference.width_px == 252);
  CHECK(test.clicks.empty());
  REQUIRE(test.reference_truth);
  CHECK(*test.reference_truth == made.truth(5, 252, 189));
  REQUIRE(test.test_views.size() == 2);
  CHECK(test.test_views[0].name == made.camera(2).name);
  CHECK(test.truth_masks[0] == made.truth(2));
  CHECK(test.test_views[1].name == made.camera(0).name);
  const Result result = made.place.run(kSpin);
  REQUIRE_MESSAGE(result.code == 0, result.err);
  CHECK(result.out.find(".929") != std::string::npos);
  const json measured = json::parse(made.place.text("out/eval.json")), &scene = measured["scenes"][0];
  CHECK(measured["clicks"] == 0);  // its mask is given
  CHECK(scene["image_iou"].get<double>() > 0.9);
  // One scene of it, its masks in a folder beside the pictures: the same answer.
  fs::create_directories(made.place / "one/images_2");
  fs::copy(made.place / "spin/apple (stand-in)", made.place / "one/images_2/label");
  made.save("one/images_2/" + made.camera(0).name + ".png", Mask(504, 378));
  REQUIRE(made.place.run("eval --spin-nerf one --scenes scenes/apple -o one_out").code == 0);
  CHECK(json::parse(made.place.text("one_out/eval.json"))["scenes"][0]["image_iou"] == scene["image_iou"]);
}

TEST_CASE(
    "what is wrong with a benchmark's folder is said in a sentence, with exit code 1, and nothing is "
    "written") {
  const StandIn made;
  made.make_nvos();
  made.make_spin_nerf();
  const std::string spin = "spin/apple (stand-in)/",
                    mask = "nvos/labels/llff/masks/apple/" + made.camera(3).name + "_mask.png";
  SUBCASE("a mask of no camera") {
    made.save(spin + "elsewhere.png", made.truth(0));
    made.refused(kSpin, {"elsewhere.png", "no camera is called", "There are 24"});
  }
  SUBCASE("two masks of one number beyond the cameras") {
    made.save(spin + "image099.png", made.truth(0));
    made.refused(kSpin, {"image099", "no camera is called"});
  }
  SUBCASE("another aspect ratio") {
    made.save(mask, Mask(504, 300, kMaskObject));
    made.refused(kNvos, {"_mask.png", "504x300", "1008x756", "aspect ratio"});
  }
  SUBCASE("an empty mask") {
    made.save(spin + "image002.png", Mask(504, 378));
    made.refused(kSpin, {"image002.png", "empty"});
  }
  SUBCASE("an empty scribble") {
    made.save("nvos/labels/llff/scribbles/apple/pos_0_apple.png", Mask(504, 378));
    made.refused(kNvos, {"pos_0_apple.png", "the scribble is empty"});
  }
  SUBCASE("no scribble on the object") {
    fs::remove(made.place / "nvos/labels/llff/scribbles/apple/pos_0_apple.png");
    made.refused(kNvos, {"scribbles/apple", "no scribble on the object"});
  }
  SUBCASE("no target mask") {
    fs::remove(made.place / mask);
    made.refused(kNvos, {"masks/apple", "no masks NAME_mask.png"});
  }
  SUBCASE("not a picture") {
    made.place.write(mask, "no picture");
    made.refused(kNvos, {"_mask.png"});
  }
  SUBCASE("not that folder") {
    made.refused("eval --nvos spin --scenes scenes -o out", {"spin", "no folder \"scribbles\""});
  }
  SUBCASE("no reconstruction") {
    made.refused("eval --nvos nvos --scenes nvos -o out", {"no reconstruction of apple"});
  }
  SUBCASE("two reconstructions") {
    fs::copy(made.place / "scenes/apple/small.ply", made.place / "scenes/apple/other.ply");
    made.refused(kNvos, {"holds 2 scenes", "other.ply"});
  }
  SUBCASE("no cameras") {
    fs::remove(made.place / "scenes/apple/cameras.json");
    made.refused(kNvos, {"holds no cameras"});
  }
}

TEST_CASE("eval takes one way in, and says which") {
  const Workplace place;
  for (const char* command :
       {"eval -o out", "eval --nvos a -o out", "eval suite.json --nvos a --scenes b -o out",
        "eval suite.json --scenes b -o out"}) {
    CHECK_MESSAGE(place.run(command).code == 2, command);
    CHECK(!place.exists("out"));
  }
}

TEST_CASE("the object on black: equal where the labels are the truth, worse the more is missing") {
  const StandIn made;
  EvaluationCase test = made.life->test;
  test.test_views.resize(2);
  render_truth(&test);
  const PictureScore perfect = score_pictures(test, test.truth_labels);
  CHECK(perfect.psnr_db == kEqualPicturesDb);
  CHECK(perfect.ssim == doctest::Approx(1));
  std::vector<std::uint8_t> half = test.truth_labels, none(test.truth_labels.size(), 0);
  bool keep = false;
  for (auto& label : half)
    if (label) label = (keep = !keep);
  const PictureScore some = score_pictures(test, half), nothing = score_pictures(test, none);
  CHECK(perfect.psnr_db > some.psnr_db);
  CHECK(some.psnr_db > nothing.psnr_db);
  // Nothing is a black picture: its mean square is the truth's own brightness.
  double squares = 0, values = 0, db = 0;
  for (const Camera& view : test.test_views) {
    squares = values = 0;
    const Image<Rgb8> truth = object_on_black(*test.cloud, view, test.truth_labels);
    for (const Rgb8& p : truth.pixels())
      for (const int c : p) squares += c * c, ++values;
    db += 10 * std::log10(255.0 * 255.0 * values / squares) / 2;
  }
  CHECK(nothing.psnr_db == doctest::Approx(db).epsilon(1e-6));
  // Known by masks only: the scene's own picture inside the mask, nearly the object alone.
  EvaluationCase masks_only = test;
  masks_only.truth_labels.clear();
  const PictureScore near = score_pictures(masks_only, test.truth_labels);
  CHECK(near.psnr_db > some.psnr_db);
  CHECK(near.psnr_db < kEqualPicturesDb);
}
