#include "app/console/labels_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "core/atomic_file.h"
#include "core/error.h"
#include "core/json_file.h"
#include "core/mapped_file.h"

namespace splatcut {

namespace {

// The header of a numpy array of bytes, version 1.0 of the format: magic, version, length, a dictionary of
// Python, and blanks up to a line's end, 64 bytes or a multiple of them in all.
std::string npy_header(std::size_t count) {
  constexpr std::size_t kAlignment = 64;
  const std::string magic("\x93NUMPY\x01\0", 8);
  std::string text = "{'descr': '|u1', 'fortran_order': False, 'shape': (" + std::to_string(count) + ",), }";
  const std::size_t length = magic.size() + 2 + text.size() + 1;
  text.append((kAlignment - length % kAlignment) % kAlignment, ' ');
  text += '\n';
  const auto low = static_cast<char>(text.size() & 0xff), high = static_cast<char>(text.size() >> 8);
  return magic + low + high + text;
}

}  // namespace

std::string labels_in_file_order(const Scene& scene, const std::vector<std::uint8_t>& labels) {
  std::string bytes(scene.file_rows, '\0');
  for (std::size_t g = 0; g < labels.size(); ++g)
    bytes[scene.cloud.file_row[g]] = static_cast<char>(labels[g]);
  return bytes;
}

void write_labels(const std::filesystem::path& path, const Scene& scene,
                  const std::vector<std::uint8_t>& labels) {
  const std::string bytes = labels_in_file_order(scene, labels);
  write_text_file(path, path.extension() == ".npy" ? npy_header(bytes.size()) + bytes : bytes);
}

std::vector<std::uint8_t> load_labels(const std::filesystem::path& path, const Scene& scene) {
  const std::string bytes = text_of_file(path);
  if (bytes.starts_with("\x93NUMPY"))
    throw Error(path.string(), "is an array of numpy", "Give the labels.u8 that was written beside it");
  if (bytes.size() != scene.file_rows)
    throw Error(path.string(),
                fmt::format("holds {} labels, the scene {} rows", bytes.size(), scene.file_rows));
  std::vector<std::uint8_t> labels(scene.cloud.size());
  for (std::size_t g = 0; g < labels.size(); ++g) labels[g] = bytes[scene.cloud.file_row[g]] != 0;
  return labels;
}

void write_object_names(const std::filesystem::path& path, std::span<const std::string> names) {
  nlohmann::json objects = nlohmann::json::array();
  for (const std::string& name : names)
    objects.push_back({{"object_id", objects.size() + 1}, {"name", name.empty() ? "object" : name}});
  write_text_file(path, json_text({{"objects", objects}}, 2) + "\n");
}

void refuse_other_than_names(const std::filesystem::path& path) {
  std::error_code failure;
  if (!std::filesystem::exists(path, failure)) return;
  const auto is_name = [](const nlohmann::json& o) { return o.contains("object_id") && o.contains("name"); };
  try {
    const nlohmann::json there = json_of_file(path);
    if (there.size() == 1 && std::ranges::all_of(there.at("objects"), is_name)) return;
  } catch (const std::exception&) {  // it is no JSON, or of another form
  }
  throw Error(path.string(), "would get the names of the objects, but holds something else",
              "It would be lost: choose another name");
}

}  // namespace splatcut
