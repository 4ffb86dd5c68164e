// Writer of USD as text with one ParticleField3DGaussianSplat (OpenUSD 26.03 and later, usdVol/schema.usda).
//
// Values are activated: scales are standard deviations, opacities 0 to 1, quaternions unit with w first. The
// coefficients of spherical harmonics stand Gaussian by Gaussian, the constant one first, then those of .ply
// in their order, red green blue together; a colour is 0.5 + their sum, as OpenUSD's own renderer has it.
// elementSize and interpolation are not in the schema, but a common renderer takes the coefficients for none
// without them.
#include <array>
#include <charconv>
#include <limits>
#include <string>
#include <string_view>

#include "core/atomic_file.h"
#include "scene/formats/axis_signs.h"
#include "scene/formats/losses.h"
#include "scene/formats/said_up.h"

namespace splatcut {

namespace {

constexpr AxisSigns kUsdAxes = kRightUpBack;

// Text on its way into a file, a piece at a time.
class UsdaText {
 public:
  explicit UsdaText(AtomicFile& out) : out_(out) {}
  void add(std::string_view text) {
    text_ += text;
    constexpr std::size_t kPiece = 1 << 20;
    if (text_.size() >= kPiece) flush();
  }
  // In the fewest digits that give the same float.
  void add(float value) {
    char digits[32];
    add({digits, std::to_chars(std::begin(digits), std::end(digits), value).ptr});
  }
  // One value, or several in parentheses.
  template <std::size_t kWidth>
  void add(const std::array<float, kWidth>& value) {
    if (kWidth > 1) add("(");
    for (std::size_t i = 0; i < kWidth; ++i) {
      if (i > 0) add(", ");
      add(value[i]);
    }
    if (kWidth > 1) add(")");
  }
  // An attribute with `each` values of every Gaussian; value(g, k) is an array.
  template <class Value>
  void add_array(std::string_view declared, std::span<const std::uint32_t> gaussians, std::size_t each,
                 const Value& value) {
    add("\n    ");
    add(declared);
    std::string_view between = " = [";
    for (const std::uint32_t g : gaussians)
      for (std::size_t k = 0; k < each; ++k, between = ", ") {
        add(between);
        add(value(g, k));
      }
    add(gaussians.empty() ? " = []" : "]");
  }
  void flush() {
    out_.write(std::as_bytes(std::span(text_)));
    text_.clear();
  }

 private:
  AtomicFile& out_;
  std::string text_;
};

std::array<float, 3> numbers(const glm::vec3& v) {
  return {v.x, v.y, v.z};
}

// Three standard deviations around every Gaussian, where the schema has its support end.
std::array<std::array<float, 3>, 2> extent_of(const GaussianCloud& cloud,
                                              std::span<const std::uint32_t> gaussians) {
  constexpr float kReach = 3;
  glm::vec3 least(std::numeric_limits<float>::max()), most(-least);
  for (const std::uint32_t g : gaussians) {
    const glm::mat3 axes = glm::mat3_cast(cloud.rotation[g]);
    glm::vec3 variance(0);
    for (int k = 0; k < 3; ++k) {
      const glm::vec3 axis = axes[k] * cloud.scale[g][k];
      variance += axis * axis;
    }
    const glm::vec3 reach = kReach * glm::sqrt(variance), p = kUsdAxes.position(cloud.position[g]);
    least = glm::min(least, p - reach);
    most = glm::max(most, p + reach);
  }
  return gaussians.empty() ? std::array<std::array<float, 3>, 2>{}
                           : std::array{numbers(least), numbers(most)};
}

std::array<float, 3> coefficient(const GaussianCloud& cloud, std::uint32_t g, std::size_t k) {
  if (k == 0) return numbers(cloud.f_dc[g]);
  static constexpr std::array<float, 15> kSigns = kUsdAxes.sh();
  const std::size_t all = cloud.sh_stride() / 3;
  const std::span<const float> rest = cloud.sh_rest_of(g);
  return {rest[k - 1] * kSigns[k - 1], rest[all + k - 1] * kSigns[k - 1],
          rest[2 * all + k - 1] * kSigns[k - 1]};
}

Losses usda_losses(const Scene& scene) {
  Losses losses;
  losses.add(origin_left_out(scene));
  losses.add(properties_left_out(scene));
  losses.add(antialiasing_left_out(scene));
  return losses;
}

std::string write_usda(AtomicFile& out, const Scene& scene, std::span<const std::uint32_t> gaussians,
                       const SaveOptions& options) {
  const GaussianCloud& cloud = scene.cloud;
  const std::size_t coefficients = 1 + cloud.sh_stride() / 3;
  const auto [least, most] = extent_of(cloud, gaussians);
  UsdaText text(out);
  text.add("#usda 1.0\n(\n    defaultPrim = \"Gaussians\"\n    metersPerUnit = 1\n    upAxis = ");
  constexpr glm::dvec3 kY(0, 1, 0), kZ(0, 0, 1);
  const glm::dvec3 up = options.up ? up_to_say(*options.up, kUsdAxes) : kY;
  text.add(up == kZ ? "\"Z\"" : "\"Y\"");
  text.add("\n)\n\ndef ParticleField3DGaussianSplat \"Gaussians\"\n{\n    float3[] extent = [");
  text.add(least);
  text.add(", ");
  text.add(most);
  text.add("]");
  text.add_array("point3f[] positions", gaussians, 1,
                 [&](std::uint32_t g, std::size_t) { return numbers(kUsdAxes.position(cloud.position[g])); });
  text.add_array("quatf[] orientations", gaussians, 1, [&](std::uint32_t g, std::size_t) {
    const glm::quat q = kUsdAxes.rotation(cloud.rotation[g]);
    return std::array{q.w, q.x, q.y, q.z};
  });
  text.add_array("float3[] scales", gaussians, 1,
                 [&](std::uint32_t g, std::size_t) { return numbers(cloud.scale[g]); });
  text.add_array("float[] opacities", gaussians, 1,
                 [&](std::uint32_t g, std::size_t) { return std::array{cloud.opacity[g]}; });
  text.add("\n    uniform int radiance:sphericalHarmonicsDegree = " + std::to_string(cloud.sh_degree));
  text.add_array("float3[] radiance:sphericalHarmonicsCoefficients", gaussians, coefficients,
                 [&](std::uint32_t g, std::size_t k) { return coefficient(cloud, g, k); });
  text.add(" (\n        elementSize = " + std::to_string(coefficients));
  text.add("\n        interpolation = \"vertex\"\n    )\n");
  text.add("    uniform token projectionModeHint = \"perspective\"\n");
  text.add("    uniform token sortingModeHint = \"zDepth\"\n}\n");
  text.flush();
  Losses losses = usda_losses(scene);
  if (up != kY && up != kZ)
    losses.add("up is said to be +y, which it is not: the format knows +y and +z alone");
  return losses.sentence();
}

FormatPlan plan_usda(const Scene& scene, std::span<const std::uint32_t> gaussians, bool) {
  constexpr std::uint64_t kFloats = 3 + 4 + 3 + 1 + 3, kDigits = 12;  // of a float, with what stands between
  FormatPlan plan;
  plan.bytes = 900 + gaussians.size() * (kFloats + scene.cloud.sh_stride()) * kDigits;
  plan.about = true;
  plan.kept =
      "What the scene says of Gaussians in 32 bits, as text, for programs that read OpenUSD's particle "
      "fields.";
  plan.lost = usda_losses(scene).in_full();
  return plan;
}

}  // namespace

constinit const SceneFormat SceneFormat::kUsda = {
    .name = "usda",
    .extension = ".usda",
    .axes = kUsdAxes,
    .write = write_usda,
    .plan = plan_usda,
};

}  // namespace splatcut
