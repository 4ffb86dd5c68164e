// USD as text: what is written, by a small parser of such text, against the cloud in its own axes.
#include <array>
#include <cstdlib>
#include <map>

#include "scene/cloud/spherical_harmonics.h"
#include "scene_file_helpers.h"

using namespace splatcut;
using namespace splatcut::testing;

namespace {

struct Attribute {
  std::string type;
  std::vector<float> numbers;  // of arrays: all, without their parentheses
  std::string text;            // of what is no number
};

// The attributes of a prim by name: "TYPE NAME = VALUE", a value in brackets over several lines, uniform or
// not.
std::map<std::string, Attribute> attributes_of(const std::string& usda) {
  std::map<std::string, Attribute> found;
  std::istringstream lines(usda.substr(usda.find("\n{\n") + 3));
  for (std::string line; std::getline(lines, line);) {
    const std::size_t equals = line.find(" = ");
    if (equals == std::string::npos) continue;
    std::istringstream before(line.substr(0, equals));
    std::string type, name, word;
    while (before >> word) {
      if (word == "uniform") continue;
      (type.empty() ? type : name) = word;
    }
    Attribute attribute{type.empty() || name.empty() ? "metadata" : type, {}, line.substr(equals + 3)};
    if (name.empty()) name = type;
    const char* at = attribute.text.c_str();
    while (*at != '\0') {
      char* end = nullptr;
      const float value = std::strtof(at, &end);
      if (end != at && *at != ' ') attribute.numbers.push_back(value);
      at = end != at && *at != ' ' ? end : at + 1;
    }
    found[name] = attribute;
  }
  return found;
}

// As OpenUSD's own example of a renderer evaluates them: the functions of Kerbl et al., b16 = coefficients.
glm::vec3 colour_of(const std::vector<float>& c, std::size_t first, int degree, const glm::vec3& d) {
  const auto [x, y, z] = std::array{d.x, d.y, d.z};
  const std::array<float, 16> b = {0.28209479f,
                                   -0.48860251f * y,
                                   0.48860251f * z,
                                   -0.48860251f * x,
                                   1.09254843f * x * y,
                                   -1.09254843f * y * z,
                                   0.31539157f * (2 * z * z - x * x - y * y),
                                   -1.09254843f * x * z,
                                   0.54627422f * (x * x - y * y),
                                   -0.59004359f * y * (3 * x * x - y * y),
                                   2.89061144f * x * y * z,
                                   -0.45704580f * y * (4 * z * z - x * x - y * y),
                                   0.37317633f * z * (2 * z * z - 3 * x * x - 3 * y * y),
                                   -0.45704580f * x * (4 * z * z - x * x - y * y),
                                   1.44530572f * z * (x * x - y * y),
                                   -0.59004359f * x * (x * x - 3 * y * y)};
  glm::vec3 sum(0.5f);
  for (std::size_t k = 0; k < static_cast<std::size_t>((degree + 1) * (degree + 1)); ++k)
    for (std::size_t channel = 0; channel < 3; ++channel)
      sum[static_cast<int>(channel)] += b[k] * c[first + 3 * k + channel];
  return sum;
}

glm::vec3 our_colour(const GaussianCloud& cloud, std::size_t g, const glm::vec3& direction) {
  float basis[15];
  const auto others = static_cast<std::size_t>(sh_rest_basis(cloud.sh_degree, direction, basis));
  glm::vec3 sum = 0.5f + 0.28209479f * cloud.f_dc[g];
  for (std::size_t channel = 0; channel < 3; ++channel)
    for (std::size_t k = 0; k < others; ++k)
      sum[static_cast<int>(channel)] += basis[k] * cloud.sh_rest_of(g)[channel * others + k];
  return sum;
}

}  // namespace

TEST_CASE("usda: a Gaussian made by hand, every line") {
  const Folder folder;
  Scene scene;
  scene.cloud.resize(1, 1);
  scene.cloud.position[0] = {1, 2.5f, -3};
  scene.cloud.scale[0] = {0.5f, 0.25f, 0.125f};
  scene.cloud.rotation[0] = {0.5f, 0.5f, -0.5f, 0.5f};
  scene.cloud.opacity[0] = 0.75f;
  scene.cloud.f_dc[0] = {0.1f, 0.2f, -0.3f};
  for (std::size_t i = 0; i < 9; ++i)
    scene.cloud.sh_rest[i] = static_cast<float>(i);  // red 0 1 2, green 3 ...
  const SaveReport report = save_scene(folder / "a.usda", scene, {}, SceneFormat::kUsda);
  CHECK(report.loss.empty());
  CHECK(report.bytes == fs::file_size(folder / "a.usda"));
  // y and z point the other way; the half axes of the rotated Gaussian are .125, .5 and .25 along x, y and z.
  CHECK(text_of(folder / "a.usda") == R"(#usda 1.0
(
    defaultPrim = "Gaussians"
    metersPerUnit = 1
    upAxis = "Y"
)

def ParticleField3DGaussianSplat "Gaussians"
{
    float3[] extent = [(0.25, -2.875, 1.5), (1.75, -2.125, 4.5)]
    point3f[] positions = [(1, -2.5, 3)]
    quatf[] orientations = [(0.5, 0.5, 0.5, -0.5)]
    float3[] scales = [(0.5, 0.25, 0.125)]
    float[] opacities = [0.75]
    uniform int radiance:sphericalHarmonicsDegree = 1
    float3[] radiance:sphericalHarmonicsCoefficients = [(0.1, 0.2, -0.3), (-0, -3, -6), (-1, -4, -7), (2, 5, 8)] (
        elementSize = 4
        interpolation = "vertex"
    )
    uniform token projectionModeHint = "perspective"
    uniform token sortingModeHint = "zDepth"
}
)");
  save_scene(folder / "z.usda", scene, {}, SceneFormat::kUsda, {.up = glm::vec3(0, 0, -1)});
  CHECK(text_of(folder / "z.usda").find("upAxis = \"Z\"") != std::string::npos);
}

TEST_CASE("usda: every value is the cloud's, to the bit, and colours are the same from every side") {
  const Folder folder;
  for (int degree = 0; degree <= 3; ++degree) {
    CAPTURE(degree);
    Scene scene;
    scene.cloud = varied_cloud(70, degree);
    save_scene(folder / "a.usda", scene, {}, SceneFormat::kUsda);
    const auto found = attributes_of(text_of(folder / "a.usda"));
    const auto numbers = [&](const char* name, const char* type) {
      REQUIRE(found.contains(name));
      CHECK(found.at(name).type == type);
      return found.at(name).numbers;
    };
    const std::vector<float> positions = numbers("positions", "point3f[]"),
                             rotations = numbers("orientations", "quatf[]"),
                             scales = numbers("scales", "float3[]"),
                             opacities = numbers("opacities", "float[]"),
                             sh = numbers("radiance:sphericalHarmonicsCoefficients", "float3[]"),
                             extent = numbers("extent", "float3[]");
    CHECK(numbers("radiance:sphericalHarmonicsDegree", "int") ==
          std::vector<float>{static_cast<float>(degree)});
    const auto coefficients = static_cast<std::size_t>((degree + 1) * (degree + 1));
    CHECK(numbers("elementSize", "metadata") == std::vector<float>{static_cast<float>(coefficients)});
    REQUIRE(positions.size() == 3 * 70);
    REQUIRE(rotations.size() == 4 * 70);
    REQUIRE(scales.size() == 3 * 70);
    REQUIRE(sh.size() == 3 * coefficients * 70);
    CHECK(opacities == scene.cloud.opacity);
    const glm::mat3 flip(1, 0, 0, 0, -1, 0, 0, 0, -1);
    for (std::size_t g = 0; g < 70; ++g) {
      const glm::vec3 p(positions[3 * g], positions[3 * g + 1], positions[3 * g + 2]);
      CHECK(p == flip * scene.cloud.position[g]);
      CHECK(glm::vec3(scales[3 * g], scales[3 * g + 1], scales[3 * g + 2]) == scene.cloud.scale[g]);
      const glm::quat q(rotations[4 * g], rotations[4 * g + 1], rotations[4 * g + 2], rotations[4 * g + 3]);
      const glm::mat3 turned = flip * glm::mat3_cast(scene.cloud.rotation[g]) * flip;
      for (int c = 0; c < 3; ++c) CHECK(glm::length(glm::mat3_cast(q)[c] - turned[c]) < 1e-6f);
      for (int c = 0; c < 3; ++c) {
        CHECK(extent[static_cast<std::size_t>(c)] < p[c]);
        CHECK(extent[static_cast<std::size_t>(3 + c)] > p[c]);
      }
      const glm::vec3 d = glm::normalize(glm::vec3(0.3f, -0.5f + 0.01f * static_cast<float>(g), 0.7f));
      CHECK(glm::length(colour_of(sh, 3 * coefficients * g, degree, flip * d) -
                        our_colour(scene.cloud, g, d)) < 1e-5f);
    }
  }
}

TEST_CASE("usda: is refused by name when read") {
  const Folder folder;
  Scene scene;
  scene.cloud = varied_cloud(3, 0);
  save_scene(folder / "a.usda", scene, {}, SceneFormat::kUsda);
  CHECK(mentions(refusal(folder / "a.usda"), {"USD", "not read", ".ply"}));
}
