#include "scene/formats/ply_writer.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cmath>
#include <cstring>
#include <utility>

#include "core/error.h"
#include "core/mapped_file.h"
#include "scene/cloud/quantise.h"
#include "scene/formats/said_up.h"
#include "scene/packing/ply_header.h"

namespace splatcut {

namespace {

constexpr std::size_t kBufferBytes = 1 << 20;

constexpr std::string_view kIdProperty = "property uchar object_id\n";

// The header text of the source with another vertex count, with object_id as the last property of a vertex if
// asked for, and with another up if one is known; all other lines stay as they are.
std::string changed_header(std::string_view header, std::size_t count, bool with_ids,
                           const std::optional<glm::vec3>& up) {
  // Readers take the end of the first line for that of all.
  const std::string_view line_end = header.substr(0, header.find('\n')).ends_with('\r') ? "\r\n" : "\n";
  const auto ended = [&](std::string_view line) {
    return line.empty() ? std::string() : std::string(line.substr(0, line.size() - 1)).append(line_end);
  };
  std::string out, line_of_up = ended(up_comment(up));
  bool in_vertex = false;
  for (std::size_t begin = 0; begin < header.size();) {
    const std::size_t end = header.find('\n', begin) + 1;
    const std::string_view line = header.substr(begin, end - begin);
    const std::vector<std::string_view> words = words_of(line);
    const bool leaves = in_vertex && !words.empty() && (words[0] == "element" || words[0] == "end_header");
    begin = end;
    if (up && is_up_comment(line)) continue;
    if (!words.empty() && words[0] == "element") out += std::exchange(line_of_up, {});
    if (leaves && with_ids) out += ended(kIdProperty);
    if (leaves) in_vertex = false;
    if (words.size() == 3 && words[0] == "element" && words[1] == "vertex") {
      in_vertex = true;
      out += fmt::format("element vertex {}{}", count, line_end);
    } else {
      out += line;
    }
  }
  return out;
}

// A logit that every viewer can read: 8-bit sources have opacities of exactly 0 and 1.
float logit(float opacity) {
  constexpr float kNearest = 1e-7f;
  const float p = std::clamp(opacity, kNearest, 1.0f - kNearest);
  return std::log(p / (1.0f - p));
}

std::string header_for(std::size_t count, const GaussianCloud& cloud, bool is_far,
                       const SaveOptions& options) {
  std::string header = fmt::format("ply\nformat binary_little_endian 1.0\n{}{}element vertex {}\n",
                                   antialiasing_comment(cloud.antialiased), up_comment(options.up), count);
  for (const char* name : {"x", "y", "z"})
    header += fmt::format("property {} {}\n", is_far ? "double" : "float", name);
  const auto add = [&](const std::string& name) { header += "property float " + name + "\n"; };
  for (const char* name : {"nx", "ny", "nz", "f_dc_0", "f_dc_1", "f_dc_2"}) add(name);
  for (std::size_t i = 0; i < cloud.sh_stride(); ++i) add(fmt::format("f_rest_{}", i));
  for (const char* name : {"opacity", "scale_0", "scale_1", "scale_2", "rot_0", "rot_1", "rot_2", "rot_3"})
    add(name);
  if (!options.object_ids.empty()) header += kIdProperty;
  return header + "end_header\n";
}

using RowValues = std::array<std::pair<const char*, double>, 14>;

RowValues values_of_row(const GaussianCloud& cloud, std::size_t g, const glm::dvec3& origin) {
  const glm::dvec3 p = glm::dvec3(cloud.position[g]) + origin;
  const glm::vec3 size = glm::log(never_flat(cloud.scale[g])), &dc = cloud.f_dc[g];
  const glm::quat& q = cloud.rotation[g];
  return {{{"x", p.x},
           {"y", p.y},
           {"z", p.z},
           {"f_dc_0", dc.x},
           {"f_dc_1", dc.y},
           {"f_dc_2", dc.z},
           {"opacity", logit(cloud.opacity[g])},
           {"scale_0", size.x},
           {"scale_1", size.y},
           {"scale_2", size.z},
           {"rot_0", q.w},
           {"rot_1", q.x},
           {"rot_2", q.y},
           {"rot_3", q.z}}};
}

void set_value(const PlyProperty& property, double value, std::span<std::byte> row) {
  const auto narrow = static_cast<float>(value);
  if (property.type == PlyType::kFloat64)
    std::memcpy(&row[property.offset], &value, sizeof value);
  else
    std::memcpy(&row[property.offset], &narrow, sizeof narrow);
}

void change_row(const GaussianCloud& to, std::size_t g, const PlyElement& vertex, const glm::dvec3& origin,
                std::span<std::byte> row) {
  for (const auto& [name, value] : values_of_row(to, g, origin)) set_value(*vertex.find(name), value, row);
  if (const PlyProperty* filter = vertex.find("filter_3D")) set_value(*filter, 0, row);  // it is in the size
}

void refuse_changed(const MappedFile& source, const Scene& scene) {
  if (source.bytes().size() != scene.file_bytes || source.modified_ns() != scene.modified_ns)
    throw Error(scene.path.string(), "the file changed since it was loaded", "Load it again");
}

}  // namespace

bool can_change_rows(const PlyElement& vertex) {
  const auto is_fraction = [](const PlyProperty* p) {
    return p && (p->type == PlyType::kFloat32 || p->type == PlyType::kFloat64);
  };
  GaussianCloud any;
  any.resize(1, 0);
  const PlyProperty* filter = vertex.find("filter_3D");
  return (!filter || is_fraction(filter)) &&
         std::ranges::all_of(values_of_row(any, 0, {}),
                             [&](const auto& v) { return is_fraction(vertex.find(v.first)); });
}

void write_ply_subset(AtomicFile& out, const Scene& scene, std::span<const std::uint32_t> gaussians,
                      const SaveOptions& options) {
  const std::span<const std::uint8_t> object_ids = options.object_ids;
  const GaussianCloud* changed = options.changed_rows;
  assert(object_ids.empty() || !changed);
  const MappedFile source(scene.path);
  refuse_changed(source, scene);
  const PlyHeader header = parse_ply_header(scene.path, source.bytes());
  const PlyElement* vertex = header.find("vertex");
  if (!vertex) throw Error(scene.path.string(), "the header has no element \"vertex\"");
  if (!object_ids.empty() && vertex->find("object_id"))
    throw Error(scene.path.string(), "has a property object_id already, where objects are to be numbered");
  const std::span<const std::byte> rows = element_bytes(scene.path, source.bytes(), *vertex);
  const std::string text =
      changed_header(source.text().substr(0, header.bytes),
                     gaussians.size() + (changed ? changed->size() : 0), !object_ids.empty(), options.up);
  out.write(std::as_bytes(std::span(text)));
  out.write(source.bytes().subspan(header.bytes, vertex->data_begin - header.bytes));
  const std::size_t row_bytes = vertex->row_bytes;
  std::vector<std::byte> buffer;
  buffer.reserve(kBufferBytes + row_bytes);
  const auto add_row = [&](std::uint32_t file_row) {
    if (buffer.size() >= kBufferBytes) {
      out.write(buffer);
      buffer.clear();
    }
    const auto row = rows.subspan(file_row * row_bytes, row_bytes);
    buffer.insert(buffer.end(), row.begin(), row.end());
  };
  for (const std::uint32_t g : gaussians) {
    add_row(scene.cloud.file_row[g]);
    if (!object_ids.empty()) buffer.push_back(std::byte{object_ids[g]});
  }
  for (std::size_t c = 0; changed && c < changed->size(); ++c) {
    add_row(changed->file_row[c]);
    change_row(*changed, c, *vertex, scene.origin, std::span(buffer).last(row_bytes));
  }
  out.write(buffer);
  out.write(source.bytes().subspan(vertex->data_begin + rows.size()));  // elements after the Gaussians
  refuse_changed(MappedFile(scene.path), scene);                        // while its rows were copied
}

void write_ply_rows(AtomicFile& out, const Scene& scene, std::span<const std::uint32_t> gaussians,
                    const SaveOptions& options) {
  const GaussianCloud& cloud = scene.cloud;
  const bool is_far = scene.origin != glm::dvec3(0);
  const std::string header = header_for(gaussians.size(), cloud, is_far, options);
  out.write(std::as_bytes(std::span(header)));
  std::vector<std::byte> buffer;
  buffer.reserve(kBufferBytes + (20 + cloud.sh_stride()) * sizeof(float));
  std::vector<float> row;
  const auto add = [&](auto... values) { (row.push_back(values), ...); };
  for (const std::uint32_t g : gaussians) {
    const glm::vec3 &p = cloud.position[g], &dc = cloud.f_dc[g], size = glm::log(never_flat(cloud.scale[g]));
    const glm::quat& q = cloud.rotation[g];
    const std::span<const float> rest = cloud.sh_rest_of(g);
    row.clear();
    if (is_far) {
      const auto halves = std::bit_cast<std::array<float, 6>>(glm::dvec3(p) + scene.origin);
      row.insert(row.end(), halves.begin(), halves.end());
    } else {
      add(p.x, p.y, p.z);
    }
    add(0.0f, 0.0f, 0.0f, dc.x, dc.y, dc.z);
    row.insert(row.end(), rest.begin(), rest.end());
    add(logit(cloud.opacity[g]), size.x, size.y, size.z, q.w, q.x, q.y, q.z);
    const auto bytes = std::as_bytes(std::span(row));
    buffer.insert(buffer.end(), bytes.begin(), bytes.end());
    if (!options.object_ids.empty()) buffer.push_back(std::byte{options.object_ids[g]});
    if (buffer.size() < kBufferBytes) continue;
    out.write(buffer);
    buffer.clear();
  }
  out.write(buffer);
}

}  // namespace splatcut
