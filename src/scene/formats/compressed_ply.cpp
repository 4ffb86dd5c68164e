// Compressed .ply of PlayCanvas/SuperSplat: 256 Gaussians share the bounds in a row of the element "chunk";
// each is four uint32: position 11-10-11 bits, rotation 2+10+10+10 (smallest three), scale (logarithm)
// 11-10-11, colour 8-8-8 with linear opacity 8; the optional element "sh" has a byte per coefficient.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>

#include "core/atomic_file.h"
#include "core/error.h"
#include "scene/cloud/chunk_order.h"
#include "scene/cloud/moved_far.h"
#include "scene/cloud/quantise.h"
#include "scene/formats/decode.h"
#include "scene/formats/losses.h"
#include "scene/formats/said_up.h"
#include "scene/packing/ply_header.h"

namespace splatcut {

namespace {

constexpr std::size_t kChunkRows = 256;
constexpr std::array<const char*, 18> kBounds{
    "min_x",       "min_y",       "min_z",       "max_x",       "max_y",       "max_z",
    "min_scale_x", "min_scale_y", "min_scale_z", "max_scale_x", "max_scale_y", "max_scale_z",
    "min_r",       "min_g",       "min_b",       "max_r",       "max_g",       "max_b"};
constexpr std::size_t kBoundsWithoutColour = 12;
constexpr std::array<const char*, 4> kPacked{"packed_position", "packed_rotation", "packed_scale",
                                             "packed_color"};
constexpr float kShRange = 8.0f;  // bytes cover -4 .. 4

struct Bounds {
  glm::vec3 min{std::numeric_limits<float>::infinity()}, max{-std::numeric_limits<float>::infinity()};
  void add(const glm::vec3& v) { min = glm::min(min, v), max = glm::max(max, v); }
  glm::vec3 at(const glm::vec3& fraction) const { return min + fraction * (max - min); }
  glm::vec3 fraction_of(const glm::vec3& v) const {
    return (v - min) / glm::max(max - min, glm::vec3(1e-20f));
  }
};
struct Chunk {
  Bounds position, log_scale, colour;
};

glm::vec3 unpack_11_10_11(std::uint32_t v) {
  return {from_steps(v >> 21, 11), from_steps(v >> 11, 10), from_steps(v, 11)};
}
std::uint32_t pack_11_10_11(const glm::vec3& v) {
  return to_steps(v.x, 11) << 21 | to_steps(v.y, 10) << 11 | to_steps(v.z, 11);
}

// Components in the order w x y z; the top two bits say which is the largest and left out.
glm::quat unpack_rotation(std::uint32_t v) {
  const std::uint32_t largest = v >> 30;
  std::array<float, 4> q{};
  float sum = 0;
  int shift = 20;
  for (std::uint32_t i = 0; i < 4; ++i) {
    if (i == largest) continue;
    q[i] = (from_steps(v >> shift, 10) - 0.5f) * std::sqrt(2.0f);
    sum += q[i] * q[i];
    shift -= 10;
  }
  q[largest] = std::sqrt(std::max(0.0f, 1.0f - sum));
  return glm::normalize(glm::quat(q[0], q[1], q[2], q[3]));
}
std::uint32_t pack_rotation(const glm::quat& rotation) {
  const std::array<float, 4> q{rotation.w, rotation.x, rotation.y, rotation.z};
  const std::uint32_t largest = largest_of(q);
  const float sign = q[largest] < 0 ? -1.0f : 1.0f;
  std::uint32_t packed = largest;
  for (std::uint32_t i = 0; i < 4; ++i)
    if (i != largest) packed = packed << 10 | to_steps(sign * q[i] / std::sqrt(2.0f) + 0.5f, 10);
  return packed;
}

struct PackedRows {
  std::vector<Chunk> chunks;
  const std::byte* vertex = nullptr;
  std::size_t vertex_bytes = 0;
  std::array<std::size_t, 4> offset{};
  const std::byte* sh = nullptr;
  std::size_t sh_bytes = 0;
  std::vector<std::size_t> sh_offset;  // empty: no SH

  std::uint32_t word(std::size_t row, std::size_t field) const {
    return load<std::uint32_t>(vertex + row * vertex_bytes + offset[field]);
  }
  glm::vec3 log_scale(std::size_t row) const {
    return chunks[row / kChunkRows].log_scale.at(unpack_11_10_11(word(row, 2)));
  }
  glm::vec3 colour(std::size_t row) const {
    const std::uint32_t v = word(row, 3);
    return chunks[row / kChunkRows].colour.at(
        {from_steps(v >> 24, 8), from_steps(v >> 16, 8), from_steps(v >> 8, 8)});
  }
  glm::vec3 position(std::size_t row) const {
    if (!is_within_reach(glm::exp(log_scale(row))) || !is_finite(colour(row))) return kDroppedRow;
    return chunks[row / kChunkRows].position.at(unpack_11_10_11(word(row, 0)));
  }
  void decode(std::size_t row, GaussianCloud& cloud, std::size_t g) const {
    cloud.scale[g] = glm::exp(log_scale(row));
    cloud.rotation[g] = unpack_rotation(word(row, 1));
    cloud.f_dc[g] = f_dc_from_colour(colour(row));
    cloud.opacity[g] = from_steps(word(row, 3), 8);
    float* rest = cloud.sh_rest.data() + g * sh_offset.size();
    for (const std::size_t at : sh_offset)
      *rest++ = ((byte_at(sh + row * sh_bytes + at) + 0.5f) / 256.0f - 0.5f) * kShRange;
  }
};

const PlyProperty& typed_property(const std::filesystem::path& path, const PlyElement& element,
                                  const char* name, PlyType type) {
  const PlyProperty& property = required_property(path, element, name);
  if (property.type == type) return property;
  throw Error(path.string(), fmt::format("the property \"{}\" of the element \"{}\" is {} instead of {}",
                                         name, element.name, name_of(property.type), name_of(type)));
}

std::vector<Chunk> read_chunks(const MappedFile& file, const PlyElement& element) {
  const bool has_colour = element.find(kBounds[kBoundsWithoutColour]) != nullptr;
  const std::size_t fields = has_colour ? kBounds.size() : kBoundsWithoutColour;
  std::array<std::size_t, kBounds.size()> offset{};
  for (std::size_t f = 0; f < fields; ++f)
    offset[f] = typed_property(file.path(), element, kBounds[f], PlyType::kFloat32).offset;
  const std::span<const std::byte> bytes = element_bytes(file.path(), file.bytes(), element);
  std::vector<Chunk> chunks(element.count);
  for (std::size_t c = 0; c < chunks.size(); ++c) {
    const std::byte* row = bytes.data() + c * element.row_bytes;
    const auto vec3 = [&](std::size_t f) {
      return glm::vec3(load<float>(row + offset[f]), load<float>(row + offset[f + 1]),
                       load<float>(row + offset[f + 2]));
    };
    chunks[c] = {{vec3(0), vec3(3)}, {vec3(6), vec3(9)}, {glm::vec3(0), glm::vec3(1)}};
    if (has_colour) chunks[c].colour = {vec3(12), vec3(15)};
  }
  return chunks;
}

// Binds the element "sh"; returns the degree.
int bind_sh(const MappedFile& file, const PlyElement& sh, std::size_t rows, PackedRows& packed) {
  int degree = 0;
  while (degree <= 3 && 3 * static_cast<std::size_t>(sh_rest_coefficients(degree)) != sh.properties.size())
    ++degree;
  if (degree > 3)
    throw Error(
        file.path().string(),
        fmt::format("the element \"sh\" has {} properties; 9, 24 or 45 are possible", sh.properties.size()));
  if (sh.count != rows)
    throw Error(file.path().string(),
                fmt::format("the element \"sh\" has {} rows for {} Gaussians", sh.count, rows));
  packed.sh = element_bytes(file.path(), file.bytes(), sh).data();
  packed.sh_bytes = sh.row_bytes;
  for (std::size_t i = 0; i < sh.properties.size(); ++i)
    packed.sh_offset.push_back(
        typed_property(file.path(), sh, fmt::format("f_rest_{}", i).c_str(), PlyType::kUint8).offset);
  return degree;
}

constexpr Reach kLogScales{-20, 20};  // as SuperSplat: a scale of 0 must not spoil the whole chunk

glm::vec3 log_scale_of(const GaussianCloud& cloud, std::uint32_t g) {
  return glm::clamp(glm::log(cloud.scale[g]), kLogScales.least, kLogScales.most);
}

Chunk chunk_of(const GaussianCloud& cloud, std::span<const std::uint32_t> gaussians) {
  Chunk chunk;
  for (const std::uint32_t g : gaussians) {
    chunk.position.add(cloud.position[g]);
    chunk.log_scale.add(log_scale_of(cloud, g));
    chunk.colour.add(colour_from_f_dc(cloud.f_dc[g]));
  }
  return chunk;
}

std::array<std::uint32_t, 4> pack(const GaussianCloud& cloud, std::uint32_t g, const Chunk& chunk) {
  const glm::vec3 colour = chunk.colour.fraction_of(colour_from_f_dc(cloud.f_dc[g]));
  return {pack_11_10_11(chunk.position.fraction_of(cloud.position[g])), pack_rotation(cloud.rotation[g]),
          pack_11_10_11(chunk.log_scale.fraction_of(log_scale_of(cloud, g))),
          to_steps(colour.x, 8) << 24 | to_steps(colour.y, 8) << 16 | to_steps(colour.z, 8) << 8 |
              to_steps(cloud.opacity[g], 8)};
}

std::string chunked_header(std::size_t gaussians, std::size_t chunks, const GaussianCloud& cloud,
                           const SaveOptions& options) {
  const std::size_t sh = cloud.sh_stride();
  std::string header = fmt::format("ply\nformat binary_little_endian 1.0\n{}{}element chunk {}\n",
                                   antialiasing_comment(cloud.antialiased), up_comment(options.up), chunks);
  for (const char* name : kBounds) header += fmt::format("property float {}\n", name);
  header += fmt::format("element vertex {}\n", gaussians);
  for (const char* name : kPacked) header += fmt::format("property uint {}\n", name);
  if (sh > 0) header += fmt::format("element sh {}\n", gaussians);
  for (std::size_t i = 0; i < sh; ++i) header += fmt::format("property uchar f_rest_{}\n", i);
  return header + "end_header\n";
}

bool is_compressed_ply(const MappedFile& file) {
  if (!has_ply_mark(file)) return false;
  const PlyHeader header = parse_ply_header(file.path(), file.bytes());
  const PlyElement* vertex = header.find("vertex");
  return header.find("chunk") && vertex && vertex->find(kPacked[0]);
}

void read_compressed_ply(const MappedFile& file, const LoadOptions&, Scene& scene, const Job& job) {
  const PlyHeader header = parse_ply_header(file.path(), file.bytes());
  const PlyElement *chunk = header.find("chunk"), *vertex = header.find("vertex");
  if (!chunk || !vertex)
    throw Error(file.path().string(),
                "is not a compressed .ply: the elements \"chunk\" and \"vertex\" are wanted");
  if (header.ascii)
    throw Error(file.path().string(), "is a compressed .ply written as text, which holds no packed numbers");
  PackedRows rows;
  for (std::size_t f = 0; f < kPacked.size(); ++f)
    rows.offset[f] = typed_property(file.path(), *vertex, kPacked[f], PlyType::kUint32).offset;
  rows.chunks = read_chunks(file, *chunk);
  rows.vertex = element_bytes(file.path(), file.bytes(), *vertex).data();
  rows.vertex_bytes = vertex->row_bytes;
  if (vertex->count > std::numeric_limits<std::uint32_t>::max() ||
      (vertex->count - 1) / kChunkRows >= chunk->count)
    throw Error(file.path().string(),
                fmt::format("{} chunks cannot hold {} Gaussians", chunk->count, vertex->count));
  const PlyElement* sh = header.find("sh");
  const int degree = sh ? bind_sh(file, *sh, vertex->count, rows) : 0;
  scene.cloud.antialiased = header.antialiased();
  decode_rows(rows, vertex->count, degree, scene, job);
  take_up(up_from_header(header), {}, &scene);
}

Losses compressed_ply_losses(const Scene& scene, std::span<const std::uint32_t> gaussians) {
  constexpr float kHalfStep = 0.5f / 256;
  constexpr Reach kShBytes{(-0.5f - kHalfStep) * kShRange, (0.5f + kHalfStep) * kShRange};
  Losses losses;
  losses.add(
      "positions are rounded to 11 bits within groups of 256 Gaussians, whose order changes, all other "
      "values to 8 to 11 bits");
  losses.add(clamped_log_scales(scene.cloud, gaussians, kLogScales));
  losses.add(clamped_sh(scene.cloud, gaussians, kShBytes));
  losses.add(origin_left_out(scene));
  losses.add(properties_left_out(scene));
  return losses;
}

std::string write_compressed_ply(AtomicFile& out, const Scene& scene,
                                 std::span<const std::uint32_t> gaussians, const SaveOptions& options) {
  const GaussianCloud& cloud = scene.cloud;
  const std::vector<std::uint32_t> order = in_order_of_chunks(cloud, gaussians, kChunkRows);
  std::vector<Chunk> chunks;
  for (std::size_t begin = 0; begin < order.size(); begin += kChunkRows)
    chunks.push_back(
        chunk_of(cloud, std::span(order).subspan(begin, std::min(kChunkRows, order.size() - begin))));
  const std::string header = chunked_header(order.size(), chunks.size(), cloud, options);
  out.write(std::as_bytes(std::span(header)));
  static_assert(sizeof(Chunk) ==
                sizeof(float) * kBounds.size());  // its members stand in the order of kBounds
  out.write(std::as_bytes(std::span(chunks)));
  std::vector<std::array<std::uint32_t, 4>> packed(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) packed[i] = pack(cloud, order[i], chunks[i / kChunkRows]);
  out.write(std::as_bytes(std::span(packed)));
  std::vector<std::uint8_t> sh;
  for (const std::uint32_t g : order) {
    for (const float v : cloud.sh_rest_of(g))
      sh.push_back(to_byte(std::floor((v / kShRange + 0.5f) * 256.0f)));
  }
  out.write(std::as_bytes(std::span(sh)));
  Losses losses = compressed_ply_losses(scene, gaussians);
  constexpr float kManySizes = 10;  // as those move that share a chunk with a stray
  losses.add(moved_far(cloud, order, kManySizes, [&](std::size_t i) {
    const Bounds& bounds = chunks[i / kChunkRows].position;
    return bounds.at(unpack_11_10_11(pack_11_10_11(bounds.fraction_of(cloud.position[order[i]]))));
  }));
  return losses.sentence();
}

FormatPlan plan_compressed_ply(const Scene& scene, std::span<const std::uint32_t> gaussians, bool) {
  FormatPlan plan;
  plan.bytes = gaussians.size() * (16 + scene.cloud.sh_stride()) + (gaussians.size() / 256 + 1) * 72 + 900;
  plan.kept = "Position, rotation, scale, colour and opacity in 16 bytes a Gaussian.";
  plan.lost = compressed_ply_losses(scene, gaussians).in_full();
  return plan;
}

}  // namespace

constinit const SceneFormat SceneFormat::kCompressedPly = {
    .name = "compressed.ply",
    .extension = ".compressed.ply",
    .recognises = is_compressed_ply,
    .read = read_compressed_ply,
    .write = write_compressed_ply,
    .plan = plan_compressed_ply,
};

}  // namespace splatcut
