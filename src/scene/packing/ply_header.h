// The text at the start of a .ply file: its elements and their properties. Internal to src/scene.
// Reads formats binary_little_endian and ascii; others, unknown types and headers without an end are an
// Error. List properties are known, but an element that has one has no fixed row size.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/mapped_file.h"

namespace splatcut {

enum class PlyType { kInt8, kUint8, kInt16, kUint16, kInt32, kUint32, kFloat32, kFloat64 };
std::size_t size_of(PlyType type);
const char* name_of(PlyType type);

struct PlyProperty {
  std::string name;
  PlyType type = PlyType::kFloat32;
  std::size_t offset = 0;  // bytes from the start of the row
};

struct PlyElement {
  std::string name;
  std::size_t count = 0;
  std::size_t row_bytes = 0;
  bool has_list = false;  // row_bytes and offsets are then meaningless
  std::vector<PlyProperty> properties;
  std::size_t data_begin = 0;  // byte in the file; 0 when an element with a list stands before

  const PlyProperty* find(std::string_view property) const;
};

struct PlyHeader {
  std::size_t bytes = 0;  // up to and including the line end after end_header
  bool ascii = false;     // rows are text: offsets and data_begin are then meaningless
  std::vector<PlyElement> elements;
  std::vector<std::string> comments;  // without the word and what stands around them

  const PlyElement* find(std::string_view element) const;
  // Whether a comment says that the scene was trained with the filter of Mip-Splatting: "SplatRenderMode:
  // mip" (Brush, gsplat, splat-transform) or "antialiased 1" (Postshot).
  bool antialiased() const;
};

// The line of a header that says so; empty for others.
std::string antialiasing_comment(bool antialiased);

// Whether the file begins as every .ply does.
bool has_ply_mark(const MappedFile& file);

// The words of a header line, without blanks and line end.
std::vector<std::string_view> words_of(std::string_view line);

PlyHeader parse_ply_header(const std::filesystem::path& path, std::span<const std::byte> file);

// The element's bytes. Throws Error when it is absent, has lists, or the file ends before its last row.
std::span<const std::byte> element_bytes(const std::filesystem::path& path, std::span<const std::byte> file,
                                         const PlyElement& element);

// The property. Throws Error that lists the properties found when it is absent.
const PlyProperty& required_property(const std::filesystem::path& path, const PlyElement& element,
                                     std::string_view property);

}  // namespace splatcut
