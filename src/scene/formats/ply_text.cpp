#include "scene/formats/ply_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "core/error.h"
#include "scene/packing/incomplete.h"

namespace splatcut {

namespace {

constexpr std::string_view kBlanks = " \t\r\n";

// Takes the next line that is not blank off the text; empty at its end.
std::string_view next_line(std::string_view* text) {
  text->remove_prefix(std::min(text->find_first_not_of(kBlanks), text->size()));
  const std::string_view line = text->substr(0, text->find('\n'));
  text->remove_prefix(line.size());
  return line;
}

// Takes the next word off the text; empty at its end.
std::string_view next_word(std::string_view* text) {
  text->remove_prefix(std::min(text->find_first_not_of(kBlanks), text->size()));
  const std::string_view word = text->substr(0, text->find_first_of(kBlanks));
  text->remove_prefix(word.size());
  return word;
}

// The number less what is taken off it.
bool parse_number(std::string_view word, double off, float* value) {
  if (word.starts_with('+') && !word.starts_with("+-")) word.remove_prefix(1);
  const char* last = word.data() + word.size();
  if (off == 0) {
    const auto [end, failure] = std::from_chars(word.data(), last, *value);
    if (failure != std::errc::result_out_of_range) return failure == std::errc() && end == last;
  }
  double wide = 0;  // where off is 0, beyond what a float holds: infinite, or 0
  const auto [wide_end, wide_failure] = std::from_chars(word.data(), last, wide);
  *value = static_cast<float>(wide - off);
  return wide_failure == std::errc() && wide_end == last;
}

PlyElement with_floats(PlyElement element) {
  for (std::size_t i = 0; i < element.properties.size(); ++i) {
    element.properties[i].type = PlyType::kFloat32;
    element.properties[i].offset = i * sizeof(float);
  }
  element.row_bytes = element.properties.size() * sizeof(float);
  return element;
}

// By column.
std::vector<double> taken_off(const PlyElement& element, const glm::dvec3& origin) {
  std::vector<double> off;
  for (const PlyProperty& p : element.properties)
    off.push_back(p.name == "x" ? origin.x : p.name == "y" ? origin.y : p.name == "z" ? origin.z : 0);
  return off;
}

}  // namespace

PlyTextRows read_text_rows(const MappedFile& file, const PlyHeader& header, const PlyElement& element,
                           const glm::dvec3& origin, const Job& job) {
  const auto refuse = [&](const std::string& what) { throw Error(file.path().string(), what); };
  if (element.has_list || element.properties.empty())
    refuse(fmt::format("list properties in the element \"{}\" are not supported", element.name));
  std::string_view text = file.text().substr(header.bytes);
  for (const PlyElement& before : header.elements) {
    if (before.name == element.name) break;
    for (std::size_t row = 0; row < before.count && !text.empty(); ++row) next_line(&text);
  }
  const std::size_t columns = element.properties.size();
  if (element.count == 0) refuse(fmt::format("the element \"{}\" is empty", element.name));
  if (element.count > (text.size() + 1) / 2 / columns)  // a digit and a blank for each number
    refuse(incomplete(
        fmt::format("{} rows of {} numbers do not fit into {} bytes", element.count, columns, text.size())));
  const std::vector<double> off = taken_off(element, origin);
  PlyTextRows rows{with_floats(element), std::vector<float>(element.count * columns)};
  constexpr std::size_t kBetweenLooks = 1 << 16;
  for (std::size_t row = 0; row < element.count; ++row) {
    if (row % kBetweenLooks == 0 && job.cancelled()) break;
    std::string_view line = next_line(&text);
    for (std::size_t column = 0; column < columns; ++column) {
      const std::string_view word = next_word(&line);
      const std::string& property = element.properties[column].name;
      if (word.empty() && text.empty())
        refuse(incomplete(fmt::format("row {} ends before \"{}\"", row, property)));
      if (word.empty()) refuse(fmt::format("row {} ends before \"{}\"", row, property));
      if (!parse_number(word, off[column], &rows.values[row * columns + column]))
        refuse(fmt::format("row {}: \"{}\" is no number, for the property \"{}\"", row, word.substr(0, 40),
                           property));
    }
    if (!next_word(&line).empty()) refuse(fmt::format("row {} has more than {} numbers", row, columns));
  }
  return rows;
}

}  // namespace splatcut
