// 3DGS .ply as Kerbl et al. (2023) write it: properties by name, in any order; opacity as logit, scale as
// logarithm, rotation w,x,y,z, f_rest channel-major. Also as text, and with red, green, blue (bytes, or 0 to
// 1) in place of f_dc.
//   scale_2 missing (2D Gaussian Splatting)  a third axis of size 0
//   filter_3D (Mip-Splatting, GOF) = f       scale = sqrt(s^2 + f^2), opacity times the share of the volume
//   72 f_rest (degree 4)                     those of degree 1 to 3
//   element color_space = 1 (ml-sharp)       colours are linear and become sRGB
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cstring>

#include "core/error.h"
#include "core/parallel.h"
#include "scene/cloud/quantise.h"
#include "scene/formats/decode.h"
#include "scene/formats/far_origin.h"
#include "scene/formats/losses.h"
#include "scene/formats/ply_text.h"
#include "scene/formats/ply_values.h"
#include "scene/formats/ply_writer.h"
#include "scene/formats/said_up.h"
#include "scene/packing/ply_header.h"

namespace splatcut {

static_assert(std::endian::native == std::endian::little, "binary_little_endian files are read in place");

namespace {

constexpr std::array<const char*, 14> kNames{"x",      "y",       "z",       "f_dc_0",  "f_dc_1",
                                             "f_dc_2", "opacity", "scale_0", "scale_1", "scale_2",
                                             "rot_0",  "rot_1",   "rot_2",   "rot_3"};
enum Field : std::size_t { kX = 0, kDc = 3, kOpacity = 6, kScale = 7, kRotation = 10, kRest = 14 };
constexpr std::size_t kMaxFields = kRest + 45;
constexpr std::array<const char*, 3> kColourNames{"red", "green", "blue"};
constexpr const char* kFilterName = "filter_3D";
constexpr std::size_t kRestOfDegree4 = 72;
constexpr std::array<const char*, 3> kNormalNames{"nx", "ny", "nz"};  // written by all, mostly as 0

constexpr std::size_t kAbsent = std::numeric_limits<std::size_t>::max();  // an offset
constexpr float kInfinite = std::numeric_limits<float>::infinity();

// Rows of a file whose fields may have any type and order; kFloats: all are float.
template <bool kFloats>
struct PlyRows {
  const std::byte* data = nullptr;
  std::size_t row_bytes = 0;
  std::size_t fields = kRest;
  std::array<std::size_t, kMaxFields> offset{};
  std::array<PlyType, kMaxFields> type{};
  bool rest_in_sequence = false;  // f_rest_0, f_rest_1, ... stand side by side as floats
  float colour_scale = 0;         // not 0: the file has colours instead of f_dc; times this they are 0 to 1
  bool linear_colours = false;
  glm::dvec3 origin{0};                 // taken off positions
  const PlyProperty* filter = nullptr;  // of the 3D filter, scene units

  float value(const std::byte* row, std::size_t field) const {
    if constexpr (kFloats) return load_as_float<float>(row + offset[field]);
    return load_as_float(row + offset[field], type[field]);
  }
  glm::vec3 vec3(const std::byte* row, std::size_t field) const {
    return {value(row, field), value(row, field + 1), value(row, field + 2)};
  }
  // Where nothing is taken off, as the bits stand there.
  glm::vec3 place(const std::byte* row) const {
    if constexpr (kFloats) return vec3(row, kX);
    const auto from_origin = [&](std::size_t axis) {
      return load_as_double(row + offset[axis], type[axis]) - origin[static_cast<int>(axis)];
    };
    return glm::vec3(from_origin(0), from_origin(1), from_origin(2));
  }
  glm::quat rotation(const std::byte* row) const {
    return {value(row, kRotation), value(row, kRotation + 1), value(row, kRotation + 2),
            value(row, kRotation + 3)};
  }
  glm::vec3 f_dc(const std::byte* row) const {
    const glm::vec3 v = vec3(row, kDc);
    if (linear_colours)
      return f_dc_from_colour(srgb_from_linear(colour_scale == 0 ? colour_from_f_dc(v) : v * colour_scale));
    return colour_scale == 0 ? v : f_dc_from_colour(v * colour_scale);
  }
  glm::vec3 log_scale(const std::byte* row) const {
    if (offset[kScale + 2] == kAbsent) return {value(row, kScale), value(row, kScale + 1), -kInfinite};
    return vec3(row, kScale);
  }
  float filter_size(const std::byte* row) const {
    return filter ? load_as_float(row + filter->offset, filter->type) : 0.0f;
  }
  bool rest_is_finite(const std::byte* row) const {
    // A sum of zeros: 0 * v is NaN for NaN and for infinite v, and the loop has no branch.
    float zero = 0;
    for (std::size_t f = kRest; f < fields; ++f) zero += 0.0f * value(row, f);
    return zero == 0.0f;
  }

  glm::vec3 position(std::size_t index) const {
    const std::byte* row = data + index * row_bytes;
    const glm::quat q = rotation(row);
    const float norm_squared = glm::dot(q, q);
    const glm::vec3 logs = log_scale(row);
    const bool good = norm_squared > 0 && std::isfinite(norm_squared) && !std::isnan(value(row, kOpacity)) &&
                      logs.x < kLargestLogSize && logs.y < kLargestLogSize && logs.z < kLargestLogSize &&
                      is_finite(vec3(row, kDc)) && is_within_reach(glm::vec3(filter_size(row))) &&
                      rest_is_finite(row);
    return good ? place(row) : kDroppedRow;
  }
  void decode(std::size_t index, GaussianCloud& cloud, std::size_t g) const {
    const std::byte* row = data + index * row_bytes;
    cloud.f_dc[g] = f_dc(row);
    cloud.opacity[g] = sigmoid(value(row, kOpacity));
    cloud.scale[g] = glm::exp(log_scale(row));
    if (filter) fuse_filter(filter_size(row), &cloud.scale[g], &cloud.opacity[g]);
    cloud.rotation[g] = glm::normalize(rotation(row));
    float* rest = cloud.sh_rest.data() + g * (fields - kRest);
    if (fields > kRest && rest_in_sequence) {
      std::memcpy(rest, row + offset[kRest], (fields - kRest) * sizeof(float));
    } else {
      for (std::size_t f = kRest; f < fields; ++f) *rest++ = value(row, f);
    }
  }
};

// What has no column.
std::size_t rest_of(const PlyElement& vertex) {
  return static_cast<std::size_t>(std::ranges::count_if(
      vertex.properties, [](const PlyProperty& p) { return p.name.starts_with("f_rest_"); }));
}

int degree_from_rest(const std::filesystem::path& path, std::size_t count) {
  for (int degree = 0; degree <= 3; ++degree)
    if (count == 3 * static_cast<std::size_t>(sh_rest_coefficients(degree))) return degree;
  throw Error(path.string(),
              fmt::format("{} f_rest properties found; 0, 9, 24, 45 or 72 are possible", count));
}

// Ends with an Error for what is a .ply but not a 3DGS scene, in the words a user can act on.
void refuse_other_ply(const std::filesystem::path& path, const PlyElement& vertex) {
  const bool has_splat_fields = vertex.find("f_dc_0") || vertex.find("opacity") || vertex.find("scale_0");
  if (!has_splat_fields && vertex.find("x"))
    throw Error(
        path.string(),
        "is an ordinary point cloud or mesh: it has points but no opacity, scale or rotation of Gaussians",
        "Give the trained scene, often point_cloud/iteration_30000/point_cloud.ply");
}

// A 2D Gaussian has two axes; one that lacks more is damaged.
bool is_flat(const PlyElement& vertex) {
  return vertex.find(kNames[kScale + 1]) && !vertex.find(kNames[kScale + 2]);
}

bool has_colours_only(const PlyElement& vertex) {
  return !vertex.find(kNames[kDc]) && vertex.find(kColourNames[0]);
}

// What makes colours of that type 0 to 1.
float colour_scale_of(PlyType type) {
  switch (type) {
    case PlyType::kUint8:
      return 1.0f / 255;
    case PlyType::kUint16:
      return 1.0f / 65535;
    default:
      return 1;
  }
}

template <bool kFloats>
PlyRows<kFloats> bind(const std::filesystem::path& path, const PlyElement& vertex) {
  PlyRows<kFloats> rows;
  rows.row_bytes = vertex.row_bytes;
  const auto add = [&](std::size_t field, const std::string& name) {
    const PlyProperty& property = required_property(path, vertex, name);
    rows.offset[field] = property.offset;
    rows.type[field] = property.type;
  };
  for (std::size_t f = 0; f < kRest; ++f) {
    if (f == kScale + 2 && is_flat(vertex)) {
      rows.offset[f] = kAbsent;
      continue;
    }
    const bool colour = f >= kDc && f < kDc + 3 && has_colours_only(vertex);
    add(f, colour ? kColourNames[f - kDc] : kNames[f]);
  }
  if (has_colours_only(vertex)) rows.colour_scale = colour_scale_of(rows.type[kDc]);
  rows.filter = vertex.find(kFilterName);
  const bool cut = rest_of(vertex) == kRestOfDegree4;
  const std::size_t rest = cut ? kMaxFields - kRest : rest_of(vertex);
  degree_from_rest(path, rest);
  rows.fields = kRest + rest;
  rows.rest_in_sequence = true;
  for (std::size_t i = 0; i < rest; ++i) {
    add(kRest + i, fmt::format("f_rest_{}", cut ? i / 15 * (kRestOfDegree4 / 3) + i % 15 : i));
    rows.rest_in_sequence = rows.rest_in_sequence && rows.type[kRest + i] == PlyType::kFloat32 &&
                            rows.offset[kRest + i] == rows.offset[kRest] + i * sizeof(float);
  }
  return rows;
}

const PlyElement& vertex_of(const std::filesystem::path& path, const PlyHeader& header) {
  if (const PlyElement* vertex = header.find("vertex")) return *vertex;
  throw Error(path.string(), "the header has no element \"vertex\"");
}

bool is_zero(const PlyElement& vertex, const PlyProperty& p, const std::byte* data) {
  std::atomic<bool> zero = true;
  for_each_index(vertex.count, [&](std::size_t row) {
    if (zero && load_as_float(data + row * vertex.row_bytes + p.offset, p.type) != 0) zero = false;
  });
  return zero;
}

// Normals count where they say something: a few trainers write such.
std::vector<std::string> other_properties(const PlyElement& vertex, const std::byte* data) {
  std::vector<std::string> others;
  for (const PlyProperty& p : vertex.properties) {
    const auto is = [&](const char* name) { return p.name == name; };
    const bool known = std::ranges::any_of(kNames, is) || is(kFilterName) || p.name.starts_with("f_rest_") ||
                       (has_colours_only(vertex) && std::ranges::any_of(kColourNames, is));
    if (!known && !(std::ranges::any_of(kNormalNames, is) && is_zero(vertex, p, data)))
      others.push_back(p.name);
  }
  return others;
}

template <bool kFloats>
void read_rows(const MappedFile& file, const PlyElement& vertex, const std::byte* data, bool linear_colours,
               Scene& scene, const Job& job) {
  PlyRows<kFloats> rows = bind<kFloats>(file.path(), vertex);
  rows.linear_colours = linear_colours;
  rows.origin = scene.origin;
  rows.data = data;
  if (vertex.count > std::numeric_limits<std::uint32_t>::max())
    throw Error(file.path().string(), fmt::format("{} Gaussians are more than can be handled", vertex.count));
  scene.other_properties = other_properties(vertex, data);
  decode_rows(rows, vertex.count, degree_from_rest(file.path(), rows.fields - kRest), scene, job);
}

bool is_ply(const MappedFile& file) {
  return has_ply_mark(file) && !SceneFormat::kCompressedPly.recognises(file);
}

// Bytes of colour are bytes in a text, too.
void read_text(const MappedFile& file, const PlyHeader& header, const PlyElement& vertex, Scene& scene,
               const Job& job) {
  bind<false>(file.path(), vertex);  // refuses what lacks a property before the long part
  if (header.find("color_space"))
    throw Error(file.path().string(),
                "is text and names a space of colours, which is only read from a binary .ply",
                "Convert the file to binary_little_endian");
  job.progress("reading text", 0.0);
  PlyTextRows rows = read_text_rows(file, header, vertex, scene.origin, job);
  if (job.cancelled()) return;
  if (has_colours_only(vertex)) {
    const float scale = colour_scale_of(vertex.find(kColourNames[0])->type);
    for (const char* name : kColourNames) {
      const std::size_t column = required_property(file.path(), rows.element, name).offset / sizeof(float);
      for (std::size_t row = 0; row < vertex.count; ++row)
        rows.values[row * vertex.properties.size() + column] *= scale;
    }
  }
  read_rows<true>(file, rows.element, std::as_bytes(std::span(rows.values)).data(), false, scene, job);
}

// The element of ml-sharp: a number, 1 for linear.
bool has_linear_colours(const MappedFile& file, const PlyHeader& header, const PlyElement& vertex) {
  const PlyElement* space = header.find("color_space");
  if (!space || space->properties.empty() || space->count == 0) return false;
  const std::span<const std::byte> bytes = element_bytes(file.path(), file.bytes(), *space);
  const bool linear = load_as_float(bytes.data(), space->properties[0].type) == 1;
  if (linear && rest_of(vertex) > 0)
    throw Error(file.path().string(), "its colours are linear and depend on the view: such are not converted",
                "Export it with sRGB colours");
  return linear;
}

void read_binary(const MappedFile& file, const PlyHeader& header, const PlyElement& vertex, Scene& scene,
                 const Job& job) {
  const bool floats = std::ranges::all_of(vertex.properties,
                                          [](const PlyProperty& p) { return p.type == PlyType::kFloat32; });
  const std::byte* data = element_bytes(file.path(), file.bytes(), vertex).data();
  const bool linear = has_linear_colours(file, header, vertex);
  if (linear) scene.rows_can_be_changed = false;  // what is added would be sRGB
  if (floats)
    read_rows<true>(file, vertex, data, linear, scene, job);
  else
    read_rows<false>(file, vertex, data, linear, scene, job);
}

void read_vertices(const MappedFile& file, const PlyHeader& header, const PlyElement& vertex, Scene& scene,
                   const Job& job) {
  if (header.ascii)
    read_text(file, header, vertex, scene, job);
  else
    read_binary(file, header, vertex, scene, job);
}

// A second time where the first look says that an origin is to be taken off.
void read_doubles(const MappedFile& file, const PlyHeader& header, const PlyElement& vertex,
                  const LoadOptions& options, Scene& scene, const Job& job) {
  scene.origin = options.origin.value_or(glm::dvec3(0));
  read_vertices(file, header, vertex, scene, job);
  if (!options.origin) scene.origin = far_origin(scene.cloud);
  if (options.origin || scene.origin == glm::dvec3(0)) {
    scene.oddity = rounded_positions(scene.cloud);
    return;
  }
  read_vertices(file, header, vertex, scene, job);
  scene.oddity = fmt::format(
      "{} is taken off its positions, which 32 bits do not hold, and off those of cameras; a .ply gets it "
      "back",
      spoken(scene.origin));
}

void read_ply(const MappedFile& file, const LoadOptions& options, Scene& scene, const Job& job) {
  const PlyHeader header = parse_ply_header(file.path(), file.bytes());
  const PlyElement& vertex = vertex_of(file.path(), header);
  refuse_other_ply(file.path(), vertex);
  scene.rows_can_be_copied = !header.ascii;
  scene.rows_can_be_changed = !header.ascii && can_change_rows(vertex);
  scene.cloud.antialiased = header.antialiased();
  if (rest_of(vertex) == kRestOfDegree4)
    scene.left_out = "Spherical harmonics of degree 4 are left out, those up to degree 3 are read";
  if (required_property(file.path(), vertex, "x").type == PlyType::kFloat64)
    read_doubles(file, header, vertex, options, scene, job);
  else
    read_vertices(file, header, vertex, scene, job);
  take_up(up_from_header(header), {}, &scene);
}

Losses ply_losses(const Scene& scene, bool rows_copied) {
  Losses losses;
  if (!rows_copied) losses.add(properties_left_out(scene));
  return losses;
}

std::string write_ply(AtomicFile& out, const Scene& scene, std::span<const std::uint32_t> gaussians,
                      const SaveOptions& options) {
  if (scene.rows_can_be_copied)
    write_ply_subset(out, scene, gaussians, options);
  else
    write_ply_rows(out, scene, gaussians, options);
  return ply_losses(scene, scene.rows_can_be_copied).sentence();
}

std::uint64_t ply_row_bytes(const Scene& scene, bool rows_copied) {
  if (rows_copied && scene.file_rows > 0) return scene.file_bytes / scene.file_rows;
  const std::size_t more = scene.origin != glm::dvec3(0) ? 3 * (sizeof(double) - sizeof(float)) : 0;
  const auto floats = 3 + 3 + 3 + scene.cloud.sh_stride() + 1 + 3 +
                      4;  // position, normal, f_dc, rest, opacity, scale, rotation
  return floats * sizeof(float) + more;
}

FormatPlan plan_ply(const Scene& scene, std::span<const std::uint32_t> gaussians, bool moved) {
  const bool rows_copied = scene.rows_can_be_copied && !moved;
  FormatPlan plan;
  plan.bytes = gaussians.size() * ply_row_bytes(scene, rows_copied) + 420 + 24 * scene.cloud.sh_stride();
  plan.kept = rows_copied
                  ? "Every property of every row, byte for byte as in the source file."
                  : "Places, sizes, turns, opacities and colours, in the way that other programs read.";
  plan.lost = ply_losses(scene, rows_copied).in_full();
  return plan;
}

}  // namespace

constinit const SceneFormat SceneFormat::kPly = {
    .name = "ply",
    .extension = ".ply",
    .recognises = is_ply,
    .read = read_ply,
    .write = write_ply,
    .plan = plan_ply,
};

}  // namespace splatcut
