#include "scene/formats/scene_formats.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "core/error.h"
#include "core/lower_case.h"
#include "core/spoken_list.h"

namespace splatcut {

namespace {

constexpr std::array kRows = {
#define SPLATCUT_LIST_ROW(row) &SceneFormat::row,
    SPLATCUT_SCENE_FORMATS(SPLATCUT_LIST_ROW)
#undef SPLATCUT_LIST_ROW
};

std::vector<std::string_view> endings_of(const SceneFormat& format) {
  std::vector<std::string_view> endings = {format.extension, format.also};
  std::erase(endings, "");
  return endings;
}

struct Ending {
  const SceneFormat* format = nullptr;  // null for none
  std::string_view text;
};

// The longest of a format that the name ends with.
Ending ending_of(const std::filesystem::path& path) {
  const std::string name = lower_case(path.filename().string());
  Ending found;
  for (const SceneFormat* row : kRows)
    for (const std::string_view ending : endings_of(*row))
      if (ending.size() > found.text.size() && name.ends_with(ending)) found = {row, ending};
  return found;
}

}  // namespace

std::vector<SceneFormat> scene_formats() {
  std::vector<SceneFormat> formats;
  for (const SceneFormat* row : kRows) formats.push_back(*row);
  return formats;
}

std::vector<SceneFormat> read_formats() {
  std::vector<SceneFormat> formats = scene_formats();
  std::erase_if(formats, [](const SceneFormat& format) { return !format.read; });
  return formats;
}

std::vector<SceneFormat> written_formats() {
  std::vector<SceneFormat> formats = scene_formats();
  std::erase_if(formats, [](const SceneFormat& format) { return !format.write; });
  return formats;
}

const SceneFormat* find_format(const std::filesystem::path& path) {
  return ending_of(path).format;
}

bool has_scene_extension(const std::filesystem::path& path) {
  return find_format(path) != nullptr;
}

SceneFormat input_format_from_name(const std::filesystem::path& path) {
  const SceneFormat* format = find_format(path);
  if (format && format->read) return *format;
  throw Error(path.string(), "the file extension is none of " + spoken_endings(read_formats(), "and"));
}

SceneFormat output_format_from_name(const std::filesystem::path& path) {
  const Ending ending = ending_of(path);
  if (ending.format && ending.format->write && ending.text == ending.format->extension) return *ending.format;
  throw Error(path.string(),
              ending.format ? fmt::format("files that end with {} are only read, not written", ending.text)
                            : "the file extension names no format of scenes",
              "Choose " + spoken_extensions(written_formats(), "or"));
}

std::vector<std::string> extensions_of(std::span<const SceneFormat> formats) {
  std::vector<std::string_view> all;
  for (const SceneFormat& format : formats)
    for (const std::string_view ending : endings_of(format)) all.push_back(ending);
  std::vector<std::string> extensions;
  for (const std::string_view mine : all) {
    const bool covered = std::ranges::any_of(
        all, [&](std::string_view other) { return other != mine && mine.ends_with(other); });
    if (!covered) extensions.emplace_back(mine);
  }
  return extensions;
}

std::string spoken_endings(std::span<const SceneFormat> formats, std::string_view conjunction) {
  std::vector<std::string> endings;
  for (const SceneFormat& format : formats)
    for (const std::string_view ending : endings_of(format))
      if (ending.starts_with('.')) endings.emplace_back(ending);
  return spoken_list(endings, conjunction);
}

std::string spoken_extensions(std::span<const SceneFormat> formats, std::string_view conjunction) {
  std::vector<std::string> extensions;
  for (const SceneFormat& format : formats) extensions.emplace_back(format.extension);
  return spoken_list(extensions, conjunction);
}

std::vector<std::string> names_of(std::span<const SceneFormat> formats) {
  std::vector<std::string> names;
  for (const SceneFormat& format : formats) names.emplace_back(format.name);
  return names;
}

std::filesystem::path with_extension(const std::filesystem::path& path, const SceneFormat& format) {
  std::string name = path.filename().string();
  const std::string_view ending = ending_of(path).text;
  if (name.size() > ending.size()) name.resize(name.size() - ending.size());
  return path.parent_path() / (name + format.extension);
}

std::string level_read(std::size_t levels, std::size_t level) {
  return fmt::format("Of its {} levels of detail, level {} is read, 0 the finest", levels, level);
}

}  // namespace splatcut
