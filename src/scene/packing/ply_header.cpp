#include "scene/packing/ply_header.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <limits>

#include "core/error.h"
#include "core/lower_case.h"
#include "scene/packing/incomplete.h"

namespace splatcut {

namespace {

constexpr std::size_t kMaxHeaderBytes = 1 << 20;  // real headers have about 1.5 kB
constexpr std::size_t kMostParts =
    4096;  // elements, and properties of one: each is compared with all before it

struct TypeName {
  const char* name;
  const char* alias;
  PlyType type;
  std::size_t bytes;
};
constexpr std::array<TypeName, 8> kTypes{{{"char", "int8", PlyType::kInt8, 1},
                                          {"uchar", "uint8", PlyType::kUint8, 1},
                                          {"short", "int16", PlyType::kInt16, 2},
                                          {"ushort", "uint16", PlyType::kUint16, 2},
                                          {"int", "int32", PlyType::kInt32, 4},
                                          {"uint", "uint32", PlyType::kUint32, 4},
                                          {"float", "float32", PlyType::kFloat32, 4},
                                          {"double", "float64", PlyType::kFloat64, 8}}};

PlyType type_from_name(const std::filesystem::path& path, std::string_view name, std::string_view line) {
  for (const TypeName& type : kTypes)
    if (name == type.name || name == type.alias) return type.type;
  throw Error(path.string(), fmt::format("unknown type \"{}\" in the header line \"{}\"", name, line));
}

PlyElement parse_element(const std::filesystem::path& path, std::span<const std::string_view> words,
                         std::string_view line) {
  PlyElement element;
  const std::string_view count = words.size() == 3 ? words[2] : std::string_view();
  const auto [end, failure] = std::from_chars(count.data(), count.data() + count.size(), element.count);
  if (count.empty() || failure != std::errc() || end != count.data() + count.size())
    throw Error(path.string(), fmt::format("bad count in the header line \"{}\"", line));
  element.name = words[1];
  return element;
}

void parse_property(const std::filesystem::path& path, std::span<const std::string_view> words,
                    std::string_view line, PlyElement& element) {
  if (words.size() == 5 && words[1] == "list") {
    element.has_list = true;
    return;
  }
  if (words.size() != 3) throw Error(path.string(), fmt::format("bad header line \"{}\"", line));
  const PlyType type = type_from_name(path, words[1], line);
  if (element.properties.size() == kMostParts)
    throw Error(path.string(), fmt::format("an element has more than {} properties", kMostParts));
  if (element.find(words[2]))
    throw Error(path.string(), fmt::format("property \"{}\" appears twice", words[2]));
  element.properties.push_back({std::string(words[2]), type, element.row_bytes});
  element.row_bytes += size_of(type);
}

// Where each element's rows begin, as far as row sizes are known and the sums do not overflow.
void place_elements(PlyHeader& header) {
  std::size_t begin = header.bytes;
  for (PlyElement& element : header.elements) {
    element.data_begin = begin;
    const bool fits = element.row_bytes == 0 ||
                      element.count <= (std::numeric_limits<std::size_t>::max() - begin) / element.row_bytes;
    if (element.count == 0) continue;  // takes no bytes, whatever its rows would be
    if (element.has_list || !fits) return;
    begin += element.count * element.row_bytes;
  }
}

}  // namespace

std::vector<std::string_view> words_of(std::string_view line) {
  std::vector<std::string_view> words;
  constexpr std::string_view kBlank = " \t\r\n";
  for (std::size_t begin = line.find_first_not_of(kBlank); begin != line.npos;) {
    const std::size_t end = std::min(line.find_first_of(kBlank, begin), line.size());
    words.push_back(line.substr(begin, end - begin));
    begin = line.find_first_not_of(kBlank, end);
  }
  return words;
}

std::size_t size_of(PlyType type) {
  return kTypes[static_cast<std::size_t>(type)].bytes;
}
const char* name_of(PlyType type) {
  return kTypes[static_cast<std::size_t>(type)].name;
}

const PlyProperty* PlyElement::find(std::string_view property) const {
  const auto it = std::ranges::find(properties, property, &PlyProperty::name);
  return it == properties.end() ? nullptr : &*it;
}

const PlyElement* PlyHeader::find(std::string_view element) const {
  const auto it = std::ranges::find(elements, element, &PlyElement::name);
  return it == elements.end() ? nullptr : &*it;
}

bool PlyHeader::antialiased() const {
  return std::ranges::any_of(comments, [](const std::string& comment) {
    std::string said = lower_case(comment);
    std::ranges::replace(said, ':', ' ');
    std::ranges::replace(said, '=', ' ');
    const std::vector<std::string_view> words = words_of(said);
    if (words.size() < 2) return false;
    if (words[0] == "splatrendermode") return words[1] == "mip" || words[1] == "antialiased";
    return words[0] == "antialiased" && (words[1] == "1" || words[1] == "true");
  });
}

std::string antialiasing_comment(bool antialiased) {
  return antialiased ? "comment SplatRenderMode: mip\n" : "";
}

bool has_ply_mark(const MappedFile& file) {
  return begins_with(file, "ply\n") || begins_with(file, "ply\r\n");
}

PlyHeader parse_ply_header(const std::filesystem::path& path, std::span<const std::byte> file) {
  const std::string_view text(reinterpret_cast<const char*>(file.data()),
                              std::min(file.size(), kMaxHeaderBytes));
  if (!text.starts_with("ply\n") && !text.starts_with("ply\r\n"))
    throw Error(path.string(), "this is not a .ply file, as it does not begin with \"ply\"");
  PlyHeader header;
  bool has_format = false;
  for (std::size_t begin = text.find('\n') + 1;;) {
    const std::size_t end = text.find('\n', begin);
    if (end == text.npos)
      throw Error(path.string(),
                  fmt::format("the header is truncated: no end_header in the first {} bytes", text.size()));
    std::string_view line = text.substr(begin, end - begin);
    if (line.ends_with('\r')) line.remove_suffix(1);
    begin = end + 1;
    const std::vector<std::string_view> words = words_of(line);
    if (words.empty() || words[0] == "obj_info") continue;
    if (words[0] == "comment") {
      header.comments.push_back(words.size() > 1 ? std::string(line.substr(line.find(words[1]))) : "");
      continue;
    }
    if (words[0] == "end_header") {
      header.bytes = begin;
      break;
    }
    if (words[0] == "format") {
      header.ascii = words.size() == 3 && words[1] == "ascii";
      if (words.size() != 3 || (words[1] != "binary_little_endian" && !header.ascii))
        throw Error(path.string(), fmt::format("\"{}\" is not supported", line),
                    "Convert the file to binary_little_endian");
      has_format = true;
    } else if (words[0] == "element") {
      if (header.elements.size() == kMostParts)
        throw Error(path.string(), fmt::format("the header has more than {} elements", kMostParts));
      PlyElement element = parse_element(path, words, line);
      if (header.find(element.name))
        throw Error(path.string(), fmt::format("the element \"{}\" appears twice", element.name));
      header.elements.push_back(std::move(element));
    } else if (words[0] == "property" && !header.elements.empty()) {
      parse_property(path, words, line, header.elements.back());
    } else {
      throw Error(path.string(), fmt::format("bad header line \"{}\"", line.substr(0, 80)));
    }
  }
  if (!has_format) throw Error(path.string(), "the header has no format line");
  place_elements(header);
  return header;
}

std::span<const std::byte> element_bytes(const std::filesystem::path& path, std::span<const std::byte> file,
                                         const PlyElement& element) {
  if (element.has_list || element.data_begin == 0)
    throw Error(
        path.string(),
        fmt::format("list properties in or before the element \"{}\" are not supported", element.name));
  if (element.count == 0 || element.row_bytes == 0)
    throw Error(path.string(), fmt::format("the element \"{}\" is empty", element.name));
  const std::size_t rows_present =
      (file.size() - std::min(file.size(), element.data_begin)) / element.row_bytes;
  if (rows_present < element.count)
    throw Error(
        path.string(),
        incomplete(fmt::format("the header promises {} rows of {} bytes in the element \"{}\", row "
                               "{} is cut at byte {}",
                               element.count, element.row_bytes, element.name, rows_present, file.size())));
  return file.subspan(element.data_begin, element.count * element.row_bytes);
}

const PlyProperty& required_property(const std::filesystem::path& path, const PlyElement& element,
                                     std::string_view property) {
  if (const PlyProperty* found = element.find(property)) return *found;
  std::string found;  // not fmt::join: g++ 12 warns inside fmt 9 about it
  for (const PlyProperty& p : element.properties) found += (found.empty() ? "" : " ") + p.name;
  throw Error(path.string(), fmt::format("the property \"{}\" is missing from the element \"{}\" (found: {})",
                                         property, element.name, found));
}

}  // namespace splatcut
