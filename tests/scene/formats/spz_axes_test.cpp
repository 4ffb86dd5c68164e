// The axes of .spz: said by the file, by the cameras, by the user, or the format's own.
#include "scene/formats/spz_axes.h"
#include "places.h"
#include "quick.h"
#include "scene/raster/guessed_up.h"
#include "scene_file_helpers.h"

using namespace splatcut;
using namespace splatcut::testing;

namespace {

constexpr std::uint32_t kLuf = 7, kRdf = 6, kRub = 4, kRfu = 12;

// One Gaussian at (1, 2, -0.5) of the file, SH of degree 1 red 0.5; version 2, not packed.
std::string plain_spz(std::uint8_t flags) {
  std::string text = "NGSP" + bytes_of(2u) + bytes_of(1u) + "\x01\x08";
  text += static_cast<char>(flags);
  text += '\0';
  text += std::string("\x00\x01\x00\x00\x02\x00\x80\xff\xff", 9) + "\xff" + std::string("\x80\x00\xff", 3) +
          std::string("\xa0\x90\x00", 3) + "\x80\xff\x80";
  return text + "\xc0\x80\x80\xc0\x80\x80\xc0\x80\x80";
}
std::string axes_record(std::uint32_t axes) {
  return bytes_of(0xadbe0003u) + bytes_of(4u) + bytes_of(axes);
}
std::string camera_record() {  // of the same vendor, and to be passed over
  return bytes_of(0xadbe0002u) + bytes_of(12u) + std::string(12, '\x07');
}

// A floor of 20 x 20 Gaussians at y = 1 and a post of 20 on it, y down; on_its_head: turned about x.
GaussianCloud floor_and_post(bool on_its_head) {
  GaussianCloud cloud;
  cloud.resize(420, 0);
  for (std::size_t g = 0; g < 420; ++g) {
    const auto i = static_cast<float>(g % 20), j = static_cast<float>(g / 20);
    cloud.position[g] = g < 400 ? glm::vec3(i - 10, 1, j - 10) * glm::vec3(0.2f, 1, 0.2f)
                                : glm::vec3(g % 2 ? 0.1f : -0.1f, 0.1f * i - 1, 0);
    if (on_its_head) cloud.position[g] = kRightUpBack.position(cloud.position[g]);
    cloud.scale[g] = glm::vec3(0.1f);
    cloud.rotation[g] = {1, 0, 0, 0};
    cloud.opacity[g] = 1;
    cloud.file_row[g] = static_cast<std::uint32_t>(g);
  }
  return cloud;
}

LoadOptions asked(SpzAxes axes) {
  LoadOptions options;
  options.spz_axes = axes;
  return options;
}

// The real spherical harmonics of degree 1 to 3 as products of coordinates, constants left out.
std::array<float, 15> harmonics(const glm::vec3& d) {
  const float x = d.x, y = d.y, z = d.z;
  return {y,
          z,
          x,
          x * y,
          y * z,
          2 * z * z - x * x - y * y,
          x * z,
          x * x - y * y,
          y * (3 * x * x - y * y),
          x * y * z,
          y * (4 * z * z - x * x - y * y),
          z * (2 * z * z - 3 * x * x - 3 * y * y),
          x * (4 * z * z - x * x - y * y),
          z * (x * x - y * y),
          x * (x * x - 3 * y * y)};
}

}  // namespace

TEST_CASE("axes: points, covariances and spherical harmonics turn together, for all eight signs") {
  const glm::vec3 direction = glm::normalize(glm::vec3(0.3f, -0.7f, 0.5f)), sizes(0.1f, 0.4f, 1.0f);
  const glm::quat rotation = glm::normalize(glm::quat(0.3f, -0.2f, 0.8f, 0.4f));
  const auto covariance = [&](const glm::quat& q) {
    const glm::mat3 axes = glm::mat3_cast(q) * glm::mat3(sizes.x, 0, 0, 0, sizes.y, 0, 0, 0, sizes.z);
    return axes * glm::transpose(axes);
  };
  for (int bits = 0; bits < 8; ++bits) {
    CAPTURE(bits);
    const AxisSigns axes{bits & 1 ? -1.0f : 1.0f, bits & 2 ? -1.0f : 1.0f, bits & 4 ? -1.0f : 1.0f};
    const glm::mat3 turn(axes.x, 0, 0, 0, axes.y, 0, 0, 0, axes.z);
    CHECK(axes.position(direction) == turn * direction);
    const glm::mat3 expected = turn * covariance(rotation) * glm::transpose(turn);
    const glm::mat3 got = covariance(axes.rotation(rotation));
    for (int c = 0; c < 3; ++c) CHECK(glm::length(got[c] - expected[c]) < 1e-6f);
    const auto here = harmonics(turn * direction), file = harmonics(direction);
    for (std::size_t k = 0; k < 15; ++k) CHECK(axes.sh()[k] * file[k] == doctest::Approx(here[k]));
  }
}

TEST_CASE("spz axes: the file's word, else right-up-back with a note, and the user's word before both") {
  const Folder folder;
  const fs::path path = folder / "a.spz";
  const auto position = [&](const LoadOptions& options = {}) {
    const Scene scene = load_scene(path, options);
    REQUIRE(scene.cloud.size() == 1);
    return scene.cloud.position[0];
  };
  for (const bool packed : {false, true}) {
    CAPTURE(packed);
    const auto put = [&](const std::string& text) { write(path, packed ? gzip(text) : text); };
    put(plain_spz(0));
    CHECK(position() == glm::vec3(1, -2, 0.5f));
    CHECK(position(asked(SpzAxes::kPly)) == glm::vec3(1, 2, -0.5f));
    CHECK(load_scene(path).taken_axes == SpzAxes::kRub);
    CHECK(mentions(load_scene(path).axes_note,
                   {"does not say", "x right, y up, z back", "nothing says otherwise"}));
    const Scene ply = load_scene(path, asked(SpzAxes::kPly));
    CHECK(ply.taken_axes == SpzAxes::kPly);
    CHECK(ply.cloud.sh_rest_of(0)[0] == 0.5f);
    CHECK(mentions(ply.axes_note, {"as in a .ply", "asked"}));

    put(plain_spz(2) + camera_record() + axes_record(kRub));
    CHECK(position() == glm::vec3(1, -2, 0.5f));
    CHECK_FALSE(load_scene(path).taken_axes);
    CHECK(load_scene(path).axes_note.empty());
    CHECK(position(asked(SpzAxes::kPly)) == glm::vec3(1, 2, -0.5f));
    const Scene against = load_scene(path, asked(SpzAxes::kPly));
    CHECK(against.taken_axes == SpzAxes::kPly);
    CHECK(against.axes_note ==
          "The .spz file says its axes, but others were asked for. Taken: x right, y down, z forward, as in "
          "a .ply");
    put(plain_spz(2) + axes_record(kRdf));
    CHECK(position() == glm::vec3(1, 2, -0.5f));
    put(plain_spz(2) + axes_record(kLuf));
    CHECK(position() == glm::vec3(-1, -2, -0.5f));
    put(plain_spz(2) + axes_record(0));
    CHECK(position() == glm::vec3(1, -2, 0.5f));
    put(plain_spz(2) + axes_record(kRfu));
    CHECK(mentions(refusal(path), {"number 12", "exchange y and z", "Convert"}));
    put(plain_spz(2) + camera_record());  // other records say nothing of axes
    CHECK(load_scene(path).taken_axes == SpzAxes::kRub);
    put(plain_spz(2) + axes_record(kRdf).substr(0, 10));  // cut short
    CHECK(load_scene(path).taken_axes == SpzAxes::kRub);
    put(plain_spz(0) + axes_record(kRdf));  // not flagged: not records
    CHECK(load_scene(path).taken_axes == SpzAxes::kRub);
  }
}

TEST_CASE(
    "spz axes: version 4 says its axes, version 3 is right-up-back and not a byte more than its attributes") {
  const Folder folder;
  for (const int version : {3, 4})
    for (int degree = 0; degree <= 3; ++degree)
      for (const bool antialiased : {false, true}) {
        CAPTURE(version);
        CAPTURE(degree);
        Scene scene;
        scene.cloud = varied_cloud(800, degree);
        scene.cloud.antialiased = antialiased;
        save_scene(folder / "a.spz", scene, {}, SceneFormat::kSpz, {version});
        const std::string bytes = text_of(folder / "a.spz");
        CHECK(bytes.starts_with(version == 4 ? "NGSP" : "\x1f\x8b"));
        const std::string plain = version == 4 ? bytes : gunzip(bytes);
        CHECK((plain.find(axes_record(kRub)) != plain.npos) == (version == 4));
        CHECK((plain[14] & 2) == (version == 4 ? 2 : 0));  // of flags: extensions follow
        const auto sh_bytes = 3 * static_cast<std::size_t>(sh_rest_coefficients(degree));
        if (version == 3) CHECK(plain.size() == 16 + 800 * (20 + sh_bytes));
        const Scene got = load_scene(folder / "a.spz");
        CHECK_FALSE(got.taken_axes);  // ours of version 3: the comment of gzip's header says them
        CHECK(got.cloud.antialiased == antialiased);
        check_same(scene.cloud, got,
                   {1.0f / 8192, 1.01f / 32, 1e-5f, 0.51f / 255, 0.51f / 255 / 0.15f, 0.51f / 128});
      }
}

TEST_CASE("spz axes: cameras that see clearly more of the scene one way decide, others do not") {
  const Folder folder;
  Scene scene;
  scene.cloud = varied_cloud(2000, 1);
  for (glm::vec3& p : scene.cloud.position) p += glm::vec3(0, 40, 0);
  save_scene(folder / "a.spz", scene, {}, SceneFormat::kSpz, {3});
  write(folder / "a.spz", gzip(gunzip(text_of(folder / "a.spz"))));  // which says nothing

  LoadOptions options;
  const auto ring = [&](const glm::vec3& centre) {
    options.cameras.clear();
    for (int i = 0; i < 8; ++i) {
      const float angle = 0.7853982f * static_cast<float>(i);
      options.cameras.push_back(look_at(centre + 20.0f * glm::vec3(std::sin(angle), 0, std::cos(angle)),
                                        centre, {0, -1, 0}, 0.9f, 160, 120));
    }
  };
  ring({0, 40, 0});  // where the cloud was written
  const Scene rub = load_scene(folder / "a.spz", options);
  CHECK(rub.taken_axes == SpzAxes::kRub);
  CHECK(rub.cloud.position[0].y > 30);
  CHECK(mentions(rub.axes_note, {"cameras see more"}));
  ring({0, -40, 0});
  const Scene ply = load_scene(folder / "a.spz", options);
  CHECK(ply.taken_axes == SpzAxes::kPly);
  CHECK(ply.cloud.position[0].y < -30);
  const auto first_sh = [](const Scene& s) {
    const auto g = std::ranges::find(s.cloud.file_row, 0u) - s.cloud.file_row.begin();
    return s.cloud.sh_rest_of(static_cast<std::size_t>(g))[0];
  };
  CHECK(first_sh(ply) == -first_sh(rub));
  CHECK(mentions(ply.axes_note, {"cameras see more", "as in a .ply"}));
  ring({0, 0, 0});  // see nothing either way
  const Scene neither = load_scene(folder / "a.spz", options);
  CHECK(neither.taken_axes == SpzAxes::kRub);
  CHECK(mentions(neither.axes_note, {"nothing says otherwise"}));
  options.spz_axes = SpzAxes::kRub;  // the user is asked first
  ring({0, -40, 0});
  options.spz_axes = SpzAxes::kRub;
  CHECK(load_scene(folder / "a.spz", options).taken_axes == SpzAxes::kRub);
}

TEST_CASE("spz axes: where nothing else says them, those in which the scene stands, which can be overruled") {
  const Folder folder;
  const fs::path path = folder / "a.spz";
  for (const bool on_its_head : {false, true}) {
    CAPTURE(on_its_head);
    Scene scene;
    scene.cloud = floor_and_post(on_its_head);
    CHECK(stands(scene.cloud) == !on_its_head);
    save_scene(path, scene, {}, SceneFormat::kSpz, {3});
    // Ours is as it was written, however it stands.
    const Scene ours = load_scene(path);
    CHECK_FALSE(ours.taken_axes);
    CHECK(ours.axes_note.empty());
    CHECK(stands(ours.cloud) == !on_its_head);
    const std::string of_others = gunzip(text_of(path));
    for (const bool packed : {false, true}) {
      write(path, packed ? gzip(of_others) : of_others);
      const Scene got = load_scene(path);
      CHECK(got.taken_axes == (on_its_head ? SpzAxes::kPly : SpzAxes::kRub));
      CHECK(mentions(got.axes_note, {"the scene stands", on_its_head ? "as in a .ply" : "y up"}));
      CHECK(stands(got.cloud) == true);
      CHECK(load_scene(path, asked(SpzAxes::kRub)).taken_axes == SpzAxes::kRub);
      CHECK(stands(load_scene(path, asked(SpzAxes::kRub)).cloud) == !on_its_head);
    }
  }
  // A floor and a ceiling alike, or few Gaussians, say nothing.
  GaussianCloud both = floor_and_post(false);
  for (std::size_t g = 0; g < 400; g += 2) both.position[g].y = -1;
  CHECK_FALSE(stands(both));
  std::vector<std::uint32_t> every_fifth(84);
  for (std::uint32_t i = 0; i < 84; ++i) every_fifth[i] = 5 * i;
  CHECK_FALSE(stands(permuted(floor_and_post(false), every_fifth)));
  // z up: the ground decides. Discs across z, posts above.
  for (const float up : {1.0f, -1.0f}) {
    GaussianCloud yard = floor_and_post(false);
    for (std::size_t g = 0; g < 420; ++g) {
      const glm::vec3 p = yard.position[g];
      yard.position[g] = {p.x, p.z, -up * p.y};
      yard.scale[g] = g < 400 ? glm::vec3(0.1f, 0.1f, 0.001f) : glm::vec3(0.001f, 0.5f, 0.5f);
    }
    CHECK(stands(yard) == (up > 0));
  }
}

QUICK_CASE("spz", "files of others: .spz of both kinds beside the .ply or the numbers they were made from") {
  const fs::path fixtures = fs::path(project_folder()) / "tests" / "data" / "formats";
  // Three Gaussians of a training, written by the format's own library.
  const Scene train = load_scene(fixtures / "three_points.ply");
  const Scene spz = load_scene(fixtures / "three_points.spz");
  REQUIRE(train.cloud.sh_degree == 3);
  std::vector<std::uint32_t> order(3);
  GaussianCloud in_file_order = train.cloud;
  for (std::uint32_t g = 0; g < 3; ++g) order[train.cloud.file_row[g]] = g;
  in_file_order = permuted(train.cloud, order);
  // Its writer keeps 5 bits of degree 1 and 4 of the others: half a step of a byte, then half of 16 of them.
  check_same(in_file_order, spz,
             {1.01f / 8192, 1.01f / 32, 1e-4f, 0.51f / 255, 0.51f / 255 / 0.15f, 8.51f / 128});

  // A grid at y = 0, x and z in {-1, 0}: as (x, z) in the rows of a 2 x 2 square.
  const auto check_grid = [&](const char* name, const LoadOptions& options) {
    const Scene grid = load_scene(fixtures / name, options);
    REQUIRE(grid.cloud.size() == 4);
    for (std::size_t g = 0; g < 4; ++g) {
      const std::uint32_t row = grid.cloud.file_row[g];
      CHECK(grid.cloud.position[g] ==
            glm::vec3(static_cast<float>(row % 2) - 1, 0, static_cast<float>(row / 2) - 1));
      CHECK(grid.cloud.scale[g].x == doctest::Approx(0.1).epsilon(1.0 / 32));
      CHECK(grid.cloud.opacity[g] == doctest::Approx(230.0 / 255));
    }
  };
  check_grid("minimal-v3.spz", {});  // by the format's library, from a .ply's axes
  check_grid("minimal-v4.spz", {});
  check_grid("minimal-v2.spz", asked(SpzAxes::kPly));  // raw numbers
  check_grid("minimal-raw.spz", asked(SpzAxes::kPly));
}
