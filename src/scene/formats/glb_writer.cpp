// Writer of .glb.
#include <algorithm>
#include <array>
#include <limits>
#include <nlohmann/json.hpp>

#include "core/atomic_file.h"
#include "core/error.h"
#include "scene/formats/axis_signs.h"
#include "scene/formats/glb.h"
#include "scene/formats/losses.h"
#include "scene/formats/said_up.h"

namespace splatcut {

namespace {

using nlohmann::json;
using namespace gltf;

// Collects attributes one behind the other, and what the text says of them.
class GlbWriter {
 public:
  // value: number c of Gaussian g.
  template <class Value>
  void add(const std::string& name, const char* type, std::size_t width,
           std::span<const std::uint32_t> gaussians, const Value& value) {
    const std::size_t begin = binary_.size();
    for (const std::uint32_t g : gaussians)
      for (std::size_t c = 0; c < width; ++c) binary_.push_back(value(g, c));
    const std::size_t index = accessors_.size();
    views_.push_back({{"buffer", 0},
                      {"byteOffset", begin * sizeof(float)},
                      {"byteLength", (binary_.size() - begin) * sizeof(float)}});
    accessors_.push_back(
        {{"bufferView", index}, {"componentType", kFloat}, {"count", gaussians.size()}, {"type", type}});
    attributes_[name] = index;
  }
  // Bounds of the first attribute, which glTF wants of positions.
  void set_bounds(const glm::vec3& least, const glm::vec3& most) {
    accessors_[0]["min"] = {least.x, least.y, least.z};
    accessors_[0]["max"] = {most.x, most.y, most.z};
  }
  void write(AtomicFile& out, const std::optional<glm::vec3>& up) const {
    json whole = document();
    if (up) add_up(up, kLeftUpForward, &whole["scenes"][0]["extras"]);
    std::string text = whole.dump();
    text.resize((text.size() + 3) / 4 * 4, ' ');
    const auto text_bytes = static_cast<std::uint32_t>(text.size());
    const auto binary_bytes = static_cast<std::uint32_t>(binary_.size() * sizeof(float));
    const GlbHeader header{
        0x46546c67, 2,
        static_cast<std::uint32_t>(sizeof(GlbHeader) + 2 * sizeof(ChunkHeader)) + text_bytes + binary_bytes};
    const ChunkHeader text_chunk{text_bytes, kJsonChunk}, binary_chunk{binary_bytes, kBinaryChunk};
    out.write(std::as_bytes(std::span(&header, 1)));
    out.write(std::as_bytes(std::span(&text_chunk, 1)));
    out.write(std::as_bytes(std::span(text)));
    out.write(std::as_bytes(std::span(&binary_chunk, 1)));
    out.write(std::as_bytes(std::span(binary_)));
  }

 private:
  json document() const {
    const json extension = {{"kernel", "ellipse"},
                            {"colorSpace", "srgb_rec709_display"},
                            {"projection", "perspective"},
                            {"sortingMethod", "cameraDistance"}};
    const json primitive = {
        {"attributes", attributes_}, {"mode", kPointsMode}, {"extensions", {{kExtension, extension}}}};
    return {{"asset", {{"version", "2.0"}, {"generator", "splatcut"}}},
            {"extensionsUsed", {kExtension}},
            {"scene", 0},
            {"scenes", {{{"nodes", {0}}}}},
            {"nodes", {{{"mesh", 0}}}},
            {"meshes", {{{"primitives", {primitive}}}}},
            {"accessors", accessors_},
            {"bufferViews", views_},
            {"buffers", {{{"byteLength", binary_.size() * sizeof(float)}}}}};
  }

  std::vector<float> binary_;
  json views_ = json::array(), accessors_ = json::array(), attributes_ = json::object();
};

std::uint64_t glb_bytes(const GaussianCloud& cloud, std::size_t gaussians) {
  constexpr std::uint64_t kFloats = 3 + 4 + 3 + 1 + 3;
  return gaussians * (kFloats + cloud.sh_stride()) * sizeof(float) + 1500 + 300 * (cloud.sh_stride() / 3);
}

void add_positions(const GaussianCloud& cloud, std::span<const std::uint32_t> gaussians, GlbWriter* glb) {
  glm::vec3 least(std::numeric_limits<float>::infinity()), most(-least);
  for (const std::uint32_t g : gaussians) {
    const glm::vec3 p = kLeftUpForward.position(cloud.position[g]);
    least = glm::min(least, p);
    most = glm::max(most, p);
  }
  glb->add("POSITION", "VEC3", 3, gaussians, [&](std::uint32_t g, std::size_t c) {
    return kLeftUpForward.position(cloud.position[g])[static_cast<int>(c)];
  });
  glb->set_bounds(least, most);
}

void add_sh(const GaussianCloud& cloud, std::span<const std::uint32_t> gaussians, GlbWriter* glb) {
  const std::array<float, 15> signs = kLeftUpForward.sh();
  const auto coefficients = static_cast<std::size_t>(sh_rest_coefficients(cloud.sh_degree));
  for (int degree = 1; degree <= cloud.sh_degree; ++degree)
    for (int k = 0; k <= 2 * degree; ++k) {
      const auto at = static_cast<std::size_t>(sh_rest_coefficients(degree - 1) + k);
      glb->add(sh_name(degree, k), "VEC3", 3, gaussians, [&](std::uint32_t g, std::size_t c) {
        return cloud.sh_rest_of(g)[c * coefficients + at] * signs[at];
      });
    }
}

Losses glb_losses(const Scene& scene) {
  Losses losses;
  losses.add(origin_left_out(scene));
  losses.add(properties_left_out(scene));
  losses.add(antialiasing_left_out(scene));
  return losses;
}

}  // namespace

std::string write_glb(AtomicFile& out, const Scene& scene, std::span<const std::uint32_t> gaussians,
                      const SaveOptions& options) {
  const GaussianCloud& cloud = scene.cloud;
  if (glb_bytes(cloud, gaussians.size()) > std::numeric_limits<std::uint32_t>::max())
    throw Error(".glb", "cannot hold more than 4 GB", "Choose another format, or export a part");
  GlbWriter glb;
  add_positions(cloud, gaussians, &glb);
  glb.add(attribute_name("ROTATION"), "VEC4", 4, gaussians, [&](std::uint32_t g, std::size_t c) {
    const glm::quat q = kLeftUpForward.rotation(cloud.rotation[g]);
    return std::array<float, 4>{q.x, q.y, q.z, q.w}[c];
  });
  glb.add(attribute_name("SCALE"), "VEC3", 3, gaussians,
          [&](std::uint32_t g, std::size_t c) { return cloud.scale[g][static_cast<int>(c)]; });
  glb.add(attribute_name("OPACITY"), "SCALAR", 1, gaussians,
          [&](std::uint32_t g, std::size_t) { return cloud.opacity[g]; });
  glb.add(sh_name(0, 0), "VEC3", 3, gaussians,
          [&](std::uint32_t g, std::size_t c) { return cloud.f_dc[g][static_cast<int>(c)]; });
  add_sh(cloud, gaussians, &glb);
  glb.write(out, options.up);
  return glb_losses(scene).sentence();
}

FormatPlan plan_glb(const Scene& scene, std::span<const std::uint32_t> gaussians, bool) {
  FormatPlan plan;
  plan.bytes = glb_bytes(scene.cloud, gaussians.size());
  plan.kept =
      "What the scene says of Gaussians in 32 bits, for programs that read glTF with KHR_gaussian_splatting.";
  plan.lost = glb_losses(scene).in_full();
  return plan;
}

}  // namespace splatcut
