// Reader of glTF with KHR_gaussian_splatting: .glb, and .gltf with its .bin beside it. The nodes' places
// count, spherical harmonics turn with them. Buffers may stand in the text (data: base64). Not read:
// extensions that are required and not known, linear colours, kernels other than the ellipse.
#include "scene/formats/glb.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <glm/gtc/type_ptr.hpp>
#include <limits>
#include <map>
#include <optional>

#include "core/error.h"
#include "core/json_file.h"
#include "scene/cloud/quantise.h"
#include "scene/cloud/spherical_harmonics.h"
#include "scene/formats/axis_signs.h"
#include "scene/formats/decode.h"
#include "scene/formats/gltf_file.h"
#include "scene/formats/said_up.h"

namespace splatcut {

namespace {

using nlohmann::json;
using namespace gltf;

std::size_t bytes_of_component(int type) {
  return type == kInt8 || type == kUint8 ? 1 : type == kInt16 || type == kUint16 ? 2 : 4;
}

std::size_t number_or_0(const json& part, const char* name) {
  return part.contains(name) ? whole_number(part.at(name)) : 0;
}

// Numbers of an attribute, `width` for each Gaussian.
struct Accessor {
  const std::byte* data = nullptr;
  std::size_t stride = 0;
  int type = kFloat;
  bool normalised = false;

  float value(std::size_t row, std::size_t c) const {
    const std::byte* at = data + row * stride + c * bytes_of_component(type);
    switch (type) {
      case kInt8:
        return scaled(load<std::int8_t>(at), 127);
      case kUint8:
        return scaled(load<std::uint8_t>(at), 255);
      case kInt16:
        return scaled(load<std::int16_t>(at), 32767);
      case kUint16:
        return scaled(load<std::uint16_t>(at), 65535);
      default:
        return load<float>(at);
    }
  }
  float scaled(int number, int most) const {
    const auto v = static_cast<float>(number);
    return normalised ? std::max(-1.0f, v / static_cast<float>(most)) : v;
  }
  glm::vec3 vec3(std::size_t row) const { return {value(row, 0), value(row, 1), value(row, 2)}; }
};

struct Primitive {
  std::size_t first_row = 0, rows = 0;
  Accessor position, rotation, scale, opacity, f_dc;
  std::vector<Accessor> sh;
  bool log_scale = false;
  glm::mat4 scene_from_local{1};
  glm::quat turn{1, 0, 0, 0};
  std::optional<ShTurn> sh_turn;  // in our axes; none where no node turns it
  float size = 1;
  int degree = 0;
};

// Checks that all numbers lie in the buffer.
Accessor accessor_of(const MappedFile& file, const Gltf& gltf, const json& attributes,
                     const std::string& name, std::size_t width, std::size_t* rows) {
  const auto refuse = [&](const std::string& what) {
    throw Error(file.path().string(), fmt::format("the attribute {} {}", name, what));
  };
  if (!attributes.contains(name)) refuse("is missing");
  const json& about = gltf.text.at("accessors").at(whole_number(attributes.at(name)));
  if (about.contains("sparse") || !about.contains("bufferView"))
    refuse("is sparse or packed, which is not read");
  const std::map<std::string, std::size_t> widths = {{"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4}};
  const auto said = widths.find(about.at("type").get<std::string>());
  if (said == widths.end() || said->second != width) refuse(fmt::format("does not have {} numbers", width));
  const json& view = gltf.text.at("bufferViews").at(whole_number(about.at("bufferView")));
  const std::span<const std::byte> buffer = gltf.buffers.at(number_or_0(view, "buffer"));
  Accessor accessor;
  accessor.type = static_cast<int>(std::min<std::size_t>(whole_number(about.at("componentType")), 1 << 20));
  accessor.normalised = about.value("normalized", false);
  if (accessor.type != kFloat && (accessor.type < kInt8 || accessor.type > kUint16))
    refuse(fmt::format("has numbers of type {}, which is not read", accessor.type));
  const std::size_t row_bytes = width * bytes_of_component(accessor.type);
  accessor.stride = view.contains("byteStride") ? whole_number(view.at("byteStride")) : row_bytes;
  const auto count = whole_number(about.at("count"));
  const auto offset_in = [&](const json& part) {
    return std::min(number_or_0(part, "byteOffset"), buffer.size() + 1);
  };
  const std::size_t begin = offset_in(view) + offset_in(about);
  if (*rows == 0) *rows = count;
  if (count != *rows) refuse(fmt::format("has {} rows, others have {}", count, *rows));
  if (count == 0 || accessor.stride < row_bytes || begin > buffer.size() ||
      (buffer.size() - begin) / accessor.stride + 1 < count ||
      buffer.size() - begin < (count - 1) * accessor.stride + row_bytes)
    refuse(fmt::format("reaches beyond the {} bytes of its buffer: truncated", buffer.size()));
  accessor.data = buffer.data() + begin;
  return accessor;
}

void check_extension(const MappedFile& file, const json& extension) {
  const auto refuse = [&](const std::string& what, const char* remedy) {
    throw Error(file.path().string(), what, remedy);
  };
  if (extension.contains("extensions"))
    refuse("its Gaussians are packed by an extension of the extension", "Unpack it, or export .ply or .spz");
  if (extension.value("kernel", "ellipse") != "ellipse")
    refuse("its Gaussians are no ellipses but \"" + extension.value("kernel", "") + "\"", "Export .ply");
  if (extension.value("colorSpace", "").starts_with("lin"))
    refuse("its colours are linear, those of a scene are sRGB",
           "Export with the colour space srgb_rec709_display");
}

Primitive primitive_of(const MappedFile& file, const Gltf& gltf, const json& about) {
  check_extension(file, about.at("extensions").at(kExtension));
  const json& attributes = about.at("attributes");
  Primitive p;
  const auto bound = [&](const std::string& name, std::size_t width) {
    return accessor_of(file, gltf, attributes, name, width, &p.rows);
  };
  p.position = bound("POSITION", 3);
  p.rotation = bound(attribute_name("ROTATION"), 4);
  p.scale = bound(attribute_name("SCALE"), 3);
  p.opacity = bound(attribute_name("OPACITY"), 1);
  p.f_dc = bound(sh_name(0, 0), 3);
  for (; p.degree < 3 && attributes.contains(sh_name(p.degree + 1, 0)); ++p.degree)
    for (int k = 0; k < 2 * p.degree + 3; ++k) p.sh.push_back(bound(sh_name(p.degree + 1, k), 3));
  for (std::size_t row = 0; row < p.rows && !p.log_scale; ++row) {
    const glm::vec3 scale = p.scale.vec3(row);
    p.log_scale = std::min({scale.x, scale.y, scale.z}) < 0;
  }
  return p;
}

glm::mat4 matrix_of(const json& node) {
  if (node.contains("matrix")) {
    const auto m = node.at("matrix").get<std::array<float, 16>>();
    return glm::make_mat4(m.data());
  }
  const auto t = node.value("translation", std::array<float, 3>{0, 0, 0});
  const auto r = node.value("rotation", std::array<float, 4>{0, 0, 0, 1});
  const auto s = node.value("scale", std::array<float, 3>{1, 1, 1});
  glm::mat4 m = glm::mat4_cast(glm::quat(r[3], r[0], r[1], r[2]));
  for (int c = 0; c < 3; ++c) m[c] *= s[static_cast<std::size_t>(c)];
  m[3] = {t[0], t[1], t[2], 1};
  return m;
}

// Moves, turns and scales the primitive; refuses what Gaussians cannot follow.
void place(const MappedFile& file, const glm::mat4& scene_from_local, Primitive* p) {
  constexpr float kAlike = 1e-4f;
  glm::mat3 linear(scene_from_local);
  const float size = std::cbrt(std::abs(glm::determinant(linear)));
  if (!(size > 0) || !std::isfinite(size)) throw Error(file.path().string(), "a node has the size 0");
  linear = linear * (1 / size);
  const glm::mat3 off = glm::transpose(linear) * linear - glm::mat3(1);
  bool even = glm::determinant(linear) > 0, turned = false;
  for (int c = 0; c < 3; ++c) {
    even = even && glm::length(off[c]) < kAlike;
    turned = turned || glm::length(linear[c] - glm::mat3(1)[c]) > kAlike;
  }
  if (!even)
    throw Error(file.path().string(), "a node stretches or mirrors its Gaussians",
                "Apply the transform in the program that wrote it");
  p->scene_from_local = scene_from_local;
  p->size = size;
  if (!turned) return;
  p->turn = glm::normalize(glm::quat_cast(linear));
  p->sh_turn.emplace(glm::mat3_cast(kLeftUpForward.rotation(p->turn)));
}

struct GltfRows {
  std::vector<Primitive> primitives;
  int degree = 0;
  std::array<float, 15> sh_signs = kLeftUpForward.sh();

  const Primitive& primitive_of_row(std::size_t* row) const {
    const auto next = std::ranges::upper_bound(primitives, *row, {}, &Primitive::first_row);
    const Primitive& p = *std::prev(next);
    *row -= p.first_row;
    return p;
  }
  static glm::vec3 scale(const Primitive& p, std::size_t row) {
    const glm::vec3 s = p.scale.vec3(row);
    return p.size * (p.log_scale ? glm::exp(s) : s);
  }
  static glm::quat rotation(const Primitive& p, std::size_t row) {
    return {p.rotation.value(row, 3), p.rotation.value(row, 0), p.rotation.value(row, 1),
            p.rotation.value(row, 2)};
  }
  glm::vec3 position(std::size_t index) const {
    const Primitive& p = primitive_of_row(&index);
    const glm::vec3 s = scale(p, index);
    const glm::quat q = rotation(p, index);
    const float norm_squared = glm::dot(q, q);
    const bool good = norm_squared > 0 && std::isfinite(norm_squared) && is_within_reach(s) &&
                      is_finite(p.f_dc.vec3(index)) && !std::isnan(p.opacity.value(index, 0)) &&
                      std::ranges::all_of(p.sh, [&](const Accessor& a) { return is_finite(a.vec3(index)); });
    if (!good) return kDroppedRow;
    return kLeftUpForward.position(glm::vec3(p.scene_from_local * glm::vec4(p.position.vec3(index), 1)));
  }
  void decode(std::size_t index, GaussianCloud& cloud, std::size_t g) const {
    const Primitive& p = primitive_of_row(&index);
    cloud.scale[g] = scale(p, index);
    cloud.rotation[g] = kLeftUpForward.rotation(p.turn * glm::normalize(rotation(p, index)));
    cloud.f_dc[g] = p.f_dc.vec3(index);
    cloud.opacity[g] = std::clamp(p.opacity.value(index, 0), 0.0f, 1.0f);
    const auto coefficients = static_cast<std::size_t>(sh_rest_coefficients(degree));
    float* rest = cloud.sh_rest.data() + g * cloud.sh_stride();
    for (std::size_t k = 0; k < p.sh.size(); ++k)
      for (std::size_t c = 0; c < 3; ++c) rest[c * coefficients + k] = p.sh[k].value(index, c) * sh_signs[k];
    if (p.sh_turn) p.sh_turn->apply({rest, cloud.sh_stride()}, degree);
  }
};

// Collects every primitive with Gaussians below a node.
class Collector {
 public:
  Collector(const MappedFile& file, const Gltf& gltf)
      : file_(file),
        gltf_(gltf),
        seen_(gltf.text.at("nodes").size(), false),
        file_bytes_(file.bytes().size()) {
    for (const auto& beside : gltf.beside) file_bytes_ += beside->bytes().size();
  }

  void collect(std::size_t node_index, const glm::mat4& parent, int depth) {
    constexpr int kDeepest = 1000;
    const json& node = gltf_.text.at("nodes").at(node_index);
    if (seen_[node_index] || depth > kDeepest)
      throw Error(file_.path().string(), "its nodes are no tree: one hangs below two, or too deep");
    seen_[node_index] = true;
    const glm::mat4 here = parent * matrix_of(node);
    if (node.contains("mesh")) add_mesh(whole_number(node.at("mesh")), here);
    for (const json& child : node.value("children", json::array()))
      collect(whole_number(child), here, depth + 1);
  }

  GltfRows rows;
  std::size_t count = 0;

 private:
  void add_mesh(std::size_t index, const glm::mat4& scene_from_local) {
    for (const json& about : gltf_.text.at("meshes").at(index).at("primitives")) {
      if (!about.value("extensions", json::object()).contains(kExtension)) continue;
      Primitive p = primitive_of(file_, gltf_, about);
      place(file_, scene_from_local, &p);
      p.first_row = count;
      count += p.rows;
      rows.degree = std::max(rows.degree, p.degree);
      check_cloud_size(file_.path(), file_bytes_, count, rows.degree);  // nodes can share a mesh
      rows.primitives.push_back(std::move(p));
    }
  }

  const MappedFile& file_;
  const Gltf& gltf_;
  std::vector<bool> seen_;
  std::size_t file_bytes_;
};

// Of the scene that is shown.
SaidUp up_said(const json& text) {
  if (!text.contains("scenes") || text.at("scenes").empty()) return {};
  const json& shown = text.at("scenes").at(number_or_0(text, "scene"));
  return shown.contains("extras") ? up_from_json(shown.at("extras")) : SaidUp();
}

// Without scenes, the nodes that hang below none.
std::vector<std::size_t> roots_of(const json& text) {
  if (!text.contains("scenes") || text.at("scenes").empty()) {
    std::vector<bool> below(text.at("nodes").size(), false);
    for (const json& node : text.at("nodes"))
      for (const json& child : node.value("children", json::array())) below.at(whole_number(child)) = true;
    std::vector<std::size_t> roots;
    for (std::size_t i = 0; i < below.size(); ++i)
      if (!below[i]) roots.push_back(i);
    return roots;
  }
  const json& scenes = text.at("scenes");
  std::vector<std::size_t> roots;
  for (const json& node : scenes.at(number_or_0(text, "scene")).value("nodes", json::array()))
    roots.push_back(whole_number(node));
  return roots;
}

void read_glb(const MappedFile& file, const LoadOptions&, Scene& scene, const Job& job) {
  try {
    const Gltf gltf(file);
    for (const auto& beside : gltf.beside) scene.files.push_back(beside->path());
    Collector found(file, gltf);
    for (const std::size_t root : roots_of(gltf.text)) found.collect(root, glm::mat4(1), 0);
    if (found.count == 0)
      throw Error(file.path().string(), "holds no Gaussians (KHR_gaussian_splatting), only meshes or nothing",
                  "Export the trained scene, not a mesh of it");
    if (found.count > std::numeric_limits<std::uint32_t>::max())
      throw Error(file.path().string(),
                  fmt::format("{} Gaussians are more than can be handled", found.count));
    decode_rows(found.rows, found.count, found.rows.degree, scene, job);
    take_up(up_said(gltf.text), kLeftUpForward, &scene);
  } catch (const json::exception& error) {
    throw Error(file.path().string(),
                fmt::format("is not glTF as its standard has it ({})", fault_of(error)));
  } catch (const std::out_of_range&) {
    throw Error(file.path().string(), "is not glTF as its standard has it: a buffer is missing");
  }
}

bool is_gltf(const MappedFile& file) {
  return begins_with(file, kGlbMark);
}

}  // namespace

constinit const SceneFormat SceneFormat::kGlb = {
    .name = "glb",
    .extension = ".glb",
    .also = ".gltf",
    .axes = kLeftUpForward,
    .recognises = is_gltf,
    .read = read_glb,
    .write = write_glb,
    .plan = plan_glb,
};

}  // namespace splatcut
