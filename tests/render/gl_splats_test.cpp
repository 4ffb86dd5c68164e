// The OpenGL picture against the CPU rasteriser, which is the reference.
#include "render/gl_splats.h"

#include <doctest/doctest.h>

#include <chrono>
#include <cmath>
#include <functional>
#include <optional>
#include <semaphore>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.h"
#include "keep_drivers_loaded.h"
#include "places.h"
#include "quick.h"
#include "render/context.h"
#include "render/depth_sorter.h"
#include "scene/camera/camera_file.h"
#include "scene/formats/scene_file.h"
#include "scene/raster/rasterizer.h"
#include "synthetic_cloud.h"

extern "C" splatcut::GlProc OSMesaGetProcAddress(const char* name);  // its header does not go with GL's

using namespace splatcut;
using namespace splatcut::testing;

namespace {

constexpr double kGoalDb = 70;

double psnr_db(const Image<glm::vec4>& gl, const RasterOutput& cpu) {
  double squares = 0;
  for (std::size_t i = 0; i < gl.size(); ++i) {
    const glm::vec4 d = gl.pixels()[i] - glm::vec4(cpu.colour.pixels()[i], cpu.alpha.pixels()[i]);
    squares += glm::dot(d, d);
  }
  return -10 * std::log10(std::max(1e-30, squares / static_cast<double>(4 * gl.size())));
}

Image<glm::vec4> gl_picture(const GaussianCloud& cloud, const Camera& camera) {
  GlSplats splats;
  splats.upload(cloud);
  const auto shared = std::make_shared<const GaussianCloud>(cloud);
  splats.upload_order(depth_order(shared, camera).back_to_front);
  splats.draw(camera);
  return splats.read_picture();
}

void compare(const GaussianCloud& cloud, const Camera& camera) {
  const double db = psnr_db(gl_picture(cloud, camera), rasterize(cloud, camera));
  MESSAGE("GL against CPU: " << db << " dB");
  CHECK(db >= kGoalDb);
}

// A context whose driver was reset.
constexpr unsigned kNoError = 0, kGuiltyContextReset = 0x8253;
unsigned g_status = kNoError;
unsigned told_status() {
  return g_status;
}
GlProc with_told_status(const char* name) {
  if (std::string_view(name).starts_with("glGetGraphicsResetStatus"))
    return reinterpret_cast<GlProc>(told_status);
  return OSMesaGetProcAddress(name);
}

}  // namespace

TEST_CASE("OSMesa: a context that was lost is told with a sentence, one that was not is drawn on") {
  const auto context = make_osmesa_context();
  CHECK_NOTHROW(refuse_lost_context());
  load_gl_functions(with_told_status);
  g_status = kNoError;
  CHECK_NOTHROW(refuse_lost_context());
  g_status = kGuiltyContextReset;
  CHECK_THROWS_WITH_AS(refuse_lost_context(), doctest::Contains("was reset"), Error);
  context->make_current();
  CHECK_NOTHROW(refuse_lost_context());
}

TEST_CASE("OSMesa: random clouds of every SH degree look as on the CPU") {
  const auto context = make_osmesa_context();
  for (int degree = 0; degree <= 3; ++degree) {
    CAPTURE(degree);
    compare(random_cloud(2000, 7 + static_cast<unsigned>(degree), degree), front_camera());
  }
}

TEST_CASE("OSMesa: an antialiased cloud looks as on the CPU") {
  const auto context = make_osmesa_context();
  GaussianCloud cloud = random_cloud(2000, 7, 1, 0.02f);
  cloud.antialiased = true;
  compare(cloud, front_camera());
}

TEST_CASE("OSMesa: the sample looks as on the CPU, near edges and all") {
  const auto context = make_osmesa_context();
  const std::string sample = project_folder() + "/assets/sample/";
  const Scene scene = load_scene(sample + "sample.compressed.ply");
  compare(scene.cloud, limited_to_width(load_cameras(sample + "cameras.json")[3], 320));
}

TEST_CASE("OSMesa: one point of a low-pass looks as by hand and as on the CPU") {
  const auto context = make_osmesa_context();
  const GaussianCloud point = single_splat(2, 1e-6f, 0.8f, glm::vec3(1));
  GlSplats splats;
  splats.upload(point);
  const std::uint32_t only[] = {0};
  splats.upload_order(only);
  for (const float low_pass_px2 : {kWebLowPassPx2, kLowPassPx2, 4.0f}) {
    splats.draw(axis_camera(), {.low_pass_px2 = low_pass_px2});
    const Image<glm::vec4> picture = splats.read_picture();
    const double beside = 0.8 * std::exp(-0.5 / low_pass_px2);
    CHECK(picture.at(16, 16).a == doctest::Approx(0.8).epsilon(1e-4));
    CHECK(picture.at(17, 16).a == doctest::Approx(beside < 1 / 255.0 ? 0 : beside).epsilon(1e-4));
    RasterOptions options;
    options.low_pass_px2 = low_pass_px2;
    CHECK(psnr_db(picture, rasterize(point, axis_camera(), options)) >= kGoalDb);
  }
}

TEST_CASE(
    "OSMesa: a cloud that is shared is drawn alike, in styles of each, also when its first holder went") {
  const auto context = make_osmesa_context();
  const GaussianCloud cloud = single_splat(2, 0.2f, 0.9f, glm::vec3(0.25f));
  const std::uint32_t only[] = {0};
  GlSplats second;
  {
    GlSplats first;
    first.upload(cloud);
    first.upload_order(only);
    first.upload_styles(std::vector<SplatStyle>{{0, 0, 0, 0}});
    second.share(first);
    first.draw(axis_camera());
    CHECK(first.read_picture().at(16, 16) == glm::vec4(0));
  }
  second.upload_order(only);
  second.draw(axis_camera());
  CHECK(psnr_db(second.read_picture(), rasterize(cloud, axis_camera())) >= kGoalDb);
}

TEST_CASE("EGL without a surface draws the same picture") {
  const auto context = make_egl_context();
  keep_drivers_loaded();
  compare(random_cloud(2000, 3, 1), front_camera());
}

TEST_CASE("batches: the 16385th Gaussian is drawn like the first") {
  const auto context = make_osmesa_context();
  GaussianCloud cloud = random_cloud(16400, 5, 0, 0.002f);
  for (std::size_t g = 0; g < cloud.size(); ++g)
    cloud.position[g].z = 1.0f - 1e-5f * static_cast<float>(g);  // later is nearer
  compare(cloud, front_camera());
}

TEST_CASE("a hidden Gaussian leaves no trace and a selected one gives its colour to the tint") {
  const auto context = make_osmesa_context();
  const GaussianCloud cloud = single_splat(2, 0.2f, 0.9f, glm::vec3(0.25f));
  GlSplats splats;
  splats.upload(cloud);
  const std::uint32_t only[] = {0};
  splats.upload_order(only);
  splats.upload_styles(std::vector<SplatStyle>{{255, 0, 0, 0}});
  splats.draw(axis_camera());
  CHECK(splats.read_picture().at(16, 16) == glm::vec4(0));
  splats.upload_styles(std::vector<SplatStyle>{{255, 0, 0, 255}});
  splats.draw(axis_camera());
  CHECK(splats.read_picture().at(16, 16).a == doctest::Approx(0.9));
  splats.resolve({.background = glm::vec3(0), .tint_strength = 1, .outline_strength = 0});
  std::vector<std::uint8_t> rgba(33 * 33 * 4);
  glBindTexture(GL_TEXTURE_2D, splats.picture_texture());
  glGetTexImage(GL_TEXTURE_2D, 0, GL_RGBA, GL_UNSIGNED_BYTE, rgba.data());
  const std::uint8_t* middle = &rgba[4 * (16 * 33 + 16)];
  // colour 0.225 under a red of strength 0.9: red 0.1 * 0.225 + 0.9, green 0.1 * 0.225.
  CHECK(middle[0] == doctest::Approx(255 * 0.9225).epsilon(0.01));
  CHECK(middle[1] == doctest::Approx(255 * 0.0225).epsilon(0.2));
}

TEST_CASE("a shaded tint covers pixels that are mostly selected, and leaves the others as they are") {
  const auto context = make_osmesa_context();
  for (const float share : {0.3f, 0.9f}) {
    CAPTURE(share);
    const GaussianCloud cloud = single_splat(2, 0.2f, share, glm::vec3(0.25f));
    GlSplats splats;
    splats.upload(cloud);
    const std::uint32_t only[] = {0};
    splats.upload_order(only);
    splats.upload_styles(std::vector<SplatStyle>{{255, 0, 0, 255}});
    splats.draw(axis_camera());
    splats.resolve({.background = glm::vec3(0), .tint_strength = 1, .tint_shaded = true});
    std::vector<std::uint8_t> rgba(33 * 33 * 4);
    glBindTexture(GL_TEXTURE_2D, splats.picture_texture());
    glGetTexImage(GL_TEXTURE_2D, 0, GL_RGBA, GL_UNSIGNED_BYTE, rgba.data());
    const std::uint8_t* middle = &rgba[4 * (16 * 33 + 16)];
    const double grey = 0.25 * share, red = 0.7 + 0.5 * grey;
    CHECK(middle[0] == doctest::Approx(255 * (share < 0.5f ? grey : red)).epsilon(0.02));
    CHECK(middle[1] == doctest::Approx(255 * (share < 0.5f ? grey : 0)).epsilon(0.02));
  }
}

TEST_CASE("a checker stands behind the splats, its squares as large as asked, from the top left") {
  const auto context = make_osmesa_context();
  const GaussianCloud cloud = single_splat(2, 0.2f, 0.9f, glm::vec3(0.25f));
  GlSplats splats;
  splats.upload(cloud);
  const std::uint32_t only[] = {0};
  splats.upload_order(only);
  splats.draw(axis_camera());
  const Image<glm::vec4> drawn = splats.read_picture();
  for (const float side_px : {4.0f, 5.5f}) {
    splats.resolve({.background = glm::vec3(1, 0, 1), .checker_px = side_px});
    std::vector<std::uint8_t> rgba(33 * 33 * 4);
    glBindTexture(GL_TEXTURE_2D, splats.picture_texture());
    glGetTexImage(GL_TEXTURE_2D, 0, GL_RGBA, GL_UNSIGNED_BYTE, rgba.data());
    double farthest = 0;
    for (int y = 0; y < 33; ++y)
      for (int x = 0; x < 33; ++x) {
        const double across = std::floor((x + 0.5) / side_px), down = std::floor((y + 0.5) / side_px);
        const double behind = std::fmod(across + down, 2) == 0 ? 0.62 : 0.42;
        const glm::vec4 over = drawn.at(x, y);
        const double expected = 255 * (over.r + (1 - over.a) * behind);
        farthest = std::max(
            farthest,
            std::abs(expected - rgba[4u * (33u * static_cast<unsigned>(y) + static_cast<unsigned>(x))]));
      }
    CHECK(farthest <= 1);
  }
}

QUICK_CASE("depth sorter",
           "depth order: back to front, equal depths in reverse, what is behind the camera left out") {
  GaussianCloud cloud;
  cloud.resize(5, 0);
  const float z[] = {3, 1, -1, 3, 2};
  for (int g = 0; g < 5; ++g) cloud.position[g] = {0, 0, z[g]};
  const auto shared = std::make_shared<const GaussianCloud>(cloud);
  CHECK(depth_order(shared, axis_camera()).back_to_front == std::vector<std::uint32_t>{3, 0, 4, 1});
}

QUICK_CASE("depth sorter", "sorter: the last request is answered") {
  const auto cloud = std::make_shared<const GaussianCloud>(random_cloud(20000, 1));
  std::counting_semaphore<> done(0);
  DepthSorter sorter([&] { done.release(); });
  Camera camera = front_camera();
  for (int i = 0; i < 50; ++i) {
    camera.camera_from_world_translation.z += 0.01f;
    sorter.request(cloud, camera);
  }
  const auto expected = depth_order(cloud, camera).back_to_front;
  std::optional<DepthOrder> order;
  while (!order || order->back_to_front != expected) {
    REQUIRE(done.try_acquire_for(std::chrono::seconds(60)));
    if (auto newer = sorter.take()) order = std::move(newer);
  }
  CHECK(order->cloud == cloud);
}
